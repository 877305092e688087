"""How long each method takes to decide: microseconds a decision, for one robot and for a thousand at once.

python benchmarks/decisions.py
"""

from __future__ import annotations

import argparse
import statistics
import time

import numpy as np

from robonav.benchmark.policies import method, methods
from robonav.lfd import plan
from robonav.robot import Policy, Sensing, random_worlds, sense

ROBOTS, ROUNDS, SECONDS = 1000, 5, 0.1


def microseconds(policy: Policy, sensing: Sensing) -> float:
    """Median over rounds of the time for one robot's decision."""
    rng, rounds = np.random.default_rng(0), []
    for _ in range(ROUNDS):
        calls, began = 0, time.perf_counter()
        while (passed := time.perf_counter() - began) < SECONDS:
            policy(sensing, rng)
            calls += 1
        rounds.append(1e6 * passed / calls / len(sensing))
    return statistics.median(rounds)


def main() -> None:
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    worlds = random_worlds(ROBOTS, 20, seed=0)
    places = np.random.default_rng(0).uniform([20, 20, -3], [80, 80, 3], (ROBOTS, 3))
    sensing = sense(worlds, places)
    for name in methods():
        alone, together = (
            microseconds(method(name), sensing[:robots]) for robots in (1, ROBOTS)
        )
        print(f"{name:18} {alone:7.1f} us alone, {together:6.2f} us among {ROBOTS}")
    began = time.perf_counter()
    for i in range(50):
        plan(worlds[i])
    print(
        f"for comparison, one plan of modified A*: {1e6 * (time.perf_counter() - began) / 50:,.0f} us"
    )


if __name__ == "__main__":
    main()
