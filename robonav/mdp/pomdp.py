"""Partial observation: the POMDP, the belief and its update, and the MDP of beliefs (section 2.2.2)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import (
    check_array,
    check_generator,
    check_instance,
    check_integer,
)

from .models import FiniteMDP
from .policies import SUM_TOLERANCE, as_distributions

Floats = NDArray[np.float64]

SAME = 1e-9  # beliefs that differ by no more than this, in any state, count as one


def bayes(prior: ArrayLike, likelihood: ArrayLike) -> tuple[Floats, float]:
    """Bayes' rule: the belief (S,) after evidence, and how probable the evidence was.

    Parameters
    ----------
    prior : (S,) belief before it.
    likelihood : (S,) probability, or density, of the evidence in each state.

    Raises
    ------
    ValueError : if no state that is believed possible could have given the evidence, or a number is negative.
    """
    before = check_array("prior", prior, shape=("S",))
    explained = check_array("likelihood", likelihood, shape=before.shape)
    for name, numbers in (("prior", before), ("likelihood", explained)):
        if numbers.min(initial=0) < 0:
            raise ValueError(
                f"{name} must hold no negative numbers, got {numbers.min():.10g}"
            )
    joint = before * explained
    probability = float(joint.sum())
    if not probability > 0:
        raise ValueError(
            "the evidence has probability zero in every state that the belief holds possible"
        )
    return joint / probability, probability


def entropy(belief: ArrayLike) -> float:
    """How uncertain a belief (S,) is, in bits: 0 where one state is sure, log2 S where all are alike."""
    b = as_distributions(
        "belief", belief, len(check_array("belief", belief, shape=("S",)))
    )
    sure = b[b > 0]
    return float(-(sure * np.log2(sure)).sum()) + 0.0  # not -0


@dataclass(frozen=True, eq=False, repr=False)
class POMDP:
    """A finite MDP whose state is not seen: <S, A, T, O, Z, R>. A belief about it is an array (S,), Eq. (2.17).

    Attributes
    ----------
    mdp : S states, A actions, transitions, rewards and discount.
    observations : Z, (A, S', O): ``observations[a, s', o]`` is the probability of observing o in the state s' that
        action a led to.

    Raises
    ------
    TypeError, ValueError : if ``observations`` has another shape or a row is no distribution.
    """

    mdp: FiniteMDP
    observations: Any

    def __post_init__(self) -> None:
        check_instance("mdp", self.mdp, FiniteMDP)
        z = check_array(
            "observations",
            self.observations,
            shape=(self.mdp.n_actions, self.mdp.n_states, "O"),
        ).copy()
        wrong = (z < 0).any(axis=2) | (abs(z.sum(axis=2) - 1) > SUM_TOLERANCE)
        if wrong.any():
            action, state = np.argwhere(wrong)[0].tolist()
            raise ValueError(
                "observations must hold one distribution for each action and state reached, "
                f"got {z[action, state]} at action {action}, state {state}"
            )
        z.flags.writeable = False
        object.__setattr__(self, "observations", z)

    def __repr__(self) -> str:
        return f"POMDP({self.mdp!r}, {self.observations.shape[2]} observations)"

    def uniform(self) -> Floats:
        """The belief (S,) of one who knows nothing."""
        return np.full(self.mdp.n_states, 1 / self.mdp.n_states)

    def predict(self, belief: ArrayLike, action: int) -> Floats:
        """The belief (S,) after an action, before anything is observed: sum_s b(s) T(s, a, .)."""
        b = self._belief(belief)
        return np.asarray(b @ self.mdp.transitions[self._action(action)])

    def update(self, belief: ArrayLike, action: int, observation: int) -> Floats:
        """The belief (S,) after an action and an observation, b' = tau(b, a, o) (Eqs. (2.18), (2.19)).

        Eq. (2.18) writes the sum as T(s, a, s') over s', the state *before*; here it is s that is summed over:
        b'(s') is proportional to Z(o, s', a) sum_s b(s) T(s, a, s').

        Raises
        ------
        ValueError : if the belief is no distribution over S states, an index does not exist, or the observation has
            probability zero.
        """
        seen = check_integer(
            "observation",
            observation,
            at_least=0,
            at_most=self.observations.shape[2] - 1,
        )
        prior = self.predict(belief, action)
        try:
            return bayes(prior, self.observations[action, :, seen])[0]
        except ValueError:
            raise ValueError(
                f"observation must be possible: {seen} has probability zero after action {action} from this belief"
            ) from None

    def observation_probabilities(self, belief: ArrayLike, action: int) -> Floats:
        """Probability (O,) of each observation after an action (Eq. (2.20))."""
        return self.predict(belief, action) @ self.observations[action]

    def expected_rewards(self, belief: ArrayLike) -> Floats:
        """Expected reward (A,) of each action, r(a | b) = sum_s b(s) R(s, a) (Eqs. (2.21), (2.23))."""
        return self._belief(belief) @ self.mdp.rewards

    def _belief(self, belief: ArrayLike) -> Floats:
        check_array("belief", belief, shape=(self.mdp.n_states,))
        return as_distributions("belief", belief, self.mdp.n_states)

    def _action(self, action: int) -> int:
        return check_integer(
            "action", action, at_least=0, at_most=self.mdp.n_actions - 1
        )


def without_sensing(mdp: FiniteMDP) -> POMDP:
    """A robot with no sensing at all (2.5.1): whatever the state, it observes the same."""
    check_instance("mdp", mdp, FiniteMDP)
    return POMDP(mdp, np.ones((mdp.n_actions, mdp.n_states, 1)))


@dataclass(frozen=True)
class BeliefMDP:
    """The MDP whose states are the beliefs of a POMDP: <B, A, tau, r, gamma>. From each, few others can be reached."""

    pomdp: POMDP

    def __post_init__(self) -> None:
        check_instance("pomdp", self.pomdp, POMDP)

    @property
    def discount(self) -> float:
        """gamma, the POMDP's own."""
        return self.pomdp.mdp.discount

    def successors(self, belief: ArrayLike, action: int) -> tuple[Floats, Floats]:
        """The beliefs (K, S) that can follow, and their probabilities (K,); two observations may lead to the same."""
        prior = self.pomdp.predict(belief, action)
        likelihoods = self.pomdp.observations[action].T  # (O, S')
        found: list[tuple[Floats, float]] = []
        for likelihood in likelihoods[likelihoods @ prior > 0]:
            posterior, probability = bayes(prior, likelihood)
            for k, (known, so_far) in enumerate(found):
                if abs(known - posterior).max() <= SAME:
                    found[k] = known, so_far + probability
                    break
            else:
                found.append((posterior, probability))
        return np.stack([b for b, _ in found]), np.array([p for _, p in found])

    def transition(self, belief: ArrayLike, action: int, successor: ArrayLike) -> float:
        """tau(b, a, b'), the probability that ``successor`` follows (Eq. (2.22))."""
        wanted = check_array("successor", successor, shape=(self.pomdp.mdp.n_states,))
        beliefs, probabilities = self.successors(belief, action)
        return float(probabilities[(abs(beliefs - wanted) <= SAME).all(axis=1)].sum())

    def reward(self, belief: ArrayLike, action: int) -> float:
        """r(b, a) = sum_s b(s) R(s, a) (Eq. (2.23))."""
        return float(self.pomdp.expected_rewards(belief)[self.pomdp._action(action)])


@dataclass(frozen=True)
class BeliefTrajectory:
    """One run through a POMDP (Fig. 2.3): what happened, what was observed, what was believed.

    Attributes
    ----------
    states : (T + 1,) the true ones, hidden from the agent.
    actions, observations : (T,).
    rewards : (T,) expected reward R(s, a) of each state and action passed.
    beliefs : (T + 1, S).
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    observations: NDArray[np.int64]
    rewards: Floats
    beliefs: Floats


def belief_rollout(
    pomdp: POMDP,
    choose: Callable[[Floats], int],
    steps: int,
    *,
    belief: ArrayLike | None = None,
    state: int | None = None,
    seed: int | np.random.Generator,
) -> BeliefTrajectory:
    """Act on beliefs for some steps.

    Parameters
    ----------
    choose : ``choose(belief) -> action``, such as :meth:`AlphaVectors.action`.
    belief : (S,) to start with; uniform if left out.
    state : the true first state; drawn from ``belief`` if left out.
    seed : number or generator, for what is random in the world.
    """
    check_instance("pomdp", pomdp, POMDP)
    rng = check_generator("seed", seed)
    check_integer("steps", steps, at_least=0)
    beliefs = [pomdp.uniform() if belief is None else pomdp._belief(belief)]
    if state is None:
        state = rng.choice(pomdp.mdp.n_states, p=beliefs[0])
    check_integer("state", state, at_least=0, at_most=pomdp.mdp.n_states - 1)
    states, actions, observations, rewards = [state], [], [], []
    for _ in range(steps):
        action = pomdp._action(choose(beliefs[-1]))
        rewards.append(pomdp.mdp.rewards[states[-1], action])
        states.append(
            rng.choice(
                pomdp.mdp.n_states,
                p=successor_probabilities(pomdp.mdp, states[-1], action),
            )
        )
        observations.append(
            rng.choice(
                pomdp.observations.shape[2], p=pomdp.observations[action, states[-1]]
            )
        )
        beliefs.append(pomdp.update(beliefs[-1], action, observations[-1]))
        actions.append(action)
    return BeliefTrajectory(
        *map(np.array, (states, actions, observations, rewards, beliefs))
    )


def successor_probabilities(mdp: FiniteMDP, state: int, action: int) -> Floats:
    """T(s, a, .), (S,), dense."""
    row = mdp.transitions[action][[state]]
    return np.asarray(row.toarray() if mdp.is_sparse else row).ravel()
