"""The conditions that all experiments of a chapter share: worlds for tests and tuning, speed, navigations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from robonav.benchmark.evaluation import outcome_rates
from robonav.robot import (
    Policy,
    PolicyWithMemory,
    Reflex,
    Worlds,
    navigate,
    random_worlds,
)


@dataclass(frozen=True, eq=False)
class Setup:
    """The conditions under which the policies of a chapter are tested.

    Parameters
    ----------
    obstacles : int
        The number of standing obstacles.
    speed : float
        Metres per second.
    max_steps : int
        The largest number of steps. A longer episode has failed.
    navigations : mapping
        The number of worlds in which a run is tested, by scale.
    test_seed : int
        Run k is tested in the worlds of the seed ``test_seed`` + k.
    tuning_seed : int
        Worlds for tuning have the seed ``tuning_seed`` + k. They differ from all worlds for tests.
    direction : {"exact", "sector"}
        What the robot's reflex knows of the direction of its target, in training and in tests.
    ends : mapping
        The starts and targets of the worlds; by default the usual ones.
    """

    obstacles: int
    speed: float
    max_steps: int
    navigations: Mapping[str, int]
    test_seed: int
    tuning_seed: int
    direction: str
    ends: Mapping[str, Sequence[tuple[float, float]]] = field(default_factory=dict)

    @property
    def reflex(self) -> Reflex:
        """The reflex of all robots of the chapter."""
        return Reflex(self.direction)

    def worlds(
        self, n: int, seed: int, obstacles: int | None = None, moving: int = 0
    ) -> Worlds:
        """Return random worlds with the chapter's obstacles, starts and targets."""
        standing = self.obstacles if obstacles is None else obstacles
        ends: dict[str, Any] = dict(self.ends)
        return random_worlds(n, standing, moving, seed=seed, **ends)

    def test_worlds(
        self, seed: int, scale: str, obstacles: int | None = None, moving: int = 0
    ) -> Worlds:
        """Return the worlds in which run ``seed`` is tested."""
        n = self.navigations[scale]
        return self.worlds(n, self.test_seed + seed, obstacles, moving)

    def tuning_worlds(self, seed: int, n: int) -> Worlds:
        """Return worlds for tuning, or for choosing among policies."""
        return self.worlds(n, self.tuning_seed + seed)

    def evaluate(
        self,
        policy: Policy | PolicyWithMemory,
        worlds: Worlds,
        speed: float | None = None,
    ) -> dict[str, float]:
        """Return the outcome rates of a policy in per cent, from one episode in each world."""
        at = self.speed if speed is None else speed
        return outcome_rates(
            navigate(policy, worlds, at, self.max_steps, reflex=self.reflex)
        )
