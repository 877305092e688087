"""6.5 step by step, with the Jacobian of the softmax."""

import numpy as np


def clipped(outputs, actions, log_before, advantages, clip, entropy_weight):
    m, k = outputs.shape
    objective, gradient = 0.0, np.zeros((m, k))
    for row in range(m):
        p = np.exp(outputs[row] - outputs[row].max())
        p = p / p.sum()
        jacobian = np.diag(p) - np.outer(p, p)
        action, gain = actions[row], advantages[row]
        before = np.exp(log_before[row])
        ratio = p[action] / before
        logs = np.log(np.where(p > 0, p, 1.0))
        objective -= entropy_weight * float(p @ logs)
        gradient[row] -= entropy_weight * jacobian @ (logs + 1)
        if gain >= 0:
            stopped, bound = ratio > 1 + clip, 1 + clip
        else:
            stopped, bound = ratio < 1 - clip, 1 - clip
        objective += gain * (bound if stopped else ratio)
        if not stopped:
            gradient[row] += gain * jacobian[action] / before
    return objective / m, gradient / m
