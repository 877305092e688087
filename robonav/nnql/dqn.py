"""Deep Q-learning (Mnih et al. 2015) in its variant "double DQN" (van Hasselt et al. 2016).

DQN learns Q-values with a network. For a transition (s, a, r, s') it makes Q(s, a) more like a target,

    target = r + gamma * max over a' of Q(s', a'),      or r where the episode ended.

The target contains the network that it trains, and it changes with every step. Three ideas make this stable:

1. Replay: the network trains on transitions drawn at random from all that were made, not on the latest one.
2. A target network: the targets come from a copy of the network that stands still between its updates.
3. Double estimator (van Hasselt et al. 2016): the network chooses the next action, and the target network gives its
   value. In plain DQN the target network does both, :func:`dqn_targets`. The maximum then prefers actions whose values
   are too large by error, and the targets are too large.

Two things differ from the papers. The robot explores with the softmax policy, Eq. (4.7), in place of epsilon-greedy,
as all methods of chapter 4 do, so that a comparison shows how they learn. The buffer keeps every transition: a training
of 300 episodes makes about ten thousand, and each is a few numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import SupportsFloat

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray
from torch.nn.functional import huber_loss

from robonav.networks.multilayer_perceptron import Network
from robonav.networks.torch_module import as_module, as_network

from ._arguments import Schedule, checked
from .schedules import geometric_schedule, softmax_policy
from .task import EXPLORING, REPLAYING, make_rng, reflex_acted


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
    """Deep Q-learning by double DQN (van Hasselt et al. 2016).

    After each step the network makes one update on a batch drawn from all transitions so far. Its outputs are linear,
    so that Q-values need no rescaling into [0, 1].

    Parameters
    ----------
    gradient_step : float
        Step of Adam.
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
    q_net = as_module(network)  # torch layers: Linear, Sigmoid, Linear
    target_net = as_module(network)
    optimiser = torch.optim.Adam(q_net.parameters(), lr=gradient_step)
    buffer, updates = ReplayBuffer(), 0
    for episode in range(episodes):
        t = geometric_schedule(temperature, episode / max(episodes - 1, 1))
        rng = make_rng(seed, EXPLORING, episode)
        replay_rng = make_rng(seed, REPLAYING, episode)
        state, done = env.reset(seed=None if episode else seed)[0], False
        while not done:
            action = select_action(q_net, state, t, rng)  # act
            next_state, reward, terminated, truncated, info = env.step(action)
            if not reflex_acted(info):
                buffer.append(state, action, reward, next_state, terminated)  # store
                if len(buffer) >= batch_size:
                    batch = buffer.sample(batch_size, replay_rng)  # replay
                    targets = double_dqn_targets(q_net, target_net, batch, discount)
                    loss = huber_loss(values_taken(q_net, batch), targets)  # learn
                    optimiser.zero_grad()
                    loss.backward()
                    optimiser.step()
                    updates += 1
                    if updates % target_update_interval == 0:
                        target_net.load_state_dict(q_net.state_dict())
            state, done = next_state, terminated or truncated
    return as_network(q_net)


def select_action(
    q_net: torch.nn.Module,
    state: NDArray[np.float64],
    temperature: float | NDArray[np.float64],
    rng: np.random.Generator,
) -> int:
    """Draw an action from the softmax policy over the network's Q-values.

    Parameters
    ----------
    q_net : torch.nn.Module
        The network that learns.
    state : (n,) array
        Its inputs.
    temperature : float
        T of the softmax policy.
    rng : Generator
        Of the random number that the draw takes.

    Returns
    -------
    int
        The action.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module
    >>> from robonav.nnql import select_action
    >>> q_net = as_module(random_network((4, 8, 2), seed=0))
    >>> select_action(q_net, np.eye(4)[0], 0.5, np.random.default_rng(0)) in (0, 1)
    True
    """
    with torch.no_grad():
        q = q_net(torch.as_tensor(state, dtype=torch.float64)).numpy()
    probabilities = softmax_policy(q, temperature)  # exp(q / T) over their sum
    return int(rng.choice(len(q), p=probabilities))


def values_taken(q_net: torch.nn.Module, batch: Batch) -> torch.Tensor:
    """Q-values of the actions taken: of each row of outputs the one that ``batch.actions`` names.

    Parameters
    ----------
    q_net : torch.nn.Module
        The network that learns.
    batch : Batch
        m transitions.

    Returns
    -------
    (m,) tensor
        Q(s, a).

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module
    >>> from robonav.nnql import ReplayBuffer
    >>> from robonav.nnql import values_taken
    >>> buffer, network = ReplayBuffer(), random_network((4, 8, 2), seed=0)
    >>> buffer.append(np.eye(4)[0], 1, 0.7, np.eye(4)[1], True)
    >>> q = values_taken(as_module(network), buffer.all()).item()
    >>> bool(np.isclose(q, network.logits(np.eye(4)[0])[1]))
    True
    """
    return q_net(batch.states).gather(1, batch.actions[:, None])[:, 0]


def dqn_targets(
    q_net: torch.nn.Module,
    target_net: torch.nn.Module,
    batch: Batch,
    discount: float,
) -> torch.Tensor:
    """Targets of plain DQN: r + gamma max_a Q_target(s', a), or r where the episode ended.

    Parameters
    ----------
    q_net : torch.nn.Module
        Not used.
    target_net : torch.nn.Module
        The older copy of the network.
    batch : Batch
        m transitions.
    discount : float
        The thesis's gamma.

    Returns
    -------
    (m,) tensor
        The targets, without a gradient.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module
    >>> from robonav.nnql import ReplayBuffer, dqn_targets
    >>> buffer, q_net = ReplayBuffer(), as_module(random_network((4, 8, 2), seed=0))
    >>> buffer.append(np.eye(4)[0], 1, 0.7, np.eye(4)[1], True)
    >>> dqn_targets(q_net, q_net, buffer.all(), 0.9)
    tensor([0.7000], dtype=torch.float64)
    """
    with torch.no_grad():
        next_values = target_net(batch.next_states).max(dim=1).values
        # ~terminal is 0 where the episode ended
        return batch.rewards + discount * (~batch.terminal * next_values)


def double_dqn_targets(
    q_net: torch.nn.Module,
    target_net: torch.nn.Module,
    batch: Batch,
    discount: float,
) -> torch.Tensor:
    """Targets by the double estimator: r + gamma Q_target(s', argmax_a Q(s', a)), or r where the episode ended.

    The two lines differ from :func:`dqn_targets`: the network chooses the next action, the target network values it.

    Parameters
    ----------
    q_net : torch.nn.Module
        The network that learns. It chooses the next action.
    target_net : torch.nn.Module
        Its older copy. It gives the value of that action.
    batch : Batch
        m transitions.
    discount : float
        The thesis's gamma.

    Returns
    -------
    (m,) tensor
        The targets, without a gradient.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.networks.torch_module import as_module
    >>> from robonav.nnql import ReplayBuffer
    >>> from robonav.nnql import double_dqn_targets
    >>> buffer, q_net = ReplayBuffer(), as_module(random_network((4, 8, 2), seed=0))
    >>> buffer.append(np.eye(4)[0], 1, 0.7, np.eye(4)[1], True)
    >>> double_dqn_targets(q_net, q_net, buffer.all(), 0.9)
    tensor([0.7000], dtype=torch.float64)
    """
    with torch.no_grad():
        best = q_net(batch.next_states).argmax(dim=1, keepdim=True)
        # gather picks in each row the column that best names
        next_values = target_net(batch.next_states).gather(1, best)[:, 0]
        # ~terminal is 0 where the episode ended
        return batch.rewards + discount * (~batch.terminal * next_values)


@dataclass(frozen=True, eq=False)
class Batch:
    """m transitions as tensors; the first axis runs over the transitions.

    Attributes
    ----------
    states, next_states : (m, n) tensors
        What the network reads before and after a step.
    actions : (m,) tensor of int
        Actions taken.
    rewards : (m,) tensor
        Rewards received.
    terminal : (m,) tensor of bool
        Whether the episode ended with this step, so that nothing followed.
    """

    states: torch.Tensor
    actions: torch.Tensor
    rewards: torch.Tensor
    next_states: torch.Tensor
    terminal: torch.Tensor


class ReplayBuffer:
    """All transitions made so far.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import ReplayBuffer
    >>> buffer = ReplayBuffer()
    >>> for k in range(5):
    ...     buffer.append(np.array([k, 0.0]), k % 2, 1.0, np.array([k + 1, 0.0]), k == 4)
    >>> buffer.sample(3, np.random.default_rng(0)).states[:, 0].tolist()
    [4.0, 3.0, 2.0]
    >>> len(buffer), buffer.all().terminal.tolist()
    (5, [False, False, False, False, True])
    """

    def __init__(self) -> None:
        self._transitions: list[tuple] = []

    def __len__(self) -> int:
        return len(self._transitions)

    def append(
        self,
        state: NDArray[np.float64],
        action: int | NDArray[np.int64],
        reward: SupportsFloat,
        next_state: NDArray[np.float64],
        terminal: bool,
    ) -> None:
        """Keep one transition."""
        before, after = np.asarray(state, float), np.asarray(next_state, float)
        self._transitions.append((before, action, float(reward), after, terminal))

    def all(self) -> Batch:
        """Every transition, in the order in which they were made."""
        return self._at(range(len(self)))

    def sample(self, size: int, rng: np.random.Generator) -> Batch:
        """Transitions drawn at random, with replacement."""
        return self._at(rng.integers(len(self), size=size))

    def _at(self, indices: range | NDArray[np.int64]) -> Batch:
        columns = zip(*(self._transitions[k] for k in indices), strict=True)
        return Batch(*(torch.as_tensor(np.array(column)) for column in columns))
