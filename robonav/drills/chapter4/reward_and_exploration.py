"""Drills of the page on the reward and on exploration."""

from __future__ import annotations

import numpy as np

from robonav import nnql
from robonav.robot import Outcome

from ..question import Choice, Number, Question, Table
from ..registry import drill
from ..runs import Line, as_list, some_in_order
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
        f"$Q(s, F) = {q[0]:g}$ and $Q(s, L30) = {q[1]:g}$. What are the probabilities of the softmax policy "
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
    start = float(rng.choice([0.5, 0.6, 0.8, 0.9, 1.0, 2.0]))
    end = float(rng.choice([0.01, 0.02, 0.04, 0.05, 0.1]))
    fraction = float(rng.choice([0.1, 0.2, 0.25, 0.4, 0.5, 0.6, 0.75, 0.8]))
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


def _nine_ranges(rng: Rng, nearest: float) -> list[float]:
    """Nine readings, the least of which is given."""
    others = np.round(rng.uniform(nearest, 10, size=9), 1)
    others[rng.random(9) < 0.3] = 10.0  # nothing in range
    others[int(rng.integers(9))] = nearest
    return [float(reading) for reading in others]


@drill("reward-and-exploration", "The property of a state")
def property_of_state(rng: Rng) -> Question:
    """Name the property of a state from the nearest distance."""
    wanted = str(rng.choice(["safe", "cozy", "dangerous"]))
    borders = {"safe": (10, 10), "cozy": (nnql.COZY_DISTANCE, 9.9)}
    low, high = borders.get(wanted, (1.1, nnql.COZY_DISTANCE - 0.1))
    nearest = round(float(rng.uniform(low, high)), 1)
    ranges = _nine_ranges(rng, nearest)
    outcomes = (
        "is on its way",
        "has arrived in this step",
        "has collided in this step",
    )
    outcome = int(rng.choice(3, p=[0.7, 0.15, 0.15]))
    codes = (
        None
        if outcome == 0
        else np.array([(Outcome.ARRIVED, Outcome.COLLIDED)[outcome - 1]])
    )
    found = nnql.property_at(np.array([min(ranges)]), codes)[0]
    name = nnql.Property(int(found)).name.lower()
    hints = {
        "safe": "A state is safe only if nothing is in sensor range, and the episode goes on.",
        "cozy": "In a cozy state something is in range, nothing is nearer than the border, and the episode goes on.",
        "dangerous": "A state is dangerous only if something is nearer than the border of cozy states, and the episode "
        "goes on.",
        "winning": "A winning state is an arrival.",
        "failure": "A failure is a collision.",
    }
    wrong = {name_: hint for name_, hint in hints.items() if name_ != name}
    shown = ", ".join(f"{reading:g}" for reading in ranges)
    return Question(
        f"The robot {outcomes[outcome]}. Its nine sensors read ${shown}$ m. Which property does its state "
        f"have by Eq. (4.6)? Sensors reach 10 m, and a state is dangerous below {nnql.COZY_DISTANCE:g} m.",
        Choice(name, wrong),
        f"The robot {outcomes[outcome]}, so the state is {name}, whatever its sensors read."
        if outcome
        else f"The nearest thing is at ${nearest:g}$ m, so the state is {name}: nothing in range is safe, nearer than "
        f"${nnql.COZY_DISTANCE:g}$ m is dangerous, and what lies between is cozy.",
    )


@drill("reward-and-exploration", "A reward from a potential")
def potential(rng: Rng) -> Question | None:
    """Compute the shaping reward of a step."""
    before, after = (round(float(v), 1) for v in rng.uniform(-5, 5, size=2))
    if before == after:  # two mistakes would give the same number
        return None
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


ANSWERS = {
    (True, True): "It is exclusive and total",
    (False, True): "It is total, but not exclusive",
    (True, False): "It is exclusive, but not total",
    (False, False): "It is neither exclusive nor total",
}


def _border(rng: Rng, at: int, kind: str) -> tuple[str, str, int, int]:
    """How a row ends and the next one begins: words, and the last distance of the one and the first of the other."""
    first = at + {"exact": 1, "both": 0, "neither": 2}[kind]
    ends = rng.choice([f"at most {at} m", f"less than {at + 1} m"])
    begins = rng.choice([f"at least {first} m", f"more than {first - 1} m"])
    return str(ends), str(begins), at, first


@drill("reward-and-exploration", "One row for every step?")
def one_row_for_every_step(rng: Rng) -> Question:
    """Tell whether a table of rewards is exclusive and total."""
    kinds = {
        (True, True): ("exact", "exact"),
        (False, True): ("both", "exact"),
        (True, False): ("neither", "exact"),
        (False, False): ("both", "neither"),
    }
    exclusive, total = (bool(rng.integers(2)) for _ in range(2))
    low, high = int(rng.integers(1, 4)), int(rng.integers(5, 8))
    first, second = rng.permutation(kinds[exclusive, total])
    near_ends, middle_begins, last_near, first_middle = _border(rng, low, str(first))
    middle_ends, far_begins, last_middle, first_far = _border(rng, high, str(second))
    rows = f"*{near_ends}*, *{middle_begins} and {middle_ends}*, and *{far_begins}*"
    whole = np.arange(11)
    holds = [whole <= last_near, (first_middle <= whole) & (whole <= last_middle), whole >= first_far]  # fmt: skip
    often = np.sum(holds, axis=0)
    both, none = np.flatnonzero(often > 1), np.flatnonzero(often == 0)
    found = (len(both) == 0, len(none) == 0)
    said = [f"At {n} m two rows hold." for n in both] + [
        f"At {n} m no row holds." for n in none
    ]
    hint = " ".join(said) or "At each distance exactly one row holds."
    right = ANSWERS[found]
    return Question(
        f"Distances are whole metres from 0 to 10. A table of rewards has three rows: {rows}. What is true of it?",
        Choice(right, {answer: hint for answer in ANSWERS.values() if answer != right}),
        f"{hint} A table is exclusive if no two rows hold at once, and total if some row always holds.",
    )


@drill("reward-and-exploration", "An episode with Gymnasium")
def parts_of_an_episode(rng: Rng) -> Question:
    """Put the parts of an episode in order, as any Gymnasium environment needs them."""
    seed, discount = int(rng.integers(100)), float(rng.choice([0.5, 0.65, 0.8, 0.9]))
    rate = float(rng.choice([0.1, 0.2, 0.5]))
    states = [int(n) for n in rng.choice(20, size=3, replace=False)]
    actions = [str(name) for name in rng.choice(["F", "L30", "R30", "L60"], size=2)]
    chosen, largest = np.sort(rng.integers(1, 10, size=2)) / 10  # in the second state
    old = float(rng.integers(1, 10)) / 10, chosen
    reward = float(rng.choice([-0.1, 0.0, 0.1]))
    targets = [reward + discount * largest, 1.0]
    new = [
        float(nnql.q_targets(np.array([q]), 0, target, 0.0, rate, 0.0)[0])
        for q, target in zip(old, targets, strict=True)
    ]
    ends = [f"and the reward ${reward:g}$.", "the reward $1$, and that the episode has ended."]  # fmt: skip
    lines = [Line(f"`reset` with the seed {seed} gives the state {states[0]}.", "")]
    for k in range(2):
        now, then = states[k], states[k + 1]
        lines += [
            Line(
                f"The policy chooses {actions[k]} for the state {now}.",
                "A policy needs a state, and the values after the update of the step before.",
            ),
            Line(
                f"`step` gives the state {then}{',' if k else ''} {ends[k]}",
                "The environment is told an action for the state that it has given before.",
            ),
            Line(
                f"The target for the state {now} is ${targets[k]:.4g}$.",
                "The target needs the reward and the state that `step` gives.",
            ),
            Line(
                f"The value of {actions[k]} in the state {now} becomes ${new[k]:.4g}$.",
                "The value moves towards the target of its step, so the target comes first.",
            ),
        ]
    asked = some_in_order(rng, lines, 5)
    return Question(
        "Q-learning updates a value after each step, before it chooses the next action, with "
        f"$\\gamma = {discount:g}$ and $\\alpha = {rate:g}$. In an episode of two steps the robot is in the states "
        f"{states[0]}, {states[1]} and {states[2]}. The largest value in the state {states[1]} is ${largest:g}$. "
        "Put these lines of the run in order.",
        asked,
        f"Reset, choose, step, target, update, and again from the next state on. {as_list(asked)}",
    )
