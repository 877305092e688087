"""Drills of the page on learning to act without a model."""

from __future__ import annotations

import inspect

import numpy as np

from robonav import mdp

from ..question import Number, Question, Table
from ..registry import drill
from ..scripted import Episode, Numbers
from ..text import sign

Rng = np.random.Generator


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
        f"$(1 - {down:.4g})^{{{length}}} = {1 - answer:.4g}$, and falls with ${answer:.4g}$. SARSA learns from these "
        "falls and keeps away from the edge; Q-learning values the greedy path and goes along it.",
    )


@drill("model-free-learning", "The target of expected SARSA")
def target_of_expected_sarsa(rng: Rng) -> Question:
    """Compute a target that takes the mean over the next action."""
    values = rng.choice(np.arange(-2, 10), size=3, replace=False).astype(float)
    reward, discount = float(rng.integers(-3, 4)), float(rng.choice([0.5, 0.8, 0.9]))
    epsilon = float(rng.choice([0.1, 0.2, 0.3, 0.4]))
    expected = float(mdp.epsilon_greedy(values[None], epsilon)[0] @ values)
    best, mean = float(values.max()), float(values.mean())
    answer = reward + discount * expected
    rest = float(values.sum() - best)
    return Question(
        f"A step has the reward ${reward:g}$, and in the next state the three actions have the values ${values[0]:g}$, "
        f"${values[1]:g}$ and ${values[2]:g}$. What is the target of expected SARSA, with $\\varepsilon = {epsilon:g}$ "
        f"and $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "This is the target of Q-learning, which takes the best value.": reward
                + discount * best,
                "Here all actions have the same probability. The best one has more.": reward
                + discount * mean,
                "An action drawn at random may be the best one, too.": reward
                + discount * ((1 - epsilon) * best + epsilon * rest / 2),
                "The discount is missing.": reward + expected,
            },
        ),
        f"The best value has the weight ${1 - epsilon:g}$, and the mean of all three, ${mean:.4g}$, the weight "
        f"${epsilon:g}$: together ${expected:.4g}$. So the target is ${reward:g} {sign(discount * expected)} = "
        f"{answer:.4g}$.",
    )
