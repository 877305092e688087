"""Dataset aggregation: ask the expert about the states that the learner gets into (Ross, Gordon and Bagnell 2011)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import Encoder, Policy, Simulator, Worlds
from robonav.validation import check_array, check_generator, check_integer

from .behaviour_cloning import learn_policy
from .computer_expert import ComputerExpert
from .demonstrations import (
    MAX_STEPS,
    Actions,
    Demonstrations,
    Expert,
    concatenate,
    record,
)

TEMPERATURE = 0.4


@dataclass(frozen=True, eq=False)
class DaggerResult:
    """The rounds of DAgger; round 0 has the first demonstrations alone.

    Attributes
    ----------
    policies : tuple of NetworkPolicy
        One a round; the last is the result.
    demonstrations : tuple of Demonstrations
        What each of the policies was trained on: everything gathered so far.

    Examples
    --------
    >>> from robonav.lfd import dagger, demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> len(dagger(shown, [random_worlds(2, obstacles=10, seed=2)], iterations=10).policies)
    2
    """

    policies: tuple[NetworkPolicy, ...]
    demonstrations: tuple[Demonstrations, ...]

    @property
    def policy(self) -> NetworkPolicy:
        """The policy of the last round."""
        return self.policies[-1]


def collect_with_expert_labels(
    policy: Policy,
    worlds: Worlds,
    *,
    expert: Expert | None = None,
    speed: float = 2.0,
    seed: int = 0,
    max_steps: int = MAX_STEPS,
) -> Demonstrations:
    """Let a policy drive through D worlds, and record what an expert would have done instead.

    The states are the policy's, the ``actions`` are the expert's. Where a reflex decides, neither of them is asked.

    Parameters
    ----------
    policy : callable
        Drives the robots.
    worlds : Worlds
        Batch of D.
    expert : callable, optional
        Gives the labels; by default the computer expert, which plans anew in each state.
    speed : float
        Metres a second.
    seed : int
        Of the generator handed to the policy.
    max_steps : int
        Seconds after which an episode is stopped.

    Returns
    -------
    Demonstrations

    Examples
    --------
    >>> from robonav.lfd import collect_with_expert_labels
    >>> from robonav.robot import random_worlds, straight
    >>> labelled = collect_with_expert_labels(straight, random_worlds(2, obstacles=10, seed=1))
    >>> len(labelled.outcome)
    2
    """
    rng = check_generator("seed", seed)

    def learner(simulator: Simulator, asked: Actions) -> Actions:
        return np.asarray(policy(simulator.sense()[asked], rng), dtype=np.int64)

    return record(
        learner,
        worlds,
        speed=speed,
        labeller=expert or ComputerExpert(),
        max_steps=max_steps,
    )


def dagger(
    demonstrations: Demonstrations,
    rounds: Sequence[Worlds],
    *,
    expert: Expert | None = None,
    hidden: int = 8,
    regularisation: float = 1.0,
    iterations: int = 300,
    seed: int | ArrayLike = 0,
    encoder: Encoder | None = None,
    temperature: float = TEMPERATURE,
    max_steps: int = MAX_STEPS,
    progress: Progress | None = None,
) -> DaggerResult:
    """Dataset aggregation (Ross, Gordon and Bagnell 2011): let the learner drive and the expert label its states.

    Each round the policy drives, the expert labels the states that it meets, and a new policy is trained on
    everything gathered so far.

    Parameters
    ----------
    demonstrations : Demonstrations
        To begin with.
    rounds : sequence of Worlds
        The worlds to drive in, one batch a round.
    expert : callable, optional
        Gives the labels; by default the computer expert.
    hidden, regularisation, iterations, encoder
        As in :func:`learn_policy`.
    seed : int or (rounds + 1, 2) array of int
        Each round gets one seed for its initial weights and one for its episodes, both drawn from this seed; or these
        seeds themselves, a row a round. Round 0 has no episodes.
    temperature : float
        Of the policies, see :class:`NetworkPolicy`. The states that a learner meets ask for more varied answers than
        an expert's own, and at temperature 0 more of the policies drive in circles.
    max_steps : int
        Seconds after which an episode of a round is stopped. A robot that drives in circles has the expert label the
        same few places again and again, and the next policy then leans towards them.
    progress : callable, optional
        Called as ``progress(round, rounds)``.

    Returns
    -------
    DaggerResult

    Raises
    ------
    ValueError
        As :func:`learn_policy`; or if ``seed`` has another shape.

    Examples
    --------
    >>> from robonav.lfd import dagger, demonstrate
    >>> from robonav.robot import random_worlds
    >>> shown = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> result = dagger(shown, [random_worlds(2, obstacles=10, seed=2)], iterations=10)
    >>> len(result.demonstrations[1]) > len(result.demonstrations[0])
    True
    """
    seeds = round_seeds(seed, len(rounds))

    def trained(gathered: Demonstrations, seed: int) -> NetworkPolicy:
        policy = learn_policy(
            gathered, hidden, regularisation, iterations, seed, encoder=encoder
        )
        return replace(policy, temperature=temperature)

    gathered, policies = [demonstrations], [trained(demonstrations, seeds[0][0])]
    for number, worlds in enumerate(rounds, start=1):
        weights_seed, episodes_seed = seeds[number]
        labelled = collect_with_expert_labels(
            policies[-1], worlds, expert=expert, speed=demonstrations.speed,
            seed=episodes_seed, max_steps=max_steps,
        )  # fmt: skip
        gathered.append(concatenate([gathered[-1], labelled]))
        policies.append(trained(gathered[-1], weights_seed))
        if progress is not None:
            progress(number, len(rounds))
    return DaggerResult(tuple(policies), tuple(gathered))


def round_seeds(seed: int | ArrayLike, rounds: int) -> list[list[int]]:
    """Return a seed of the weights and one of the episodes for each round, the demonstrations' round 0 first."""
    if np.ndim(seed) == 0:
        sequence = np.random.SeedSequence(check_integer("seed", seed, at_least=0))
        pairs: NDArray = sequence.generate_state(2 * (rounds + 1)).reshape(-1, 2)
        return pairs.tolist()
    given = check_array("seed", seed, shape=(rounds + 1, 2), dtype=np.int64)
    return given.tolist()
