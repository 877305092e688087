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
    others=1.0, inner=1.0, entropy_slope=1.0, entropy_too=True, interval=None,
    entropy_of=None,
):  # fmt: skip
    m, low, high = len(outputs), 1 - clip, 1 + clip
    low, high = (low, high) if interval is None else interval(low, high)
    log_policy = _log_policy(outputs) if log_policy is None else log_policy
    policy, taken = np.exp(log_policy), log_policy[np.arange(m), actions]
    ratio = np.exp(taken - log_before) if ratio is None else ratio(taken, log_before)
    plain = ratio * advantages
    limited = np.clip(ratio, low, high) * advantages
    entropy = -(policy * log_policy).sum(axis=1)
    counted = entropy if entropy_of is None else entropy_of(policy, log_policy, actions)
    gains = surrogate(plain, limited) + entropy_weight * entropy_too * counted
    still = moves(plain, limited, (ratio < low) | (ratio > high))
    slope = plain if slope is None else slope(plain, limited, advantages)
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
    return _found(*case, slope=lambda plain, limited, advantages: advantages)


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


def entropy_subtracted_from_the_value(*case):
    """The entropy is added to the objective: it has a minus in its definition. Your gradient has it right."""
    return _found(*case[:5], -case[5])[0], _found(*case)[1]


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


def _never_stops(plain, limited, outside):
    return np.ones_like(outside)


def _stops_outside(plain, limited, outside):
    return ~outside


def _plain(plain, limited):
    return plain


def _limited(plain, limited):
    return limited


def value_always_clipped(*case):
    """The surrogate is the smaller one of the two products, not always the clipped one; your gradient has it right."""
    return _found(*case, surrogate=_limited)


def value_never_clipped(*case):
    """The surrogate is the smaller one of the two products; here the value is not clipped, but your gradient stops."""
    return _found(*case, surrogate=_plain)


def value_of_the_larger(*case):
    """The surrogate is the smaller one of the two products, not the larger one; your gradient has it right."""
    return _found(*case, surrogate=np.maximum)


def always_clipped_without_a_stop(*case):
    """The surrogate is the smaller one of the two products, not always the clipped one.

    Where the clipped one is smaller, the gradient is zero.
    """
    return _found(*case, surrogate=_limited, moves=_never_stops)


def larger_without_a_stop(*case):
    """The surrogate is the smaller one of the two products, not the larger one.

    Where the clipped one is smaller, the gradient is zero.
    """
    return _found(*case, surrogate=np.maximum, moves=_never_stops)


def larger_that_stops_outside(*case):
    """The surrogate is the smaller one of the two products, not the larger one.

    The gradient is zero only where the clipped one is smaller.
    """
    return _found(*case, surrogate=np.maximum, moves=_stops_outside)


def never_clipped_that_stops_outside(*case):
    """The surrogate is the smaller one of the two products, not always the plain one.

    The gradient is zero only where the clipped one is smaller.
    """
    return _found(*case, surrogate=_plain, moves=_stops_outside)


def slope_is_the_surrogate(*case):
    """Where the clipped product is the smaller one, it is constant: its gradient is zero, and not the product."""
    return _found(
        *case,
        moves=_never_stops,
        slope=lambda plain, limited, advantages: np.minimum(plain, limited),
    )


def slope_is_the_clipped_product(*case):
    """The slope of the plain product has the ratio itself, not the clipped one.

    Where the clipped product is smaller, there is no slope at all.
    """
    return _found(
        *case,
        moves=_never_stops,
        slope=lambda plain, limited, advantages: limited,
    )


def slope_with_the_clipped_ratio(*case):
    """Where the plain product is the smaller one, its slope has the ratio itself as a factor, not the clipped one."""
    return _found(*case, slope=lambda plain, limited, advantages: limited)


def one_value_for_each_step(*case):
    """The objective is one number, the mean over the steps, and not one for each step."""
    objective, gradient = _found(*case)
    return np.full(len(case[0]), objective), gradient


def stops_where_it_should_move(*case):
    """The gradient is zero where the clipped product is the smaller one, and not where the plain one is."""
    return _found(*case, moves=lambda plain, limited, outside: plain >= limited)


def clipped_above_alone(*case):
    """The interval has two ends: the ratio is clipped below, too."""
    return _found(*case, interval=lambda low, high: (-np.inf, high))


def clipped_below_alone(*case):
    """The interval has two ends: the ratio is clipped above, too."""
    return _found(*case, interval=lambda low, high: (low, np.inf))


def interval_around_zero(*case):
    """The interval lies around 1, where the policy has not changed, and not around 0."""
    return _found(*case, interval=lambda low, high: (low - 1, high - 1))


def product_clipped(outputs, actions, log_before, advantages, *others):
    """The ratio is clipped, and then multiplied by the advantage; here the product is clipped."""

    def surrogate(plain, limited):
        low, high = 1 - others[0], 1 + others[0]
        return np.minimum(plain, np.clip(plain, low, high))

    return _found(
        outputs, actions, log_before, advantages, *others, surrogate=surrogate
    )


def gradient_by_the_advantage_alone(*case):
    """The derivative of the surrogate has the advantage as a factor; here it is missing."""
    return _found(*case, slope=lambda plain, limited, advantages: plain / advantages)


def gradient_of_the_probability(*case):
    """The ratio grows as the probability does: the derivative is the ratio times that of the logarithm, once only."""
    taken = _log_policy(case[0])[np.arange(len(case[1])), case[1]]
    return _found(*case, slope=lambda plain, limited, advantages: plain * np.exp(taken))


def only_the_taken_output(*case):
    """Every output changes the probability of the action that was taken, not only its own output."""
    objective, found = _found(*case)
    entropy_alone = _found(*case, slope=lambda plain, limited, advantages: 0 * plain)[1]
    taken = np.eye(case[0].shape[1])[case[1]]
    return objective, (found - entropy_alone) * taken + entropy_alone


def gradient_upside_down(*case):
    """The objective rises along its gradient: the gradient has the wrong sign."""
    objective, gradient = _found(*case)
    return objective, -gradient


def surrogate_gradient_upside_down(*case):
    """If the output of the action that was taken rises, so does the ratio: its part of the gradient is upside down."""
    return _found(*case, slope=lambda plain, limited, advantages: -plain)


def value_upside_down(*case):
    """The objective has the wrong sign; its gradient is right."""
    objective, gradient = _found(*case)
    return -objective, gradient


def gradient_divided_by_all_outputs(*case):
    """The objective is a mean over the steps: divide its gradient by their number, not by that of all outputs."""
    objective, gradient = _found(*case)
    return objective, gradient / case[0].shape[1]


def standardised(outputs, actions, log_before, advantages, *others):
    """Take the advantages as they are given; they are not to be shifted or scaled here."""
    scaled = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
    return _found(outputs, actions, log_before, scaled, *others)


def logarithm_taken_again(*case):
    """The logarithm of the probability is given, not the probability."""
    with np.errstate(all="ignore"):
        return _found(*case, ratio=lambda taken, before: np.exp(taken) / before)


def difference_of_probabilities(*case):
    """The ratio is a quotient of probabilities, and not their difference."""
    return _found(*case, ratio=lambda taken, before: np.exp(taken) - np.exp(before))


def entropy_in_bits(*case):
    """The entropy has the natural logarithm, not the logarithm to the base 2."""
    return _found(
        *case[:5],
        case[5],
        entropy_of=lambda policy, log_policy, actions: (
            -(policy * log_policy).sum(axis=1) / np.log(2)
        ),
    )


def entropy_of_the_taken(*case):
    """The entropy is the sum over all actions, not only over the one that was taken."""
    return _found(
        *case,
        entropy_of=lambda policy, log_policy, actions: (
            -(policy * log_policy)[np.arange(len(actions)), actions]
        ),
    )


def surprise_for_the_entropy(*case):
    """Each logarithm in the entropy has its probability as a factor; here it is minus the logarithm alone."""
    return _found(
        *case,
        entropy_of=lambda policy, log_policy, actions: -log_policy.sum(axis=1),
    )


def entropy_summed_over_steps(*case):
    """The entropy is a mean over the steps, as the surrogate is, and not their sum."""
    return _found(
        *case,
        entropy_of=lambda policy, log_policy, actions: np.full(
            len(policy), -(policy * log_policy).sum()
        ),
    )


def entropy_gradient_upside_down(*case):
    """The gradient of the entropy has the wrong sign: it draws all probabilities together."""
    return _found(*case, entropy_slope=-1.0)


def entropy_of_free_probabilities_with_its_one(*case):
    """The probabilities sum to one, and an output changes all of them: the entropy itself stands in its gradient."""
    objective, gradient = _found(*case, inner=0.0)
    policy = np.exp(_log_policy(case[0]))
    return objective, gradient - case[5] * policy / len(policy)


def entropy_with_respect_to_the_probabilities(*case):
    """This is the entropy's derivative with respect to the probabilities; go on to the outputs by the chain rule."""
    objective, gradient = _found(*case, entropy_slope=0.0)
    log_policy = _log_policy(case[0])
    return objective, gradient - case[5] * (log_policy + 1) / len(log_policy)


def entropy_gradient_not_divided(*case):
    """The entropy is a mean over the steps: divide its gradient by their number, too."""
    return _found(*case, entropy_slope=len(case[0]))


def largest_of_all_steps(*case):
    """Shift the outputs of each step by their own largest one: that of all steps leaves nothing of the others."""
    with np.errstate(all="ignore"):
        shifted = case[0] - case[0].max()
        log_policy = shifted - np.log(np.exp(shifted).sum(axis=1, keepdims=True))
        return _found(*case, log_policy=log_policy)
