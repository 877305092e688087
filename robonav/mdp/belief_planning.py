"""Planning with beliefs: QMDP and point-based value iteration.

The value of a belief b is convex and, over a finite horizon, the largest of finitely many linear functions (Smallwood
and Sondik 1973). Each linear function is an alpha vector: one value a state, and the action that it stands for:

    V(b) = max over alpha of b . alpha,    b . alpha = sum over s of b(s) alpha(s).

The vectors for one more step follow from the known ones. For each action a and observation o, a known vector, which
holds values of the next state s', is carried back to the present state s. A belief then takes the best vector for each
observation, and the best action:

    g(s)     = sum over s' of T(s, a, s') Z(o, s', a) alpha(s'),
    alpha_ab = r_a + gamma * sum over o of argmax over g of b . g,
    alpha_b  = argmax over alpha_ab of b . alpha_ab.

For all beliefs together the number of vectors can grow exponentially. :func:`point_based_value_iteration` keeps one
vector for each belief of a fixed set, which :func:`spread_beliefs` chooses; :func:`backup` is its step. :func:`qmdp`
has one vector an action, from the values of the MDP.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import ArrayArgument, check_array

from ._arguments import checked
from .convergence import warns_not_converged
from .dynamic_programming import value_iteration
from .policies import as_distributions
from .pomdp import POMDP, SAME, BeliefMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AlphaVectors:
    """A policy over beliefs with the values that it promises.

    Attributes
    ----------
    vectors : (K, S) array
    actions : (K,) array of ints
        The action of each vector.
    iterations : int
        Number of backups of the whole set.
    residual : float
        Largest rise of a value in the last backup.
    converged : bool
        Whether it was as small as the tolerance asks for.

    Examples
    --------
    >>> from robonav.mdp import qmdp, tiger
    >>> plan = qmdp(tiger())
    >>> plan.action([0.5, 0.5]), plan.action([0.0, 1.0])
    (0, 1)
    """

    vectors: Floats
    actions: NDArray[np.int64]
    iterations: int = 0
    residual: float = 0.0
    converged: bool = True

    def value(self, belief: ArrayLike) -> Floats:
        """Value of one belief or of many: the largest of the linear functions.

        Parameters
        ----------
        belief : (..., S) array
            One belief, or several in rows.

        Returns
        -------
        (...) array

        Examples
        --------
        >>> from robonav.mdp import qmdp, tiger
        >>> qmdp(tiger()).value([[0.5, 0.5], [0.0, 1.0]]).round(1)
        array([189., 200.])
        """
        b = as_distributions("belief", belief, self.vectors.shape[1])
        return (b @ self.vectors.T).max(axis=-1)

    def action(self, belief: ArrayLike) -> int:
        """Action of the vector that is largest at a belief.

        Parameters
        ----------
        belief : (S,) array
            b.

        Returns
        -------
        int

        Examples
        --------
        >>> from robonav.mdp import qmdp, tiger
        >>> qmdp(tiger()).action([0.0, 1.0])
        1
        """
        check_array("belief", belief, shape=("S",))
        b = as_distributions("belief", belief, self.vectors.shape[1])
        return int(self.actions[(self.vectors @ b).argmax()])


@checked
def qmdp(pomdp: POMDP, *, tolerance: float = 1e-6) -> AlphaVectors:
    """QMDP: act as if the state were known after the next step (Littman, Cassandra and Kaelbling 1995).

    One vector an action: Q*(., a) of the underlying MDP. Its values are upper bounds. Its policy never takes an action
    only to learn something, since it assumes that it will know everything anyway.

    Parameters
    ----------
    pomdp : POMDP
    tolerance : float
        Largest loss of value in the underlying MDP.

    Returns
    -------
    AlphaVectors

    Examples
    --------
    >>> from robonav.mdp import qmdp, tiger
    >>> qmdp(tiger()).vectors.round(1)
    array([[189., 189.],
           [ 90., 200.],
           [200.,  90.]])
    """
    values = value_iteration(pomdp.mdp, tolerance).values
    q = pomdp.mdp.action_values(values)
    return AlphaVectors(q.T.copy(), np.arange(pomdp.mdp.n_actions))


def largest_rise(pomdp: POMDP, tolerance: float) -> float:
    """The largest rise of a value after which all later rises, each discounted, add up to at most ``tolerance``."""
    return tolerance * (1 - pomdp.mdp.discount)


@checked
@warns_not_converged(largest_rise)
def point_based_value_iteration(
    pomdp: POMDP,
    beliefs: ArrayArgument,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 10_000,
) -> AlphaVectors:
    """Point-based value iteration: back up at some beliefs only, one vector each (Pineau, Gordon and Thrun 2003).

    Starts below every value (the worst reward forever) and keeps the best vector found so far for each belief. Of
    vectors that are equally good there, it keeps the one with the larger sum, since the next backup may start from
    another belief. So the values of the beliefs rise and stay lower bounds everywhere. With more
    beliefs they come closer to the optimal values.

    The beliefs are fixed beforehand. The published method alternates: after some backups it adds a successor of each
    belief, the one that is furthest from all others, and backs up again.

    Parameters
    ----------
    pomdp : POMDP
    beliefs : (N, S) array
        Such as :func:`spread_beliefs` finds.
    tolerance : float
        How far values may still rise, in units of reward. Stops when a backup replaces no belief's vector by one that
        is larger by more than ``tolerance * (1 - discount)`` in any state: if later rises shrink by the discount, their
        sum stays below the tolerance.
    max_iterations : int
        Number of backups after which to give up.

    Returns
    -------
    AlphaVectors

    Raises
    ------
    ValueError
        If the discount is 1, for which there are no values to start from, or a row of ``beliefs`` is not a belief.

    Warns
    -----
    ConvergenceWarning
        If values were still rising; the message says by how much.

    Examples
    --------
    >>> from robonav.mdp import point_based_value_iteration, spread_beliefs, tiger
    >>> pomdp = tiger()
    >>> plan = point_based_value_iteration(pomdp, spread_beliefs(pomdp, [0.5, 0.5], 10))
    >>> round(float(plan.value([0.5, 0.5])), 2)
    19.37
    """
    epsilon = largest_rise(pomdp, tolerance)
    found = worst_vectors(pomdp)  # one vector, below every value
    for iteration in range(1, max_iterations + 1):
        backed_up = backup(pomdp, beliefs, found)
        found, rise = keep_best(beliefs, found, backed_up, iteration)
        if rise <= epsilon:
            break
    return replace(found, residual=rise, converged=rise <= epsilon)


def backup(pomdp: POMDP, points: Floats, known: AlphaVectors) -> AlphaVectors:
    """The best vector at each of N beliefs, one step ahead of the known ones.

    1. For each action a and observation o, the known vectors, which are values of the next state s', are carried back
       to the present state s: g(s) = sum over s' of T(s, a, s') Z(o, s', a) alpha(s').
    2. Each belief b takes the best g for each observation.
    3. They add up to a vector for each action, alpha_ab = r_a + gamma * sum over o of argmax_g b . g.
    4. Each belief takes the best action, alpha_b = argmax over the alpha_ab of b . alpha_ab.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.mdp import tiger
    >>> from robonav.mdp.belief_planning import backup, worst_vectors
    >>> pomdp = tiger()
    >>> found = backup(pomdp, np.array([[0.5, 0.5]]), worst_vectors(pomdp))
    >>> found.actions, found.vectors.round(1)
    (array([0]), array([[-1901., -1901.]]))
    """
    mdp = pomdp.mdp
    alphas = np.empty((mdp.n_actions, *points.shape))  # (A, N, S): alpha_ab
    for action in range(mdp.n_actions):
        alphas[action] = mdp.rewards[:, action]
        for likelihood in pomdp.observations[action].T:  # (S',): Z(o, s', a) of one o
            # 1: carry the known vectors back
            weighted = likelihood * known.vectors  # (K, S'): Z(o, s', a) alpha(s')
            g = (mdp.transitions[action] @ weighted.T).T  # (K, S): the sum over s'
            # 2, 3: take the best one for each belief, and add up
            best_g = (points @ g.T).argmax(axis=1)  # (N,)
            alphas[action] += mdp.discount * g[best_g]  # (N, S)
    # 4: take the best action for each belief
    values = np.einsum("ans,ns->na", alphas, points)  # (N, A): b . alpha_ab
    best = values.argmax(axis=1)  # (N,)
    return AlphaVectors(alphas[best, np.arange(len(points))], best)


def worst_vectors(pomdp: POMDP) -> AlphaVectors:
    """One vector (1, S) below all values: the worst reward forever."""
    worst = pomdp.mdp.rewards.min() / (1 - pomdp.mdp.discount)
    return AlphaVectors(
        np.full((1, pomdp.mdp.n_states), worst), np.zeros(1, dtype=np.int64)
    )


def keep_best(
    points: Floats, old: AlphaVectors, new: AlphaVectors, iterations: int
) -> tuple[AlphaVectors, float]:
    """The vectors of two sets that are best at some belief, and the largest rise of a belief's vector in a state."""
    vectors = np.concatenate([old.vectors, new.vectors])
    actions = np.concatenate([old.actions, new.actions])
    chosen = best_at(points, vectors)
    rise = (vectors[chosen] - old.vectors[best_at(points, old.vectors)]).max()
    kept = np.unique(chosen)
    return AlphaVectors(vectors[kept], actions[kept], iterations), float(rise)


def best_at(points: Floats, vectors: Floats) -> NDArray[np.intp]:
    """Index of the best vector at each belief (N,); of those equal to rounding, the one with the largest sum."""
    values = points @ vectors.T
    rounding = 16 * np.finfo(float).eps * abs(vectors).max()
    ties = values >= values.max(axis=1, keepdims=True) - rounding
    return np.where(ties, vectors.sum(axis=1), -np.inf).argmax(axis=1)


@checked
def spread_beliefs(pomdp: POMDP, start: ArrayLike, count: int) -> Floats:
    """Up to ``count`` beliefs that can be reached from ``start``, as far apart as possible.

    Each new belief is the successor, by any action and observation, that is furthest (sum of absolute differences)
    from those taken before, so nothing is random.

    Parameters
    ----------
    pomdp : POMDP
    start : (S,) array
        The first belief.
    count : int

    Returns
    -------
    (N, S) array
        N is less than ``count`` if fewer can be reached.

    Examples
    --------
    >>> from robonav.mdp import spread_beliefs, tiger
    >>> spread_beliefs(tiger(), [0.5, 0.5], 3).round(2)
    array([[0.5 , 0.5 ],
           [0.85, 0.15],
           [0.15, 0.85]])
    """
    taken = [pomdp.as_belief(start)]
    candidates, distances = np.empty((0, pomdp.mdp.n_states)), np.empty(0)
    while len(taken) < count:
        distances = np.minimum(distances, abs(candidates - taken[-1]).sum(axis=1))
        new = all_successors(pomdp, taken[-1])
        new_distances = np.min([abs(new - b).sum(axis=1) for b in taken], axis=0)
        candidates = np.concatenate([candidates, new])
        distances = np.concatenate([distances, new_distances])
        furthest = int(distances.argmax())
        if distances[furthest] <= SAME:
            break
        taken.append(candidates[furthest])
        keep = distances > SAME
        keep[furthest] = False
        candidates, distances = candidates[keep], distances[keep]
    return np.stack(taken)


def all_successors(pomdp: POMDP, belief: Floats) -> Floats:
    """Beliefs (K, S) that can follow a belief by any action."""
    beliefs = BeliefMDP(pomdp)
    actions = range(pomdp.mdp.n_actions)
    return np.concatenate([beliefs.successors(belief, a)[0] for a in actions])
