"""The networks of the package. ``python -m robonav.experiments.ship`` trains them again.

The networks of chapter 3 are those of the first run of its tables. For each method of chapters 4, 5 and 6,
some seeds train under the conditions of Tables 4.3 and 5.2 and of the pages of chapter 6, and the package has the
policy with the greatest success in the worlds that are reserved for tuning.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from robonav.deep import GAILResult, PPOResult, train_gail, train_ppo
from robonav.networks import NetworkPolicy, Weights, save_weights
from robonav.nnql import METHODS
from robonav.progress import bar
from robonav.robot import Worlds

from .chapter3 import setup as chapter3
from .chapter4 import setup as chapter4
from .chapter4 import tuning as tuning4
from .chapter5 import setup as chapter5
from .chapter5 import tuning as tuning5
from .chapter6 import curriculum, gail, ppo
from .runner.setup import Setup

SEED = 0  # the seed of chapter 3's networks
SEEDS_4 = tuple(range(tuning4.TUNING_SEEDS, tuning4.TUNING_SEEDS + 8))
SEEDS_5 = tuple(range(tuning5.TUNING_SEEDS + 10, tuning5.TUNING_SEEDS + 14))
SEEDS_6 = tuple(range(100, 108))
TEMPERATURE_5 = (
    0.05  # a robot without memory can go in circles, which a little randomness ends
)
COMMAND = "python -m robonav.experiments.ship"


def folder_of(chapter: str) -> Path:
    """Return the folder of a chapter's networks: that of "lfd", "nnql", "nirl" or "deep".

    Parameters
    ----------
    chapter : str
        The chapter's package.

    Returns
    -------
    Path

    Examples
    --------
    >>> folder_of("lfd").name
    'shipped'
    """
    return Path(str(files(f"robonav.{chapter}"))) / "shipped"


def lfd_weights() -> dict[str, Weights]:
    """Return ``lfd``, cloned from 25 demonstrations, and ``dagger``, after three rounds with as many maps each."""
    made = {
        "seed": SEED,
        "demonstrations": chapter3.DEMONSTRATIONS,
        "obstacles": chapter3.SETUP.obstacles,
        "speed": chapter3.SETUP.speed,
        "seed of the worlds": chapter3.DEMONSTRATION_SEED + SEED,
    }
    rounds = {
        "rounds": chapter3.ROUNDS,
        "seed of the worlds of round 1": chapter3.DAGGER_SEED + 10 * SEED,
    }
    cloned, dagger = chapter3.cloned_policy(SEED), chapter3.dagger_result(SEED).policy
    return {
        "lfd": weights_of("lfd", cloned, made),
        "dagger": weights_of("dagger", dagger, made | rounds),
    }


def nnql_weights(
    method: str, seeds: Sequence[int] = SEEDS_4, *, length: float = 1.0
) -> Weights:
    """Return the best network of some seeds of a method of chapter 4."""
    settings = chapter4.tuned()[method]
    temperature = chapter4.EVALUATION_TEMPERATURE[method]

    def train_seed(seed: int) -> NetworkPolicy:
        trained = chapter4.training(method, seed, "thesis", settings, length=length)
        return replace(trained.policies[0], temperature=temperature)

    worlds = chapter4.SETUP.tuning_worlds(
        len(SEEDS_4), chapter4.SETUP.navigations["thesis"]
    )
    seed, policy, success = best_of(train_seed, seeds, chapter4.SETUP, worlds)
    made = {
        "command": COMMAND,
        "seed": seed,
        "seeds": list(seeds),
        "episodes": round(chapter4.EPISODES * length),
        "speed": chapter4.SETUP.speed,
        "obstacles": chapter4.SETUP.obstacles,
        "settings": dict(settings),
        "success in tuning worlds (%)": success,
    }
    return weights_of(method, policy, made)


def nirl_weights(
    method: str,
    seeds: Sequence[int] = SEEDS_5,
    *,
    length: float = 1.0,
    discount: float = chapter5.OTHER_DISCOUNT,
) -> Weights:
    """Return the best network of some seeds of a method of chapter 5, with its learned reward."""
    settings = chapter5.tuned(method, discount)

    def train_seed(seed: int) -> NetworkPolicy:
        learned = chapter5.trained(method, seed, settings, length=length)
        return replace(learned.policy, temperature=TEMPERATURE_5)

    worlds = chapter5.SETUP.tuning_worlds(
        len(SEEDS_5), chapter5.SETUP.navigations["thesis"]
    )
    seed, policy, success = best_of(train_seed, seeds, chapter5.SETUP, worlds)
    learned = chapter5.trained(method, seed, settings, length=length)
    made = {
        "command": COMMAND,
        "seed": seed,
        "seeds": list(seeds),
        "demonstrations": chapter5.DEMONSTRATIONS,
        "iterations": round(chapter5.ITERATIONS * length),
        "speed": chapter5.SETUP.speed,
        "obstacles": chapter5.SETUP.obstacles,
        "settings": dict(settings),
        "success in tuning worlds (%)": success,
        "reward weights": learned.reward_weights.tolist(),
    }
    return weights_of(method, policy, made)


def ppo_weights(seeds: Sequence[int] = SEEDS_6) -> Weights:
    """Return the best actor of some seeds of PPO, with the settings of its page."""
    result = train_ppo(seeds, task=ppo.task(), **ppo.TRAINING)
    return best_actor("ppo", seeds, result, ppo.SETUP, result.settings)


def curriculum_weights(seeds: Sequence[int] = SEEDS_6) -> Weights:
    """Return the best actor of some seeds of PPO after the last of its stages."""
    *_, last = curriculum.STAGES
    result = curriculum.trained(last, tuple(seeds), "thesis")
    stages = curriculum.EXPERIMENTS[0].settings["stages"]
    return best_actor("ppo-curriculum", seeds, result, curriculum.SETUP, stages)


def gail_weights(seeds: Sequence[int] = SEEDS_6) -> Weights:
    """Return the best actor of some seeds of GAIL, each with ten demonstrations of its own."""
    result = train_gail(
        [gail.demonstrations_of_run(gail.MOST_DEMONSTRATIONS, seed) for seed in seeds],
        seeds,
        task=gail.task(),
        reward=gail.REWARDS[gail.SHIPPED_REWARD],
        **gail.TRAINING,
    )
    return best_actor("gail", seeds, result, gail.SETUP, result.settings)


def best_actor(
    method: str,
    seeds: Sequence[int],
    result: PPOResult | GAILResult,
    setup: Setup,
    settings: Mapping[str, Any],
) -> Weights:
    """Return the actor with the greatest success in the worlds that are reserved for tuning."""
    policies = {
        seed: replace(policy, temperature=ppo.TEMPERATURE)
        for seed, policy in zip(seeds, result.policies, strict=True)
    }
    worlds = setup.tuning_worlds(0, setup.navigations["thesis"])
    seed, policy, success = best_of(policies.__getitem__, seeds, setup, worlds)
    made = {
        "command": COMMAND,
        "seed": seed,
        "seeds": list(seeds),
        "speed": setup.speed,
        "obstacles": setup.obstacles,
        "settings": dict(settings),
        "success in tuning worlds (%)": success,
    }
    return weights_of(method, policy, made)


def best_of(
    train_seed: Callable[[int], NetworkPolicy],
    seeds: Sequence[int],
    setup: Setup,
    worlds: Worlds,
) -> tuple[int, NetworkPolicy, float]:
    """Train with each seed. Return seed, policy and success of the best policy; of equal ones the first."""
    policies = {seed: train_seed(seed) for seed in seeds}
    success = {
        seed: setup.evaluate(policy, worlds)["success"]
        for seed, policy in policies.items()
    }
    best = max(seeds, key=lambda seed: success[seed])
    return best, policies[best], success[best]


def weights_of(method: str, policy: NetworkPolicy, made: dict[str, Any]) -> Weights:
    """Return a policy with a description of its training, in the form of a file."""
    return Weights(policy.network, method, policy.encoder, made, policy.temperature)


def all_weights() -> Iterator[tuple[str, str, Weights]]:
    """Return chapter, file name and weights of every network of the package."""
    for name, weights in lfd_weights().items():
        yield "lfd", name, weights
    for method in METHODS:
        yield "nnql", method, nnql_weights(method)
    for method in chapter5.LEARNERS:
        yield "nirl", method, nirl_weights(method)
    yield "deep", "ppo", ppo_weights()
    yield "deep", "ppo-curriculum", curriculum_weights()
    yield "deep", "gail", gail_weights()


def ship() -> None:
    """Write a file for every network to the folder from which the package loads it."""
    total = 2 + len(METHODS) + len(chapter5.LEARNERS) + 3
    with bar("networks that ship") as progress:
        for done, (chapter, name, weights) in enumerate(all_weights()):
            folder_of(chapter).mkdir(exist_ok=True)
            save_weights(folder_of(chapter) / f"{name}.safetensors", weights)
            progress(done + 1, total)


if __name__ == "__main__":
    ship()
