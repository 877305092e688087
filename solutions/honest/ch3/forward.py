"""Thirty ways to write exercise 3.1, as students who do not know each other would."""

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


def forward_13(weights, inputs):
    number_of_layers = len(weights)
    activation = inputs
    for layer in range(number_of_layers):
        bias = weights[layer][:, 0]
        matrix = weights[layer][:, 1:]
        weighted_sum = np.dot(activation, matrix.T) + bias
        if layer < number_of_layers - 1:
            activation = np.tanh(weighted_sum)
        else:
            largest = np.max(weighted_sum, axis=1)
            for row in range(weighted_sum.shape[0]):
                weighted_sum[row] = weighted_sum[row] - largest[row]
            exponential = np.exp(weighted_sum)
            total = np.sum(exponential, axis=1)
            activation = exponential / total.reshape(len(total), 1)
    return activation


def forward_14(weights, inputs):
    from scipy.special import softmax

    for W in weights[:-1]:
        inputs = np.tanh(inputs @ W[:, 1:].T + W[:, 0])
    return softmax(inputs @ weights[-1][:, 1:].T + weights[-1][:, 0], axis=1)


def forward_15(weights, inputs):
    def layer(W):
        return lambda x: np.c_[np.ones(len(x)), x] @ W.T

    x = inputs
    layers = [layer(W) for W in weights]
    for f in layers[:-1]:
        x = np.tanh(f(x))
    logits = layers[-1](x)
    logits -= np.max(logits, axis=1, keepdims=True)
    np.exp(logits, out=logits)
    return logits / logits.sum(axis=1)[:, np.newaxis]


def forward_16(weights, inputs):
    class Layer:
        def __init__(self, W):
            self.bias, self.matrix = W[:, 0], W[:, 1:]

        def __call__(self, x):
            return self.matrix @ x + self.bias

    net = [Layer(W) for W in weights]

    def probabilities(x):
        for layer in net[:-1]:
            x = np.tanh(layer(x))
        z = net[-1](x)
        p = np.exp(z - z.max())
        return p / p.sum()

    return np.array([probabilities(x) for x in inputs])


def forward_17(weights, inputs):
    M = inputs.shape[0]
    a = np.hstack((np.ones((M, 1)), inputs))
    for W in weights[:-1]:
        a = np.hstack((np.ones((M, 1)), np.tanh(a.dot(W.T))))
    z = a.dot(weights[-1].T)
    top = z.max(axis=1)
    numerators = np.exp((z.T - top).T)
    return (numerators.T / numerators.sum(axis=1)).T


def forward_18(weights, inputs):
    import math

    def dot(unit, x):
        return unit[0] + sum(w * v for w, v in zip(unit[1:], x))

    results = []
    for x in inputs.tolist():
        for W in weights[:-1]:
            x = [math.tanh(dot(unit, x)) for unit in W.tolist()]
        z = [dot(unit, x) for unit in weights[-1].tolist()]
        highest = max(z)
        e = [math.exp(v - highest) for v in z]
        results.append([v / math.fsum(e) for v in e])
    return np.array(results)


def forward_19(weights, inputs):
    from scipy.special import logsumexp

    h, k = inputs, 0
    while k < len(weights):
        h = h @ weights[k][:, 1:].T
        h = h + weights[k][:, 0]
        k += 1
        if k < len(weights):
            h = np.tanh(h)
    return np.exp(h - logsumexp(h, axis=1, keepdims=True))


def forward_20(weights, inputs):
    signal = inputs.copy()
    final = len(weights) - 1
    for i, W in enumerate(weights):
        b = W[:, 0]
        out = np.zeros((signal.shape[0], W.shape[0]))
        for j in range(W.shape[0]):
            out[:, j] = b[j] + (signal * W[j, 1:]).sum(axis=1)
        signal = out if i == final else np.tanh(out)
    shifted = signal - signal.max(axis=1).reshape((-1, 1))
    p = np.exp(shifted)
    for row in p:
        row /= row.sum()
    return p


def forward_21(weights, inputs):
    def hidden(x, remaining):
        if len(remaining) == 0:
            return x
        W, *rest = remaining
        return hidden(np.tanh(x @ W[:, 1:].T + W[:, 0]), rest)

    last = weights[-1]
    z = hidden(inputs, weights[:-1]) @ last[:, 1:].T + last[:, 0]
    # the difference to the largest of each row
    z = np.subtract(z, np.amax(z, axis=1, keepdims=True))
    odds = np.exp(z)
    return np.true_divide(odds, np.sum(odds, axis=1, keepdims=True))


def forward_22(weights, inputs):
    x = np.atleast_2d(inputs)
    states = {0: x}
    for level, W in enumerate(weights, start=1):
        net = np.tensordot(states[level - 1], W[:, 1:], axes=(1, 1)) + W[:, 0]
        states[level] = net
        if level != len(weights):
            states[level] = np.tanh(net)
    out = states[len(weights)]
    maximum = np.max(out, axis=1, keepdims=True)
    stable = np.exp(out - maximum)
    denominator = stable @ np.ones((out.shape[1], 1))
    return stable / denominator


def forward_23(weights, inputs):
    biases = [W[:, 0] for W in weights]
    matrices = [np.delete(W, 0, axis=1) for W in weights]
    a = inputs
    for b, A in zip(biases[:-1], matrices[:-1]):
        z = b + a @ A.T
        a = np.tanh(z)
    z = biases[-1] + a @ matrices[-1].T
    result = []
    for scores in z:
        e = np.exp(scores - scores.max())
        result.append(e / e.sum())
    return np.vstack(result)


def forward_24(weights, inputs):
    v = inputs.T
    for W in weights[:-1]:
        v = np.tanh(W @ np.vstack([np.ones(v.shape[1]), v]))
    v = weights[-1] @ np.vstack([np.ones(v.shape[1]), v])
    v = np.exp(v - v.max(axis=0, keepdims=True))
    v = v / v.sum(axis=0, keepdims=True)
    return v.transpose()


def forward_25(weights, inputs):
    rows = len(inputs)
    padded = [np.ones((rows, 1)), inputs]
    for n in range(len(weights)):
        z = np.concatenate(padded, axis=1) @ np.transpose(weights[n])
        padded = [np.ones((rows, 1)), np.tanh(z)]
    m = np.maximum.reduce(z, axis=1, keepdims=True)
    q = np.exp(z - m)
    s = np.add.reduce(q, axis=1, keepdims=True)
    return np.multiply(q, 1 / s)


def forward_26(weights, inputs):
    x = inputs
    for W in weights:
        z = W[:, 0] + x @ W[:, 1:].T
        x = np.tanh(z)
    K = z.shape[1]
    p = np.zeros_like(z)
    for m in range(z.shape[0]):
        for k in range(K):
            # one over the sum of all differences, none of them too large
            p[m, k] = 1.0 / sum(np.exp(min(z[m, j] - z[m, k], 700)) for j in range(K))
    return p


def forward_27(weights, inputs):
    def affine(x, W):
        return np.array([[row[0] + row[1:] @ v for row in W] for v in x])

    a = inputs
    for number in range(len(weights) - 1):
        a = np.tanh(affine(a, weights[number]))
    scores = affine(a, weights[-1])
    best = scores.argmax(axis=1)
    relative = scores - scores[np.arange(len(scores)), best][:, None]
    powers = np.exp(relative)
    return powers / powers.sum(axis=1, keepdims=True)


def forward_28(weights, inputs):
    stack = list(reversed(weights))
    current = inputs
    while len(stack) > 1:
        W = stack.pop()
        current = current @ W.T[1:] + W.T[0]
        current = (
            (1 - np.exp(-2 * np.abs(current)))
            / (1 + np.exp(-2 * np.abs(current)))
            * np.sign(current)
        )
    W = stack.pop()
    current = current @ W.T[1:] + W.T[0]
    current = np.exp(current - current.max(axis=-1)[..., None])
    return current / current.sum(axis=-1)[..., None]


def forward_29(weights, inputs):
    result = np.zeros((len(inputs), len(weights[-1])))
    for i in range(len(inputs)):
        a = inputs[i]
        for l in range(len(weights)):
            z = np.zeros(len(weights[l]))
            for j in range(len(weights[l])):
                z[j] = weights[l][j, 0] + np.dot(weights[l][j, 1:], a)
            a = np.tanh(z)
        e = np.exp(z - np.max(z))
        result[i, :] = e / np.sum(e)
    return result


def forward_30(weights, inputs):
    *inner, outer = [(W[:, 1:].T, W[:, 0]) for W in weights]
    x = inputs
    for matrix, bias in inner:
        x = np.tanh(np.matmul(x, matrix) + bias)
    log_p = np.matmul(x, outer[0]) + outer[1]
    log_p = log_p - log_p.max(axis=1, keepdims=True)
    log_p = log_p - np.log(np.exp(log_p).sum(axis=1, keepdims=True))
    return np.exp(log_p)
