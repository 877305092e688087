"""Acting on beliefs step by step (Fig. 2.3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_integer

from ._arguments import checked
from .models import FiniteMDP
from .pomdp import POMDP

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BeliefTrajectory:
    """One run through a POMDP (Fig. 2.3): what happened, what was observed, what was believed.

    Attributes
    ----------
    states : (T + 1,) array of ints
        The true states, hidden from the agent.
    actions, observations : (T,) arrays of ints
    rewards : (T,) array
        Expected reward R(s, a) of each state and action.
    beliefs : (T + 1, S) array

    Examples
    --------
    >>> from robonav.mdp import belief_rollout, tiger
    >>> run = belief_rollout(tiger(), lambda belief: 0, steps=2, seed=0)
    >>> run.beliefs.shape, run.rewards
    ((3, 2), array([-1., -1.]))
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    observations: NDArray[np.int64]
    rewards: Floats
    beliefs: Floats


@checked
def belief_rollout(
    pomdp: POMDP,
    policy: Callable[[Floats], int],
    steps: int,
    *,
    belief: ArrayLike | None = None,
    state: int | None = None,
    seed: int | np.random.Generator,
) -> BeliefTrajectory:
    """Act on beliefs for some steps.

    Parameters
    ----------
    pomdp : POMDP
    policy : callable
        ``policy(belief)`` is an action, such as :meth:`AlphaVectors.action`.
    steps : int
        Number of steps T.
    belief : (S,) array, optional
        The belief to start with; uniform by default.
    state : int, optional
        The true first state; drawn from ``belief`` by default.
    seed : int or numpy.random.Generator
        For what is random in the world.

    Returns
    -------
    BeliefTrajectory

    Examples
    --------
    >>> from robonav.mdp import belief_rollout, corridor
    >>> belief_rollout(corridor(), lambda belief: 1, steps=3, seed=0).actions
    array([1, 1, 1])
    """
    rng = np.random.default_rng(seed)
    beliefs = [pomdp.uniform() if belief is None else pomdp.as_belief(belief)]
    if state is None:
        state = rng.choice(pomdp.mdp.n_states, p=beliefs[0])
    last = pomdp.mdp.n_states - 1
    states = [check_integer("state", state, at_least=0, at_most=last)]
    actions: list[int] = []
    observations: list[int] = []
    rewards: list[float] = []
    for _ in range(steps):
        action = pomdp.as_action(policy(beliefs[-1]))
        rewards.append(pomdp.mdp.rewards[states[-1], action])
        following = successor_probabilities(pomdp.mdp, states[-1], action)
        states.append(int(rng.choice(pomdp.mdp.n_states, p=following)))
        seen = pomdp.observations[action, states[-1]]
        observations.append(int(rng.choice(len(seen), p=seen)))
        beliefs.append(pomdp.update(beliefs[-1], action, observations[-1]))
        actions.append(action)
    return BeliefTrajectory(
        np.array(states, dtype=np.int64),
        np.array(actions, dtype=np.int64),
        np.array(observations, dtype=np.int64),
        np.array(rewards, dtype=float),
        np.stack(beliefs),
    )


def successor_probabilities(mdp: FiniteMDP, state: int, action: int) -> Floats:
    """T(s, a, .) as a dense array (S,)."""
    row = mdp.transitions[action][[state]]
    return np.asarray(row.toarray() if mdp.is_sparse else row).ravel()
