"""Feature expectations: what a policy meets, discounted; exact, and from trajectories (Eq. (5.3), (5.13))."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import lfilter

from robonav.mdp import policies
from robonav.validation import check_array, check_integer, check_real

from .reward_free_mdp import RewardFreeMDP

Floats = NDArray[np.float64]


def feature_expectations(mdp: RewardFreeMDP, policy: ArrayLike) -> Floats:
    """mu(s, a) = E[sum_t gamma^t f(s_t, a_t) | s, a], Eq. (5.3), (S, A, K), from the transition matrix.

    Each feature is treated as a reward, and its action values are found from the Bellman equation
    mu(s, a) = f(s, a) + gamma sum_s' T(s, a, s') sum_a' pi(s', a') mu(s', a').

    Parameters
    ----------
    mdp : S states, A actions, K features.
    policy : (S,) actions or (S, A) probabilities, followed after the first action.
    """
    chances = policies.probabilities(policy, mdp.n_states, mdp.n_actions)
    chain = np.einsum("sa,ast->st", chances, mdp.transitions)
    met = np.einsum("sa,sak->sk", chances, mdp.features)
    from_state = np.linalg.solve(np.eye(mdp.n_states) - mdp.discount * chain, met)
    return mdp.features + mdp.discount * np.einsum(
        "ast,tk->sak", mdp.transitions, from_state
    )


def initial_expectations(mdp: RewardFreeMDP, policy: ArrayLike) -> Floats:
    """mu of a policy from the start, (K,): with reward theta . f the policy is worth theta . mu (Eq. (5.4))."""
    chances = policies.probabilities(policy, mdp.n_states, mdp.n_actions)
    return np.einsum(
        "s,sa,sak->k", mdp.starts, chances, feature_expectations(mdp, policy)
    )


def discounted_feature_sums(
    features: ArrayLike, trajectory: ArrayLike, discount: float
) -> Floats:
    """From every step the discounted features of the rest of its trajectory, itself included: (M, K).

    A Monte Carlo estimate of mu(s_t, a_t), Eq. (5.3).

    Parameters
    ----------
    features : f(s_t, a_t) of M steps, (M, K), trajectories laid end to end.
    trajectory : (M,) which trajectory each step belongs to.
    discount : gamma in [0, 1].

    Raises
    ------
    ValueError : if shapes do not fit, or the steps of one trajectory do not stand together.
    """
    f = check_array("features", features, shape=("M", "K"))
    gamma = check_real("discount", discount, at_least=0, at_most=1)
    parts = [
        lfilter([1.0], [1.0, -gamma], f[start:stop][::-1], axis=0)[::-1]
        for start, stop in spans(trajectory, len(f))
    ]
    return np.concatenate(parts) if parts else np.zeros_like(f)


def empirical_expectations(
    features: ArrayLike, trajectory: ArrayLike, discount: float
) -> Floats:
    """The mean over trajectories of their discounted features, (K,): Eq. (5.13). Arguments as above.

    Raises
    ------
    ValueError : if there is no trajectory.
    """
    to_go = discounted_feature_sums(features, trajectory, discount)
    first = [start for start, _ in spans(trajectory, len(to_go))]
    if not first:
        raise ValueError("features must hold at least one trajectory, got none")
    return to_go[first].mean(axis=0)


def mean_by_pair(pair: ArrayLike, to_go: ArrayLike, pairs: int) -> Floats:
    """Monte Carlo estimate of mu for each of P pairs of state and action, (P, K); NaN for one never met.

    Parameters
    ----------
    pair : (M,) which pair each step was.
    to_go : (M, K) what followed it, from :func:`discounted_feature_sums`.
    pairs : P.
    """
    values = check_array("to_go", to_go, shape=("M", "K"))
    which = check_array("pair", pair, shape=(len(values),), dtype=np.int64)
    met = np.bincount(which, minlength=check_integer("pairs", pairs, at_least=1))
    total = np.zeros((pairs, values.shape[1]))
    np.add.at(total, which, values)
    return np.divide(
        total, met[:, None], out=np.full_like(total, np.nan), where=met[:, None] > 0
    )


def spans(trajectory: ArrayLike, steps: int) -> list[tuple[int, int]]:
    """Where each trajectory begins and ends, (start, stop), in M steps laid end to end."""
    owner = check_array("trajectory", trajectory, shape=(steps,), dtype=np.int64)
    if steps == 0:
        return []
    borders = np.flatnonzero(np.diff(owner)) + 1
    if len(borders) + 1 != len(np.unique(owner)):
        raise ValueError("trajectory must keep the steps of one trajectory together")
    edges = [0, *borders.tolist(), steps]
    return list(pairwise(edges))
