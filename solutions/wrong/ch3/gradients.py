"""Known mistakes in 3.3; a function's docstring is its hint."""

import numpy as np


def _slopes(
    weights,
    inputs,
    labels,
    decay,
    slope_of=lambda a: 1 - a**2,
    mean=True,
    bias=False,
    per_example=True,
    sign=1,
    output=False,
    over_states=False,
    bias_slope=True,
):
    activations = [inputs]
    for layer in weights[:-1]:
        activations.append(np.tanh(layer[:, 0] + activations[-1] @ layer[:, 1:].T))
    z = weights[-1][:, 0] + activations[-1] @ weights[-1][:, 1:].T
    axis = 0 if over_states else 1
    e = np.exp(z - z.max(axis=axis, keepdims=True))
    p = e / e.sum(axis=axis, keepdims=True)
    delta = p.copy()
    delta[np.arange(len(labels)), labels] -= 1
    delta *= sign * (p * (1 - p) if output else 1)
    slopes, m = [], len(inputs)
    for layer, a in zip(weights[::-1], activations[::-1]):
        slope = np.column_stack([delta.sum(axis=0), delta.T @ a]) / (m if mean else 1)
        slope[:, 0 if bias else 1 :] += (
            decay / (m if per_example else 1) * layer[:, 0 if bias else 1 :]
        )
        slope[:, 0] *= 1.0 if bias_slope else 0.0
        slopes.insert(0, slope)
        delta = delta @ layer[:, 1:] * slope_of(a)
    return slopes


def sigmoid_slope(weights, inputs, labels, decay):
    """The derivative of the hyperbolic tangent is 1 - h * h; h * (1 - h) is the sigmoid's."""
    return _slopes(weights, inputs, labels, decay, slope_of=lambda a: a * (1 - a))


def no_slope(weights, inputs, labels, decay):
    """Multiply the error by the derivative of the hidden unit when you propagate it back."""
    return _slopes(weights, inputs, labels, decay, slope_of=lambda a: 1.0)


def summed(weights, inputs, labels, decay):
    """The cost is a mean over the examples: divide by their number."""
    return _slopes(weights, inputs, labels, decay, mean=False)


def decays_biases(weights, inputs, labels, decay):
    """The biases have no weight decay: leave column 0 out."""
    return _slopes(weights, inputs, labels, decay, bias=True)


def decays_too_much(weights, inputs, labels, decay):
    """Divide the weight decay by the number of examples, too: it is part of the mean."""
    return _slopes(weights, inputs, labels, decay, per_example=False)


def uphill(weights, inputs, labels, decay):
    """The error of an output is p - y. With y - p the derivatives of the cross-entropy have the wrong sign."""
    return _slopes(weights, inputs, labels, decay, sign=-1)


def squared_error(weights, inputs, labels, decay):
    """The slope of the softmax cancels against that of the logarithm: the error of an output is p - y alone."""
    return _slopes(weights, inputs, labels, decay, output=True)


def decays_twice(weights, inputs, labels, decay):
    """The derivative of lambda / 2 times a square is lambda times the weight: the 2 cancels."""
    return _slopes(weights, inputs, labels, 2 * decay)


def decays_half(weights, inputs, labels, decay):
    """The derivative of lambda / 2 times a square is lambda times the weight: the 2 cancels."""
    return _slopes(weights, inputs, labels, decay / 2)


def no_decay(weights, inputs, labels, decay):
    """Add the derivative of the weight decay."""
    return _slopes(weights, inputs, labels, 0.0)


def slope_of_the_slope(weights, inputs, labels, decay):
    """The derivative is 1 - h * h for the unit's value h: do not apply the hyperbolic tangent again."""
    return _slopes(
        weights, inputs, labels, decay, slope_of=lambda a: 1 - np.tanh(a) ** 2
    )


def softmax_over_states(weights, inputs, labels, decay):
    """The softmax is over the outputs of one state, whose probabilities sum to 1, not over the states."""
    return _slopes(weights, inputs, labels, decay, over_states=True)


def no_slope_of_the_bias(weights, inputs, labels, decay):
    """The bias has a derivative, too: its input is always 1, so it is the mean of the unit's errors."""
    return _slopes(weights, inputs, labels, decay, bias_slope=False)
