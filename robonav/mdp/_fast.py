"""The inner loops of planning, compiled: a sweep over all states each.

Transitions come as the three arrays of ``FiniteMDP.rows``, a CSR matrix whose row s A + a holds T(s, a, .): the
successors of (s, a) are ``successors[starts[row]:starts[row + 1]]``, their probabilities stand likewise in ``chances``.
Positions are unsigned, which spares numba the test for Python's negative ones (twice as fast). All is serial, without
the interpreter's lock, and in one file because numba's cache does not see an edit in another.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Unsigned = NDArray[Any]
Actions = NDArray[np.intp]
Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """A kernel callers see with its own signature."""
    kernel: Any = njit(cache=True, nogil=True)(function)
    return kernel


def inlined(function: Function) -> Function:
    """A part of kernels, written out where it is used: calls with so many arrays would cost more than the work."""
    part: Any = njit(inline="always")(function)
    return part


@inlined
def action_value(
    row: int,
    reward: float,
    starts: Unsigned,
    successors: Unsigned,
    chances: Floats,
    discount: float,
    values: Floats,
) -> float:
    """One entry of the backup: r(s, a) + gamma sum_s' T(s, a, s') V(s')."""
    ahead = 0.0
    for k in range(starts[np.uint64(row)], starts[np.uint64(row + 1)]):
        ahead += chances[k] * values[successors[k]]
    return reward + discount * ahead


@inlined
def best_action(
    state: int,
    starts: Unsigned,
    successors: Unsigned,
    chances: Floats,
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
            chances,
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
    chances: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
    out: Floats,
    policy: Actions,
) -> tuple[float, float]:
    """``out`` = the best action value of each state, ``policy`` its action; least and largest change."""
    least, most = np.inf, -np.inf
    for state in range(values.size):
        best, chosen = best_action(
            state, starts, successors, chances, rewards, discount, values
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
    chances: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
    out: Floats,
    policy: Actions,
) -> float:
    """``out`` = the action value of each state under ``policy``; largest absolute change."""
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
            chances,
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
    chances: Floats,
    rewards: Floats,
    discount: float,
    values: Floats,
) -> float:
    """Back up every state with the values as they are by then; largest absolute change."""
    most = 0.0
    for state in range(values.size):
        best, _ = best_action(
            state, starts, successors, chances, rewards, discount, values
        )
        most = max(most, abs(best - values[state]))
        values[state] = best
    return most


@compiled
def sink(heap: Actions, place: Actions, urgency: Floats) -> None:
    """Let the state on top of the heap sink to where it belongs."""
    state, at = heap[0], 0
    while 2 * at + 1 < heap.size:
        child = 2 * at + 1
        if child + 1 < heap.size and urgency[heap[child + 1]] > urgency[heap[child]]:
            child += 1
        if urgency[heap[child]] <= urgency[state]:
            break
        heap[at] = heap[child]
        place[heap[at]] = at
        at = child
    heap[at] = state
    place[state] = at


@compiled
def rise(heap: Actions, place: Actions, urgency: Floats, at: int) -> None:
    """Let the state at one place of the heap rise to where it belongs."""
    state = heap[at]
    while at > 0 and urgency[heap[(at - 1) // 2]] < urgency[state]:
        heap[at] = heap[(at - 1) // 2]
        place[heap[at]] = at
        at = (at - 1) // 2
    heap[at] = state
    place[state] = at


@compiled
def prioritized_backups(
    starts: Unsigned,
    successors: Unsigned,
    chances: Floats,
    rewards: Floats,
    discount: float,
    into: Unsigned,
    predecessors: Unsigned,
    weights: Floats,
    values: Floats,
    urgency: Floats,
    heap: Actions,
    enough: float,
    max_backups: int,
) -> tuple[int, float]:
    """Back up the most urgent state until none is more urgent than ``enough``; backups done, largest urgency left.

    ``values`` and ``urgency`` change in place. ``heap`` is a binary heap of states, the most urgent on top (sorted is
    a heap too); ``place`` says where in it each state is.
    """
    place = np.empty_like(heap)
    for at in range(heap.size):
        place[heap[at]] = at
    backups = 0
    while urgency[heap[0]] > enough and backups < max_backups:
        state = heap[0]
        best, _ = best_action(
            state, starts, successors, chances, rewards, discount, values
        )
        change = abs(best - values[state])
        values[state] = best
        urgency[state] = 0.0
        sink(heap, place, urgency)
        for k in range(into[np.uint64(state)], into[np.uint64(state + 1)]):
            before = predecessors[k]
            urgency[before] += discount * weights[k] * change
            rise(heap, place, urgency, place[before])
        backups += 1
    return backups, urgency[heap[0]]
