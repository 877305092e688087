"""From features of a state to features of a state and an action, one block for each action (section 5.4.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.validation import ArrayArgument

from ._arguments import checked

Floats = NDArray[np.float64]


@checked
def action_block(
    state_features: ArrayArgument, actions: ArrayArgument, action: int
) -> Floats:
    """Block of one action: phi(s) where this action was taken, 0 elsewhere, Eq. (5.6).

    Parameters
    ----------
    state_features : (M, k) array
        phi(s) of M states.
    actions : (M,) array of int
        The action taken in each.
    action : int
        The action whose block is wanted.

    Returns
    -------
    (M, k) array

    Examples
    --------
    >>> from robonav.nirl import action_block
    >>> action_block([[0.7, 1.0], [0.2, 1.0]], [0, 1], 1)
    array([[0. , 0. ],
           [0.2, 1. ]])
    """
    taken = np.equal(actions, action)[:, None]
    return np.where(taken, state_features, 0.0)  # Eq. (5.6)


@checked
def state_action_features(
    state_features: ArrayArgument, actions: ArrayArgument, n_actions: int
) -> Floats:
    """Features f(s, a) of the actions taken: the blocks of all actions side by side, Eq. (5.5).

    With them the reward theta . f(s, a) is theta_a . phi(s): a linear function of the state for each action.

    Parameters
    ----------
    state_features : (M, k) array
        phi(s) of M states.
    actions : (M,) array of int
        The action taken in each.
    n_actions : int
        A.

    Returns
    -------
    (M, A k) array

    Raises
    ------
    ValueError
        If shapes do not fit or an action does not exist.

    Examples
    --------
    >>> from robonav.nirl import state_action_features
    >>> state_action_features([[0.7, 1.0]], [1], 2)
    array([[0. , 0. , 0.7, 1. ]])
    """
    blocks = [action_block(state_features, actions, u) for u in range(n_actions)]
    return np.concatenate(blocks, axis=1)  # Eq. (5.5)


@checked
def all_action_features(state_features: ArrayArgument, n_actions: int) -> Floats:
    """Features f(s, a) of every action in every state.

    Parameters
    ----------
    state_features : (M, k) array
        phi(s) of M states.
    n_actions : int
        A.

    Returns
    -------
    (M, A, A k) array
        Rows as :func:`state_action_features` gives them.

    Examples
    --------
    >>> from robonav.nirl import all_action_features
    >>> all_action_features([[0.7, 1.0]], 2)
    array([[[0.7, 1. , 0. , 0. ],
            [0. , 0. , 0.7, 1. ]]])
    """
    n = len(state_features)
    every = [
        state_action_features(state_features, np.full(n, u), n_actions)
        for u in range(n_actions)
    ]
    return np.stack(every, axis=1)
