"""Drills of the page on NIRL in practice."""

from __future__ import annotations

import numpy as np

from robonav import nirl
from robonav.networks import random_network

from ..question import Choice, Number, Question, Table
from ..registry import drill

Rng = np.random.Generator


@drill("nirl-in-practice", "Plain and balanced accuracy")
def two_accuracies(rng: Rng) -> Question:
    """Compute both accuracies from a confusion matrix."""
    often, seldom = int(rng.choice([40, 50, 60, 80, 90])), int(rng.choice([5, 8, 10, 20]))  # fmt: skip
    hit_often = int(often * rng.uniform(0.7, 1.0))
    hit_seldom = int(seldom * rng.uniform(0.0, 0.8))
    own = np.repeat([0, 1], [often, seldom])
    predicted = np.concatenate(
        [
            np.repeat([0, 1], [hit_often, often - hit_often]),
            np.repeat([1, 0], [hit_seldom, seldom - hit_seldom]),
        ]
    )
    plain = float(nirl.accuracy(predicted, own))
    balanced = float(nirl.balanced_accuracy(predicted, own))
    return Question(
        f"The expert took F in {often} decisions and L30 in {seldom}. A policy predicts {hit_often} of the F and "
        f"{hit_seldom} of the L30. What are its accuracy and its balanced accuracy, from 0 to 1?",
        Table(
            ["value"],
            ["accuracy", "balanced accuracy"],
            [[plain, balanced]],
            wrong={
                "The two are exchanged: the balanced accuracy is the mean of the two actions' shares.": [
                    [balanced, plain]
                ],
                "The balanced accuracy gives both actions the same weight.": [
                    [plain, plain]
                ],
                "The accuracy counts decisions, not actions.": [[balanced, balanced]],
            },
        ),
        f"Accuracy: $({hit_often} + {hit_seldom}) / {often + seldom} = {plain:.4g}$. Balanced: "
        f"$({hit_often / often:.3g} + {hit_seldom / seldom:.3g}) / 2 = {balanced:.4g}$.",
    )


@drill("nirl-in-practice", "How often is a decision learned?")
def draws_of_a_decision(rng: Rng) -> Question:
    """Count how often a decision is drawn while it is in the memory."""
    added = int(
        rng.choice([100, 120, 150, 160, 200, 240, 250, 300, 320, 400, 480, 600])
    )
    kept = int(rng.choice([5, 10, 20, 40]))
    draws = int(rng.choice([1200, 2400, 4800, 9600]))
    answer = kept * draws / (kept * added)
    return Question(
        f"Each iteration adds ${added}$ decisions to the memory, which keeps those of the last ${kept}$ iterations. "
        f"It then draws ${draws}$ decisions from the memory, with equal probability. The memory is full. How often is "
        "a decision drawn on average, before it is forgotten?",
        Number(
            answer,
            wrong={
                "This is how often it is drawn in one iteration. It stays in the memory longer.": draws
                / (kept * added),
                "The memory holds the decisions of all the iterations that it keeps, not of one.": kept
                * draws
                / added,
                "It is the other way round: draws for each decision.": added / draws,
            },
        ),
        f"The memory has ${kept} \\cdot {added} = {kept * added}$ decisions, so a decision is drawn "
        f"${draws} / {kept * added} = {draws / (kept * added):.4g}$ times an iteration, and it stays for ${kept}$ "
        f"iterations: ${answer:.4g}$ times. The length of the memory cancels.",
    )


@drill("nirl-in-practice", "Which policy does each measure keep?")
def kept_policy(rng: Rng) -> Question | None:
    """Choose a policy by accuracy and by balanced accuracy."""
    often, seldom = 80, 20
    shares = rng.integers([[50, 1], [50, 1]], [[81, 21], [81, 21]])
    own = np.repeat([0, 1], [often, seldom])
    scores = []
    for hit, hit_seldom in shares:
        counts = [hit, often - hit, hit_seldom, seldom - hit_seldom]
        predicted = np.repeat([0, 1, 1, 0], counts)
        scores.append(
            (nirl.accuracy(predicted, own), nirl.balanced_accuracy(predicted, own))
        )
    (a, a_balanced), (b, b_balanced) = scores
    if min(abs(a - b), abs(a_balanced - b_balanced)) < 0.02:
        return None
    if (a > b) == (a_balanced > b_balanced) and rng.random() < 0.6:
        return None  # the measures should disagree as often as not
    plain, balanced = "AB"[int(b > a)], "AB"[int(b_balanced > a_balanced)]
    named = {
        (p, q): f"accuracy keeps {p}, balanced accuracy {q}" for p in "AB" for q in "AB"
    }
    hints = {
        (
            True,
            False,
        ): "Accuracy is right. Balanced accuracy is the mean of the shares of the two actions.",
        (
            False,
            True,
        ): "Balanced accuracy is right. Accuracy counts all decisions that are predicted.",
        (
            False,
            False,
        ): "Neither is right. Accuracy counts decisions, balanced accuracy takes the mean of two shares.",
    }
    return Question(
        f"The expert took F in {often} decisions and L30 in {seldom}. Policy A predicts {shares[0, 0]} of the F and "
        f"{shares[0, 1]} of the L30, policy B {shares[1, 0]} and {shares[1, 1]}. Which policy does each measure keep?",
        Choice(
            named[plain, balanced],
            {
                text: hints[p == plain, q == balanced]
                for (p, q), text in named.items()
                if (p, q) != (plain, balanced)
            },
        ),
        f"Accuracy: {a:.3g} for A and {b:.3g} for B. Balanced accuracy: {a_balanced:.3g} for A and {b_balanced:.3g} "
        "for B.",
    )


@drill("nirl-in-practice", "Which weights change more?")
def change_of_each_weight(rng: Rng) -> Question:
    """Divide the change of a layer by its number of weights."""
    inputs, hidden = int(rng.integers(6, 19)), int(rng.integers(4, 17))
    outputs = int(rng.choice([5, 6]))
    sums = [float(n) for n in rng.choice([2, 3, 4, 5, 6, 8, 10, 12], size=2)]
    layers = random_network((inputs, hidden, outputs), seed=0)
    weights = [
        w.size + b.size for w, b in zip(layers.weights, layers.biases, strict=True)
    ]
    each = [1000 * s / n for s, n in zip(sums, weights, strict=True)]
    bare = [inputs * hidden, hidden * outputs]
    return Question(
        f"A network has {inputs} inputs, {hidden} hidden units and {outputs} outputs, with biases in both layers. In "
        f"an iteration the absolute changes of all weights and biases sum to ${sums[0]:g}$ in the first layer and to "
        f"${sums[1]:g}$ in the second. By how many thousandths does each weight change on average?",
        Table(
            ["thousandths"],
            ["first layer", "second layer"],
            [each],
            tolerance=0.06,
            wrong={
                "The biases are missing: each unit has one more weight than it has inputs.": [
                    [1000 * s / n for s, n in zip(sums, bare, strict=True)]
                ],
                "The two layers are exchanged.": [
                    [1000 * sums[0] / weights[1], 1000 * sums[1] / weights[0]]
                ],
            },
        ),
        f"The layers have ${hidden} \\cdot ({inputs} + 1) = {weights[0]}$ and "
        f"${outputs} \\cdot ({hidden} + 1) = {weights[1]}$ weights, so each changes by ${each[0]:.4g}$ and "
        f"${each[1]:.4g}$ thousandths on average.",
    )
