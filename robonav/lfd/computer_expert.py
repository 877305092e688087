"""The computer expert, which knows the map and plans a path in it (sections 3.5 and 5.5.5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.robot import (
    COLLISION_DISTANCE,
    REFLEX,
    ReflexRule,
    Simulator,
    Worlds,
)
from robonav.robot.worlds import LARGEST_MAP
from robonav.validation import check_instance, check_real

from . import _fast
from .demonstrations import Actions, Demonstrations, record_demonstrations
from .planning import MOVE, as_single_steps, plan, steps_in_move

MARGIN = (
    3.0  # metres that plans keep from obstacles; no setting changes the policy more
)
CAUTION = 2.0  # how much more a step costs near an obstacle, see `plan`
MARGIN_STEP = 0.5  # metres by which the margin is reduced where it leaves no path
LIMIT = 50_000  # nodes to expand: many times what a path takes

Floats = NDArray[np.float64]


@dataclass(eq=False)
class FollowedPlan:
    """A plan that a robot is following.

    Attributes
    ----------
    poses : (K + 1, 3) array
        The poses of the plan.
    actions : (K,) array of int
        The actions of the plan.
    target : (2,) array
        The target that the plan leads to.
    centres : (M, 2) array
        Where the obstacles were when the plan was made.
    done : int
        How many of the actions the robot has taken.
    """

    poses: NDArray[np.float64]
    actions: Actions
    target: NDArray[np.float64]
    centres: NDArray[np.float64]
    done: int = 0

    def holds_for(self, simulator: Simulator, robot: int) -> bool:
        """Return whether the robot is at the next pose of the plan, in the world that the plan was made for."""
        return bool(
            self.done < len(self.actions)
            and np.abs(self.poses[self.done] - simulator.poses[robot]).max() < 1e-6
            and np.array_equal(self.target, simulator.worlds.targets[robot])
            and np.array_equal(self.centres, simulator.centres[robot])
            and not simulator.worlds.speeds[robot].any()
        )


class ComputerExpert:
    """An expert that plans with modified A* from where the robot is, and plans again once the robot has left its plan.

    One expert can serve several simulators: it follows a plan only in the world that it was made for.

    Parameters
    ----------
    margin : float
        Distance in metres that plans keep from obstacles and borders. Where that leaves no path, the margin is reduced
        by half a metre at a time.
    caution : float
        How much more steps near obstacles cost, see :func:`plan`.

    Notes
    -----
    The cells that tell poses apart are as large as a step, and at least 1 m. Smaller cells give shorter plans with more
    and smaller turns, which are harder to learn from.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import ComputerExpert
    >>> from robonav.robot import Simulator, random_worlds
    >>> ComputerExpert()(Simulator(random_worlds(2, obstacles=0, seed=1)), np.array([0, 1]))
    array([1, 1])
    """

    def __init__(self, margin: float = MARGIN, caution: float = CAUTION) -> None:
        self.margin = check_real(
            "margin", margin, at_least=COLLISION_DISTANCE, at_most=LARGEST_MAP / 2
        )
        self.caution = check_real("caution", caution, at_least=0)
        self._plans: dict[int, FollowedPlan] = {}

    def __call__(self, simulator: Simulator, robots: Actions) -> Actions:
        """Return the next actions (n,) of the robots with these indices (n,)."""
        return np.array(
            [self.next_action(simulator, int(robot)) for robot in robots],
            dtype=np.int64,
        )

    def next_action(self, simulator: Simulator, robot: int) -> int:
        """Return the next action of the plan that a robot follows; plan again if that plan no longer holds.

        Parameters
        ----------
        simulator : Simulator
            Its worlds and poses are read.
        robot : int
            The robot's index.

        Returns
        -------
        int
            One of the six actions.

        Examples
        --------
        >>> from robonav.lfd import ComputerExpert
        >>> from robonav.robot import Action, Simulator, make_world
        >>> simulator = Simulator(make_world(start=(10, 10), target=(10, 90)))
        >>> Action(ComputerExpert().next_action(simulator, 0)).name
        'F'
        """
        followed = self._plans.get(robot)
        if followed is None or not followed.holds_for(simulator, robot):
            followed = self._plans[robot] = self.plan_from(simulator, robot)
        followed.done += 1
        return int(followed.actions[followed.done - 1])

    def plan_from(self, simulator: Simulator, robot: int) -> FollowedPlan:
        """Plan from where a robot is, with the largest margin that leaves a path; if none does, go straight on.

        Parameters
        ----------
        simulator : Simulator
            Its worlds and poses are read.
        robot : int
            The robot's index.

        Returns
        -------
        FollowedPlan
            Its ``actions``, ``poses`` and ``target``.

        Examples
        --------
        >>> from robonav.lfd import ComputerExpert
        >>> from robonav.robot import Simulator, make_world
        >>> simulator = Simulator(make_world(start=(10, 10), target=(10, 90)), speed=4.0)
        >>> len(ComputerExpert().plan_from(simulator, 0).actions)
        20
        """
        world, pose = simulator.worlds, simulator.poses[robot].copy()
        target, centres = world.targets[robot].copy(), simulator.centres[robot].copy()
        obstacles = world.kinds[robot], world.shapes[robot], centres, world.size
        cell = max(simulator.speed, MOVE)
        steps = steps_in_move(simulator.speed, cell)
        move = steps * simulator.speed
        margins = np.arange(self.margin, COLLISION_DISTANCE, -MARGIN_STEP)
        for margin in np.append(margins, COLLISION_DISTANCE):
            found, poses, actions = search(
                obstacles, pose, target, move, margin, self.caution, cell
            )
            if found:
                poses, actions = as_single_steps(poses, actions, steps, target)
                return FollowedPlan(poses, actions, target, centres)
        straight_on = np.zeros(1, dtype=np.int64)
        return FollowedPlan(pose[None], straight_on, target, centres)


def search(
    obstacles: tuple[Any, ...],
    pose: Floats,
    target: Floats,
    move: float,
    margin: float,
    caution: float,
    cell: float,
) -> tuple[bool, Floats, Actions]:
    """Search for a path by the compiled twin of modified A*, without a record of the nodes expanded.

    Parameters
    ----------
    obstacles : tuple
        Kinds (M,), shapes (M, 3) and centres (M, 2) of the obstacles, and the side of the map.
    pose : (3,) array
        x, y and heading to start from.
    target : (2,) array
        x and y.
    move : float
        Length of a move in metres.
    margin, caution, cell : float
        See :func:`plan`.

    Returns
    -------
    found : bool
    poses : (K + 1, 3) array
    actions : (K,) array of int

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd.computer_expert import search
    >>> from robonav.robot import make_world
    >>> world = make_world(start=(10, 10), target=(10, 90))
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0], world.size
    >>> found, _, actions = search(obstacles, world.start_poses[0], world.targets[0], 4.0, 1.0, 0.0, 4.0)
    >>> found, len(actions)
    (True, 20)
    """
    found, poses, actions, _ = _fast.search_actions(
        *obstacles, pose, target, move, margin, caution, cell, LIMIT, False, np.empty((0, 3))
    )  # fmt: skip
    return found, poses, actions


def demonstrate(
    worlds: Worlds,
    *,
    speed: float = 2.0,
    margin: float = MARGIN,
    caution: float = CAUTION,
    slip: ArrayLike | None = None,
    reflex: ReflexRule | None = REFLEX,
    progress: Progress | None = None,
) -> Demonstrations:
    """Record demonstrations by the computer expert, one in each of D worlds.

    The robot keeps its reflexes: in a safe state it turns to the target and goes, and where it is blocked it steps
    back. Everywhere else it takes the first action of a plan from where it is.

    Parameters
    ----------
    worlds : Worlds
        Batch of D.
    speed : float
        Of the robots, in m/s.
    margin, caution : float
        How far plans keep from obstacles and borders, see :class:`ComputerExpert`.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another one (Fig. 5.5). The actions executed are recorded.
    reflex : callable, optional
        What the robot does before the expert is asked, see :class:`robonav.robot.Reflex`.
    progress : callable, optional
        Called as ``progress(worlds done, D)``.

    Returns
    -------
    Demonstrations

    Raises
    ------
    TypeError
        If ``worlds`` is not Worlds, or an argument is not a number.
    ValueError
        If an argument is out of bounds, or if a world has no path to the target.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrate(random_worlds(2, obstacles=10, seed=1)).outcome.tolist()
    ['arrived', 'arrived']
    """
    check_real(
        "margin", margin, at_most=check_instance("worlds", worlds, Worlds).size / 2
    )
    recorded = record_demonstrations(
        ComputerExpert(margin, caution),
        worlds,
        speed=speed,
        slip=slip,
        reflex=reflex,
        progress=progress,
    )
    failed = (recorded.outcome != "arrived") & ~worlds.speeds.any(axis=1)
    for number in np.flatnonzero(failed):
        if not plan(worlds[number], speed=speed, margin=COLLISION_DISTANCE).found:
            raise ValueError(
                f"worlds[{number}] must have a path from start to target at {speed:g} m/s, and has none"
            )
    return recorded
