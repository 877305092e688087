"""Drills of the page on learning without a model."""

from __future__ import annotations

import inspect

import numpy as np

from robonav import mdp

from ..question import Number, Question, Table
from ..registry import drill
from ..scripted import Episode, Numbers
from ..text import sign, terms

Rng = np.random.Generator


@drill("model-free-learning", "One step of TD(0)")
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


def _updated(learner: str, q: list[list[float]], number: float, **step: float) -> float:
    """Q(s, a) after one step from state 0 by action 0 to state 1, where the learner explores with ``number``."""
    table = [row.copy() for row in q]
    inspect.unwrap(getattr(mdp, learner))(
        Episode([0, 1], [step["reward"]], terminated=False),
        table,
        [[0, 0], [0, 0]],
        1,
        discount=step["discount"],
        learning_rate=lambda visits: step["rate"],
        epsilon=lambda episode: 1.0,
        rng=Numbers([0.0, 0.0, 0.0, number]),
    )
    return table[0][0]


@drill("model-free-learning", "The same step, SARSA and Q-learning")
def sarsa_and_q_learning(rng: Rng) -> Question:
    """Compute both updates of one step."""
    q = np.round(rng.uniform(-1, 6, size=(2, 2)), 1).tolist()
    reward, discount = float(rng.integers(-1, 4)), float(rng.choice([0.5, 0.8, 0.9]))
    rate = float(rng.choice([0.1, 0.5]))
    worse = int(np.argmin(q[1]))  # the next action explores
    step = {"reward": reward, "discount": discount, "rate": rate}
    sarsa, best = (
        _updated(name, q, worse / 2, **step) for name in ("sarsa", "q_learning")
    )
    name = "ab"[worse]
    old, largest = q[0][0], max(q[1])
    return Question(
        f"In $s$ the robot takes action a, gets the reward ${reward:g}$ and reaches $s'$, where it explores with "
        f"action {name}. $Q(s, a) = {old:g}$, $Q(s', a) = {q[1][0]:g}$ and $Q(s', b) = {q[1][1]:g}$. "
        f"Which $Q(s, a)$ does each learner have after this step, with $\\gamma = {discount:g}$ and "
        f"$\\alpha = {rate:g}$?",
        Table(
            ["SARSA", "Q-learning"],
            ["new Q(s, a)"],
            [[sarsa], [best]],
            wrong={
                "The two are exchanged: SARSA uses the action that is taken, Q-learning the best one.": [
                    [best],
                    [sarsa],
                ],
                "Both use the best action here. SARSA uses the action that is taken.": [
                    [best],
                    [best],
                ],
                "Both use the action that is taken here. Q-learning uses the best one.": [
                    [sarsa],
                    [sarsa],
                ],
            },
        ),
        f"SARSA: ${old:g} + {rate:g} \\, ({reward:g} {sign(discount * q[1][worse])} {sign(-old)}) = {sarsa:.4g}$. "
        f"Q-learning: ${old:g} + {rate:g} \\, ({reward:g} {sign(discount * largest)} {sign(-old)}) = {best:.4g}$.",
    )


@drill("model-free-learning", "What Monte Carlo averages")
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


@drill("model-free-learning", "Probabilities of an epsilon-greedy policy")
def epsilon_greedy(rng: Rng) -> Question:
    """Compute how probable each action is."""
    q = rng.choice(50, size=int(rng.choice([2, 3, 4])), replace=False) / 10
    epsilon = float(rng.choice([0.1, 0.2, 0.4]))
    probabilities = mdp.epsilon_greedy(q[None], epsilon)[0]
    best, count = int(q.argmax()), len(q)
    names = [f"action {letter}" for letter in "abcd"[:count]]
    without_best = np.full(count, epsilon / (count - 1))
    without_best[best] = 1 - epsilon
    all_of_it = np.full(count, epsilon)
    all_of_it[best] = 1 - epsilon
    wrong = {
        "With probability $\\epsilon$ any action is drawn, the greedy one too.": [
            without_best.tolist()
        ],
    }
    if count > 2:
        wrong["The probability $\\epsilon$ is shared among all actions."] = [
            all_of_it.tolist()
        ]
    return Question(
        f"In a state the action values are ${', '.join(f'{value:g}' for value in q)}$ (actions "
        f"{', '.join('abcd'[:count])}). How probable is each action with $\\epsilon = {epsilon:g}$?",
        Table(["probability"], names, [probabilities.tolist()], wrong=wrong),
        f"Each action has at least $\\epsilon / {count} = {epsilon / count:.4g}$. The greedy action "
        f"{'abcd'[best]} has $1 - \\epsilon$ more: {probabilities[best]:.4g}.",
    )
