"""The MDP whose reward is unknown, with which inverse reinforcement learning starts (section 5.3.1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.mdp import policies
from robonav.mdp.gridworld import GridWorld
from robonav.mdp.models import FiniteMDP
from robonav.networks.policy import sample_actions
from robonav.validation import (
    ArrayArgument,
    check_array,
    check_generator,
    check_integer,
    check_real,
)

from ._arguments import checked

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RewardFreeMDP:
    r"""A finite MDP without its reward, MDP\\R, and K features in which the reward is linear.

    Parameters
    ----------
    transitions : (A, S, S) array
        Probabilities T(s, a, s'), as in :class:`~robonav.mdp.FiniteMDP`.
    features : (S, A, K) array
        f(s, a).
    discount : float
        gamma, at least 0 and below 1.
    starts : (S,) array
        Probabilities of the initial state.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, a row is not a distribution, or the discount is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import RewardFreeMDP
    >>> stay, move = np.eye(2), np.array([[0.0, 1.0], [0.0, 1.0]])
    >>> mdp = RewardFreeMDP(np.stack([stay, move]), np.ones((2, 2, 1)), 0.9, np.array([1.0, 0.0]))
    >>> mdp.with_reward([2.0]).rewards.tolist()
    [[2.0, 2.0], [2.0, 2.0]]
    """

    transitions: Floats
    features: Floats
    discount: float
    starts: Floats

    def __post_init__(self) -> None:
        features = check_array("features", self.features, shape=("S", "A", "K"))
        states, actions, _ = features.shape
        discount = check_real("discount", self.discount, at_least=0, below=1)
        unrewarded = FiniteMDP(self.transitions, np.zeros((states, actions)), discount)
        starts, wrong = policies.distributions("starts", self.starts, (states,))
        if wrong:
            raise ValueError(
                f"starts must be probabilities that sum to 1, got a sum of {starts.sum():.10g}"
            )
        for name, value in (
            ("transitions", unrewarded.transitions),
            ("features", features),
            ("starts", starts),
        ):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "discount", discount)

    @classmethod
    def of_grid(
        cls, grid: GridWorld, cell_features: ArrayLike, discount: float
    ) -> RewardFreeMDP:
        """A gridworld with features phi(s') of the cell that a step ends in.

        f(s, a) = sum_s' T(s, a, s') phi(s'): the expectation over the cells that a step may end in. A terminal cell
        counts when it is reached, and not afterwards.

        Parameters
        ----------
        grid : GridWorld
            The grid, whose rewards are not used.
        cell_features : (S, K) array
            phi.
        discount : float
            gamma, in [0, 1].

        Returns
        -------
        RewardFreeMDP

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> from robonav.nirl import RewardFreeMDP
        >>> mdp = RewardFreeMDP.of_grid(GridWorld("S G"), [[0.0], [1.0]], discount=0.9)
        >>> mdp.features[0, :, 0]  # only the step to the right ends on the goal
        array([0., 1., 0., 0.])
        """
        phi = check_array("cell_features", cell_features, shape=(grid.n_states, "K"))
        transitions = np.stack(
            [matrix.toarray() for matrix in grid.mdp(discount).transitions]
        )
        features = np.einsum("ast,tk->sak", transitions, phi)
        features[grid.terminal] = 0
        return cls(transitions, features, discount, grid.start)

    @property
    def n_states(self) -> int:
        """Number of states S."""
        return self.features.shape[0]

    @property
    def n_actions(self) -> int:
        """Number of actions A."""
        return self.features.shape[1]

    @cached_property
    def terminal(self) -> NDArray[np.bool_]:
        """Whether each state (S,) ends an episode: it is absorbing under every action and has no features."""
        staying = self.transitions.diagonal(axis1=1, axis2=2)
        return (staying > 1 - policies.SUM_TOLERANCE).all(axis=0) & (
            self.features == 0
        ).all(axis=(1, 2))

    @checked
    def with_reward(self, weights: ArrayArgument) -> FiniteMDP:
        """The finite MDP whose reward is linear in the features, r(s, a) = theta . f(s, a), Eq. (5.2).

        Parameters
        ----------
        weights : (K,) array
            theta.

        Returns
        -------
        FiniteMDP

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> from robonav.nirl import RewardFreeMDP
        >>> mdp = RewardFreeMDP.of_grid(GridWorld("S G"), [[0.0], [1.0]], discount=0.9)
        >>> mdp.with_reward([5.0]).rewards[0]
        array([0., 5., 0., 0.])
        """
        rewards = self.features @ weights  # Eq. (5.2)
        return FiniteMDP(self.transitions, rewards, self.discount)

    def rollout(
        self,
        policy: ArrayLike,
        n_episodes: int,
        n_steps: int,
        *,
        seed: int | np.random.Generator,
        first: ArrayLike | None = None,
    ) -> Trajectories:
        """Follow a policy for ``n_steps`` steps, ``n_episodes`` times.

        Parameters
        ----------
        policy : (S,) array of int or (S, A) array
            Actions or probabilities.
        n_episodes, n_steps : int
            N and T of :class:`Trajectories`.
        seed : int or Generator
            Of the random numbers.
        first : (N,) array of int, optional
            The first states; by default they are drawn from ``starts``.

        Returns
        -------
        Trajectories

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> from robonav.nirl import RewardFreeMDP
        >>> mdp = RewardFreeMDP.of_grid(GridWorld("S G"), [[0.0], [1.0]], discount=0.9)
        >>> mdp.rollout([1, 1], n_episodes=1, n_steps=3, seed=0).states  # always to the right
        array([[0, 1, 1]])
        """
        rng = check_generator("seed", seed)
        n = check_integer("n_episodes", n_episodes, at_least=0)
        probabilities = policies.probabilities(policy, self.n_states, self.n_actions)
        states = np.empty(
            (n, check_integer("n_steps", n_steps, at_least=1)), dtype=np.int64
        )
        actions = np.empty_like(states)
        state = np.asarray(
            rng.choice(self.n_states, n, p=self.starts) if first is None else first
        )
        for t in range(n_steps):
            action = sample_actions(probabilities[state], rng.random(n))
            states[:, t], actions[:, t] = state, action
            state = sample_actions(self.transitions[action, state], rng.random(n))
        return Trajectories(states, actions)


@dataclass(frozen=True, eq=False)
class Trajectories:
    """N trajectories of T steps each through a finite MDP.

    Attributes
    ----------
    states, actions : (N, T) array of int

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import Trajectories
    >>> Trajectories(np.zeros((2, 3), dtype=int), np.zeros((2, 3), dtype=int)).trajectory
    array([0, 0, 0, 1, 1, 1])
    """

    states: Ints
    actions: Ints

    @property
    def trajectory(self) -> Ints:
        """(N T,) which trajectory each step belongs to, trajectories laid end to end."""
        return np.repeat(np.arange(len(self.states)), self.states.shape[1])
