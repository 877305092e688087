"""Known mistakes in 3.1; a function's docstring is its hint."""

import numpy as np


def _z(weights, inputs, squash=np.tanh, column=0):
    a = inputs
    for number, layer in enumerate(weights):
        others = layer[:, 1:] if column == 0 else layer[:, :-1]
        z = (layer[:, column] if column is not None else 0) + a @ others.T
        a = squash(z) if number < len(weights) - 1 else z
    return a


def _softmax(z):
    e = np.exp(z - z.max(axis=1, keepdims=True))
    return e / e.sum(axis=1, keepdims=True)


def no_bias(weights, inputs):
    """Column 0 holds the biases: add them. They are the weights of a unit that is always one."""
    return _softmax(
        _z([np.hstack([0 * layer[:, :1], layer[:, 1:]]) for layer in weights], inputs)
    )


def bias_last(weights, inputs):
    """The bias is in the first column, not in the last."""
    return _softmax(_z(weights, inputs, column=-1))


def sigmoid_hidden(weights, inputs):
    """The hidden units have the hyperbolic tangent here, not the sigmoid."""
    return _softmax(_z(weights, inputs, squash=lambda z: 0.5 * (1 + np.tanh(z / 2))))


def sigmoid_outputs(weights, inputs):
    """Sigmoid outputs need not sum to one; the softmax divides each exponential by the sum of all."""
    return 0.5 * (1 + np.tanh(_z(weights, inputs) / 2))


def over_the_batch(weights, inputs):
    """The softmax is taken over the outputs of one state, not over the states."""
    z = _z(weights, inputs)
    e = np.exp(z - z.max(axis=0))
    return e / e.sum(axis=0)


def over_everything(weights, inputs):
    """Each row is a distribution of its own: divide it by the sum of its own row, not of the whole array."""
    z = _z(weights, inputs)
    e = np.exp(z - z.max(axis=1, keepdims=True))
    return e / e.sum()


def squashed_twice(weights, inputs):
    """Apply the softmax to the last layer's weighted sums directly, without the hyperbolic tangent."""
    return _softmax(np.tanh(_z(weights, inputs)))


def overflows(weights, inputs):
    """Exponentials of large numbers overflow: first subtract the largest in each row. The result stays the same."""
    e = np.exp(_z(weights, inputs))
    return e / e.sum(axis=1, keepdims=True)


def one_maximum(weights, inputs):
    """Subtract the largest of each row. With the largest of all rows, a row far below it becomes 0 divided by 0."""
    z = _z(weights, inputs)
    e = np.exp(z - z.max())
    return e / e.sum(axis=1, keepdims=True)


def hidden_without_a_curve(weights, inputs):
    """The hidden layers need the hyperbolic tangent."""
    return _softmax(_z(weights, inputs, squash=lambda z: z))


def not_divided(weights, inputs):
    """Divide the exponentials of a row by their sum."""
    z = _z(weights, inputs)
    return np.exp(z - z.max(axis=1, keepdims=True))
