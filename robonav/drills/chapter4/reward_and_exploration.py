"""Drills of the page on the reward and on exploration."""

from __future__ import annotations

import numpy as np

from robonav import nnql

from ..question import Choice, Number, Order, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator


@drill("reward-and-exploration", "A softmax policy")
def softmax(rng: Rng) -> Question:
    """Compute the probabilities of actions at a temperature."""
    q = rng.choice(np.arange(1, 10), size=2, replace=False) / 10
    temperature = float(rng.choice([0.1, 0.2, 0.5, 1.0]))
    p = nnql.softmax_policy(q, temperature)
    flat = q / q.sum()
    hot = nnql.softmax_policy(q, 1 / temperature)
    wrong = {
        "This is in proportion to the values. The policy is in proportion to their exponentials.": [
            flat.tolist()
        ],
        "The larger value has the larger probability.": [p[::-1].tolist()],
    }
    if temperature != 1:
        wrong["The values are divided by the temperature, not multiplied by it."] = [
            hot.tolist()
        ]
    gap = (q[0] - q[1]) / temperature
    return Question(
        f"$Q(s, F) = {q[0]:g}$ and $Q(s, L30) = {q[1]:g}$. Which probabilities has the softmax policy "
        f"at the temperature "
        f"${temperature:g}$?",
        Table(["probability"], ["F", "L30"], [p.tolist()], wrong=wrong),
        f"$P(F) = 1 / (1 + e^{{-({q[0]:g} - {q[1]:g}) / {temperature:g}}}) = 1 / (1 + "
        f"e^{{{-gap:.4g}}}) = {p[0]:.4g}$, "
        f"and L30 has the rest, ${p[1]:.4g}$.",
    )


@drill("reward-and-exploration", "A geometric schedule")
def schedule(rng: Rng) -> Question:
    """Compute a temperature that falls by a factor each episode."""
    start, end = rng.choice([(1.0, 0.01), (0.9, 0.1), (0.8, 0.05), (1.0, 0.04)])
    fraction = float(rng.choice([0.25, 0.5, 0.75]))
    value = float(nnql.geometric_schedule((start, end), fraction))
    return Question(
        f"A temperature falls geometrically from ${start:g}$ to ${end:g}$. What is it after ${fraction:g}$ of all "
        "episodes? Give three decimals.",
        Number(
            value,
            tolerance=0.0011,
            wrong={
                "This falls linearly. A geometric schedule multiplies by the same factor each episode.": start
                + (end - start) * fraction,
                "Start and end are exchanged.": float(
                    nnql.geometric_schedule((end, start), fraction)
                ),
            },
        ),
        f"${start:g} \\cdot ({end:g} / {start:g})^{{{fraction:g}}} = {value:.4g}$.",
    )


@drill("reward-and-exploration", "The property of a state")
def property_of_state(rng: Rng) -> Question:
    """Name the property of a state from the nearest distance."""
    nearest = round(float(rng.uniform(1.1, 10)), 1) if rng.random() < 0.75 else 10.0
    found = nnql.Property(int(nnql.property_at(np.array([nearest]))[0])).name.lower()
    hints = {
        "safe": "A state is safe only if nothing is in sensor range.",
        "cozy": "In a cozy state something is in range, and nothing is near.",
        "dangerous": "A state is dangerous only if something is nearer than the border of cozy states.",
        "winning": "A winning state is an arrival; the robot is still on its way.",
        "failure": "A failure is a collision; nothing is nearer than 1 m.",
    }
    wrong = {name: hint for name, hint in hints.items() if name != found}
    return Question(
        f"The robot is on its way, and the least of its nine ranges is ${nearest:g}$ m. Which "
        f"property has its state by "
        "Eq. (4.6)?",
        Choice(found, wrong),
        f"With the nearest thing at ${nearest:g}$ m the state is {found}: nothing in range is safe, nearer than "
        f"${nnql.COZY_DISTANCE:g}$ m is dangerous, and what lies between is cozy.",
    )


@drill("reward-and-exploration", "A reward from a potential")
def potential(rng: Rng) -> Question:
    """Compute the shaping reward of a step."""
    before, after = (round(float(v), 1) for v in rng.uniform(-5, 5, size=2))
    discount = float(rng.choice([0.5, 0.8, 0.9]))
    answer = discount * after - before
    return Question(
        f"The potential is $\\Phi(s) = {before:g}$ and $\\Phi(s') = {after:g}$. Which reward does "
        f"potential-based shaping add "
        f"to the step from $s$ to $s'$, with $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "The potential of $s'$ is discounted. Without that, a circle could earn something.": after
                - before,
                "The sign is wrong: the step gains the potential of $s'$ and gives up that of $s$.": before
                - discount * after,
                "The discount belongs to $\\Phi(s')$.": after - discount * before,
            },
        ),
        f"$\\gamma \\Phi(s') - \\Phi(s) = {discount * after:.4g} {sign(-before)} = {answer:.4g}$.",
    )


@drill("reward-and-exploration", "One row for every step?")
def one_row_for_every_step(rng: Rng) -> Question:
    """Tell whether a table of rewards is exclusive and total."""
    border = int(rng.integers(3, 8))
    low_closed, high_closed = bool(rng.integers(2)), bool(rng.integers(2))
    shift = int(rng.choice([0, 0, 1, -1]))
    low, high = border, border + shift
    whole = np.arange(0, 11)
    first = whole <= low if low_closed else whole < low
    second = whole >= high if high_closed else whole > high
    exclusive, total = not (first & second).any(), bool((first | second).all())
    answers = {
        (True, True): "It is exclusive and total",
        (False, True): "It is total, but not exclusive",
        (True, False): "It is exclusive, but not total",
        (False, False): "It is neither exclusive nor total",
    }
    both = [int(n) for n in whole[first & second]]
    none = [int(n) for n in whole[~first & ~second]]
    hint = (
        f"At {both[0]} m both rows hold."
        if both
        else f"At {none[0]} m no row holds."
        if none
        else "At each distance exactly one row holds."
    )
    right = answers[exclusive, total]
    return Question(
        f"Distances are whole metres from 0 to 10. A table of rewards has two rows: "
        f"*{'at most' if low_closed else 'less than'} "
        f"{low} m* and *{'at least' if high_closed else 'more than'} {high} m*. What is true of it?",
        Choice(
            right,
            {answer: hint for answer in answers.values() if answer != right},
            order=tuple(answers.values()),
        ),
        f"{hint} A table is exclusive if no two rows hold at once, and total if some row always holds.",
    )


@drill("reward-and-exploration", "An episode with Gymnasium")
def parts_of_an_episode(rng: Rng) -> Question:
    """Put the parts of an episode in order, as any Gymnasium environment needs them."""
    lines = [
        f"`reset` with the seed {int(rng.integers(100))} gives the first state.",
        "The policy chooses an action for the state.",
        "`step` gives the next state, the reward, and whether the episode has ended.",
        f"The target is the reward; unless the episode has ended, plus {rng.choice([0.65, 0.9])} "
        f"times the best next value.",
        "The value of state and action moves towards the target.",
        "The next state becomes the state.",
    ]
    hints = (
        "A policy needs a state, and the first one comes from the reset.",
        "The environment is told an action, so that it must be chosen before.",
        "The target needs the reward and the next state.",
        "The value moves towards the target, so the target comes first.",
        "The update is that of the old state, so the state changes after it.",
    )
    first = int(rng.integers(3))
    shown = lines[first : first + 4]
    return Question(
        "Put these parts of an episode in order. The parts after the reset are repeated until the episode ends.",
        Order(
            shown,
            "Each part uses what the parts before it have computed.",
            {(k, k + 1): hints[first + k] for k in range(3)},
        ),
        " ".join(f"({k + 1}) {part}" for k, part in enumerate(shown)),
    )
