"""Drills of the page on the most random policy."""

from __future__ import annotations

import numpy as np

from robonav import nirl

from ..question import Number, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator


@drill("maximum-entropy", "The soft maximum")
def soft_maximum_of_values(rng: Rng) -> Question:
    """Compute the soft maximum of two action values."""
    q = rng.choice(np.arange(0, 31), size=2, replace=False) / 10
    temperature = float(rng.choice([0.5, 1.0, 2.0]))
    answer = float(nirl.soft_maximum(q, temperature))
    scaled = np.exp(q / temperature)
    share = scaled / scaled.sum()
    wrong = {
        "This is the maximum. The soft maximum is larger, and tends to it as $T$ falls to 0.": float(
            q.max()
        ),
        "This is the mean under the softmax policy. The entropy of the policy is missing.": float(
            share @ q
        ),
        "The logarithm is missing.": float(temperature * scaled.sum()),
    }
    if temperature != 1:
        wrong[
            "Each exponential must be of $Q / T$, and the logarithm is multiplied by $T$."
        ] = float(np.log(np.exp(q).sum()))
    return Question(
        f"Two actions have the values ${q[0]:g}$ and ${q[1]:g}$. What is the soft maximum at the temperature "
        f"$T = {temperature:g}$?",
        Number(answer, wrong=wrong),
        f"$T \\ln(e^{{{q[0]:g} / {temperature:g}}} + e^{{{q[1]:g} / {temperature:g}}}) = {temperature:g} "
        f"\\ln({scaled[0]:.4g} + {scaled[1]:.4g}) = {answer:.4g}$. It lies at most $T \\ln 2 = "
        f"{temperature * np.log(2):.4g}$ above the maximum.",
    )


@drill("maximum-entropy", "From a share to a weight")
def weight_of_share(rng: Rng) -> Question:
    """Find the weight with which the most random policy has the expert's share."""
    first, second = (float(f) for f in rng.choice(np.arange(0, 6), size=2, replace=False))  # fmt: skip
    share = int(rng.choice([60, 65, 70, 75, 80, 85, 90, 95])) / 100
    odds = float(np.log(share / (1 - share)))
    answer = odds / (first - second)
    return Question(
        f"In one state two actions have the features $f_1 = {first:g}$ and $f_2 = {second:g}$. The expert takes the "
        f"first in ${100 * share:g}$ % of its decisions. Which weight $\\theta$ does maximum entropy find?",
        Number(
            answer,
            wrong={
                "The sign is wrong: the action that the expert prefers needs the larger "
                "$\\theta f$.": -answer,
                "The weight multiplies the difference of the features. Divide by it.": odds,
                "The ratio of the two probabilities decides, not the probability alone.": float(
                    np.log(share)
                )
                / (first - second),
            },
        ),
        f"$p_1 / p_2 = \\exp(\\theta (f_1 - f_2))$, so $\\theta = \\ln({share:g} / {1 - share:.2g}) / "
        f"({first:g} {sign(-second)}) = {answer:.4g}$.",
    )


@drill("maximum-entropy", "Importance weights")
def importance_weights(rng: Rng) -> Question:
    """Weight sampled trajectories by the reward."""
    features = rng.choice(np.arange(0, 6), size=3, replace=False).astype(float)
    base = int(rng.choice([2, 3]))
    weights = nirl.importance_weights([np.log(base)], features[:, None], np.zeros(3))
    powers = base**features
    return Question(
        f"Three trajectories were sampled with the baseline policy. Their discounted features are "
        f"${', '.join(f'{f:g}' for f in features)}$. What are their importance weights at "
        f"$\\theta = \\ln {base}$?",
        Table(
            ["weight"],
            ["first", "second", "third"],
            [weights.tolist()],
            wrong={
                "Equal weights do not depend on $\\theta$: the factor $\\exp(\\theta f)$ has cancelled.": [
                    [1 / 3] * 3
                ],
                "These factors do not sum to 1. Divide them by their sum.": [
                    powers.tolist()
                ],
                "The weights are proportional to $\\exp(\\theta f)$, not to $f$.": [
                    (features / features.sum()).tolist()
                ],
                "The larger the reward is, the larger is the weight. Here the sign is wrong.": [
                    ((1 / powers) / (1 / powers).sum()).tolist()
                ],
            },
        ),
        f"$\\exp(\\theta f) = {base}^f$: ${', '.join(f'{p:g}' for p in powers)}$. Their sum is ${powers.sum():g}$, and "
        f"divided by it they are ${', '.join(f'{w:.4g}' for w in weights)}$.",
    )


@drill("maximum-entropy", "The gradient of relative entropy")
def gradient_of_the_dual(rng: Rng) -> Question:
    """Compute the gradient of the dual function at one reward."""
    features = rng.choice(np.arange(0, 4), size=2, replace=False).astype(float)
    base = int(rng.choice([2, 3, 4]))
    rising = bool(rng.integers(2))
    theta = float(np.log(base)) * (1 if rising else -1)
    expert = round(float(rng.uniform(features.min(), features.max())), 1)
    slack = float(rng.choice([0.05, 0.1]))
    given = ([theta], [expert], features[:, None], [0.0, 0.0])
    answer = float(nirl.dual_gradient(*given, [slack])[0])
    weights = nirl.importance_weights([theta], features[:, None], [0.0, 0.0])
    mean = float(weights @ features)
    pull = slack * float(np.sign(theta))
    shown = f"{'' if rising else '-'}\\ln {base}"
    return Question(
        f"The expert has the feature $\\mu_E = {expert:g}$. Two trajectories, sampled with the baseline policy, have "
        f"${features[0]:g}$ and ${features[1]:g}$. The slack is ${slack:g}$. The dual is "
        "$g(\\theta) = \\theta \\mu_E - \\ln \\sum_j e^{\\theta f_j} - \\epsilon |\\theta|$ with the samples' features "
        f"$f_j$ and the slack $\\epsilon$. What is its gradient at $\\theta = {shown}$?",
        Number(
            answer,
            wrong={
                "The samples have equal weights here. They depend on $\\theta$.": expert
                - float(features.mean())
                - pull,
                "The slack is missing.": expert - mean,
                "The slack pulls $\\theta$ towards 0: its sign is that of $-\\theta$.": expert
                - mean
                + pull,
                "This is the samples' mean minus the expert's feature. It is the other way round.": mean
                - expert
                - pull,
            },
        ),
        f"The weights are ${weights[0]:.4g}$ and ${weights[1]:.4g}$, and the weighted mean is ${mean:.4g}$. "
        f"${expert:g} - {mean:.4g} {sign(-pull)} = {answer:.4g}$.",
    )
