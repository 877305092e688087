"""What a reader sets for chapter 4's training, for Python's trainings and for the page's (``learning/nnql.js``)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.experiments.chapter4.ablations import EVADING, RawNumbers
from robonav.nnql import NavigationTask, double_dqn_targets, reward_row
from robonav.nnql.reward import REWARDS
from robonav.robot import NNQL_SENSORS, TARGET_ENCODINGS, Encoder, Reflex, Sensing
from robonav.robot.environment_settings import Reward
from robonav.validation import (
    check_array,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
)

METHODS = ("nnql", "online", "dqn")
INPUTS = (*TARGET_ENCODINGS, "raw")
"""What the network reads: an encoding of the target's sector, or the numbers of Eq. (4.5) as they are."""


@dataclass(frozen=True)
class QLearningSettings:
    """One training by NNQL, by its online form, or by double DQN.

    DQN takes the start of ``gradient_step`` for the step of Adam, and needs none of ``learning_rate``, ``rescale``,
    ``passes`` and ``tolerance``.

    Parameters
    ----------
    method : {"nnql", "online", "dqn"}
        The method.
    rewards : tuple of 13 floats
        The reward of each row of Table 4.1.
    must_move_away : bool
        Whether staying away is rewarded only if the nearest thing is farther away than before.
    obstacles, moving, speed, max_steps
        See :class:`robonav.nnql.NavigationTask`.
    direction : {"sector", "exact"}
        What the robot's reflex knows of the direction of its target, see :class:`robonav.robot.Reflex`.
    inputs : {"number", "signed", "one-hot", "sine-cosine", "raw"}
        How the target's sector is encoded, or raw numbers.
    hidden : int
        Units of the hidden layer.
    episodes, learning_rate, discount, gradient_step, temperature, rescale, passes, tolerance, seed
        See :func:`robonav.nnql.nnql`; schedules are pairs.

    Examples
    --------
    >>> from robonav.widgets.q_learning_settings import QLearningSettings
    >>> settings = QLearningSettings(obstacles=20, discount=0.7)
    >>> settings.task().obstacles, settings.hyperparameters()["discount"]
    (20, 0.7)
    """

    method: str = "nnql"
    rewards: tuple[float, ...] = tuple(REWARDS.tolist())
    must_move_away: bool = False
    obstacles: int = 10
    moving: int = 0
    speed: float = 2.5
    max_steps: int = 400
    direction: str = Reflex().direction
    inputs: str = "number"
    hidden: int = 8
    episodes: int = 300
    learning_rate: tuple[float, float] = (0.8, 0.1)
    discount: float = 0.6
    gradient_step: tuple[float, float] = (0.3, 0.05)
    temperature: tuple[float, float] = (0.9, 0.1)
    rescale: str = "shift"
    passes: int = 3
    tolerance: float = 1e-3
    seed: int = 0

    def __post_init__(self) -> None:
        check_one_of("method", self.method, METHODS)
        check_one_of("inputs", self.inputs, INPUTS)
        check_one_of("rescale", self.rescale, ("shift", "clip"))
        Reflex(self.direction)  # which checks it
        check_array("rewards", self.rewards, shape=(len(REWARDS),))
        for name in ("hidden", "episodes", "max_steps", "passes"):
            check_integer(name, getattr(self, name), at_least=1)
        for name in ("obstacles", "moving", "seed"):
            check_integer(name, getattr(self, name), at_least=0)
        check_positive("speed", self.speed)
        check_real("discount", self.discount, at_least=0, at_most=1)
        check_real("tolerance", self.tolerance, at_least=0)
        for name in ("learning_rate", "gradient_step", "temperature"):
            check_array(name, getattr(self, name), shape=(2,))

    def encoder(self) -> Encoder:
        """What the network reads."""
        if self.inputs == "raw":
            return RawNumbers()
        return Encoder(NNQL_SENSORS, walls=True, target=self.inputs)

    def reward(self) -> Reward:
        """The reward of a step."""
        rewards = np.array(self.rewards)

        def reward(
            before: Sensing, after: Sensing, outcome: NDArray[np.int8]
        ) -> NDArray[np.float64]:
            """The reward of a step of N robots."""
            row = reward_row(before, after, outcome)
            farther = after.ranges.min(axis=1) > before.ranges.min(axis=1)
            unpaid = self.must_move_away & np.isin(row, EVADING) & ~farther
            return np.where(unpaid, 0.0, rewards[row])

        return reward

    def task(self) -> NavigationTask:
        """The task that Python trains on."""
        return NavigationTask(
            self.obstacles,
            self.moving,
            self.speed,
            self.max_steps,
            encoder=self.encoder(),
            reward=self.reward(),
            reflex=Reflex(self.direction),
        )

    def hyperparameters(self) -> dict[str, Any]:
        """The keyword arguments of the method's readable function, without episodes and seed."""
        if self.method == "dqn":
            return {
                "discount": self.discount,
                "gradient_step": self.gradient_step[0],
                "temperature": self.temperature,
                "targets": double_dqn_targets,
            }
        names = (
            "learning_rate",
            "discount",
            "gradient_step",
            "temperature",
            "rescale",
            "passes",
            "tolerance",
        )
        return {name: getattr(self, name) for name in names}

    def for_page(self) -> dict[str, Any]:
        """The settings under the names that JavaScript has for them."""
        return {_camel(f.name): getattr(self, f.name) for f in fields(self)}

    @classmethod
    def from_page(cls, settings: Mapping[str, Any]) -> QLearningSettings:
        """The settings that a page sent.

        Raises
        ------
        TypeError, ValueError
            If one is missing or out of bounds.
        """
        values = {f.name: settings[_camel(f.name)] for f in fields(cls)}
        pairs = {k: tuple(v) for k, v in values.items() if isinstance(v, list)}
        return cls(**(values | pairs))


def _camel(name: str) -> str:
    """The JavaScript name of a Python name."""
    first, *rest = name.split("_")
    return first + "".join(part.capitalize() for part in rest)
