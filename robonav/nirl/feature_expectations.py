"""Feature expectations: the expected discounted sum of features under a policy, from a model or from trajectories."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.mdp.evaluation import policy_evaluation
from robonav.validation import ArrayArgument

from ._arguments import checked
from .decisions import Decisions
from .features import state_action_features
from .reward_free_mdp import RewardFreeMDP

Floats = NDArray[np.float64]


def action_values_under_reward(
    mdp: RewardFreeMDP, policy: ArrayLike, weights: ArrayLike
) -> Floats:
    """Action values of a policy: the expected discounted sum of its rewards, Eq. (5.1).

    The sum's first term is the reward of the first action; the rest is the discounted value of the next state.

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions, K features.
    policy : (S,) array of int or (S, A) array
        Actions or probabilities, followed after the first action.
    weights : (K,) array
        theta of the reward.

    Returns
    -------
    (S, A) array

    Examples
    --------
    >>> from robonav.nirl import TRUE_WEIGHTS, action_values_under_reward, terrain
    >>> grid, mdp = terrain()
    >>> action_values_under_reward(mdp, [0] * mdp.n_states, TRUE_WEIGHTS).shape
    (42, 4)
    """
    rewarded = mdp.with_reward(weights)
    values = policy_evaluation(rewarded, policy)
    next_values = rewarded.expected_next_values(values)  # sum_s' T(s, a, s') V(s')
    return rewarded.rewards + rewarded.discount * next_values  # Eq. (5.1)


@checked
def feature_expectations(mdp: RewardFreeMDP, policy: ArrayArgument) -> Floats:
    """Feature expectations mu(s, a) = E[sum_t gamma^t f(s_t, a_t) | s, a], exactly from a model, Eq. (5.3).

    Take each feature as a reward. Its action values then solve the Bellman equation
    mu(s, a) = f(s, a) + gamma sum_s' T(s, a, s') sum_a' pi(s', a') mu(s', a').

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions, K features.
    policy : (S,) array of int or (S, A) array
        Actions or probabilities, followed after the first action.

    Returns
    -------
    (S, A, K) array

    Examples
    --------
    >>> from robonav.nirl import feature_expectations, terrain
    >>> grid, mdp = terrain()
    >>> feature_expectations(mdp, [0] * mdp.n_states).shape
    (42, 4, 4)
    """
    chain = np.einsum("sa,ast->st", policy, mdp.transitions)  # from s to s' under pi
    features = np.einsum("sa,sak->sk", policy, mdp.features)
    mu = np.linalg.solve(np.eye(mdp.n_states) - mdp.discount * chain, features)  # mu(s)
    next_mu = np.einsum("ast,tk->sak", mdp.transitions, mu)  # expectation over s'
    return mdp.features + mdp.discount * next_mu  # Eq. (5.3)


@checked
def initial_expectations(mdp: RewardFreeMDP, policy: ArrayArgument) -> Floats:
    """Feature expectations mu of a policy from the initial state.

    Parameters
    ----------
    mdp : RewardFreeMDP
        S states, A actions, K features.
    policy : (S,) array of int or (S, A) array
        Actions or probabilities.

    Returns
    -------
    (K,) array

    Examples
    --------
    >>> from robonav.nirl import initial_expectations, terrain
    >>> grid, mdp = terrain()
    >>> initial_expectations(mdp, [0] * mdp.n_states).sum().round(2)
    np.float64(10.0)
    """
    mu = feature_expectations(mdp, policy)
    return np.einsum("s,sa,sak->k", mdp.starts, policy, mu)


def value_of_expectations(weights: ArrayLike, expectations: ArrayLike) -> Floats:
    """Value theta . mu of policies: it depends on their feature expectations alone, Eq. (5.4).

    Two policies with the same feature expectations therefore have the same value under every linear reward.

    Parameters
    ----------
    weights : (K,) array
        theta.
    expectations : (..., K) array
        mu.

    Returns
    -------
    (...) array

    Examples
    --------
    >>> from robonav.nirl import value_of_expectations
    >>> value_of_expectations([1.0, -2.0], [[3.0, 1.0], [5.0, 2.0]])
    array([1., 1.])
    """
    return np.dot(expectations, weights)  # Eq. (5.4)


@checked
def discounted_feature_sums(
    features: ArrayArgument, trajectory: ArrayArgument, discount: float
) -> Floats:
    """The discounted sum of features from each step to the end of its trajectory.

    It is a Monte Carlo estimate of mu(s_t, a_t), see Eq. (5.3).

    Parameters
    ----------
    features : (M, K) array
        f(s_t, a_t) of M steps, trajectories laid end to end.
    trajectory : (M,) array of int
        Which trajectory each step belongs to.
    discount : float
        gamma, from 0 to 1.

    Returns
    -------
    (M, K) array

    Raises
    ------
    ValueError
        If shapes do not fit, or the steps of one trajectory do not stand together.

    Examples
    --------
    >>> from robonav.nirl import discounted_feature_sums
    >>> discounted_feature_sums([[1.0], [1.0], [1.0]], [0, 0, 1], 0.5).ravel()
    array([1.5, 1. , 1. ])
    """
    sums = features.copy()
    for t in reversed(range(len(sums) - 1)):
        if trajectory[t] == trajectory[t + 1]:
            sums[t] += discount * sums[t + 1]
    return sums


def decision_feature_sums(
    decisions: Decisions, n_actions: int, discount: float
) -> Floats:
    """The discounted sum of features f(s, a) from each decision to the end of its episode.

    Parameters
    ----------
    decisions : Decisions
        M decisions, with k features of each state and a constant.
    n_actions : int
        A.
    discount : float
        gamma, from 0 to 1.

    Returns
    -------
    (M, A (k + 1)) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, decision_feature_sums, terrain
    >>> task = TabularTask(terrain()[1], max_steps=2)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> decision_feature_sums(expert, 4, 0.5).sum(axis=1)  # a feature and the constant in each step
    array([3., 2.])
    """
    taken = state_action_features(decisions.features, decisions.actions, n_actions)
    return discounted_feature_sums(taken, decisions.trajectory, discount)


@checked
def empirical_expectations(
    features: ArrayArgument, trajectory: ArrayArgument, discount: float
) -> Floats:
    """Estimate of mu_E: the mean over trajectories of their discounted features, Eq. (5.13).

    Parameters
    ----------
    features : (M, K) array
        f(s_t, a_t) of M steps, trajectories laid end to end.
    trajectory : (M,) array of int
        Which trajectory each step belongs to.
    discount : float
        gamma, from 0 to 1.

    Returns
    -------
    (K,) array

    Raises
    ------
    ValueError
        If there is no trajectory.

    Examples
    --------
    >>> from robonav.nirl import empirical_expectations
    >>> empirical_expectations([[1.0], [1.0], [1.0]], [0, 0, 1], 0.5)
    array([1.25])
    """
    sums = discounted_feature_sums(features, trajectory, discount)
    first = np.flatnonzero(np.diff(trajectory, prepend=trajectory[0] - 1))
    return sums[first].mean(axis=0)  # Eq. (5.13)


@checked
def mean_by_pair(
    pair: ArrayArgument, feature_sums: ArrayArgument, n_pairs: int
) -> Floats:
    """Monte Carlo estimate of mu for each of P pairs of state and action; NaN for a pair that never occurs.

    Parameters
    ----------
    pair : (M,) array of int
        Which pair each step is.
    feature_sums : (M, K) array
        From :func:`discounted_feature_sums`.
    n_pairs : int
        P.

    Returns
    -------
    (P, K) array

    Examples
    --------
    >>> from robonav.nirl import mean_by_pair
    >>> mean_by_pair([0, 0, 2], [[1.0], [3.0], [5.0]], 3).ravel()
    array([ 2., nan,  5.])
    """
    count = np.bincount(pair, minlength=n_pairs)[:, None]
    total = np.zeros((n_pairs, feature_sums.shape[1]))
    np.add.at(total, pair, feature_sums)
    return np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0)
