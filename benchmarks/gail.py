"""GAIL on CartPole, beside the library imitation: returns and steps a second, from the same demonstrations.

    python benchmarks/gail.py                  # ours
    python benchmarks/gail.py --peers DIR      # and imitation's GAIL (see benchmarks/peers/README.md)

The expert is a rule: push to the right if a sum of the four numbers of the state is positive. Ten of its episodes are
the demonstrations. Both programs have networks of one size, and equal numbers of actors, steps, epochs and minibatches
and steps of Adam; all else is the default of each. A score is the mean return of 20 new episodes, whose greatest is
500. The control earns 1 in each step, whatever the discriminator says. ``--cpu`` counts seconds of the processor, for a
machine that others use too, and ``--json FILE`` writes what was measured.
"""

from __future__ import annotations

import json
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import gymnasium
import numpy as np
from numpy.typing import NDArray
from peer_process import add_processor_clock, lines_of_peer, parser_with_peers

from robonav import atomic
from robonav.deep import actor_critic, constant_reward, gail, random_discriminator
from robonav.deep.gail import Reward, deceiving_reward

TASK = "CartPole-v1"
RULE = np.array([0.1, 0.3, 3.0, 1.0])
"""Weights of the cart's position and speed, and of the pole's angle and its speed."""

DEMONSTRATIONS, EPISODES = 10, 20
SEEDS, ACTORS, STEPS, UPDATES = (0, 1, 2), 8, 128, 40
Act = Callable[[NDArray[np.float64]], int]


def expert(state: NDArray[np.float64]) -> int:
    """The action of the rule."""
    return int(state @ RULE > 0)


def episode(
    env: gymnasium.Env, act: Act, seed: int
) -> list[tuple[NDArray[np.float64], int]]:
    """States and actions of one episode."""
    state, _ = env.reset(seed=seed)
    made, ended = [], False
    while not ended:
        made.append((state, act(state)))
        state, _, terminated, truncated, _ = env.step(made[-1][1])
        ended = terminated or truncated
    return made


def score(act: Act) -> float:
    """Mean return in new episodes: each step earns 1."""
    env = gymnasium.make(TASK)
    return float(
        np.mean([len(episode(env, act, 1000 + number)) for number in range(EPISODES)])
    )


def trained(
    states: NDArray[np.float64], actions: NDArray[np.int64], reward: Reward, seed: int
) -> Act:
    """The policy of one training, which takes the most probable action."""
    envs = [gymnasium.make(TASK) for _ in range(ACTORS)]
    judge = random_discriminator(envs[0], seed=seed)
    networks = gail(
        envs, actor_critic(envs[0], seed=seed), judge, states, actions,
        updates=UPDATES, steps=STEPS, reward=reward, seed=seed,
    )  # fmt: skip
    return lambda state: int(networks.policy.logits(state[None]).argmax())


def beside(
    folder: Path, states: NDArray[np.float64], actions: NDArray[np.int64], *more: str
) -> tuple[list[float], float]:
    """Scores and steps a second of imitation's GAIL."""
    with tempfile.TemporaryDirectory() as shared:
        path = Path(shared, "demonstrations.npz")
        np.savez(path, states=states, actions=actions)
        numbers = [UPDATES, *SEEDS]
        lines = lines_of_peer(
            folder, "v2", "imitation_gail.py", str(path), *map(str, numbers), *more
        )
    *scores, speed = (float(line) for line in lines[-len(SEEDS) - 1 :])
    return scores, speed


def line(name: str, scores: list[float], speed: float) -> str:
    """One line of the report."""
    each = ", ".join(f"{found:.0f}" for found in scores)
    return f"{name:22} {np.mean(scores):5.0f} (seeds: {each}); {speed:,.0f} steps/s"


def main() -> None:
    parser = parser_with_peers(__doc__)
    add_processor_clock(parser)
    parser.add_argument("--json", type=Path, help="write what was measured")
    options = parser.parse_args()
    clock = time.process_time if options.cpu else time.perf_counter
    env = gymnasium.make(TASK)
    shown = [
        step for seed in range(DEMONSTRATIONS) for step in episode(env, expert, seed)
    ]
    states, actions = (np.array(column) for column in zip(*shown, strict=True))
    steps = UPDATES * ACTORS * STEPS
    found = {"expert": score(expert)}
    print(
        f"expert {found['expert']:.0f}; {DEMONSTRATIONS} demonstrations; {steps:,} steps a seed"
    )
    for name, reward in (("ours", deceiving_reward), ("ours, control", constant_reward)):  # fmt: skip
        began = clock()
        policies = [trained(states, actions, reward, seed) for seed in SEEDS]
        speed = len(SEEDS) * steps / (clock() - began)
        found[name] = {"scores": [score(act) for act in policies], "steps/s": speed}
        print(line(name, found[name]["scores"], speed))
    if options.peers:
        more = ["--cpu"] if options.cpu else []
        scores, speed = beside(options.peers, states, actions, *more)
        found["imitation"] = {"scores": scores, "steps/s": speed}
        print(line("imitation", scores, speed))
        print(f"ratio of steps/s {found['ours']['steps/s'] / speed:.1f}")
    if options.json:
        atomic.write_text(options.json, json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
