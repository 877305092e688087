"""Known mistakes in 4.9. The hints of an open task say what the robots did."""

import numpy as np


def _fitted(weights, states, actions, targets, steps=400):
    """The weights after some steps of gradient descent to the targets."""
    rng = np.random.default_rng(0)
    first, last = (layer.copy() for layer in weights)
    for _ in range(steps):
        rows = rng.integers(len(states), size=128)
        x = states[rows]
        hidden = np.tanh(first[:, 0] + x @ first[:, 1:].T)
        q = last[:, 0] + hidden @ last[:, 1:].T
        wrong = np.zeros_like(q)
        taken = np.arange(128), actions[rows]
        wrong[taken] = (q[taken] - targets[rows]) / 128
        back = wrong @ last[:, 1:] * (1 - hidden**2)
        first -= np.column_stack([back.sum(axis=0), back.T @ x])
        last -= np.column_stack([wrong.sum(axis=0), wrong.T @ hidden])
    return [first, last]


def unchanged(weights, states, actions, next_states, ends, rounds_left):
    """The robot practises but does not learn."""
    return weights


def ignores_the_state(weights, states, actions, next_states, ends, rounds_left):
    """The outputs are means over all states, so the robot always takes the same action."""
    first, last = np.zeros((16, 13)), np.zeros((5, 17))
    for action in range(5):
        last[action, 0] = ends[actions == action].mean() if len(ends) else 0.0
    return [first, last]


def upside_down(weights, states, actions, next_states, ends, rounds_left):
    """Collisions are rewarded, and arrivals are not."""
    return _fitted(weights, states, actions, -ends.astype(float))
