"""Deep Q-learning, DQN (Mnih et al. 2015), with the targets of double DQN (van Hasselt et al. 2016) as an option.

DQN learns Q-values with a network. For a transition (s, a, r, s') it makes Q(s, a) more like a target. Two ideas keep
this stable although the network trains on targets that contain a network:

1. Replay: the network trains on transitions drawn at random from those made so far, not on the latest one.
2. A target network: the targets come from Q_target, a copy of the network that stands still between its updates.

In plain DQN the copy does all of the work, :func:`dqn_targets`:

    target = r + gamma * max over a' of Q_target(s', a'),      or r where the episode ended.

This maximum prefers actions whose values are too large by error, so that the targets are too large. In double DQN the
network Q that learns chooses the action, and the copy gives its value, :func:`double_dqn_targets`:

    target = r + gamma * Q_target(s', a*),  a* = argmax over a' of Q(s', a'),      or r where the episode ended.

``dqn(..., targets=double_dqn_targets)`` is double DQN. The network has three layers, the inputs, hidden sigmoid units
and one linear output an action, in torch ``Sequential(Linear(n, hidden), Sigmoid(), Linear(hidden, A))``.

These things differ from Mnih et al.:

- The state is a vector of a few numbers, not four images, and the network is small and not convolutional.
- The robot explores with the softmax policy, Eq. (4.7), in place of epsilon-greedy, as all methods of chapter 4 do. Its
  temperature falls from the first episode to the last.
- The buffer keeps every transition, not the latest million: a training of 300 episodes makes about ten thousand.
- Learning starts with the first full batch, not after 50,000 random steps, and there is an update after each step, not
  after every fourth.
- Adam makes the steps in place of RMSProp.
- The cost is Huber's loss. Its slope is the error clipped to [-1, 1], and this is what the paper clips.
- Rewards are used as they are, not clipped to [-1, 1], and no action is repeated for four frames.
- A robot's reflex may act in place of the policy. Such a step is not stored, since its reward and its next state do not
  follow from the action that the policy chose.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import SupportsFloat, TypeAlias

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


def dqn_targets(
    q_net: torch.nn.Module,
    target_net: torch.nn.Module,
    batch: Batch,
    discount: float,
) -> torch.Tensor:
    """Targets of plain DQN: r + gamma max_a Q_target(s', a), or r where the episode ended.

    The network that learns has no part in them.

    Parameters
    ----------
    q_net : torch.nn.Module
        The network that learns, which only the double estimator asks.
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


TargetRule: TypeAlias = (
    "Callable[[torch.nn.Module, torch.nn.Module, Batch, float], torch.Tensor]"
)
"""``targets(q_net, target_net, batch, discount)``: the targets (m,) of a batch of m transitions."""


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
    targets: TargetRule = dqn_targets,
    seed: int,
) -> Network:
    """Deep Q-learning, DQN (Mnih et al. 2015).

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
    targets : callable
        :func:`dqn_targets`, or :func:`double_dqn_targets` for double DQN.
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
    >>> from robonav.nnql import NavigationTask, double_dqn_targets, dqn, q_network
    >>> env = NavigationTask().environment()
    >>> dqn(env, q_network(env, seed=0), episodes=1, targets=double_dqn_targets, seed=0).sizes
    (16, 8, 5)
    """
    q_net, target_net = as_module(network), as_module(network)  # Q and Q_target
    optimiser = torch.optim.Adam(q_net.parameters(), lr=gradient_step)
    buffer, updates = ReplayBuffer(), 0
    for episode in range(episodes):
        t = geometric_schedule(temperature, episode / max(episodes - 1, 1))
        rng = make_rng(seed, EXPLORING, episode)
        replay_rng = make_rng(seed, REPLAYING, episode)
        state, _ = env.reset(seed=seed if episode == 0 else None)  # once for all
        done = False
        while not done:
            action = select_action(q_net, state, t, rng)  # act
            next_state, reward, terminated, truncated, info = env.step(action)
            if not reflex_acted(info):  # a step of the reflex teaches nothing
                buffer.append(state, action, reward, next_state, terminated)  # store
                if len(buffer) >= batch_size:
                    batch = buffer.sample(batch_size, replay_rng)  # replay
                    y = targets(q_net, target_net, batch, discount)
                    loss = huber_loss(values_taken(q_net, batch), y)  # learn
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

    A ``collections.deque(maxlen=...)`` in place of the list would drop the oldest.

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
        """Keep one transition.

        Parameters
        ----------
        state : (k,) array
            s.
        action : int
            a.
        reward : float
            r.
        next_state : (k,) array
            s'.
        terminal : bool
            Whether the episode ended in s', so that nothing follows.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nnql import ReplayBuffer
        >>> buffer = ReplayBuffer()
        >>> for reward in (0.0, 1.0):
        ...     buffer.append(np.zeros(2), 0, reward, np.ones(2), False)
        >>> len(buffer)
        2
        """
        before, after = np.asarray(state, float), np.asarray(next_state, float)
        self._transitions.append((before, action, float(reward), after, terminal))

    def all(self) -> Batch:
        """Every transition, in the order in which they were made.

        Returns
        -------
        Batch

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nnql import ReplayBuffer
        >>> buffer = ReplayBuffer()
        >>> buffer.append(np.zeros(2), 1, 0.5, np.ones(2), True)
        >>> buffer.all().terminal
        tensor([True])
        """
        return self._at(range(len(self)))

    def sample(self, size: int, rng: np.random.Generator) -> Batch:
        """Transitions drawn at random, with replacement.

        Parameters
        ----------
        size : int
            How many.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Batch

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nnql import ReplayBuffer
        >>> buffer = ReplayBuffer()
        >>> buffer.append(np.zeros(2), 1, 0.5, np.ones(2), True)
        >>> buffer.sample(3, np.random.default_rng(0)).actions
        tensor([1, 1, 1])
        """
        return self._at(rng.integers(len(self), size=size))

    def _at(self, indices: range | NDArray[np.int64]) -> Batch:
        columns = zip(*(self._transitions[k] for k in indices), strict=True)
        return Batch(*(torch.as_tensor(np.array(column)) for column in columns))
