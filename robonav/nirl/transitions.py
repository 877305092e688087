"""Decisions of a driver, laid end to end: what inverse reinforcement learning sees of experts and learners alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.lfd.demonstrations import LEARNED, Demonstrations
from robonav.robot import NNQL_SENSORS, Encoder
from robonav.validation import check_array

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ENCODER = Encoder(NNQL_SENSORS, walls=True)
"""phi(s) of section 5.4.1: seven degrees of danger, the target's sector as sine and cosine, target seen, wall flags."""


@dataclass(frozen=True, eq=False)
class Steps:
    """M decisions of N drives, one drive after the other. Steps that the robot's reflexes took are not among them.

    Attributes
    ----------
    inputs : phi(s_t), (M, k).
    actions : (M,) 0 to A - 1.
    trajectory : (M,) the drive that each belongs to, ascending from 0 to N - 1; a drive may have no decisions.
    when : (M,) seconds into its drive, those of reflexes counted.
    failed : (N,) whether the drive ended in a collision.
    arrived : (N,) whether it reached its target.
    """

    inputs: Floats
    actions: Ints
    trajectory: Ints
    when: Ints
    failed: NDArray[np.bool_]
    arrived: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.actions)

    @property
    def features(self) -> Floats:
        """phi(s_t) and a constant 1, (M, k + 1): the bias unit of section 5.4.2, for rewards to use as well."""
        return with_constant(self.inputs)

    @property
    def after(self) -> Ints:
        """(M,) the next decision of the same drive, -1 where there is none."""
        following = np.arange(1, len(self) + 1)
        last = np.append(self.trajectory[1:] != self.trajectory[:-1], True)[: len(self)]
        return np.where(last, -1, following)

    def with_actions(self, actions: ArrayLike) -> Steps:
        """The same states with other actions: refined ones."""
        return replace(
            self,
            actions=check_array("actions", actions, shape=(len(self),), dtype=np.int64),
        )


def with_constant(inputs: Floats) -> Floats:
    """Inputs (M, k) and a column of ones."""
    return np.concatenate([inputs, np.ones((len(inputs), 1))], axis=1)


def joined(parts: Sequence[Steps]) -> Steps:
    """Several as one, their drives numbered through."""
    drives = np.cumsum([0] + [len(part.failed) for part in parts])
    columns: dict[str, Any] = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts])
        for field in fields(Steps)
    }
    columns["trajectory"] = np.concatenate(
        [part.trajectory + d for part, d in zip(parts, drives, strict=False)]
    )
    return Steps(**columns)


def expert_transitions(
    demonstrations: Demonstrations, encoder: Encoder = ENCODER
) -> Steps:
    """What an expert decided: the effective pairs of its demonstrations.

    Raises
    ------
    ValueError : if there is none.
    """
    first = np.searchsorted(
        demonstrations.trajectory, np.arange(len(demonstrations.worlds))
    )
    when = np.arange(len(demonstrations)) - first[demonstrations.trajectory]
    pairs = demonstrations.effective
    if len(pairs) == 0:
        raise ValueError(
            "demonstrations must hold an effective pair, a step with something in range and one of the five learned "
            f"actions, got none in {len(demonstrations)} steps"
        )
    return Steps(
        encoder(pairs.sensing),
        pairs.actions,
        pairs.trajectory,
        when[~demonstrations.sensing.safe & (demonstrations.actions < LEARNED)],
        demonstrations.outcome == "collided",
        demonstrations.outcome == "arrived",
    )
