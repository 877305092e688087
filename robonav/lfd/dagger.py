"""Dataset aggregation (DAgger): train on the states that the learner itself visits (Ross, Gordon and Bagnell 2011).

A cloned policy is trained on the states that the expert visits. Once it makes a mistake, it meets states that the
training examples do not cover, and makes more mistakes there. If it errs with probability epsilon in the expert's
states, its cost over T steps can exceed the expert's by the order of epsilon T^2. DAgger trains on the states that the
learner itself visits, and brings this down to the order of epsilon T. It repeats three things, in round i = 1, 2, ...:

1. Roll out the learner pi_i, and label each state s that it visits with the action pi*(s) that the expert would take
   there. In a mixture with the expert, each step is the expert's with probability beta_i: it then takes the action
   pi*(s) instead of pi_i(s).
2. Aggregate: D_i = D_(i-1) and all these pairs (s, pi*(s)).
3. Train a new policy pi_(i+1) on D_i by supervised learning.

Two things differ from the paper. It starts with an empty D and lets the expert choose all actions of its first round;
here D_0 are the expert's demonstrations, which is the same. And it returns the policy of all rounds that does best in
states kept for validation; here the result is the policy of the last round, and ``policies`` holds all of them.

:func:`dagger` is this loop, :func:`labelled_rollout` its first step, and :class:`Mixture` chooses the actions there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import (
    REFLEX,
    Encoder,
    Policy,
    ReflexRule,
    Sensing,
    Simulator,
    Transition,
    Worlds,
    run_episodes,
)
from robonav.robot.simulator import check_actions
from robonav.validation import ArrayArgument, check_generator, check_real

from ._arguments import checked
from .behaviour_cloning import learn_policy
from .computer_expert import ComputerExpert
from .demonstrations import (
    MAX_STEPS,
    Actions,
    Demonstrations,
    Expert,
    by_trajectory,
    concatenate,
)

TEMPERATURE = 0.4


@checked
def dagger(
    demonstrations: Demonstrations,
    rounds: Sequence[Worlds],
    *,
    expert: Expert | None = None,
    beta_decay: float = 0.0,
    hidden: int = 8,
    regularisation: float = 1.0,
    iterations: int = 300,
    seed: int | ArrayLike = 0,
    encoder: Encoder | None = None,
    temperature: float = TEMPERATURE,
    reflex: ReflexRule | None = REFLEX,
    max_steps: int = MAX_STEPS,
    progress: Progress | None = None,
) -> DaggerResult:
    """Dataset aggregation, DAgger (Ross, Gordon and Bagnell 2011).

    In round i the robot is steered by a mixture: with probability beta_i it takes the expert's action, else the
    learner's. By default beta is 1 in round 0, whose episodes are the demonstrations, and 0 in all later rounds. Ross
    et al. call this the parameter-free version and report that it often performs best: the later rounds then visit
    the states that the learner will meet when it is on its own.

    Parameters
    ----------
    demonstrations : Demonstrations
        The expert's own episodes, the data of round 0.
    rounds : sequence of Worlds
        One batch of worlds for each later round.
    expert : callable, optional
        Labels the states visited; by default the computer expert.
    beta_decay : float
        p in the schedule ``beta_i = p**i`` of :func:`beta_schedule`.
    hidden : int
        Number of units in the hidden layer.
    regularisation : float
        lambda in the cost, Eq. (3.22).
    iterations : int
        The most iterations of L-BFGS in each round.
    seed : int or (rounds + 1, 2) array of int
        From a whole number, :func:`round_seeds` derives for each round a seed of the initial weights and a seed of the
        episodes. An array gives these seeds themselves: row i holds the two of round i.
    encoder : Encoder, optional
        Turns what the robot senses into the network's inputs, see :func:`learn_policy`.
    temperature : float
        Temperature of the policies, see :class:`NetworkPolicy`. At 0 a policy without memory can go round in circles;
        actions drawn at random lead out of them.
    reflex : callable, optional
        What the robot does before expert or learner is asked, see :class:`robonav.robot.Reflex`.
    max_steps : int
        Seconds after which an episode is stopped. Without a limit, a robot that goes round in circles would fill the
        dataset with copies of a few states.
    progress : callable, optional
        Called as ``progress(round, rounds)``.

    Returns
    -------
    DaggerResult

    Raises
    ------
    TypeError, ValueError
        As :func:`learn_policy`; or if ``seed`` has another shape, or ``beta_decay`` is not in [0, 1].

    Examples
    --------
    >>> from robonav.lfd import dagger, demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> result = dagger(demonstrations, [random_worlds(2, obstacles=10, seed=2)], iterations=10)
    >>> len(result.demonstrations[1]) > len(result.demonstrations[0])
    True
    """

    def train(dataset: Demonstrations, weights_seed: int) -> NetworkPolicy:
        policy = learn_policy(
            dataset, hidden, regularisation, iterations, weights_seed, encoder=encoder
        )
        return replace(policy, temperature=temperature)

    expert = expert or ComputerExpert()
    betas = beta_schedule(beta_decay, len(rounds))
    seeds = round_seeds(seed, len(rounds))
    datasets = [demonstrations]  # round 0: the expert alone chose the actions
    policies = [train(demonstrations, seeds[0].weights)]
    for i, worlds in enumerate(rounds, start=1):
        simulator = Simulator(worlds, demonstrations.speed, max_steps=max_steps)
        rng = np.random.default_rng(seeds[i].episodes)
        # Roll out the mixture, and label the states visited with the expert's actions.
        learner, beta = policies[-1], betas[i]
        visited = labelled_rollout(simulator, learner, expert, beta, rng, reflex=reflex)
        datasets.append(concatenate([datasets[-1], visited]))  # aggregate
        policies.append(train(datasets[-1], seeds[i].weights))  # train
        if progress is not None:
            progress(i, len(rounds))
    return DaggerResult(tuple(policies), tuple(datasets))


def labelled_rollout(
    simulator: Simulator,
    policy: Policy,
    expert: Expert,
    beta: float,
    rng: np.random.Generator,
    *,
    reflex: ReflexRule | None = REFLEX,
) -> Demonstrations:
    """Roll out the mixture of expert and learner, and label each state visited with the expert's action.

    Where a reflex decides, neither of the two is asked, and the reflex's action is recorded.

    Parameters
    ----------
    simulator : Simulator
        One robot in each of D worlds, at the start.
    policy : callable
        The learner.
    expert : callable
        Labels the states.
    beta : float
        Probability that a robot takes the expert's action.
    rng : Generator
        For the learner's random numbers.
    reflex : callable, optional
        What the robot does before expert or learner is asked.

    Returns
    -------
    Demonstrations
        The states visited by the mixture, with the expert's actions.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import ComputerExpert
    >>> from robonav.lfd.dagger import labelled_rollout
    >>> from robonav.robot import Simulator, random_worlds, straight
    >>> simulator = Simulator(random_worlds(2, obstacles=10, seed=1), max_steps=100)
    >>> visited = labelled_rollout(
    ...     simulator, straight, ComputerExpert(), beta=0.0, rng=np.random.default_rng(0))
    >>> bool((visited.effective.actions != 0).any())  # straight always goes on, the expert does not
    True
    """
    # asked for actions, the mixture also keeps what the expert would have done
    mixture = Mixture(policy, expert, beta, rng, len(simulator))
    steps: list[Transition] = []
    for step in run_episodes(simulator, mixture, reflex=reflex):  # one second
        labels = mixture.labels[step.robots]  # the expert's actions there
        labels = np.where(step.asked, labels, step.actions)  # elsewhere: the reflex
        steps.append(replace(step, actions=labels))
    return by_trajectory(simulator, steps)


class Mixture:
    """Expert and learner in a mixture, as DAgger rolls it out, with the expert's action in every state as its label.

    Parameters
    ----------
    policy : callable
        The learner.
    expert : callable
        Chooses and labels.
    beta : float
        Probability that a robot takes the expert's action.
    rng : Generator
        For the learner's random numbers.
    n : int
        Number of robots.

    Attributes
    ----------
    labels : (n,) array of int
        What the expert would do in the latest state in which each robot was asked.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import ComputerExpert
    >>> from robonav.lfd.dagger import Mixture
    >>> from robonav.robot import Simulator, random_worlds, straight
    >>> simulator = Simulator(random_worlds(2, obstacles=10, seed=1))
    >>> mixture = Mixture(straight, ComputerExpert(), 0.0, np.random.default_rng(0), n=2)
    >>> mixture(simulator, simulator.sense(), np.array([0, 1]))  # the learner goes straight on
    array([0, 0])
    >>> mixture.labels  # the expert would turn left
    array([1, 1])
    """

    def __init__(
        self,
        policy: Policy,
        expert: Expert,
        beta: float,
        rng: np.random.Generator,
        n: int,
    ) -> None:
        self.policy, self.expert, self.beta, self.rng = policy, expert, beta, rng
        self.coin = rng.spawn(1)[0]  # its own, which leaves the learner's draws alone
        self.labels = np.zeros(n, dtype=np.int64)

    def __call__(
        self, simulator: Simulator, sensing: Sensing, robots: Actions
    ) -> Actions:
        """Return the actions of the robots with these indices (K,); their labels are kept."""
        self.labels[robots] = self.expert(simulator, robots)  # what the expert would do
        learner = self.policy(sensing, self.rng)  # what the learner would do
        expert_acts = self.coin.random(len(robots)) < self.beta
        return np.where(expert_acts, self.labels[robots], learner)


@checked
def collect_with_expert_labels(
    policy: Policy,
    worlds: Worlds,
    *,
    expert: Expert | None = None,
    beta: float = 0.0,
    speed: float = 2.0,
    seed: int | np.random.Generator = 0,
    max_steps: int = MAX_STEPS,
) -> Demonstrations:
    """Roll out a policy in D worlds and label the states it visits with an expert's actions.

    Checks its arguments and calls :func:`labelled_rollout`, the first of DAgger's three steps.

    Parameters
    ----------
    policy : callable
        The learner.
    worlds : Worlds
        Batch of D.
    expert : callable, optional
        Labels the states; by default the computer expert, which plans from wherever the robot is.
    beta : float
        Probability that a robot takes the expert's action instead of the policy's.
    speed : float
        Of the robots, in m/s.
    seed : int or Generator
        For the policy's random numbers.
    max_steps : int
        Seconds after which an episode is stopped.

    Returns
    -------
    Demonstrations
        The states visited, with the expert's actions. Where a reflex decides, the reflex's action is recorded.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong type or out of bounds.

    Examples
    --------
    >>> from robonav.lfd import collect_with_expert_labels
    >>> from robonav.robot import random_worlds, straight
    >>> labelled = collect_with_expert_labels(straight, random_worlds(2, obstacles=10, seed=1))
    >>> len(labelled.outcome)
    2
    """
    simulator = Simulator(worlds, speed, max_steps=max_steps)
    beta = check_real("beta", beta, at_least=0, at_most=1)
    rng = check_generator("seed", seed)

    def learner(sensing: Sensing, rng: np.random.Generator) -> Actions:
        return check_actions(policy(sensing, rng), (len(sensing),))

    return labelled_rollout(simulator, learner, expert or ComputerExpert(), beta, rng)


@dataclass(frozen=True, eq=False)
class DaggerResult:
    """The policies and datasets of all rounds of DAgger. Round 0 is behaviour cloning of the first demonstrations.

    Attributes
    ----------
    policies : tuple of NetworkPolicy
        The policy trained in each round. The last one is the result; the paper takes the one that does best in
        validation.
    demonstrations : tuple of Demonstrations
        The aggregate that each of these policies was trained on.

    Examples
    --------
    >>> from robonav.lfd import dagger, demonstrate
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> result = dagger(demonstrations, [random_worlds(2, obstacles=10, seed=2)], iterations=10)
    >>> len(result.policies)
    2
    """

    policies: tuple[NetworkPolicy, ...]
    demonstrations: tuple[Demonstrations, ...]

    @property
    def policy(self) -> NetworkPolicy:
        """The policy of the last round."""
        return self.policies[-1]


def beta_schedule(decay: float, rounds: int) -> list[float]:
    """Return beta_i = decay**i for round 0 and the rounds after it.

    Ross et al. count rounds from 1 and write p**(i - 1). ``decay=0`` gives their parameter-free version 1, 0, 0, ...

    Examples
    --------
    >>> from robonav.lfd.dagger import beta_schedule
    >>> beta_schedule(0.0, 3), beta_schedule(0.5, 3)
    ([1.0, 0.0, 0.0, 0.0], [1.0, 0.5, 0.25, 0.125])
    """
    return [decay**i for i in range(rounds + 1)]


class RoundSeeds(NamedTuple):
    """The seeds of one round of DAgger: for the network's initial weights, and for the learner's episodes."""

    weights: int
    episodes: int


@checked
def round_seeds(seed: ArrayArgument, rounds: int) -> list[RoundSeeds]:
    """Return the seeds of round 0, which has no episodes, and of the rounds after it.

    All are derived from one whole number, or are given as an array of shape (rounds + 1, 2).

    Examples
    --------
    >>> from robonav.lfd.dagger import round_seeds
    >>> round_seeds([[3, 0], [4, 5]], rounds=1)
    [RoundSeeds(weights=3, episodes=0), RoundSeeds(weights=4, episodes=5)]
    """
    if np.ndim(seed) == 0:
        sequence = np.random.SeedSequence(seed)
        pairs = sequence.generate_state(2 * (rounds + 1)).reshape(-1, 2)
    else:
        pairs = seed
    return [RoundSeeds(weights, episodes) for weights, episodes in pairs.tolist()]
