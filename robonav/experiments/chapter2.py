"""Claims on Q-learning and SARSA that section 4.2 of the thesis quotes, tested in three small worlds."""

from __future__ import annotations

from functools import lru_cache

import gymnasium
import numpy as np
from numpy.typing import NDArray

from robonav.mdp import (
    FiniteMDP,
    policy_evaluation,
    policy_iteration,
    q_learning,
    sarsa,
)

from .runner.experiment import Case, Experiment, Numbers, Plot

DISCOUNT, EPSILON, MAX_STEPS = 0.99, 0.1, 1000
LEARNING_RATES = (0.1, 0.5)
EPISODES = {"CliffWalking-v1": 500, "FrozenLake-v1": 2000, "Taxi-v4": 1000}
METHODS = {"q-learning": q_learning, "sarsa": sarsa}
EARLY = 10  # the first tenth of the episodes, and the last


@lru_cache(maxsize=len(EPISODES))
def model(world: str) -> tuple[FiniteMDP, NDArray[np.float64], float]:
    """Return the model of a world, how likely each state is the first (S,), and the value of the best policy."""
    env = gymnasium.make(world)
    mdp = FiniteMDP.from_gymnasium(env, discount=DISCOUNT)
    first = np.asarray(env.unwrapped.initial_state_distrib)  # type: ignore[attr-defined]
    start = np.zeros(mdp.n_states)  # the model may have one more state, for all ends
    start[: len(first)] = first
    return mdp, start, float(start @ policy_iteration(mdp).values)


def value_of_greedy(world: str, q: NDArray[np.float64]) -> float:
    """Return the exact value of the greedy policy of action values (S, A), from the start."""
    mdp, start, _ = model(world)
    policy = np.zeros(mdp.n_states, dtype=np.int64)
    policy[: len(q)] = q.argmax(axis=1)
    return float(start @ policy_evaluation(mdp, policy))


def early_and_late(case: Case, seed: int, scale: str) -> Numbers:
    """One training: how well the learner does while it learns, and how good its greedy policy is."""
    world = str(case["world"])
    episodes = EPISODES[world]
    early = episodes // EARLY
    learned = METHODS[str(case["method"])](
        gymnasium.make(world),
        episodes,
        discount=DISCOUNT,
        learning_rate=float(case["learning rate"]),
        epsilon=EPSILON,
        max_steps=MAX_STEPS,
        seed=seed,
        record=True,
    )
    assert learned.history is not None
    best = model(world)[2]
    at_the_end = value_of_greedy(world, learned.q)
    return {
        "return, first tenth": learned.returns[:early].mean(),
        "return, last tenth": learned.returns[-early:].mean(),
        "greedy value after a tenth": value_of_greedy(world, learned.history[early]),
        "greedy value at the end": at_the_end,
        "best value": best,
        "optimal at the end": 100.0 * (at_the_end > best - 1e-6),
    }


EXPERIMENTS = (
    Experiment(
        name="sarsa-q-learning",
        title="Q-learning and SARSA while they learn, and the value of their greedy policies",
        cases=[
            {"world": world, "learning rate": rate, "method": method}
            for world in EPISODES
            for rate in LEARNING_RATES
            for method in METHODS
        ],
        run=early_and_late,
        seeds={"quick": 2, "thesis": 30},
        settings={
            "discount": DISCOUNT,
            "epsilon": EPSILON,
            "steps of an episode at most": MAX_STEPS,
            "episodes": EPISODES,
        },
        plot=Plot(
            "experiments.draw_bars",
            metric="greedy value at the end",
            label="value of the greedy policy",
        ),
    ),
)
