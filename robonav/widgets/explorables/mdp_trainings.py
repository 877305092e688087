"""What the kernel computes for the explorables of chapter 2: values from episodes, and plans for beliefs."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np

from robonav import mdp
from robonav.mdp.episodes import EpisodeLog, policy_sampler
from robonav.mdp.exploration import constant

from ..kernel_training import Report
from .chapter2 import (
    COIN,
    EPISODES,
    ROOMS,
    RUNS,
    TRUTH,
    five_rooms,
    grid_to_touch,
    page_episodes,
    page_vectors,
    plans_by_steps,
    turn_arrows,
)
from .training import Curve, Dial, Menu, Trained, trains

POLICIES = ("the one that goes around", "an optimal one")
AT_ONCE = 20
"""Episodes between two points of the curve."""


@trains(
    "turn_arrows",
    "The value of the start, as the mean return of many episodes",
    action="Compute in Python",
    unit="episode",
    length="episodes",
    settings={
        "policy": Menu("policy", POLICIES),
        "step_reward": Dial("reward of a step", -2.0, 0.0, 0.02, -0.04),
        "slip": Dial("a step slips with probability", 0.0, 0.6, 0.05, 0.2),
        "discount": Dial("discount γ", 0.5, 0.95, 0.05, 0.95),
        "episodes": Dial("episodes", 200, 10_000, 200, 2000),
        "seed": Dial("seed", 0, 20, 1, 0),
    },
    curves={
        "mean": Curve(
            "mean return", "The mean of all returns so far.", low=None, digits=3
        ),
        "error": Curve(
            "standard error",
            "The standard deviation of the returns, divided by the square root of their number.",
            digits=3,
        ),
    },
)
def mean_return(settings: dict[str, Any], report: Report) -> Trained:
    """Episodes of a policy on the grid of four by three cells; the page gets this grid and this policy."""
    grid = mdp.four_by_three(slip=settings["slip"], step_reward=settings["step_reward"])
    discount, total = settings["discount"], settings["episodes"]
    model, given = grid_to_touch(grid, discount)
    around = settings["policy"] == POLICIES[0]
    policy = np.array(
        turn_arrows()["policy"] if around else mdp.policy_iteration(model).policy
    )
    rng = np.random.default_rng(settings["seed"])
    returns: list[float] = []
    while len(returns) < total:
        episodes = mdp.rollouts(
            grid.environment(), policy, AT_ONCE, max_steps=1000, seed=rng
        )
        returns += [
            float(mdp.discounted_return(episode.rewards, discount)[0])
            for episode in episodes
        ]
        report(
            len(returns),
            total,
            at=len(returns),
            mean=float(np.mean(returns)),
            error=float(np.std(returns, ddof=1) / np.sqrt(len(returns))),
        )
    value = float(grid.start @ mdp.policy_evaluation(model, policy))
    error = float(np.std(returns, ddof=1) / np.sqrt(total))
    return Trained(
        [np.array(returns)],
        f"The mean return is {np.mean(returns):.3f}, with a standard error of {error:.3f}. Bellman's equations give "
        f"the value {value:.3f}.",
        given | {"policy": policy.tolist()},
    )


@trains(
    "tiger_vectors",
    "Plans for your own tiger, backed up at a few beliefs",
    action="Compute in Python",
    unit="steps to go",
    length="steps",
    settings={
        "accuracy": Dial("listening is right in", 50, 99, 1, 85, " %"),
        "bite": Dial("a wrong door costs", 10, 300, 10, 100),
        "discount": Dial("discount γ", 0.5, 0.95, 0.05, 0.95),
        "beliefs": Dial("beliefs to back up", 1, 40, 1, 20),
        "steps": Dial("steps to go", 1, 60, 1, 30),
    },
    curves={
        "value": Curve("value", "The value of the uniform belief.", low=None, digits=2),
        "vectors": Curve("vectors", "How many vectors are kept.", digits=0),
    },
)
def plans_for_beliefs(settings: dict[str, Any], report: Report) -> Trained:
    """Point-based backups for the tiger; the page gets the vectors for each number of steps to go."""
    accuracy, steps = settings["accuracy"] / 100, settings["steps"]
    known = mdp.tiger(accuracy=accuracy)
    rewards = np.where(known.mdp.rewards == -100, -settings["bite"], known.mdp.rewards)
    tiger = mdp.POMDP(
        mdp.FiniteMDP(known.mdp.transitions, rewards, settings["discount"]),
        known.observations,
    )
    uniform = [0.5, 0.5]
    points = mdp.spread_beliefs(tiger, uniform, settings["beliefs"])
    plans = []
    for plan in plans_by_steps(tiger, points, steps):
        plans.append(plan)
        report(
            len(plans),
            steps,
            at=len(plans),
            value=float(plan.value(uniform)),
            vectors=len(plan.vectors),
        )
    ways = ("listen", "open left", "open right")
    return Trained(
        [plans[-1]],
        f"Beliefs backed up: {len(points)}. Vectors with {steps} steps to go: {len(plans[-1].vectors)}. The uniform "
        f"belief has the value {plans[-1].value(uniform):.2f}, and the best action there is to "
        f"{ways[plans[-1].action(uniform)]}.",
        {"accuracies": [accuracy], "plans": [[page_vectors(plan) for plan in plans]]},
    )


PREDICTIONS = ("TD(0)", "Monte Carlo, first visit", "Monte Carlo, every visit")


class _RunInRooms:
    """One run of a prediction in the five rooms, which can be continued.

    It is what :func:`robonav.mdp.td_prediction` or :func:`robonav.mdp.monte_carlo_prediction` does with this seed, but
    some episodes at a time, so that the page can draw the error meanwhile. All estimates are 0.5 at first.
    """

    def __init__(self, algorithm: Callable[..., None], seed: int) -> None:
        rng = np.random.default_rng(seed)
        self._algorithm = algorithm
        self._values, self._visits = [0.5] * len(COIN), [0] * len(COIN)
        n_states, n_actions = COIN.shape
        self._act = policy_sampler(COIN, n_states, n_actions, rng)
        self._log = EpisodeLog(five_rooms(), 0, 10_000, rng)
        self._log.record(lambda: np.array(self._values))

    def learn(self, episodes: int) -> None:
        """Go on for some episodes."""
        self._algorithm(
            self._log, self._act, self._values, self._visits, episodes, discount=1.0
        )
        self._log.end_episode()

    @property
    def result(self) -> mdp.PredictionResult:
        """The estimates so far."""
        return mdp.PredictionResult(
            np.array(self._values), np.array(self._visits), self._log.history
        )

    @property
    def error(self) -> float:
        """The root mean squared error over the rooms."""
        return float(np.sqrt(np.mean((np.array(self._values)[ROOMS] - TRUTH) ** 2)))

    def episodes(self, count: int) -> str:
        """The first episodes, for the page."""
        return page_episodes(self._log.visited_states[:count])


def _prediction(name: str, rate: float) -> Callable[..., None]:
    """The algorithm of a name in the menu, as it is written in :mod:`robonav.mdp`."""
    if name == "TD(0)":
        return partial(inspect.unwrap(mdp.td_prediction), learning_rate=constant(rate))
    visit = "first" if name.endswith("first visit") else "every"
    return partial(inspect.unwrap(mdp.monte_carlo_prediction), visit=visit)


@trains(
    "td_step_size",
    "Values of the five rooms, from twenty runs",
    unit="episode",
    length="episodes",
    settings={
        "method": Menu("method", PREDICTIONS),
        "learning_rate": Dial("learning rate α of TD(0)", 0.01, 0.5, 0.01, 0.05),
        "episodes": Dial("episodes of each run", 100, 1000, 100, 200),
        "seed": Dial("first seed", 0, 200, 20, 20),
    },
    curves={
        "error": Curve(
            "error",
            "Root mean squared error over the rooms, mean of 20 runs.",
            digits=3,
        ),
    },
)
def values_of_rooms(settings: dict[str, Any], report: Report) -> Trained:
    """Runs in the five rooms; the page gets their first episodes and the learning rate."""
    method, rate = settings["method"], settings["learning_rate"]
    algorithm = _prediction(method, rate)
    seeds = range(settings["seed"], settings["seed"] + RUNS)
    runs = [_RunInRooms(algorithm, seed) for seed in seeds]
    total = RUNS * settings["episodes"]
    errors = {0: float(np.mean([run.error for run in runs]))}
    report(0, total, at=0, error=errors[0])
    for begun in range(0, settings["episodes"], AT_ONCE):
        done = begun + AT_ONCE
        for number, run in enumerate(runs):
            report(RUNS * begun + number * AT_ONCE, total)
            run.learn(AT_ONCE)
        errors[done] = float(np.mean([run.error for run in runs]))
        report(RUNS * done, total, at=done, error=errors[done])
    lowest = min(errors, key=lambda at: errors[at])
    said = f"{method} with α = {rate:.2f}" if method == "TD(0)" else method
    return Trained(
        [run.result for run in runs],
        f"{said}: after {settings['episodes']} episodes the error is {errors[settings['episodes']]:.3f}, mean of "
        f"{RUNS} runs. The lowest point of the curve is {errors[lowest]:.3f}, after {lowest} episodes.",
        {"episodes": [run.episodes(EPISODES) for run in runs], "rate": rate},
    )


LAST = 10
"""The last episodes, over which the sentence at the end takes the mean."""


@trains(
    "shared_tiles",
    "A car that learns to climb, with tilings of your own",
    unit="episode",
    length="episodes",
    settings={
        "tilings": Dial("tilings of 8 × 8 tiles", 1, 8, 1, 8),
        "learning_rate": Dial("learning rate α, times the tilings", 0.1, 1.0, 0.1, 0.5),
        "episodes": Dial("episodes", 10, 100, 10, 40),
        "seed": Dial("seed", 0, 20, 1, 0),
    },
    curves={
        "steps": Curve(
            "steps to the top",
            "Steps of each episode, which is cut off after 2000.",
            digits=0,
        ),
    },
)
def car_with_tiles(settings: dict[str, Any], report: Report) -> Trained:
    """SARSA with tile coding on MountainCar; the page gets the number of tilings."""
    tilings = settings["tilings"]
    car = gym.make("MountainCar-v0", max_episode_steps=2000)
    counted = gym.wrappers.RecordEpisodeStatistics(car, buffer_length=1)
    tiles = mdp.Tiles((-1.2, -0.07), (0.6, 0.07), (8, 8), tilings, n_actions=3)

    def progress(done: int, total: int) -> None:
        """Report the steps of the episode that has just ended."""
        report(done, total, at=done, steps=int(counted.length_queue[-1]))

    learned = mdp.linear_sarsa(
        counted,
        settings["episodes"],
        tiles,
        discount=1.0,
        learning_rate=settings["learning_rate"] / tilings,
        epsilon=0.0,
        seed=settings["seed"],
        progress=progress,
    )
    taken = learned.lengths[-LAST:].mean()
    expected = -learned.q([(-0.5, 0.0)]).max()
    return Trained(
        [learned],
        f"The first episode takes {learned.lengths[0]} steps, and the last {LAST} take {taken:.0f} on average. From "
        f"rest in the valley, the weights predict {expected:.0f} steps.",
        {"tilings": tilings},
    )
