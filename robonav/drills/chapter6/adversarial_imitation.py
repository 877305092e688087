"""Drills of the page on generative adversarial imitation."""

from __future__ import annotations

import math

import numpy as np
import torch

from robonav.deep import (
    best_discriminator,
    deceiving_reward,
    discriminator_loss,
    hurrying_reward,
    log_odds,
)

from ..question import Choice, Number, Question, Table
from ..registry import drill

Rng = np.random.Generator
PAGE = "adversarial-imitation"


def _logits(*probabilities: float) -> torch.Tensor:
    """The logits of which these probabilities D are the sigmoids."""
    return torch.tensor(probabilities, dtype=torch.float64).logit()


@drill(PAGE, "The best discriminator")
def best_judge(rng: Rng) -> Question:
    """Compute the best D from how often learner and expert make a pair."""
    learner, expert = (
        int(n) for n in rng.choice(np.arange(5, 61, 5), 2, replace=False)
    )
    answer = float(best_discriminator(learner, expert))
    return Question(
        f"Of 100 steps of the learner, {learner} are a certain pair of state and action. Of 100 steps of the expert, "
        f"{expert} are this pair. $D(s, a)$ is the probability that the pair is the learner's. Which $D(s, a)$ makes "
        "the discriminator's cost as small as it can be?",
        Number(
            answer,
            wrong={
                "$D$ is the probability that the pair is the learner's, not the expert's.": 1
                - answer,
                "This is how often the learner makes the pair. Compare it with the expert.": learner
                / 100,
                "Divide by the sum of both, not by the other one.": learner / expert,
            },
        ),
        f"$D = p / (p + q) = {learner} / ({learner} + {expert}) = {answer:.4g}$.",
    )


@drill(PAGE, "Three rewards of a pair")
def rewards_of_a_pair(rng: Rng) -> Question:
    """Compute the reward of a pair from what the discriminator says, in three ways."""
    d = float(rng.choice(np.arange(10, 191))) / 200
    logit = _logits(d)
    answer = [f(logit).item() for f in (deceiving_reward, hurrying_reward, log_odds)]
    return Question(
        f"The discriminator gives a pair the probability $D = {d:g}$ to be the learner's. Compute its three rewards "
        "with natural logarithms.",
        Table(
            rows=("reward",),
            columns=("$-\\log D$", "$\\log(1 - D)$", "$\\log(1 - D) - \\log D$"),
            answer=[answer],
            wrong={
                "$D$ is the probability that the pair is the learner's; here it stands for the expert's.": [
                    [-math.log(1 - d), math.log(d), math.log(d) - math.log(1 - d)]
                ],
                "The logarithms are natural ones, to the base $e$.": [
                    [x / math.log(10) for x in answer]
                ],
            },
        ),
        f"$-\\log {d:g} = {answer[0]:.4g}$ and $\\log {1 - d:g} = {answer[1]:.4g}$. The third is their sum, "
        f"${answer[2]:.4g}$.",
    )


@drill(PAGE, "The cost of the discriminator")
def cost_of_the_judge(rng: Rng) -> Question:
    """Compute the discriminator's cost for one pair of each."""
    own, expert = (
        float(x) / 100 for x in rng.choice(np.arange(10, 95, 5), 2, replace=False)
    )
    yes = torch.tensor([True])
    answer = discriminator_loss(_logits(own), _logits(expert), yes).item()
    swapped = discriminator_loss(_logits(expert), _logits(own), yes).item()
    return Question(
        f"The discriminator gives $D = {own:g}$ for a pair of the learner, and $D = {expert:g}$ for a pair of the "
        "expert. $D$ is the probability that a pair is the learner's. What is the discriminator's cost for these two? "
        "Use natural logarithms.",
        Number(
            answer,
            wrong={
                "For the expert's pair $1 - D$ counts.": -math.log(own)
                - math.log(expert),
                "$D$ should be near 1 for the learner's pair and near 0 for the expert's, not the other way round.": (
                    swapped
                ),
                "The cost of the expert's pair is missing.": -math.log(own),
            },
        ),
        f"$-\\log {own:g} - \\log(1 - {expert:g}) = {-math.log(own):.4g} + {-math.log(1 - expert):.4g} "
        f"= {answer:.4g}$.",
    )


LONGER, SHORTER = "The longer episode", "The shorter episode"


@drill(PAGE, "Stay or end?")
def stay_or_end(rng: Rng) -> Question:
    """Say whether a reward makes a robot that the discriminator cannot tell prefer long or short episodes."""
    d = float(rng.choice([0.3, 0.4, 0.45, 0.5, 0.55, 0.6, 0.7]))
    short = int(rng.choice([10, 15, 20, 30, 40]))
    long = short * int(rng.choice([2, 3, 5]))
    name, reward = (
        ("-\\log D", deceiving_reward),
        ("\\log(1 - D)", hurrying_reward),
    )[int(rng.integers(2))]
    each = reward(_logits(d)).item()
    right = LONGER if long * each > short * each else SHORTER
    other = SHORTER if right == LONGER else LONGER
    return Question(
        f"The discriminator gives every pair $D = {d:g}$, and the reward is ${name}$. One episode ends after {short} "
        f"steps, another after {long}. Without a discount, which of them has the larger return?",
        Choice(
            right,
            {
                other: f"Each step earns ${each:.3g}$. Multiply it by the number of steps, and look at its sign.",
                "Neither: the discriminator says the same of both": (
                    "It says the same of each step. But the two episodes have different numbers of steps."
                ),
            },
        ),
        f"Each step earns ${each:.3g}$, so the returns are ${long} \\cdot {_factor(each)} = {long * each:.3g}$ and "
        f"${short} \\cdot {_factor(each)} = {short * each:.3g}$.",
    )


def _factor(number: float) -> str:
    """A number as a factor in a formula."""
    return f"({number:.3g})" if number < 0 else f"{number:.3g}"
