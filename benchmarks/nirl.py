"""How fast neural inverse reinforcement learning learns: seconds a run, from demonstrations to a policy and its reward.

    python benchmarks/nirl.py          # at most 10 s for a run of the thesis's size, 2 s for one of a slider's
    python benchmarks/nirl.py --cpu    # seconds of the processor, for a machine that others use too

Figures are medians of rounds. The demonstrations are made beforehand. The four methods take turns in each round, in
seconds of the processor; what the others take is given relative to NIRL.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable

from robonav.lfd import Demonstrations, demonstrate
from robonav.nirl import METHODS, learn
from robonav.robot import random_worlds

ROUNDS = 3
LIMITS = {
    "thesis": (30, 140, 10.0),
    "slider": (10, 30, 2.0),
}  # demonstrations, iterations, seconds at most


def run(
    shown: Demonstrations,
    iterations: int,
    clock: Callable[[], float],
    method: str = "nirl",
) -> float:
    """Seconds of one run."""
    began = clock()
    learn(shown, method, iterations=iterations, seed=0)
    return clock() - began


def beside_nirl(shown: Demonstrations) -> dict[str, float]:
    """Return the time of each other method of Table 5.2 relative to that of NIRL, for as many iterations."""
    for method in METHODS:
        run(shown, 14, time.process_time, method)  # compiled
    rounds = [
        {method: run(shown, 140, time.process_time, method) for method in METHODS}
        for _ in range(ROUNDS)
    ]
    return {
        method: statistics.median(spent[method] / spent["nirl"] for spent in rounds)
        for method in METHODS
        if method != "nirl"
    }


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--cpu", action="store_true", help="count seconds of the processor"
    )
    clock = time.process_time if parser.parse_args().cpu else time.perf_counter
    shown = demonstrate(random_worlds(30, 20, seed=0))
    learn(shown, iterations=1)  # compiled
    slow = False
    for size, (demonstrations, iterations, most) in LIMITS.items():
        some = shown.select_trajectories(range(demonstrations))
        spent = statistics.median(run(some, iterations, clock) for _ in range(ROUNDS))
        print(
            f"{size}: {demonstrations} demonstrations, {iterations} iterations: {spent:.2f} s (at most {most:g} s)"
        )
        slow |= spent > most
    for method, ratio in beside_nirl(shown).items():
        print(f"{method}, as many iterations: {ratio:.2f} times the time of nirl")
    sys.exit(slow)


if __name__ == "__main__":
    main()
