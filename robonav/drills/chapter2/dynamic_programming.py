"""Drills of the page on planning with a known model."""

from __future__ import annotations

import numpy as np

from robonav import mdp

from ..pictures import grid_picture
from ..question import Number, Place, Question, Table
from ..registry import drill
from ..runs import Line, as_list, some_in_order

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
    discount = float(rng.choice([0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.92, 0.95]))
    loss = float(rng.integers(1, 41)) / 2
    model = mdp.FiniteMDP([[[1.0]]], [[1.0]], discount)
    answer = model.residual_for(loss)
    return Question(
        "If the last sweep changed no value by more than $d$, the greedy policy loses at most "
        "$\\frac{2 \\gamma}{1 - \\gamma} \\, d$ in every state. "
        f"Your policy may lose at most ${loss:g}$, and $\\gamma = {discount:g}$. "
        "At which largest change of a sweep may value iteration stop? Give three decimals.",
        Number(
            answer,
            tolerance=0.0011,
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
        f"= {answer:.4g}$.",
    )


def _grid(rng: Rng) -> mdp.GridWorld | None:
    """A grid of three by three cells with a goal and one or two walls, or None if the goal cannot be reached."""
    rows = [["."] * 3 for _ in range(3)]
    goal, *walls = (divmod(int(k), 3) for k in rng.permutation(9)[: rng.integers(2, 4)])
    rows[goal[0]][goal[1]] = "G"
    for i, j in walls:
        rows[i][j] = "#"
    grid = mdp.GridWorld("\n".join("".join(row) for row in rows))
    values = mdp.policy_iteration(grid.mdp(discount=0.9)).values
    reached = np.delete(values, grid.numbers[goal]) > 0
    return grid if reached[: len(grid.cells) - 1].all() else None


@drill("dynamic-programming", "Which arrow changes?")
def improved_cell(rng: Rng) -> Question | None:
    """Find the state in which a policy is not greedy."""
    grid = _grid(rng)
    if grid is None:
        return None
    discount = 0.9  # with a discount of 1 a detour would cost nothing
    model = grid.mdp(discount=discount)
    best = mdp.policy_iteration(model)
    q = model.action_values(best.values)
    greedy = mdp.greedy_action_mask(q)
    asked = np.flatnonzero(~model.terminal)
    changed = int(rng.choice(asked))
    policy = best.policy.copy()
    worse = np.flatnonzero(~greedy[changed])
    if len(worse) == 0:
        return None
    policy[changed] = rng.choice(worse)
    letters = dict(zip(asked.tolist(), "ABCDEFHI", strict=False))  # G is the goal
    shown: list[list[str | None]] = [[None] * 3 for _ in range(3)]
    for s, (i, j) in enumerate(grid.cells.tolist()):
        shown[i][j] = mdp.gridworld.ARROWS[policy[s]] if s in letters else "G"
    places = {tuple(grid.cells[s].tolist()): name for s, name in letters.items()}
    name = letters[changed]
    better = int(best.policy[changed])
    return Question(
        f"The goal G gives the reward 1 and ends the episode; steps never slip, and $\\gamma = {discount:g}$. One "
        "arrow of this policy is not greedy with respect to the optimal values. Which cell's arrow does an "
        "improvement change?",
        Place(
            [*letters.values()],
            [name],
            {
                other: f"This arrow is greedy: it has the largest action value of its cell, ${q[s].max():.3g}$."
                for s, other in letters.items()
                if s != changed
            },
        ),
        f"In {name} the greedy action is {mdp.gridworld.ARROWS[better]}: "
        f"its action value is {q[changed].max():.3g}, and the arrow's is {q[changed, policy[changed]]:.3g}.",
        grid_picture(
            shown,
            names=places,
            title="A policy on a grid of three by three cells with the goal and walls.",
        ),
    )


STAY_OR_GO = ("stay", "go")


def _said(policy: np.ndarray) -> str:
    return ", ".join(STAY_OR_GO[int(action)] for action in policy)


def _run_of_policy_iteration(
    model: mdp.FiniteMDP, policy: np.ndarray
) -> list[Line] | None:
    """The lines of a run from a policy on, or None if two actions of a state are nearly equally good."""
    lines = []
    while True:
        values = np.asarray(mdp.policy_evaluation(model, policy))
        numbers = ", ".join(f"{value:.4g}" for value in values + 0.0)
        lines.append(
            Line(
                f"The values of A, B and C are ${numbers}$.",
                "These are the values of a policy that was found before. "
                "No value falls from one policy to the next.",
            )
        )
        q = model.action_values(values)
        if abs(q[:, 0] - q[:, 1]).min() < 0.05:
            return None
        better = q.argmax(axis=1)
        if (better == policy).all():
            end = "The run ends only when an improvement changes nothing, so that this is its last line."
            lines.append(Line("An improvement changes no action.", end))
            return lines
        policy = better
        lines.append(
            Line(
                f"The actions in A, B and C become {_said(policy)}.",
                "These actions come out of an improvement, which needs the values of the policy before it.",
            )
        )


@drill("dynamic-programming", "A run of policy iteration")
def order_of_policy_iteration(rng: Rng) -> Question | None:
    """Put the steps of an algorithm in order."""
    rewards = rng.integers(-3, 6, size=(3, 2)).astype(float)
    discount = float(rng.choice([0.5, 0.8]))
    moves = [np.eye(3), np.roll(np.eye(3), 1, axis=1)]  # stay, or go to the next state
    model = mdp.FiniteMDP(moves, rewards, discount)
    first = rng.integers(2, size=3)
    lines = _run_of_policy_iteration(model, first)
    if lines is None or len(lines) < 6:
        return None
    asked = some_in_order(rng, lines, int(rng.integers(4, 6)))
    table = ", ".join(
        f"$R({state}, \\text{{{action}}}) = {rewards[i, j]:g}$"
        for i, state in enumerate("ABC")
        for j, action in enumerate(STAY_OR_GO)
    )
    return Question(
        "In each of the states A, B and C the robot can stay, or go to the next one: from A to B, from B to C, from C "
        f"to A. {table}, and $\\gamma = {discount:g}$. Policy iteration begins with the actions {_said(first)}. Put "
        "these lines of its run in order (the run may have more lines).",
        asked,
        f"Evaluation and improvement alternate until an improvement changes nothing. {as_list(asked)}",
    )


@drill("dynamic-programming", "Does the model fit into memory?")
def memory_of_a_model(rng: Rng) -> Question:
    """Compute what a full and a sparse model need, on which the choice of a planner depends."""
    states = 1000 * int(rng.choice([5, 8, 10, 12, 15, 20, 25, 30, 40, 50, 100, 1000]))
    actions, reached = int(rng.choice([2, 3, 4, 5, 6, 8])), int(rng.integers(2, 6))
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
