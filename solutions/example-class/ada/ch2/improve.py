import numpy as np


def improve(q, policy, tolerance):
    new = policy.copy()
    for s, a in enumerate(policy):
        if q[s].max() > q[s, a] + tolerance:
            new[s] = np.argmax(q[s])
    return new
