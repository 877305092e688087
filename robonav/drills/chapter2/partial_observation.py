"""Drills of the page on partial observation."""

from __future__ import annotations

import numpy as np

from robonav import mdp

from ..question import Number, Question, Table
from ..registry import drill

Rng = np.random.Generator


@drill("partial-observation", "A belief after one observation")
def belief_after_observation(rng: Rng) -> Question:
    """Apply Bayes' rule to a belief over three places."""
    belief = rng.permutation([0.2, 0.3, 0.5])
    door = rng.permutation([0.1, 0.4, 0.8])
    posterior, probability = mdp.bayes(belief, door)
    joint = belief * door
    return Question(
        "A robot believes itself in A, B or C with the probabilities "
        f"${', '.join(f'{b:g}' for b in belief)}$. Its sensor reports a door with probability "
        f"${', '.join(f'{d:g}' for d in door)}$ in A, B and C. It reports a door. What does the robot believe now?",
        Table(
            ["belief"],
            ["A", "B", "C"],
            [posterior.tolist()],
            wrong={
                "These products do not sum to 1. Divide them by their sum.": [
                    joint.tolist()
                ],
                "The old belief is missing: these are the sensor's probabilities alone.": [
                    (door / door.sum()).tolist()
                ],
                "These are the probabilities if the sensor had reported no door.": [
                    (belief * (1 - door) / (belief * (1 - door)).sum()).tolist()
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
    moves = float(rng.choice([0.7, 0.8, 0.9]))
    belief = rng.permutation([0.1, 0.3, 0.6])
    right = [[1 - moves, moves, 0], [0, 1 - moves, moves], [0, 0, 1]]
    model = mdp.FiniteMDP([right], np.zeros((3, 1)), 0.9)
    pomdp = mdp.POMDP(model, np.ones((1, 3, 1)))
    predicted = pomdp.predict(belief, 0)
    always = [0, belief[0], belief[1] + belief[2]]
    left_alone = [(1 - moves) * belief[0], (1 - moves) * belief[1], belief[2]]
    return Question(
        "Three places A, B and C lie in a row. The action right goes one place on with probability "
        f"${moves:g}$, and otherwise the robot stays; in C it always stays. It believes itself there with the "
        f"probabilities ${', '.join(f'{b:g}' for b in belief)}$. What does it believe after the action, before it "
        "observes anything?",
        Table(
            ["belief"],
            ["A", "B", "C"],
            [predicted.tolist()],
            wrong={
                "The action may fail, too: the robot can still be where it was.": [
                    always
                ],
                "The ways from the left into a place are missing: these numbers do not sum to 1.": [
                    left_alone
                ],
                "An action changes the belief even without an observation.": [
                    belief.tolist()
                ],
            },
        ),
        f"$b'(A) = {1 - moves:.2g} \\cdot {belief[0]:g} = {predicted[0]:.4g}$; "
        f"$b'(B) = {moves:g} \\cdot {belief[0]:g} + {1 - moves:.2g} \\cdot {belief[1]:g} = {predicted[1]:.4g}$; "
        f"$b'(C)$ is the rest, ${predicted[2]:.4g}$.",
    )


@drill("partial-observation", "How probable is an observation?")
def probability_of_observation(rng: Rng) -> Question:
    """Compute the probability of an observation from a belief."""
    left, accuracy = (
        float(rng.choice([0.3, 0.6, 0.7, 0.9])),
        float(rng.choice([0.8, 0.85])),
    )
    pomdp = mdp.tiger(accuracy=accuracy)
    heard = float(pomdp.observation_probabilities([left, 1 - left], action=0)[0])
    return Question(
        f"The tiger is behind the left door with probability ${left:g}$. Listening reports the right side with "
        f"probability ${accuracy:g}$. How probable is it that the next report says left?",
        Number(
            heard,
            wrong={
                "The report may err, too: it also says left if the tiger is on the right and the report is wrong.": left
                * accuracy,
                "This is the belief itself. The report is not always right.": left,
                "This holds if the tiger is surely on the left.": accuracy,
                "This is the probability that the report says right.": 1 - heard,
            },
        ),
        f"${left:g} \\cdot {accuracy:g} + {1 - left:.2g} \\cdot {1 - accuracy:.2g} = {heard:.4g}$.",
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
        "robot could look which state it is. How much is that look worth?",
        Number(
            known - now,
            wrong={
                "This is what it earns if it knows the state. Subtract what it earns without the look.": known,
                "This is what it earns without the look.": now,
                "Without the look it takes the better action, not any.": known
                - float(each.mean()),
            },
        ),
        f"Without the look a earns ${each[0]:.4g}$ and b ${each[1]:.4g}$, so it earns ${now:.4g}$. "
        f"With it the robot takes "
        f"the better action of each state: ${belief:g} \\cdot {rewards[:, 0].max():g} + {1 - belief:.2g} \\cdot "
        f"({rewards[:, 1].max():g}) = {known:.4g}$. The difference is ${known - now:.4g}$. A planner "
        f"that assumes that the "
        "state will be known anyhow gives such a look no value.",
    )
