"""How fast learning from demonstration is: a training, a whole study from nothing, a plan.

    python benchmarks/lfd.py          # seconds on the clock
    python benchmarks/lfd.py --cpu    # seconds of the processor, for a machine that others use too

The thesis has 10.64 s for 300 iterations and 23.2 s for a plan, in Matlab, on a machine of its time. Figures are
medians of rounds; loading and compiling are not counted. Ends with 1 if one of them is over its limit.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable

from robonav.lfd import demonstrate, labelled_states, learn_policy, plan
from robonav.networks import fit
from robonav.robot import Encoder, navigate, random_worlds

ROUNDS, PLANS = 5, 200
SEED = 5

Clock = Callable[[], float]


def training(clock: Clock) -> float:
    """Seconds of 300 iterations on 25 demonstrations, in the thesis's setting."""
    x, y = labelled_states(
        demonstrate(random_worlds(25, seed=SEED)), Encoder(target="number")
    )
    began = clock()
    fit(x, y, iterations=300)
    return clock() - began


def study(clock: Clock) -> float:
    """Seconds of a whole study: 25 demonstrations planned, a policy learned, 500 maps driven."""
    began = clock()
    policy = learn_policy(demonstrate(random_worlds(25, seed=SEED)))
    navigate(policy, random_worlds(500, seed=SEED + 1))
    return clock() - began


def planning(clock: Clock) -> float:
    """Median seconds of a plan by modified A* among 10 obstacles."""
    spent = []
    for world in random_worlds(PLANS, 10, seed=SEED):
        began = clock()
        plan(world)
        spent.append(clock() - began)
    return statistics.median(spent)


LIMITS: dict[str, tuple[Callable[[Clock], float], float]] = {
    "300 iterations": (training, 0.5),
    "25 demonstrations planned and learned from, 500 maps driven": (study, 5.0),
    "modified A*, 10 obstacles, median": (planning, 0.010),
}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--cpu", action="store_true", help="count seconds of the processor"
    )
    clock = time.process_time if parser.parse_args().cpu else time.perf_counter
    study(clock)  # loaded and compiled
    slow = False
    for what, (measured, most) in LIMITS.items():
        spent = statistics.median(measured(clock) for _ in range(ROUNDS))
        print(f"{what}: {1000 * spent:.4g} ms (at most {1000 * most:g} ms)")
        slow |= spent > most
    sys.exit(slow)


if __name__ == "__main__":
    main()
