"""Known mistakes in 4.1; a function's docstring is its hint."""

import numpy as np


def _shares(q, temperature, allowed, *, ties=True, hot=False):
    values = np.where(allowed, q, -np.inf)
    below = values - values.max(axis=1, keepdims=True)
    cold = temperature == 0
    with np.errstate(all="ignore"):
        shares = np.exp(
            below * temperature[:, None]
            if hot
            else below / np.where(cold, 1.0, temperature)[:, None]
        )
    shares[cold] = (
        below[cold] == 0 if ties else np.eye(q.shape[1])[below[cold].argmax(axis=1)]
    )
    return shares / shares.sum(axis=1, keepdims=True)


def overflows(q, temperature, allowed):
    """The exponential of a large number overflows: subtract the largest value first, which changes no probability."""
    with np.errstate(all="ignore"):
        shares = np.where(allowed, np.exp(q / temperature[:, None]), 0.0)
        return shares / shares.sum(axis=1, keepdims=True)


def all_allowed(q, temperature, allowed):
    """An action that is not allowed must have the probability 0."""
    return _shares(q, temperature, np.ones_like(allowed))


def forbidden_at_zero(q, temperature, allowed):
    """An action with the value 0 can still be taken. Set the probability of an action that is not allowed to 0."""
    return _shares(np.where(allowed, q, 0.0), temperature, np.ones_like(allowed))


def first_of_the_best(q, temperature, allowed):
    """At temperature zero all best actions have the same probability."""
    return _shares(q, temperature, allowed, ties=False)


def not_normalised_again(q, temperature, allowed):
    """When some actions are not allowed, scale the probabilities of the others so that they sum to one."""
    return np.where(allowed, _shares(q, temperature, np.ones_like(allowed)), 0.0)


def multiplies(q, temperature, allowed):
    """Divide the values by the temperature: a low temperature makes differences large."""
    return _shares(q, temperature, allowed, hot=True)
