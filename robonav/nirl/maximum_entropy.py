"""Maximum-entropy inverse reinforcement learning (Ziebart et al. 2008; for chance in the world, Ziebart et al. 2010).

Of all behaviours with the expert's feature expectations take the least committed one. It is a Boltzmann policy over
action values whose backup has a soft maximum where Bellman's has a hard one.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize
from scipy.special import logsumexp, softmax

from robonav.errors import ConvergenceWarning
from robonav.mdp.models import FiniteMDP
from robonav.validation import check_array, check_integer, check_positive, check_real

from .feature_expectations import initial_expectations
from .reward_free_mdp import RewardFreeMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SoftSolution:
    """``values`` (S,), ``q`` (S, A) and the Boltzmann ``policy`` (S, A) over it, at one temperature."""

    values: Floats
    q: Floats
    policy: Floats


@dataclass(frozen=True)
class MaximumEntropy:
    """A reward's ``weights`` (K,), its soft ``policy`` (S, A), and the likelihood and gap on the way.

    Attributes
    ----------
    log_likelihoods : (iterations,) of the demonstrations, up to a constant: what is maximised.
    gaps : (iterations,) distance between the expert's feature expectations and the policy's.
    """

    weights: Floats
    policy: Floats
    log_likelihoods: Floats
    gaps: Floats


def soft_maximum(q: ArrayLike, temperature: float) -> Floats:
    """T log sum_a exp(q / T) over the last axis: above the maximum, and towards it as the temperature T falls."""
    heat = check_positive("temperature", temperature)
    return np.asarray(heat * logsumexp(np.asarray(q, dtype=float) / heat, axis=-1))


def soft_value_iteration(
    mdp: FiniteMDP,
    *,
    temperature: float = 1.0,
    tolerance: float = 1e-10,
    start: ArrayLike | None = None,
    max_iterations: int = 100_000,
) -> SoftSolution:
    """The soft Bellman backup repeated to its fixed point: V(s) = T log sum_a exp(Q(s, a) / T).

    No policy collects more reward and entropy (times T), discounted alike. A terminal state goes on collecting entropy,
    A actions that are all the same: an end costs nothing of it.

    Parameters
    ----------
    mdp : finite MDP with S states, A actions and a discount below 1.
    temperature : T, positive; towards 0 it becomes value iteration.
    tolerance : largest error of a value accepted.
    start : values (S,) to start from; zeros if not given.
    max_iterations : sweeps after which to give up.

    Warns
    -----
    ConvergenceWarning : if ``max_iterations`` sweeps did not suffice.
    """
    discount = check_real("mdp: discount", mdp.discount, below=1)
    enough = check_positive("tolerance", tolerance) * (1 - discount)
    values = (
        np.zeros(mdp.n_states)
        if start is None
        else check_array("start", start, shape=(mdp.n_states,))
    )
    for _ in range(check_integer("max_iterations", max_iterations, at_least=1)):
        before = values
        values = soft_maximum(mdp.action_values(before), temperature)
        moved = abs(values - before).max()
        if discount * moved <= enough:
            break
    else:
        warnings.warn(
            f"soft_value_iteration gave up after {max_iterations} sweeps: the last one still changed a value by "
            f"{moved:.3g}",
            ConvergenceWarning,
            stacklevel=2,
        )
    q = mdp.action_values(values)
    return SoftSolution(values, q, softmax(q / temperature, axis=1))


def maximum_entropy(
    mdp: RewardFreeMDP,
    expert: ArrayLike,
    *,
    ridge: float = 1e-6,
    tolerance: float = 1e-6,
    iterations: int = 200,
) -> MaximumEntropy:
    """The reward under which the demonstrations are likeliest for a soft-optimal driver.

    Maximises theta . mu_E - E[V_theta(s_0)] - ridge ||theta||^2 / 2, which is concave; its gradient is the expert's
    feature expectations minus those of the soft policy of theta. L-BFGS takes the steps.

    Parameters
    ----------
    mdp : transitions, features, discount, starts.
    expert : feature expectations mu_E of the expert from the start, (K,).
    ridge : keeps the weights finite where the expert never errs; at least 0.
    tolerance : largest entry of the gradient at which to stop.
    iterations : of L-BFGS at most.
    """
    mu = check_array("expert", expert, shape=(mdp.features.shape[2],))
    decay = check_real("ridge", ridge, at_least=0)
    values = np.zeros(mdp.n_states)
    trace: list[tuple[float, float]] = []

    def negative(theta: Floats) -> tuple[float, Floats]:
        nonlocal values
        soft = soft_value_iteration(mdp.with_reward(theta), start=values)
        values = soft.values
        gap = mu - initial_expectations(mdp, soft.policy)
        log_likelihood = float(
            theta @ mu - mdp.starts @ soft.values - decay / 2 * theta @ theta
        )
        latest[:] = [log_likelihood, float(np.linalg.norm(gap))]
        return -log_likelihood, decay * theta - gap

    latest = [0.0, 0.0]
    found = minimize(
        negative,
        np.zeros(len(mu)),
        jac=True,
        method="L-BFGS-B",
        callback=lambda _: trace.append((latest[0], latest[1])),
        options={
            "maxiter": check_integer("iterations", iterations, at_least=1),
            "gtol": tolerance,
            "ftol": 0.0,
        },
    )
    policy = soft_value_iteration(mdp.with_reward(found.x), start=values).policy
    history = np.array(trace, dtype=float).reshape(-1, 2)
    return MaximumEntropy(found.x, policy, history[:, 0], history[:, 1])
