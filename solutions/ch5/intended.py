r"""On a slippery road the expert's actions are not always the intended ones. The
chapter's Eq. (5.12) takes the most frequent action in a state. If the probabilities of
slips are known, there is a better estimate. Assume that the expert means one action in
each state, and that its steps slip independently of each other. From $P(\text{done}
\mid \text{meant})$ and a prior over the intended actions, find for each state the
intended action that is most probable, given all actions done there. A state may occur a
thousand times: the product of a thousand probabilities is zero in floating-point
arithmetic.
"""

import numpy as np
from numpy.typing import NDArray


def intended(
    states: NDArray[np.int64],
    done: NDArray[np.int64],
    slip: NDArray[np.float64],
    prior: NDArray[np.float64],
    size: int,
) -> NDArray[np.int64]:
    """The action most likely meant in each state.

    Parameters
    ----------
    states, done : (N,), state and action of each step that was recorded.
    slip : (A, A), probability that an action (column) is done when one (row) was meant;
        may hold zeros.
    prior : (A,), probability that the expert means each action; may hold zeros.
    size : number of states S.

    Returns
    -------
    (S,), the action most likely meant, the lowest index among equals, and -1 for a
    state that was never seen. For each state that was seen, one intended action at
    least could have led to all that was done there.
    """
    ### BEGIN SOLUTION
    with np.errstate(divide="ignore"):
        log_slip, log_prior = np.log(slip), np.log(prior)
    meant = np.full(size, -1)
    for state in np.unique(states):
        log_posterior = log_prior + log_slip[:, done[states == state]].sum(axis=1)
        meant[state] = np.argmax(log_posterior)
    return meant
    ### END SOLUTION
