"""Apprenticeship learning (Abbeel and Ng 2004) for the robot: no model, and a neural network for each policy.

The loop is that of :func:`robonav.nirl.apprenticeship_learning`. Three things are different here. The feature
expectations of expert and policies are estimated from episodes. A neural network learns the policy of each reward, and
goes on from one reward to the next. And what is returned is not a mixture, but the best network of all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from robonav.networks.multilayer_perceptron import Network

from .apprenticeship import RewardGuess, projection_guess
from .decisions import Decisions, concatenate_decisions
from .feature_expectations import decision_feature_sums
from .max_margin import project_to_unit_ball
from .policy import exploring_policy
from .policy_improvement import ReplaySGD, decision_rewards
from .tasks import Task
from .training import Iteration, training_method

Floats = NDArray[np.float64]

PolicyExpectations = Callable[[Decisions, int, float], Floats]
"""``expectations(decisions, n_actions, discount) -> (A (k + 1),)``: estimated feature expectations."""


def from_initial_state(decisions: Decisions, n_actions: int, discount: float) -> Floats:
    """Feature expectations discounted from the first decision of each episode.

    Uses Eq. (5.13). With the thesis's discount of 0.65, decisions after the first dozen hardly count.

    Parameters
    ----------
    decisions : Decisions
        M decisions; if there is none, the expectations are zero.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (A (k + 1),) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, from_initial_state, terrain
    >>> task = TabularTask(terrain()[1], max_steps=2)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> from_initial_state(expert, 4, 0.5).sum()  # a feature and the constant, at two steps
    np.float64(3.0)
    """
    sums = decision_feature_sums(decisions, n_actions, discount)
    begins = np.diff(decisions.trajectory, prepend=-1) != 0
    return mean_or_zeros(sums[begins])


def from_all_states(decisions: Decisions, n_actions: int, discount: float) -> Floats:
    """Feature expectations discounted from every decision, and averaged over all decisions.

    All parts of an episode then have equal weight.

    Parameters
    ----------
    decisions : Decisions
        M decisions; if there is none, the expectations are zero.
    n_actions : int
        A.
    discount : float
        gamma.

    Returns
    -------
    (A (k + 1),) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, from_all_states, terrain
    >>> task = TabularTask(terrain()[1], max_steps=2)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> from_all_states(expert, 4, 0.5).sum()  # the mean of 3 and 2
    np.float64(2.5)
    """
    return mean_or_zeros(decision_feature_sums(decisions, n_actions, discount))


def mean_or_zeros(sums: Floats) -> Floats:
    """The mean of the rows (M, K), or zeros (K,) if there is none."""
    return sums.mean(axis=0) if len(sums) else np.zeros(sums.shape[1])


@training_method
def apprenticeship(
    demonstrations: Decisions,
    task: Task,
    network: Network,
    *,
    guess: RewardGuess = projection_guess,
    expectations: PolicyExpectations = from_all_states,
    n_rewards: int = 14,
    iterations: int = 140,
    inverse_temperature: float = 25.0,
    improver: ReplaySGD = ReplaySGD(),  # noqa: B008 - frozen
    rng: np.random.Generator,
) -> Iterator[Iteration]:
    """Apprenticeship learning (Abbeel and Ng 2004) without a model: a neural network learns the policy of each reward.

    The numbers in the code are the steps of the paper, as in :func:`apprenticeship_learning`. Feature expectations are
    estimated from episodes. One network learns all policies: it goes on from one reward to the next.

    Parameters
    ----------
    guess : callable
        :func:`projection_guess` or :func:`max_margin_guess`.
    expectations : callable
        :func:`from_all_states`, or :func:`from_initial_state`, which takes the equation literally.
    n_rewards : int
        Rewards to guess at most. The ``iterations`` are divided among them: if ``n_rewards`` does not divide their
        number, the last rewards get one iteration more. The network keeps its weights from one reward to the next.
    improver : ReplaySGD
        Improves the network; its discount is that of the feature expectations.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, apprenticeship, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> len(apprenticeship(expert, task, n_rewards=2, iterations=4).history.costs)
    4
    """
    n_actions, discount = task.n_actions, improver.discount
    n_guesses = min(n_rewards, iterations)
    mu_expert = expectations(demonstrations, n_actions, discount)
    episodes = [task.rollout(exploring_policy(network, inverse_temperature), rng)]
    found = [expectations(episodes[0], n_actions, discount)]  # 1
    for number in range(n_guesses):
        weights, distance = guess(mu_expert, found)  # 2
        if distance <= 0:  # 3
            break
        theta = project_to_unit_ball(weights.reshape(n_actions, -1))
        for _ in range((iterations + number) // n_guesses):  # 4
            pairs = concatenate_decisions(episodes[-improver.replay :])
            rewards = decision_rewards(theta, pairs)  # theta . f(s, a)
            fraction = (len(episodes) - 1) / max(iterations - 1, 1)
            network, cost = improver.improve(network, pairs, rewards, fraction, rng)
            yield Iteration(episodes[-1], theta, network, cost)
            policy = exploring_policy(network, inverse_temperature)
            episodes.append(task.rollout(policy, rng))
        found.append(expectations(episodes[-1], n_actions, discount))  # 5, 6
