"""The compiled twin of :func:`robonav.nirl.sarsa_descent`.

The passes through the network are those of :mod:`robonav.networks._fast`. The first index of the weights is the unit
that they come from, so that inner loops run along memory. Inputs that are 0, as most are, cost nothing.
"""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler
from robonav.networks._fast import kernels as network
from robonav.networks._fast.kernels import hidden_layer, output_logit

compiled = compiler(network)


@compiled
def sarsa_descent(
    w1,
    b1,
    w2,
    b2,
    inputs,
    actions,
    rewards,
    next_index,
    terminal_values,
    order,
    learning_rate,
    discount,
    gradient_step,
):
    """Make the steps of :func:`robonav.nirl.sarsa_descent`; the weights change in place.

    Parameters
    ----------
    w1, b1, w2, b2 : (k, H), (H,), (H, A) and (A,) array
        The network.
    inputs, actions, rewards : (M, k), (M,) and (M,) array
        Decisions; rewards in units of the network's output.
    next_index : (M,) array of int
        The next decision of the same episode, or -1.
    terminal_values : (M,) array
        The future value where there is no next decision, in the same units.
    order : array of int
        The decisions, one step for each.
    learning_rate, discount, gradient_step : float
        alpha, gamma and sigma. Targets are cut to [0, 1].

    Returns
    -------
    float
        The mean cost of the outputs before their steps.
    """
    h, d = np.empty(len(b1)), np.empty(len(b1))
    cost = 0.0
    for i in order:
        future, n = terminal_values[i], next_index[i]
        if n >= 0:
            hidden_layer(w1, b1, inputs[n], h)
            future = 1.0 / (1.0 + math.exp(-output_logit(w2, b2, h, actions[n])))
        x, a = inputs[i], actions[i]
        hidden_layer(w1, b1, x, h)
        z = output_logit(w2, b2, h, a)
        q = 1.0 / (1.0 + math.exp(-z))
        error = rewards[i] + discount * future - q
        target = min(max(q + learning_rate * error, 0.0), 1.0)
        cost += max(z, 0.0) - target * z + math.log1p(math.exp(-abs(z)))
        step = gradient_step * (q - target)
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
