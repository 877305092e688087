"""Drills of the page on planning with a known model."""

from __future__ import annotations

import numpy as np

from robonav import mdp

from ..pictures import grid_picture
from ..question import Number, Order, Place, Question, Table
from ..registry import drill

Rng = np.random.Generator


@drill("dynamic-programming", "A Bellman backup in one cell")
def bellman_backup(rng: Rng) -> Question:
    """Back up the value of one cell of a grid that slips."""
    slip = float(rng.choice([0.1, 0.2]))
    up, right, down = np.round(rng.uniform(0, 1, size=3), 2)
    discount = float(rng.choice([0.8, 0.9]))
    ahead, aside = 1 - 2 * slip, slip
    expected = np.array([ahead * right + aside * (up + down)])
    # one action, "right"; the states are the cell itself, and the cells above, right and below
    to_others = [0, aside, ahead, aside]
    stay = [np.eye(4)[k] for k in (1, 2, 3)]
    model = mdp.FiniteMDP([[to_others, *stay]], np.zeros((4, 1)), discount)
    answer = float(model.action_values([0, up, right, down])[0, 0])
    return Question(
        f"The robot in the cell A goes right. It gets there with probability ${ahead:g}$, and slips up or down with "
        f"probability ${aside:g}$ each. The step gives no reward. The picture shows the values of the cells around. "
        f"What does the backup give as $Q(A, \\text{{right}})$ with $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "The discount is missing.": float(expected[0]),
                "The robot may also slip: this counts the cell to the right alone.": discount
                * right,
                "Each value counts by its own probability; this is the plain mean of the three.": discount
                * (up + right + down)
                / 3,
                "The slips are missing: only the way to the right is counted here.": discount
                * ahead
                * right,
                "This is the largest of the values. A backup of one action is a mean over next states.": discount
                * max(up, right, down),
            },
        ),
        f"${discount:g} \\, ({ahead:g} \\cdot {right:g} + {aside:g} \\cdot {up:g} + {aside:g} \\cdot {down:g}) "
        f"= {answer:.4g}$.",
        grid_picture(
            [
                [None, f"{up:g}", None],
                [None, "A", f"{right:g}"],
                [None, f"{down:g}", None],
            ],
            title=f"Cell A. Above it a cell with value {up:g}, to its right {right:g}, below it {down:g}.",
        ),
    )


@drill("dynamic-programming", "When may value iteration stop?")
def stopping_bound(rng: Rng) -> Question:
    """Turn an accepted loss into the change at which to stop."""
    discount = float(rng.choice([0.8, 0.9, 0.95, 0.99]))
    loss = float(rng.choice([0.5, 1.0, 2.0, 5.0]))
    model = mdp.FiniteMDP([[[1.0]]], [[1.0]], discount)
    answer = model.residual_for(loss)
    return Question(
        f"Your policy may lose at most ${loss:g}$ in every state, and $\\gamma = {discount:g}$. "
        "At which largest change of a sweep may value iteration stop? Give three significant digits.",
        Number(
            answer,
            tolerance=0.006 * answer,
            wrong={
                "This is the accepted loss itself. Later sweeps can still change the values much more.": loss,
                "This is a bound on the values. The policy's loss can be twice as large.": loss
                * (1 - discount)
                / discount,
                "The discount in the denominator is missing.": loss
                * (1 - discount)
                / 2,
                "The factor $1 - \\gamma$ is missing.": loss / (2 * discount),
            },
        ),
        f"$\\epsilon (1 - \\gamma) / (2 \\gamma) = {loss:g} \\cdot {1 - discount:.2g} / {2 * discount:g} "
        f"= {answer:.3g}$.",
    )


@drill("dynamic-programming", "Which arrow changes?")
def improved_cell(rng: Rng) -> Question:
    """Find the state in which a policy is not greedy."""
    grid = mdp.GridWorld("S . . \n . # . \n . . G")
    model = grid.mdp(discount=0.9)
    best = mdp.policy_iteration(model)
    q = model.action_values(best.values)
    unique = np.flatnonzero((mdp.greedy_actions(q).sum(axis=1) == 1) & ~model.terminal)
    changed = int(rng.choice(unique))
    policy = best.policy.copy()
    policy[changed] = (policy[changed] + rng.integers(1, 4)) % 4
    letters = "ABCDEFH"  # G is the goal
    places = {tuple(cell): letters[s] for s, cell in enumerate(grid.cells[:7].tolist())}
    shown: list[list[str | None]] = [["", "", ""], ["", None, ""], ["", "", "G"]]
    for s, (i, j) in enumerate(grid.cells[:7].tolist()):
        shown[i][j] = mdp.gridworld.ARROWS[policy[s]]
    name = letters[changed]
    return Question(
        "The goal G gives the reward 1 and ends the episode; steps never slip. One arrow of this "
        "policy is not greedy "
        "with respect to the optimal values. Which cell's arrow does an improvement change?",
        Place([*letters], [name]),
        f"In {name} the greedy action is {mdp.gridworld.ARROWS[best.policy[changed]]}: "
        f"its action value is {q[changed].max():.3g}, and the arrow's is {q[changed, policy[changed]]:.3g}.",
        grid_picture(
            shown,
            names=places,
            title="A policy on a grid of three by three cells with a wall in the middle.",
        ),
    )


@drill("dynamic-programming", "The steps of policy iteration")
def order_of_policy_iteration(rng: Rng) -> Question:
    """Put the steps of an algorithm in order."""
    return Question(
        "Put the steps of policy iteration in order.",
        Order(
            [
                "Choose any policy.",
                "Compute the values of the policy.",
                "Take in each state the action with the largest action value.",
                "Stop if no action has changed; else evaluate again.",
            ],
            hint="An evaluation comes before each improvement, because the improvement needs the values.",
            before={
                (0, 1): "There must be a policy before it can be evaluated.",
                (1, 2): "The improvement needs the values of the policy.",
                (2, 3): "Whether an action has changed is known after the improvement.",
            },
        ),
        "Evaluation and improvement alternate, beginning with any policy, until an improvement changes nothing.",
    )


@drill("dynamic-programming", "Does the model fit into memory?")
def memory_of_a_model(rng: Rng) -> Question:
    """Compute what a full and a sparse model need, on which the choice of a planner depends."""
    states = int(rng.choice([10_000, 20_000, 50_000, 100_000, 1_000_000]))
    actions, reached = int(rng.choice([4, 5, 8])), int(rng.choice([3, 4]))
    full, sparse = (
        8.0 * actions * states**2 / 1e9,
        12.0 * actions * states * reached / 1e6,
    )
    return Question(
        f"A grid has {states} states and {actions} actions, and each action leads to {reached} states. A number needs "
        "8 bytes, and its column in a sparse matrix 4 more. How much memory do the transitions need as full matrices, "
        "and how much as sparse ones? A GB has $10^9$ bytes, an MB $10^6$.",
        Table(
            ["transitions"],
            ["full, in GB", "sparse, in MB"],
            [[full, sparse]],
            wrong={
                "There is one matrix for each action.": [
                    [full / actions, sparse / actions]
                ],
                "A full matrix holds a number for each pair of states.": [
                    [full * reached / states, sparse]
                ],
                "A sparse matrix holds numbers only for the states that are reached.": [
                    [full, 1.5e3 * full]
                ],
                "A sparse matrix also holds the column of each number.": [
                    [full, sparse * 2 / 3]
                ],
            },
        ),
        f"Full: $8 \\cdot {actions} \\cdot {states}^2$ bytes are {full:,.2f} GB. Sparse: $12 \\cdot {actions} \\cdot "
        f"{states} \\cdot {reached}$ bytes are {sparse:.2f} MB. Exact values also need a system of {states} equations; "
        "modified policy iteration needs only sweeps.",
    )
