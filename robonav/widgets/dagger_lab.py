"""DAgger by hand: the robot drives, the reader takes over where it errs, and the robot learns from the corrections."""

from __future__ import annotations

from typing import Any

from robonav.lfd import DaggerResult, dagger, demonstrate
from robonav.networks.policy import NetworkPolicy
from robonav.robot import random_worlds
from robonav.validation import check_integer, check_real

from .imitation_lab import OBSTACLES, imitation_lab
from .kernel_training import (
    TRIED,
    KernelTraining,
    Report,
    sentence_on_rates,
    success_rates,
)
from .shared import front_end, style_sheet

ROUNDS_SEED = 610_000
"""The maps of round i of robot n have the seed ``ROUNDS_SEED + 100 * n + i``."""
REGULARISATION = 0.1
"""lambda of all trainings, as in the page's own."""


class DaggerLab(KernelTraining):
    """Train a weak robot, watch it fail, take over, and train it again.

    With a kernel, the computer expert corrects robots in Python, round after round.
    """

    _esm = front_end(
        "simulator", "maps", "episode", "steering", "files",
        "learning/random", "learning/worlds", "learning/network", "learning/lbfgs",
        "learning/astar", "learning/trials", "learning/worker", "learning/training_panel",
        "learning/kernel_panel", "kept_demonstrations", "kept_robots", "imitation", "dagger_lab",
    )  # fmt: skip
    _css = style_sheet(
        "maps",
        "steering",
        "kept_demonstrations",
        "learning/training_panel",
        "imitation",
        "dagger_lab",
    )

    def train(self, request: dict[str, Any], report: Report) -> str:
        """Train robots by DAgger, and try the policy of every round in new maps."""
        settings = request["settings"]
        robots = check_integer("robots", request["robots"], at_least=1)
        rounds = check_integer("rounds", settings["rounds"], at_least=1, at_most=99)
        n_worlds = check_integer("maps a round", settings["maps"], at_least=1)
        first = check_integer("demonstrations", settings["demonstrations"], at_least=1)
        decay = check_real("beta", settings["beta"], at_least=0, at_most=1)
        worlds = random_worlds(TRIED, OBSTACLES, seed=self.data["trial"]["seed"])
        demonstrations = demonstrate(
            random_worlds(first, OBSTACLES, seed=self.data["expert"]["seed"])
        )
        each = rounds + (rounds + 1)  # rounds, and policies that are tried
        results: list[DaggerResult] = []
        rates: list[list[float]] = []
        for robot in range(robots):
            begun, total = robot * each, robots * each
            seeds = [ROUNDS_SEED + 100 * robot + i for i in range(1, rounds + 1)]
            results.append(
                dagger(
                    demonstrations,
                    [random_worlds(n_worlds, OBSTACLES, seed=seed) for seed in seeds],
                    beta_decay=decay,
                    regularisation=REGULARISATION,
                    seed=robot,
                    progress=report.part(begun, total),
                )
            )
            rates.append([])
            for i, policy in enumerate(results[-1].policies):
                rates[-1] += success_rates([policy], worlds)
                report(begun + rounds + i + 1, total, at=i, arrived=rates[-1][-1])
        self.trainings = results
        before = sum(rate[0] for rate in rates) / robots
        after = sentence_on_rates([rate[-1] for rate in rates], TRIED)
        return f"{after} Before the first round it was {before:.1f} %."


def dagger_lab(
    policy: NetworkPolicy,
    *,
    expert_seed: int = 9,
    n_worlds: int = 200,
    test_seed: int = 2024,
) -> DaggerLab:
    """Make a lab in which the reader corrects a robot that has learned from one demonstration.

    Parameters
    ----------
    policy : NetworkPolicy
        The book's own, to compare with.
    expert_seed : int
        The seed of the expert's world.
    n_worlds : int
        Number of worlds to test in.
    test_seed : int
        Their seed, another than that of the expert's world.

    Returns
    -------
    DaggerLab

    Raises
    ------
    ValueError
        If there is no map to test in, or the two seeds are equal.

    Examples
    --------
    >>> from robonav.benchmark.policies import method
    >>> sorted(dagger_lab(method("dagger"), n_worlds=10).data)
    ['book', 'expert', 'playground', 'trial']
    """
    lab = imitation_lab(
        policy,
        demonstrations=1,
        expert_seed=expert_seed,
        n_worlds=n_worlds,
        test_seed=test_seed,
    )
    return DaggerLab(lab.data)
