"""What a learned reward is good for: practising elsewhere (section 5.5.4); and mending an expert that slips (5.12)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.lfd import Demonstrations, demonstrate
from robonav.lfd.demonstrations import LEARNED
from robonav.nirl import (
    expert_transitions,
    learn_under_reward,
    map_uniform_prior,
    most_frequent,
)
from robonav.nirl.methods import Refinement
from robonav.nnql import NavigationTask, train
from robonav.robot import Policy, neighbour_slip, random_worlds, turn_to_clearer_side

from ..chapter4.tuning import arguments, block
from ..runner.experiment import Case, Experiment
from .ablations import member
from .setup import (
    DEMONSTRATIONS,
    ITERATIONS,
    NAVIGATIONS,
    OBSTACLES,
    SHORTENED,
    SHOWN_WORLDS,
    SPEED,
    Numbers,
    control,
    course,
    demonstrations,
    descent,
    driven,
    encoder,
    learned,
    new_worlds,
    policy,
    teach,
)
from .tables import settings

EPISODES = 1400  # of training with Table 4.1's reward: as many drives as practice takes
TOGETHER = 5  # seeds that train at once under Table 4.1: quicker than one by one, with the same numbers
PLACES = ((10, 2.0), (30, 2.0), (20, 1.0), (20, 3.0))
SLIP = 0.3
TABLE_SETTINGS: dict[str, Any] = {
    "gamma": 0.7, "alpha": (0.4, 0.05), "rate": (0.3, 0.05), "temperature": (0.9, 0.05), "rescale": "clip",
}  # fmt: skip


def under(
    theta: NDArray[np.float64], seed: int, length: float, obstacles: int, speed: float
) -> Policy:
    """The last policy of a new robot that practises elsewhere under a reward (5, k + 1), and nothing else."""
    chosen = settings("nirl")
    iterations = round(ITERATIONS * length)
    practised = learn_under_reward(
        demonstrations(seed),
        theta,
        course=course(chosen["target"], obstacles=obstacles, speed=speed),
        seed=seed + 1,
        improve=descent(chosen),
        iterations=iterations,
        eta=chosen["eta"],
        hidden=chosen["hidden"],
    )
    return member(practised, iterations)


def carried(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """The policy learned among 20 obstacles at 2 m/s, as it is."""
    return policy("nirl", seed, settings("nirl"), length=length)


def cloned(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """The policy cloned from the same demonstrations, as it is."""
    return policy("cloning", seed, settings("cloning"))


def by_reward(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """A new robot, trained there under the reward learned among 20 obstacles at 2 m/s."""
    theta = learned("nirl", seed, settings("nirl"), length=length).reward_weights
    return under(theta, seed, length, obstacles, speed)


def by_control(
    seed: int, length: float, obstacles: int, speed: float, *, name: str
) -> Policy:
    """The same under a reward of zero, or of chance."""
    theta = control(name, seed, encoder(settings("nirl")["target"]).size)
    return under(theta, seed, length, obstacles, speed)


def by_table(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """A new robot, trained there by NNQL with the reward of Table 4.1."""
    return _by_table(block(seed, TOGETHER), length, obstacles, speed)[seed % TOGETHER]


@lru_cache(maxsize=16)
def _by_table(
    seeds: range, length: float, obstacles: int, speed: float
) -> Sequence[Policy]:
    ground = NavigationTask(
        obstacles, speed=speed, starts=[(10, 10)], targets=[(90, 90)]
    )
    return train(
        "nnql",
        seeds,
        round(EPISODES * length),
        task=ground,
        **arguments(TABLE_SETTINGS),
    ).policies


def by_rule(seed: int, length: float, obstacles: int, speed: float) -> Policy:
    """The rule of three lines."""
    return turn_to_clearer_side


TAKEN: dict[str, Callable[[int, float, int, float], Policy]] = {
    "the policy itself": carried,
    "a cloned policy": cloned,
    "trained there under the learned reward": by_reward,
    "trained there under Table 4.1": by_table,
    "trained there under no reward": partial(by_control, name="zero reward"),
    "trained there under a random reward": partial(by_control, name="random reward"),
    "freer side": by_rule,
}


def elsewhere(case: Case, seed: int, scale: str) -> Numbers:
    """One run of one way to drive in maps of another density, or at another speed."""
    obstacles, speed = int(case["obstacles"]), float(case["speed"])
    robot = TAKEN[str(case["taken along"])](seed, SHORTENED[scale], obstacles, speed)
    return driven(robot, new_worlds(scale, seed, obstacles), speed)


REFINEMENTS: dict[str, Refinement | None] = {
    "as shown": None,
    "most frequent": most_frequent,
    "most telling": map_uniform_prior,
}


@lru_cache(maxsize=64)
def slipping(seed: int) -> Demonstrations:
    """A computer expert whose turns come out 30 degrees off, three times in ten."""
    worlds = random_worlds(DEMONSTRATIONS, OBSTACLES, seed=SHOWN_WORLDS + seed)
    return demonstrate(worlds, speed=SPEED, slip=neighbour_slip(SLIP))


def refine(case: Case, seed: int, scale: str) -> Numbers:
    """One run of NIRL from an expert that contradicts itself, mended by Eq. (5.12) in one way or another."""
    shown = (
        slipping(seed)
        if case["expert"] == "slipping"
        else demonstrations(seed, expert=str(case["expert"]))
    )
    how = REFINEMENTS[str(case["actions"])]
    changed = 0.0
    if how is not None:
        steps = expert_transitions(shown, encoder(settings("nirl")["target"]))
        changed = (
            100 * how(steps.inputs.round(6), steps.actions, LEARNED).changed.mean()
        )
    found = teach("nirl", shown, seed, settings("nirl"), refine=how)
    return driven(found.policy, new_worlds(scale, seed)) | {"actions changed": changed}


TRANSFER = Experiment(
    name="nirl-transfer",
    title="Elsewhere: the policy taken along, or the reward alone; beside cloning, other rewards, and a rule",
    cases=[
        {"obstacles": obstacles, "speed": speed, "taken along": taken}
        for obstacles, speed in PLACES
        for taken in TAKEN
    ],
    run=elsewhere,
    seeds={"quick": 1, "thesis": 10},
    shortened="a tenth of the iterations",
    settings={
        "learned with": {"obstacles": OBSTACLES, "speed": SPEED} | settings("nirl"),
        "episodes with Table 4.1": EPISODES,
        "NNQL": TABLE_SETTINGS,
        "drives a run": NAVIGATIONS,
    },
)
REFINEMENT = Experiment(
    name="nirl-refinement",
    title="Experts that contradict themselves, and what MAP refinement mends",
    cases=[
        {"expert": expert, "actions": how}
        for expert in ("computer", "human", "slipping")
        for how in REFINEMENTS
    ],
    run=refine,
    seeds={"quick": 1, "thesis": 10},
    settings={"slip": SLIP, "settings": settings("nirl"), "drives a run": NAVIGATIONS},
)

EXPERIMENTS = (TRANSFER, REFINEMENT)
