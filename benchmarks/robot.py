"""How fast the robot goes: steps a second, batched and single, against peers timed in the same run.

    python benchmarks/robot.py                  # against Gymnasium's CartPole, which is always there
    python benchmarks/robot.py --peers DIR      # and against VMAS, ir-sim and JaxNav (see benchmarks/peers/README.md)

Every figure is the median of several rounds, robonav and peer in turn. Absolute figures do not carry from one machine
to another; the ratios do, roughly.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial

import gymnasium
from peer_process import parser_with_peers, printed_by_peer
from timing import in_turn

import robonav  # noqa: F401  (registers the environments)

NAME = "robonav/Navigation-v0"
SECONDS, ROUNDS = 1.5, 5


def batched(name: str, number: int, **settings: object) -> Callable[[], float]:
    """Steps a second of a vector environment, random actions, new worlds after each episode included."""
    env = gymnasium.make_vec(
        name, number, vectorization_mode="vector_entry_point", **settings
    )
    env.reset(seed=0)
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(16)]
    for k in range(8):
        env.step(actions[k])

    def measure() -> float:
        steps, start = 0, time.perf_counter()
        while (passed := time.perf_counter() - start) < SECONDS:
            env.step(actions[steps % 16])
            steps += 1
        return steps * number / passed

    return measure


def single(name: str, **settings: object) -> Callable[[], float]:
    """Steps a second of processor time of one environment as ``gymnasium.make`` gives it, resets included."""
    env = gymnasium.make(name, **settings)
    env.reset(seed=0)
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(1000)]

    def measure() -> float:
        steps, start = 0, time.process_time()
        while (passed := time.process_time() - start) < SECONDS:
            *_, terminated, truncated, _ = env.step(actions[steps % 1000])
            steps += 1
            if terminated or truncated:
                env.reset()
        return steps / passed

    measure()
    return measure


def import_and_compile() -> None:
    """Seconds to import the package, to the first step where nothing is compiled, and after it, as `make` leaves it."""
    imports = [seconds("import robonav") - seconds("pass") for _ in range(5)]
    print(f"import robonav: {statistics.median(imports):.2f} s (at most 0.3 s)")
    step = (
        "import robonav, gymnasium; e = gymnasium.make('robonav/Navigation-v0'); e.reset(seed=0); e.step(0);"
        "e = gymnasium.make_vec('robonav/Navigation-v0', 2, vectorization_mode='vector_entry_point');"
        "e.reset(seed=0); e.step([0, 0])"
    )
    with tempfile.TemporaryDirectory() as cache:
        first = seconds(step, NUMBA_CACHE_DIR=cache)
        again = seconds(step, NUMBA_CACHE_DIR=cache)
    print(
        f"first step: {again:.1f} s (at most 5 s); where nothing is compiled yet: {first:.1f} s"
    )


def seconds(code: str, **environment: str) -> float:
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", code], check=True, env=os.environ | environment
    )
    return time.perf_counter() - start


def main() -> None:
    folder = parser_with_peers(__doc__).parse_args().peers
    import_and_compile()
    ours, peer, ratio = in_turn(
        single(NAME, obstacles=20), single("CartPole-v1"), ROUNDS
    )
    print(
        f"single, 20 obstacles: {ours:,.0f} steps/s; CartPole {peer:,.0f}; ratio {ratio:.2f} (at least 0.33)"
    )
    for number in (1024, 4096, 16384):
        ours, peer, ratio = in_turn(
            batched(NAME, number, obstacles=20), batched("CartPole-v1", number), ROUNDS
        )
        print(
            f"{number} at once, 20 obstacles: {ours:,.0f} steps/s; CartPole {peer:,.0f}; ratio {ratio:.3f}"
        )
    if folder is None:
        print("peers in their own environments: left out, see --peers")
        return
    for what, environment, script in (
        ("VMAS navigation", "v1", "vmas_navigation.py"),
        ("ir-sim", "v1", "irsim_robot.py"),
        ("JaxNav", "v3", "jaxnav.py"),
    ):
        ours, peer, ratio = in_turn(
            batched(NAME, 4096, obstacles=20),
            partial(printed_by_peer, folder, environment, script),
            ROUNDS,
        )
        print(
            f"4096 at once, 20 obstacles: {ours:,.0f} steps/s; {what} {peer:,.0f}; ratio {ratio:.1f}"
        )


if __name__ == "__main__":
    main()
