"""Known mistakes in 6.7. The hints of an open task say what the robots did."""

import numpy as np


def _ascended(layers, states, actions, gains, steps=60, rate=0.3):
    """The weights after some steps of plain gradient ascent on the gains."""
    first, last = (layer.copy() for layer in layers[:2])
    taken = np.eye(5)[actions]
    for _ in range(steps):
        hidden = np.tanh(first[:, 0] + states @ first[:, 1:].T)
        z = last[:, 0] + hidden @ last[:, 1:].T
        policy = np.exp(z - z.max(axis=1, keepdims=True))
        policy /= policy.sum(axis=1, keepdims=True)
        up = gains[:, None] * (taken - policy) / len(states)
        back = up @ last[:, 1:] * (1 - hidden**2)
        first += rate * np.column_stack([back.sum(axis=0), back.T @ states])
        last += rate * np.column_stack([up.sum(axis=0), up.T @ hidden])
    return [first, last, *layers[2:]]


def unchanged(layers, states, actions, log_before, episodes, ends, rounds_left):
    """The robot practises but does not learn."""
    return layers


def ends_alone(layers, states, actions, log_before, episodes, ends, rounds_left):
    """Only the last step of an episode counts, and those before it learn nothing."""
    return _ascended(layers, states, actions, ends.astype(float))


def upside_down(layers, states, actions, log_before, episodes, ends, rounds_left):
    """The gradient is followed downwards, so that collisions become frequent."""
    outcome = np.zeros(episodes.max() + 1)
    np.add.at(outcome, episodes, ends)
    return _ascended(layers, states, actions, -outcome[episodes])


def without_a_baseline(
    layers, states, actions, log_before, episodes, ends, rounds_left
):
    """Every action of an episode gets its end, with nothing taken off and nothing discounted."""
    outcome = np.zeros(episodes.max() + 1)
    np.add.at(outcome, episodes, ends)
    return _ascended(layers, states, actions, outcome[episodes], rate=0.1)
