"""Drills of the page on feature expectations."""

from __future__ import annotations

import numpy as np

from robonav import nirl

from ..question import Number, Question, Table
from ..registry import drill
from ..text import terms

Rng = np.random.Generator


@drill("feature-expectations", "Feature expectations of one trajectory")
def of_one_trajectory(rng: Rng) -> Question:
    """Discount the features of a trajectory and add them up."""
    features = rng.integers(0, 2, size=(3, 2)).astype(float)
    discount = float(rng.choice([0.5, 0.8, 0.9]))
    mu = nirl.empirical_expectations(features, [0, 0, 0], discount)
    plain, late = features.sum(axis=0), discount * mu
    shown = ", ".join(f"({a:g}, {b:g})" for a, b in features)
    powers = discount ** np.arange(3)
    return Question(
        f"The three steps of a trajectory have the features {shown}. What are its feature expectations with "
        f"$\\gamma = {discount:g}$?",
        Table(
            ["$\\mu$"],
            ["feature 1", "feature 2"],
            [mu.tolist()],
            wrong={
                "The discount is missing.": [plain.tolist()],
                "The first step is not discounted.": [late.tolist()],
                "This is a mean. Feature expectations are a discounted sum.": [
                    (plain / 3).tolist()
                ],
            },
        ),
        f"Feature 1: ${terms(features[:, 0], powers)} = {mu[0]:.4g}$. "
        f"Feature 2: ${terms(features[:, 1], powers)} = {mu[1]:.4g}$.",
    )


@drill("feature-expectations", "The mean over demonstrations")
def of_two_trajectories(rng: Rng) -> Question:
    """Estimate feature expectations from two demonstrations."""
    lengths = rng.choice([1, 2, 3], size=2, replace=False)
    feature = rng.integers(0, 3, size=int(lengths.sum())).astype(float)
    discount = float(rng.choice([0.5, 0.8]))
    trajectory = np.repeat([0, 1], lengths)
    answer = float(
        nirl.empirical_expectations(feature[:, None], trajectory, discount)[0]
    )
    parts = np.split(feature, [lengths[0]])
    sums = [float(part @ discount ** np.arange(len(part))) for part in parts]
    shown = [", ".join(f"{f:g}" for f in part) for part in parts]
    return Question(
        f"One feature. The first demonstration has ${shown[0]}$ in its steps, the second "
        f"${shown[1]}$. What is the estimate "
        f"of $\\mu_E$ with $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "This is the sum over both demonstrations. The estimate is their mean.": sum(
                    sums
                ),
                "The discount starts again in each demonstration.": float(
                    feature @ discount ** np.arange(len(feature))
                )
                / 2,
                "Divide by the number of demonstrations, not of steps.": sum(sums)
                / len(feature),
                "The discount is missing.": float(feature.sum()) / 2,
            },
        ),
        f"The discounted sums are ${sums[0]:.4g}$ and ${sums[1]:.4g}$, and their mean is ${answer:.4g}$.",
    )


@drill("feature-expectations", "The value of a policy from its features")
def value_of_features(rng: Rng) -> Question:
    """Compute a value from a reward's weights."""
    theta = rng.choice([-2.0, -1.0, -0.5, 0.5, 1.0, 2.0], size=2)
    mu = np.round(rng.uniform(0, 5, size=2), 1)
    value = float(nirl.value_of_expectations(theta, mu))
    return Question(
        f"A policy has the feature expectations $({mu[0]:g}, {mu[1]:g})$. What is its value under the "
        f"reward with the "
        f"weights $({theta[0]:g}, {theta[1]:g})$?",
        Number(
            value,
            wrong={
                "The weights are missing.": float(mu.sum()),
                "The weights belong to the other feature each.": float(
                    theta[::-1] @ mu
                ),
                "The signs of the weights count.": float(abs(theta) @ mu),
            },
        ),
        f"$\\theta \\cdot \\mu = {theta[0]:g} \\cdot {mu[0]:g} + ({theta[1]:g}) \\cdot {mu[1]:g} = {value:.4g}$.",
    )


@drill("feature-expectations", "Refine contradictory demonstrations")
def refined(rng: Rng) -> Question | None:
    """Count which action a state keeps under two priors."""
    left_here, right_here = (
        int(n) for n in rng.choice([2, 3, 4, 5, 6], size=2, replace=False)
    )
    left_there, right_there = (int(n) for n in rng.integers(0, 40, size=2))
    if left_here * right_there == right_here * left_there:
        return None  # P(s | a) is the same for both
    states = [0] * (left_here + right_here) + [1] * (left_there + right_there)
    actions = [0] * left_here + [1] * right_here + [0] * left_there + [1] * right_there
    frequent = int(nirl.most_frequent(states, actions, 2).actions[0])
    uniform = int(nirl.map_uniform_prior(states, actions, 2).actions[0])
    answer = [[frequent], [uniform]]
    share = [
        left_here / (left_here + left_there),
        right_here / (right_here + right_there),
    ]
    return Question(
        f"In the state s the expert went left {left_here} times and right {right_here} times; in all "
        f"other states it went "
        f"left {left_there} times and right {right_there} times. Which action does s keep: 0 (left) "
        f"or 1 (right)? Answer "
        "for Eq. (5.12), which makes $P(s | a) P(a)$ as large as possible with counted shares, and for a uniform prior "
        "$P(a)$.",
        Table(
            ["Eq. (5.12)", "uniform prior"],
            ["action"],
            answer,
            tolerance=0.1,
            wrong={
                "With a uniform prior the likelihoods $P(s | a)$ decide, not the counts.": [
                    [frequent],
                    [1 - uniform],
                ],
                "With the prior of Eq. (5.12) the most frequent action in the state wins.": [
                    [1 - frequent],
                    [uniform],
                ],
                "The two are exchanged, or the two actions.": [
                    [1 - frequent],
                    [1 - uniform],
                ],
            },
        ),
        f"Eq. (5.12) keeps the most frequent action in s, {'left' if frequent == 0 else 'right'}. "
        f"With a uniform prior "
        f"$P(s | \\text{{left}}) = {share[0]:.3g}$ and $P(s | \\text{{right}}) = {share[1]:.3g}$ decide: "
        f"{'left' if uniform == 0 else 'right'}.",
    )
