"""How fast neural Q-learning trains: seconds a training, and learning steps a second beside stable-baselines3's DQN.

    python benchmarks/nnql.py                  # seconds
    python benchmarks/nnql.py --peers DIR      # and DQN with an update a step (see benchmarks/peers/README.md)

A learning step is a state in which the network is updated; the robot's other steps, which its reflexes decide, are not
counted. Figures are medians of rounds, robonav and peer in turn; ``--cpu`` counts seconds of the processor, for a
machine that others use too.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

from peer_process import add_processor_clock, parser_with_peers, printed_by_peer

from robonav.nnql import train

EPISODES, ROUNDS = 300, 3
LIMITS = {
    1: (5, 3),
    16: (15, 20),
}  # seeds: seconds at most, and times the peer's rate at least


def training(seeds: int, clock: Callable[[], float]) -> tuple[float, float]:
    """Seconds of a training, and its learning steps a second."""
    began = clock()
    result = train("nnql", seeds=seeds, episodes=EPISODES)
    spent = clock() - began
    return spent, result.decisions.sum() / spent


def peer(folder: Path, *options: str) -> float:
    """Updates a second of stable-baselines3's DQN, in its own environment."""
    return printed_by_peer(folder, "v1", "sb3_dqn.py", *options)


def main() -> None:
    parser = parser_with_peers(__doc__)
    add_processor_clock(parser)
    options = parser.parse_args()
    clock = time.process_time if options.cpu else time.perf_counter
    extra = ["--cpu"] if options.cpu else []
    train("nnql", seeds=1, episodes=5)  # compiled
    slow = False
    for seeds, (most, times) in LIMITS.items():
        rounds = [
            (
                *training(seeds, clock),
                peer(options.peers, *extra) if options.peers else 0.0,
            )
            for _ in range(ROUNDS)
        ]
        spent, rate = (
            statistics.median(column) for column in list(zip(*rounds, strict=True))[:2]
        )
        print(
            f"{seeds} seeds x {EPISODES} episodes: {spent:.1f} s (at most {most} s), {rate:,.0f} learning steps/s"
        )
        slow |= spent > most
        if options.peers:
            theirs = statistics.median(row[2] for row in rounds)
            ratio = statistics.median(row[1] / row[2] for row in rounds)
            print(
                f"   stable-baselines3 DQN: {theirs:,.0f} updates/s; ratio {ratio:.1f} (at least {times})"
            )
            slow |= ratio < times
    sys.exit(1 if slow else 0)


if __name__ == "__main__":
    main()
