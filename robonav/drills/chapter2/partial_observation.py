"""Drills of the page on partial observation."""

from __future__ import annotations

import numpy as np

from robonav import mdp

from ..question import Number, Question, Table
from ..registry import drill

Rng = np.random.Generator


def _belief(rng: Rng) -> np.ndarray:
    """Probabilities of three places, with one or two decimals."""
    parts = [[0.2, 0.3, 0.5], [0.1, 0.3, 0.6], [0.1, 0.2, 0.7], [0.15, 0.25, 0.6]]
    belief: np.ndarray = rng.permutation(parts[int(rng.integers(len(parts)))])
    return belief


@drill("partial-observation", "A belief after one observation")
def belief_after_observation(rng: Rng) -> Question:
    """Apply Bayes' rule to a belief over three places."""
    belief = _belief(rng)
    door = rng.choice([0.1, 0.2, 0.4, 0.5, 0.7, 0.8, 0.9], size=3, replace=False)
    seen = bool(rng.integers(2))
    report, other = (door, 1 - door) if seen else (1 - door, door)
    posterior, probability = mdp.bayes(belief, report)
    joint = belief * report
    return Question(
        "A robot believes that it is in A, B or C with the probabilities "
        f"${', '.join(f'{b:g}' for b in belief)}$. Its sensor reports a door with probability "
        f"${', '.join(f'{d:g}' for d in door)}$ in A, B and C. It reports {'a' if seen else 'no'} door. What does the "
        "robot believe now?",
        Table(
            ["belief"],
            ["A", "B", "C"],
            [posterior.tolist()],
            wrong={
                "These products do not sum to 1. Divide them by their sum.": [
                    joint.tolist()
                ],
                "The old belief is missing: these are the sensor's probabilities alone.": [
                    (report / report.sum()).tolist()
                ],
                f"These are the probabilities if the sensor had reported {'no' if seen else 'a'} door.": [
                    (belief * other / (belief * other).sum()).tolist()
                ],
            },
        ),
        f"The products are ${', '.join(f'{j:.4g}' for j in joint)}$. Their sum is "
        f"${probability:.4g}$, and divided by "
        f"it they are ${', '.join(f'{p:.4g}' for p in posterior)}$.",
    )


@drill("partial-observation", "A belief after one action")
def belief_after_action(rng: Rng) -> Question:
    """Predict a belief before the next observation."""
    moves = float(rng.choice([0.5, 0.6, 0.7, 0.8, 0.9]))
    belief = _belief(rng)
    to_right = bool(rng.integers(2))
    right = np.array([[1 - moves, moves, 0], [0, 1 - moves, moves], [0, 0, 1]])
    model = mdp.FiniteMDP(
        [right if to_right else right[::-1, ::-1]], np.zeros((3, 1)), 0.9
    )
    pomdp = mdp.POMDP(model, np.ones((1, 3, 1)))
    predicted = pomdp.predict(belief, 0)
    # along the way of the action: its first place, the middle, and the last, in which it stays
    first, middle, last = belief if to_right else belief[::-1]
    always = np.array([0, first, middle + last])
    left_alone = np.array([(1 - moves) * first, (1 - moves) * middle, last])
    if not to_right:
        always, left_alone = always[::-1], left_alone[::-1]
    way, ends, begins = ("right", "C", "A") if to_right else ("left", "A", "C")
    shown = predicted if to_right else predicted[::-1]
    return Question(
        f"Three places A, B and C lie in a row, from left to right. The action {way} goes one place on with "
        f"probability ${moves:g}$, and otherwise the robot stays; in {ends} it always stays. It believes that it "
        f"is in A, B or C with the probabilities ${', '.join(f'{b:g}' for b in belief)}$. What does it believe after "
        "the action, before it observes anything?",
        Table(
            ["belief"],
            ["A", "B", "C"],
            [predicted.tolist()],
            wrong={
                "The action may fail, too: the robot can still be where it was.": [
                    always.tolist()
                ],
                "The ways into a place from the one beside it are missing: these numbers do not sum to 1.": [
                    left_alone.tolist()
                ],
                "An action changes the belief even without an observation.": [
                    belief.tolist()
                ],
            },
        ),
        f"$b'({begins}) = {1 - moves:.2g} \\cdot {first:g} = {shown[0]:.4g}$; "
        f"$b'(B) = {moves:g} \\cdot {first:g} + {1 - moves:.2g} \\cdot {middle:g} = {shown[1]:.4g}$; "
        f"$b'({ends})$ is the rest, ${shown[2]:.4g}$.",
    )


@drill("partial-observation", "How probable is an observation?")
def probability_of_observation(rng: Rng) -> Question:
    """Compute the probability of an observation from a belief."""
    left = float(rng.integers(1, 20)) / 20
    accuracy = float(rng.choice([0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95]))
    pomdp = mdp.tiger(accuracy=accuracy)
    side = int(rng.integers(2))
    asked, opposite = (("left", "right"), ("right", "left"))[side]
    belief = [left, 1 - left]
    heard = float(pomdp.observation_probabilities(belief, action=0)[side])
    there = belief[side]
    return Question(
        f"The tiger is behind the left door with probability ${left:g}$, and otherwise behind the right one. Listening "
        f"reports the side where it is with probability ${accuracy:g}$, and otherwise the other side. How probable "
        f"is it that the next report says {asked}?",
        Number(
            heard,
            wrong={
                f"The report may err, too: it also says {asked} if the tiger is on the {opposite} and the report is "
                "wrong.": there * accuracy,
                "This is the belief itself. The report is not always right.": there,
                f"This holds if the tiger is surely on the {asked}.": accuracy,
                f"This is the probability that the report says {opposite}.": 1 - heard,
            },
        ),
        f"${there:g} \\cdot {accuracy:g} + {1 - there:.2g} \\cdot {1 - accuracy:.2g} = {heard:.4g}$.",
    )


@drill("partial-observation", "The value of a belief from alpha vectors")
def value_from_vectors(rng: Rng) -> Question:
    """Take the largest of the linear functions at a belief."""
    vectors = rng.integers(-5, 11, size=(3, 2)).astype(float)
    belief = float(rng.choice([0.1, 0.25, 0.4, 0.6, 0.75, 0.8]))
    point = np.array([belief, 1 - belief])
    value = float(mdp.AlphaVectors(vectors, np.arange(3)).value(point))
    products = vectors @ point
    shown = "; ".join(f"$({a:g}, {b:g})$" for a, b in vectors)
    return Question(
        f"Three alpha vectors of two states: {shown}. "
        f"What is the value of the belief $({belief:g}, {1 - belief:.2g})$?",
        Number(
            value,
            wrong={
                "This is the mean of the three. The value is the largest.": float(
                    products.mean()
                ),
                "This is the smallest of the three products. The value is the largest.": float(
                    products.min()
                ),
                "The best vector may not change with the state: first weight each vector by the belief, "
                "then take the largest.": float(vectors.max(axis=0) @ point),
                "The belief weights the states; this is the largest number of all vectors.": float(
                    vectors.max()
                ),
            },
        ),
        f"The products are ${', '.join(f'{p:.4g}' for p in products)}$, and the largest is ${value:.4g}$.",
    )


@drill("partial-observation", "What is it worth to know?")
def value_of_knowing(rng: Rng) -> Question:
    """Compute the value of information about a hidden state."""
    rewards = rng.integers(-10, 11, size=(2, 2)).astype(float)
    belief = float(rng.choice([0.2, 0.3, 0.4, 0.5, 0.6, 0.8]))
    vectors = mdp.AlphaVectors(rewards, np.arange(2))
    point = np.array([belief, 1 - belief])
    now = float(vectors.value(point))
    known = float(point @ [vectors.value([1, 0]), vectors.value([0, 1])])
    each = rewards @ point
    return Question(
        f"The state is L with probability ${belief:g}$, and otherwise R. The action a gives "
        f"${rewards[0, 0]:g}$ in L and "
        f"${rewards[0, 1]:g}$ in R; b gives ${rewards[1, 0]:g}$ in L and ${rewards[1, 1]:g}$ in R. Before it acts, the "
        "robot could look and find out the state. How much is that look worth?",
        Number(
            known - now,
            wrong={
                "This is what it earns if it knows the state. Subtract what it earns without the look.": known,
                "This is what it earns without the look.": now,
                "Without the look it takes the better of the two actions, not one of them at random.": known
                - float(each.mean()),
            },
        ),
        f"Without the look a earns ${each[0]:.4g}$ and b ${each[1]:.4g}$, so it earns ${now:.4g}$. "
        f"With it the robot takes "
        f"the better action of each state: ${belief:g} \\cdot {rewards[:, 0].max():g} + {1 - belief:.2g} \\cdot "
        f"({rewards[:, 1].max():g}) = {known:.4g}$. The difference is ${known - now:.4g}$. A planner "
        f"that assumes that the "
        "state will be known anyway gives such a look no value.",
    )
