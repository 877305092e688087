"""Known mistakes in 2.4; a function's docstring is its hint."""

import numpy as np


def _likelihood(observations, action, reading):
    return (
        observations[action, :, reading]
        if reading >= 0
        else np.ones(observations.shape[1])
    )


def not_normalised(belief, transitions, observations, actions, readings):
    """A belief must sum to one: divide by the probability of the reading."""
    for action, reading in zip(actions, readings):
        belief = (belief @ transitions[action]) * _likelihood(
            observations, action, reading
        )
    return belief


def reads_first(belief, transitions, observations, actions, readings):
    """The robot first moves and then reads its sensor: the reading depends on the state after the move."""
    for action, reading in zip(actions, readings):
        joint = belief * _likelihood(observations, action, reading)
        belief = (joint / joint.sum() if joint.sum() > 0 else belief) @ transitions[
            action
        ]
    return belief


def backwards(belief, transitions, observations, actions, readings):
    """Sum over the state before the move. Eq. (2.18), as printed, has the two states exchanged."""
    for action, reading in zip(actions, readings):
        moved = transitions[action] @ belief
        joint = moved * _likelihood(observations, action, reading)
        belief = joint / joint.sum() if joint.sum() > 0 else moved
    return belief


def last_symbol(belief, transitions, observations, actions, readings):
    """A reading of -1 means that there is none. As an index, -1 selects the last reading."""
    for action, reading in zip(actions, readings):
        moved = belief @ transitions[action]
        joint = moved * observations[action, :, reading]
        belief = joint / joint.sum() if joint.sum() > 0 else moved
    return belief


def starts_anew(belief, transitions, observations, actions, readings):
    """After an impossible reading keep the prediction from the move. Do not make the belief uniform."""
    for action, reading in zip(actions, readings):
        joint = (belief @ transitions[action]) * _likelihood(
            observations, action, reading
        )
        belief = (
            joint / joint.sum()
            if joint.sum() > 0
            else np.full(len(belief), 1 / len(belief))
        )
    return belief
