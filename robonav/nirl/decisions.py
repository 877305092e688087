"""Decisions of an expert or a learner, laid end to end: the data of inverse reinforcement learning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.counting import counted
from robonav.lfd.demonstrations import LEARNED, Demonstrations
from robonav.robot import NNQL_SENSORS, Encoder, Worlds
from robonav.validation import check_array, check_instance

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ENCODER = Encoder(NNQL_SENSORS, walls=True)
"""phi(s) of section 5.4.1, with sine and cosine in place of the number of the target's sector.

Seven degrees of danger, the target's sector, whether the target is seen, and seven wall flags.
"""


@dataclass(frozen=True, eq=False)
class RobotStates:
    """Where the robot was at each of M decisions, so that a simulator can start there.

    Attributes
    ----------
    worlds : Worlds
        One of each trajectory.
    poses : (M, 3) array
        x, y and heading.
    speed : float
        m/s.
    """

    worlds: Worlds
    poses: Floats
    speed: float


@dataclass(frozen=True, eq=False)
class Decisions:
    """M decisions in N episodes, one episode after the other. Steps in which the robot's reflex acted are left out.

    Attributes
    ----------
    inputs : (M, k) array
        phi(s_t).
    actions : (M,) array of int
        0 to A - 1.
    trajectory : (M,) array of int
        The number of each decision's episode, ascending from 0 to N - 1. An episode may have no decisions.
    times : (M,) array of int
        Seconds since the episode began, those of reflexes counted.
    collided : (N,) array of bool
        Whether the episode ended in a collision.
    arrived : (N,) array of bool
        Whether it reached the target.
    states : RobotStates, optional
        Where a simulator can start again, if known.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import expert_decisions
    >>> from robonav.robot import random_worlds
    >>> decisions = expert_decisions(demonstrate(random_worlds(2, obstacles=20, seed=3)))
    >>> decisions.inputs.shape[1], bool(decisions.arrived.all())
    (17, True)
    """

    inputs: Floats
    actions: Ints
    trajectory: Ints
    times: Ints
    collided: NDArray[np.bool_]
    arrived: NDArray[np.bool_]
    states: RobotStates | None = None

    def __len__(self) -> int:
        return len(self.actions)

    @property
    def features(self) -> Floats:
        """phi(s_t) and a constant 1, (M, k + 1): the bias unit of section 5.4.2, which rewards use as well."""
        return add_constant(self.inputs)

    @property
    def next_index(self) -> Ints:
        """(M,) the next decision of the same episode, -1 where there is none."""
        following = np.arange(1, len(self) + 1)
        last = np.append(self.trajectory[1:] != self.trajectory[:-1], True)[: len(self)]
        return np.where(last, -1, following)

    def with_actions(self, actions: ArrayLike) -> Decisions:
        """The same states with other actions, for instance refined ones.

        Parameters
        ----------
        actions : (M,) array of int
            The other actions.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import Decisions
        >>> zero = np.zeros(1, dtype=int)
        >>> Decisions(np.array([[2.0]]), zero, zero, zero, zero, zero).with_actions([3]).actions
        array([3])
        """
        return replace(
            self,
            actions=check_array("actions", actions, shape=(len(self),), dtype=np.int64),
        )


def add_constant(inputs: Floats) -> Floats:
    """Append a column of ones to the inputs (M, k).

    Examples
    --------
    >>> add_constant(np.array([[2.0, 3.0]]))
    array([[2., 3., 1.]])
    """
    return np.concatenate([inputs, np.ones((len(inputs), 1))], axis=1)


def concatenate_decisions(parts: Sequence[Decisions]) -> Decisions:
    """Join several sets of decisions into one, and number their episodes consecutively."""
    offsets = np.cumsum([0] + [len(part.collided) for part in parts])
    trajectories = [
        part.trajectory + offset for part, offset in zip(parts, offsets, strict=False)
    ]
    return Decisions(
        np.concatenate([part.inputs for part in parts]),
        np.concatenate([part.actions for part in parts]),
        np.concatenate(trajectories),
        np.concatenate([part.times for part in parts]),
        np.concatenate([part.collided for part in parts]),
        np.concatenate([part.arrived for part in parts]),
    )


def expert_decisions(
    demonstrations: Demonstrations, encoder: Encoder = ENCODER
) -> Decisions:
    """What an expert decided: the effective pairs of its demonstrations.

    Parameters
    ----------
    demonstrations : Demonstrations
        Of any expert.
    encoder : Encoder
        phi.

    Returns
    -------
    Decisions

    Raises
    ------
    ValueError
        If there is no effective pair.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import expert_decisions
    >>> from robonav.robot import random_worlds
    >>> len(expert_decisions(demonstrate(random_worlds(1, obstacles=20, seed=3)))) > 0
    True
    """
    check_instance("demonstrations", demonstrations, Demonstrations)
    first = np.searchsorted(
        demonstrations.trajectory, np.arange(len(demonstrations.worlds))
    )
    times = np.arange(len(demonstrations)) - first[demonstrations.trajectory]
    pairs = demonstrations.effective
    if len(pairs) == 0:
        raise ValueError(
            "demonstrations must hold an effective pair, a step with something in range and one of the five learned "
            f"actions, got none in {counted(len(demonstrations), 'step')}"
        )
    return Decisions(
        encoder(pairs.sensing),
        pairs.actions,
        pairs.trajectory,
        times[~demonstrations.sensing.safe & (demonstrations.actions < LEARNED)],
        demonstrations.outcome == "collided",
        demonstrations.outcome == "arrived",
        RobotStates(pairs.worlds, pairs.poses, pairs.speed),
    )
