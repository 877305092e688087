"""Drills of the page on learning values from episodes."""

from __future__ import annotations

import inspect

import numpy as np

from robonav import mdp

from ..question import Number, Question, Table
from ..registry import drill
from ..scripted import Episode
from ..text import sign, terms

Rng = np.random.Generator


@drill("prediction", "One step of TD(0)")
def td_error(rng: Rng) -> Question:
    """Update the value of a state by its TD error."""
    value, following = np.round(rng.uniform(-2, 8, size=2), 1)
    reward, discount = float(rng.integers(-2, 4)), float(rng.choice([0.5, 0.8, 0.9]))
    rate = float(rng.choice([0.1, 0.2, 0.5]))
    values = [float(value), float(following)]
    inspect.unwrap(mdp.td_prediction)(
        Episode([0, 1], [reward], terminated=False),
        lambda state: 0,
        values,
        [0, 0],
        1,
        discount=discount,
        learning_rate=lambda visits: rate,
    )
    target = reward + discount * following
    error = target - value
    return Question(
        f"$V(s) = {value:g}$ and $V(s') = {following:g}$. A step from $s$ to $s'$ gives the reward ${reward:g}$. "
        f"Which value does TD(0) give $s$, with $\\gamma = {discount:g}$ and $\\alpha = {rate:g}$?",
        Number(
            values[0],
            wrong={
                "This is the target. The value moves towards it by the part $\\alpha$ only.": target,
                "This is the TD error alone. It is multiplied by $\\alpha$ and added to $V(s)$.": error,
                "The discount of $V(s')$ is missing.": value
                + rate * (reward + following - value),
                "$V(s)$ is missing in the TD error.": value + rate * target,
                "The sign of the step is wrong: the value moves towards the target.": value
                - rate * error,
            },
        ),
        f"The target is ${reward:g} {sign(discount * following)} = {target:.4g}$, so the TD error is "
        f"${target:.4g} {sign(-value)} = {error:.4g}$, and $V(s) = {value:g} {sign(rate * error)} = "
        f"{values[0]:.4g}$.",
    )


@drill("prediction", "What Monte Carlo averages")
def monte_carlo_return(rng: Rng) -> Question:
    """Find the return that first-visit Monte Carlo counts for a state."""
    path = ["A", "B", *rng.permutation(["A", "B"]).tolist()]
    rewards = rng.integers(-2, 5, size=4).astype(float)
    discount = float(rng.choice([0.5, 0.8]))
    asked = str(rng.choice(["A", "B"]))
    values = [0.0, 0.0, 0.0]
    inspect.unwrap(mdp.monte_carlo_prediction)(
        Episode([*("AB".index(state) for state in path), 2], rewards.tolist()),
        lambda state: 0,
        values,
        [0, 0, 0],
        1,
        discount=discount,
    )
    answer = values["AB".index(asked)]
    returns = mdp.discounted_return(rewards, discount)
    visits = [k for k, state in enumerate(path) if state == asked]
    first = visits[0]
    steps = ", ".join(
        f"{state} ({reward:g})" for state, reward in zip(path, rewards, strict=True)
    )
    return Question(
        f"An episode visits these states, with the reward of each step in brackets: {steps}; then it ends. Which "
        f"return does first-visit Monte Carlo count for {asked}, with $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "This is the return of the second visit. First-visit Monte Carlo counts the first.": returns[
                    visits[1]
                ],
                "This is the mean over both visits, which every-visit Monte Carlo takes.": returns[
                    visits
                ].mean(),
                "The discount is missing.": rewards[first:].sum(),
                "Only the reward of the first step is counted here.": rewards[first],
            },
        ),
        f"{asked} is first visited in step {first}. From there on "
        f"${terms(rewards[first:], discount ** np.arange(4 - first))} = {answer:.4g}$.",
    )


@drill("prediction", "A mean without a list")
def running_mean(rng: Rng) -> Question:
    """Update the mean of all returns by one more return."""
    n = int(rng.integers(3, 11))
    value, new = (float(x) for x in np.round(rng.uniform(-4, 12, size=2), 1))
    values, visits = [value, 0.0], [n - 1, 0]
    inspect.unwrap(mdp.monte_carlo_prediction)(
        Episode([0, 1], [new]), lambda state: 0, values, visits, 1, discount=1.0
    )
    answer = values[0]
    return Question(
        f"A state was visited ${n - 1}$ times, and the mean of its returns is ${value:g}$. The next return is "
        f"${new:g}$. What is the new mean?",
        Number(
            answer,
            wrong={
                "The new return counts as much as each of the old ones, not as much as all of them together.": (
                    value + new
                )
                / 2,
                f"With the new one there are ${n}$ returns, not ${n - 1}$.": value
                + (new - value) / (n - 1),
                "The old mean moves towards the new return. Here the sign is wrong.": value
                - (new - value) / n,
                "This is the step. It is added to the old mean.": (new - value) / n,
            },
        ),
        f"${value:g} + \\frac{{1}}{{{n}}} ({new:g} {sign(-value)}) = {answer:.4g}$.",
    )


@drill("prediction", "How far does news travel in an episode?")
def news_of_an_episode(rng: Rng) -> Question:
    """Update the values of three states by TD(0), one step after the other."""
    old = [float(x) for x in rng.integers(0, 9, size=3)]
    rewards = [float(x) for x in rng.integers(-3, 10, size=3)]
    rate, discount = float(rng.choice([0.5, 0.1])), float(rng.choice([1.0, 0.5]))
    values = [*old, 0.0]
    inspect.unwrap(mdp.td_prediction)(
        Episode([0, 1, 2, 3], rewards),
        lambda state: 0,
        values,
        [0, 0, 0, 0],
        1,
        discount=discount,
        learning_rate=lambda visits: rate,
    )
    returns = mdp.discounted_return(rewards, discount)
    backwards = [*old, 0.0]
    for k in (2, 1, 0):
        target = rewards[k] + discount * backwards[k + 1]
        backwards[k] += rate * (target - backwards[k])
    whole = [r + discount * v for r, v in zip(rewards, [*old[1:], 0.0], strict=True)]
    return Question(
        f"The values of A, B and C are ${old[0]:g}$, ${old[1]:g}$ and ${old[2]:g}$. An episode goes from A to B to C "
        f"and ends, with the rewards ${rewards[0]:g}$, ${rewards[1]:g}$ and ${rewards[2]:g}$. Which values does TD(0) "
        f"give, which updates after each step, with $\\alpha = {rate:g}$ and $\\gamma = {discount:g}$?",
        Table(
            ["value"],
            ["A", "B", "C"],
            [values[:3]],
            wrong={
                "These are targets. A value moves towards its target by the part $\\alpha$ only.": [
                    whole
                ],
                "These updates begin at the end. TD(0) updates A when B still has its old value.": [
                    backwards[:3]
                ],
                "These values move towards the returns, as those of Monte Carlo do.": [
                    [
                        v + rate * (g - v)
                        for v, g in zip(old, returns.tolist(), strict=True)
                    ]
                ],
            },
        ),
        "Each target is the reward plus the discounted old value of the next state; the end has the value 0. The "
        f"targets are ${whole[0]:g}$, ${whole[1]:g}$ and ${whole[2]:g}$, so the values become ${values[0]:.4g}$, "
        f"${values[1]:.4g}$ and ${values[2]:.4g}$.",
    )
