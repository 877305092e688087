"""Neural fitted Q iteration (Riedmiller 2005): collect transitions, then fit the network to all of them."""

from __future__ import annotations

import gymnasium
import numpy as np
import torch

from robonav.networks.multilayer_perceptron import Network
from robonav.networks.policy import sample_actions
from robonav.networks.torch_module import as_module, as_network

from ._settings import Schedule, checked
from .replay_buffer import ReplayBuffer
from .schedules import geometric_schedule, softmax_policy
from .task import EXPLORING, make_rng


@checked
def nfq(
    env: gymnasium.Env,
    network: Network,
    *,
    episodes: int,
    discount: float = 0.9,
    temperature: Schedule = (0.9, 0.05),
    episodes_per_fit: int = 20,
    sweeps: int = 20,
    epochs: int = 30,
    tolerance: float = 1e-5,
    seed: int,
) -> Network:
    """Neural fitted Q iteration: after every few episodes, fit the network to all transitions made so far.

    Each fit computes the targets ``r + gamma max Q`` anew several times, clips them into [0, 1], and fits the values
    of the actions taken. Riedmiller's network has state and action as inputs and one output. Ours has one output an
    action, as in Fig. 4.1.

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
    temperature : Schedule
        T of the softmax policy, Eq. (4.7).
    episodes_per_fit : int
        Episodes between two fits.
    sweeps : int
        How often a fit computes its targets anew.
    epochs, tolerance : int, float
        Rprop goes over all transitions at most so often, and stops when the mean cost changes by less.
    seed : int
        Seed of the environment and of the exploration.

    Returns
    -------
    Network
        The trained network.

    Raises
    ------
    ValueError, TypeError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.nnql import NavigationTask, nfq, q_network
    >>> env = NavigationTask().environment()
    >>> nfq(env, q_network(env, seed=0), episodes=2, episodes_per_fit=2, sweeps=2, seed=0).sizes
    (16, 8, 5)
    """
    buffer = ReplayBuffer()
    for episode in range(episodes):
        t = geometric_schedule(temperature, episode / max(episodes - 1, 1))
        rng = make_rng(seed, EXPLORING, episode)
        state, _ = env.reset(seed=None if episode else seed)
        done = False
        while not done:
            policy = softmax_policy(network.forward(state), t)
            action = sample_actions(policy, rng.random())
            reached, reward, terminated, truncated, info = env.step(action)
            if info.get("reflex", -1) < 0:  # in a safe state the reflex acts
                buffer.append(state, action, reward, reached, terminated)
            state, done = reached, terminated or truncated
        if (episode + 1) % episodes_per_fit == 0 and len(buffer):
            for _ in range(sweeps):
                network = fit_q_values(network, buffer, discount, epochs, tolerance)
    return network


def fit_q_values(
    network: Network,
    buffer: ReplayBuffer,
    discount: float,
    epochs: int,
    tolerance: float,
) -> Network:
    """One sweep of fitted Q iteration: targets for all transitions, then a fit by Rprop on the whole batch.

    Rprop (Riedmiller and Braun 1993) looks at the signs of the gradient alone: a weight's step grows while its sign
    stays, and shrinks when it turns. It therefore needs no learning rate.

    Parameters
    ----------
    network : Network
        The network that makes the targets and that the fit starts from.
    buffer : ReplayBuffer
        The transitions.
    discount : float
        The thesis's gamma.
    epochs, tolerance : int, float
        See :func:`nfq`.

    Returns
    -------
    Network
        The fitted network.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nnql import ReplayBuffer
    >>> from robonav.nnql.nfq import fit_q_values
    >>> buffer, state = ReplayBuffer(), np.eye(4)[0]
    >>> buffer.append(state, 1, 0.7, np.eye(4)[1], True)
    >>> fitted = fit_q_values(random_network((4, 8, 2), seed=0), buffer, 0.9, 300, 0.0)
    >>> fitted.forward(state)[1].round(2)
    np.float64(0.7)
    """
    states, actions, rewards, next_states, terminal = buffer.all()
    module = as_module(network)
    with torch.no_grad():
        future = torch.sigmoid(module(next_states).max(dim=1).values)
        targets = (rewards + discount * ~terminal * future).clamp(0, 1)
    optimiser = torch.optim.Rprop(module.parameters(), lr=0.01)
    previous = np.inf
    for _ in range(epochs):
        taken = module(states).gather(1, actions[:, None])[:, 0]
        cost = torch.nn.functional.binary_cross_entropy_with_logits(taken, targets)
        optimiser.zero_grad()
        cost.backward()
        optimiser.step()
        if abs(previous - cost.item()) < tolerance:
            break
        previous = cost.item()
    return as_network(module)
