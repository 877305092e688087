"""Proximal policy optimisation, PPO (Schulman et al. 2017), with a clipped surrogate.

PPO learns two networks: a policy pi(a|s) with parameters theta, and a value function V(s), which says what the policy
will earn from s on. It repeats two things. First it lets the policy act for a number of steps. Then it improves theta
on these steps several times over, and throws them away. The numbers of the equations are those of the paper.

How much better than expected was an action? This is its advantage A, :func:`advantages`:

    delta_t = r_t + gamma V(s_t+1) - V(s_t)                                                     (12)
    A_t = delta_t + (gamma lambda) delta_t+1 + (gamma lambda)^2 delta_t+2 + ...                 (11)

The policy should choose actions of positive advantage more often. With the ratio of its probability now to that when it
acted, rho_t = pi(a_t|s_t) / pi_old(a_t|s_t), PPO makes the mean of this larger, :func:`clipped_surrogate`:

    L_CLIP = min(rho_t A_t, clip(rho_t, 1 - epsilon, 1 + epsilon) A_t)                          (7)

Beyond epsilon a larger change of the policy earns nothing more, so several epochs on the same steps are safe. To this
the whole objective adds that V be near the returns R_t, and that the policy stay random, :func:`objective`:

    L = mean of L_CLIP - c_1 (V(s_t) - R_t)^2 + c_2 S(pi)(s_t)                                  (9)

with the entropy S. These things differ from the paper:

- There are two networks, and they share no parameters. Their hidden units are sigmoids, as everywhere in this book; the
  paper has tanh, and a convolutional network for pictures.
- R_t is A_t + V(s_t), both of the networks that acted. The paper only says that it is a target.
- The advantages of an update are shifted to mean 0 and scaled to standard deviation 1. The paper does not say so, but
  its authors' program does the same.
- An episode that the time limit ends goes on in thought: the value of its last state is counted. An episode that a
  collision or an arrival ends does not.
- The step of Adam and epsilon stay the same. For Atari games the paper lets both fall to 0.
- A robot's reflex may act in place of the policy. Such a step counts in Eq. (11), and the value function learns from
  it. The surrogate and the entropy leave it out, because the policy did not choose the action.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray

from robonav.networks.policy import sample_actions
from robonav.networks.torch_lbfgs import one_thread
from robonav.networks.torch_module import as_module, as_network
from robonav.nnql.task import (
    EXPLORING,
    REPLAYING,
    WORLDS,
    make_rng,
    reflex_acted,
)

from ._arguments import checked
from .networks import ActorCritic, random_actor_critic


@checked
@one_thread()
def ppo(
    envs: Sequence[gymnasium.Env],
    networks: ActorCritic,
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
    seed: int,
) -> ActorCritic:
    """Proximal policy optimisation, PPO (Schulman et al. 2017), for environments with discrete actions.

    The numbers in the comments are the lines of the paper's Algorithm 1, and the paper's equations.

    Examples
    --------
    >>> import gymnasium
    >>> from robonav.deep import actor_critic, ppo
    >>> envs = [gymnasium.make("CartPole-v1") for _ in range(2)]
    >>> networks = ppo(envs, actor_critic(envs[0], seed=0), updates=2, steps=32, seed=0)
    >>> networks.policy.sizes, networks.value.sizes
    ((4, 32, 2), (4, 32, 1))
    """
    policy, value = as_module(networks.policy), as_module(networks.value)
    parameters = [*policy.parameters(), *value.parameters()]  # theta
    optimiser = torch.optim.Adam(parameters, lr=gradient_step)
    actors = [Actor(env, seed, number) for number, env in enumerate(envs)]
    for update in range(updates):  # 1
        rollouts = [actor.act(policy, steps) for actor in actors]  # 2, 3
        batch = batch_of(rollouts, policy, value, discount, trace_decay)  # 4  Eq. (11)
        rng = make_rng(seed, REPLAYING, update)
        for rows in minibatches(len(batch), epochs, batches, rng):  # 6
            gain = objective(
                policy, value, batch[rows], clip, value_weight, entropy_weight
            )  # Eq. (9)
            optimiser.zero_grad()
            (-gain).backward()  # torch descends, and the objective is to rise
            optimiser.step()
    return ActorCritic(as_network(policy), as_network(value))


@dataclass(frozen=True, eq=False)
class Rollout:
    """T steps of actors as tensors; the first axis runs over the steps.

    Attributes
    ----------
    states, next_states : (T, ..., n) tensors
        What the networks read before and after a step. The next state is that before the environment begins anew.
    actions : (T, ...) tensor of int
        Actions that the policy chose.
    rewards : (T, ...) tensor
        Rewards received.
    terminal : (T, ...) tensor of bool
        Whether the episode ended with this step, so that nothing followed.
    ended : (T, ...) tensor of bool
        The same, or the time limit was reached: the next step belongs to another episode.
    decided : (T, ...) tensor of bool
        Whether the action was carried out, and not that of a robot's reflex.
    """

    states: torch.Tensor
    actions: torch.Tensor
    rewards: torch.Tensor
    next_states: torch.Tensor
    terminal: torch.Tensor
    ended: torch.Tensor
    decided: torch.Tensor


@dataclass(frozen=True, eq=False)
class Batch:
    """m steps to learn from, as tensors.

    Attributes
    ----------
    states : (..., m, n) tensor
        What the networks read.
    actions : (..., m) tensor of int
        Actions that the policy chose.
    log_probabilities : (..., m) tensor
        Logarithms of their probabilities under the policy that acted.
    advantages : (..., m) tensor
        Estimates of Eq. (11), standardised.
    returns : (..., m) tensor
        R, what the value function is to become.
    decided : (..., m) tensor of bool
        Whether the action was carried out.

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import Batch
    >>> batch = Batch(torch.eye(3), torch.tensor([0, 1, 1]), *torch.rand(3, 3), torch.ones(3) > 0)
    >>> len(batch), batch[[0, 2]].actions
    (3, tensor([0, 1]))
    """

    states: torch.Tensor
    actions: torch.Tensor
    log_probabilities: torch.Tensor
    advantages: torch.Tensor
    returns: torch.Tensor
    decided: torch.Tensor

    def __len__(self) -> int:
        return self.actions.shape[-1]

    def __getitem__(self, rows: Any) -> Batch:
        """Return a minibatch, the steps of these indices."""
        return Batch(*(getattr(self, part.name)[rows] for part in fields(self)))


class Actor:
    """One of the actors that gather experience: an environment, whose episodes go on from update to update.

    Parameters
    ----------
    env : gymnasium.Env
        Its environment.
    seed, number : int
        The seed of the training and the number of the actor in it, on which its random numbers depend.
    """

    def __init__(self, env: gymnasium.Env, seed: int, number: int) -> None:
        self.env, self.rng = env, make_rng(seed, EXPLORING, number)
        self.state, _ = env.reset(seed=actor_seed(seed, number))

    def act(self, policy: torch.nn.Module, steps: int) -> Rollout:
        """Make some steps with actions drawn from the policy."""
        made = []
        for _ in range(steps):
            state = self.state
            action = draw_action(policy, state, self.rng)
            after, reward, terminal, late, info = self.env.step(action)
            ended, decided = terminal or late, not reflex_acted(info)
            made.append(
                (np.array(state, float), action, float(reward), np.array(after, float),
                 terminal, ended, decided)
            )  # fmt: skip
            self.state = self.env.reset()[0] if ended else after
        return Rollout(*(torch.as_tensor(np.array(x)) for x in zip(*made, strict=True)))


def actor_seed(seed: int, number: int) -> int:
    """Return the seed of the environment of one actor of a training."""
    return int(make_rng(seed, WORLDS, number).integers(2**31))


def draw_action(
    policy: torch.nn.Module, state: NDArray[np.float64], rng: np.random.Generator
) -> int:
    """Draw an action from the policy, the softmax of the network's outputs."""
    with torch.no_grad():
        logits = policy(torch.as_tensor(state, dtype=torch.float64))
    return int(sample_actions(logits.softmax(dim=-1).numpy(), rng.random()))


def advantages(
    rewards: torch.Tensor,
    values: torch.Tensor,
    next_values: torch.Tensor,
    terminal: torch.Tensor,
    ended: torch.Tensor,
    discount: float,
    trace_decay: float,
) -> torch.Tensor:
    """Generalised advantage estimation, Eqs. (11) and (12) of the paper (Schulman et al. 2016).

    The sum of Eq. (11) is computed from its end: A_t = delta_t + gamma lambda A_t+1. It ends with the episode, or with
    the last step.

    Parameters
    ----------
    rewards, values, next_values : (T, ...) tensor
        The reward of each step, and the values of the states before and after it.
    terminal : (T, ...) tensor of bool
        Whether the episode ended with this step, so that its next state has no value.
    ended : (T, ...) tensor of bool
        Whether the next step belongs to another episode.
    discount : float
        gamma.
    trace_decay : float
        lambda. At 0 the advantage is delta_t; at 1 it is the sum of all rewards that follow, less V(s_t).

    Returns
    -------
    (T, ...) tensor
        The advantages.

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import advantages
    >>> no, value = torch.tensor([False, False]), torch.zeros(2)
    >>> advantages(torch.tensor([0.0, 1.0]), value, value, no, no, discount=0.9, trace_decay=0.5)
    tensor([0.4500, 1.0000])
    """
    # ~terminal is 0 where the episode ended
    deltas = rewards + discount * (~terminal * next_values) - values  # Eq. (12)
    found, following = torch.empty_like(deltas), torch.zeros_like(deltas[0])
    for t in reversed(range(len(deltas))):
        following = deltas[t] + discount * trace_decay * (~ended[t] * following)
        found[t] = following  # Eq. (11)
    return found


def clipped_surrogate(
    ratio: torch.Tensor, advantages: torch.Tensor, clip: float
) -> torch.Tensor:
    """The clipped surrogate of each step, Eq. (7) of the paper.

    Parameters
    ----------
    ratio : (...) tensor
        rho, the probability of the action now by that when it was taken.
    advantages : (...) tensor
        A.
    clip : float
        epsilon.

    Returns
    -------
    (...) tensor
        min(rho A, clip(rho, 1 - epsilon, 1 + epsilon) A).

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import clipped_surrogate
    >>> clipped_surrogate(torch.tensor([0.5, 1.5]), torch.tensor([1.0, 1.0]), clip=0.2)
    tensor([0.5000, 1.2000])
    """
    clipped = ratio.clamp(1 - clip, 1 + clip)
    return torch.minimum(ratio * advantages, clipped * advantages)  # Eq. (7)


def objective(
    policy: torch.nn.Module,
    value: torch.nn.Module,
    batch: Batch,
    clip: float,
    value_weight: float,
    entropy_weight: float,
) -> torch.Tensor:
    """What PPO makes larger: surrogate, error of the value function, and entropy, Eq. (9) of the paper.

    Parameters
    ----------
    policy, value : callable
        The networks that learn.
    batch : Batch
        m steps.
    clip, value_weight, entropy_weight : float
        epsilon, c_1 and c_2.

    Returns
    -------
    (...) tensor
        The objective, one for each of several seeds.

    Examples
    --------
    >>> import torch
    >>> from robonav.deep import Batch, objective
    >>> fair, value = torch.nn.Linear(1, 2), torch.nn.Linear(1, 1)
    >>> for network in (fair, value):
    ...     _ = torch.nn.init.zeros_(network.weight), torch.nn.init.zeros_(network.bias)
    >>> one = torch.ones(1)
    >>> batch = Batch(one[:, None], torch.tensor([0]), (one / 2).log(), one, one, one > 0)
    >>> objective(fair, value, batch, clip=0.2, value_weight=0.5, entropy_weight=0).item()  # 1 - 0.5 * 1
    0.5
    """
    log_policy = policy(batch.states).log_softmax(dim=-1)
    taken = log_policy.gather(-1, batch.actions[..., None])[..., 0]
    ratio = (taken - batch.log_probabilities).exp()  # rho
    surrogate = clipped_surrogate(ratio, batch.advantages, clip)  # Eq. (7)
    entropy = -(log_policy.exp() * log_policy).sum(dim=-1)  # S
    errors = (value(batch.states)[..., 0] - batch.returns) ** 2  # L_VF
    gains = batch.decided * (surrogate + entropy_weight * entropy)
    decisions = batch.decided.sum(dim=-1).clamp(min=1)
    return gains.sum(dim=-1) / decisions - value_weight * errors.mean(dim=-1)  # Eq. (9)


def batch_of(
    rollouts: Sequence[Rollout],
    policy: torch.nn.Module,
    value: torch.nn.Module,
    discount: float,
    trace_decay: float,
) -> Batch:
    """Join the steps of all actors, with their advantages and what the networks say of them now."""
    parts = []
    with torch.no_grad():
        for one in rollouts:
            values = value(one.states)[..., 0]
            next_values = value(one.next_states)[..., 0]
            found = advantages(
                one.rewards, values, next_values, one.terminal, one.ended,
                discount, trace_decay,
            )  # fmt: skip
            log_policy = policy(one.states).log_softmax(dim=-1)
            taken = log_policy.gather(-1, one.actions[..., None])[..., 0]
            parts.append(
                (one.states, one.actions, taken, found, found + values, one.decided)
            )
    whole = Batch(*(torch.cat(part) for part in zip(*parts, strict=True)))
    return replace(whole, advantages=standardised(whole.advantages, whole.decided))


def standardised(numbers: torch.Tensor, chosen: torch.Tensor) -> torch.Tensor:
    """Shift and scale numbers (..., m) so that the chosen ones have mean 0 and standard deviation 1."""
    n = chosen.sum(dim=-1, keepdim=True).clamp(min=1)
    centred = numbers - (numbers * chosen).sum(dim=-1, keepdim=True) / n
    variance = (centred**2 * chosen).sum(dim=-1, keepdim=True) / n
    return centred / (variance.sqrt() + 1e-8)


def minibatches(
    size: int, epochs: int, batches: int, rng: np.random.Generator
) -> Iterator[NDArray[np.int64]]:
    """Go through all rows in some epochs, each time in another random order, in minibatches."""
    for _ in range(epochs):
        yield from np.array_split(rng.permutation(size), batches)


@checked
def actor_critic(
    env: gymnasium.Env, *, hidden: Sequence[int] = (32,), seed: int
) -> ActorCritic:
    """Draw the two networks with small random weights.

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
    ActorCritic
        To be trained by :func:`ppo`.

    Examples
    --------
    >>> import gymnasium
    >>> from robonav.deep import actor_critic
    >>> actor_critic(gymnasium.make("CartPole-v1"), hidden=(16, 8), seed=0).policy.sizes
    (4, 16, 8, 2)
    """
    states = gymnasium.spaces.flatdim(env.observation_space)
    actions = gymnasium.spaces.flatdim(env.action_space)
    return random_actor_critic(states, hidden, actions, seed)
