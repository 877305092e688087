"""The computer expert, who knows the map and plans in it (sections 3.5 and 5.5.5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.robot import COLLISION_DISTANCE, Simulator, Worlds
from robonav.robot.worlds import LARGEST_MAP
from robonav.validation import check_instance, check_real

from . import _fast
from .astar import plan
from .demonstrations import Actions, Demonstrations, record

MARGIN, CAUTION = (
    3.0,
    2.0,
)  # what is learned depends on nothing as much as on the distance that the expert keeps
SHRINK = 0.5  # metres that the margin gives way by, where it leaves no path
LIMIT = 50_000  # nodes to expand: many times what a path takes

_NOBODY = np.empty((0, 3))


@dataclass
class FollowedPlan:
    """A plan that a robot is following: its poses and actions, and how far it is."""

    poses: NDArray[np.float64]
    actions: Actions
    done: int = 0

    def follows(self, pose: NDArray[np.float64]) -> bool:
        """Whether the robot is where the plan has it next, with something left to do."""
        return self.done < len(self.actions) and bool(
            np.abs(self.poses[self.done] - pose).max() < 1e-6
        )


class ComputerExpert:
    """Plans with modified A* from where the robot is, follows the plan, and plans anew where the robot has left it.

    Parameters
    ----------
    margin : distance in metres that plans keep from obstacles and borders; where that leaves no path it gives way by
        half a metre at a time.
    caution : how much they shun what is in sensor range, see :func:`plan`.

    Notes
    -----
    Poses of one heading less than a step apart count as one node. Finer cells give shorter plans with more and smaller
    turns, which are harder to learn from.
    """

    def __init__(self, margin: float = MARGIN, caution: float = CAUTION) -> None:
        self.margin = check_real(
            "margin", margin, at_least=COLLISION_DISTANCE, at_most=LARGEST_MAP / 2
        )
        self.caution = check_real("caution", caution, at_least=0)
        self._plans: dict[int, FollowedPlan] = {}

    def __call__(self, simulator: Simulator, asked: Actions) -> Actions:
        """The next actions (n,) of the robots ``asked`` (n,)."""
        return np.array(
            [self._next(simulator, int(robot)) for robot in asked], dtype=np.int64
        )

    def _next(self, simulator: Simulator, robot: int) -> int:
        way = self._plans.get(robot)
        if (
            way is None
            or not way.follows(simulator.poses[robot])
            or simulator.worlds.speeds[robot].any()
        ):
            way = self._plans[robot] = self.plan_from(simulator, robot)
        way.done += 1
        return int(way.actions[way.done - 1])

    def plan_from(self, simulator: Simulator, robot: int) -> FollowedPlan:
        """A way for one robot from where it is, as wide as there is one; a single step straight on if there is none."""
        world = simulator.worlds
        for margin in np.append(
            np.arange(self.margin, COLLISION_DISTANCE, -SHRINK), COLLISION_DISTANCE
        ):
            found, poses, actions, _ = _fast.search_actions(
                world.kinds[robot], world.shapes[robot], simulator.centres[robot], world.size, simulator.poses[robot],
                world.targets[robot], simulator.speed, margin, self.caution, simulator.speed, LIMIT, False, _NOBODY,
            )  # fmt: skip
            if found:
                return FollowedPlan(poses, actions)
        return FollowedPlan(simulator.poses[robot][None], np.zeros(1, dtype=np.int64))


def demonstrate(
    worlds: Worlds,
    *,
    speed: float = 2.0,
    margin: float = MARGIN,
    caution: float = CAUTION,
    slip: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Demonstrations:
    """Demonstrations by the computer expert, one in each of D worlds.

    The expert keeps the robot's own convention: in a safe state it turns to the target and goes, blocked it steps
    back, else it does the first action of a plan from here.

    Parameters
    ----------
    worlds : batch of D.
    speed : m/s.
    margin, caution : how far plans keep from obstacles and borders, see :class:`ComputerExpert`.
    slip : (6, 6) probabilities that action a (row) turns into another: a slipping expert, Fig. 5.5.

    Raises
    ------
    TypeError : if ``worlds`` are no worlds, or an argument is no number.
    ValueError : if an argument is out of bounds, or the expert failed in a world where there is no way to the target.
    """
    check_real(
        "margin", margin, at_most=check_instance("worlds", worlds, Worlds).size / 2
    )
    shown = record(
        ComputerExpert(margin, caution),
        worlds,
        speed=speed,
        slip=slip,
        progress=progress,
    )
    for lost in np.flatnonzero(
        (shown.outcome != "arrived") & ~worlds.speeds.any(axis=1)
    ):
        if not plan(worlds[lost], speed=speed, margin=COLLISION_DISTANCE).found:
            raise ValueError(
                f"worlds[{lost}] must have a way from start to target at {speed:g} m/s, and has none"
            )
    return shown
