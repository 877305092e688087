"""Planning without discount: the stochastic shortest path problem (Bertsekas and Tsitsiklis 1991).

A policy is *proper* if it reaches a terminal state with probability 1 from every state. With gamma = 1 the backup is a
contraction only under proper policies, which raises three problems that discounted planning does not have:

- A loop of zero-reward actions keeps whatever value it starts from, though the value of staying in it is 0. So values
  of such actions are clamped at 0 from below (:func:`clamp_undiscounted`), and sweeps start from below
  (:func:`proper_values`).
- An action that waits can be as greedy as the one that goes to the goal. So among greedy actions those are taken that
  lead towards a terminal state (:func:`greedy_actions`).
- A policy that collects rewards forever has no finite value (:func:`policy_values` refuses it).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import csgraph

from . import policies
from .linear_solver import solve
from .models import FiniteMDP

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


def once_per_model(function: Callable[[FiniteMDP], Any]) -> Callable[[FiniteMDP], Any]:
    """Keep the result of a function for as long as its model exists."""
    known: WeakKeyDictionary[FiniteMDP, Any] = WeakKeyDictionary()

    @wraps(function)
    def kept(mdp: FiniteMDP) -> Any:
        """The answer for a model, kept for the next call."""
        if mdp not in known:
            known[mdp] = function(mdp)
        return known[mdp]

    return kept


@once_per_model
def predecessors(mdp: FiniteMDP) -> sp.csr_array:
    """Pairs from which each state can be reached, (S, S A): row s', column s A + a holds T(s, a, s')."""
    return sp.csr_array(mdp.rows.T)


@once_per_model
def zero_reward_absorbing(mdp: FiniteMDP) -> Bools:
    """Actions (S, A) with which the agent can stay forever in zero-reward states; their value is at least 0.

    Found by elimination: starting from all pairs with reward 0, remove those that may lead to a state without any pair
    left, until nothing changes.

    Examples
    --------
    >>> from robonav.mdp import GridWorld
    >>> corridor = GridWorld("S . G", step_reward=-1).mdp(1.0)  # the step into G gives 0
    >>> zero_reward_absorbing(corridor).any(axis=1)
    array([False,  True,  True])
    """
    staying = np.ascontiguousarray(mdp.rewards == 0)
    pairs = staying.ravel()  # a view
    left = np.flatnonzero(~staying.any(axis=1))
    while left.size:
        lost = np.unique(predecessors(mdp)[left].indices)
        lost = lost[pairs[lost]]
        pairs[lost] = False
        touched = np.unique(lost // mdp.n_actions)
        left = touched[~staying[touched].any(axis=1)]
    staying.flags.writeable = False
    return staying


def shortest_path_policy(
    mdp: FiniteMDP, goals: Bools, allowed: Bools | None = None
) -> tuple[Floats, NDArray[np.intp]]:
    """Reach some of the states ``goals`` in the fewest steps that can succeed.

    Breadth-first search backwards from the goals.

    Parameters
    ----------
    mdp : FiniteMDP
    goals : (S,) array of bools
    allowed : (S, A) array of bools, optional
        The actions that may be used; all by default.

    Returns
    -------
    steps : (S,) array
        Least number of steps; infinite where no goal can be reached.
    policy : (S,) array of ints
        The action that leads one step closer with the largest probability (0 where none does). Following it reaches a
        goal with probability 1 from every state if all ``steps`` are finite.

    Examples
    --------
    >>> from robonav.mdp import GridWorld
    >>> corridor = GridWorld("S . G", step_reward=-1).mdp(1.0)
    >>> steps, policy = shortest_path_policy(corridor, corridor.terminal)
    >>> steps, policy[:2]
    (array([2., 1., 0.]), array([1, 1]))
    """
    usable = (
        np.ones(mdp.rewards.size, dtype=bool) if allowed is None else allowed.ravel()
    )
    steps = np.where(goals, 0.0, np.inf)
    policy = np.zeros(mdp.n_states, dtype=np.intp)
    frontier = np.flatnonzero(goals)
    while frontier.size:
        distance = steps[frontier[0]] + 1
        closer = predecessors(mdp)[frontier]
        found, which = np.unique(closer.indices, return_inverse=True)
        probability = np.bincount(which, closer.data, found.size)
        new = usable[found] & np.isinf(steps[found // mdp.n_actions])
        likeliest_first = np.lexsort((-probability[new], found[new] // mdp.n_actions))
        found = found[new][likeliest_first]
        frontier, first = np.unique(found // mdp.n_actions, return_index=True)
        steps[frontier], policy[frontier] = distance, found[first] % mdp.n_actions
    return steps, policy


def clamp_undiscounted(mdp: FiniteMDP, q: Floats) -> Floats:
    """Action values (S, A), without discount at least 0 where the action lets the agent stay in zero-reward states.

    With gamma < 1 the backup converges to 0 for a zero-reward loop. With gamma = 1 the loop keeps the value that it
    starts from (say -1), so it is clamped to 0.

    Examples
    --------
    >>> from robonav.mdp import FiniteMDP
    >>> waiting = FiniteMDP([[[1.0]]], [[0.0]], 1.0)
    >>> clamp_undiscounted(waiting, np.array([[-1.0]]))
    array([[0.]])
    """
    if mdp.discount < 1:
        return q
    return np.where(zero_reward_absorbing(mdp), np.maximum(q, 0), q)


def proper_values(mdp: FiniteMDP, start: Floats) -> Floats:
    """Values (S,) of a proper policy, from which sweeps without discount converge.

    The policy is greedy for the values ``start`` where that leads to a terminal state, and the shortest path
    elsewhere. Where the agent can stay in zero-reward states instead, the value is at least 0.

    Examples
    --------
    >>> from robonav.mdp import GridWorld
    >>> corridor = GridWorld("S . G", step_reward=-1).mdp(1.0)
    >>> proper_values(corridor, np.zeros(3))
    array([-1.,  0.,  0.])
    """
    _, shortest = shortest_path_policy(mdp, mdp.terminal)
    greedy = policies.greedy_action_mask(mdp.action_values(start))
    steps, onwards = shortest_path_policy(mdp, mdp.terminal, greedy)
    policy = np.where(np.isfinite(steps), onwards, shortest)
    values = policy_values(*mdp.induced_chain(policy), guess=start)
    staying = zero_reward_absorbing(mdp).any(axis=1)
    return np.where(staying, np.maximum(values, 0), values)


def greedy_actions(
    mdp: FiniteMDP, values: Floats, tolerance: float
) -> NDArray[np.intp]:
    """Greedy policy (S,) that also ends, for optimal values known to within ``tolerance``.

    An action that waits forever can be as greedy as one that goes on, but its return is 0. So of the greedy
    actions take one that leads closer to a terminal state or, where 0 is the optimal value, to a state in which the
    agent can stay without reward.

    Examples
    --------
    >>> from robonav.mdp import GridWorld
    >>> corridor = GridWorld("S . G", step_reward=-1).mdp(1.0)
    >>> greedy_actions(corridor, np.array([-2.0, -1.0, 0.0]), 1e-9)[:2]
    array([1, 1])
    """
    q = clamp_undiscounted(mdp, mdp.action_values(values))
    best = policies.greedy_action_mask(q, tolerance=tolerance)
    steps, onwards = shortest_path_policy(mdp, mdp.terminal, best)
    ends = np.isfinite(steps)
    staying = zero_reward_absorbing(mdp)
    stays = staying.any(axis=1) & (values <= tolerance) & ~ends
    steps, towards = shortest_path_policy(mdp, ends | stays, best)
    return np.select(
        [ends, stays, np.isfinite(steps)],
        [onwards, staying.argmax(axis=1), towards],
        default=q.argmax(axis=1),
    )


def policy_values(
    transitions: sp.csr_array, rewards: Floats, *, guess: Floats, name: str = "policy"
) -> Floats:
    """Values (S,) of the policy ``name`` without discount, from the chain that it induces.

    States of a closed class have value 0; the others solve V = r + T V.

    Raises
    ------
    ValueError
        If the chain collects rewards forever, so that its values are not finite.
    """
    moving = ~closed_classes(transitions, rewards, name)
    values = np.zeros(rewards.size)
    equations = (
        sp.eye_array(moving.sum(), format="csr") - transitions[moving][:, moving]
    )
    values[moving] = solve(equations, rewards[moving], guess[moving])
    return values


def closed_classes(transitions: sp.csr_array, rewards: Floats, name: str) -> Bools:
    """Which states (S,) lie in a class that the chain never leaves. A chain that pays rewards there is refused."""
    count, member = csgraph.connected_components(transitions, connection="strong")
    source, reached = transitions.nonzero()
    closed = np.ones(count, dtype=bool)
    closed[member[source[member[source] != member[reached]]]] = False
    rewarded = closed[member] & (rewards != 0)
    if rewarded.any():
        raise ValueError(
            f"{name} must not collect rewards forever where discount is 1, "
            f"but it returns to state {int(rewarded.argmax())} forever, which pays a reward"
        )
    return closed[member]
