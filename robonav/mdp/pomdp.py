"""Partial observation: the POMDP, the belief and its update, and the belief MDP (section 2.2.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import ArrayArgument, check_array, check_instance, check_integer

from ._arguments import checked, refuses_impossible, require_type
from .models import FiniteMDP
from .policies import as_distributions, distributions

Floats = NDArray[np.float64]

SAME = 1e-9  # beliefs that differ by at most this in every state count as equal


def as_evidence(prior: ArrayLike, likelihood: ArrayLike) -> tuple[Floats, Floats]:
    """Prior and likelihood as arrays (S,), checked: neither holds a negative number."""
    before = check_array("prior", prior, shape=("S",))
    explained = check_array("likelihood", likelihood, shape=before.shape)
    for name, numbers in (("prior", before), ("likelihood", explained)):
        if numbers.min(initial=0) < 0:
            raise ValueError(
                f"{name} must hold no negative numbers, got {numbers.min():.10g}"
            )
    return before, explained


def bayes(prior: ArrayLike, likelihood: ArrayLike) -> tuple[Floats, float]:
    """Bayes' rule: the belief after evidence, and the probability of the evidence.

    Parameters
    ----------
    prior : (S,) array
        The belief before the evidence.
    likelihood : (S,) array
        Probability, or density, of the evidence in each state.

    Returns
    -------
    posterior : (S,) array
    probability : float

    Raises
    ------
    ValueError
        If no state that is believed possible could have given the evidence, or a number is negative.

    Examples
    --------
    >>> from robonav.mdp import bayes
    >>> posterior, probability = bayes([0.5, 0.5], likelihood=[0.9, 0.3])
    >>> posterior.round(2), round(probability, 2)
    (array([0.75, 0.25]), 0.6)
    """
    before, explained = as_evidence(prior, likelihood)
    joint = before * explained
    probability = float(joint.sum())
    if not probability > 0:
        raise ValueError(
            "the evidence has probability zero in every state that the belief holds possible"
        )
    return joint / probability, probability


@checked
def entropy(belief: ArrayArgument) -> float:
    """Entropy of a belief in bits: 0 if one state is certain, log2 S if all are equally likely.

    Parameters
    ----------
    belief : (S,) array

    Returns
    -------
    float

    Examples
    --------
    >>> from robonav.mdp import entropy
    >>> entropy([0.5, 0.5]), entropy([1.0, 0.0])
    (1.0, 0.0)
    """
    possible = belief[belief > 0]
    return float(-(possible * np.log2(possible)).sum()) + 0.0  # not -0


@dataclass(frozen=True, eq=False, repr=False)
class POMDP:
    """A finite MDP whose state is hidden: <S, A, T, O, Z, R>. A belief about it is an array (S,).

    Parameters
    ----------
    mdp : FiniteMDP
        S states, A actions, transitions, rewards and discount.
    observations : (A, S', O) array
        ``observations[a, s', o]`` is the probability Z(o, s', a) of observing o in the state s' that action a led to.

    Raises
    ------
    TypeError, ValueError
        If ``observations`` has another shape or a row is not a distribution.

    Examples
    --------
    >>> from robonav.mdp import tiger
    >>> pomdp = tiger(accuracy=0.85)
    >>> pomdp
    POMDP(FiniteMDP(2 states, 3 actions, discount 0.95, dense), 2 observations)
    >>> pomdp.update([0.5, 0.5], action=0, observation=0)
    array([0.85, 0.15])
    """

    mdp: FiniteMDP
    observations: Any

    def __post_init__(self) -> None:
        check_instance("mdp", self.mdp, FiniteMDP)
        z, wrong = distributions(
            "observations",
            self.observations,
            (self.mdp.n_actions, self.mdp.n_states, "O"),
        )
        if wrong.any():
            action, state = np.argwhere(wrong)[0].tolist()
            raise ValueError(
                "observations must hold one distribution for each action and state reached, "
                f"got {z[action, state]} at action {action}, state {state}"
            )
        z = z.copy()
        z.flags.writeable = False
        object.__setattr__(self, "observations", z)

    def __repr__(self) -> str:
        return f"POMDP({self.mdp!r}, {self.observations.shape[2]} observations)"

    def uniform(self) -> Floats:
        """The belief in which all states are equally likely.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger().uniform()
        array([0.5, 0.5])
        """
        return np.full(self.mdp.n_states, 1 / self.mdp.n_states)

    @checked
    def predict(self, belief: ArrayArgument, action: int) -> Floats:
        """Belief after an action, before anything is observed: sum over s of b(s) T(s, a, .).

        Parameters
        ----------
        belief : (S,) array
            b.
        action : int
            a.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger().predict([0.8, 0.2], action=1)  # a door was opened: a new round begins
        array([0.5, 0.5])
        """
        return belief @ self.mdp.transitions[action]

    @refuses_impossible(
        "observation must be possible: {observation} has probability zero "
        "after action {action} from this belief"
    )
    def update(self, belief: ArrayLike, action: int, observation: int) -> Floats:
        """Belief after an action and an observation, Eq. (2.18).

        b'(s') is proportional to Z(o, s', a) times the sum over s of b(s) T(s, a, s'). Here s is the state before the
        action, and s' the one after it. (Eq. (2.18) of the thesis has the two names the other way round.) Eq. (2.19)
        names this function tau.

        Parameters
        ----------
        belief : (S,) array
        action, observation : int

        Returns
        -------
        (S,) array

        Raises
        ------
        ValueError
            If the belief is not a distribution over S states, an index does not exist, or the observation has
            probability zero.

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger(accuracy=0.85).update([0.5, 0.5], action=0, observation=0)
        array([0.85, 0.15])
        """
        predicted = self.predict(belief, action)  # sum over s of b(s) T(s, a, s')
        joint = self.likelihood(action, observation) * predicted
        return joint / joint.sum()  # Eq. (2.18)

    def likelihood(self, action: int, observation: int) -> Floats:
        """Probability Z(o, s', a) of an observation in each state s'.

        Parameters
        ----------
        action : int
            a.
        observation : int
            o.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger(accuracy=0.85).likelihood(action=0, observation=0)
        array([0.85, 0.15])
        """
        last = self.observations.shape[2] - 1
        seen = check_integer("observation", observation, at_least=0, at_most=last)
        return self.observations[self.as_action(action), :, seen]

    def observation_probabilities(self, belief: ArrayLike, action: int) -> Floats:
        """Probability of each observation after an action, Eq. (2.20).

        Parameters
        ----------
        belief : (S,) array
            b.
        action : int
            a.

        Returns
        -------
        (O,) array

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger(accuracy=0.85).observation_probabilities([1.0, 0.0], action=0)
        array([0.85, 0.15])
        """
        predicted = self.predict(belief, action)  # sum over s of b(s) T(s, a, s')
        return predicted @ self.observations[action]  # Eq. (2.20)

    @checked
    def expected_rewards(self, belief: ArrayArgument) -> Floats:
        """Expected reward of each action, r(a | b), Eq. (2.21).

        Parameters
        ----------
        belief : (S,) array
            b.

        Returns
        -------
        (A,) array

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger().expected_rewards([0.5, 0.5])
        array([ -1., -45., -45.])
        """
        return belief @ self.mdp.rewards  # Eq. (2.21)

    def as_belief(self, belief: ArrayLike) -> Floats:
        """The belief as an array, checked.

        Parameters
        ----------
        belief : (S,) array
            Probabilities of the states.

        Returns
        -------
        (S,) array

        Raises
        ------
        ValueError
            If it is not a distribution over the S states.

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger().as_belief([0.5, 0.5])
        array([0.5, 0.5])
        """
        check_array("belief", belief, shape=(self.mdp.n_states,))
        return as_distributions("belief", belief, self.mdp.n_states)

    def as_action(self, action: int) -> int:
        """The action as an index, checked.

        Parameters
        ----------
        action : int
            An action's index.

        Returns
        -------
        int

        Examples
        --------
        >>> from robonav.mdp import tiger
        >>> tiger().as_action(2)
        2
        """
        last = self.mdp.n_actions - 1
        return check_integer("action", action, at_least=0, at_most=last)


require_type("pomdp", POMDP)


@dataclass(frozen=True, eq=False)
class BeliefMDP:
    """The MDP whose states are the beliefs of a POMDP: <B, A, tau, r, gamma>. Few beliefs can follow a belief.

    Parameters
    ----------
    pomdp : POMDP

    Examples
    --------
    >>> from robonav.mdp import BeliefMDP, tiger
    >>> beliefs, probabilities = BeliefMDP(tiger()).successors([0.5, 0.5], action=0)
    >>> beliefs.round(2), probabilities
    (array([[0.85, 0.15],
           [0.15, 0.85]]), array([0.5, 0.5]))
    """

    pomdp: POMDP

    def __post_init__(self) -> None:
        check_instance("pomdp", self.pomdp, POMDP)

    @property
    def discount(self) -> float:
        """gamma of the POMDP."""
        return self.pomdp.mdp.discount

    def successors(self, belief: ArrayLike, action: int) -> tuple[Floats, Floats]:
        """Beliefs that can follow, and their probabilities; two observations may lead to the same one.

        Parameters
        ----------
        belief : (S,) array
            b.
        action : int
            a.

        Returns
        -------
        beliefs : (K, S) array
            The K beliefs.
        probabilities : (K,) array
            Their probabilities, which sum to 1.

        Examples
        --------
        >>> from robonav.mdp import BeliefMDP, tiger
        >>> beliefs, probabilities = BeliefMDP(tiger()).successors([0.5, 0.5], action=0)
        >>> beliefs.round(2), probabilities
        (array([[0.85, 0.15],
               [0.15, 0.85]]), array([0.5, 0.5]))
        """
        predicted = self.pomdp.predict(belief, action)
        likelihoods = self.pomdp.observations[action].T  # (O, S')
        found: list[tuple[Floats, float]] = []
        for likelihood in likelihoods[likelihoods @ predicted > 0]:
            posterior, probability = bayes(predicted, likelihood)
            for k, (known, so_far) in enumerate(found):
                if abs(known - posterior).max() <= SAME:
                    found[k] = known, so_far + probability
                    break
            else:
                found.append((posterior, probability))
        return np.stack([b for b, _ in found]), np.array([p for _, p in found])

    @checked
    def transition(
        self, belief: ArrayArgument, action: int, successor: ArrayArgument
    ) -> float:
        """Probability tau(b, a, b') that the belief ``successor`` follows, Eq. (2.22).

        Parameters
        ----------
        belief : (S,) array
            b.
        action : int
            a.
        successor : (S,) array
            b'.

        Returns
        -------
        float

        Examples
        --------
        >>> from robonav.mdp import BeliefMDP, tiger
        >>> BeliefMDP(tiger()).transition([0.5, 0.5], action=0, successor=[0.85, 0.15])
        0.5
        """
        beliefs, probabilities = self.successors(belief, action)
        same = (abs(beliefs - successor) <= SAME).all(axis=1)
        return float(probabilities[same].sum())  # Eq. (2.22)

    @checked
    def reward(self, belief: ArrayArgument, action: int) -> float:
        """Expected reward r(b, a) of an action at a belief, Eq. (2.23).

        Parameters
        ----------
        belief : (S,) array
            b.
        action : int
            a.

        Returns
        -------
        float

        Examples
        --------
        >>> from robonav.mdp import BeliefMDP, tiger
        >>> BeliefMDP(tiger()).reward([0.5, 0.5], action=0)
        -1.0
        """
        return float((belief @ self.pomdp.mdp.rewards)[action])  # Eq. (2.23)
