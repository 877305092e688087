"""Known mistakes in 4.1; a function's docstring is its hint."""

import numpy as np


def _heats(below, share, count, *, halvings=200, highest=np.inf, turned=False):
    """Temperatures at which the best actions have their share; ``count`` gives the number of best actions."""
    finite = np.where(np.isfinite(below), below, 0.0)
    size = np.abs(finite).max(axis=1)
    size[size == 0] = 1.0
    low, high = np.log(size) - 60, np.minimum(np.log(size) + 60, np.log(highest))
    if turned:
        low, high = np.full(len(size), -60.0), np.full(len(size), 60.0)
    for _ in range(halvings):
        middle = (low + high) / 2
        with np.errstate(all="ignore"):
            shares = np.exp(below / np.exp(middle)[:, None])
        too_cold = (count / shares.sum(axis=1) > share) != turned
        low, high = np.where(too_cold, middle, low), np.where(too_cold, high, middle)
    return np.exp(high)[:, None]


def _below(q, allowed):
    values = np.where(allowed, q, -np.inf)
    return values - values.max(axis=1, keepdims=True)


def _right(q, share, allowed, **search):
    below = _below(q, allowed)
    shares = np.exp(below / _heats(below, share, (below == 0).sum(axis=1), **search))
    shares[share == 1] = below[share == 1] == 0
    return shares / shares.sum(axis=1, keepdims=True)


def overflows(q, share, allowed):
    """The exponential of a large number overflows: subtract the largest allowed value first."""
    below = _below(q, allowed)
    heat = _heats(below, share, (below == 0).sum(axis=1))
    with np.errstate(all="ignore"):
        shares = np.where(allowed, np.exp(q / heat), 0.0)
        shares[share == 1] = below[share == 1] == 0
        return shares / shares.sum(axis=1, keepdims=True)


def subtracts_a_forbidden_value(q, share, allowed):
    """Subtract the largest value of the allowed actions: a forbidden one may be far larger."""
    below = _below(q, allowed)
    heat = _heats(below, share, (below == 0).sum(axis=1))
    with np.errstate(all="ignore"):
        shares = np.exp((q - q.max(axis=1, keepdims=True)) / heat)
        shares = np.where(allowed, shares, 0.0)
        shares[share == 1] = below[share == 1] == 0
        return shares / shares.sum(axis=1, keepdims=True)


def all_allowed(q, share, allowed):
    """An action that is not allowed must have the probability 0."""
    return _right(q, share, np.ones_like(allowed))


def forbidden_at_zero(q, share, allowed):
    """An action with the value 0 can still be taken. Set the probability of an action that is not allowed to 0."""
    return _right(np.where(allowed, q, 0.0), share, np.ones_like(allowed))


def not_normalised_again(q, share, allowed):
    """When some actions are not allowed, the probabilities of the others alone must sum to one."""
    return np.where(allowed, _right(q, share, np.ones_like(allowed)), 0.0)


def first_of_the_best(q, share, allowed):
    """Where several actions are best, they have the same probability, at a share of 1, too."""
    below = _below(q, allowed)
    shares = _right(q, share, allowed)
    greedy = np.eye(q.shape[1])[below.argmax(axis=1)]
    return np.where((share == 1)[:, None], greedy, shares)


def share_of_a_single_one(q, share, allowed):
    """The share is that of all best actions together: where two are best, each has half of it."""
    below = _below(q, allowed)
    shares = np.exp(below / _heats(below, share, np.ones(len(q))))
    shares[share == 1] = below[share == 1] == 0
    return shares / shares.sum(axis=1, keepdims=True)


def others_alike(q, share, allowed):
    """The softmax policy takes a better action more often: the actions that are not best do not share equally."""
    best = _below(q, allowed) == 0
    others = allowed & ~best
    share = np.where(others.any(axis=1), share, 1.0)[:, None]
    return best * share / best.sum(axis=1, keepdims=True) + others * (
        1 - share
    ) / np.maximum(others.sum(axis=1, keepdims=True), 1)


def one_temperature(q, share, allowed):
    """Every robot has a temperature of its own, because the values and the shares differ."""
    below = _below(q, allowed)
    heats = _heats(below, share, (below == 0).sum(axis=1))
    shares = np.exp(below / np.exp(np.log(heats).mean()))
    shares[share == 1] = below[share == 1] == 0
    return shares / shares.sum(axis=1, keepdims=True)


def share_as_temperature(q, share, allowed):
    """The share is a probability, not the temperature: search for the temperature that gives it."""
    below = _below(q, allowed)
    shares = np.exp(below / share[:, None])
    shares[share == 1] = below[share == 1] == 0
    return shares / shares.sum(axis=1, keepdims=True)


def divides_by_zero(q, share, allowed):
    """A share of 1 belongs to temperature 0, by which you cannot divide: treat the greedy policy separately."""
    shares = _right(q, share, allowed)
    return np.where((share == 1)[:, None], np.nan, shares)


def range_too_low(q, share, allowed):
    """Search up to very high temperatures: the larger the values are, or the smaller the share, the higher it is."""
    return _right(q, share, allowed, highest=1.0)


def range_up_to_ten(q, share, allowed):
    """Search up to very high temperatures: the larger the values are, or the smaller the share, the higher it is."""
    return _right(q, share, allowed, highest=10.0)


def range_up_to_a_hundred(q, share, allowed):
    """Search up to very high temperatures: the larger the values are, or the smaller the share, the higher it is."""
    return _right(q, share, allowed, highest=100.0)


def wrong_half(q, share, allowed):
    """A higher temperature lowers the share of the best actions. Where it is too large, search among higher ones."""
    return _right(q, share, allowed, turned=True)


def too_few_halvings(q, share, allowed):
    """The temperature is not exact enough: halve the interval more often, until the probabilities change no more."""
    return _right(q, share, allowed, halvings=20)
