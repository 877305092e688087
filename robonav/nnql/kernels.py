"""Stacks of small networks, compiled: one hidden layer, trained one example at a time.

Weights lie with the unit they come from first, (S, from, to), so that inner loops run along memory; inputs that are 0
(most are) cost nothing. Every kernel treats network ``s`` alone: a stack of one gives the same bits as any other.

Shapes: S networks of n inputs, H hidden units, A outputs; ``w1`` (S, n, H), ``b1`` (S, H), ``w2`` (S, H, A),
``b2`` (S, A).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

compiled = njit(cache=True, nogil=True, error_model="numpy")


@compiled
def _forward(w1, b1, w2, b2, x, h, z):
    """Hidden activations ``h`` (H,) and logits ``z`` (A,) of one network for one input, Eq. (3.3)."""
    for j in range(len(h)):
        h[j] = b1[j]
    for i in range(len(x)):
        if x[i] != 0.0:
            for j in range(len(h)):
                h[j] += x[i] * w1[i, j]
    for a in range(len(z)):
        z[a] = b2[a]
    for j in range(len(h)):
        h[j] = 1.0 / (1.0 + math.exp(-h[j]))
        for a in range(len(z)):
            z[a] += h[j] * w2[j, a]


@compiled
def logits(rows, w1, b1, w2, b2, x, z):
    """Logits ``z`` (K, A) of network ``rows[k]`` for input ``x[k]``, K of them."""
    h = np.empty(w1.shape[2])
    for k in range(len(rows)):
        s = rows[k]
        _forward(w1[s], b1[s], w2[s], b2[s], x[k], h, z[k])


@compiled
def _pass(w1, b1, w2, b2, inputs, targets, rate, h, z, d1):
    """Once through the examples, a step of Eq. (4.12) after each; the cost, Eq. (4.11), met on the way."""
    cost = 0.0
    for i in range(len(inputs)):
        x, target = inputs[i], targets[i]
        _forward(w1, b1, w2, b2, x, h, z)
        odds = 1.0  # one logarithm of a product instead of a sum of logarithms
        for a in range(len(z)):
            e = math.exp(-abs(z[a]))
            q = 1.0 / (1.0 + e) if z[a] >= 0.0 else e / (1.0 + e)
            odds *= 1.0 + e
            cost += max(z[a], 0.0) - target[a] * z[a]
            z[a] = rate * (q - target[a])
            b2[a] -= z[a]
        cost += math.log(odds)
        for j in range(len(h)):
            d = 0.0
            for a in range(len(z)):
                d += z[a] * w2[j, a]
                w2[j, a] -= z[a] * h[j]
            d1[j] = d * h[j] * (1.0 - h[j])
            b1[j] -= d1[j]
        for m in range(len(x)):
            if x[m] != 0.0:
                for j in range(len(h)):
                    w1[m, j] -= x[m] * d1[j]
    return cost / max(len(inputs), 1)


@compiled
def descend(rows, w1, b1, w2, b2, inputs, targets, first, last, rate, passes, tolerance):
    """Train network ``rows[k]`` on examples ``first[k]`` to ``last[k]`` of its memory, (S, L, n) and (S, L, A).

    Pass after pass of stochastic gradient descent, at most ``passes``, until the mean cost moves by less than
    ``tolerance`` from one pass to the next. ``rate`` (K,) is sigma of Eq. (4.12).
    """
    h, z, d1 = np.empty(w1.shape[2]), np.empty(w2.shape[2]), np.empty(w1.shape[2])
    for k in range(len(rows)):
        s, before = rows[k], np.inf
        x, y = inputs[s, first[k] : last[k]], targets[s, first[k] : last[k]]
        for _ in range(passes):
            cost = _pass(w1[s], b1[s], w2[s], b2[s], x, y, rate[k], h, z, d1)
            if abs(before - cost) < tolerance:
                break
            before = cost
