"""The finite Markov decision process: states, actions, transitions, rewards, discount (section 2.2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csgraph

from robonav.counting import counted
from robonav.validation import check_array, check_real

from . import policies
from ._arguments import checked, require_type, takes_policy, takes_values
from ._model_arrays import (
    checked_rewards,
    checked_transitions,
    with_small_indices,
)

Arrays = tuple[
    NDArray[Any], NDArray[Any], NDArray[np.float64], NDArray[np.float64], float
]


@dataclass(frozen=True, eq=False, repr=False)
class FiniteMDP:
    """A finite MDP with S states and A actions, checked when it is made.

    The next state depends on the present state and action alone, Eq. (2.2): each pair has one row of ``transitions``.

    Every action is allowed in every state. Write an action that is forbidden in a state as a copy of one that is
    allowed there: the same transitions and the same reward. The optimal values are then those of the allowed actions.
    A reward of minus infinity is refused.

    Parameters
    ----------
    transitions : (A, S, S) array or sequence of A sparse (S, S) matrices
        ``transitions[a][s, s']`` is the probability T(s, a, s') of reaching s' from s by action a. Kept dense or
        sparse, as it was given, and read-only. An array of A matrices as objects is a sequence too.
    rewards : (S, A) array
        Expected immediate reward r(s, a).
    discount : float
        gamma, in [0, 1]. A discount of 1 needs terminal states (absorbing under every action, reward 0), at least one
        of which can be reached from every state.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, numbers are not finite, probabilities are negative or do not sum to one, or the discount
        is out of range.

    Examples
    --------
    State 0 is left by action 1, for a reward of 1; state 1 is terminal.

    >>> from robonav.mdp import FiniteMDP
    >>> stay, leave = [[1, 0], [0, 1]], [[0, 1], [0, 1]]
    >>> mdp = FiniteMDP([stay, leave], rewards=[[0, 1], [0, 0]], discount=0.9)
    >>> mdp
    FiniteMDP(2 states, 2 actions, discount 0.9, dense)
    >>> mdp.action_values([1.0, 0.0])
    array([[0.9, 1. ],
           [0. , 0. ]])
    """

    transitions: Any
    rewards: Any
    discount: float

    def __post_init__(self) -> None:
        transitions = checked_transitions(self.transitions)
        shape = (transitions[0].shape[0], len(transitions))
        rewards = checked_rewards(self.rewards, shape).copy(order="F")
        rewards.flags.writeable = False
        discount = check_real("discount", self.discount, at_least=0, at_most=1)
        object.__setattr__(self, "transitions", transitions)
        object.__setattr__(self, "rewards", rewards)
        object.__setattr__(self, "discount", discount)
        if discount == 1:
            stranded = ~self._reaching_terminal()
            if stranded.any():
                raise ValueError(
                    "discount must be less than 1 unless every state can reach a terminal state (absorbing, reward 0), "
                    f"got 1 with state {int(stranded.argmax())} unable to"
                )

    def __reduce__(self) -> tuple[type, tuple[Any, ...]]:
        """Make copies by the constructor, so that their arrays are read-only too."""
        return type(self), (self.transitions, self.rewards, self.discount)

    def __repr__(self) -> str:
        kind = "sparse" if self.is_sparse else "dense"
        states = counted(self.n_states, "state")
        actions = counted(self.n_actions, "action")
        return f"FiniteMDP({states}, {actions}, discount {self.discount:g}, {kind})"

    @classmethod
    def from_gymnasium(cls, env: Any, discount: float) -> FiniteMDP:
        """Return the model of an environment that publishes its table of transitions.

        The table is ``P[s][a] = [(probability, s', reward, terminated), ...]``, as Gymnasium's FrozenLake, Taxi and
        CliffWalking have it. A state in which an episode ends becomes terminal.

        Parameters
        ----------
        env : gymnasium.Env
            The environment.
        discount : float
            gamma, in [0, 1].

        Returns
        -------
        FiniteMDP

        Raises
        ------
        ValueError
            If the environment has no such table.

        Examples
        --------
        >>> import gymnasium
        >>> from robonav.mdp import FiniteMDP
        >>> FiniteMDP.from_gymnasium(gymnasium.make("FrozenLake-v1"), discount=0.9)
        FiniteMDP(16 states, 4 actions, discount 0.9, sparse)
        """
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
        """Whether the transitions are sparse matrices."""
        return isinstance(self.transitions, tuple)

    @cached_property
    def terminal(self) -> NDArray[np.bool_]:
        """Which states (S,) end an episode: absorbing under every action, with reward 0."""
        staying = np.stack([matrix.diagonal() for matrix in self.transitions])
        return (staying > 1 - policies.SUM_TOLERANCE).all(axis=0) & (
            self.rewards == 0
        ).all(axis=1)

    @cached_property
    def by_action(self) -> sp.csr_array:
        """All transitions as one sparse matrix (A S, S); row a S + s holds T(s, a, .)."""
        if not self.is_sparse:
            return sp.csr_array(self.transitions.reshape(-1, self.n_states))
        return with_small_indices(
            sp.csr_array(sp.vstack(self.transitions, format="csr"))
        )

    @cached_property
    def rows(self) -> sp.csr_array:
        """All transitions as one sparse matrix (S A, S); row s A + a holds T(s, a, .)."""
        pairs = np.arange(self.n_states * self.n_actions)
        order = pairs.reshape(self.n_actions, self.n_states).T.ravel()
        return with_small_indices(self.by_action[order])

    def transitions_from(self, state: int) -> sp.csr_array:
        """Transitions T(s, a, s') from one state s, one row an action.

        Parameters
        ----------
        state : int
            s.

        Returns
        -------
        (A, S') sparse array

        Examples
        --------
        >>> from robonav.mdp import FiniteMDP
        >>> mdp = FiniteMDP([[[0.5, 0.5], [0, 1]]], [[1], [0]], discount=0.9)
        >>> mdp.transitions_from(0).toarray()
        array([[0.5, 0.5]])
        """
        return self.rows[state * self.n_actions : (state + 1) * self.n_actions]

    def likeliest_predecessors(self) -> sp.csr_array:
        """Largest probability of reaching s' from s by any action: row s', column s.

        Returns
        -------
        (S', S) sparse array

        Examples
        --------
        >>> from robonav.mdp import FiniteMDP
        >>> mdp = FiniteMDP([[[0.5, 0.5], [0, 1]]], [[1], [0]], discount=0.9)
        >>> mdp.likeliest_predecessors().toarray()
        array([[0.5, 0. ],
               [0.5, 1. ]])
        """
        likeliest = self.rows[:: self.n_actions]
        for action in range(1, self.n_actions):
            likeliest = likeliest.maximum(self.rows[action :: self.n_actions])
        return sp.csr_array(likeliest.T)

    @cached_property
    def arrays(self) -> Arrays:
        """Model as ``_fast`` takes it: starts, successors, probabilities, rewards, discount."""
        starts, successors = (
            part.view(f"u{part.itemsize}")
            for part in (self.rows.indptr, self.rows.indices)
        )
        rewards = np.ascontiguousarray(self.rewards)
        rewards.flags.writeable = False  # numba compiles once for read-only arrays
        return starts, successors, self.rows.data, rewards, self.discount

    @takes_values
    def expected_next_values(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Expected value of the next state: the sum over s' of T(s, a, s') V(s').

        Parameters
        ----------
        values : (S,) array
            Value of each state.

        Returns
        -------
        (S, A) array

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.mdp import FiniteMDP
        >>> mdp = FiniteMDP([[[0.5, 0.5], [0, 1]]], [[1], [0]], discount=0.9)
        >>> mdp.expected_next_values(np.array([2.0, 4.0]))
        array([[3.],
               [4.]])
        """
        if self.is_sparse:
            by_action = self.by_action @ values
            return by_action.reshape(self.n_actions, self.n_states).T
        return (self.transitions @ values).T

    def action_values(self, values: ArrayLike) -> NDArray[np.float64]:
        """Action values one step ahead of ``values``, Eqs. (2.11) and (2.15).

        Parameters
        ----------
        values : (S,) array
            Optimal values for Eq. (2.11), values of a policy for Eq. (2.15), or any others.

        Returns
        -------
        (S, A) array

        Examples
        --------
        >>> from robonav.mdp import FiniteMDP
        >>> mdp = FiniteMDP([[[0.5, 0.5], [0, 1]]], [[1], [0]], discount=0.9)
        >>> mdp.action_values([2.0, 4.0])
        array([[3.7],
               [3.6]])
        """
        expected = self.expected_next_values(values)  # sum over s' of T(s, a, s') V(s')
        return self.rewards + self.discount * expected  # Eqs. (2.11) and (2.15)

    def greedy(self, values: ArrayLike) -> NDArray[np.intp]:
        """Greedy policy with respect to values, Eq. (2.25); of equal actions the first.

        Parameters
        ----------
        values : (S,) array
            Value of each state.

        Returns
        -------
        (S,) array of int

        Examples
        --------
        >>> from robonav.mdp import four_by_three, value_iteration
        >>> mdp = four_by_three().mdp(discount=0.95)
        >>> mdp.greedy(value_iteration(mdp).values)
        array([1, 1, 1, 0, 0, 0, 0, 0, 3, 0, 3])
        """
        return self.action_values(values).argmax(axis=1)  # Eq. (2.25)

    @takes_policy
    def induced_chain(
        self, policy: NDArray[Any]
    ) -> tuple[sp.csr_array, NDArray[np.float64]]:
        """Markov chain that a policy induces, Eq. (2.6).

        Parameters
        ----------
        policy : (S,) array of ints or (S, A) array of probabilities
            A stochastic policy averages over its actions.

        Returns
        -------
        transitions : (S, S) sparse array
            T_pi.
        rewards : (S,) array
            r_pi.

        Examples
        --------
        >>> from robonav.mdp import FiniteMDP
        >>> mdp = FiniteMDP([[[1, 0], [0, 1]], [[0, 1], [0, 1]]], [[0, 2], [0, 0]], discount=0.9)
        >>> transitions, rewards = mdp.induced_chain([[0.5, 0.5], [1, 0]])
        >>> transitions.toarray(), rewards
        (array([[0.5, 0.5],
               [0. , 1. ]]), array([1., 0.]))
        """
        if policy.ndim == 1:
            pair = np.arange(self.n_states), policy
            return self.rows[pair[0] * self.n_actions + policy], self.rewards[pair]
        starts = np.arange(0, policy.size + 1, self.n_actions)
        average = sp.csr_array((policy.ravel(), np.arange(policy.size), starts))
        return average @ self.rows, (policy * self.rewards).sum(axis=1)  # Eq. (2.6)

    @checked
    def residual_for(self, tolerance: float) -> float:
        """The largest change of a sweep after which the greedy policy loses at most ``tolerance`` in every state.

        It is tolerance (1 - gamma) / (2 gamma) (Puterman 2005, Theorem 6.3.1), and infinite for discount 0. Without
        discount there is no such bound; ``tolerance`` itself is returned.

        Parameters
        ----------
        tolerance : float
            The loss of value that is accepted in each state, positive.

        Returns
        -------
        float

        Examples
        --------
        >>> from robonav.mdp import FiniteMDP
        >>> round(FiniteMDP([[[1]]], [[0]], discount=0.9).residual_for(0.18), 6)
        0.01
        """
        if self.discount == 1:
            return tolerance
        if self.discount == 0:
            return np.inf
        return tolerance * (1 - self.discount) / (2 * self.discount)

    def _reaching_terminal(self) -> NDArray[np.bool_]:
        """Which states (S,) can reach a terminal state."""
        backward = sum(
            (sp.csr_array(matrix) for matrix in self.transitions),
            start=sp.csr_array((self.n_states, self.n_states)),
        ).T
        return reachable(sp.csr_array(backward), np.flatnonzero(self.terminal))


require_type("mdp", FiniteMDP)


def reachable(steps: sp.csr_array, starts: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Which states (S,) can be reached from some of ``starts`` along the nonzero entries of ``steps`` (S, S).

    Examples
    --------
    >>> steps = sp.csr_array(([1.0], ([0], [1])), (3, 3))  # from state 0 to state 1
    >>> reachable(steps, np.array([0]))
    array([ True,  True, False])
    """
    if not starts.size:
        return np.zeros(steps.shape[0], dtype=bool)
    return np.isfinite(
        csgraph.dijkstra(steps, indices=starts, unweighted=True, min_only=True)
    )


def expected_rewards(transitions: Any, rewards: ArrayLike) -> NDArray[np.float64]:
    """Expected rewards r(s, a) of rewards that depend on the state reached.

    Parameters
    ----------
    transitions : (A, S, S) array or sequence of A sparse (S, S) matrices
    rewards : (A, S, S') array

    Returns
    -------
    (S, A) array

    Examples
    --------
    >>> from robonav.mdp import expected_rewards
    >>> expected_rewards([[[0.5, 0.5], [0, 1]]], [[[0, 4], [0, 0]]])
    array([[2.],
           [0.]])
    """
    checked = checked_transitions(transitions)
    states = checked[0].shape[0]
    reached = check_array("rewards", rewards, shape=(len(checked), states, states))
    return np.stack(
        [
            np.asarray((t * r).sum(axis=1))
            for t, r in zip(checked, reached, strict=True)
        ],
        axis=1,
    )


def tabulate(env: Any) -> tuple[list[sp.csr_array], NDArray[np.float64]]:
    """Sparse transitions and rewards (S, A) of an environment that publishes its table ``P``.

    A state that a transition marked as ended leads to becomes terminal: absorbing, with reward 0. Wrappers are not
    looked at.

    Raises
    ------
    ValueError
        If the environment publishes no table or an incomplete one, or does not keep to it. Also if it may end an
        episode in a state and go on from it another time, so that the state alone does not say what is to come.
    """
    bare = getattr(env, "unwrapped", env)
    rows = _published_rows(bare, env)
    states, actions = len(rows), len(rows[0])
    entries = np.array(
        [
            (action, state, reached, probability, probability * reward, ended)
            for state, row in enumerate(rows)
            for action, outcomes in enumerate(row)
            for probability, reached, reward, ended in outcomes
            if probability > 0
        ],
        dtype=float,
    ).reshape(-1, 6)
    action, state, reached = entries[:, :3].astype(np.intp).T
    if reached.min(initial=0) < 0 or reached.max(initial=0) >= states:
        raise ValueError(
            f"env must publish transitions to states from 0 to {states - 1}, got {reached.max()}"
        )
    ended = entries[:, 5] == 1
    terminal = np.zeros(states, dtype=bool)
    terminal[reached[ended]] = True
    leaving = np.zeros(states, dtype=bool)
    leaving[state[(reached != state) | (entries[:, 4] != 0)]] = True
    starts = np.asarray(getattr(bare, "initial_state_distrib", np.ones(states)))
    going_on = sp.csr_array(
        (np.ones((~ended).sum()), (state[~ended], reached[~ended])), (states, states)
    )
    passed = terminal & leaving & reachable(going_on, np.flatnonzero(starts))
    if passed.any():
        raise ValueError(
            "env must end an episode in a state always or never: its number alone must say what is to come, got state "
            f"{int(passed.argmax())}, in which it may end and may go on"
        )
    inside = ~terminal[state]
    rewards = np.zeros((states, actions))
    np.add.at(rewards, (state[inside], action[inside]), entries[inside, 4])
    ends = np.flatnonzero(terminal)
    transitions = []
    for which in range(actions):
        own = inside & (action == which)
        coordinates = np.append(state[own], ends), np.append(reached[own], ends)
        probability = np.append(entries[own, 3], np.ones(ends.size))
        transitions.append(
            sp.coo_array((probability, coordinates), (states, states)).tocsr()
        )
    return transitions, rewards


def _published_rows(bare: Any, env: Any) -> list[list[Any]]:
    """The table P[s][a] of an environment, as lists; ValueError if it is missing or incomplete."""
    table = getattr(bare, "P", None)
    if table is None:
        raise ValueError(
            f"env must publish its transitions as P[s][a] (FrozenLake, Taxi, CliffWalking), got {env}"
        )
    if getattr(bare, "fickle_passenger", False):
        raise ValueError(
            "env must move as its table P says, got a taxi whose fickle passenger is not in it"
        )
    rows = [_in_order(row) for row in _in_order(table)]
    actions = len(rows[0]) if rows else 0
    if actions == 0 or any(len(row) != actions for row in rows):
        raise ValueError(
            "env must publish P[s][a] for as many actions in every state, and for at least one of each"
        )
    return rows


def _in_order(part: Any) -> list[Any]:
    """What a list, or a dictionary with the keys 0, 1, 2, ..., holds."""
    try:
        return [part[key] for key in range(len(part))]
    except (TypeError, LookupError):
        raise ValueError(
            f"env must publish P[s][a] with states and actions numbered from 0, got {part}"
        ) from None
