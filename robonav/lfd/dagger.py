"""Dataset aggregation: ask the expert about the states that the learner gets into (Ross, Gordon and Bagnell 2011)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import Encoder, Policy, Simulator, Worlds
from robonav.validation import check_generator

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
    """What DAgger went through, round by round; in round 0 there are the first demonstrations alone.

    Attributes
    ----------
    policies : one a round; the last is the result.
    demonstrations : what each of them has learned from, everything so far.
    """

    policies: tuple[NetworkPolicy, ...]
    demonstrations: tuple[Demonstrations, ...]

    @property
    def policy(self) -> NetworkPolicy:
        """The last."""
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
    """Let a policy drive in D worlds, and write down what an expert would have done instead.

    The ``actions`` of what is returned are the expert's, the states are the policy's. Where a reflex decides, nobody
    is asked.

    Parameters
    ----------
    policy : drives.
    worlds : batch of D.
    expert : gives the labels; by default the computer expert, who plans anew in each state.
    speed : m/s.
    seed : of the generator handed to the policy.
    max_steps : seconds after which a drive is stopped.
    """
    rng = check_generator("seed", seed)

    def follow_policy(simulator: Simulator, asked: Actions) -> Actions:
        return np.asarray(policy(simulator.sense()[asked], rng), dtype=np.int64)

    return record(
        follow_policy,
        worlds,
        speed=speed,
        labeller=expert or ComputerExpert(),
        max_steps=max_steps,
    )


def dagger(
    demonstrations: Demonstrations,
    rounds: Sequence[Worlds],
    *,
    expert: Callable[[], Expert] = ComputerExpert,
    hidden: int = 8,
    regularisation: float = 1.0,
    iterations: int = 300,
    seed: int = 0,
    encoder: Encoder | None = None,
    temperature: float = TEMPERATURE,
    max_steps: int = MAX_STEPS,
    progress: Progress | None = None,
) -> DaggerResult:
    """Clone the demonstrations, drive, have the expert label the states met, learn from everything; again.

    Parameters
    ----------
    demonstrations : to begin with.
    rounds : worlds to drive in, one batch a round.
    expert : makes the one who labels.
    hidden, regularisation, iterations, seed, encoder : as in :func:`learn_policy`.
    temperature : of the policies, see :class:`NetworkPolicy`. The states that a learner meets by itself ask for more
        different answers than an expert's drives, and at 0 more policies go round in circles.
    max_steps : seconds after which a round's drives are stopped. A robot that goes in circles has the expert label
        the same few places again and again, and what is learned from everything then leans to them.

    Raises
    ------
    ValueError : as :func:`learn_policy`.
    """

    def learned(gathered: Demonstrations) -> NetworkPolicy:
        policy = learn_policy(
            gathered, hidden, regularisation, iterations, seed, encoder=encoder
        )
        return replace(policy, temperature=temperature)

    gathered, policies = [demonstrations], [learned(demonstrations)]
    for number, worlds in enumerate(rounds, start=1):
        met = collect_with_expert_labels(
            policies[-1],
            worlds,
            expert=expert(),
            speed=demonstrations.speed,
            seed=seed,
            max_steps=max_steps,
        )
        gathered.append(concatenate([gathered[-1], met]))
        policies.append(learned(gathered[-1]))
        if progress is not None:
            progress(number, len(rounds))
    return DaggerResult(tuple(policies), tuple(gathered))
