"""SARSA with a small network, compiled: one decision at a time, the target worked out as it is used (Eq. (5.16)).

The passes through the network are those of :mod:`robonav.networks._fast`.
"""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler
from robonav.networks import _fast as network
from robonav.networks._fast import hidden_layer, output_logit

compiled = compiler(network)


@compiled
def descend(
    w1, b1, w2, b2, inputs, actions, rewards, after, ends, order, alpha, discount, rate
):
    """Gradient steps on the cost (5.15), without its decay, for the decisions ``order``; weights change in place.

    Parameters
    ----------
    w1 (k, H), b1 (H,), w2 (H, A), b2 (A,) : the network.
    inputs (M, k), actions (M,), rewards (M,) : decisions; rewards in units of the network's output.
    after : (M,) the next decision of the same drive, or -1.
    ends : (M,) what is left to be had where there is none, in the same units.
    order : the decisions to step for, one after the other.
    alpha, discount : of Eq. (5.16). The target is kept within [0, 1].
    rate : sigma.

    Returns
    -------
    The mean cost met on the way.
    """
    h, d = np.empty(len(b1)), np.empty(len(b1))
    cost = 0.0
    for i in order:
        future = ends[i]
        if after[i] >= 0:
            hidden_layer(w1, b1, inputs[after[i]], h)
            future = 1.0 / (1.0 + math.exp(-output_logit(w2, b2, h, actions[after[i]])))
        x, a = inputs[i], actions[i]
        hidden_layer(w1, b1, x, h)
        z = output_logit(w2, b2, h, a)
        q = 1.0 / (1.0 + math.exp(-z))
        target = min(max(q + alpha * (rewards[i] + discount * future - q), 0.0), 1.0)
        cost += max(z, 0.0) - target * z + math.log1p(math.exp(-abs(z)))
        step = rate * (q - target)
        for j in range(len(h)):
            d[j] = step * w2[j, a] * h[j] * (1.0 - h[j])
            w2[j, a] -= step * h[j]
            b1[j] -= d[j]
        b2[a] -= step
        for m in range(len(x)):
            if x[m] != 0.0:
                for j in range(len(h)):
                    w1[m, j] -= x[m] * d[j]
    return cost / max(len(order), 1)
