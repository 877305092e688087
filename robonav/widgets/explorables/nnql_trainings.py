"""What the kernel trains for the explorables of chapter 4: networks that learn Q-values by the chapter's methods."""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.experiments.chapter4.setup import EVALUATION_TEMPERATURE
from robonav.nnql import STARTS, TARGETS, NavigationTask, double_dqn_targets, train
from robonav.nnql.reward import reward
from robonav.nnql.training import TrainingResult
from robonav.progress import Progress
from robonav.robot import OUTCOMES, Action, Sensing, Worlds, random_worlds

from ..kernel_training import TRIED, Report, sentence_on_rates, success_rates
from ..shared import packed_network
from .training import Curve, Dial, Menu, Trained, trains

Floats = NDArray[np.float64]

METHODS: dict[str, tuple[str, dict[str, Any]]] = {
    "NNQL": ("nnql", {}),
    "online": ("online", {}),
    "NFQ": ("nfq", {}),
    "double DQN": ("dqn", {"targets": double_dqn_targets}),
}
"""Method and settings of :func:`robonav.nnql.train`, by the name in the menu."""
WINDOW = 30
"""Episodes of each robot over which the live curves count, as in Fig. 4.4."""

MAPS_SEED = 58_000

COLLISIONS = "In how many of the latest 30 episodes a decision of the network ends in a collision."


class CountedCollisions:
    """The reward of Table 4.1, which also counts the decisions that end in a collision.

    A training asks for the reward of decisions only, and tells its progress in episodes. Together they give a live
    curve without any change of the training.
    """

    def __init__(self) -> None:
        self.collisions = 0

    def __call__(
        self, before: Sensing, after: Sensing, outcome: NDArray[np.int8]
    ) -> Floats:
        """The reward (N,) of N decisions."""
        self.collisions += int((OUTCOMES[outcome] == "collided").sum())
        return reward(before, after, outcome)

    def watcher(
        self, report: Report, name: str, robots: int, *, before: int, of_all: int
    ) -> Progress:
        """The progress of a training of some robots, with the share of collisions as points of the curve ``name``."""
        marks: deque[tuple[int, int]] = deque([(0, 0)])

        def progress(done: int, total: int) -> None:
            """Report a point of the curve after every ``robots`` episodes."""
            if done - marks[-1][0] < robots and done < total:
                report(before + done, of_all)
                return
            while len(marks) > 1 and done - marks[0][0] > WINDOW * robots:
                marks.popleft()
            first, collided = marks[0]
            share = 100 * (self.collisions - collided) / max(done - first, 1)
            if done > marks[-1][0]:
                marks.append((done, self.collisions))
            report(before + done, of_all, at=done // robots, **{name: share})

        return progress


def _tested(
    training: TrainingResult, worlds: Worlds, task: NavigationTask
) -> list[float]:
    """How often each robot of a training arrives in new worlds, at the low temperature of the book's tables."""
    policies = [
        replace(policy, temperature=EVALUATION_TEMPERATURE[training.method])
        for policy in training.policies
    ]
    return success_rates(policies, worlds, speed=task.speed, max_steps=task.max_steps)


def _new_worlds(obstacles: int) -> Worlds:
    return random_worlds(
        TRIED, obstacles, seed=MAPS_SEED, starts=STARTS, targets=TARGETS
    )


def _facing(sensor: int, task: NavigationTask) -> Floats:
    """The inputs of a robot that senses one object, at degree of danger 4, and has its target ahead."""
    ranges = np.full((1, 9), 10.0)
    ranges[0, sensor - 1] = 4.5
    nothing = np.zeros((1, 9), bool)
    return task.encoder(Sensing(ranges, nothing, np.ones(1, int), np.zeros(1, bool)))[0]


@trains(
    "moving_together",
    "A network that has learned to drive, in place of the small one",
    unit="episode",
    length="episodes",
    settings={
        "rescale": Menu("targets are rescaled by", ("shift", "clip")),
        "hidden": Dial("hidden units", 1, 24, 1, 8),
        "discount": Dial("discount γ", 0.0, 0.95, 0.05, 0.6),
        "obstacles": Dial("obstacles", 0, 20, 5, 10),
        "episodes": Dial("episodes", 20, 300, 20, 100),
        "seed": Dial("seed", 0, 20, 1, 3),
    },
    curves={"collided": Curve("collisions (%)", COLLISIONS, high=100.0, digits=0)},
)
def network_that_drives(settings: dict[str, Any], report: Report) -> Trained:
    """NNQL on the robot; the page gets the network, and two states with an object ahead and on the left."""
    counted = CountedCollisions()
    task = NavigationTask(settings["obstacles"], reward=counted)
    episodes = settings["episodes"]
    training = train(
        "nnql",
        [settings["seed"]],
        episodes,
        task=task,
        hidden=settings["hidden"],
        discount=settings["discount"],
        rescale=settings["rescale"],
        progress=counted.watcher(report, "collided", 1, before=0, of_all=episodes),
    )
    rates = _tested(training, _new_worlds(settings["obstacles"]), task)
    return Trained(
        [training],
        f"{sentence_on_rates(rates, TRIED)} State A is an object ahead, and state B is one on the left, both at "
        "degree of danger 4.",
        {
            "network": packed_network(training.network[0]),
            "states": [_facing(1, task).tolist(), _facing(2, task).tolist()],
            "names": ["A, an object ahead", "B, one on the left"],
            "actions": [Action(action).name for action in range(5)],
        },
    )


@trains(
    "seeds_to_tell_apart",
    "Compare two methods by trainings of your own",
    unit="episode",
    length="episodes",
    settings={
        "one": Menu("one method", tuple(METHODS)),
        "other": Menu("the other method", tuple(reversed(METHODS))),
        "trainings": Dial("trainings of each", 2, 16, 1, 4),
        "obstacles": Dial("obstacles", 0, 20, 5, 10),
        "episodes": Dial("episodes of each training", 25, 300, 25, 100),
        "seed": Dial("first seed", 0, 100, 10, 0),
    },
    curves={
        "one": Curve("collisions, one (%)", COLLISIONS, high=100.0, digits=0),
        "other": Curve("collisions, other (%)", COLLISIONS, high=100.0, digits=0),
    },
)
def two_methods(settings: dict[str, Any], report: Report) -> Trained:
    """Trainings by two methods; the page gets their difference in success, and how much single trainings scatter."""
    robots, episodes = settings["trainings"], settings["episodes"]
    seeds = range(settings["seed"], settings["seed"] + robots)
    worlds = _new_worlds(settings["obstacles"])
    results: list[TrainingResult] = []
    rates: list[list[float]] = []
    for number, which in enumerate(("one", "other")):
        counted = CountedCollisions()
        task = NavigationTask(settings["obstacles"], reward=counted)
        watcher = counted.watcher(
            report,
            which,
            robots,
            before=number * robots * episodes,
            of_all=2 * robots * episodes,
        )
        method, options = METHODS[settings[which]]
        results.append(
            train(method, seeds, episodes, task=task, progress=watcher, **options)
        )
        rates.append(_tested(results[-1], worlds, task))
    means = [float(np.mean(own)) for own in rates]
    scatter = float(np.sqrt(np.mean([np.var(own, ddof=1) for own in rates])))
    difference = abs(means[0] - means[1])
    names = [settings["one"], settings["other"]]
    said = "; ".join(
        f"{name} arrives in {mean:.1f} % of {TRIED} new maps on average, between {min(own):.1f} and {max(own):.1f} %"
        for name, mean, own in zip(names, means, rates, strict=True)
    )
    return Trained(
        results,
        f"{said}. The means differ by {difference:.1f} points, and single trainings have a standard deviation of "
        f"{scatter:.1f}.",
        {
            "seeds": robots,
            # in the steps of the page's sliders
            "difference": round(difference / 0.25) * 0.25,
            "scatter": max(0.5, round(scatter / 0.25) * 0.25),
        },
    )
