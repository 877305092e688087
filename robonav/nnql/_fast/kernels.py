"""Stacks of small networks, compiled: one hidden layer, one output for each action.

A network is a row of P numbers: weights from n inputs to H hidden units (n, H), their biases (H,), weights to A outputs
(H, A), their biases (A,). Weights lie with the unit they come from first, so that inner loops run along memory; inputs
that are 0 (most are) cost nothing. Every kernel treats each network alone: a stack of one gives the same bits as any.
"""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler
from robonav.networks._fast import kernels as network
from robonav.networks._fast.kernels import hidden_layer, output_logits

compiled = compiler(network)


@compiled
def unpacked(row, n, h, a):
    """Views of a row of parameters (P,): w1 (n, H), b1 (H,), w2 (H, A), b2 (A,)."""
    first, second, third = n * h, n * h + h, n * h + h + h * a
    return (
        row[:first].reshape(n, h),
        row[first:second],
        row[second:third].reshape(h, a),
        row[third:],
    )


@compiled
def _sigmoid(z):
    """``1 / (1 + exp(-z))`` without overflow, and ``log(1 + exp(-|z|))``, which its cross-entropy needs."""
    e = math.exp(-abs(z))
    return (1.0 if z >= 0.0 else e) / (1.0 + e), math.log1p(e)


@compiled
def logits(parameters, rows, x, z):
    """Logits ``z`` (K, m, A) of the networks ``rows`` (K,), each for m inputs of its own: ``x`` (K, m, n)."""
    n, a = x.shape[2], z.shape[2]
    h = (parameters.shape[1] - a) // (n + 1 + a)
    hidden = np.empty(h)
    for k in range(len(rows)):
        w1, b1, w2, b2 = unpacked(parameters[rows[k]], n, h, a)
        for i in range(x.shape[1]):
            hidden_layer(w1, b1, x[k, i], hidden)
            output_logits(w2, b2, hidden, z[k, i])


@compiled
def _pass(w1, b1, w2, b2, inputs, targets, gradient_step, hidden, z, d1):
    """One pass of gradient descent through the pairs, with a step after each; return the mean cost.

    Uses Eqs. (4.11) and (4.12).
    """
    cost = 0.0
    for i in range(len(inputs)):
        x, target = inputs[i], targets[i]
        hidden_layer(w1, b1, x, hidden)
        output_logits(w2, b2, hidden, z)
        odds = 1.0  # one logarithm of a product instead of a sum of logarithms
        for a in range(len(z)):
            e = math.exp(-abs(z[a]))
            odds *= 1.0 + e
            cost += max(z[a], 0.0) - target[a] * z[a]
            q = (1.0 if z[a] >= 0.0 else e) / (1.0 + e)
            z[a] = gradient_step * (q - target[a])
            b2[a] -= z[a]
        cost += math.log(odds)
        for j in range(len(hidden)):
            d = 0.0
            for a in range(len(z)):
                d += z[a] * w2[j, a]
                w2[j, a] -= z[a] * hidden[j]
            d1[j] = d * hidden[j] * (1.0 - hidden[j])
            b1[j] -= d1[j]
        for m in range(len(x)):
            if x[m] != 0.0:
                for j in range(len(hidden)):
                    w1[m, j] -= x[m] * d1[j]
    return cost / max(len(inputs), 1)


@compiled
def sgd(
    parameters, rows, inputs, targets, first, last, gradient_step, passes, tolerance
):
    """Stochastic gradient descent, see :meth:`robonav.nnql._fast.networks.BatchedNetworks.sgd`."""
    n, a = inputs.shape[2], targets.shape[2]
    h = (parameters.shape[1] - a) // (n + 1 + a)
    hidden, z, d1 = np.empty(h), np.empty(a), np.empty(h)
    for k in range(len(rows)):
        s, before = rows[k], np.inf
        w1, b1, w2, b2 = unpacked(parameters[s], n, h, a)
        x, y = inputs[s, first[k] : last[k]], targets[s, first[k] : last[k]]
        for _ in range(passes):
            cost = _pass(w1, b1, w2, b2, x, y, gradient_step[k], hidden, z, d1)
            if abs(before - cost) < tolerance:
                break
            before = cost


@compiled
def gradients(parameters, rows, x, actions, targets, outputs, linear, slope, costs):
    """Gradients (K, P) of the mean cost of m examples, see :meth:`.networks.BatchedNetworks.gradients`."""
    m, n, a = x.shape[1], x.shape[2], outputs
    h = (parameters.shape[1] - a) // (n + 1 + a)
    hidden, d1 = np.empty(h), np.empty(h)
    for k in range(len(rows)):
        w1, b1, w2, b2 = unpacked(parameters[rows[k]], n, h, a)
        slope[k] = 0.0
        g1, c1, g2, c2 = unpacked(slope[k], n, h, a)
        total = 0.0
        for i in range(m):
            hidden_layer(w1, b1, x[k, i], hidden)
            taken, target = actions[k, i], targets[k, i]
            z = b2[taken]
            for j in range(h):
                z += hidden[j] * w2[j, taken]
            if linear:
                error = z - target
                total += 0.5 * error * error if abs(error) <= 1.0 else abs(error) - 0.5
                d = min(max(error, -1.0), 1.0) / m
            else:
                q, soft = _sigmoid(z)
                total += max(z, 0.0) + soft - target * z
                d = (q - target) / m
            c2[taken] += d
            for j in range(h):
                g2[j, taken] += d * hidden[j]
                d1[j] = d * w2[j, taken] * hidden[j] * (1.0 - hidden[j])
                c1[j] += d1[j]
            for p in range(n):
                if x[k, i, p] != 0.0:
                    for j in range(h):
                        g1[p, j] += x[k, i, p] * d1[j]
        costs[k] = total / m
