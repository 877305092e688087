"""Drills of the page on too many states for a table."""

from __future__ import annotations

import inspect

import numpy as np

from robonav import mdp

from ..question import Number, Question, Table
from ..registry import drill
from ..scripted import Episode, Numbers
from ..text import sign

Rng = np.random.Generator


@drill("linear-values", "Weights of features in place of a table")
def weights_of_features(rng: Rng) -> Question:
    """Compute one step of Q-learning with a linear function."""
    f, after = (rng.integers(0, 4, size=2).astype(float) for _ in range(2))
    weights = np.round(rng.uniform(-1, 1, size=2), 1)
    reward, alpha = float(rng.integers(-1, 4)), float(rng.choice([0.1, 0.5]))
    discount = float(rng.choice([0.5, 0.9]))
    table = {0: np.array([f, f]), 1: np.array([after, after])}
    updated = weights.copy()
    inspect.unwrap(mdp.linear_q_learning)(
        Episode([0, 1], [reward], terminated=False),
        table.__getitem__,
        updated,
        1,
        discount=discount,
        learning_rate=lambda episode: alpha,
        epsilon=lambda episode: 0.0,
        rng=Numbers([0.5, 0.5]),
    )
    now, then = float(weights @ f), float(weights @ after)
    delta = reward + discount * then - now
    shown, next_shown, old = (
        f"({a:g}, {b:g})" for a, b in (f, after, np.round(weights, 1))
    )
    return Question(
        f"$Q(s, a) = w \\cdot f(s, a)$ with the weights $w = {old}$. A step with the features "
        f"${shown}$ gives the reward "
        f"${reward:g}$. The best action of the next state has the features ${next_shown}$. What are the weights after "
        f"one step of Q-learning with $\\alpha = {alpha:g}$ and $\\gamma = {discount:g}$?",
        Table(
            ["weights"],
            ["$w_1$", "$w_2$"],
            [updated.tolist()],
            wrong={
                "Each weight changes in proportion to its feature.": [
                    (weights + alpha * delta).tolist()
                ],
                "The discount is missing.": [
                    (weights + alpha * (reward + then - now) * f).tolist()
                ],
                "The old value is missing in the TD error.": [
                    (weights + alpha * (reward + discount * then) * f).tolist()
                ],
                "The features are those of the step, not of the next state.": [
                    (weights + alpha * delta * after).tolist()
                ],
            },
        ),
        f"$Q(s, a) = {now:.4g}$, and the next state has ${then:.4g}$. The TD error is $\\delta = {reward:g} "
        f"{sign(discount * then)} {sign(-now)} = {delta:.4g}$. Each weight changes by $\\alpha \\delta f_i$: "
        f"$w = ({updated[0]:.4g}, {updated[1]:.4g})$.",
    )


@drill("linear-values", "Tiles that two states share")
def tiles_in_common(rng: Rng) -> Question:
    """Find how far an update in one state moves the value of another."""
    tilings, width = int(rng.choice([2, 4, 5, 8])), float(rng.choice([0.5, 1.0, 2.0]))
    tiles = mdp.Tiles((0.0,), (10.0,), (round(10 / width),), tilings, n_actions=1)
    here = int(rng.integers(20, 60)) / 10 + 0.03
    there = here + int(rng.integers(1, 10)) / 10 * width
    same = int((tiles.active([here]) == tiles.active([there])).sum())
    error = float(rng.choice([-2.0, 1.0, 3.0, 4.0]))
    numbers = [int(at / width + k / tilings) for at in (here, there) for k in range(tilings)]  # fmt: skip
    rows = [
        ", ".join(map(str, half)) for half in (numbers[:tilings], numbers[tilings:])
    ]
    answer = error * same / tilings
    return Question(
        f"A line is covered by {tilings} tilings. State A lies in their tiles number {rows[0]}, one of each tiling, "
        f"and state B in {rows[1]}. All weights are 0. One update in A, with $\\alpha = 1 / {tilings}$, has the TD "
        f"error ${error:g}$. What is the value of B afterwards?",
        Number(
            answer,
            wrong={
                "B shares only some of its tiles with A.": error,
                "These are the tiles that A and B do not share.": error
                * (tilings - same)
                / tilings,
                "Each weight changes by the part $\\alpha$ of the error.": error * same,
            }
            if 0 < same < tilings and 2 * same != tilings
            else {
                "Count the tiles that both states have.": error * (same + 1) / tilings,
                "Each weight changes by the part $\\alpha$ of the error.": error
                * (same + 1),
            },
        ),
        f"A and B have {same} of {tilings} tiles in common. Each of their weights is now ${error:g} / {tilings}$, so "
        f"the value of B is ${same} \\cdot {error / tilings:.4g} = {answer:.4g}$.",
    )


@drill("linear-values", "How many weights?")
def weights_of_tilings(rng: Rng) -> Question:
    """Count the weights of a tile coding, and those that one update changes."""
    side, tilings = int(rng.integers(4, 13)), int(rng.choice([2, 4, 8, 16]))
    actions = int(rng.choice([2, 3, 4, 5]))
    tiles = tilings * (side + 1) ** 2  # a shifted grid needs one more row and column
    weights = tiles * actions
    return Question(
        f"Position and speed are covered by {tilings} tilings of ${side} \\times {side}$ tiles. Each tiling has one "
        f"more row and one more column, because it may be shifted. There are {actions} actions, each with weights of "
        "its own. How many weights are there, and how many does one update change?",
        Table(
            ["number"],
            ["weights", "changed by an update"],
            [[weights, tilings]],
            tolerance=0.1,
            wrong={
                "Each tiling has one more row and one more column.": [
                    [side**2 * tilings * actions, tilings]
                ],
                "Each action has weights of its own.": [[tiles, tilings]],
                "Only the weights of the action taken change.": [
                    [weights, tilings * actions]
                ],
                "In each tiling one tile holds the state, and all of these tiles count.": [
                    [weights, 1]
                ],
            },
        ),
        f"${tilings} \\cdot {side + 1}^2 \\cdot {actions} = {weights}$ weights. A state lies in one tile of each "
        f"tiling, so {tilings} weights of the action taken change.",
    )


@drill("linear-values", "A step that is too large")
def rate_for_features(rng: Rng) -> Question:
    """Compute where a value moves if several features are 1."""
    active, rate = (
        int(rng.integers(2, 11)),
        float(rng.choice([0.05, 0.1, 0.2, 0.25, 0.5])),
    )
    value, target = (float(n) for n in rng.choice(np.arange(-4, 11), size=2, replace=False))  # fmt: skip
    features = np.ones(active)
    weights = features * value / active
    answer = float((weights + rate * (target - value) * features) @ features)
    return Question(
        f"In a state {active} features are 1 and all others 0. Its value is ${value:g}$, and the target of an update "
        f"is ${target:g}$. What is the value after the update, with $\\alpha = {rate:g}$?",
        Number(
            answer,
            wrong={
                "This is the step of one weight. The value is the sum of all of them.": value
                + rate * (target - value),
                "Here the step is divided by the number of features. Each weight makes the whole step.": value
                + rate * (target - value) / active,
                "The value moves towards the target. Here the sign is wrong.": value
                - active * rate * (target - value),
            },
        ),
        f"Each of the {active} weights changes by ${rate:g} \\cdot ({target:g} {sign(-value)})$, so the value becomes "
        f"${value:g} {sign(active * rate * (target - value))} = {answer:.4g}$. It goes "
        f"{'beyond' if active * rate > 1 else 'no further than'} the target.",
    )
