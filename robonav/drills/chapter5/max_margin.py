"""Drills of the page on the largest margin."""

from __future__ import annotations

import numpy as np

from robonav import nirl

from ..question import Choice, Number, Question, Table
from ..registry import drill

Rng = np.random.Generator


def _pair(point: np.ndarray) -> str:
    return f"({point[0]:.4g}, {point[1]:.4g})"


@drill("max-margin", "The margin against one policy")
def margin_of_one(rng: Rng) -> Question:
    """Find the largest margin against one policy, and its reward."""
    found = rng.integers(0, 6, size=2).astype(float)
    step = np.array(rng.choice([[3, 4], [4, 3], [6, 8], [-3, 4], [4, -3]]), float)
    expert = found + step
    best = nirl.maximum_margin(expert, found[None])
    length = float(np.linalg.norm(step))
    return Question(
        f"The expert's feature expectations are ${_pair(expert)}$, those of the only policy found so "
        f"far ${_pair(found)}$. "
        "Which weights with $\\|\\theta\\| \\leq 1$ give the largest margin, and how large is it?",
        Table(
            ["answer"],
            ["$\\theta_1$", "$\\theta_2$", "margin"],
            [[*best.weights.tolist(), best.margin]],
            wrong={
                "The weights must have length 1: divide by the length.": [
                    [*step.tolist(), length]
                ],
                "The weights point from the policy to the expert, not back.": [
                    [*(-best.weights).tolist(), best.margin]
                ],
                "The margin is the length of the difference, not its square.": [
                    [*best.weights.tolist(), length**2]
                ],
            },
        ),
        f"The difference is ${_pair(step)}$ with length ${length:g}$. Divided by it, it is $\\theta = "
        f"{_pair(best.weights)}$, "
        f"and the margin is $\\theta \\cdot (\\mu_E - \\mu) = {length:g}$.",
    )


@drill("max-margin", "Which reward prefers the expert most?")
def best_of_three(rng: Rng) -> Question | None:
    """Compare the margins of three rewards against two policies."""
    expert = rng.integers(2, 8, size=2).astype(float)
    others = rng.integers(0, 8, size=(2, 2)).astype(float)
    rewards = np.array([[1.0, 0.0], [0.0, 1.0], [0.6, 0.8]])
    values = [
        [nirl.value_of_expectations(reward, mu) for mu in (expert, *others)]
        for reward in rewards
    ]
    leads = np.round([[own - v for v in found] for own, *found in values], 6) + 0.0
    margins, largest = leads.min(axis=1), leads.max(axis=1)
    names = [f"$({a:g}, {b:g})$" for a, b in rewards]
    best = int(margins.argmax())
    if np.sort(margins)[-1] - np.sort(margins)[-2] < 0.05:
        return None  # a tie, or nearly one
    hint = "Its margin is its smallest lead over the policies"
    wrong = {
        name: f"{hint}, ${margin:.4g}$"
        + (" (its largest lead does not count)." if lead > margins[best] else ".")
        for k, (name, margin, lead) in enumerate(
            zip(names, margins, largest, strict=True)
        )
        if k != best
    }
    return Question(
        f"The expert has $\\mu_E = {_pair(expert)}$, and two policies have ${_pair(others[0])}$ and "
        f"${_pair(others[1])}$. "
        "Under which of these weights does the expert lead by the largest margin?",
        Choice(names[best], wrong),
        "The margins, the smaller lead of each: "
        + ", ".join(f"{name} ${m:.4g}$" for name, m in zip(names, margins, strict=True))
        + ".",
    )


@drill("max-margin", "One step of the projection method")
def projection(rng: Rng) -> Question:
    """Project the expert onto a segment between two points."""
    mean, found, expert = (rng.integers(0, 7, size=2).astype(float) for _ in range(3))
    point = nirl.project(mean, found, expert)
    middle = (mean + found) / 2
    step = found - mean
    share = float(step @ (expert - mean) / max(step @ step, 1))
    unlimited = mean + share * step
    wrong = {
        "This is the middle of the segment, not the point nearest to the expert.": [
            middle.tolist()
        ],
    }
    if not 0 <= share <= 1:
        wrong["The nearest point must lie on the segment, not beyond its end."] = [
            unlimited.tolist()
        ]
    where = (
        "inside the segment"
        if 0 < share < 1
        else "at its end"
        if share >= 1
        else "at its beginning"
    )
    return Question(
        f"The mixture of policies so far has the feature expectations ${_pair(mean)}$, the new policy "
        f"${_pair(found)}$, "
        f"the expert ${_pair(expert)}$. To which point does the projection method move the mixture?",
        Table(["mixture"], ["feature 1", "feature 2"], [point.tolist()], wrong=wrong),
        f"The share is $(\\mu - \\bar\\mu) \\cdot (\\mu_E - \\bar\\mu) / \\|\\mu - \\bar\\mu\\|^2 = "
        f"{share:.4g}$, so the "
        f"nearest point lies {where}: ${_pair(point)}$.",
    )


@drill("max-margin", "Back into the unit ball")
def into_the_ball(rng: Rng) -> Question:
    """Project weights that are too long."""
    sides = np.array([[3, 4], [5, 12], [8, 15], [7, 24], [20, 21]])
    weights = rng.permutation(rng.choice(sides)) * rng.choice([-1, 1], size=2)
    weights = weights * rng.choice([0.02, 0.05, 0.1, 0.2, 0.5])
    projected = nirl.project_to_unit_ball(weights)
    length = float(np.linalg.norm(weights))
    wrong = {
        "These are divided by the sum of the absolute values. The length is the root of the sum of squares.": [
            (weights / abs(weights).sum()).tolist()
        ],
    }
    if length < 1:
        wrong["Weights that are short enough stay as they are."] = [
            (weights / length).tolist()
        ]
    if length > 1:
        wrong["Each weight is cut off alone here. All are divided by the length."] = [
            np.clip(weights, -1, 1).tolist()
        ]
    return Question(
        f"A subgradient step has made the weights $({weights[0]:g}, {weights[1]:g})$. What are the "
        f"nearest weights with "
        "$\\|\\theta\\| \\leq 1$?",
        Table(
            ["weights"],
            ["$\\theta_1$", "$\\theta_2$"],
            [projected.tolist()],
            wrong=wrong,
        ),
        f"Their length is ${length:g}$. "
        + (
            f"Divided by it they are ${_pair(projected)}$."
            if length > 1
            else "It is at most 1, so they stay as they are."
        ),
    )


@drill("max-margin", "Compared in the expert's states")
def gap_without_model(rng: Rng) -> Question:
    """Compute the feature gap of one decision, which needs no model."""
    feature = float(rng.integers(2, 8))
    p = rng.permutation(
        [[0.5, 0.3, 0.2], [0.6, 0.3, 0.1], [0.4, 0.4, 0.2]][int(rng.integers(3))]
    )
    own = int(rng.integers(3))
    none = np.zeros(1, dtype=int)
    decision = nirl.Decisions(
        np.array([[feature]]), np.array([own]), none, none, none, none
    )
    gap = nirl.feature_gap(decision, p[None], np.ones(1))[:, 0]
    names = ("F", "L30", "R30")
    hot = np.eye(3)[own]
    return Question(
        f"In a demonstrated state with one feature, ${feature:g}$, the expert took {names[own]}. The "
        f"learner's policy takes "
        f"F with probability ${p[0]:g}$, L30 with ${p[1]:g}$ and R30 with ${p[2]:g}$ there. The features stand in the "
        "block of the action. What is the gap between the expert's features and the learner's, block by block?",
        Table(
            ["gap"],
            names,
            [gap.tolist()],
            wrong={
                "The learner's features are missing.": [(hot * feature).tolist()],
                "The feature is missing: these are the probabilities alone.": [
                    (hot - p).tolist()
                ],
                "The gap is the expert's features minus the learner's.": [
                    (-gap).tolist()
                ],
            },
        ),
        f"Expert: {feature:g} in the block {names[own]}, 0 elsewhere. Learner: "
        f"${', '.join(f'{x * feature:.4g}' for x in p)}$. The gap is ${', '.join(f'{x:.4g}' for x in gap)}$, from the "
        "expert's states alone.",
    )


@drill("max-margin", "What the thesis's objective finds")
def fitted_to_values(rng: Rng) -> Question | None:
    """Minimise the thesis's objective for one weight, and see what it ignores."""
    mu = rng.integers(1, 6, size=2).astype(float)
    values = np.round(rng.uniform(-3, 3, size=2), 1)
    free = float(mu @ values / (mu @ mu))
    answer = float(nirl.project_to_unit_ball(np.array([free]))[0])
    worst = float((values / mu).mean())
    wrong = {
        "The sum of squares is minimised by $\\sum \\mu Q / \\sum \\mu^2$, not by the mean of the ratios.": worst,
        "This has the wrong sign: the expert's values are fitted to the learner's.": -answer,
    }
    if abs(free) > 1:
        wrong["The weight must not be longer than 1."] = free
    wrong = {hint: n for hint, n in wrong.items() if abs(n - answer) > 0.02}
    if not wrong:
        return None  # every way gives the same number
    return Question(
        f"In two demonstrated states the expert's feature expectations are ${mu[0]:g}$ and "
        f"${mu[1]:g}$, and the learner's "
        f"values are ${values[0]:g}$ and ${values[1]:g}$. Which weight $|\\theta| \\leq 1$ makes the objective "
        "$\\sum_t (\\theta \\mu_t - Q_t)^2$ smallest?",
        Number(answer, wrong=wrong),
        f"$\\sum \\mu Q / \\sum \\mu^2 = {mu @ values:.4g} / {mu @ mu:g} = {free:.4g}$"
        + (f", cut off to {answer:g}" if abs(free) > 1 else "")
        + ". Its sign is that of the learner's values. How good the expert is does not matter: this is why the "
        "minimum is not a good reward.",
    )
