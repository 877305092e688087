"""DAgger for networks with a memory (Ross, Gordon and Bagnell 2011).

The loop is that of :mod:`robonav.lfd.dagger`. What differs is the example: a policy without a memory learns from pairs
of a state and an action, a network with a memory from whole episodes, since what it is to do depends on what came
before. So an episode is kept as a sequence of inputs, with the expert's action in each step as its label.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from torch.nn.functional import cross_entropy

from robonav.lfd import ComputerExpert
from robonav.lfd.demonstrations import Expert
from robonav.networks.policy import draw_actions
from robonav.networks.torch_lbfgs import one_thread
from robonav.progress import Progress
from robonav.robot import (
    ReflexRule,
    Sensing,
    Simulator,
    Worlds,
    navigate,
    run_episodes,
)

from .policies import Actions, Memories, MemoryPolicy

UNKNOWN = (
    -100
)  # the label of a step after an episode's end, which cross_entropy ignores


@dataclass(frozen=True, eq=False)
class Episodes:
    """N episodes as sequences of equal length.

    Attributes
    ----------
    inputs : (T, N, D) tensor
        What the network reads in each step; 0 after the end of an episode.
    labels : (T, N) tensor of int
        The expert's actions; -100 after the end of an episode.

    Examples
    --------
    >>> import torch
    >>> from robonav.memory import Episodes
    >>> Episodes(torch.zeros(9, 2, 17), torch.zeros(9, 2, dtype=torch.int64)).labels.shape
    torch.Size([9, 2])
    """

    inputs: torch.Tensor
    labels: torch.Tensor


@one_thread()
def dagger_with_memory(
    policy: MemoryPolicy,
    rounds: Sequence[Worlds],
    *,
    reflex: ReflexRule | None,
    validation: Worlds,
    expert: Expert | None = None,
    steps: int = 300,
    batch: int = 20,
    gradient_step: float = 0.003,
    max_steps: int = 100,
    seed: int,
    progress: Progress | None = None,
) -> MemoryPolicy:
    """Train a policy with a memory by DAgger, and return that of the round which arrives most often in validation.

    Parameters
    ----------
    policy : MemoryPolicy
        What is to learn. Its network is trained in place.
    rounds : sequence of Worlds
        One batch of worlds for each round. In those of the first round the expert acts, in all others the learner.
    reflex : callable or None
        What the robot does before expert or learner is asked, see :class:`robonav.robot.Reflex`; None for no reflex.
    validation : Worlds
        Worlds of their own, in which each round's policy is tested.
    expert : callable, optional
        Labels the states; by default the computer expert, which knows the map.
    steps : int
        Steps of Adam in each round.
    batch : int
        Episodes in a step.
    gradient_step : float
        Step of Adam.
    max_steps : int
        Seconds after which an episode is stopped.
    seed : int
        Seed of the learner's actions and of the batches.
    progress : callable, optional
        Called as ``progress(round, rounds)``.

    Returns
    -------
    MemoryPolicy
        Its network is the one of the best round.

    Examples
    --------
    >>> from robonav.memory import MemoryPolicy, WindowNetwork, dagger_with_memory
    >>> from robonav.robot import Encoder, crossing_worlds
    >>> policy = MemoryPolicy(WindowNetwork(Encoder().size, k=2, hidden=8, seed=0))
    >>> rounds = [crossing_worlds(2, seed=seed) for seed in (1, 2)]
    >>> test = crossing_worlds(4, seed=3)
    >>> trained = dagger_with_memory(policy, rounds, reflex=None, validation=test, steps=5, seed=0)
    >>> trained.network.k
    2
    """
    expert = expert or ComputerExpert()
    rng = np.random.default_rng(seed)
    known: list[Episodes] = []
    best, kept = -1.0, {}
    for i, worlds in enumerate(rounds):
        simulator = Simulator(worlds, max_steps=max_steps)
        expert_acts = i == 0
        seen = labelled_episodes(simulator, policy, expert, expert_acts, rng, reflex)
        known.append(seen)  # aggregate
        train(policy, known, steps=steps, batch=batch, size=gradient_step, rng=rng)
        ends = navigate(policy, validation, max_steps=max_steps, reflex=reflex, seed=i)
        if ends.success.mean() > best:
            best, kept = ends.success.mean(), copied(policy.network)
        if progress is not None:
            progress(i + 1, len(rounds))
    policy.network.load_state_dict(kept)
    return replace(policy)


def labelled_episodes(
    simulator: Simulator,
    policy: MemoryPolicy,
    expert: Expert,
    expert_acts: bool,
    rng: np.random.Generator,
    reflex: ReflexRule | None,
) -> Episodes:
    """Let expert or learner act, and label each step in which they are asked with the expert's action.

    Parameters
    ----------
    simulator : Simulator
        N robots at the start.
    policy : MemoryPolicy
        The learner.
    expert : callable
        Labels the states.
    expert_acts : bool
        Whether the expert acts.
    rng : numpy.random.Generator
        Of the learner's actions.
    reflex : callable or None
        As in :func:`dagger_with_memory`.

    Returns
    -------
    Episodes

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import ComputerExpert
    >>> from robonav.memory import MemoryPolicy, RecurrentNetwork, labelled_episodes
    >>> from robonav.robot import Encoder, Simulator, crossing_worlds
    >>> policy = MemoryPolicy(RecurrentNetwork(Encoder().size, units=4, seed=0))
    >>> simulator, rng = Simulator(crossing_worlds(3, seed=1)), np.random.default_rng(0)
    >>> labelled_episodes(simulator, policy, ComputerExpert(), True, rng, None).inputs.shape[1:]
    torch.Size([3, 17])
    """
    n = len(simulator)
    memories = Memories(policy.network, policy.encoder, n)
    inputs: list[list[np.ndarray]] = [[] for _ in range(n)]
    labels: list[list[int]] = [[] for _ in range(n)]

    def select_actions(
        simulator: Simulator, sensing: Sensing, robots: Actions
    ) -> Actions:
        """Record one step of K robots, and return their actions."""
        wanted = expert(simulator, robots)
        x, logits = memories.read(sensing, robots)
        chosen = (
            wanted if expert_acts else draw_actions(logits, policy.temperature, rng)
        )
        memories.acted(robots, chosen)
        for row, robot in enumerate(robots):
            inputs[robot].append(x[row])
            labels[robot].append(wanted[row])
        return chosen

    for _ in run_episodes(simulator, select_actions, reflex=reflex):
        pass
    return Episodes(
        pad([torch.tensor(np.array(rows)) for rows in inputs], 0.0),
        pad([torch.tensor(row) for row in labels], UNKNOWN),
    )


def pad(sequences: Sequence[torch.Tensor], value: float) -> torch.Tensor:
    """Join sequences of several lengths along a second axis; what is missing at their ends gets a value.

    Examples
    --------
    >>> pad([torch.tensor([1, 2]), torch.tensor([3])], -1)
    tensor([[ 1,  3],
            [ 2, -1]])
    """
    return torch.nn.utils.rnn.pad_sequence(list(sequences), padding_value=value)


def train(
    policy: MemoryPolicy,
    known: Sequence[Episodes],
    *,
    steps: int,
    batch: int,
    size: float,
    rng: np.random.Generator,
) -> None:
    """Train a network in place to answer episodes with the expert's actions, by Adam on the cross-entropy."""
    columns = [(part, n) for part, k in enumerate(known) for n in range(k.labels.shape[1])]  # fmt: skip
    optimiser = torch.optim.Adam(policy.network.parameters(), lr=size)
    for _ in range(steps):
        chosen = [columns[c] for c in rng.integers(len(columns), size=batch)]
        xs = pad([known[part].inputs[:, n] for part, n in chosen], 0.0)
        labels = pad([known[part].labels[:, n] for part, n in chosen], UNKNOWN)
        logits = policy.network(xs)
        loss = cross_entropy(
            logits.flatten(0, 1), labels.flatten(), ignore_index=UNKNOWN
        )
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()


def copied(network: torch.nn.Module) -> dict[str, torch.Tensor]:
    """Return a copy of the parameters of a network.

    Examples
    --------
    >>> sorted(copied(torch.nn.Linear(1, 1)))
    ['bias', 'weight']
    """
    return {name: value.clone() for name, value in network.state_dict().items()}
