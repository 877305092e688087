"""Mending demonstrations that contradict themselves: one action a state, by maximum a posteriori (Eq. (5.12))."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_integer

Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Refined:
    """What a refinement made of M steps.

    Attributes
    ----------
    actions : (M,) the action given to each step: the same for all steps in the same state.
    changed : (M,) whether that is another action than was shown.
    states : number of different states among the steps.
    inconsistent : number of those in which more than one action was shown.
    """

    actions: Ints
    changed: NDArray[np.bool_]
    states: int
    inconsistent: int


def counts(states: ArrayLike, shown: ArrayLike, actions: int) -> tuple[Ints, Ints]:
    """How often each action was shown in each different state: (D, A), and which of the D each step is in, (M,).

    Parameters
    ----------
    states : (M, k) states as whole numbers, or (M,); equal rows are equal states.
    shown : (M,) actions.
    actions : A.

    Raises
    ------
    ValueError : if there is no step, shapes do not fit, or an action does not exist.
    """
    own = check_array("shown", shown, shape=("M",), dtype=np.int64)
    if len(own) == 0:
        raise ValueError(
            "states must hold at least one step, got none: were all of them filtered out?"
        )
    if not 0 <= own.min() <= own.max() < check_integer("actions", actions, at_least=1):
        raise ValueError(
            f"shown must hold actions from 0 to {actions - 1}, got {own.min()} to {own.max()}"
        )
    rows = np.asarray(states)
    if len(rows) != len(own):
        raise ValueError(
            f"states must be as many as the actions shown, {len(own)}, got {len(rows)}"
        )
    _, which = np.unique(rows, axis=0, return_inverse=True)
    which = which.reshape(len(own))
    table = np.zeros((which.max() + 1, actions), dtype=np.int64)
    np.add.at(table, (which, own), 1)
    return table, which


def most_frequent(states: ArrayLike, shown: ArrayLike, actions: int) -> Refined:
    """Give every step the action shown most often in its state: argmax_a P(s | a) P(a), Eq. (5.12).

    With the prior counted from the same demonstrations, P(s | a) P(a) = P(s, a) is the share of the pair among all
    steps. Of equally frequent actions the first. Arguments as in :func:`counts`.
    """
    table, which = counts(states, shown, actions)
    return _refined(table, which, table, shown)


def map_uniform_prior(states: ArrayLike, shown: ArrayLike, actions: int) -> Refined:
    """Give every step the action under which its state is likeliest: argmax_a P(s | a), Eq. (5.12), uniform prior.

    The thesis says that this too is the action shown most often. It is not: an action that is rarely shown at all, once
    in this state, wins over one that is shown here ten times and elsewhere a thousand times.
    """
    table, which = counts(states, shown, actions)
    likelihood = table / np.maximum(table.sum(axis=0), 1)
    return _refined(likelihood, which, table, shown)


def _refined(score: NDArray, which: Ints, table: Ints, shown: ArrayLike) -> Refined:
    actions = score.argmax(axis=1)[which]
    return Refined(
        actions,
        actions != np.asarray(shown),
        len(table),
        int(((table > 0).sum(axis=1) > 1).sum()),
    )
