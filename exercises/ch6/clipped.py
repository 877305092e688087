# Exercise 6.5: PPO's objective and its gradient.
# 10 points, project, about 90 minutes.
# Check it with: robonav check 6.5
r"""A larger project: what PPO maximises, and its gradient, by hand. A network
has an output $z_a$ for each action, and the policy is their softmax $\pi$. For recorded
steps the probability of the action when it was taken is known. Let $\rho$ be its
probability now, divided by that one, and $A$ the advantage of the step. The surrogate
of the step is the smaller one of $\rho A$ and $\hat\rho A$, where $\hat\rho$ is $\rho$
clipped to the interval from $1 - \varepsilon$ to $1 + \varepsilon$. The objective is
the mean over all steps of the surrogate plus $c$ times the entropy $-\sum_a \pi_a \ln
\pi_a$, which keeps the policy random.

Return the objective and its gradient with respect to the outputs. From there
backpropagation takes over, as in chapter 3. Where $\hat\rho A$ is smaller than $\rho A$
the surrogate is constant, so the gradient of the surrogate of this step is zero. First
find the derivatives of $\rho$ and of the entropy on paper; remember that every output
changes the probabilities of all actions. Outputs may be large: $e^{z}$ must not
overflow, and an action of probability zero adds nothing to the entropy.
"""

import numpy as np
from numpy.typing import NDArray


def clipped(
    outputs: NDArray[np.float64],
    actions: NDArray[np.int64],
    log_before: NDArray[np.float64],
    advantages: NDArray[np.float64],
    clip: float,
    entropy_weight: float,
) -> tuple[float, NDArray[np.float64]]:
    """The objective of PPO and its gradient.

    Parameters
    ----------
    outputs : (M, K), the network's outputs in M steps, one for each of K actions.
    actions : (M,), the action that was taken in each step.
    log_before : (M,), logarithm of its probability when it was taken.
    advantages : (M,), A.
    clip : epsilon, between 0 and 1.
    entropy_weight : c, at least 0.

    Returns
    -------
    The objective, and (M, K) its derivatives with respect to the outputs.
    """
    raise NotImplementedError("clipped is yours to write")
