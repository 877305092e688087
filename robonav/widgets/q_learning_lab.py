"""Q-learning lab: a robot learns from the reader's own reward, in the page or, with a kernel, in Python."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import anywidget
import traitlets

from robonav.benchmark.policies import method
from robonav.experiments import bootstrap_interval
from robonav.experiments.chapter4.setup import EVALUATION_TEMPERATURE, THESIS
from robonav.networks import NetworkPolicy
from robonav.nnql import STARTS, TARGETS, TrainingResult, train
from robonav.nnql.reward import TABLE
from robonav.progress import Progress
from robonav.robot import navigate, random_worlds
from robonav.validation import check_instance, check_integer, check_one_of

from .q_learning_settings import METHODS, QLearningSettings
from .shared import front_end, style_sheet
from .simulator import page_policy

GROUPS = ("reward", "exploration", "learning", "robot")
MAPS = (100, 200)
EPISODES_A_MESSAGE = 10
TOGETHER = 4
"""Robots that the kernel trains at once; the page hears of them together."""

TRIED = 400
"""Maps that each robot is tried in which the kernel trains."""

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

    Examples
    --------
    >>> from robonav.widgets.q_learning_lab import Preset
    >>> from robonav.widgets.q_learning_settings import QLearningSettings
    >>> cold = QLearningSettings(temperature=(0.03, 0.03))
    >>> Preset("cold", "It hardly explores.", "The temperature falls.", cold).name
    'cold'
    """

    name: str
    watch: str
    cure: str
    settings: QLearningSettings


class Cancelled(Exception):
    """Raised when the reader has cancelled a training."""


class QLearningLab(anywidget.AnyWidget):
    """Set reward, exploration and learning; train, watch, cancel; drive new maps; compare; download the weights.

    Attributes
    ----------
    trainings : list of TrainingResult
        The last trainings in the kernel, one for each robot. Trainings in the page stay there.
    """

    _esm = front_end(
        "simulator",
        "maps",
        "files",
        "learning/random",
        "learning/network",
        "learning/worlds",
        "learning/nnql",
        "learning/dqn",
        "learning/worker",
        "learning/training_panel",
        "q_learning_lab",
    )
    _css = style_sheet("maps", "learning/training_panel", "q_learning_lab")
    data = traitlets.Dict().tag(sync=True)

    def __init__(self, data: dict[str, Any]) -> None:
        super().__init__(data=data)
        self.trainings: list[TrainingResult] = []
        self._cancelled = threading.Event()
        self._thread: threading.Thread | None = None
        self.on_msg(self._answer)

    def _answer(self, _widget: Any, message: dict[str, Any], _buffers: Any) -> None:
        """Answer the page, which asks whether a kernel is there, for a training, or for its end."""
        asked = message.get("ask")
        if asked == "kernel":
            self.send({"kernel": True})
        elif asked == "cancel":
            self._cancelled.set()
        elif asked == "train":
            self._cancelled.set()  # a training that still runs
            if self._thread is not None:
                self._thread.join()
            self._cancelled.clear()
            self._thread = threading.Thread(
                target=self._run, args=(message,), daemon=True
            )
            self._thread.start()  # apart, so that a cancellation is heard

    def _run(self, message: dict[str, Any]) -> None:
        """Train the robots of a request, and send each of them to the page."""
        run = {"run": message["run"]}
        try:
            settings = QLearningSettings.from_page(message["settings"])
            robots = check_integer("robots", message["robots"], at_least=1)
            self.send(run | {"ended": self._train(settings, robots, run)})
        except Cancelled:
            pass  # the page knows
        except Exception as error:
            self.send(run | {"error": f"{type(error).__name__}: {error}"})

    def _train(
        self, settings: QLearningSettings, robots: int, run: dict[str, Any]
    ) -> str:
        """Train robots one after the other, and return a sentence with their results."""
        worlds = random_worlds(
            TRIED, settings.obstacles, settings.moving, seed=MAPS_SEED, starts=STARTS, targets=TARGETS,
        )  # fmt: skip
        self.trainings, rates = [], []
        total = robots * settings.episodes
        for first in range(0, robots, TOGETHER):
            before = first * settings.episodes
            seeds = range(
                settings.seed + first, settings.seed + min(first + TOGETHER, robots)
            )
            training = train(
                settings.method,
                seeds,
                settings.episodes,
                task=settings.task(),
                hidden=settings.hidden,
                progress=self._teller(run, before, total),
                **settings.hyperparameters(),
            )
            self.trainings += [training[k] for k in range(len(seeds))]
            for policy, arrived in zip(
                training.policies, training.successes, strict=True
            ):
                drives = navigate(policy, worlds, settings.speed, settings.max_steps)
                rates.append(100 * float(drives.success.mean()))
                last = 100 * float(arrived[-100:].mean())
                live = {"at": len(rates), "last": last, "maps": rates[-1]}
                done = before + len(seeds) * settings.episodes
                self.send(run | {"done": done, "total": total, "live": live})
        mean = sum(rates) / robots
        if robots == 1:
            return f"One robot crosses {mean:.1f} % of {TRIED} new maps."
        low, high = bootstrap_interval(rates)
        return (
            f"{robots} robots cross {mean:.1f} % of {TRIED} new maps on average, "
            f"95 % interval {low:.1f} to {high:.1f}; the worst {min(rates):.1f} %."
        )

    def _teller(self, run: dict[str, Any], before: int, of_all: int) -> Progress:
        """A callback that tells the page now and then how many episodes are done, and ends a cancelled training."""
        told = 0

        def progress(done: int, total: int) -> None:
            nonlocal told
            if self._cancelled.is_set():
                raise Cancelled
            if done >= told + EPISODES_A_MESSAGE:
                told = done
                self.send(run | {"done": before + done, "total": of_all})

        return progress


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
        Settings with which learning fails. ``settings`` corrects them.

    Returns
    -------
    QLearningLab

    Raises
    ------
    ValueError
        If there is no group of such a name.

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
            "thesis": thesis_settings(settings).for_page(),
            "presets": [
                {
                    "name": preset.name,
                    "watch": preset.watch,
                    "cure": preset.cure,
                    "settings": preset.settings.for_page(),
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
