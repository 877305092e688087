"""Known mistakes in 5.5; a function's docstring is its hint."""

import numpy as np


def _estimate(ratio, features, most, *, again=True, cut=True):
    weights = np.exp(ratio - ratio.max())
    weights = weights / weights.mean()
    weights = np.minimum(weights, most) if cut else weights
    weights = weights / (weights.sum() if again else len(weights))
    return weights @ features, 1 / (weights @ weights)


def overflows(log_p, log_q, features, most):
    """The ratios overflow or underflow: first subtract the largest logarithm, which cancels later."""
    with np.errstate(all="ignore"):
        weights = np.exp(log_p) / np.exp(log_q)
        weights = np.minimum(weights / weights.mean(), most)
        weights /= weights.sum()
        return weights @ features, 1 / (weights @ weights)


def overflows_in_the_ratio(log_p, log_q, features, most):
    """The ratios overflow or underflow: first subtract the largest logarithm, which cancels later."""
    with np.errstate(all="ignore"):
        weights = np.exp(log_p - log_q)
        weights = np.minimum(weights / weights.mean(), most)
        weights /= weights.sum()
        return weights @ features, 1 / (weights @ weights)


def no_cut(log_p, log_q, features, most):
    """No weight is clipped. Scale the weights to the mean one, and then lower those above the limit to the limit."""
    return _estimate(log_p - log_q, features, most, cut=False)


def dropped(log_p, log_q, features, most):
    """Keep samples whose weight is too large, with the limit as their weight."""
    weights = np.exp(log_p - log_q - (log_p - log_q).max())
    weights = np.where(weights <= most * weights.mean(), weights, 0.0)
    weights = weights / weights.sum()
    return weights @ features, 1 / (weights @ weights)


def not_scaled_again(log_p, log_q, features, most):
    """After clipping, the mean of the weights is no longer one: scale them to sum to one."""
    return _estimate(log_p - log_q, features, most, again=False)


def upside_down(log_p, log_q, features, most):
    """The samples come from q, and the expectation is under p: the weight of a sample is p / q."""
    return _estimate(log_q - log_p, features, most)


def equal_weights(log_p, log_q, features, most):
    """Samples that are more probable under p than under q must have larger weights."""
    return features.mean(axis=0), float(len(features))


def size_before_the_cut(log_p, log_q, features, most):
    """Compute the effective sample size from the final weights, after clipping."""
    estimate, _ = _estimate(log_p - log_q, features, most)
    _, size = _estimate(log_p - log_q, features, most, cut=False)
    return estimate, size


def cuts_the_ratios(log_p, log_q, features, most):
    """Clip the weights after you scaled them to the mean one: the limit has no meaning for unscaled weights."""
    with np.errstate(all="ignore"):
        weights = np.minimum(np.exp(log_p - log_q), most)
        weights = weights / weights.sum()
        return weights @ features, 1 / (weights @ weights)


def shifted_apart(log_p, log_q, features, most):
    """Subtract the logarithms of each sample first, then the largest difference: p and q alone may underflow."""
    with np.errstate(all="ignore"):
        weights = np.exp(log_p - log_p.max()) / np.exp(log_q - log_q.max())
        weights = np.minimum(weights / weights.mean(), most)
        weights /= weights.sum()
        return weights @ features, 1 / (weights @ weights)


def number_of_samples(log_p, log_q, features, most):
    """The effective sample size is smaller than the number of samples: it is 1 / sum of the squared weights."""
    return _estimate(log_p - log_q, features, most)[0], float(len(features))


def sum_of_squares(log_p, log_q, features, most):
    """The effective sample size is 1 divided by the sum of the squared weights."""
    estimate, size = _estimate(log_p - log_q, features, most)
    return estimate, 1 / size
