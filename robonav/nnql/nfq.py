"""Neural fitted Q iteration (Riedmiller 2005): collect transitions, then fit the network to all of them.

The method alternates between two phases. The robot first collects transitions (s, a, r, s') in a few episodes. Then
fitted Q iteration repeats two steps: compute a target for every transition so far,

    target = r + gamma * max over a' of Q(s', a'),      or r where the episode ended,

and fit the network to these targets by supervised learning on the whole batch. While the network is fitted, the
targets do not change.

These things differ from Riedmiller's paper:

- His network has state and action as inputs and one output; ours has one output an action, as in Fig. 4.1, and only the
  output of the action taken is fitted.
- His Q-values are costs, so that he takes their minimum; ours are rewards, and we take the maximum.
- Our outputs are sigmoids, between 0 and 1, and so the targets are clipped into [0, 1]. A target below 0 counts as 0: a
  punishment cannot be told from a step that brings nothing. He scales his costs so that they fit.
- We fit by the cross-entropy of Eq. (4.11), he by the squared error.
- We collect by the softmax policy, Eq. (4.7), whose temperature falls, and fit after every 20 episodes. He collects by
  random actions, or greedily and with a fit after each episode.
- A fit ends when its cost settles, or after 30 epochs.
- He may add artificial transitions, "hints to the goal", which start in the goal and cost nothing. We add none.
- A robot's reflex may act in place of the policy. Such a step is not stored, since its reward and its next state do not
  follow from the action that the policy chose.

Each sweep copies the network into torch, fits it, and copies it back. The weights go on from sweep to sweep; the step
sizes of Rprop start again with each.
"""

from __future__ import annotations

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray
from torch.nn.functional import binary_cross_entropy_with_logits

from robonav.networks.multilayer_perceptron import Network
from robonav.networks.policy import sample_actions
from robonav.networks.torch_module import as_module, as_network

from ._arguments import Schedule, checked
from .dqn import Batch, ReplayBuffer
from .schedules import geometric_schedule, softmax_policy
from .task import EXPLORING, make_rng, reflex_acted


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
    """Neural fitted Q iteration: after every few episodes, fit the network to all transitions so far.

    Parameters
    ----------
    episodes_per_fit : int
        Episodes that are collected before the network is fitted again.
    sweeps : int
        Sweeps of fitted Q iteration: how many times targets are computed and fitted.
    epochs : int
        Epochs of Rprop in a sweep, at most.
    tolerance : float
        A sweep ends early when an epoch changes the cost by less than this.

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
        rng = make_rng(seed, EXPLORING, episode)  # explores in this episode
        state, _ = env.reset(seed=seed if episode == 0 else None)  # once for all
        collect_episode(env, state, network, t, buffer, rng)
        if (episode + 1) % episodes_per_fit == 0 and len(buffer) > 0:
            transitions = buffer.all()
            for _ in range(sweeps):  # targets, then the fit; the targets stand still
                targets = nfq_targets(network, transitions, discount)
                network = rprop_fit(network, transitions, targets, epochs, tolerance)
    return network


def collect_episode(
    env: gymnasium.Env,
    state: NDArray[np.float64],
    network: Network,
    temperature: float | NDArray[np.float64],
    buffer: ReplayBuffer,
    rng: np.random.Generator,
) -> None:
    """Follow the softmax policy over the network's Q-values to the end of an episode, and store its transitions.

    Parameters
    ----------
    env : gymnasium.Env
        The environment, just reset.
    state : (n,) array
        The state that it was reset to.
    network : Network
        Its outputs are the Q-values.
    temperature : float
        T of the softmax policy, Eq. (4.7).
    buffer : ReplayBuffer
        Where the transitions go.
    rng : Generator
        Of the exploration.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nnql import NavigationTask, ReplayBuffer, q_network
    >>> from robonav.nnql import collect_episode
    >>> env, buffer = NavigationTask().environment(), ReplayBuffer()
    >>> state, _ = env.reset(seed=0)
    >>> collect_episode(env, state, q_network(env, seed=0), 0.9, buffer, np.random.default_rng(0))
    >>> len(buffer) > 0
    True
    """
    done = False
    while not done:
        probabilities = softmax_policy(network.forward(state), temperature)
        action = sample_actions(probabilities, rng.random())
        next_state, reward, terminated, truncated, info = env.step(action)
        if not reflex_acted(info):  # a step of the reflex teaches nothing
            buffer.append(state, action, reward, next_state, terminated)
        state, done = next_state, terminated or truncated


def nfq_targets(network: Network, transitions: Batch, discount: float) -> torch.Tensor:
    """Targets of all transitions: r + gamma max_a Q(s', a), or r where the episode ended, clipped into [0, 1].

    A Q-value is the sigmoid of a logit. The sigmoid is increasing, so the sigmoid of the largest logit is the largest
    Q-value. Targets outside [0, 1] are clipped, because no output of a sigmoid reaches them.

    Parameters
    ----------
    network : Network
        The network of the last sweep.
    transitions : Batch
        M transitions.
    discount : float
        The thesis's gamma.

    Returns
    -------
    (M,) tensor
        The targets.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nnql import ReplayBuffer, nfq_targets
    >>> buffer = ReplayBuffer()
    >>> buffer.append(np.eye(4)[0], 1, 0.7, np.eye(4)[1], True)
    >>> nfq_targets(random_network((4, 8, 2), seed=0), buffer.all(), 0.9)
    tensor([0.7000], dtype=torch.float64)
    """
    with torch.no_grad():
        logits = as_module(network)(transitions.next_states)
        next_values = torch.sigmoid(logits.max(dim=1).values)
        # ~terminal is 0 where the episode ended
        targets = transitions.rewards + discount * (~transitions.terminal * next_values)
        return targets.clamp(0, 1)


def rprop_fit(
    network: Network,
    transitions: Batch,
    targets: torch.Tensor,
    epochs: int,
    tolerance: float,
) -> Network:
    """Fit the Q-values of the actions taken to their targets, by Rprop on the whole batch.

    The cost is the mean cross-entropy of targets and Q-values, as in Eq. (4.11). torch's
    ``binary_cross_entropy_with_logits`` applies the sigmoid itself, because it can then avoid the logarithm of 0.

    Rprop (Riedmiller and Braun 1993) uses the signs of the derivatives alone: a weight's step grows while its
    derivative keeps its sign, and shrinks when the sign changes. It needs no learning rate.

    Parameters
    ----------
    network : Network
        The network that the fit starts from.
    transitions : Batch
        M transitions.
    targets : (M,) tensor
        Q-values to fit, see :func:`nfq_targets`.
    epochs : int
        See :func:`nfq`.
    tolerance : float
        See :func:`nfq`.

    Returns
    -------
    Network
        The fitted network.

    Examples
    --------
    >>> import numpy as np
    >>> import torch
    >>> from robonav.networks import random_network
    >>> from robonav.nnql import ReplayBuffer, rprop_fit
    >>> buffer, state = ReplayBuffer(), np.eye(4)[0]
    >>> buffer.append(state, 1, 0.7, np.eye(4)[1], True)
    >>> network, target = random_network((4, 8, 2), seed=0), torch.tensor([0.7], dtype=torch.float64)
    >>> rprop_fit(network, buffer.all(), target, 300, 0.0).forward(state)[1].round(2)
    np.float64(0.7)
    """
    module = as_module(network)
    rprop = torch.optim.Rprop(module.parameters(), lr=0.01)  # the first step's size
    previous = np.inf
    for _ in range(epochs):
        logits = module(transitions.states)
        # gather picks in each row the column of the action taken
        taken = logits.gather(1, transitions.actions[:, None])[:, 0]
        cost = binary_cross_entropy_with_logits(taken, targets)
        rprop.zero_grad()
        cost.backward()
        rprop.step()
        if abs(previous - cost.item()) < tolerance:
            break
        previous = cost.item()
    return as_network(module)
