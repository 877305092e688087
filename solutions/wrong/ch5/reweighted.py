"""Known mistakes in 5.5; a function's docstring is its hint."""

import numpy as np


def _estimate(ratio, features, most, *, again=True, cut=True):
    weights = np.exp(ratio - ratio.max())
    weights = weights / weights.mean()
    weights = np.minimum(weights, most) if cut else weights
    weights = weights / (weights.sum() if again else len(weights))
    return weights @ features, 1 / (weights @ weights)


def overflows(log_p, log_q, features, most):
    """The ratios are too large or too small for a computer: subtract the largest logarithm first, it cancels."""
    with np.errstate(all="ignore"):
        weights = np.exp(log_p) / np.exp(log_q)
        weights = np.minimum(weights / weights.mean(), most)
        weights /= weights.sum()
        return weights @ features, 1 / (weights @ weights)


def no_cut(log_p, log_q, features, most):
    """Lower the weights that are larger than the most allowed."""
    return _estimate(log_p - log_q, features, most, cut=False)


def dropped(log_p, log_q, features, most):
    """A sample whose weight is too large still counts, with the most allowed."""
    weights = np.exp(log_p - log_q - (log_p - log_q).max())
    weights = np.where(weights <= most * weights.mean(), weights, 0.0)
    weights = weights / weights.sum()
    return weights @ features, 1 / (weights @ weights)


def not_scaled_again(log_p, log_q, features, most):
    """After the cut the weights no longer have the mean one: scale them to sum to one."""
    return _estimate(log_p - log_q, features, most, again=False)


def upside_down(log_p, log_q, features, most):
    """The samples are of q and stand for p: a sample weighs p / q."""
    return _estimate(log_q - log_p, features, most)


def equal_weights(log_p, log_q, features, most):
    """Samples that p prefers to q must count more."""
    return features.mean(axis=0), float(len(features))


def size_before_the_cut(log_p, log_q, features, most):
    """The effective sample size is that of the weights that are used, after the cut."""
    estimate, _ = _estimate(log_p - log_q, features, most)
    _, size = _estimate(log_p - log_q, features, most, cut=False)
    return estimate, size
