"""Drills of the page that compares four inverse methods."""

from __future__ import annotations

import numpy as np

from robonav import nirl
from robonav.experiments import probability_of_improvement

from ..question import Choice, Number, Question
from ..registry import drill

Rng = np.random.Generator


@drill("nirl-comparison", "The cost of one step in SCIRL")
def large_margin_step(rng: Rng) -> Question:
    """Compute how much is missing to a lead of 1."""
    scores = np.round(rng.uniform(0, 3, size=3), 1)
    own = int(rng.integers(3))
    cost, _ = nirl.large_margin_cost(
        np.ones(1), scores[None, :, None], np.array([own]), np.ones(1)
    )
    others = np.delete(scores, own)
    rival = float(others.max())
    lead = float(scores[own]) - rival
    wrong = {
        "Every other action has 1 added to its score. Here the 1 is missing.": float(
            scores.max() - scores[own]
        ),
        "Only the strongest rival counts, not all of them.": float(
            np.maximum(others + 1 - scores[own], 0).sum()
        ),
        "This is the lead. The cost is 1 minus the lead, and at least 0.": lead,
    }
    wrong = {
        hint: number for hint, number in wrong.items() if abs(number - cost) > 0.02
    }
    names = ("a", "b", "c")
    return Question(
        f"SCIRL gives the actions of a state the scores "
        f"{', '.join(f'{n}: ${s:g}$' for n, s in zip(names, scores, strict=True))}. The expert takes "
        f"{names[own]}. What does this step cost, with weight 1 and without "
        "regularisation? It is free if the expert's action leads by at least 1, and costs what is missing otherwise.",
        Number(cost, wrong=wrong),
        f"The strongest rival has ${rival:g} + 1 = {rival + 1:.4g}$. "
        + (
            f"The expert's action has ${scores[own]:g}$, so the cost is ${rival + 1:.4g} - "
            f"{scores[own]:g} = {cost:.4g}$."
            if cost > 0
            else f"The expert's action has ${scores[own]:g}$ and leads by at least 1. The step costs nothing."
        ),
    )


@drill("nirl-comparison", "LSTD-μ with one number")
def one_step_of_lstd(rng: Rng) -> Question:
    """Solve the equation of LSTD-μ for one basis function."""
    discount = float(rng.choice([0.5, 0.8]))
    ends = bool(rng.integers(2))
    while True:
        psi = rng.integers(1, 5, size=2).astype(float)
        after = np.array([psi[1], 0.0 if ends else float(rng.integers(1, 4))])
        left = float(psi @ (psi - discount * after))
        undiscounted = float(psi @ (psi - after))
        unweighted = float((psi - discount * after).sum())
        if min(left, abs(undiscounted), abs(unweighted)) > 0.4:
            break
    feature = rng.integers(0, 5, size=2).astype(float)
    right = float(psi @ feature)
    answer = float(
        nirl.lstd_mu(
            psi[:, None],
            after[:, None],
            feature[:, None],
            discount,
            regularisation=1e-12,
        )[0, 0]
    )
    end = (
        "and then the episode ends"
        if ends
        else f"and the step after it has $\\psi = {after[1]:g}$"
    )
    return Question(
        "LSTD-μ estimates discounted sums of the feature $f$ as $\\omega \\psi$. "
        f"Two steps of the expert have $\\psi = {psi[0]:g}$ and $\\psi = {psi[1]:g}$, {end}. Their features are "
        f"$f = {feature[0]:g}$ and $f = {feature[1]:g}$. With $\\gamma = {discount:g}$, what is $\\omega$?",
        Number(
            answer,
            wrong={
                "The discount is missing.": right / undiscounted,
                "This fits $f$ itself. The next step, $\\gamma \\psi_{t+1}$, is missing.": right
                / float(psi @ psi),
                "The difference $\\psi_t - \\gamma \\psi_{t+1}$ must be multiplied by $\\psi_t$, like $f_t$.": float(
                    feature.sum()
                )
                / unweighted,
            },
        ),
        f"$\\sum_t \\psi_t (\\psi_t - \\gamma \\psi_{{t+1}}) = {psi[0]:g} ({psi[0]:g} - {discount:g} "
        f"\\cdot {after[0]:g}) "
        f"+ {psi[1]:g} ({psi[1]:g} - {discount:g} \\cdot {after[1]:g}) = {left:.4g}$, and $\\sum_t \\psi_t f_t = "
        f"{psi[0]:g} \\cdot {feature[0]:g} + {psi[1]:g} \\cdot {feature[1]:g} = {right:g}$. So "
        f"$\\omega = {answer:.4g}$.",
    )


@drill("nirl-comparison", "Probability of improvement")
def run_against_run(rng: Rng) -> Question:
    """Compute how probably a run of one method beats a run of another."""
    ours, theirs = rng.integers(80, 100, size=3), rng.integers(75, 99, size=3)
    if rng.random() < 0.5:
        theirs[0] = ours[0]
    answer = probability_of_improvement(ours, theirs).probability
    difference = ours[:, None] - theirs[None]
    wins, ties = int((difference > 0).sum()), int((difference == 0).sum())
    in_pairs = float((ours > theirs).mean() + (ours == theirs).mean() / 2)
    wrong = {"This is the probability that the second method is better.": 1 - answer}
    if ties:
        wrong["A tie counts half, not as a win."] = (wins + ties) / 9
        wrong["A tie counts half, not as nothing."] = wins / 9
    if abs(in_pairs - answer) > 0.02:
        wrong[
            "Each run is compared with all three of the other method, not only with one."
        ] = in_pairs
    return Question(
        f"Three runs of one method arrive in ${', '.join(f'{r}' for r in ours)}$ % of the maps, three runs of another "
        f"in ${', '.join(f'{r}' for r in theirs)}$ %. With which probability is a run of the first method better than "
        "a run of the second?",
        Number(answer, wrong=wrong),
        f"Of the nine pairs the first method wins {wins}"
        + (f" and ties in {ties}, which counts half" if ties else "")
        + f": ${wins + ties / 2:g} / 9 = {answer:.4g}$.",
    )


SHOWN = {
    "nothing": "Nothing about the reward, since training without one does as well",
    "not needed": "The reward made the difference in training, but cloning does without one",
    "needed": "The reward made the difference, and cloning does not reach it",
}
CONCLUSIONS = {
    "nothing": "It is no better than its training with the reward 0, so its success shows nothing about its reward.",
    "not needed": "It is far better than with the reward 0, so its reward made the difference in training. It is no "
    "better than cloning, so a reward was not needed.",
    "needed": "It is far better than with the reward 0, so its reward made the difference in training. It is far "
    "better than cloning, too, so the demonstrations alone do not give this success.",
}


@drill("nirl-comparison", "What do the controls show?")
def what_controls_show(rng: Rng) -> Question:
    """Judge a method by its controls, not by its success."""
    method = int(rng.integers(90, 98))
    kind = str(rng.choice([*SHOWN]))
    near = int(rng.integers(-1, 2))
    far = int(rng.integers(15, 45))
    zero = method - (int(rng.integers(0, 2)) if kind == "nothing" else far)
    cloning = method - (int(rng.integers(8, 20)) if kind == "needed" else near)
    if kind == "nothing":
        cloning = method - int(rng.choice([1, 10, 15]))
    hints = {
        "nothing": f"The same training with the reward 0 arrives in only {zero} %.",
        "not needed": f"Cloning arrives in {cloning} %, and the method in {method} %."
        if kind == "needed"
        else f"With the reward 0 the training arrives in {zero} % as well, so the reward made no difference.",
        "needed": f"Cloning, which has no reward, arrives in {cloning} %."
        if kind == "not needed"
        else f"With the reward 0 the training arrives in {zero} % as well, so the reward made no difference.",
    }
    return Question(
        f"A method of inverse reinforcement learning arrives in {method} % of the maps, the same training with the "
        f"reward 0 in {zero} %, and cloning from the same demonstrations in {cloning} %. Each number is a mean of 25 "
        "runs, and its 95 % interval is one point wide to each side. What do the numbers show?",
        Choice(
            SHOWN[kind],
            {SHOWN[other]: hints[other] for other in SHOWN if other != kind},
        ),
        f"The reward 0 tells what the training reaches by itself: {zero} %. Cloning tells what the demonstrations give "
        f"without any reward: {cloning} %. The method has {method} %. {CONCLUSIONS[kind]}",
    )


BOTH, REWARD, NEITHER = (
    "The reward still describes the task, and the policy is as good as before",
    "The reward still describes the task, but the policy may not be the best one any more",
    "The reward does not describe the task any more, so new demonstrations are needed",
)
CHANGES = {
    BOTH: (
        "Now it has to drive in other maps of the same kind, at the same speed",
        "Now its maps are drawn with another seed",
        "Now another robot of the same make takes its place",
        "Now its battery is exchanged for one of the same weight",
        "Now its targets stand elsewhere in maps of the same kind",
        "Now it drives at night, too, and its sensors need no light",
    ),
    REWARD: (
        "Now it has to drive at twice the speed",
        "Now it drives at half the speed, so that a step is half as long",
        "Now the obstacles stand twice as densely",
        "Now its greatest turn is 30 degrees instead of 60",
        "Now its floor is slippery, and some turns come out too small",
        "Now it may also go sideways",
        "Now some of the obstacles move",
        "Now it senses and decides only half as often",
    ),
    NEITHER: (
        "Now it should keep away from people, and no feature tells people from walls",
        "Now a camera replaces its sensors, and the old features cannot be computed any more",
        "Now it should follow the walls, which the expert never did",
        "Now it should be quiet, and no feature measures noise",
        "Now it should fetch a parcel on its way, and no feature knows of parcels",
        "Now it should arrive with its back to the target, and no feature tells how it stands",
    ),
}
AIM = "The aim and the features are the same, so the reward holds."
MOVES = "What an action leads to is the same as before, so the policy holds as well."
OTHER_MOVES = (
    "An action leads to something else than before, so another policy may be better."
)
OTHER_AIM = (
    "The features do not tell what now counts, or they cannot be computed any more, so the old reward does not "
    "describe the task."
)
HINTS = {
    BOTH: {REWARD: MOVES, NEITHER: AIM},
    REWARD: {BOTH: OTHER_MOVES, NEITHER: AIM},
    NEITHER: {BOTH: OTHER_AIM, REWARD: OTHER_AIM},
}
WHY = {
    BOTH: f"{AIM} {MOVES}",
    REWARD: f"{AIM} {OTHER_MOVES}",
    NEITHER: OTHER_AIM,
}


@drill("nirl-comparison", "What still holds after a change?")
def after_a_change(rng: Rng) -> Question:
    """Decide whether a policy or a reward can be kept when the task changes."""
    right = str(rng.choice([*CHANGES]))
    changes = {kind: str(rng.choice(CHANGES[kind])) for kind in CHANGES}
    obstacles, speed = int(rng.choice([10, 20, 30])), int(rng.choice([1, 2, 3]))
    learned = f"A robot learned a reward and a policy from demonstrations among {obstacles} obstacles at {speed} m/s."
    if rng.random() < 0.5:
        return Question(
            f"{learned} {changes[right]}. Which statement is right?",
            Choice(right, HINTS[right], order=(BOTH, REWARD, NEITHER)),
            WHY[right],
        )
    return Question(
        f"{learned} After which change does this hold? *{right}.*",
        Choice(
            changes[right],
            {changes[kind]: HINTS[kind][right] for kind in CHANGES if kind != right},
        ),
        WHY[right],
    )
