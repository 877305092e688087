r"""A larger project: maximum margin with weights that are easy to interpret. Among all
rewards $r = \theta \cdot f$ whose weights are not negative and sum to one, find one
with the largest margin between the expert and the policies found so far: the $\theta$
for which the smallest $\theta \cdot (\mu_E - \mu_j)$ over the policies $j$ is largest.
This is a game of two players, in which one chooses the weights and the other a policy.
It can be solved by a linear program that you write yourself, or by letting both players
learn.

Multiplicative weights (Freund and Schapire, 1999) is such a method. Each player keeps a
probability for each of its choices, all equal at first. In every round the gain of a
feature is its mean difference under the other player's probabilities of the policies,
and the loss of a policy is its difference under the present $\theta$. A feature's
probability is multiplied by $e^{\eta \cdot \text{gain}}$, a policy's by $e^{-\eta \cdot
\text{loss}}$, with a small $\eta$, and each player's probabilities are scaled to sum to
one. The solution is the mean of $\theta$ over all rounds; the probabilities of one
round go around it for ever.

The mean comes as near to the solution as you like. Divide the differences by their
largest absolute value, so that they lie between $-1$ and 1. After $T$ rounds, with $k$
features and $n$ policies, the error is then at most $\eta + \log(k n) / (\eta T)$. So
choose $\eta$ first, and then the number of rounds.

There may be several best $\theta$; any of them is correct. The margin may be smaller
than the best one by a hundredth of the largest absolute number in the differences.
"""

import numpy as np
from numpy.typing import NDArray


def margin(
    expert: NDArray[np.float64],
    found: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Weights of the reward with the greatest margin.

    Parameters
    ----------
    expert : (k,), the expert's feature expectations.
    found : (n, k), those of the policies found so far, one at least.

    Returns
    -------
    (k,), weights of the features, not negative and with sum one.
    """
    ### BEGIN SOLUTION
    contrasts = expert - found
    payoff = contrasts / max(np.abs(contrasts).max(), 1e-300)
    policies, features = payoff.shape
    theta, against = np.full(features, 1 / features), np.full(policies, 1 / policies)
    gains, losses, total = np.zeros(features), np.zeros(policies), np.zeros(features)
    for _ in range(1500):
        gain, loss = against @ payoff, payoff @ theta
        gains, losses, total = gains + gain, losses + loss, total + theta
        # The last round counts twice, as a guess at the next: with it the mean comes
        # near the solution much sooner.
        theta = np.exp(0.5 * (gains + gain - (gains + gain).max()))
        theta /= theta.sum()
        against = np.exp(-0.5 * (losses + loss - (losses + loss).min()))
        against /= against.sum()
    return total / total.sum()
    ### END SOLUTION
