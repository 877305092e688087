"""The conditions that all experiments of a chapter share: worlds to test and to tune in, speed, navigations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from robonav.benchmark.evaluation import outcome_rates
from robonav.robot import Policy, Worlds, navigate, random_worlds


@dataclass(frozen=True, eq=False)
class Setup:
    """How policies of a chapter are tested.

    Parameters
    ----------
    obstacles : int
        The number of standing obstacles.
    speed : float
        Metres a second.
    max_steps : int
        An episode that takes longer has failed.
    navigations : mapping
        The number of worlds that a run is tested in, by scale.
    test_seed : int
        Run k is tested in the worlds of this seed + k.
    tuning_seed : int
        Worlds for tuning have this seed + k. They never meet those for testing.
    ends : mapping
        Starts and targets of the worlds, where they are not the usual ones.
    """

    obstacles: int
    speed: float
    max_steps: int
    navigations: Mapping[str, int]
    test_seed: int
    tuning_seed: int
    ends: Mapping[str, Sequence[tuple[float, float]]] = field(default_factory=dict)

    def worlds(
        self, n: int, seed: int, obstacles: int | None = None, moving: int = 0
    ) -> Worlds:
        """Random worlds with the chapter's obstacles, starts and targets."""
        standing = self.obstacles if obstacles is None else obstacles
        ends: dict[str, Any] = dict(self.ends)
        return random_worlds(n, standing, moving, seed=seed, **ends)

    def test_worlds(
        self, seed: int, scale: str, obstacles: int | None = None, moving: int = 0
    ) -> Worlds:
        """The worlds that run ``seed`` is tested in."""
        n = self.navigations[scale]
        return self.worlds(n, self.test_seed + seed, obstacles, moving)

    def tuning_worlds(self, seed: int, n: int) -> Worlds:
        """Worlds to tune in or to choose by."""
        return self.worlds(n, self.tuning_seed + seed)

    def evaluate(
        self, policy: Policy, worlds: Worlds, speed: float | None = None
    ) -> dict[str, float]:
        """Outcome rates of a policy, one episode in each world, in per cent."""
        at = self.speed if speed is None else speed
        return outcome_rates(navigate(policy, worlds, at, self.max_steps))
