"""Known mistakes in 5.4; a function's docstring is its hint."""

import numpy as np


def _onto_the_simplex(theta):
    theta = np.maximum(theta, 0.0)
    return theta / theta.sum() if theta.sum() > 0 else np.full(len(theta), 1 / len(theta))


def against_the_mean(expert, found):
    """This is best against the average policy; the margin is that over the policy it is hardest to tell from."""
    return np.eye(len(expert))[np.argmax(expert - found.mean(axis=0))]


def difference_of_means(expert, found):
    """The direction from the policies to the expert is not the answer: solve for the worst policy, not the average."""
    return _onto_the_simplex(expert - found.mean(axis=0))


def all_alike(expert, found):
    """Equal weights tell nobody from the expert: put the weight where all the policies fall short."""
    return np.full(len(expert), 1 / len(expert))


def signs_swapped(expert, found):
    """The expert is to be better than the policies, not worse."""
    payoff = found - expert
    theta, losses, total = np.full(len(expert), 1 / len(expert)), np.zeros(len(found)), np.zeros(len(expert))
    for _ in range(300):
        losses += payoff @ theta
        theta = np.eye(len(expert))[np.argmax(payoff[np.argmin(losses)])]
        total += theta
    return total / total.sum()


def last_policy_alone(expert, found):
    """All policies found so far count, not only the last."""
    return np.eye(len(expert))[np.argmax(expert - found[-1])]
