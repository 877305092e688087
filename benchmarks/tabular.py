"""Q-learning's cost: 500,000 steps of FrozenLake, learned from and merely taken.

usage: python benchmarks/tabular.py [--steps 500000] [--repeats 3]

The bare loop takes random actions and does nothing else, so it costs what the environment costs. Random actions in both
(epsilon 1), so that both see episodes of the same length; the best of some repeats, taken in turns.
"""

from __future__ import annotations

import argparse
import time

import gymnasium as gym
import numpy as np

from robonav import mdp

LIMIT = 3.0


def bare(env: gym.Env, steps: int) -> float:
    """Seconds for taking ``steps`` random actions."""
    actions = np.random.default_rng(0).integers(4, size=steps).tolist()
    env.reset(seed=0)
    start = time.perf_counter()
    for action in actions:
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            env.reset()
    return time.perf_counter() - start


def learning(env: gym.Env, steps: int, epsilon: float) -> float:
    """Seconds a step while Q-learning takes about ``steps``, times ``steps``."""
    episodes = steps // 8 if epsilon == 1 else steps // 30
    start = time.perf_counter()
    learned = mdp.q_learning(env, episodes, learning_rate=0.1, epsilon=epsilon, seed=0)
    return (time.perf_counter() - start) / learned.lengths.sum() * steps


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=500_000)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    env = gym.make("FrozenLake-v1")
    timings = np.array(
        [
            (
                bare(env, options.steps),
                learning(env, options.steps, 1.0),
                learning(env, options.steps, 0.1),
            )
            for _ in range(options.repeats)
        ]
    )
    loop, blind, greedy = timings.min(axis=0)
    print(f"{options.steps} steps of FrozenLake-v1, best of {options.repeats}")
    print(f"bare loop                   {loop:6.2f} s")
    print(f"Q-learning, random actions  {blind:6.2f} s   ratio {blind / loop:.2f}")
    print(
        f"Q-learning, epsilon 0.1     {greedy:6.2f} s   ratio {greedy / loop:.2f}   (limit {LIMIT})"
    )
    if max(blind, greedy) / loop > LIMIT:
        raise SystemExit("Q-learning takes more than its limit")


if __name__ == "__main__":
    main()
