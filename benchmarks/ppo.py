"""How fast PPO trains robots: seconds until sixteen seeds arrive in 95 % of new worlds, and steps a second; and the
seconds of the training on the page on deep reinforcement learning.

    python benchmarks/ppo.py                   # seconds
    python benchmarks/ppo.py --peers DIR       # and stable-baselines3's PPO (see benchmarks/peers/README.md)

Each seed is tested with 10 obstacles in 500 worlds in which nothing was trained or tuned; the seed with the least
success counts. The peer has the same network, numbers of actors, steps, epochs and minibatches, on CartPole; a step is
one of one actor, learning included. ``--cpu`` counts seconds of the processor, for a machine that others use too.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from peer_process import add_processor_clock, parser_with_peers, printed_by_peer

from robonav.deep import train_ppo
from robonav.experiments.chapter6.ppo import TRAINING, task
from robonav.robot import navigate, random_worlds

SEEDS, WORLDS, WORLD_SEED = 16, 500, 95_000
SECONDS, SUCCESS = 60, 95
PAGE_SECONDS = 10


def peer(folder: Path, *options: str) -> float:
    """Steps a second of stable-baselines3's PPO, in its own environment."""
    return printed_by_peer(folder, "v1", "sb3_ppo.py", *options)


def main() -> None:
    parser = parser_with_peers(__doc__)
    add_processor_clock(parser)
    options = parser.parse_args()
    clock = time.process_time if options.cpu else time.perf_counter
    train_ppo(1, 1, actors=2, steps=4)  # compiled
    began = clock()
    result = train_ppo(SEEDS)
    spent = clock() - began
    worlds = random_worlds(WORLDS, obstacles=10, seed=WORLD_SEED)
    success = [
        100 * navigate(policy, worlds, seed=0).success.mean()
        for policy in result.policies
    ]
    settings = result.settings
    steps = SEEDS * settings["updates"] * settings["actors"] * settings["steps"]
    print(
        f"{SEEDS} seeds: {spent:.1f} s (at most {SECONDS} s), {steps:,} steps, {steps / spent:,.0f} steps/s"
    )
    print(
        f"success with 10 obstacles: {min(success):.1f} to {max(success):.1f} % (at least {SUCCESS} %), "
        f"mean {np.mean(success):.1f} %"
    )
    began = clock()
    train_ppo(SEEDS, task=task(), **TRAINING)
    on_page = clock() - began
    print(
        f"the page's training of {SEEDS} seeds: {on_page:.1f} s (at most {PAGE_SECONDS} s)"
    )
    if options.peers:
        theirs = peer(options.peers, *(["--cpu"] if options.cpu else []))
        print(
            f"   stable-baselines3 PPO: {theirs:,.0f} steps/s; ratio {steps / spent / theirs:.1f}"
        )
    met = spent <= SECONDS and min(success) >= SUCCESS and on_page <= PAGE_SECONDS
    sys.exit(0 if met else 1)


if __name__ == "__main__":
    main()
