"""Drills of the conclusions: what numbers of a comparison say."""

from __future__ import annotations

import numpy as np

from robonav.benchmark import success_interval

from ..question import Choice, Number, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator


@drill("conclusions", "How much better than the rule?")
def failures_avoided(rng: Rng) -> Question:
    """Compare a policy with a baseline by its failures."""
    rule = int(rng.integers(40, 95))
    learned = int(rng.integers(rule + 2, 100))
    answer = (learned - rule) / (100 - rule)
    return Question(
        f"A rule of three lines arrives in {rule} % of the maps, a learned policy in {learned} %. Which share of the "
        "rule's failures does the learned policy avoid, from 0 to 1?",
        Number(
            answer,
            wrong={
                "This is the difference of the success rates. Divide it by the rule's failures.": (
                    learned - rule
                )
                / 100,
                "This compares the successes. The question is about the failures.": (
                    learned - rule
                )
                / rule,
                "This is the share of the failures that is left.": 1 - answer,
            },
        ),
        f"The failures fall from {100 - rule} % to {100 - learned} %, and $({100 - rule} - {100 - learned}) / "
        f"{100 - rule} = {answer:.4g}$.",
    )


@drill("conclusions", "Which change made the difference?")
def effects_of_two_changes(rng: Rng) -> Question:
    """Compute the effect of each of two changes from all four combinations."""
    base = int(rng.integers(20, 44))  # so that no rate is above 100
    expert, network = (int(n) for n in rng.integers(-4, 26, size=2))
    together = int(rng.choice([-6, -4, 4, 6]))
    rates = np.array(
        [[base, base + network], [base + expert, base + expert + network + together]]
    )
    effects = [
        float((rates[1] - rates[0]).mean()),
        float((rates[:, 1] - rates[:, 0]).mean()),
    ]
    alone = [float(rates[1, 0] - rates[0, 0]), float(rates[0, 1] - rates[0, 0])]
    larger = "The expert's effect is the larger one."
    if effects[0] < effects[1]:
        larger = "The algorithm's effect is the larger one."
    if effects[0] == effects[1]:
        larger = "Both effects are equally large."
    return Question(
        f"Success in per cent: old expert and old algorithm {rates[0, 0]}, old expert and new algorithm {rates[0, 1]}, "
        f"new expert and old algorithm {rates[1, 0]}, new expert and new algorithm {rates[1, 1]}. By how many points "
        "does each change raise the success, on average over the other one?",
        Table(
            ["points"],
            ["new expert", "new algorithm"],
            [effects],
            wrong={
                "The two effects are exchanged.": [effects[::-1]],
                "Each change is tested once with the old and once with the new other part. Take the mean of both.": [
                    alone
                ],
            },
        ),
        f"Expert: $({rates[1, 0] - rates[0, 0]} {sign(rates[1, 1] - rates[0, 1])}) / 2 = {effects[0]:g}$. Algorithm: "
        f"$({rates[0, 1] - rates[0, 0]} {sign(rates[1, 1] - rates[1, 0])}) / 2 = {effects[1]:g}$. {larger}",
    )


@drill("conclusions", "Many fields one after the other")
def fields_in_a_row(rng: Rng) -> Question:
    """Compute how often policies cross several fields without a failure in any."""
    fields = int(rng.integers(3, 9))
    rule = int(rng.integers(60, 90))
    learned = int(rng.integers(rule + 3, 99))
    rates = np.array([rule, learned]) / 100
    answer = rates**fields
    return Question(
        f"A rule arrives in {rule} % of the fields, a learned policy in {learned} %. A delivery leads through {fields} "
        "new fields one after the other, and a failure in any of them ends it. With which probabilities do the two "
        "arrive?",
        Table(
            ["probability"],
            ["rule", "learned policy"],
            [answer.tolist()],
            wrong={
                "Every field must be crossed, so the rates are multiplied, once for each field.": [
                    rates.tolist()
                ],
                "These are the probabilities of at least one failure.": [
                    (1 - answer).tolist()
                ],
                "Failures do not add up: a robot that failed in one field does not reach the next.": [
                    (1 - fields * (1 - rates)).tolist()
                ],
            },
        ),
        f"Rule: ${rates[0]:g}^{{{fields}}} = {answer[0]:.3g}$. Learned policy: ${rates[1]:g}^{{{fields}}} = "
        f"{answer[1]:.3g}$. A difference that is small in one field is large in {fields}.",
    )


FIRST, SECOND, OPEN = (
    "The first policy is better",
    "The second policy is better",
    "The test does not show which is better",
)


def _interval(arrived: int, maps: int) -> tuple[float, float]:
    """The 95 % interval by the formula of the question, within 0 and 1."""
    p = arrived / maps
    half = 2 * (p * (1 - p) / maps) ** 0.5
    return max(p - half, 0.0), min(p + half, 1.0)


def _shown(first: tuple[float, float], second: tuple[float, float]) -> str:
    """What two intervals show."""
    if first[0] > second[1]:
        return FIRST
    return SECOND if second[0] > first[1] else OPEN


@drill("conclusions", "Is the difference more than chance?")
def more_than_chance(rng: Rng) -> Question:
    """Judge a difference of success rates by the number of maps."""
    right = str(rng.choice([FIRST, SECOND, OPEN]))
    while True:
        maps = int(rng.choice([20, 50, 100, 400, 1000]))
        rates = rng.choice(np.arange(60, 98), size=2, replace=False) / 100
        arrived = [int(n) for n in np.round(rates * maps)]
        (low, high), (other_low, other_high) = (_interval(n, maps) for n in arrived)
        exact = _shown(*(success_interval(n, maps) for n in arrived))
        half = max(high - low, other_high - other_low) / 2
        gap = abs(arrived[0] - arrived[1]) / maps
        plain = arrived[0] != arrived[1] and (gap < half or gap > 3 * half)
        if plain and right == exact == _shown((low, high), (other_low, other_high)):
            break
    intervals = (
        f"{100 * low:.1f} to {100 * high:.1f} %",
        f"{100 * other_low:.1f} to {100 * other_high:.1f} %",
    )
    apart = f"The 95 % intervals are {intervals[0]} and {intervals[1]}: "
    hints = {
        FIRST: "it arrives less often." if arrived[0] < arrived[1] else "they overlap.",
        SECOND: "it arrives less often."
        if arrived[1] < arrived[0]
        else "they overlap.",
        OPEN: "they do not overlap.",
    }
    return Question(
        f"In {maps} new maps the first policy arrives {arrived[0]} times and the second {arrived[1]} "
        f"times. Compare their "
        "95 % intervals, about $p \\pm 2 \\sqrt{p (1 - p) / n}$. What does the test show?",
        Choice(
            right,
            {option: apart + hint for option, hint in hints.items() if option != right},
            order=(FIRST, SECOND, OPEN),
        ),
        apart
        + (
            "they overlap. This does not show that both are equally good."
            if right == OPEN
            else "they do not overlap."
        ),
    )
