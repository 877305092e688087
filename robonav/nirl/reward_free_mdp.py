"""The MDP whose reward is unknown, and walks through it: where inverse reinforcement learning starts (5.3.1)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.mdp import policies
from robonav.mdp.gridworld import GridWorld
from robonav.mdp.models import FiniteMDP
from robonav.networks.policy import sample_actions
from robonav.validation import check_array, check_generator, check_integer, check_real

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RewardFreeMDP:
    r"""A finite MDP without its reward, MDP\\R, and K features in which the reward is linear (Eq. (5.2)).

    Parameters
    ----------
    transitions : (A, S, S), probabilities T(s, a, s') as in :class:`~robonav.mdp.FiniteMDP`.
    features : (S, A, K), f(s, a).
    discount : gamma in [0, 1).
    starts : (S,) probabilities of the first state.

    Raises
    ------
    TypeError, ValueError : if shapes do not fit, a row is no distribution, or the discount is out of range.
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
        starts = check_array("starts", self.starts, shape=(states,))
        if (starts < 0).any() or abs(starts.sum() - 1) > policies.SUM_TOLERANCE:
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
        """A gridworld with features phi(s') of the cell that a step ends in, (S, K).

        f(s, a) = sum_s' T(s, a, s') phi(s'): so a step that may slip is worth what it may lead to. A terminal cell
        counts when it is reached and no more.
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
        """Which states (S,) end an episode: absorbing under every action, without a feature."""
        staying = self.transitions.diagonal(axis1=1, axis2=2)
        return (staying > 1 - policies.SUM_TOLERANCE).all(axis=0) & (
            self.features == 0
        ).all(axis=(1, 2))

    def with_reward(self, weights: ArrayLike) -> FiniteMDP:
        """The finite MDP whose reward is r(s, a) = theta . f(s, a), Eq. (5.2), for weights (K,)."""
        theta = check_array("weights", weights, shape=(self.features.shape[2],))
        return FiniteMDP(self.transitions, self.features @ theta, self.discount)

    def walk(
        self,
        policy: ArrayLike,
        walks: int,
        steps: int,
        *,
        seed: int | np.random.Generator,
    ) -> Walks:
        """Follow a policy, (S,) actions or (S, A) probabilities, for ``steps`` steps, ``walks`` times over."""
        rng = check_generator("seed", seed)
        n = check_integer("walks", walks, at_least=0)
        chances = policies.probabilities(policy, self.n_states, self.n_actions)
        states = np.empty(
            (n, check_integer("steps", steps, at_least=1)), dtype=np.int64
        )
        actions = np.empty_like(states)
        here = rng.choice(self.n_states, n, p=self.starts)
        for step in range(steps):
            action = sample_actions(chances[here], rng.random(n))
            states[:, step], actions[:, step] = here, action
            here = sample_actions(self.transitions[action, here], rng.random(n))
        return Walks(states, actions)


@dataclass(frozen=True)
class Walks:
    """N walks of T steps each through a finite MDP: ``states`` and ``actions``, both (N, T)."""

    states: Ints
    actions: Ints

    @property
    def trajectory(self) -> Ints:
        """(N T,) which walk each step belongs to, walks laid end to end."""
        return np.repeat(np.arange(len(self.states)), self.states.shape[1])
