"""Inner loops of planning, compiled: one sweep over all states each.

Transitions are the three arrays of ``FiniteMDP.rows``, a CSR matrix whose row s A + a holds T(s, a, .): the successors
of (s, a) are ``successors[starts[row]:starts[row + 1]]``, and ``probabilities`` is laid out in the same way. Positions
are unsigned, so that numba need not handle Python's negative ones (twice as fast). All kernels are serial, release the
interpreter's lock, and are in one file because numba's cache does not notice an edit in another.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.compilation import compiler

Floats = NDArray[np.float64]
Unsigned = NDArray[Any]
Actions = NDArray[np.intp]

compiled = compiler()
inlined = compiler(inline=True)


@inlined
def action_value(
    row: int,
    reward: float,
    starts: Unsigned,
    successors: Unsigned,
    probabilities: Floats,
    discount: float,
    values: Floats,
) -> float:
    """One action value: r(s, a) + gamma sum over s' of T(s, a, s') V(s')."""
    ahead = 0.0
    for k in range(starts[np.uint64(row)], starts[np.uint64(row + 1)]):
        ahead += probabilities[k] * values[successors[k]]
    return reward + discount * ahead


@inlined
def best_action(
    state: int,
    starts: Unsigned,
    successors: Unsigned,
    probabilities: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
) -> tuple[float, int]:
    """The largest action value of a state, and the first action that has it."""
    best, chosen = -np.inf, 0
    actions = rewards.shape[1]
    for action in range(actions):
        reward = rewards[state, action]
        value = action_value(
            state * actions + action,
            reward,
            starts,
            successors,
            probabilities,
            discount,
            values,
        )
        if value > best:
            best, chosen = value, action
    return best, chosen


@compiled
def optimal_sweep(
    starts: Unsigned,
    successors: Unsigned,
    probabilities: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
    out: Floats,
    policy: Actions,
) -> tuple[float, float]:
    """Write the best action values to ``out`` and the actions to ``policy``; return the least and largest change."""
    least, most = np.inf, -np.inf
    for state in range(values.size):
        best, chosen = best_action(
            state, starts, successors, probabilities, rewards, discount, values
        )
        out[state] = best
        policy[state] = chosen
        change = best - values[state]
        least = min(least, change)
        most = max(most, change)
    return least, most


@compiled
def policy_sweep(
    starts: Unsigned,
    successors: Unsigned,
    probabilities: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
    out: Floats,
    policy: Actions,
) -> float:
    """Write the action value of each state under ``policy`` to ``out``; return the largest absolute change."""
    actions = rewards.shape[1]
    most = 0.0
    for state in range(values.size):
        action = policy[state]
        reward = rewards[state, action]
        value = action_value(
            state * actions + action,
            reward,
            starts,
            successors,
            probabilities,
            discount,
            values,
        )
        out[state] = value
        most = max(most, abs(value - values[state]))
    return most


@compiled
def in_place_sweep(
    starts: Unsigned,
    successors: Unsigned,
    probabilities: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
) -> float:
    """Back up every state with the values as they are by then; return the largest absolute change."""
    most = 0.0
    for state in range(values.size):
        best, _ = best_action(
            state, starts, successors, probabilities, rewards, discount, values
        )
        most = max(most, abs(best - values[state]))
        values[state] = best
    return most


@compiled
def sink(heap: Actions, place: Actions, priority: Floats) -> None:
    """Let the state on top of the heap sink to where it belongs."""
    state, at = heap[0], 0
    while 2 * at + 1 < heap.size:
        child = 2 * at + 1
        if child + 1 < heap.size and priority[heap[child + 1]] > priority[heap[child]]:
            child += 1
        if priority[heap[child]] <= priority[state]:
            break
        heap[at] = heap[child]
        place[heap[at]] = at
        at = child
    heap[at] = state
    place[state] = at


@compiled
def rise(heap: Actions, place: Actions, priority: Floats, at: int) -> None:
    """Let the state at one place of the heap rise to where it belongs."""
    state = heap[at]
    while at > 0 and priority[heap[(at - 1) // 2]] < priority[state]:
        heap[at] = heap[(at - 1) // 2]
        place[heap[at]] = at
        at = (at - 1) // 2
    heap[at] = state
    place[state] = at


@compiled
def prioritized_backups(
    starts: Unsigned,
    successors: Unsigned,
    probabilities: Floats,
    rewards: Floats,
    discount: float,
    into: Unsigned,
    predecessors: Unsigned,
    weights: Floats,
    values: Floats,
    priority: Floats,
    heap: Actions,
    limit: float,
    max_backups: int,
) -> tuple[int, float]:
    """Back up the state of largest priority until none exceeds ``limit``; return the backups and the largest priority.

    ``values`` and ``priority`` change in place. ``heap`` is a binary heap of states, the largest priority on top (a
    sorted array is a heap); ``place`` holds the position of each state in it.
    """
    place = np.empty_like(heap)
    for at in range(heap.size):
        place[heap[at]] = at
    backups = 0
    while priority[heap[0]] > limit and backups < max_backups:
        state = heap[0]
        best, _ = best_action(
            state, starts, successors, probabilities, rewards, discount, values
        )
        change = abs(best - values[state])
        values[state] = best
        priority[state] = 0.0
        sink(heap, place, priority)
        for k in range(into[np.uint64(state)], into[np.uint64(state + 1)]):
            before = predecessors[k]
            priority[before] += discount * weights[k] * change
            rise(heap, place, priority, place[before])
        backups += 1
    return backups, priority[heap[0]]
