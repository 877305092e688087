"""Generative adversarial imitation learning, GAIL (Ho and Ermon 2016): a reward from a judge, and PPO.

GAIL learns a policy from an expert's states and actions, without a reward. A third network, the discriminator, learns
to tell the learner's pairs (s, a) from the expert's: D(s, a) is its probability that a pair is the learner's. In turn

- the discriminator improves, by logistic regression on pairs of both, :func:`discriminator_loss`:

      mean of -log D(s, a) over the learner's pairs  +  mean of -log(1 - D(s, a)) over the expert's,

- and the policy improves, by PPO under the reward -log D(s, a), :func:`deceiving_reward`: a pair that the
  discriminator takes for the expert's earns more.

If the learner drives like the expert, nobody can tell the pairs apart: D is 1/2 everywhere. These things differ from
the paper:

- The policy improves by PPO. The paper uses another method, trust region policy optimisation, for the same step.
- The discriminator makes several small steps of Adam on minibatches in each update. The paper has one step.
- A robot's reflex may act in place of the policy. Such a step earns nothing, and the discriminator does not see it.

The reward -log D is positive, whatever the pair is. So an episode that goes on earns more than one that ends, even if
the expert's episodes end early. Kostrikov et al. (2019) call this the survival bias. :func:`hurrying_reward` has the
opposite bias, and :func:`log_odds` has either sign.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import torch
from gymnasium.spaces import flatdim
from numpy.typing import NDArray
from torch.nn.functional import one_hot, softplus

from robonav.networks import random_network
from robonav.networks.multilayer_perceptron import Network
from robonav.networks.torch_lbfgs import one_thread
from robonav.networks.torch_module import as_module, as_network
from robonav.nnql.task import INITIAL, REPLAYING, make_rng
from robonav.validation import ArrayArgument

from ._arguments import checked
from .gradient_ascent import adam, ascend
from .networks import ActorCritic
from .ppo import Actor, Rollout, batch_of, minibatches, objective

Reward = Callable[[torch.Tensor], torch.Tensor]
"""Turns the logits of the discriminator into rewards."""


def deceiving_reward(logits: torch.Tensor) -> torch.Tensor:
    """The reward of GAIL, -log D: positive, and large where the discriminator takes a pair for the expert's.

    Parameters
    ----------
    logits : (...) tensor
        f, of which D is the sigmoid.

    Returns
    -------
    (...) tensor

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import deceiving_reward
    >>> deceiving_reward(torch.tensor([0.0])).exp()  # D is 1/2
    tensor([2.])
    """
    return softplus(-logits)


def hurrying_reward(logits: torch.Tensor) -> torch.Tensor:
    """The reward log(1 - D): negative, so that an episode that ends soon loses little.

    Parameters
    ----------
    logits : (...) tensor
        f, of which D is the sigmoid.

    Returns
    -------
    (...) tensor

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import hurrying_reward
    >>> hurrying_reward(torch.tensor([0.0])).exp()
    tensor([0.5000])
    """
    return -softplus(logits)


def log_odds(logits: torch.Tensor) -> torch.Tensor:
    """The reward log(1 - D) - log D, which Fu et al. (2018) use: 0 where the discriminator cannot tell.

    Parameters
    ----------
    logits : (...) tensor
        f, of which D is the sigmoid.

    Returns
    -------
    (...) tensor

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import log_odds
    >>> log_odds(torch.tensor([0.0, 2.0]))
    tensor([-0., -2.])
    """
    return -logits


def constant_reward(logits: torch.Tensor) -> torch.Tensor:
    """A control: each decision earns 1, whatever the discriminator says. Nothing is learned from the expert.

    Parameters
    ----------
    logits : (...) tensor
        Only their shape matters.

    Returns
    -------
    (...) tensor

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import constant_reward
    >>> constant_reward(torch.tensor([-3.0, 2.0]))
    tensor([1., 1.])
    """
    return torch.ones_like(logits)


@checked
@one_thread()
def gail(
    envs: Sequence[gymnasium.Env],
    networks: ActorCritic,
    discriminator: Network,
    states: ArrayArgument,
    actions: ArrayArgument,
    *,
    updates: int,
    steps: int = 128,
    epochs: int = 4,
    batches: int = 4,
    clip: float = 0.2,
    discount: float = 0.99,
    trace_decay: float = 0.95,
    gradient_step: float = 0.01,
    value_weight: float = 0.5,
    entropy_weight: float = 0.03,
    reward: Reward = deceiving_reward,
    seed: int,
) -> ActorCritic:
    """Generative adversarial imitation learning, GAIL (Ho and Ermon 2016), for environments with discrete actions.

    The numbers in the comments are the lines of the paper's Algorithm 1.

    Examples
    --------
    >>> import gymnasium, numpy as np
    >>> from robonav.deep import actor_critic, gail, random_discriminator
    >>> envs = [gymnasium.make("CartPole-v1") for _ in range(2)]
    >>> judge = random_discriminator(envs[0], seed=0)
    >>> states, actions = np.zeros((3, 4)), np.array([0, 1, 1])  # of an expert
    >>> networks = gail(envs, actor_critic(envs[0], seed=0), judge, states, actions, updates=1, steps=32, seed=0)
    >>> networks.policy.sizes
    (4, 32, 2)
    """
    policy, value = as_module(networks.policy), as_module(networks.value)
    judge = as_module(discriminator)
    optimiser, judging = adam(gradient_step, policy, value), adam(gradient_step, judge)
    weights = clip, value_weight, entropy_weight
    n_actions = networks.policy.sizes[-1]
    expert = pairs(states, actions, n_actions)
    actors = [Actor(env, seed, number) for number, env in enumerate(envs)]
    for update in range(updates):  # 2
        rollouts = [actor.act(policy, steps) for actor in actors]  # 3
        rng = make_rng(seed, REPLAYING, update)
        own, decided = own_pairs(rollouts, n_actions)
        discriminate(judge, judging, own, decided, expert, epochs, batches, rng)  # 4
        rollouts = [rewarded(one, judge, reward, n_actions) for one in rollouts]
        batch = batch_of(rollouts, policy, value, discount, trace_decay)
        for rows in minibatches(len(batch), epochs, batches, rng):  # 5, by PPO
            ascend(optimiser, objective(policy, value, batch[rows], *weights))
    return ActorCritic(as_network(policy), as_network(value))


def discriminate(
    judge: torch.nn.Module,
    judging: torch.optim.Optimizer,
    own: torch.Tensor,
    decided: torch.Tensor,
    expert: torch.Tensor,
    epochs: int,
    batches: int,
    rng: np.random.Generator,
) -> None:
    """Improve the discriminator in some epochs of minibatches."""
    for rows, drawn in minibatch_pairs(len(own), len(expert), epochs, batches, rng):
        of_learner, of_expert = judge(own[rows])[..., 0], judge(expert[drawn])[..., 0]
        ascend(judging, -discriminator_loss(of_learner, of_expert, decided[rows]))


def discriminator_loss(
    learners: torch.Tensor, experts: torch.Tensor, decided: torch.Tensor
) -> torch.Tensor:
    """The cross-entropy of the discriminator: it should be 1 for the learner's pairs, and 0 for the expert's.

    Parameters
    ----------
    learners, experts : (..., m) tensor
        Its logits for pairs of both.
    decided : (..., m) tensor of bool
        Which of the learner's pairs count: those whose action was carried out.

    Returns
    -------
    (...) tensor
        mean of -log D(s, a) over the learner's pairs + mean of -log(1 - D(s, a)) over the expert's.

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import discriminator_loss
    >>> unsure = torch.zeros(2)
    >>> discriminator_loss(unsure, unsure, unsure == 0).exp()  # 2 log 2
    tensor(4.)
    """
    counted = decided.sum(dim=-1).clamp(min=1)
    of_learner = (decided * softplus(-learners)).sum(dim=-1) / counted  # -log D
    return of_learner + softplus(experts).mean(dim=-1)  # -log(1 - D)


def best_discriminator(learner: ArrayArgument, expert: ArrayArgument) -> Any:
    """The D of each pair that makes :func:`discriminator_loss` as small as it can be.

    Parameters
    ----------
    learner, expert : (...) array
        p and q: how often each of both makes a pair, not both 0.

    Returns
    -------
    (...) array
        p / (p + q): 1/2 where both make a pair equally often.

    Examples
    --------
    >>> from robonav.deep import best_discriminator
    >>> best_discriminator([0.6, 0.3], [0.2, 0.3])
    array([0.75, 0.5 ])
    """
    p, q = np.asarray(learner), np.asarray(expert)
    return p / (p + q)


def pairs(states: Any, actions: Any, n_actions: int) -> torch.Tensor:
    """Join states (..., m, n) with their actions (..., m) as indicators: what the discriminator reads."""
    states, actions = torch.as_tensor(states), torch.as_tensor(actions)
    return torch.cat([states, one_hot(actions, n_actions).to(states)], dim=-1)


def minibatch_pairs(
    own: int, expert: int, epochs: int, batches: int, rng: np.random.Generator
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Go through all rows of the learner in minibatches, each with as many rows drawn from the expert's."""
    for rows in minibatches(own, epochs, batches, rng):
        yield rows, rng.integers(expert, size=len(rows))


def own_pairs(
    rollouts: Sequence[Rollout], n_actions: int
) -> tuple[torch.Tensor, torch.Tensor]:
    """The pairs of all actors, one after the other, and which of them the policy decided."""
    made = [pairs(one.states, one.actions, n_actions) for one in rollouts]
    return torch.cat(made), torch.cat([one.decided for one in rollouts])


def rewarded(
    rollout: Rollout, judge: torch.nn.Module, reward: Reward, n_actions: int
) -> Rollout:
    """Return a rollout with the rewards that the discriminator gives, and 0 where the reflex acted."""
    with torch.no_grad():
        logits = judge(pairs(rollout.states, rollout.actions, n_actions))[..., 0]
    return replace(rollout, rewards=rollout.decided * reward(logits))


@checked
def random_discriminator(
    env: gymnasium.Env, *, hidden: Sequence[int] = (32,), seed: int
) -> Network:
    """Draw a discriminator with small random weights.

    Parameters
    ----------
    env : gymnasium.Env
        An environment with discrete actions.
    hidden : sequence of int
        Units of each hidden layer.
    seed : int
        Seed of the weights.

    Returns
    -------
    Network
        Its inputs are a state and an indicator of each action. D is the sigmoid of its output.

    Examples
    --------
    >>> import gymnasium
    >>> from robonav.deep import random_discriminator
    >>> random_discriminator(gymnasium.make("CartPole-v1"), hidden=(16,), seed=0).sizes
    (6, 16, 1)
    """
    return first_discriminator(
        flatdim(env.observation_space), flatdim(env.action_space), hidden, seed
    )


def first_discriminator(
    states: int, actions: int, hidden: Sequence[int], seed: int
) -> Network:
    """Draw a discriminator for states of some numbers and for some actions."""
    return random_network(
        (states + actions, *hidden, 1), seed=make_rng(seed, INITIAL, 1)
    )
