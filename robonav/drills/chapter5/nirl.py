"""Drills of the page on neural inverse reinforcement learning."""

from __future__ import annotations

import numpy as np

from robonav import nirl

from ..question import Choice, Number, Question, Table
from ..registry import drill
from ..runs import Line, as_list, some_in_order
from ..text import sign

Rng = np.random.Generator


@drill("nirl", "A Boltzmann policy")
def boltzmann(rng: Rng) -> Question:
    """Compute probabilities from the inverse temperature."""
    q = rng.choice(np.arange(1, 10), size=2, replace=False) / 10
    eta = float(rng.choice([2.0, 5.0, 10.0]))
    p = nirl.boltzmann_policy(q, eta)
    hot = nirl.boltzmann_policy(q, 1 / eta)
    exponent = -eta * (q[0] - q[1])
    return Question(
        f"$Q(s, a) = {q[0]:g}$ and $Q(s, b) = {q[1]:g}$. Which probabilities does the Boltzmann "
        f"policy of Eq. (5.10) have at the inverse temperature $\\eta = {eta:g}$?",
        Table(
            ["probability"],
            ["a", "b"],
            [p.tolist()],
            wrong={
                "An inverse temperature multiplies the values. A temperature would divide them.": [
                    hot.tolist()
                ],
                "This is in proportion to the values, not to their exponentials.": [
                    (q / q.sum()).tolist()
                ],
                "The larger value has the larger probability.": [p[::-1].tolist()],
            },
        ),
        f"$P(a) = 1 / (1 + e^{{-{eta:g} ({q[0]:g} - {q[1]:g})}}) = 1 / (1 + e^{{{exponent:.4g}}}) = "
        f"{p[0]:.4g}$, and b "
        "has the rest.",
    )


@drill("nirl", "A SARSA target")
def sarsa_target(rng: Rng) -> Question:
    """Compute the target of one output under a learned reward."""
    q, next_q = np.round(rng.uniform(0.1, 0.9, size=2), 2)
    reward = round(float(rng.uniform(0, 1)), 2)
    alpha, gamma = float(rng.choice([0.5, 0.8])), float(rng.choice([0.65, 0.9]))
    answer = float(
        nirl.sarsa_targets(
            [q], [reward], [next_q], learning_rate=alpha, discount=gamma
        )[0]
    )
    target = reward + gamma * next_q
    return Question(
        f"$Q(s_t, a_t) = {q:g}$, the learned reward of the step is ${reward:g}$, and $Q(s_{{t+1}}, "
        f"a_{{t+1}}) = {next_q:g}$. "
        "Which value does the update of SARSA, Eq. (5.16), give $Q(s_t, a_t)$ as the network's target, with "
        f"$\\alpha = {alpha:g}$ and $\\gamma = {gamma:g}$?",
        Number(
            answer,
            wrong={
                "This is what the target is with $\\alpha = 1$.": target,
                "The discount is missing.": q + alpha * (reward + next_q - q),
                "The old value is missing in the TD error.": q + alpha * target,
                "The reward is missing.": q + alpha * (gamma * next_q - q),
            },
        ),
        f"${q:g} + {alpha:g} \\, ({reward:g} {sign(gamma * next_q)} {sign(-q)}) = {answer:.4g}$.",
    )


@drill("nirl", "A learned reward on the unit interval")
def scaled_rewards(rng: Rng) -> Question:
    """Map rewards into the network's range."""
    rewards = rng.choice(np.arange(-10, 11), size=3, replace=False) / 2
    scaled = nirl.scale_to_unit_interval(rewards, percentile=100)
    scale = abs(rewards).max()
    low, high = rewards.min(), rewards.max()
    return Question(
        f"The learned rewards of three steps are ${', '.join(f'{r:g}' for r in rewards)}$. Divide "
        f"them by the largest "
        "absolute value and map the result so that 0 becomes $1/2$. What are they then?",
        Table(
            ["reward"],
            ["step 1", "step 2", "step 3"],
            [scaled.tolist()],
            wrong={
                "These are only divided. They must lie between 0 and 1, with 0 at $1/2$.": [
                    (rewards / scale).tolist()
                ],
                "This maps the least to 0 and the largest to 1, so 0 does not become $1/2$.": [
                    ((rewards - low) / (high - low)).tolist()
                ],
            },
        ),
        f"$(r / {scale:g} + 1) / 2$: {', '.join(f'{r:.4g}' for r in scaled)}.",
    )


def _iteration(
    number: int, arrived: int, margin: float, pairs: int, last: bool
) -> list[Line]:
    """What one iteration of Algorithm 10 does; the last one stops."""
    lines = [
        (
            f"run episodes in new maps with the present policy, which arrives in {arrived} of 10.",
            "An iteration begins with episodes of the present policy, which was trained in the iteration before.",
        ),
        (
            f"find the reward that separates the expert from this policy; the margin is ${margin:.2f}$.",
            "The reward is compared with the present policy, which must have been run before.",
        ),
    ]
    if last:
        lines.append(
            (
                f"stop, because the margin ${margin:.2f}$ is small.",
                "There is no margin yet that could be small.",
            )
        )
    else:
        lines += [
            (
                f"do not stop, because the margin ${margin:.2f}$ is not small.",
                "There is no margin yet that could be small.",
            ),
            (
                f"compute the targets of {pairs} pairs under this reward.",
                "The targets need the reward, and are computed only if the margin is not small.",
            ),
            (
                "train the network on the targets.",
                "The network is trained on the targets of the iteration, so these come first.",
            ),
        ]
    return [Line(f"Iteration {number}: {text}", why) for text, why in lines]


@drill("nirl", "A run of NIRL")
def order_of_nirl(rng: Rng) -> Question:
    """Put the steps of one iteration of Algorithm 10 in order."""
    number, pairs = int(rng.integers(2, 30)), int(rng.integers(90, 200))
    arrived = np.sort(rng.integers(2, 11, size=2))
    margin = float(rng.uniform(0.3, 0.9))
    stops = bool(rng.integers(2))
    small = float(rng.uniform(0.01, 0.09)) if stops else margin - 0.1
    lines = _iteration(number, int(arrived[0]), margin, pairs, last=False)
    lines += _iteration(number + 1, int(arrived[1]), small, pairs + 20, last=stops)
    asked = some_in_order(rng, lines, 5)
    return Question(
        f"Put these lines of the iterations {number} and {number + 1} of Algorithm 10 in order. A margin below 0.1 is "
        "small.",
        asked,
        f"Episodes, reward and margin, the decision whether to stop, targets, training. {as_list(asked)}",
    )


GIVEN = {
    "the learning rate of the values": "0.8",
    "the learning rate of the network": "0.4",
    "the discount": "0.65",
    "the number of hidden units": "10, or 8",
    "the number of episodes in an iteration": "10",
    "the number of iterations": "about 140",
    "the range of the sensors": "10 m",
    "the warning distance": "5 m",
    "the number of demonstrations": "30",
}
OPEN = {
    "the inverse temperature": ("5", "10", "25", "50"),
    "the number of seconds of an episode": ("100", "200", "300", "500"),
    "the number of gradient steps in an iteration": ("500", "1000", "5000", "9600"),
    "the number of obstacles in the maps of the demonstrations": ("5", "10", "20"),
}


WHERE_GIVEN = (
    "You need to know what the thesis states: the table of its settings on the page of NIRL says so, and the page "
    "*Why learn the reward?* of the demonstrations."
)


@drill("nirl", "What does the thesis leave open?")
def left_open(rng: Rng) -> Question:
    """Tell which settings of NIRL the thesis does not give."""
    is_open = rng.random() < 0.6
    one_of, all_of = (OPEN, GIVEN) if is_open else (GIVEN, OPEN)
    right = str(rng.choice([*one_of]))
    others = [str(name) for name in rng.choice([*all_of], size=3, replace=False)]
    used = GIVEN | {name: str(rng.choice(values)) for name, values in OPEN.items()}
    listed = "; ".join(f"{name}: {used[name]}" for name in rng.permutation([right, *others]))  # fmt: skip
    hints = {
        name: f"The thesis gives it: {GIVEN[name]}."
        if is_open
        else f"The thesis does not give {name}."
        for name in others
    }
    asks, why = (
        (
            "had to be chosen, because the thesis does not give it",
            f"The thesis does not give {right}, so that a repetition has to try several values.",
        )
        if is_open
        else (
            "is taken from the thesis",
            f"The thesis gives {right}: {GIVEN[right]}. A repetition has to try several values of the others.",
        )
    )
    return Question(
        f"A repetition of the thesis's NIRL uses these settings. {listed[0].upper()}{listed[1:]}. {WHERE_GIVEN} Which "
        f"of them {asks}?",
        Choice(right, hints),
        why,
    )
