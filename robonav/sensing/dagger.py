"""DAgger for any sensor, and the randomised worlds that it may train in.

The loop is that of :mod:`robonav.lfd.dagger` (Ross, Gordon and Bagnell 2011). What differs is the state: a pair of an
example is what the sensor reads, with the action of the expert. The expert knows the map, so it is the same expert for
every sensor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from torch.nn.functional import cross_entropy

from robonav.lfd import ComputerExpert
from robonav.lfd.demonstrations import Expert
from robonav.networks.torch_lbfgs import one_thread
from robonav.progress import Progress
from robonav.robot import (
    ReflexRule,
    Sensing,
    Simulator,
    Worlds,
    neighbour_slip,
    run_episodes,
)

from .policies import SensorPolicy, inputs_of
from .sensors import Robots


@dataclass(frozen=True, eq=False)
class Examples:
    """N states as a sensor reads them, with the expert's actions.

    Attributes
    ----------
    readings : (N, \\*shape) tensor
        What the sensor reads.
    targets : (N, 3) tensor
        Where the target is.
    labels : (N,) tensor of int
        The expert's actions.

    Examples
    --------
    >>> import torch
    >>> from robonav.sensing import Examples
    >>> len(Examples(torch.zeros(4, 36), torch.zeros(4, 3), torch.zeros(4, dtype=torch.int64)))
    4
    """

    readings: torch.Tensor
    targets: torch.Tensor
    labels: torch.Tensor

    def __len__(self) -> int:
        return len(self.labels)


@one_thread()
def dagger_with_sensor(
    policy: SensorPolicy,
    rounds: Sequence[Simulator],
    *,
    reflex: ReflexRule | None,
    expert: Expert | None = None,
    steps: int = 100,
    batch: int = 64,
    gradient_step: float = 0.003,
    seed: int,
    progress: Progress | None = None,
) -> SensorPolicy:
    """Train the policy of a sensor by DAgger, and return that of the last round.

    Parameters
    ----------
    policy : SensorPolicy
        What is to learn. Its network is trained in place.
    rounds : sequence of Simulator
        One for each round, at the start. In the first one the expert acts, in all others the learner.
    reflex : callable or None
        What the robot does before expert or learner is asked, see :class:`robonav.robot.Reflex`; None for no reflex.
    expert : callable, optional
        Labels the states; by default the computer expert, which knows the map.
    steps : int
        Steps of Adam in each round.
    batch : int
        Examples in a step.
    gradient_step : float
        Step of Adam in the first round. It falls linearly to a part of one by the number of rounds in the last one.
    seed : int
        Seed of the learner's actions and of the batches.
    progress : callable, optional
        Called as ``progress(round, rounds)``.

    Returns
    -------
    SensorPolicy

    Examples
    --------
    >>> from robonav.robot import REFLEX, Simulator, random_worlds
    >>> from robonav.sensing import Ring, SensorPolicy, dagger_with_sensor, ring_network
    >>> policy = SensorPolicy(Ring(18), ring_network(Ring(18), seed=0))
    >>> rounds = [Simulator(random_worlds(2, seed=seed), max_steps=100) for seed in (1, 2)]
    >>> trained = dagger_with_sensor(policy, rounds, reflex=REFLEX, steps=5, seed=0)
    >>> trained.sensor
    Ring(sectors=18)
    """
    expert = expert or ComputerExpert()
    rng = np.random.default_rng(seed)
    optimiser = torch.optim.Adam(policy.network.parameters(), lr=gradient_step)
    known: Examples | None = None
    for i, simulator in enumerate(rounds):
        expert_acts = i == 0
        seen = labelled_examples(simulator, policy, expert, expert_acts, rng, reflex)
        known = seen if known is None else joined(known, seen)  # aggregate
        for group in optimiser.param_groups:
            group["lr"] = gradient_step * (1 - i / len(rounds))
        train_network(policy, known, optimiser, steps=steps, batch=batch, rng=rng)
        if progress is not None:
            progress(i + 1, len(rounds))
    return replace(policy)


def labelled_examples(
    simulator: Simulator,
    policy: SensorPolicy,
    expert: Expert,
    expert_acts: bool,
    rng: np.random.Generator,
    reflex: ReflexRule | None,
) -> Examples:
    """Let expert or learner act, and label each state in which they are asked with the expert's action.

    Parameters
    ----------
    simulator : Simulator
        Robots at the start.
    policy : SensorPolicy
        The learner.
    expert : callable
        Labels the states.
    expert_acts : bool
        Whether the expert acts.
    rng : numpy.random.Generator
        Of the learner's actions.
    reflex : callable or None
        As in :func:`dagger_with_sensor`.

    Returns
    -------
    Examples

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import ComputerExpert
    >>> from robonav.robot import REFLEX, Simulator, random_worlds
    >>> from robonav.sensing import Ring, SensorPolicy, fully_connected, labelled_examples
    >>> policy = SensorPolicy(Ring(9), fully_connected(Ring(9), seed=0))
    >>> simulator, rng = Simulator(random_worlds(2, seed=1)), np.random.default_rng(0)
    >>> labelled_examples(simulator, policy, ComputerExpert(), True, rng, REFLEX).readings.shape[1:]
    torch.Size([9])
    """
    asked: list[Examples] = []
    learner = policy.begin(simulator, rng)

    def select_actions(
        simulator: Simulator, sensing: Sensing, robots: Robots
    ) -> Robots:
        """Record one step of K robots, and return their actions."""
        wanted = expert(simulator, robots)
        read = inputs_of(policy.sensor, simulator, sensing, robots)
        asked.append(Examples(*read, torch.from_numpy(wanted)))
        if expert_acts:
            return wanted
        return np.asarray(learner(simulator, sensing, robots))

    for _ in run_episodes(simulator, select_actions, reflex=reflex):
        pass
    return joined(*asked)


def joined(*parts: Examples) -> Examples:
    """Join examples.

    Examples
    --------
    >>> import torch
    >>> one = Examples(torch.zeros(1, 9), torch.zeros(1, 3), torch.zeros(1, dtype=torch.int64))
    >>> len(joined(one, one))
    2
    """
    return Examples(
        torch.cat([part.readings for part in parts]),
        torch.cat([part.targets for part in parts]),
        torch.cat([part.labels for part in parts]),
    )


def train_network(
    policy: SensorPolicy,
    known: Examples,
    optimiser: torch.optim.Optimizer,
    *,
    steps: int,
    batch: int,
    rng: np.random.Generator,
) -> None:
    """Train a network in place to answer examples with the expert's actions, by steps on the cross-entropy."""
    for _ in range(steps):
        chosen = torch.from_numpy(rng.integers(len(known), size=batch))
        logits = policy.network(known.readings[chosen], known.targets[chosen])
        loss = cross_entropy(logits, known.labels[chosen])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()


def randomised_simulators(
    worlds: Sequence[Worlds],
    *,
    noise: float,
    slip: float,
    speed: float = 2.0,
    max_steps: int = 100,
    seed: int,
) -> list[Simulator]:
    """Return a simulator for each batch of worlds, with uncertainties of its own: domain randomisation.

    Parameters
    ----------
    worlds : sequence of Worlds
        One batch for each round of training.
    noise : float
        The largest error of sensing, in metres. Each batch draws its own between 0 and this.
    slip : float
        The largest probability that a turn slips, see :func:`robonav.robot.neighbour_slip`, likewise.
    speed : float
        Of the robots in m/s.
    max_steps : int
        Seconds after which an episode is stopped.
    seed : int
        Of what is drawn.

    Returns
    -------
    list of Simulator

    Examples
    --------
    >>> from robonav.robot import random_worlds
    >>> from robonav.sensing import randomised_simulators
    >>> worlds = [random_worlds(5, seed=seed) for seed in range(3)]
    >>> [round(simulator.noise, 2) for simulator in randomised_simulators(worlds, noise=1.0, slip=0.4, seed=0)]
    [0.64, 0.04, 0.81]
    """
    drawn = np.random.default_rng(seed).random((len(worlds), 2))
    return [
        Simulator(
            batch,
            speed,
            noise=noise * share[0],
            slip=neighbour_slip(slip * share[1]),
            max_steps=max_steps,
        )
        for batch, share in zip(worlds, drawn, strict=True)
    ]
