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
