"""How fast several robots on one map go: robot steps a second, beside those of robots that are each alone.

    python benchmarks/team.py

Robots that are alone take turns with teams in the same run, so that the ratio says what seeing each other costs.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np

from robonav.robot import Simulator, navigate, random_worlds, turn_to_clearer_side
from robonav.robot.team import TeamSimulator, navigate_team, random_teams

ROBOTS, SECONDS, ROUNDS = 8192, 10, 9
LEAST = 1_000_000  # robot steps a second with 16 robots a map

Measure = Callable[[], tuple[int, float]]


def stepping(begin: Callable[[], Simulator]) -> Measure:
    """Robot steps and seconds of the simulator alone, with random actions, from the start on."""
    rng = np.random.default_rng(0)
    actions = [rng.integers(0, 5, ROBOTS) for _ in range(SECONDS)]

    def measure() -> tuple[int, float]:
        simulator = begin()
        start = time.perf_counter()
        for action in actions:
            simulator.second(action)
        passed = time.perf_counter() - start
        return int(simulator.steps.sum()), passed

    measure()
    return measure


def driving(drive: Callable[[], int]) -> Measure:
    """Robot steps and seconds of whole episodes: the sum of the steps that ``drive`` returns, and how long it takes."""

    def measure() -> tuple[int, float]:
        start = time.perf_counter()
        steps = drive()
        return steps, time.perf_counter() - start

    measure()
    return measure


def in_turn(team: Measure, alone: Measure) -> tuple[float, float, float]:
    """Medians of the steps a second of both, and of their ratio, round by round."""
    rounds = []
    for _ in range(ROUNDS):
        rounds.append([steps / passed for steps, passed in (team(), alone())])
    return (
        statistics.median(a for a, _ in rounds),
        statistics.median(b for _, b in rounds),
        statistics.median(a / b for a, b in rounds),
    )


def main() -> None:
    worlds = random_worlds(ROBOTS, 10, seed=1)
    alone = stepping(lambda: Simulator(worlds))
    for number in (1, 2, 4, 8, 16):
        teams = random_teams(ROBOTS // number, number, 10, seed=1)
        ours, one, ratio = in_turn(stepping(lambda t=teams: TeamSimulator(t)), alone)  # type: ignore[misc]
        limit = f" (at least {LEAST:,} steps/s)" if number == 16 else ""
        print(
            f"{number} robots a map: {ours:,.0f} robot steps/s; alone {one:,.0f}; ratio {ratio:.2f}{limit}"
        )
    teams = random_teams(ROBOTS // 16, 16, 10, seed=1)
    ours, one, ratio = in_turn(
        driving(lambda: navigate_team(turn_to_clearer_side, teams).steps.sum()),
        driving(lambda: navigate(turn_to_clearer_side, worlds).steps.sum()),
    )
    print(
        f"16 robots a map, whole episodes of a rule: {ours:,.0f} robot steps/s; alone {one:,.0f}; ratio {ratio:.2f}"
    )


if __name__ == "__main__":
    main()
