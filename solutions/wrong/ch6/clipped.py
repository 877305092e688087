"""Known mistakes in 6.5; a function's docstring is its hint."""

import numpy as np


def _least(plain, limited):
    return np.minimum(plain, limited)


def _moves(plain, limited, outside):
    return plain <= limited


def _log_policy(outputs):
    shifted = outputs - outputs.max(axis=1, keepdims=True)
    return shifted - np.log(np.exp(shifted).sum(axis=1, keepdims=True))


def _found(
    outputs, actions, log_before, advantages, clip, entropy_weight, *,
    log_policy=None, ratio=None, surrogate=_least, moves=_moves, slope=None,
    others=1.0, inner=1.0, entropy_slope=1.0, entropy_too=True,
):  # fmt: skip
    m, low, high = len(outputs), 1 - clip, 1 + clip
    log_policy = _log_policy(outputs) if log_policy is None else log_policy
    policy, taken = np.exp(log_policy), log_policy[np.arange(m), actions]
    ratio = np.exp(taken - log_before) if ratio is None else ratio(taken, log_before)
    plain = ratio * advantages
    limited = np.clip(ratio, low, high) * advantages
    entropy = -(policy * log_policy).sum(axis=1)
    gains = surrogate(plain, limited) + entropy_weight * entropy_too * entropy
    still = moves(plain, limited, (ratio < low) | (ratio > high))
    slope = plain if slope is None else slope(plain, advantages)
    moving = np.where(still, slope, 0.0)
    gradient = moving[:, None] * (np.eye(outputs.shape[1])[actions] - others * policy)
    weight = entropy_weight * entropy_slope
    gradient = gradient - weight * policy * (log_policy + inner * entropy[:, None])
    return float(np.mean(gains)), gradient / m


def upside_down(*case):
    """The ratio is the probability now, divided by the probability when the action was taken."""
    return _found(*case, ratio=lambda taken, before: np.exp(before - taken))


def difference_of_logarithms(*case):
    """The ratio of two probabilities is the exponential of the difference of their logarithms."""
    return _found(*case, ratio=lambda taken, before: 1 + taken - before)


def never_clipped(*case):
    """This is the objective without clipping: the surrogate is the smaller one of the two products."""
    return _found(
        *case,
        surrogate=lambda plain, limited: plain,
        moves=lambda plain, limited, outside: True,
    )


def always_clipped(*case):
    """The surrogate is the smaller one of the two products, and not always the clipped one."""
    return _found(
        *case,
        surrogate=lambda plain, limited: limited,
        moves=lambda plain, limited, outside: ~outside,
    )


def larger_of_the_two(*case):
    """The surrogate is the smaller one of the two products, not the larger one."""
    return _found(
        *case, surrogate=np.maximum, moves=lambda plain, limited, outside: plain >= limited
    )  # fmt: skip


def gradient_never_stops(*case):
    """Where the clipped product is the smaller one, the surrogate is constant and has no gradient."""
    return _found(*case, moves=lambda plain, limited, outside: True)


def gradient_stops_outside(*case):
    """A ratio outside the interval has a gradient where the plain product is the smaller one: the sign of A decides."""
    return _found(*case, moves=lambda plain, limited, outside: ~outside)


def gradient_of_the_logarithm(*case):
    """The derivative of the ratio is the ratio times the derivative of the logarithm: the ratio is missing."""
    return _found(*case, slope=lambda plain, advantages: advantages)


def other_outputs_left_out(*case):
    """The outputs of the other actions count, too: if they rise, the action that was taken becomes less probable."""
    return _found(*case, others=0.0)


def sum_over_steps(*case):
    """The objective is the mean over the steps, and its gradient is divided by their number, too."""
    objective, gradient = _found(*case)
    return objective * len(case[0]), gradient * len(case[0])


def gradient_not_divided(*case):
    """The objective is a mean: divide its gradient by the number of steps, too."""
    objective, gradient = _found(*case)
    return objective, gradient * len(case[0])


def entropy_left_out(*case):
    """The objective also has the entropy with its weight."""
    return _found(*case[:5], 0.0)


def entropy_subtracted(*case):
    """The entropy is added: it has a minus in its definition, since logarithms of probabilities are negative."""
    return _found(*case[:5], -case[5])


def entropy_without_its_gradient(*case):
    """The entropy has a gradient, too."""
    return _found(*case, entropy_slope=0.0)


def entropy_of_free_probabilities(*case):
    """The probabilities sum to one: an output changes all of them, so the entropy itself stands in its gradient."""
    return _found(*case, inner=0.0)


def loss_instead(*case):
    """This is the loss, which is to fall. Return the objective, which is to rise, and its own gradient."""
    objective, gradient = _found(*case)
    return -objective, -gradient


def overflow(*case):
    """Shift the outputs of a step so that the largest is 0 before you take exponentials: the softmax stays the same."""
    with np.errstate(all="ignore"):
        powers = np.exp(case[0])
        log_policy = np.log(powers / powers.sum(axis=1, keepdims=True))
        return _found(*case, log_policy=log_policy)


def zero_times_infinity(*case):
    """An action of probability 0 adds nothing to the entropy: take the logarithm from the shifted outputs."""
    with np.errstate(all="ignore"):
        powers = np.exp(case[0] - case[0].max(axis=1, keepdims=True))
        log_policy = np.log(powers / powers.sum(axis=1, keepdims=True))
        return _found(*case, log_policy=log_policy)
