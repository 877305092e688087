"""Q-learning lab: a robot learns from the reader's own reward, in the page or, with a kernel, in Python."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from robonav.benchmark.policies import method
from robonav.experiments.chapter4.setup import EVALUATION_TEMPERATURE, THESIS
from robonav.networks import NetworkPolicy
from robonav.nnql import STARTS, TARGETS, TrainingResult, train
from robonav.nnql.reward import TABLE
from robonav.robot import Reflex, random_worlds
from robonav.validation import check_instance, check_integer, check_one_of

from .kernel_training import (
    TRIED,
    KernelTraining,
    Report,
    sentence_on_rates,
    success_rates,
)
from .q_learning_settings import METHODS, QLearningSettings
from .shared import front_end, style_sheet
from .simulator import page_policy

SHOWS = ("maps", "training", "targets", "nothing")
"""Where a fault shows."""
GROUPS = ("reward", "exploration", "learning", "robot")
MAPS = (100, 200)
ROBOTS_PER_BATCH = 4
"""Robots that the kernel trains at once; the page gets their results together."""

MAPS_SEED = 44_000
"""Seed of the maps that robots are tried in; no training and no experiment uses them."""


@dataclass(frozen=True)
class Preset:
    """Settings with which learning fails, and their correction.

    Parameters
    ----------
    name : str
        The name of the fault.
    watch : str
        One or two sentences on what to observe.
    cure : str
        One sentence on the correction.
    settings : QLearningSettings
        The settings with the fault.
    shows : {"maps", "training", "targets", "nothing"}
        Where the fault shows: in the new maps, in the arrivals of the training, in the targets that do not fit into
        the outputs, or nowhere, where what looks like a fault is none.

    Raises
    ------
    ValueError
        If ``shows`` is none of these.

    Examples
    --------
    >>> from robonav.widgets.q_learning_lab import Preset
    >>> from robonav.widgets.q_learning_settings import QLearningSettings
    >>> cold = QLearningSettings(temperature=(0.03, 0.03))
    >>> Preset("cold", "It hardly explores.", "The temperature falls.", cold).shows
    'maps'
    """

    name: str
    watch: str
    cure: str
    settings: QLearningSettings
    shows: str = "maps"

    def __post_init__(self) -> None:
        check_one_of("shows", self.shows, SHOWS)


class QLearningLab(KernelTraining):
    """Set reward, exploration and learning; train, watch, cancel; drive new maps; compare; download the weights."""

    _esm = front_end(
        "simulator",
        "maps",
        "files",
        "learning/random",
        "learning/network",
        "learning/worlds",
        "learning/nnql",
        "learning/trials",
        "learning/dqn",
        "learning/worker",
        "learning/training_panel",
        "learning/kernel_panel",
        "kept_robots",
        "q_learning_lab",
    )
    _css = style_sheet(
        "maps", "learning/training_panel", "kept_robots", "q_learning_lab"
    )

    def train(self, request: dict[str, Any], report: Report) -> str:
        """Train robots, a few at a time, and return a sentence with their results."""
        settings = QLearningSettings.from_page(request["settings"])
        robots = check_integer("robots", request["robots"], at_least=1)
        worlds = random_worlds(
            TRIED, settings.obstacles, settings.moving, seed=MAPS_SEED, starts=STARTS, targets=TARGETS,
        )  # fmt: skip
        trainings: list[TrainingResult] = []
        rates: list[float] = []
        total = robots * settings.episodes
        for first in range(0, robots, ROBOTS_PER_BATCH):
            before = first * settings.episodes
            batch = min(ROBOTS_PER_BATCH, robots - first)

            training = train(
                settings.method,
                range(settings.seed + first, settings.seed + first + batch),
                settings.episodes,
                task=settings.task(),
                hidden=settings.hidden,
                progress=report.part(before, total),
                **settings.hyperparameters(),
            )
            trainings += [training[k] for k in range(batch)]
            for policy, arrived in zip(
                training.policies, training.successes, strict=True
            ):
                rates += success_rates(
                    [policy],
                    worlds,
                    speed=settings.speed,
                    max_steps=settings.max_steps,
                    reflex=Reflex(settings.direction),
                )
                report(
                    before + batch * settings.episodes,
                    total,
                    at=len(rates),
                    last=100 * float(arrived[-100:].mean()),
                    maps=rates[-1],
                )
        self.trainings = trainings
        return sentence_on_rates(rates, TRIED)


def q_learning_lab(
    *open_groups: str,
    settings: QLearningSettings | None = None,
    presets: Sequence[Preset] = (),
) -> QLearningLab:
    """Make the lab.

    Parameters
    ----------
    *open_groups : {"reward", "exploration", "learning", "robot"}
        The groups of settings that are open at first.
    settings : QLearningSettings, optional
        The settings at first, to which the reader can return; by default the book's.
    presets : sequence of Preset
        Settings with which learning fails. ``settings`` corrects them, for the same maps and the same seed.

    Returns
    -------
    QLearningLab

    Raises
    ------
    ValueError
        If a name is not that of a group.

    Examples
    --------
    >>> from robonav.widgets.q_learning_lab import q_learning_lab
    >>> q_learning_lab("reward").data["open"]
    ['reward']
    """
    for group in open_groups:
        check_one_of("open_groups", group, GROUPS)
    settings = settings or QLearningSettings()
    book = check_instance("policy", method("nnql"), NetworkPolicy)
    return QLearningLab(
        data={
            "table": [
                {"before": row.before, "after": row.after, "condition": row.condition}
                for row in TABLE
            ],
            "open": list(open_groups),
            "first": settings.for_page(),
            "usual": QLearningSettings(direction=settings.direction).for_page(),
            "thesis": thesis_settings(settings).for_page(),
            "presets": [
                {
                    "name": preset.name,
                    "watch": preset.watch,
                    "cure": preset.cure,
                    "settings": preset.settings.for_page(),
                    "shows": preset.shows,
                }
                for preset in presets
            ],
            "trial": {
                "seed": MAPS_SEED,
                "numbers": list(MAPS),
                "temperatures": {
                    name: EVALUATION_TEMPERATURE[name] for name in METHODS
                },
                "book": page_policy(book),
            },
        }
    )


def thesis_settings(settings: QLearningSettings) -> QLearningSettings:
    """Return the thesis's hyperparameters, with the episodes and maps of other settings."""
    own: dict[str, Any] = dict(THESIS["nnql"])
    inputs = own.pop("target")
    for name in ("learning_rate", "gradient_step"):
        own[name] = (own[name], own[name])
    return replace(
        settings, inputs=inputs, **own | {"temperature": tuple(own["temperature"])}
    )
