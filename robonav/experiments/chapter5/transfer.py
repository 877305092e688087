"""Uses of a learned reward: training in other worlds (section 5.5.4), and an expert that slips (Eq. (5.12))."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from robonav.lfd import Demonstrations, demonstrate
from robonav.lfd.demonstrations import LEARNED
from robonav.nirl import (
    expert_decisions,
    learn_under_reward,
    map_uniform_prior,
    most_frequent,
)
from robonav.nirl.learning import Refinement
from robonav.nnql import NavigationTask, train
from robonav.robot import Policy, neighbour_slip, random_worlds, turn_to_clearer_side

from ..chapter4.setup import batch_of
from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers
from ..runner.settings import Settings
from .ablations import policy_at
from .setup import (
    CONDITIONS,
    DEMONSTRATION_SEED,
    DEMONSTRATIONS,
    ITERATIONS,
    SETUP,
    SHORTENED,
    control_reward,
    demonstrations,
    encoder,
    policy_improvement,
    task,
    train_irl,
    trained,
    trained_policy,
    tuned,
)

TRANSFER_CONDITIONS = CONDITIONS["transfer"]
PLACES = tuple(tuple(place) for place in TRANSFER_CONDITIONS["places"])
SEEDS_PER_BATCH: int = TRANSFER_CONDITIONS["seeds_per_batch"]
NNQL = Settings.of(TRANSFER_CONDITIONS["nnql"])


def train_under_reward(
    reward_weights: NDArray[np.float64],
    seed: int,
    length: float,
    obstacles: int,
    speed: float,
) -> Policy:
    """Return the last policy of a new robot that trains in other worlds with a given reward (5, k + 1)."""
    settings = tuned("nirl")
    iterations = round(ITERATIONS * length)
    learned = learn_under_reward(
        demonstrations(seed),
        reward_weights,
        task=task(settings["target"], obstacles=obstacles, speed=speed),
        seed=seed + 1,
        improver=policy_improvement(settings),
        iterations=iterations,
        inverse_temperature=settings["inverse_temperature"],
        hidden=settings["hidden"],
    )
    return policy_at(learned, iterations)


def same_policy(
    seed: int, length: float, obstacles: int, speed: float, *, method: str
) -> Policy:
    """Return the policy learned with 20 obstacles at 2 m/s, unchanged."""
    return trained_policy(method, seed, length=length)


def learned_reward(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """Return a new robot, trained there with the reward learned with 20 obstacles at 2 m/s."""
    weights = trained("nirl", seed, tuned("nirl"), length=length).reward_weights
    return train_under_reward(weights, seed, length, obstacles, speed)


def given_reward(
    seed: int, length: float, obstacles: int, speed: float, *, control: str
) -> Policy:
    """Return a new robot, trained there with the reward of a control: zero, or random."""
    weights = control_reward(control, seed, encoder(tuned("nirl")["target"]).size)
    return train_under_reward(weights, seed, length, obstacles, speed)


def reward_table(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """Return a new robot, trained there by NNQL with the reward of Table 4.1."""
    seeds = batch_of(seed, SEEDS_PER_BATCH)
    return _reward_table(seeds, length, obstacles, speed)[seed % SEEDS_PER_BATCH]


@lru_cache(maxsize=16)
def _reward_table(
    seeds: range, length: float, obstacles: int, speed: float
) -> Sequence[Policy]:
    there = NavigationTask(
        obstacles,
        speed=speed,
        starts=[(10, 10)],
        targets=[(90, 90)],
        reflex=SETUP.reflex,
    )
    episodes = round(TRANSFER_CONDITIONS["episodes"] * length)
    return train("nnql", seeds, episodes, task=there, **NNQL).policies


def clearer_side(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """Return the baseline."""
    return turn_to_clearer_side


POLICIES: dict[str, Callable[[int, float, int, float], Policy]] = {
    "kept-policy": partial(same_policy, method="nirl"),
    "kept-clone": partial(same_policy, method="lfd"),
    "learned-reward-there": learned_reward,
    "table-reward-there": reward_table,
    "zero-reward-there": partial(given_reward, control="zero-reward"),
    "random-reward-there": partial(given_reward, control="random-reward"),
    "freer-side": clearer_side,
}
"""The methods for other worlds: an old policy, or a new one that is trained there."""


def elsewhere(case: Case, seed: int, scale: str) -> Numbers:
    """Test one run of one method in maps of another density, or at another speed."""
    obstacles, speed = int(case["obstacles"]), float(case["speed"])
    method = POLICIES[str(case["method"])]
    policy = method(seed, SHORTENED[scale], obstacles, speed)
    return SETUP.evaluate(policy, SETUP.test_worlds(seed, scale, obstacles), speed)


REFINEMENTS: dict[str, Refinement | None] = {
    "as demonstrated": None,
    "most frequent": most_frequent,
    "maximum a posteriori": map_uniform_prior,
}


@lru_cache(maxsize=64)
def slipping_demonstrations(seed: int) -> Demonstrations:
    """Return demonstrations of an expert whose turns miss by 30 degrees with probability 0.3."""
    worlds = random_worlds(
        DEMONSTRATIONS, SETUP.obstacles, seed=DEMONSTRATION_SEED + seed
    )
    slip = neighbour_slip(TRANSFER_CONDITIONS["slip"])
    return demonstrate(worlds, speed=SETUP.speed, slip=slip, reflex=SETUP.reflex)


def refine(case: Case, seed: int, scale: str) -> Numbers:
    """Test one run of NIRL from contradictory demonstrations, refined by Eq. (5.12) in one of two ways, or not."""
    trajectories = (
        slipping_demonstrations(seed)
        if case["expert"] == "computer, slipping"
        else demonstrations(seed, expert=str(case["expert"]))
    )
    refinement = REFINEMENTS[str(case["actions"])]
    changed = 0.0
    if refinement is not None:
        steps = expert_decisions(trajectories, encoder(tuned("nirl")["target"]))
        refined = refinement(steps.inputs.round(6), steps.actions, LEARNED)
        changed = 100 * refined.changed.mean()
    learned = train_irl("nirl", trajectories, seed, tuned("nirl"), refine=refinement)
    rates = SETUP.evaluate(learned.policy, SETUP.test_worlds(seed, scale))
    return rates | {"actions changed": changed}


TRANSFER = Experiment(
    name="nirl-transfer",
    title="Success elsewhere: the old policy, training under the learned and other rewards, cloning, and a baseline",
    cases=[
        {"obstacles": obstacles, "speed": speed, "method": method}
        for obstacles, speed in PLACES
        for method in POLICIES
    ],
    run=elsewhere,
    seeds={"quick": 1, "thesis": 10},
    shortened="a tenth of the iterations",
    settings={
        "learned with": {
            "obstacles": SETUP.obstacles,
            "speed": SETUP.speed,
            **tuned("nirl"),
        },
        "episodes with Table 4.1": TRANSFER_CONDITIONS["episodes"],
        "NNQL": dict(NNQL),
        "navigations a run": SETUP.navigations,
    },
    plot=SUCCESS_BARS,
)
REFINEMENT = Experiment(
    name="nirl-refinement",
    title="Success with experts that contradict themselves, with and without MAP refinement",
    cases=[
        {"expert": expert, "actions": refinement}
        for expert in ("computer", "human", "computer, slipping")
        for refinement in REFINEMENTS
    ],
    run=refine,
    seeds={"quick": 1, "thesis": 10},
    settings={
        "slip": TRANSFER_CONDITIONS["slip"],
        "settings": dict(tuned("nirl")),
        "navigations a run": SETUP.navigations,
    },
    plot=SUCCESS_BARS,
)

EXPERIMENTS = (TRANSFER, REFINEMENT)
