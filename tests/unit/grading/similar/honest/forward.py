"""Twelve ways to write exercise 3.1, as students who do not know each other would."""

import numpy as np


def forward_1(weights, inputs):
    a = inputs
    for W in weights[:-1]:
        a = np.tanh(a @ W[:, 1:].T + W[:, 0])
    z = a @ weights[-1][:, 1:].T + weights[-1][:, 0]
    z = z - z.max(axis=1, keepdims=True)
    return np.exp(z) / np.exp(z).sum(axis=1, keepdims=True)


def forward_2(weights, inputs):
    x = inputs
    for number, W in enumerate(weights):
        ones = np.ones((x.shape[0], 1))
        x = np.concatenate([ones, x], axis=1) @ W.T
        if number < len(weights) - 1:
            x = np.tanh(x)
    exponentials = np.exp(x - np.max(x, axis=1)[:, None])
    return exponentials / np.sum(exponentials, axis=1)[:, None]


def forward_3(weights, inputs):
    output = []
    for x in inputs:
        layer = x
        for W in weights[:-1]:
            layer = np.tanh(W[:, 0] + W[:, 1:] @ layer)
        last = weights[-1]
        scores = last[:, 0] + last[:, 1:] @ layer
        e = np.exp(scores - max(scores))
        output.append(e / sum(e))
    return np.array(output)


def forward_4(weights, inputs):
    def softmax(z):
        shifted = z - np.amax(z, axis=-1, keepdims=True)
        log_sum = np.log(np.sum(np.exp(shifted), axis=-1, keepdims=True))
        return np.exp(shifted - log_sum)

    def linear(W, a):
        return W[:, 0] + np.dot(a, W[:, 1:].T)

    *hidden, last = weights
    a = inputs
    for W in hidden:
        a = np.tanh(linear(W, a))
    return softmax(linear(last, a))


def forward_5(weights, inputs):
    activations = inputs.T
    depth = len(weights)
    for k in range(depth):
        bias, matrix = weights[k][:, :1], weights[k][:, 1:]
        z = matrix @ activations + bias
        activations = np.tanh(z) if k != depth - 1 else z
    activations = activations - activations.max(axis=0)
    p = np.exp(activations)
    return (p / p.sum(axis=0)).T


def forward_6(weights, inputs):
    if len(weights) > 1:
        first = weights[0]
        return forward_6(weights[1:], np.tanh(first[:, 0] + inputs @ first[:, 1:].T))
    z = weights[0][:, 0] + inputs @ weights[0][:, 1:].T
    p = np.exp(z - z.max(1, keepdims=True))
    p /= p.sum(1, keepdims=True)
    return p


def forward_7(weights, inputs):
    M = len(inputs)
    rows = []
    for m in range(M):
        a = list(inputs[m])
        for depth, W in enumerate(weights):
            z = []
            for unit in W:
                total = unit[0]
                for w, value in zip(unit[1:], a):
                    total += w * value
                z.append(total)
            a = z if depth == len(weights) - 1 else [np.tanh(v) for v in z]
        top = max(a)
        powers = [np.exp(v - top) for v in a]
        rows.append([p / sum(powers) for p in powers])
    return rows


def forward_8(weights, inputs):
    h = inputs
    for W in weights[:-1]:
        h = np.einsum("mn,un->mu", h, W[:, 1:]) + W[None, :, 0]
        h = 1 - 2 / (np.exp(np.clip(2 * h, -700, 700)) + 1)
    scores = np.einsum("mn,un->mu", h, weights[-1][:, 1:]) + weights[-1][None, :, 0]
    difference = scores[:, None, :] - scores[:, :, None]
    with np.errstate(over="ignore"):
        return 1 / np.exp(difference).sum(axis=2)


def forward_9(weights, inputs):
    from functools import reduce

    def step(a, W):
        return np.tanh(np.insert(a, 0, 1, axis=1) @ W.T)

    a = reduce(step, weights[:-1], inputs)
    z = np.insert(a, 0, 1, axis=1) @ weights[-1].T
    highest = z.max(axis=1).reshape(-1, 1)
    e = np.exp(z - highest)
    return np.divide(e, e.sum(axis=1).reshape(-1, 1))


def forward_10(weights, inputs):
    current = np.array(inputs, dtype=float)
    i = 0
    while i < len(weights) - 1:
        biases = weights[i][:, 0]
        current = np.tanh(np.matmul(current, weights[i][:, 1:].transpose()) + biases)
        i += 1
    logits = np.matmul(current, weights[i][:, 1:].transpose()) + weights[i][:, 0]
    probabilities = np.zeros_like(logits)
    for r in range(len(logits)):
        numerator = np.exp(logits[r] - np.max(logits[r]))
        probabilities[r] = numerator / np.sum(numerator)
    return probabilities


def forward_11(weights, inputs):
    layers = [inputs]
    for W in weights:
        layers.append(layers[-1].dot(W[:, 1:].T) + W[:, 0])
        if W is not weights[-1]:
            layers[-1] = np.tanh(layers[-1])
    z = layers[-1]
    return np.exp(z - np.logaddexp.reduce(z, axis=1, keepdims=True))


def forward_12(weights, inputs):
    result = np.empty((inputs.shape[0], weights[-1].shape[0]))
    for n, x in enumerate(inputs):
        v = x
        for W in weights[:-1]:
            v = np.tanh(np.hstack([1, v]) @ W.T)
        z = np.hstack([1, v]) @ weights[-1].T
        z -= z.max()
        result[n] = np.exp(z)
        result[n] /= result[n].sum()
    return result
