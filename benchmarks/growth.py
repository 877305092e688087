"""How time and memory grow: with obstacles and worlds of the robot, seeds of Q-learning, states of a decision process.

python benchmarks/growth.py --json growth.json
"""

from __future__ import annotations

import argparse
import json
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from dp import grid

from robonav import atomic
from robonav.mdp import value_iteration
from robonav.nnql import train
from robonav.robot import navigate, random_worlds, straight

OBSTACLES = (0, 5, 10, 20, 40)
WORLDS = (1, 16, 256, 4096, 16384)
SEEDS = (1, 2, 4, 8, 16)
SIDES = (10, 32, 100, 316)  # of square grids: a hundred to a hundred thousand states
ROUNDS = 3
EPISODES = 100

Point = dict[str, float]


def measured(work: Callable[[], Any]) -> Point:
    """The least seconds of some rounds, and the peak memory of numpy in MiB."""
    seconds = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - began)
    tracemalloc.start()
    work()
    memory = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    return {"seconds": min(seconds), "MiB": memory}


def rollouts(worlds: int, obstacles: int) -> Callable[[], Any]:
    """A number of robots go straight on through their worlds."""
    drawn = random_worlds(worlds, obstacles, seed=0)
    return lambda: navigate(straight, drawn)


def planning(side: int) -> Callable[[], Any]:
    """Value iteration on a square grid."""
    mdp = grid(side, 0.95)
    return lambda: value_iteration(mdp)


def growth() -> dict[str, list[Point]]:
    """Sizes, with seconds and memory of each."""
    work: dict[str, dict[int, Callable[[], Any]]] = {
        "obstacles, 4096 worlds": {n: rollouts(4096, n) for n in OBSTACLES},
        "worlds, 20 obstacles": {n: rollouts(n, 20) for n in WORLDS},
        f"seeds of NNQL, {EPISODES} episodes": {
            n: lambda n=n: train("nnql", seeds=n, episodes=EPISODES) for n in SEEDS
        },
        "states, value iteration": {side * side: planning(side) for side in SIDES},
    }
    return {
        what: [{"size": size, **measured(one)} for size, one in sizes.items()]
        for what, sizes in work.items()
    }


def slope(points: list[Point]) -> float:
    """The exponent of the growth of seconds over the upper half of the sizes; 1 means in proportion."""
    upper = [point for point in points if point["size"] > 0][-3:]
    size, seconds = (
        np.log([point[key] for point in upper]) for key in ("size", "seconds")
    )
    return float(np.polyfit(size, seconds, 1)[0])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", type=Path, help="also write the points here")
    path = parser.parse_args().json
    train("nnql", seeds=1, episodes=2)  # compiled
    found = growth()
    for what, points in found.items():
        print(f"{what}: seconds grow with the power {slope(points):.2f}")
        for point in points:
            print(
                f"  {point['size']:>9,.0f}: {point['seconds'] * 1000:10,.1f} ms {point['MiB']:8.1f} MiB"
            )
    if path is not None:
        atomic.write_text(path, json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
