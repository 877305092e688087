"""The finite Markov decision process: states, actions, transitions, rewards, discount (section 2.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_positive, check_real

from . import policies

Arrays = tuple[
    NDArray[Any], NDArray[Any], NDArray[np.float64], NDArray[np.float64], float
]


@dataclass(frozen=True, eq=False, repr=False)
class FiniteMDP:
    """A finite MDP with S states and A actions, checked when it is made.

    What comes next depends on the state and the action alone (Eq. (2.2)): one row of ``transitions`` for each pair.

    Parameters
    ----------
    transitions : ``transitions[a][s, s']`` is the probability T(s, a, s') of reaching s' by action a from s: an array
        (A, S, S), or a sequence of A scipy sparse matrices (S, S). Kept in the form it came in, read-only.
    rewards : (S, A), the expected immediate reward r(s, a).
    discount : gamma in [0, 1]. Without discount (1) there must be terminal states (absorbing under every action,
        with reward 0) and a way to one of them from every state.

    Raises
    ------
    TypeError, ValueError : if shapes do not fit, numbers are not finite, probabilities are negative or do not sum
        to one, or the discount is out of range.
    """

    transitions: Any
    rewards: Any
    discount: float

    def __post_init__(self) -> None:
        transitions = _checked_transitions(self.transitions)
        shape = (transitions[0].shape[0], len(transitions))
        rewards = check_array("rewards", self.rewards, shape=shape).copy()
        rewards.flags.writeable = False
        object.__setattr__(self, "transitions", transitions)
        object.__setattr__(self, "rewards", rewards)
        object.__setattr__(
            self,
            "discount",
            check_real("discount", self.discount, at_least=0, at_most=1),
        )
        if self.discount == 1:
            stranded = np.isinf(self.steps_to_end)
            if stranded.any():
                raise ValueError(
                    "discount must be less than 1 unless every state can reach a terminal state (absorbing, reward 0), "
                    f"got 1 with state {int(stranded.argmax())} unable to"
                )

    def __repr__(self) -> str:
        kind = "sparse" if self.is_sparse else "dense"
        return f"FiniteMDP({self.n_states} states, {self.n_actions} actions, discount {self.discount:g}, {kind})"

    @classmethod
    def from_gymnasium(cls, env: Any, discount: float) -> FiniteMDP:
        """The model of an environment that publishes its table ``P[s][a] = [(probability, s', reward, ended), ...]``.

        Gymnasium's FrozenLake, Taxi and CliffWalking do. A state in which an episode ends becomes terminal.

        Raises
        ------
        ValueError : if the environment has no such table.
        """
        from .environments import (
            tabulate,  # the other way round, environments are made from models
        )

        return cls(*tabulate(env), discount)

    @property
    def n_states(self) -> int:
        """Number of states S."""
        return self.rewards.shape[0]

    @property
    def n_actions(self) -> int:
        """Number of actions A."""
        return self.rewards.shape[1]

    @property
    def is_sparse(self) -> bool:
        """Whether the transitions came as sparse matrices."""
        return isinstance(self.transitions, tuple)

    @cached_property
    def rows(self) -> sp.csr_array:
        """All transitions as one sparse matrix (S A, S); row s A + a holds T(s, a, .)."""
        if not self.is_sparse:
            return sp.csr_array(
                self.transitions.swapaxes(0, 1).reshape(-1, self.n_states)
            )
        by_action = sp.vstack(self.transitions, format="csr")
        return by_action[
            np.arange(self.n_states * self.n_actions)
            .reshape(self.n_actions, self.n_states)
            .T.ravel()
        ]

    @cached_property
    def arrays(self) -> Arrays:
        """What the compiled sweeps take: see ``packed``."""
        return packed(self.rows, self.rewards, self.discount)

    @cached_property
    def terminal(self) -> NDArray[np.bool_]:
        """Which states (S,) end an episode: absorbing under every action, with reward 0."""
        staying = np.stack([matrix.diagonal() for matrix in self.transitions])
        return (staying > 1 - policies.SUM_TOLERANCE).all(axis=0) & (
            self.rewards == 0
        ).all(axis=1)

    @cached_property
    def steps_to_end(self) -> NDArray[np.float64]:
        """Least number of steps (S,) in which a terminal state can be reached; infinite where none can."""
        return self.way_to(self.terminal)[0]

    @cached_property
    def rests(self) -> NDArray[np.bool_]:
        """Which actions (S, A) keep one for ever, if one likes, among states where nothing is earned: worth 0 for sure.

        Those of the terminal states do; elsewhere it is what a free wait is, or a free walk in circles.
        """
        rests = self.rewards == 0
        pairs = rests.ravel()  # a view
        restless = np.flatnonzero(~rests.any(axis=1))
        while restless.size:
            lost = np.unique(self.leading_to[restless].indices)
            lost = lost[pairs[lost]]
            pairs[lost] = False
            touched = np.unique(lost // self.n_actions)
            restless = touched[~rests[touched].any(axis=1)]
        rests.flags.writeable = False
        return rests

    @cached_property
    def leading_to(self) -> sp.csr_array:
        """Where each state can be reached from, (S, S A): row s', column s A + a holds T(s, a, s')."""
        return sp.csr_array(self.rows.T)

    def way_to(
        self, goals: NDArray[np.bool_], allowed: NDArray[np.bool_] | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
        """The way to some of the states ``goals`` (S,) with the fewest steps that can succeed.

        Parameters
        ----------
        goals : (S,), where to go.
        allowed : (S, A), the actions that may be used; all if left out.

        Returns
        -------
        steps : (S,), infinite where no goal can be reached.
        policy : (S,), whose every action leads one step closer as likely as any can (0 where none does). Followed for
            ever, it gets there with probability 1 if all steps are finite.
        """
        usable = (
            np.ones(self.rewards.size, dtype=bool)
            if allowed is None
            else allowed.ravel()
        )
        steps = np.where(goals, 0.0, np.inf)
        policy = np.zeros(self.n_states, dtype=np.intp)
        frontier = np.flatnonzero(goals)
        while frontier.size:
            distance = steps[frontier[0]] + 1
            closer = self.leading_to[frontier]
            found, which = np.unique(closer.indices, return_inverse=True)
            chance = np.bincount(which, closer.data, found.size)
            new = usable[found] & np.isinf(steps[found // self.n_actions])
            likeliest = np.lexsort((-chance[new], found[new] // self.n_actions))
            found = found[new][likeliest]
            frontier, first = np.unique(found // self.n_actions, return_index=True)
            steps[frontier], policy[frontier] = distance, found[first] % self.n_actions
        return steps, policy

    def action_values(self, values: ArrayLike) -> NDArray[np.float64]:
        """Action values (S, A) one step ahead of ``values`` (S,): r(s, a) + gamma sum_s' T(s, a, s') V(s').

        This is Q from V, Eq. (2.11) for the optimal values and Eq. (2.15) for those of a policy.
        """
        v = check_array("values", values, shape=(self.n_states,))
        ahead = (
            (self.rows @ v).reshape(self.rewards.shape)
            if self.is_sparse
            else (self.transitions @ v).T
        )
        return self.rewards + self.discount * ahead

    def greedy(self, values: ArrayLike) -> NDArray[np.intp]:
        """The greedy policy (S,) with regard to ``values`` (S,), Eq. (2.25); of equal actions the first."""
        return self.action_values(values).argmax(axis=1)

    def induced_chain(
        self, policy: ArrayLike
    ) -> tuple[sp.csr_array, NDArray[np.float64]]:
        """The Markov chain that a policy makes of the process: transitions (S, S) and rewards (S,).

        ``policy`` is (S,) actions or (S, A) probabilities; a stochastic one averages over its actions, Eq. (2.6).
        """
        chosen = policies.check_policy(policy, self.n_states, self.n_actions)
        state = np.arange(self.n_states)
        if chosen.ndim == 1:
            return self.rows[state * self.n_actions + chosen], self.rewards[
                state, chosen
            ]
        starts = np.arange(0, chosen.size + 1, self.n_actions)
        average = sp.csr_array(
            (chosen.ravel(), np.arange(chosen.size), starts),
            (self.n_states, chosen.size),
        )
        return sp.csr_array(average @ self.rows), (chosen * self.rewards).sum(axis=1)

    def residual_for(self, tolerance: float) -> float:
        """How little a sweep of value iteration must change for its greedy policy to lose at most ``tolerance``.

        tolerance (1 - gamma) / (2 gamma), Puterman (2005), Theorem 6.3.1: infinite for discount 0. Without
        discount there is no such bound, and it is ``tolerance`` itself.
        """
        check_positive("tolerance", tolerance)
        if self.discount == 0:
            return np.inf
        return (
            tolerance
            if self.discount == 1
            else tolerance * (1 - self.discount) / (2 * self.discount)
        )


def packed(rows: sp.csr_array, rewards: NDArray[np.float64], discount: float) -> Arrays:
    """A model as the compiled sweeps take it: starts, successors, chances (see ``kernels``), rewards, discount.

    ``rows`` is (S A, S), row s A + a holding T(s, a, .); ``rewards`` (S, A).
    """
    starts, successors = (
        part.view(f"u{part.itemsize}") for part in (rows.indptr, rows.indices)
    )
    fixed = rewards.view()
    fixed.flags.writeable = (
        False  # numba compiles for a read-only array anew: one kind only
    )
    return starts, successors, rows.data, fixed, discount


def expected_rewards(transitions: Any, rewards: ArrayLike) -> NDArray[np.float64]:
    """Rewards r(s, a), (S, A), of rewards R(s', a, s) that depend on the state reached, given as (A, S, S')."""
    checked = _checked_transitions(transitions)
    states = checked[0].shape[0]
    reached = check_array("rewards", rewards, shape=(len(checked), states, states))
    return np.stack(
        [
            np.asarray((t * r).sum(axis=1))
            for t, r in zip(checked, reached, strict=True)
        ],
        axis=1,
    )


def _checked_transitions(
    transitions: Any,
) -> NDArray[np.float64] | tuple[sp.csr_array, ...]:
    """A read-only copy: an array (A, S, S), or a tuple of A sparse arrays (S, S)."""
    checked: NDArray[np.float64] | tuple[sp.csr_array, ...]
    if sp.issparse(transitions):
        raise TypeError(
            "transitions must be a sequence of A sparse matrices (S, S), got one sparse matrix"
        )
    if isinstance(transitions, Sequence) and any(
        sp.issparse(matrix) for matrix in transitions
    ):
        checked = tuple(
            _checked_sparse(action, matrix, transitions)
            for action, matrix in enumerate(transitions)
        )
        parts = [
            part
            for matrix in checked
            for part in (matrix.data, matrix.indices, matrix.indptr)
        ]
    else:
        checked = check_array("transitions", transitions, shape=("A", "S", "S")).copy()
        if checked.shape[1] != checked.shape[2]:
            raise ValueError(
                f"transitions must have shape (A, S, S), got {checked.shape}"
            )
        parts = [checked]
    if len(checked) == 0 or checked[0].shape[0] == 0:
        raise ValueError("transitions must hold at least one action and one state")
    for part in parts:
        part.flags.writeable = False
    for action, matrix in enumerate(checked):
        _check_rows(action, matrix)
    return checked


def _checked_sparse(
    action: int, matrix: Any, transitions: Sequence[Any]
) -> sp.csr_array:
    """A canonical copy of one action's sparse matrix."""
    if not sp.issparse(matrix):
        raise TypeError(
            f"transitions must be all sparse or all dense, got {type(matrix).__name__} at action {action}"
        )
    states = transitions[0].shape[0]
    if matrix.shape != (states, states):
        raise ValueError(
            f"transitions must hold matrices ({states}, {states}), got {matrix.shape} at action {action}"
        )
    copy = sp.csr_array(matrix, dtype=float, copy=True)
    copy.sum_duplicates()
    copy.eliminate_zeros()
    check_array("transitions", copy.data)
    return copy


def _check_rows(action: int, matrix: NDArray[np.float64] | sp.csr_array) -> None:
    """ValueError unless every row is a distribution."""
    probabilities = matrix if isinstance(matrix, np.ndarray) else matrix.data
    if probabilities.min(initial=0) < 0:
        raise ValueError(
            f"transitions must not hold negative probabilities, got one at action {action}"
        )
    totals = np.asarray(matrix.sum(axis=1))
    state = int(abs(totals - 1).argmax())
    if abs(totals[state] - 1) > policies.SUM_TOLERANCE:
        raise ValueError(
            "transitions must sum to 1 over the states reached, "
            f"got {totals[state]:.10g} at action {action}, state {state}"
        )
