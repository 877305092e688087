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


@drill("model-free-learning", "Along the edge of a cliff")
def along_the_edge(rng: Rng) -> Question:
    """Compute how often an exploring robot falls where the greedy path runs along a cliff."""
    epsilon = float(rng.choice([0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4]))
    length, actions = int(rng.integers(3, 16)), int(rng.choice([4, 8]))
    policy = mdp.exploration.epsilon_greedy(np.eye(actions)[0], epsilon)
    down = float(policy[2])
    # state 0 is on the way and state 1 over the edge, where the episode ends; the reward counts falls
    model = mdp.FiniteMDP([[[1 - down, down], [0, 1]]], [[down], [0]], discount=1)
    answer = float(mdp.finite_horizon_evaluation(model, [0, 0], length)[0])
    return Question(
        f"A robot that learns goes {length} steps along a cliff. In each it takes the greedy action with probability "
        f"$1 - \\varepsilon$ and otherwise any of its {actions} actions with equal probability, and $\\varepsilon = "
        f"{epsilon:g}$. One of the {actions} leads over the edge. Assume that it makes no other detours. "
        "With which probability does it fall on the way?",
        Number(
            answer,
            wrong={
                f"Only one of the {actions} actions that are drawn at random leads over the edge.": 1
                - (1 - epsilon) ** length,
                "It can fall only once: the probability is not the sum over the steps.": down
                * length,
                "This is the probability that it does not fall.": 1 - answer,
                "This is the probability for one step.": down,
            },
        ),
        f"In each step it falls with probability ${epsilon:g} / {actions} = {down:.4g}$, so it arrives with "
        f"$(1 - {down:.4g})^{{{length}}} = {1 - answer:.4g}$. SARSA learns from these falls and keeps away from the "
        f"edge; Q-learning values "
        "the greedy path and goes along it.",
    )


@drill("model-free-learning", "Weights of features in place of a table")
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
