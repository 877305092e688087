r"""Three quarters of an expert's actions are "forward". A policy that always goes
forward agrees with three quarters of the demonstrations, and collides with the first
wall. The chapter gives rare actions a larger weight, by balanced accuracy. Cohen (1960)
subtracts the agreement that is expected by chance. If expert and policy drew their
actions independently of the state, each with its own frequencies, they would agree in
$c = \sum_a p_a q_a$ of the steps, where $p_a$ and $q_a$ are the frequencies of action
$a$. Compute the plain accuracy $o$, and the agreement beyond chance, $(o - c) / (1 -
c)$. It is one for a policy that always agrees with the expert, zero for one that always
takes the same action, and zero on average for one that draws its actions without
looking at the state.
"""

import numpy as np
from numpy.typing import NDArray


def accuracies(
    expert_actions: NDArray[np.int64],
    policy_actions: NDArray[np.int64],
    number: int,
) -> NDArray[np.float64]:
    """Plain accuracy and agreement beyond chance.

    Parameters
    ----------
    expert_actions : (N,), the expert's actions, 0 to ``number`` - 1; at least one.
    policy_actions : (N,), the policy's actions in the same states.
    number : number of actions; some may never occur.

    Returns
    -------
    (2,), the plain accuracy, and the agreement beyond chance; this is 0 if c is 1.
    """
    ### BEGIN SOLUTION
    plain = (expert_actions == policy_actions).mean()
    p, q = (
        np.bincount(taken, minlength=number) / len(taken)
        for taken in (expert_actions, policy_actions)
    )
    expected = p @ q
    return np.array(
        [plain, (plain - expected) / (1 - expected) if expected < 1 else 0.0]
    )
    ### END SOLUTION
