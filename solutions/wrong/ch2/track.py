"""Known mistakes in 2.4; a function's docstring is its hint."""

import numpy as np


def _likelihood(observations, action, reading):
    return observations[action, :, reading] if reading >= 0 else np.ones(observations.shape[1])


def not_normalised(belief, transitions, observations, actions, readings):
    """A belief sums to one: divide by the probability of the reading."""
    for action, reading in zip(actions, readings):
        belief = (belief @ transitions[action]) * _likelihood(observations, action, reading)
    return belief


def reads_first(belief, transitions, observations, actions, readings):
    """The robot moves first and reads then: the reading says something about the state after the move."""
    for action, reading in zip(actions, readings):
        joint = belief * _likelihood(observations, action, reading)
        belief = (joint / joint.sum() if joint.sum() > 0 else belief) @ transitions[action]
    return belief


def backwards(belief, transitions, observations, actions, readings):
    """The sum runs over the state before the move, the first of the two; this is Eq. (2.18) as printed, a slip."""
    for action, reading in zip(actions, readings):
        moved = transitions[action] @ belief
        joint = moved * _likelihood(observations, action, reading)
        belief = joint / joint.sum() if joint.sum() > 0 else moved
    return belief


def last_symbol(belief, transitions, observations, actions, readings):
    """A reading of -1 is none at all; as an index it would be the last reading there is."""
    for action, reading in zip(actions, readings):
        moved = belief @ transitions[action]
        joint = moved * observations[action, :, reading]
        belief = joint / joint.sum() if joint.sum() > 0 else moved
    return belief


def starts_anew(belief, transitions, observations, actions, readings):
    """After an impossible reading the belief is what the move made of it, not even over all states."""
    for action, reading in zip(actions, readings):
        joint = (belief @ transitions[action]) * _likelihood(observations, action, reading)
        belief = joint / joint.sum() if joint.sum() > 0 else np.full(len(belief), 1 / len(belief))
    return belief
