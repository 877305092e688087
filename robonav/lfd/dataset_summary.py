"""What a set of demonstrations holds, in a few numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.robot import SENSOR_RANGE, Action, lfd_state
from robonav.validation import check_instance

from .demonstrations import LEARNED, Demonstrations


@dataclass(frozen=True, eq=False)
class DatasetSummary:
    """A set of demonstrations in a few numbers; as text, a few lines.

    Attributes
    ----------
    drives, arrived : how many drives, and how many of them reached the target.
    steps, effective : how many steps, and how many of them are learned from.
    states : how many different states of 11 numbers, Eq. (3.17), these are.
    actions : (5,) how often they hold each of F, L30, L60, R30, R60.
    closest : the least that any sensor read, in metres.
    """

    drives: int
    arrived: int
    steps: int
    effective: int
    states: int
    actions: NDArray[np.int64]
    closest: float

    def __str__(self) -> str:
        shares = ", ".join(
            f"{Action(action).name} {count / max(self.effective, 1):.0%}"
            for action, count in enumerate(self.actions)
        )
        return (
            f"{self.drives} drives, {self.arrived} arrived\n"
            f"{self.steps} steps, {self.effective} to learn from, in {self.states} different states\n"
            f"{shares}\n"
            f"nothing nearer than {self.closest:.1f} m"
        )


def summarise_dataset(demonstrations: Demonstrations) -> DatasetSummary:
    """Sum up a set of demonstrations.

    Raises
    ------
    TypeError : if these are no demonstrations.
    """
    pairs = check_instance("demonstrations", demonstrations, Demonstrations).effective
    return DatasetSummary(
        drives=len(demonstrations.worlds),
        arrived=int((demonstrations.outcome == "arrived").sum()),
        steps=len(demonstrations),
        effective=len(pairs),
        states=len(np.unique(lfd_state(pairs.sensing), axis=0)),
        actions=np.bincount(pairs.actions, minlength=LEARNED),
        closest=float(demonstrations.sensing.ranges.min(initial=SENSOR_RANGE)),
    )
