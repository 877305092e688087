"""Demonstrations: the states that an expert's robot sensed and the actions that it took (section 3.4.1)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.robot import (
    OUTCOMES,
    REFLEX,
    Action,
    ReflexRule,
    Sensing,
    Simulator,
    Transition,
    Worlds,
    run_episodes,
)
from robonav.robot.worlds import concatenate_worlds
from robonav.validation import (
    check_array,
    check_callable,
    check_integer,
    check_one_of,
    check_positive,
)

Floats = NDArray[np.float64]
Actions = NDArray[np.int64]

LEARNED = 5  # number of actions that a policy learns: F, L30, L60, R30, R60
MAX_STEPS = 500


@dataclass(frozen=True, eq=False)
class Demonstrations:
    """K steps of D trajectories, one trajectory after the other.

    ``demonstrations[mask]`` selects steps. Sensing is kept raw, so that each chapter can encode it in its own way.

    Attributes
    ----------
    worlds : Worlds
        Batch of D.
    trajectory : (K,) array of int
        The number of the trajectory that each step belongs to, ascending.
    sensing : Sensing
        K rows: what the robot sensed before each action.
    actions : (K,) array of int
        The actions taken; ``Action.TO_TARGET``, ``Action.TO_SECTOR`` or ``Action.B`` where the robot's reflex acted.
    poses : (K, 3) array
        x, y and heading before each action.
    speed : float
        Of the robots, in m/s.
    outcome : (D,) array of str
        How each trajectory ended: "arrived", "collided" or "out of steps".

    Raises
    ------
    ValueError
        If shapes do not fit, or if numbers lie outside their range.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(3, obstacles=10, seed=1))
    >>> demonstrations.lengths.sum() == len(demonstrations)
    np.True_
    >>> len(demonstrations.select_trajectories([0, 2]).worlds)
    2
    """

    worlds: Worlds
    trajectory: Actions
    sensing: Sensing
    actions: Actions
    poses: Floats
    speed: float
    outcome: NDArray[np.str_]

    def __post_init__(self) -> None:
        trajectories, steps = len(self.worlds), len(self.sensing)
        wanted: dict[str, tuple[tuple[int, ...], Any]] = {
            "trajectory": ((steps,), np.int64),
            "actions": ((steps,), np.int64),
            "poses": ((steps, 3), np.float64),
            "outcome": ((trajectories,), np.str_),
        }
        for name, (shape, dtype) in wanted.items():
            checked = check_array(
                f"demonstrations: {name}", getattr(self, name), shape=shape, dtype=dtype
            )
            object.__setattr__(self, name, checked)
        object.__setattr__(
            self, "speed", check_positive("demonstrations: speed", self.speed)
        )
        if steps and (np.diff(self.trajectory) < 0).any():
            raise ValueError(
                "demonstrations: trajectory must ascend, one trajectory after the other"
            )
        for name, values, most in (
            ("trajectory", self.trajectory, trajectories - 1),
            ("actions", self.actions, max(Action)),
        ):
            if steps and not 0 <= values.min() <= values.max() <= most:
                raise ValueError(
                    f"demonstrations: {name} must lie in 0..{most}, got {values.min()}..{values.max()}"
                )
        here, size = self.poses[:, :2], self.worlds.size
        if ((here < 0) | (here > size)).any():
            raise ValueError(
                f"demonstrations: poses must have x and y in 0..{size:g}, got {here.min():g}..{here.max():g}"
            )
        for outcome in np.unique(self.outcome):
            check_one_of("demonstrations: outcome", outcome, OUTCOMES[1:])

    def __len__(self) -> int:
        return len(self.actions)

    def __getitem__(self, index: slice | NDArray[Any]) -> Demonstrations:
        """Select some of the steps, in their order. All worlds and outcomes are kept."""
        if not isinstance(index, slice) and np.ndim(index) != 1:
            raise TypeError(
                f"steps are selected by a slice, a list or a mask, got {index!r}"
            )
        steps = {
            name: getattr(self, name)[index]
            for name in ("trajectory", "sensing", "actions", "poses")
        }
        return replace(self, **steps)

    @property
    def effective(self) -> Demonstrations:
        """The effective pairs: the steps in which something was in range and the action was one of the five learned."""
        return self[~self.sensing.safe & (self.actions < LEARNED)]

    @property
    def lengths(self) -> Actions:
        """Number of steps (D,) of each trajectory."""
        return np.bincount(self.trajectory, minlength=len(self.worlds))

    def select_trajectories(self, index: ArrayLike) -> Demonstrations:
        """Select whole trajectories by an index, indices or a mask, and number them from 0.

        Parameters
        ----------
        index : int or slice or (K,) array of int or (N,) array of bool
            Which of the N trajectories.

        Returns
        -------
        Demonstrations
            Theirs alone.

        Examples
        --------
        >>> from robonav.lfd import demonstrate
        >>> from robonav.robot import random_worlds
        >>> three = demonstrate(random_worlds(3, obstacles=5, seed=1))
        >>> len(three.select_trajectories([0, 2]).worlds)
        2
        """
        chosen = np.atleast_1d(np.arange(len(self.worlds))[np.asarray(index)])
        none = np.empty(0, np.int64)
        rows = np.concatenate(
            [none, *(np.flatnonzero(self.trajectory == number) for number in chosen)]
        )
        return replace(
            self,
            worlds=self.worlds[chosen],
            trajectory=np.repeat(np.arange(len(chosen)), self.lengths[chosen]),
            sensing=self.sensing[rows],
            actions=self.actions[rows],
            poses=self.poses[rows],
            outcome=self.outcome[chosen],
        )


Expert = Callable[[Simulator, Actions], Actions]
"""``expert(simulator, robots)`` returns the actions (n,) that the robots with these indices (n,) should take now."""


def record_demonstrations(
    expert: Expert,
    worlds: Worlds,
    *,
    speed: float = 2.0,
    slip: ArrayLike | None = None,
    intended: bool = False,
    reflex: ReflexRule | None = REFLEX,
    max_steps: int = MAX_STEPS,
    progress: Progress | None = None,
) -> Demonstrations:
    """Record demonstrations by any expert: one episode in each of D worlds.

    Parameters
    ----------
    expert : callable
        Chooses the actions where the reflex does not decide.
    worlds : Worlds
        Batch of D.
    speed : float
        Of the robots, in m/s; positive.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another one.
    intended : bool
        Whether to record the actions that the expert chose. By default the actions that the robot executed are
        recorded, which differ where it slipped.
    reflex : callable, optional
        What the robot does before the expert is asked. None leaves every step to the expert.
    max_steps : int
        Seconds after which an episode ends as "out of steps".
    progress : callable, optional
        Called as ``progress(worlds done, D)``.

    Returns
    -------
    Demonstrations

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong type or out of bounds.

    Examples
    --------
    >>> from robonav.lfd import ComputerExpert, record_demonstrations
    >>> from robonav.robot import random_worlds
    >>> record_demonstrations(ComputerExpert(), random_worlds(2, obstacles=10, seed=1)).outcome.tolist()
    ['arrived', 'arrived']
    """
    check_callable("expert", expert, "expert(simulator, robots)")
    check_integer("max_steps", max_steps, at_least=1)
    simulator = Simulator(worlds, speed, slip=slip, max_steps=max_steps)

    def select_actions(
        simulator: Simulator, sensing: Sensing, robots: Actions
    ) -> Actions:
        return expert(simulator, robots)

    steps: list[Transition] = []
    for step in run_episodes(simulator, select_actions, reflex=reflex):
        executed = np.where(step.asked, step.executed, step.actions)  # reflexes stay
        steps.append(step if intended else replace(step, actions=executed))
        if progress is not None:
            progress(len(worlds) - len(step.robots), len(worlds))
    return by_trajectory(simulator, steps)


def concatenate(sets: Sequence[Demonstrations]) -> Demonstrations:
    """Concatenate sets of demonstrations into one, and number their trajectories consecutively.

    Parameters
    ----------
    sets : sequence of Demonstrations
        At least one, all of one speed and one map size.

    Returns
    -------
    Demonstrations

    Raises
    ------
    ValueError
        If there is no set, or if speeds or map sizes differ.

    Examples
    --------
    >>> from robonav.lfd import concatenate, demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> len(concatenate([demonstrations, demonstrations]).worlds)
    4
    """
    if not sets or len({each.speed for each in sets}) > 1:
        raise ValueError(
            "sets must hold at least one set, and all must have the same speed, "
            f"got speeds {[each.speed for each in sets]}"
        )
    before = np.cumsum([0, *(len(each.worlds) for each in sets)])
    return Demonstrations(
        worlds=concatenate_worlds([each.worlds for each in sets]),
        trajectory=np.concatenate(
            [each.trajectory + n for each, n in zip(sets, before[:-1], strict=True)]
        ),
        sensing=_stacked([each.sensing for each in sets]),
        actions=np.concatenate([each.actions for each in sets]),
        poses=np.concatenate([each.poses for each in sets]),
        speed=sets[0].speed,
        outcome=np.concatenate([each.outcome for each in sets]),
    )


def actions_from_poses(before: Floats, after: Floats) -> Actions:
    """Return the actions (N,) that led from poses ``before`` to poses ``after``.

    A step backwards is B. Otherwise the change of heading, rounded to a multiple of 30 degrees, tells the action.

    Parameters
    ----------
    before, after : (N, 3) array
        x, y and heading before and after each action.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd.demonstrations import actions_from_poses
    >>> from robonav.robot import Action
    >>> before, after = np.array([[10, 10, 0]]), np.array([[11.7, 11, np.pi / 6]])
    >>> Action(actions_from_poses(before, after)[0]).name
    'L30'
    """
    turned = np.rint((after[:, 2] - before[:, 2]) / np.radians(30)).astype(int) % 12
    actions = np.select(
        [turned == 1, turned == 2, turned == 11, turned == 10],
        [Action.L30, Action.L60, Action.R30, Action.R60],
    )
    forward = np.column_stack([np.cos(after[:, 2]), np.sin(after[:, 2])])
    went_back = ((after[:, :2] - before[:, :2]) * forward).sum(axis=1) < 0
    return np.where(went_back, Action.B, actions)


def by_trajectory(simulator: Simulator, steps: list[Transition]) -> Demonstrations:
    """Return recorded steps as demonstrations: sorted by robot, and for each robot by time.

    Parameters
    ----------
    simulator : Simulator
        The simulator after its last step.
    steps : list of Transition
        All steps, in the order of time. Their ``actions`` are those to be learned.

    Returns
    -------
    Demonstrations

    Examples
    --------
    >>> from robonav.lfd.demonstrations import by_trajectory
    >>> from robonav.robot import Simulator, run_episodes, follow_policy, random_worlds, straight
    >>> simulator = Simulator(random_worlds(2, obstacles=0, seed=1))
    >>> steps = list(run_episodes(simulator, follow_policy(straight, rng=0)))
    >>> by_trajectory(simulator, steps).lengths
    array([56, 56])
    """
    none = np.empty(0, np.int64)
    trajectory = np.concatenate([none, *(step.robots for step in steps)])
    sensing = _stacked([Sensing.empty(0), *(step.sensing for step in steps)])
    actions = np.concatenate([none, *(step.actions for step in steps)])
    poses = np.concatenate([np.empty((0, 3)), *(step.poses for step in steps)])
    order = np.argsort(trajectory, kind="stable")
    return Demonstrations(
        worlds=simulator.worlds,
        trajectory=trajectory[order],
        sensing=sensing[order],
        actions=actions[order],
        poses=poses[order],
        speed=simulator.speed,
        outcome=OUTCOMES[simulator.outcome],
    )


def _stacked(parts: Sequence[Sensing]) -> Sensing:
    """Return the rows of several as one."""
    return Sensing(
        *(
            np.concatenate([getattr(part, field.name) for part in parts])
            for field in fields(Sensing)
        )
    )
