r"""After each step the chapter's NNQL trains on all pairs of the episode so far, with
the targets computed when each pair was new. Follow one recorded episode with a learner
that is simple enough to check by hand. It is linear, $Q(s, a) = w_a \cdot \phi(s)$,
with initial weights of zero. After each step compute the target of the new pair, with
$\alpha = 1$: the reward plus the discounted largest value of the next state under the
present weights. Then go once through all pairs so far, oldest first. Each pair changes
the weights $w_a$ of its action by $\sigma \, (\text{target} - w_a \cdot \phi(s)) \,
\phi(s)$.
"""

import numpy as np
from numpy.typing import NDArray


def accumulated(
    features: NDArray[np.float64],
    actions: NDArray[np.int64],
    rewards: NDArray[np.float64],
    ended: bool,
    number: int,
    discount: float,
    gradient_step: float,
) -> NDArray[np.float64]:
    """The weights after an episode.

    Parameters
    ----------
    features : (T + 1, k), features of each state before a step, and of the one after
        the last.
    actions, rewards : (T,), action and reward of each step.
    ended : whether nothing follows the last step.
    number : of actions A.
    discount : discount factor in [0, 1].
    gradient_step : the step size sigma.

    Returns
    -------
    (A, k), one row of weights for each action.
    """
    ### BEGIN SOLUTION
    weights = np.zeros((number, features.shape[1]))
    targets: list[float] = []
    for t, reward in enumerate(rewards):
        last = ended and t == len(rewards) - 1
        targets.append(
            reward + (0.0 if last else discount * (weights @ features[t + 1]).max())
        )
        for target, action, phi in zip(targets, actions, features):
            weights[action] += gradient_step * (target - weights[action] @ phi) * phi
    return weights
    ### END SOLUTION
