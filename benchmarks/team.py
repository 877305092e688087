"""How fast several robots on one map go: robot steps a second, beside those of robots that are each alone.

    python benchmarks/team.py

Robots that are alone take turns with teams in the same run, so that the ratio says what seeing each other costs.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np
from timing import in_turn

from robonav.robot import Simulator, navigate, random_worlds, turn_to_clearer_side
from robonav.robot.team import TeamSimulator, navigate_team, random_teams

ROBOTS, SECONDS, ROUNDS = 8192, 10, 9
LEAST = 1_000_000  # robot steps a second with 16 robots a map

Measure = Callable[[], float]


def stepping(begin: Callable[[], Simulator]) -> Measure:
    """Robot steps a second of the simulator alone, with random actions, from the start on."""
    rng = np.random.default_rng(0)
    actions = [rng.integers(0, 5, ROBOTS) for _ in range(SECONDS)]

    def measure() -> float:
        simulator = begin()
        start = time.perf_counter()
        for action in actions:
            simulator.second(action)
        passed = time.perf_counter() - start
        return int(simulator.steps.sum()) / passed

    measure()
    return measure


def driving(drive: Callable[[], int]) -> Measure:
    """Robot steps a second of whole episodes; ``drive`` returns the sum of the steps."""

    def measure() -> float:
        start = time.perf_counter()
        steps = drive()
        return steps / (time.perf_counter() - start)

    measure()
    return measure


def main() -> None:
    worlds = random_worlds(ROBOTS, 10, seed=1)
    alone = stepping(partial(Simulator, worlds))
    for number in (1, 2, 4, 8, 16):
        teams = random_teams(ROBOTS // number, number, 10, seed=1)
        together = stepping(partial(TeamSimulator, teams))
        ours, one, ratio = in_turn(together, alone, ROUNDS)
        limit = f" (at least {LEAST:,} steps/s)" if number == 16 else ""
        print(
            f"{number} robots a map: {ours:,.0f} robot steps/s; alone {one:,.0f}; ratio {ratio:.2f}{limit}"
        )
    teams = random_teams(ROBOTS // 16, 16, 10, seed=1)
    ours, one, ratio = in_turn(
        driving(lambda: navigate_team(turn_to_clearer_side, teams).steps.sum()),
        driving(lambda: navigate(turn_to_clearer_side, worlds).steps.sum()),
        ROUNDS,
    )
    print(
        f"16 robots a map, whole episodes of a rule: {ours:,.0f} robot steps/s; alone {one:,.0f}; ratio {ratio:.2f}"
    )


if __name__ == "__main__":
    main()
