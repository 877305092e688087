"""Summary statistics of a set of demonstrations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.counting import counted
from robonav.robot import SENSOR_RANGE, Action, lfd_state
from robonav.validation import check_instance

from .demonstrations import LEARNED, Demonstrations


@dataclass(frozen=True, eq=False)
class DatasetSummary:
    """Summary statistics of a set of demonstrations. ``str`` writes them as four lines of text.

    Attributes
    ----------
    trajectories, arrived : int
        Number of trajectories, and number of those that reached the target.
    steps, effective : int
        Number of steps, and number of effective pairs among them.
    states : int
        Number of distinct states in the effective pairs, each written as the 11 numbers of Eq. (3.17).
    actions : (5,) array of int
        Number of effective pairs with each of the actions F, L30, L60, R30, R60.
    closest : float
        The smallest range that any sensor measured, in metres.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, summarise_dataset
    >>> from robonav.robot import random_worlds
    >>> summarise_dataset(demonstrate(random_worlds(2, obstacles=10, seed=1))).arrived
    2
    """

    trajectories: int
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
            f"{counted(self.trajectories, 'trajectory', 'trajectories')}, {self.arrived} arrived\n"
            f"{counted(self.steps, 'step')}, {counted(self.effective, 'effective pair')} in "
            f"{counted(self.states, 'distinct state')}\n"
            f"{shares}\n"
            f"smallest range {self.closest:.1f} m"
        )


def summarise_dataset(demonstrations: Demonstrations) -> DatasetSummary:
    """Summarise a set of demonstrations.

    Parameters
    ----------
    demonstrations : Demonstrations
        By any expert.

    Returns
    -------
    DatasetSummary

    Raises
    ------
    TypeError
        If ``demonstrations`` is not Demonstrations.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, summarise_dataset
    >>> from robonav.robot import random_worlds
    >>> str(summarise_dataset(demonstrate(random_worlds(2, obstacles=10, seed=1)))).splitlines()[0]
    '2 trajectories, 2 arrived'
    """
    pairs = check_instance("demonstrations", demonstrations, Demonstrations).effective
    return DatasetSummary(
        trajectories=len(demonstrations.worlds),
        arrived=int((demonstrations.outcome == "arrived").sum()),
        steps=len(demonstrations),
        effective=len(pairs),
        states=len(np.unique(lfd_state(pairs.sensing), axis=0)),
        actions=np.bincount(pairs.actions, minlength=LEARNED),
        closest=float(demonstrations.sensing.ranges.min(initial=SENSOR_RANGE)),
    )
