"""Known mistakes in 5.6; a function's docstring is its hint."""

import numpy as np


def plain_twice(shown, chosen, number):
    """This is the plain accuracy again: in the balanced one a rare action counts as much as a frequent one."""
    plain = float((shown == chosen).mean())
    return plain, plain


def counts_the_absent(shown, chosen, number):
    """An action that the expert never took does not count: there is nothing to agree with."""
    right = shown == chosen
    recalls = [right[shown == a].mean() if (shown == a).any() else 0.0 for a in range(number)]
    return float(right.mean()), float(np.mean(recalls))


def of_the_chosen(shown, chosen, number):
    """Count how often the policy took an action when the *expert* did, not the other way round."""
    right = shown == chosen
    shares = [right[chosen == a].mean() for a in range(number) if (chosen == a).any()]
    return float(right.mean()), float(np.mean(shares))


def balanced_first(shown, chosen, number):
    """The plain accuracy comes first."""
    right = shown == chosen
    recalls = [right[shown == a].mean() for a in range(number) if (shown == a).any()]
    return float(np.mean(recalls)), float(right.mean())


def in_percent(shown, chosen, number):
    """Give both as fractions from 0 to 1."""
    right = shown == chosen
    recalls = [right[shown == a].mean() for a in range(number) if (shown == a).any()]
    return 100 * float(right.mean()), 100 * float(np.mean(recalls))
