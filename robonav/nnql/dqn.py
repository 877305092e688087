"""The deep Q-network (Mnih et al. 2015) with the double estimator (van Hasselt et al. 2016)."""

from __future__ import annotations

import gymnasium
import torch

from robonav.networks.multilayer_perceptron import Network
from robonav.networks.policy import sample_actions
from robonav.networks.torch_module import as_module, as_network

from ._settings import Schedule, checked
from .replay_buffer import ReplayBuffer, Transitions
from .schedules import geometric_schedule, softmax_policy
from .task import EXPLORING, REPLAYING, make_rng


@checked
def dqn(
    env: gymnasium.Env,
    network: Network,
    *,
    episodes: int,
    discount: float = 0.7,
    gradient_step: float = 0.003,
    temperature: Schedule = (0.9, 0.1),
    batch_size: int = 32,
    target_update_interval: int = 1000,
    seed: int,
) -> Network:
    """Deep Q-learning (DQN): after each step, one update on a batch drawn from all transitions made so far.

    Three things set it apart from online Q-learning: replay, a target network that stands still between its updates,
    and the double estimator. The outputs are linear, so that Q-values need no rescaling, and the loss is Huber's.

    Parameters
    ----------
    env : gymnasium.Env
        An environment with discrete actions, whose observations are the network's inputs.
    network : Network
        The network to start from, with one output an action, see :func:`q_network`.
    episodes : int
        Episodes of training.
    discount : float
        The thesis's gamma.
    gradient_step : float
        Step of Adam.
    temperature : Schedule
        T of the softmax policy, Eq. (4.7).
    batch_size : int
        Transitions drawn for an update.
    target_update_interval : int
        Updates after which the target network becomes a copy of the network.
    seed : int
        Seed of the environment, of the exploration and of the replay.

    Returns
    -------
    Network
        The trained network; its logits are the Q-values.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.nnql import NavigationTask, dqn, q_network
    >>> env = NavigationTask().environment()
    >>> dqn(env, q_network(env, seed=0), episodes=1, seed=0).sizes
    (16, 8, 5)
    """
    q_module, target_module = as_module(network), as_module(network)
    adam = torch.optim.Adam(q_module.parameters(), lr=gradient_step)
    buffer, updates = ReplayBuffer(), 0
    for episode in range(episodes):
        t = geometric_schedule(temperature, episode / max(episodes - 1, 1))
        rng, replay_rng = (make_rng(seed, p, episode) for p in (EXPLORING, REPLAYING))
        state, _ = env.reset(seed=None if episode else seed)
        done = False
        while not done:
            q = q_module(torch.as_tensor(state, dtype=torch.float64)).detach()
            action = sample_actions(softmax_policy(q, t), rng.random())
            reached, reward, terminated, truncated, info = env.step(action)
            state, before, done = reached, state, terminated or truncated
            if info.get("reflex", -1) >= 0:  # in a safe state the reflex acts
                continue
            buffer.append(before, action, reward, reached, terminated)
            if len(buffer) >= batch_size:
                batch = buffer.sample(batch_size, replay_rng)
                adam.zero_grad()
                double_dqn_loss(q_module, target_module, batch, discount).backward()
                adam.step()
                updates += 1
                if updates % target_update_interval == 0:
                    target_module.load_state_dict(q_module.state_dict())
    return as_network(q_module)


def double_dqn_loss(
    q_module: torch.nn.Module,
    target_module: torch.nn.Module,
    batch: Transitions,
    discount: float,
) -> torch.Tensor:
    """Huber's loss between the values of the actions taken and their targets, by the double estimator.

    The network chooses the next action, and the target network gives its value. One network that does both takes the
    maximum of its own errors, and overestimates.

    Parameters
    ----------
    q_module, target_module : torch.nn.Module
        The network that learns, and its older copy.
    batch : Transitions
        m transitions.
    discount : float
        The thesis's gamma.

    Returns
    -------
    torch.Tensor
        The mean loss.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module
    >>> from robonav.nnql import ReplayBuffer
    >>> from robonav.nnql.dqn import double_dqn_loss
    >>> buffer, module = ReplayBuffer(), as_module(random_network((4, 8, 2), seed=0))
    >>> buffer.append(np.eye(4)[0], 1, 0.7, np.eye(4)[1], True)
    >>> double_dqn_loss(module, module, buffer.all(), 0.9).item() > 0
    True
    """
    states, actions, rewards, next_states, terminal = batch
    with torch.no_grad():
        best = q_module(next_states).argmax(dim=1, keepdim=True)
        future = target_module(next_states).gather(1, best)[:, 0]
        targets = rewards + discount * ~terminal * future
    values = q_module(states).gather(1, actions[:, None])[:, 0]
    return torch.nn.functional.huber_loss(values, targets)
