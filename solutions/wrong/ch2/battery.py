"""Known mistakes in 2.7; a function's docstring is its hint."""

import numpy as np


def counts_steps(transitions, rewards, costs, charge):
    """This counts steps. Subtract the units that each action uses."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        possible = [a for a, cost in enumerate(costs) if cost <= left]
        if possible:
            values[left] = np.max(
                [rewards[:, a] + transitions[a] @ values[left - 1] for a in possible],
                axis=0,
            )
    return values


def runs_dry(transitions, rewards, costs, charge):
    """An action that needs more units than are left is not possible."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        q = [
            rewards[:, a] + transitions[a] @ values[max(left - cost, 0)]
            for a, cost in enumerate(costs)
        ]
        values[left] = np.max(q, axis=0)
    return values


def may_stop(transitions, rewards, costs, charge):
    """The robot cannot choose to stop: it must take a possible action even if all of them have negative rewards."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        q = [
            rewards[:, a] + transitions[a] @ values[left - cost]
            for a, cost in enumerate(costs)
            if cost <= left
        ]
        values[left] = np.max([np.zeros(transitions.shape[1]), *q], axis=0)
    return values


def keeps_the_last_unit(transitions, rewards, costs, charge):
    """An action that needs exactly the units that are left is still possible."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        possible = [a for a, cost in enumerate(costs) if cost < left]
        if possible:
            values[left] = np.max(
                [
                    rewards[:, a] + transitions[a] @ values[left - costs[a]]
                    for a in possible
                ],
                axis=0,
            )
    return values


def full_first(transitions, rewards, costs, charge):
    """Row c is for c units left, so the first row is for an empty battery."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        possible = [a for a, cost in enumerate(costs) if cost <= left]
        if possible:
            values[left] = np.max(
                [
                    rewards[:, a] + transitions[a] @ values[left - costs[a]]
                    for a in possible
                ],
                axis=0,
            )
    return values[::-1]


def counts_steps_freely(transitions, rewards, costs, charge):
    """Charge is not the number of steps: an action uses its own units, and needs as many as it uses."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        q = [
            rewards[:, a] + transitions[a] @ values[left - 1] for a in range(len(costs))
        ]
        values[left] = np.max(q, axis=0)
    return values


def wraps_around(transitions, rewards, costs, charge):
    """A negative index counts from the end in Python: leave out actions that need more units than are left."""
    values = [np.zeros(transitions.shape[1])]
    for left in range(1, charge + 1):
        q = [
            rewards[:, a] + transitions[a] @ values[left - cost]
            for a, cost in enumerate(costs)
            if left - cost >= -len(values)
        ]
        values.append(np.max(q, axis=0) if q else np.zeros(transitions.shape[1]))
    return np.array(values)


def same_charge(transitions, rewards, costs, charge):
    """After the action less charge is left: use the row of the units that remain."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        possible = [a for a, cost in enumerate(costs) if cost <= left]
        if possible:
            values[left] = np.max([rewards[:, a] for a in possible], axis=0)
    return values


def worth_minus_infinity(transitions, rewards, costs, charge):
    """If no action is possible the episode ends, and the value is 0, not minus infinity."""
    values = np.full((charge + 1, transitions.shape[1]), -np.inf)
    values[0] = 0.0
    for left in range(1, charge + 1):
        for a, cost in enumerate(costs):
            if cost <= left:
                q = rewards[:, a] + transitions[a] @ values[left - cost]
                values[left] = np.maximum(values[left], q)
    return values


def averages(transitions, rewards, costs, charge):
    """The robot takes the best action, so take the maximum over the possible actions, not their mean."""
    values = np.zeros((charge + 1, transitions.shape[1]))
    for left in range(1, charge + 1):
        possible = [a for a, cost in enumerate(costs) if cost <= left]
        if possible:
            values[left] = np.mean(
                [
                    rewards[:, a] + transitions[a] @ values[left - costs[a]]
                    for a in possible
                ],
                axis=0,
            )
    return values
