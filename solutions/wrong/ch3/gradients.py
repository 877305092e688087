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
):
    activations = [inputs]
    for layer in weights[:-1]:
        activations.append(np.tanh(layer[:, 0] + activations[-1] @ layer[:, 1:].T))
    z = weights[-1][:, 0] + activations[-1] @ weights[-1][:, 1:].T
    e = np.exp(z - z.max(axis=1, keepdims=True))
    delta = e / e.sum(axis=1, keepdims=True)
    delta[np.arange(len(labels)), labels] -= 1
    slopes, m = [], len(inputs)
    for layer, a in zip(weights[::-1], activations[::-1]):
        slope = np.column_stack([delta.sum(axis=0), delta.T @ a]) / (m if mean else 1)
        slope[:, 0 if bias else 1 :] += (
            decay / (m if per_example else 1) * layer[:, 0 if bias else 1 :]
        )
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
    """Divide the weight decay by the number of examples, too. The thesis prints Eq. (3.27) without this division."""
    return _slopes(weights, inputs, labels, decay, per_example=False)
