"""Imitation lab: in the page, a robot learns from the reader's episodes and navigates new maps."""

from __future__ import annotations

from typing import Any

from robonav.lfd import demonstrate
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import random_worlds
from robonav.validation import check_instance, check_integer

from .imitation_training import train_imitators
from .kernel_training import TRIED, KernelTraining, Report
from .shared import front_end, style_sheet
from .simulator import page_demonstrations, page_policy

OBSTACLES = 10


class ImitationLab(KernelTraining):
    """Choose demonstrations, train, watch the robot in new maps, compare it, and download its weights.

    With a kernel, Python trains several robots on the same demonstrations.
    """

    _esm = front_end(
        "simulator", "maps", "episode", "files",
        "learning/random", "learning/worlds", "learning/network", "learning/lbfgs",
        "learning/trials", "learning/worker", "learning/training_panel",
        "learning/kernel_panel", "kept_demonstrations", "kept_robots", "imitation", "imitation_lab",
    )  # fmt: skip
    _css = style_sheet(
        "maps",
        "kept_demonstrations",
        "learning/training_panel",
        "kept_robots",
        "imitation",
    )

    def train(self, request: dict[str, Any], report: Report) -> dict[str, Any]:
        """Train robots side by side by L-BFGS, and return the one with the least cost."""
        settings = request["settings"]
        worlds = random_worlds(
            TRIED, settings["obstacles"], seed=self.data["trial"]["seed"]
        )
        self.trainings, ended = train_imitators(
            page_demonstrations(request["demonstrations"]),
            settings,
            worlds,
            report,
            robots=request["robots"],
        )
        return ended


def imitation_lab(
    policy: NetworkPolicy,
    *,
    demonstrations: int = 100,
    expert_seed: int = 9,
    n_worlds: int = 200,
    test_seed: int = 2024,
    playground: str = "playground.html",
    progress: Progress | None = None,
) -> ImitationLab:
    """Make a lab in which a robot learns from demonstrations of the reader or of the computer expert.

    The page gets the expert's actions, one digit for each step, and repeats them in the same worlds.

    Parameters
    ----------
    policy : NetworkPolicy
        The book's policy, with which the reader's is compared.
    demonstrations : int
        The number of demonstrations of the computer expert.
    expert_seed : int
        The seed of the expert's worlds.
    n_worlds : int
        The number of test worlds.
    test_seed : int
        Their seed, another than that of the expert's worlds.
    playground : str
        The address of the page on which the reader steers the robot.
    progress : callable, optional
        Called as ``progress(done, demonstrations)`` while the expert demonstrates.

    Returns
    -------
    ImitationLab

    Raises
    ------
    ValueError
        If there is no demonstration or no map, or the two seeds are equal.

    Examples
    --------
    >>> from robonav.benchmark.policies import method
    >>> lab = imitation_lab(method("lfd"), demonstrations=2, n_worlds=10)
    >>> len(lab.data["expert"]["actions"])
    2
    """
    check_instance("policy", policy, NetworkPolicy)
    count = check_integer("demonstrations", demonstrations, at_least=1)
    tested = check_integer("n_worlds", n_worlds, at_least=1)
    if expert_seed == test_seed:
        raise ValueError(
            f"expert_seed and test_seed must differ, got {test_seed} twice"
        )
    worlds = random_worlds(count, OBSTACLES, seed=expert_seed)
    driven = demonstrate(worlds, progress=progress)
    actions = [
        "".join(map(str, driven.actions[driven.trajectory == i])) for i in range(count)
    ]
    return ImitationLab(
        {
            "expert": {"seed": expert_seed, "obstacles": OBSTACLES, "actions": actions},
            "book": page_policy(policy),
            "trial": {"seed": test_seed, "maps": tested},
            "playground": playground,
        }
    )
