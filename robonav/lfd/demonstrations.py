"""Demonstrations: what an expert's robot sensed, and what it did (section 3.4.1)."""

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
    Reflex,
    Sensing,
    Simulator,
    Worlds,
    drive,
)
from robonav.robot.worlds import concatenate as concatenate_worlds
from robonav.validation import check_array, check_integer, check_one_of, check_positive

Floats = NDArray[np.float64]
Actions = NDArray[np.int64]

LEARNED = 5  # actions: F, L30, L60, R30, R60
MAX_STEPS = 500


@dataclass(frozen=True, eq=False)
class Demonstrations:
    """K steps of D trajectories, one trajectory after the other; ``demonstrations[mask]`` selects steps.

    All sensing is kept raw, so that each chapter can encode it in its own way.

    Attributes
    ----------
    worlds : Worlds
        Batch of D.
    trajectory : (K,) array of int
        The trajectory that each step belongs to, ascending.
    sensing : Sensing
        K rows, as perceived before each action.
    actions : (K,) array of int
        The actions executed; ``Action.TO_TARGET`` and ``Action.B`` where the robot's reflex acted.
    poses : (K, 3) array
        x, y and heading before each action.
    speed : float
        Metres a second.
    outcome : (D,) array of str
        How each trajectory ended: "arrived", "collided" or "out of steps".

    Raises
    ------
    ValueError
        If shapes do not fit, or numbers lie outside their range.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(3, obstacles=10, seed=1))
    >>> len(shown) == shown.lengths.sum(), len(shown.select_trajectories([0, 2]).worlds)
    (np.True_, 2)
    """

    worlds: Worlds
    trajectory: Actions
    sensing: Sensing
    actions: Actions
    poses: Floats
    speed: float
    outcome: NDArray[np.str_]

    def __post_init__(self) -> None:
        drives, steps = len(self.worlds), len(self.sensing)
        wanted: dict[str, tuple[tuple[int, ...], Any]] = {
            "trajectory": ((steps,), np.int64),
            "actions": ((steps,), np.int64),
            "poses": ((steps, 3), np.float64),
            "outcome": ((drives,), np.str_),
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
                "demonstrations: trajectory must ascend, one drive after the other"
            )
        for name, values, most in (
            ("trajectory", self.trajectory, drives - 1),
            ("actions", self.actions, max(Action)),
        ):
            if steps and not 0 <= values.min() <= values.max() <= most:
                raise ValueError(
                    f"demonstrations: {name} must lie in 0..{most}, got {values.min()}..{values.max()}"
                )
        for outcome in np.unique(self.outcome):
            check_one_of("demonstrations: outcome", outcome, OUTCOMES[1:])

    def __len__(self) -> int:
        return len(self.actions)

    def __getitem__(self, index: slice | NDArray[Any]) -> Demonstrations:
        """Select some of the steps, in their order; the worlds and outcomes stay."""
        steps = {
            name: getattr(self, name)[index]
            for name in ("trajectory", "sensing", "actions", "poses")
        }
        return replace(self, **steps)

    @property
    def effective(self) -> Demonstrations:
        """The effective pairs to learn from: steps with something in range and one of the five learned actions."""
        return self[~self.sensing.safe & (self.actions < LEARNED)]

    @property
    def lengths(self) -> Actions:
        """Number of steps (D,) of each trajectory."""
        return np.bincount(self.trajectory, minlength=len(self.worlds))

    def select_trajectories(self, index: ArrayLike) -> Demonstrations:
        """Select whole trajectories by indices or a mask; they are numbered from 0 again."""
        chosen = np.arange(len(self.worlds))[np.asarray(index)]
        none = np.empty(0, np.int64)
        rows = np.concatenate(
            [none, *(np.flatnonzero(self.trajectory == drive) for drive in chosen)]
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
"""``expert(simulator, asked)`` returns the actions (n,) that the robots ``asked`` (n,) should take now."""


def record(
    expert: Expert,
    worlds: Worlds,
    *,
    speed: float = 2.0,
    slip: ArrayLike | None = None,
    reflex: Reflex | None = REFLEX,
    labeller: Expert | None = None,
    max_steps: int = MAX_STEPS,
    progress: Progress | None = None,
) -> Demonstrations:
    """Let an expert drive one robot through each of D worlds, and record what the robot sensed and did.

    Parameters
    ----------
    expert : callable
        Chooses the action where the reflex does not decide.
    worlds : Worlds
        Batch of D.
    speed : float
        Metres a second, positive.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another. The action executed is the one recorded.
    reflex : callable, optional
        What the robot does before the expert is asked. None leaves every step to the expert.
    labeller : callable, optional
        Another expert, who does not drive. It is asked about the same states, and its actions are recorded instead.
    max_steps : int
        Seconds after which an episode is out of steps.
    progress : callable, optional
        Called as ``progress(worlds done, D)``.

    Returns
    -------
    Demonstrations

    Raises
    ------
    ValueError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.lfd import ComputerExpert, record
    >>> from robonav.robot import random_worlds
    >>> record(ComputerExpert(), random_worlds(2, obstacles=10, seed=1)).outcome.tolist()
    ['arrived', 'arrived']
    """
    check_integer("max_steps", max_steps, at_least=1)
    simulator = Simulator(worlds, speed, slip=slip, max_steps=max_steps)
    advice = np.zeros(len(worlds), dtype=np.int64)

    def choose(simulator: Simulator, sensing: Sensing, robots: Actions) -> Actions:
        if labeller is not None:
            advice[robots] = labeller(simulator, robots)
        return expert(simulator, robots)

    rows: list[tuple[Actions, Sensing, Actions, Floats]] = []
    for second in drive(simulator, choose, reflex=reflex):
        done = second.executed if labeller is None else advice[second.robots]
        actions = np.where(second.asked, done, second.actions)
        rows.append((second.robots, second.sensing, actions, second.poses))
        if progress is not None:
            progress(len(worlds) - len(second.robots), len(worlds))
    return _by_drive(worlds, rows, speed, OUTCOMES[simulator.outcome])


def concatenate(sets: Sequence[Demonstrations]) -> Demonstrations:
    """Concatenate sets of demonstrations; the trajectories are numbered on.

    Parameters
    ----------
    sets : sequence of Demonstrations

    Returns
    -------
    Demonstrations

    Raises
    ------
    ValueError
        If there is no set, or speeds or map sizes differ.

    Examples
    --------
    >>> from robonav.lfd import concatenate, demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> len(concatenate([shown, shown]).worlds)
    4
    """
    if not sets or len({each.speed for each in sets}) > 1:
        raise ValueError(
            f"sets must be at least one, of one speed, got {[each.speed for each in sets]}"
        )
    before = np.cumsum([0, *(len(each.worlds) for each in sets)])
    return Demonstrations(
        worlds=concatenate_worlds([each.worlds for each in sets]),
        trajectory=np.concatenate(
            [each.trajectory + n for each, n in zip(sets, before[:-1], strict=True)]
        ),
        sensing=_sensings([each.sensing for each in sets]),
        actions=np.concatenate([each.actions for each in sets]),
        poses=np.concatenate([each.poses for each in sets]),
        speed=sets[0].speed,
        outcome=np.concatenate([each.outcome for each in sets]),
    )


def actions_from_poses(before: Floats, after: Floats) -> Actions:
    """The actions (N,) that led from poses ``before`` to ``after`` (N, 3): by the turn, or B where it went back."""
    turned = np.rint((after[:, 2] - before[:, 2]) / np.radians(30)).astype(int) % 12
    actions = np.select(
        [turned == 1, turned == 2, turned == 11, turned == 10],
        [Action.L30, Action.L60, Action.R30, Action.R60],
    )
    way = np.column_stack([np.cos(after[:, 2]), np.sin(after[:, 2])])
    backward = ((after[:, :2] - before[:, :2]) * way).sum(axis=1) < 0
    return np.where(backward, Action.B, actions)


def _sensings(parts: Sequence[Sensing]) -> Sensing:
    """Rows of several as one."""
    return Sensing(
        *(
            np.concatenate([getattr(part, field.name) for part in parts])
            for field in fields(Sensing)
        )
    )


def _by_drive(
    worlds: Worlds,
    rows: list[tuple[Actions, Sensing, Actions, Floats]],
    speed: float,
    outcome: NDArray[np.str_],
) -> Demonstrations:
    """Steps by drive from steps by time."""
    nothing = (
        np.empty(0, np.int64),
        Sensing.empty(0),
        np.empty(0, np.int64),
        np.empty((0, 3)),
    )
    owners, sensed, actions, poses = zip(nothing, *rows, strict=True)
    drives = np.concatenate(owners)
    order = np.argsort(drives, kind="stable")
    return Demonstrations(
        worlds=worlds,
        trajectory=drives[order],
        sensing=_sensings(sensed)[order],
        actions=np.concatenate(actions)[order],
        poses=np.concatenate(poses)[order],
        speed=speed,
        outcome=outcome,
    )
