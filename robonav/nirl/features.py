"""From state features to state-action features, one block an action: Eq. (5.5), (5.6)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_integer

Floats = NDArray[np.float64]


def all_action_features(state_features: ArrayLike, actions: int) -> Floats:
    """The features f(s, a) of every action: (M, A, A k), zero but for the block of ``a``, which holds phi(s).

    Eq. (5.5), (5.6). With them the reward theta . f(s, a) is theta_a . phi(s): a linear function of the state for
    each action.

    Parameters
    ----------
    state_features : phi(s) of M states, (M, k).
    actions : A.
    """
    phi = check_array("state_features", state_features, shape=("M", "k"))
    count = check_integer("actions", actions, at_least=1)
    m, k = phi.shape
    blocks = np.zeros((m, count, count, k))
    own = np.arange(count)
    blocks[:, own, own] = phi[:, None]
    return blocks.reshape(m, count, count * k)


def state_action_features(
    state_features: ArrayLike, chosen: ArrayLike, actions: int
) -> Floats:
    """The features f(s_t, a_t) of one action a state: (M, A k), from phi(s_t) (M, k) and a_t (M,)."""
    phi = check_array("state_features", state_features, shape=("M", "k"))
    taken = check_array("chosen", chosen, shape=(len(phi),), dtype=np.int64)
    if len(taken) and not 0 <= taken.min() <= taken.max() < actions:
        raise ValueError(
            f"chosen must hold actions from 0 to {actions - 1}, got {taken.min()} to {taken.max()}"
        )
    blocks = np.zeros((len(phi), actions, phi.shape[1]))
    blocks[np.arange(len(phi)), taken] = phi
    return blocks.reshape(len(phi), -1)
