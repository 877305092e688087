"""The two networks that PPO trains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from robonav.networks import random_network
from robonav.networks.multilayer_perceptron import Network
from robonav.nnql.task import INITIAL, make_rng


@dataclass(frozen=True, eq=False)
class ActorCritic:
    """The two networks of PPO: the actor, a policy, and the critic, a value function.

    Attributes
    ----------
    policy : Network
        One output for each action; the policy is the softmax of the logits.
    value : Network
        One output, whose logit is the value of a state.

    Examples
    --------
    >>> from robonav.networks import random_network
    >>> from robonav.deep import ActorCritic
    >>> ActorCritic(random_network((4, 8, 2), seed=0), random_network((4, 8, 1), seed=1)).value.sizes
    (4, 8, 1)
    """

    policy: Network
    value: Network


def random_actor_critic(
    states: int, hidden: Sequence[int], actions: int, seed: int
) -> ActorCritic:
    """Draw the networks for states of some numbers and for some actions."""
    rng = make_rng(seed, INITIAL)
    return ActorCritic(
        random_network((states, *hidden, actions), seed=rng),
        random_network((states, *hidden, 1), seed=rng),
    )
