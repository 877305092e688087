"""Known mistakes in 3.5; a function's docstring is its hint."""

import numpy as np


def _thinned(states, actions, with_action=True):
    same = (states[1:] == states[:-1]).all(axis=1)
    if with_action:
        same &= actions[1:] == actions[:-1]
    kept = np.concatenate([[True], ~same])[: len(states)]
    return states[kept], actions[kept]


def any_number(states, actions):
    """Select the pairs in which a sensor detects something: one of the nine degrees of danger, not the region."""
    near = (states > 0).any(axis=1)
    return _thinned(states[near], actions[near])


def keeps_repeats(states, actions):
    """Of equal pairs in a row, keep only the first."""
    near = (states[:, :9] > 0).any(axis=1)
    return states[near], actions[near]


def keeps_repeats_apart(states, actions):
    """Remove the safe pairs first: two equal effective pairs with only safe ones between them are then in a row."""
    states, actions = _thinned(states, actions)
    near = (states[:, :9] > 0).any(axis=1)
    return states[near], actions[near]


def never_again(states, actions):
    """Keep a pair that occurs again after a different one."""
    near = (states[:, :9] > 0).any(axis=1)
    pairs = np.column_stack([states[near], actions[near]])
    _, first = np.unique(pairs, axis=0, return_index=True)
    return states[near][np.sort(first)], actions[near][np.sort(first)]


def forgets_the_action(states, actions):
    """The same state with another action is another pair."""
    near = (states[:, :9] > 0).any(axis=1)
    return _thinned(states[near], actions[near], with_action=False)


def all_sensors(states, actions):
    """A pair is effective if any of the nine sensors detects something: not all need to."""
    near = (states[:, :9] > 0).all(axis=1)
    return _thinned(states[near], actions[near])


def forgets_the_target(states, actions):
    """The region and whether the target is seen belong to the state: compare all eleven numbers."""
    near = (states[:, :9] > 0).any(axis=1)
    states, actions = states[near], actions[near]
    same = (states[1:, :9] == states[:-1, :9]).all(axis=1)
    kept = np.concatenate([[True], ~(same & (actions[1:] == actions[:-1]))])
    return states[kept[: len(states)]], actions[kept[: len(states)]]


def either_is_the_same(states, actions):
    """A repetition has the same state and the same action."""
    near = (states[:, :9] > 0).any(axis=1)
    states, actions = states[near], actions[near]
    same = (states[1:] == states[:-1]).all(axis=1) | (actions[1:] == actions[:-1])
    kept = np.concatenate([[True], ~same])[: len(states)]
    return states[kept], actions[kept]
