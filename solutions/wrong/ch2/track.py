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
    """Sum over the state before the move: it is the first of the two states in ``transitions[action]``, the row."""
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


def moves_only_with_a_reading(belief, transitions, observations, actions, readings):
    """The robot moves in every step: without a reading, the belief is the prediction from the move."""
    for action, reading in zip(actions, readings):
        if reading >= 0:
            moved = belief @ transitions[action]
            joint = moved * observations[action, :, reading]
            belief = joint / joint.sum() if joint.sum() > 0 else moved
    return belief


def forgets_the_move_with_a_lie(belief, transitions, observations, actions, readings):
    """A wrong reading does not undo the move: keep the prediction, not the belief from before the step."""
    for action, reading in zip(actions, readings):
        moved = belief @ transitions[action]
        joint = moved * _likelihood(observations, action, reading)
        belief = joint / joint.sum() if joint.sum() > 0 else belief
    return belief


def divides_by_zero(belief, transitions, observations, actions, readings):
    """An impossible reading has the probability zero, and dividing by it gives nan. Ignore such a reading."""
    for action, reading in zip(actions, readings):
        joint = (belief @ transitions[action]) * _likelihood(
            observations, action, reading
        )
        belief = joint / joint.sum()
    return belief


def stops_at_a_lie(belief, transitions, observations, actions, readings):
    """Go on after a wrong reading: only the reading is ignored, not the rest of the episode."""
    for action, reading in zip(actions, readings):
        belief = belief @ transitions[action]
        joint = belief * _likelihood(observations, action, reading)
        if joint.sum() == 0:
            return belief
        belief = joint / joint.sum()
    return belief


def never_moves(belief, transitions, observations, actions, readings):
    """The robot moves before it reads its sensor: first predict with ``transitions[action]``."""
    for action, reading in zip(actions, readings):
        joint = belief * _likelihood(observations, action, reading)
        belief = joint / joint.sum() if joint.sum() > 0 else belief
    return belief


def back_to_the_start(belief, transitions, observations, actions, readings):
    """Ignore only the wrong reading: go on from the prediction, not from the belief before the first step."""
    start = belief
    for action, reading in zip(actions, readings):
        joint = (belief @ transitions[action]) * _likelihood(
            observations, action, reading
        )
        belief = joint / joint.sum() if joint.sum() > 0 else start
    return belief
