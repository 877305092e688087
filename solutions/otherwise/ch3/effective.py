"""3.5 pair by pair."""

import numpy as np


def effective(states, actions):
    kept = []
    for state, action in zip(states.tolist(), actions.tolist()):
        pair = (state, action)
        if max(state[:9]) > 0 and (not kept or kept[-1] != pair):
            kept.append(pair)
    return np.array([state for state, _ in kept], dtype=int).reshape(-1, 11), [
        action for _, action in kept
    ]
