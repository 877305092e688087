"""Planning side by side with QuantEcon, as ratios of times in one run, and a million states.

    python benchmarks/dp.py            the ratios
    python benchmarks/dp.py --million  the large grid too

10,000 states, 4 actions, discount 0.95, tolerance 1e-6: a slippery gridworld full of ties, and a random model with
five successors. A ratio is our time over QuantEcon's, each the best of several runs taken by turns. QuantEcon's policy
iteration goes in circles on the grid and takes minutes on the random model, so ours is timed alone. Needs the extra
``benchmarks``.
"""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse as sp
from quantecon.markov import DiscreteDP

from robonav.mdp import (
    Cell,
    FiniteMDP,
    GridWorld,
    modified_policy_iteration,
    policy_evaluation,
    policy_iteration,
    value_iteration,
)

DISCOUNT, TOLERANCE, RUNS = 0.95, 1e-6, 7


def grid(side: int, discount: float, *, seed: int = 0) -> FiniteMDP:
    """A square grid with a goal in the corner: 15 % of the cells cannot be entered, slip 0.1 either side, -1 a step."""
    rng = np.random.default_rng(seed)
    walls = rng.random((side, side)) < 0.15
    walls[-1, -1] = False
    states, goal = np.arange(side * side), side * side - 1
    row, column = np.divmod(states, side)
    reached = []
    for down, right in ((-1, 0), (0, 1), (1, 0), (0, -1)):
        to = np.clip(row + down, 0, side - 1), np.clip(column + right, 0, side - 1)
        reached.append(
            np.where(walls[to] | (states == goal), states, to[0] * side + to[1])
        )
    chances = np.repeat([0.8, 0.1, 0.1], states.size)
    transitions = [
        sp.csr_array(
            (
                chances,
                (
                    np.tile(states, 3),
                    np.concatenate([reached[(a + turn) % 4] for turn in (0, 1, 3)]),
                ),
            )
        )
        for a in range(4)
    ]
    rewards = np.full((states.size, 4), -1.0)
    rewards[goal] = 0
    return FiniteMDP(transitions, rewards, discount)


def scattered(states: int = 10_000, successors: int = 5, *, seed: int = 0) -> FiniteMDP:
    """A random model whose actions lead to a few states anywhere."""
    rng = np.random.default_rng(seed)
    transitions = []
    for _ in range(4):
        reached = rng.integers(0, states, (states, successors))
        chances = rng.dirichlet(np.ones(successors), states)
        place = np.repeat(np.arange(states), successors), reached.ravel()
        transitions.append(sp.csr_array((chances.ravel(), place), (states, states)))
    return FiniteMDP(transitions, rng.random((states, 4)), DISCOUNT)


def peer(mdp: FiniteMDP) -> DiscreteDP:
    """The same model as QuantEcon keeps it: state-action pairs in order of the state."""
    state, action = np.divmod(np.arange(mdp.rewards.size), mdp.n_actions)
    return DiscreteDP(
        mdp.rewards.ravel(), sp.csr_matrix(mdp.rows), mdp.discount, state, action
    )


def seconds(work: Callable[[], Any]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def best_by_turns(*works: Callable[[], Any]) -> list[float]:
    """The least time of each, run by turns so that a busy machine slows all equally; a first round warms up."""
    times = np.array([[seconds(work) for work in works] for _ in range(RUNS + 1)])
    return times[1:].min(axis=0).tolist()


def compare(name: str, mdp: FiniteMDP) -> None:
    other = peer(mdp)
    exact = policy_iteration(mdp).values
    for planner, method in (
        (value_iteration, "vi"),
        (modified_policy_iteration, "mpi"),
    ):

        def ours(planner: Callable[..., Any] = planner) -> Any:
            return planner(mdp, TOLERANCE)

        def theirs(method: str = method) -> Any:
            return other.solve(method=method, epsilon=TOLERANCE, max_iter=100_000)

        own, quantecon = best_by_turns(ours, theirs)
        errors = abs(ours().values - exact).max(), abs(theirs().v - exact).max()
        print(
            f"{name:5} {planner.__name__:26} {1e3 * own:7.1f} ms, QuantEcon {1e3 * quantecon:7.1f} ms, "
            f"ratio {own / quantecon:.2f} (errors {errors[0]:.1e}, {errors[1]:.1e})"
        )
    solution = policy_iteration(mdp)
    (own,) = best_by_turns(lambda: policy_iteration(mdp))
    off = abs(solution.values - policy_evaluation(mdp, solution.policy)).max()
    print(
        f"{name:5} policy_iteration           {1e3 * own:7.1f} ms, {solution.iterations} policies (error {off:.1e})"
    )


def million() -> None:
    """A sparse gridworld of a million states from its text to its solution: discount 0.99, tolerance 1e-4."""
    rng = np.random.default_rng(0)
    symbols = np.where(rng.random((1085, 1085)) < 0.15, "#", ".")
    symbols[-1, -1] = "G"
    text = "\n".join("".join(row) for row in symbols)
    start = time.perf_counter()
    mdp = GridWorld(text, legend={"G": Cell(ends=True)}, slip=0.2, step_reward=-1).mdp(
        0.99
    )
    print(f"\n{mdp}: built in {time.perf_counter() - start:.1f} s")
    for planner in (value_iteration, modified_policy_iteration):
        start = time.perf_counter()
        solution = planner(mdp, 1e-4)
        print(
            f"{planner.__name__:26} {time.perf_counter() - start:5.1f} s, {solution.iterations} iterations"
        )
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"memory at its highest: {peak:.2f} GiB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--million", action="store_true", help="solve the grid of a million states too"
    )
    options = parser.parse_args()
    ties = grid(100, DISCOUNT)
    compare("grid", ties)
    given_up = peer(ties).solve(method="policy_iteration", max_iter=60).num_iter == 60
    print(
        f"grid  QuantEcon's policy iteration {'still changes' if given_up else 'is done'} after 60 policies"
    )
    compare("rand", scattered())
    if options.million:
        million()
