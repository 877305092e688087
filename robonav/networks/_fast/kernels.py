"""Compiled parts of the small network's passes, which chapters 4 and 5 share: one hidden layer, one input at a time.

The weights ``w1`` (n, H) and ``w2`` (H, A) have a row for each unit that they come from, so that the inner loops run
along memory. Inputs that are 0, and most are, cost nothing.
"""

from __future__ import annotations

import math

from robonav.compilation import compiler

compiled = compiler()


@compiled
def hidden_layer(w1, b1, x, hidden):
    """Compute the activations ``hidden`` (H,) of the hidden layer for one input ``x`` (n,)."""
    for j in range(len(hidden)):
        hidden[j] = b1[j]
    for i in range(len(x)):
        if x[i] != 0.0:
            for j in range(len(hidden)):
                hidden[j] += x[i] * w1[i, j]
    for j in range(len(hidden)):
        hidden[j] = 1.0 / (1.0 + math.exp(-hidden[j]))


@compiled
def output_logit(w2, b2, hidden, a):
    """Return the weighted sum of output unit ``a``."""
    z = b2[a]
    for j in range(len(hidden)):
        z += hidden[j] * w2[j, a]
    return z


@compiled
def output_logits(w2, b2, hidden, z):
    """Compute the weighted sums ``z`` (A,) of all output units."""
    for a in range(len(z)):
        z[a] = b2[a]
    for j in range(len(hidden)):
        for a in range(len(z)):
            z[a] += hidden[j] * w2[j, a]
