"""3.3 forwards: how the outputs change with the sum of each unit, through all layers behind it."""

import numpy as np


def gradients(weights, inputs, labels, decay):
    values = [inputs]  # of each layer's units
    for layer in weights[:-1]:
        values.append(np.tanh(layer[:, 0] + values[-1] @ layer[:, 1:].T))
    z = weights[-1][:, 0] + values[-1] @ weights[-1][:, 1:].T
    p = np.exp(z - z.max(axis=1, keepdims=True))
    p /= p.sum(axis=1, keepdims=True)
    p[np.arange(len(labels)), labels] -= 1  # the cost's change with each output

    slopes = []
    for number, layer in enumerate(weights):
        slope = np.zeros(layer.shape)
        for unit in range(len(layer)):
            change = np.zeros((len(inputs), len(layer)))
            change[:, unit] = 1
            for own, behind in zip(values[number + 1 :], weights[number + 1 :]):
                change = change * (1 - own**2) @ behind[:, 1:].T
            cost = (p * change).sum(axis=1)
            slope[unit] = np.append(cost.sum(), cost @ values[number])
        slope[:, 1:] += decay * layer[:, 1:]
        slopes.append(slope / len(inputs))
    return slopes
