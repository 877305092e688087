"""What the kernel computes for the explorables of chapter 2: values from episodes, and plans for beliefs."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav import mdp

from ..kernel_training import Report
from .chapter2 import grid_to_touch, page_vectors, plans_by_steps, turn_arrows
from .training import Curve, Dial, Menu, Trained, trains

POLICIES = ("the one that goes around", "an optimal one")
AT_ONCE = 20
"""Episodes between two points of the curve."""


@trains(
    "turn_arrows",
    "The value of the start, as the mean return of many episodes",
    action="Compute in Python",
    unit="episode",
    length="episodes",
    settings={
        "policy": Menu("policy", POLICIES),
        "step_reward": Dial("reward of a step", -2.0, 0.0, 0.02, -0.04),
        "slip": Dial("a step slips with probability", 0.0, 0.6, 0.05, 0.2),
        "discount": Dial("discount γ", 0.5, 0.95, 0.05, 0.95),
        "episodes": Dial("episodes", 200, 10_000, 200, 2000),
        "seed": Dial("seed", 0, 20, 1, 0),
    },
    curves={
        "mean": Curve(
            "mean return", "The mean of all returns so far.", low=None, digits=3
        ),
        "error": Curve(
            "standard error",
            "The standard deviation of the returns, divided by the square root of their number.",
            digits=3,
        ),
    },
)
def mean_return(settings: dict[str, Any], report: Report) -> Trained:
    """Episodes of a policy on the grid of four by three cells; the page gets this grid and this policy."""
    grid = mdp.four_by_three(slip=settings["slip"], step_reward=settings["step_reward"])
    discount, total = settings["discount"], settings["episodes"]
    model, given = grid_to_touch(grid, discount)
    around = settings["policy"] == POLICIES[0]
    policy = np.array(
        turn_arrows()["policy"] if around else mdp.policy_iteration(model).policy
    )
    rng = np.random.default_rng(settings["seed"])
    returns: list[float] = []
    while len(returns) < total:
        episodes = mdp.rollouts(
            grid.environment(), policy, AT_ONCE, max_steps=1000, seed=rng
        )
        returns += [
            float(mdp.discounted_return(episode.rewards, discount)[0])
            for episode in episodes
        ]
        report(
            len(returns),
            total,
            at=len(returns),
            mean=float(np.mean(returns)),
            error=float(np.std(returns, ddof=1) / np.sqrt(len(returns))),
        )
    value = float(grid.start @ mdp.policy_evaluation(model, policy))
    error = float(np.std(returns, ddof=1) / np.sqrt(total))
    return Trained(
        [np.array(returns)],
        f"The mean return is {np.mean(returns):.3f}, with a standard error of {error:.3f}. Bellman's equations give "
        f"the value {value:.3f}.",
        given | {"policy": policy.tolist()},
    )


@trains(
    "tiger_vectors",
    "Plans for your own tiger, backed up at a few beliefs",
    action="Compute in Python",
    unit="steps to go",
    length="steps",
    settings={
        "accuracy": Dial("listening is right in", 50, 99, 1, 85, " %"),
        "bite": Dial("a wrong door costs", 10, 300, 10, 100),
        "discount": Dial("discount γ", 0.5, 0.95, 0.05, 0.95),
        "beliefs": Dial("beliefs to back up", 1, 40, 1, 20),
        "steps": Dial("steps to go", 1, 60, 1, 30),
    },
    curves={
        "value": Curve("value", "The value of the uniform belief.", low=None, digits=2),
        "vectors": Curve("vectors", "How many vectors are kept.", digits=0),
    },
)
def plans_for_beliefs(settings: dict[str, Any], report: Report) -> Trained:
    """Point-based backups for the tiger; the page gets the vectors for each number of steps to go."""
    accuracy, steps = settings["accuracy"] / 100, settings["steps"]
    known = mdp.tiger(accuracy=accuracy)
    rewards = np.where(known.mdp.rewards == -100, -settings["bite"], known.mdp.rewards)
    tiger = mdp.POMDP(
        mdp.FiniteMDP(known.mdp.transitions, rewards, settings["discount"]),
        known.observations,
    )
    uniform = [0.5, 0.5]
    points = mdp.spread_beliefs(tiger, uniform, settings["beliefs"])
    plans = []
    for plan in plans_by_steps(tiger, points, steps):
        plans.append(plan)
        report(
            len(plans),
            steps,
            at=len(plans),
            value=float(plan.value(uniform)),
            vectors=len(plan.vectors),
        )
    ways = ("listen", "open left", "open right")
    return Trained(
        [plans[-1]],
        f"Beliefs backed up: {len(points)}. Vectors with {steps} steps to go: {len(plans[-1].vectors)}. The uniform "
        f"belief has the value {plans[-1].value(uniform):.2f}, and the best action there is to "
        f"{ways[plans[-1].action(uniform)]}.",
        {"accuracies": [accuracy], "plans": [[page_vectors(plan) for plan in plans]]},
    )
