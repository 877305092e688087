"""The numbers of chapter 5's explorables."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav import mdp, nirl
from robonav.nirl.benchmark_mdps import CELLS, TERRAIN

from ..grid import page_grid
from .registry import asks

WALK_STEPS = 20
"""Steps of each random walk of ``weights_of_samples``."""


def terrain_with(target: tuple[int, int]) -> tuple[mdp.GridWorld, nirl.RewardFreeMDP]:
    """The terrain of mud, road and grass with its target in another cell."""
    rows = [row.split() for row in TERRAIN.split("\n") if row.strip()]
    rows = [["." if symbol == "T" else symbol for symbol in row] for row in rows]
    rows[target[0]][target[1]] = "T"
    grid = mdp.GridWorld(
        "\n".join(" ".join(row) for row in rows), legend=CELLS, slip=0.2
    )
    symbols = np.array([grid.rows[row][column] for row, column in grid.cells])
    symbols[symbols == "S"] = "."
    kinds = (symbols[:, None] == np.array(list(".mrT"))).astype(float)
    return grid, nirl.RewardFreeMDP.of_grid(grid, kinds, 0.9)


TARGETS = {
    "where it was": (3, 6),
    "top right": (0, 6),
    "bottom right": (5, 6),
    "top left": (0, 0),
    "in the mud": (4, 3),
}


@asks(
    "Copy the actions, or learn the reward?",
    "An expert walks to the target on the right. "
    "Then the target moves to the top left. "
    "A learner has copied the actions. "
    "In how many of the 41 cells is its action still the best one?",
    guesses=["in all", "in about two thirds", "in about a third", "in none"],
    right="in about a third",
    because="The copied actions still lead to the old target, which is the right way from 13 of the "
    "41 cells only.",
    files=("grid",),
)
def reward_transfer() -> dict[str, Any]:
    """For each place of the target: the copied policy and the best one for the expert's reward, with their values."""
    copied = mdp.policy_iteration(
        terrain_with(TARGETS["where it was"])[1].with_reward(nirl.TRUE_WEIGHTS)
    ).policy
    return {"terrains": transferred(copied, nirl.TRUE_WEIGHTS), "learned": False}


def transferred(
    copied: NDArray[np.intp], weights: NDArray[np.float64]
) -> list[dict[str, Any]]:
    """For each place of the target: copied actions, the best ones for a reward, and their values for the expert's."""
    terrains = []
    for name, target in TARGETS.items():
        grid, task = terrain_with(target)
        model = task.with_reward(nirl.TRUE_WEIGHTS)
        q = model.action_values(mdp.policy_iteration(model).values)
        still = q[np.arange(len(copied)), copied] >= q.max(axis=1) - 1e-9
        best = mdp.policy_iteration(task.with_reward(weights)).policy
        terrains.append(
            {
                "name": name,
                "layout": page_grid(grid),
                "start": int(grid.start.argmax()),
                "still": int(still[~grid.terminal].sum()),
                "cells": int((~grid.terminal).sum()),
                "copied": {
                    "policy": copied.tolist(),
                    "values": mdp.policy_evaluation(model, copied).tolist(),
                },
                "reward": {
                    "policy": best.tolist(),
                    "values": mdp.policy_evaluation(model, best).tolist(),
                },
            }
        )
    return terrains


@asks(
    "Which action did the expert mean?",
    "In one state the expert went forward 10 times and turned left once. "
    "Elsewhere it went forward 1,000 times and never turned left. "
    "All actions are taken as equally likely beforehand. "
    "Which action is then the most probable one (maximum a posteriori) in this state?",
    guesses=["forward", "left", "both are equally probable"],
    right="left",
    because="Its only left turn was made in this state, but only 10 of its 1,010 forward steps were.",
)
def inconsistent_expert() -> dict[str, Any]:
    """Counts in the state that the reader changes; the page does the sums."""
    return {"here": [10, 1]}


@asks(
    "Two trajectories, four features",
    "A step costs 1 in mud, 0.3 on grass and 0.05 on the road, and the target gives 3. "
    "With a discount of 0.9 the long trajectory on the road has a larger return than the short one "
    "through the mud. "
    "Does it still with a discount of 0.5?",
    guesses=["yes", "no"],
    right="yes",
    because="The mud comes early on the short trajectory, so a small discount gives it more weight, while "
    "the target is far away on both.",
    files=("grid",),
)
def trajectory_features() -> dict[str, Any]:
    """Two trajectories from the start to the target of the terrain, as kinds of the cells stepped onto."""
    grid, _ = nirl.terrain()
    place = {tuple(cell): state for state, cell in enumerate(grid.cells.tolist())}
    road = [
        (3, 0),
        (3, 1),
        (2, 1),
        (1, 1),
        (1, 2),
        (1, 3),
        (1, 4),
        (1, 5),
        (2, 5),
        (3, 5),
        (3, 6),
    ]
    straight = [(3, column) for column in range(7)]
    symbols = {".": 0, "S": 0, "m": 1, "r": 2, "T": 3}
    trajectories = [
        {
            "name": name,
            "states": [place[cell] for cell in trajectory],
            "kinds": [
                symbols[grid.rows[row][column]] for row, column in trajectory[1:]
            ],
        }
        for name, trajectory in (
            ("straight through the mud", straight),
            ("round on the road", road),
        )
    ]
    return {
        "layout": page_grid(grid),
        "trajectories": trajectories,
        "kinds": list(nirl.TERRAIN_KINDS),
        "weights": nirl.TRUE_WEIGHTS.tolist(),
        "discount": 0.9,
    }


@asks(
    "A soft maximum",
    "Three actions have the values 1, 1 and 0. "
    "Their hard maximum is 1. "
    "How large is their soft maximum at temperature 1, the logarithm of the sum of their "
    "exponentials?",
    guesses=["below 1", "exactly 1", "above 1"],
    right="above 1",
    because="It adds up the exponentials of all three values, so it is larger than any of them: ln(e "
    "+ e + 1) = 1.86.",
)
def soft_maximum_of_three() -> dict[str, Any]:
    """Three values to be changed."""
    return {"values": [1.0, 1.0, 0.0]}


@asks(
    "Turn the reward until the margin is largest",
    "The grey points are the feature expectations of some policies, and the orange one is the "
    "expert's. "
    "A reward is a direction. "
    "Its margin is the expert's lead over the best of the others. "
    "In which direction is the margin largest? "
    "(The hull is the smallest polygon around the grey points.)",
    guesses=[
        "from the origin to the expert",
        "from the nearest point of the hull to the expert",
        "from the mean of the others to the expert",
    ],
    right="from the nearest point of the hull to the expert",
    because="In this direction the margin is the whole distance from the hull to the expert, 0.91, "
    "and no direction can give more.",
)
def widest_margin() -> dict[str, Any]:
    """The points of the page's figure, and the widest margin for the expert where it stands."""
    rng = np.random.default_rng(4)
    others, expert = rng.normal(size=(6, 2)), np.array([2.2, 1.4])
    widest = nirl.maximum_margin(expert, others)
    return {
        "others": others.tolist(),
        "expert": expert.tolist(),
        "margin": widest.margin,
        "angle": float(np.degrees(np.arctan2(widest.weights[1], widest.weights[0]))),
    }


@asks(
    "Projection, step by step",
    "Each grey point is a policy. "
    "In each step, the apprentice adds to its mixture the policy that lies furthest in the "
    "direction from the mixture to the expert. "
    "How many policies does it add until the mixture is within 0.1 of the expert?",
    guesses=["1", "3", "6", "more than 12"],
    right="3",
    because="The first policies overshoot to one side, each later one moves the mixture to the other "
    "side, and the third brings it within 0.1.",
)
def projection_steps(policies: int = 12) -> dict[str, Any]:
    """Feature expectations of twelve policies on a circle, and an expert inside it."""
    angles = 2 * np.pi * np.arange(policies) / policies
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    return {
        "points": points.tolist(),
        "expert": [0.45, 0.55],
        "first": 7,
        "names": ["feature 1", "feature 2"],
        "least": -1,
        "most": 1,
    }


@asks(
    "How sure is a Boltzmann policy?",
    "Three actions have the values 0.6, 0.5 and 0.2. "
    "From which inverse temperature η on is the best one taken nine times in ten?",
    guesses=["η = 1", "η = 10", "η = 22", "never"],
    right="η = 22",
    because="The second value is lower by 0.1, and exp(22 · 0.1) = 9, so the second action is taken "
    "once for every nine times of the best.",
)
def boltzmann_temperature() -> dict[str, Any]:
    """Three values to be changed, and the answer."""
    values = [0.6, 0.5, 0.2]
    etas = np.arange(0, 60.5, 0.5)
    best = [nirl.boltzmann_policy(values, eta)[0] for eta in etas]
    return {"values": values, "sure": float(etas[np.argmax(np.array(best) >= 0.9)])}


@asks(
    "Which policy is kept?",
    "A careful policy predicts seven in ten of the expert's decisions, whichever action the "
    "expert took. "
    "A simple policy always goes forward. "
    "The expert goes forward in 75 % of its decisions. "
    "Which of the two has the higher accuracy?",
    guesses=["the careful one", "the simple one"],
    right="the simple one",
    because="Always going forward is right in 75 % of the decisions, and the careful policy in 70 %.",
)
def accuracy_or_balance() -> dict[str, Any]:
    """How often the expert goes forward, how many other actions there are, and how well the careful policy predicts."""
    return {"forward": 0.5, "others": 4, "careful": 0.7}


@asks(
    "A few samples carry all the weight",
    "Fifty random walks of twenty steps are samples of all trajectories. "
    "With θ = 1, each step to the right multiplies the weight of a walk by e. "
    "The weighted mean of the fifty is as reliable as the mean of how many walks of equal weight?",
    guesses=["about 50", "about 25", "about 7", "about 1"],
    right="about 7",
    because="Three more steps to the right multiply the weight of a walk by e³ = 20, so a few walks "
    "have nearly all of it.",
)
def weights_of_samples() -> dict[str, Any]:
    """Features of fifty random walks, the share of twenty steps that go to the right, and theta per step at first."""
    rng = np.random.default_rng(9)
    features = rng.binomial(WALK_STEPS, 0.5, size=50) / WALK_STEPS
    return {"features": features.tolist(), "expert": 0.8, "theta": 0.0}


@asks(
    "The value of an end",
    "Each step gives a reward of 0.3, after scaling to the range from 0 to 1, and the end of "
    "the episode has the value 0. "
    "Will a robot that maximises its return try to end the episode?",
    guesses=["yes", "no, it delays the end", "it does not care"],
    right="no, it delays the end",
    because="Each further step gives 0.3, and the end gives 0.",
)
def value_of_an_end() -> dict[str, Any]:
    """A reward and the same value of an end, with the discount of the chapter."""
    return {"reward": 0.3, "end": 0.3, "discount": nirl.ReplaySGD().discount}
