"""Acting on beliefs: QMDP and point-based value iteration.

The value of a belief is convex and, over a finite horizon, the largest of finitely many linear functions (Smallwood and
Sondik 1973). Each such function is a vector of one value a state, with the action it stands for.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.errors import ConvergenceWarning
from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
)

from .dynamic_programming import value_iteration
from .policies import as_distributions
from .pomdp import POMDP, SAME, BeliefMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class AlphaVectors:
    """A policy over beliefs, and what it is thought to earn.

    Attributes
    ----------
    vectors : (K, S).
    actions : (K,) the action that goes with each.
    iterations : backups of the whole set that were done.
    """

    vectors: Floats
    actions: NDArray[np.int64]
    iterations: int = 0

    def value(self, belief: ArrayLike) -> Floats:
        """Value (...) of one belief (S,) or many (..., S): the largest of the linear functions."""
        return (
            as_distributions("belief", belief, self.vectors.shape[1]) @ self.vectors.T
        ).max(axis=-1)

    def action(self, belief: ArrayLike) -> int:
        """The action of the vector that is largest at a belief (S,)."""
        check_array("belief", belief, shape=("S",))
        return int(
            self.actions[
                (
                    self.vectors
                    @ as_distributions("belief", belief, self.vectors.shape[1])
                ).argmax()
            ]
        )


def qmdp(pomdp: POMDP, *, tolerance: float = 1e-6) -> AlphaVectors:
    """Act as if all doubt were gone after this one step (Littman, Cassandra and Kaelbling 1995).

    One vector an action, Q*(., a) of the MDP underneath. Its values are an upper bound; its policy never takes an
    action only to learn something, since it believes that it will know everything anyway.
    """
    check_instance("pomdp", pomdp, POMDP)
    values = value_iteration(pomdp.mdp, tolerance).values
    return AlphaVectors(
        pomdp.mdp.action_values(values).T.copy(), np.arange(pomdp.mdp.n_actions)
    )


def spread_beliefs(pomdp: POMDP, start: ArrayLike, count: int) -> Floats:
    """Up to ``count`` beliefs (N, S) that can be reached from ``start``, as far apart as they come.

    Each new one is the successor, by any action and observation, that is furthest (sum of absolute differences) from
    those taken before; so the choice involves no chance. There are fewer where fewer can be reached.
    """
    check_instance("pomdp", pomdp, POMDP)
    check_integer("count", count, at_least=1)
    taken = [pomdp._belief(start)]
    candidates, distances = np.empty((0, pomdp.mdp.n_states)), np.empty(0)
    while len(taken) < count:
        distances = np.minimum(distances, abs(candidates - taken[-1]).sum(axis=1))
        new = np.concatenate(
            [
                BeliefMDP(pomdp).successors(taken[-1], action)[0]
                for action in range(pomdp.mdp.n_actions)
            ]
        )
        new_distances = np.min(
            [abs(new - belief).sum(axis=1) for belief in taken], axis=0
        )
        candidates, distances = (
            np.concatenate([candidates, new]),
            np.concatenate([distances, new_distances]),
        )
        furthest = int(distances.argmax())
        if distances[furthest] <= SAME:
            break
        taken.append(candidates[furthest])
        keep = distances > SAME
        keep[furthest] = False
        candidates, distances = candidates[keep], distances[keep]
    return np.stack(taken)


def point_based_value_iteration(
    pomdp: POMDP,
    beliefs: ArrayLike,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 10_000,
) -> AlphaVectors:
    """Value iteration at some beliefs only, one vector for each (Pineau, Gordon and Thrun 2003).

    Starts below every value (the worst reward for ever), and keeps for each point the best vector found so far; of
    vectors that are equally good there the one that is larger on the whole, since the next backup may look from
    another belief. So the values of the points rise, and stay a lower bound of the true ones, everywhere. More points
    come closer.

    Parameters
    ----------
    beliefs : (N, S) the points, such as :func:`spread_beliefs` finds.
    tolerance : how far values may still rise, in units of reward; positive. Stops when a backup replaces no point's
        vector by one that is larger by more than ``tolerance * (1 - discount)`` in any state: if it goes on like that,
        rises shrink by the discount, and all that would follow stay below the tolerance.
    max_iterations : backups after which to give up.

    Raises
    ------
    ValueError : if the discount is 1, with which there is nothing to start from, or a point is no belief.

    Warns
    -----
    ConvergenceWarning : if values were still rising; says by how much.
    """
    check_instance("pomdp", pomdp, POMDP)
    if pomdp.mdp.discount == 1:
        raise ValueError("point_based_value_iteration needs a discount below 1, got 1")
    check_array("beliefs", beliefs, shape=("N", pomdp.mdp.n_states))
    points = as_distributions("beliefs", beliefs, pomdp.mdp.n_states)
    if len(points) == 0:
        raise ValueError("beliefs must hold at least one belief, got none")
    enough = check_positive("tolerance", tolerance) * (1 - pomdp.mdp.discount)
    check_integer("max_iterations", max_iterations, at_least=1)
    worst = pomdp.mdp.rewards.min() / (1 - pomdp.mdp.discount)
    found = AlphaVectors(
        np.full((1, pomdp.mdp.n_states), worst), np.zeros(1, dtype=np.int64)
    )
    for iterations in range(1, max_iterations + 1):
        found, rise = improved_at(
            points, found, backup(pomdp, points, found), iterations
        )
        if rise <= enough:
            return found
    warnings.warn(
        f"point_based_value_iteration stopped after {max_iterations} backups with a value still rising by {rise:.3g}",
        ConvergenceWarning,
        stacklevel=2,
    )
    return found


def backup(pomdp: POMDP, points: Floats, known: AlphaVectors) -> AlphaVectors:
    """The best vector at each of N points, one step ahead of those known.

    For each action and observation the known vectors, which speak of the state s' that comes, are carried back to the
    state s that is: g(s) = sum_s' T(s, a, s') Z(o, s', a) alpha(s'). Each point takes the best g for each observation.
    """
    mdp = pomdp.mdp
    candidates = np.empty((mdp.n_actions, *points.shape))
    for action in range(mdp.n_actions):
        candidates[action] = mdp.rewards[:, action]
        for likelihood in pomdp.observations[action].T:
            carried = (
                mdp.transitions[action] @ (likelihood * known.vectors).T
            ).T  # (K, S)
            candidates[action] += (
                mdp.discount * carried[(points @ carried.T).argmax(axis=1)]
            )
    best = np.einsum("ans,ns->na", candidates, points).argmax(axis=1)
    return AlphaVectors(candidates[best, np.arange(len(points))], best)


def improved_at(
    points: Floats, old: AlphaVectors, new: AlphaVectors, iterations: int
) -> tuple[AlphaVectors, float]:
    """Of two sets, the vectors that are best at some point, and the most by which a point's vector rose in a state."""
    vectors, actions = (
        np.concatenate([old.vectors, new.vectors]),
        np.concatenate([old.actions, new.actions]),
    )
    chosen = best_at(points, vectors)
    rise = (vectors[chosen] - old.vectors[best_at(points, old.vectors)]).max()
    kept = np.unique(chosen)
    return AlphaVectors(vectors[kept], actions[kept], iterations), float(rise)


def best_at(points: Floats, vectors: Floats) -> NDArray[np.intp]:
    """Which vector is best at each point (N,); of those equal to rounding the one with the largest sum."""
    worth = points @ vectors.T
    rounding = 16 * np.finfo(float).eps * abs(vectors).max()
    ties = worth >= worth.max(axis=1, keepdims=True) - rounding
    return np.where(ties, vectors.sum(axis=1), -np.inf).argmax(axis=1)
