"""Drills of the page that compares all methods."""

from __future__ import annotations

import math

import numpy as np

from robonav.benchmark import pareto_front, spl

from ..question import Choice, Number, Question, Table
from ..registry import drill

Rng = np.random.Generator
PAGE = "methods-compared"
NAMES = ("A", "B", "C", "D")


def _listed(names: list[str]) -> str:
    """Names as words: "A", "A and B", "A, B and C"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


@drill(PAGE, "Which methods are not beaten?")
def not_beaten(rng: Rng) -> Question:
    """Find the Pareto front of four methods with two criteria."""
    success = rng.choice(np.arange(70, 100), 4, replace=False)
    ways = rng.choice(np.arange(60, 95), 4, replace=False)
    front = pareto_front(np.column_stack([success, ways]))
    right = [name for name, on in zip(NAMES, front, strict=True) if on]
    best = [NAMES[int(success.argmax())]]
    both = sorted({*best, NAMES[int(ways.argmax())]})
    hints = {
        _listed(
            best
        ): "This method arrives most often. Another one may have shorter ways.",
        _listed(
            both
        ): "Besides the best of each criterion, a method between them may not be beaten either; or one "
        "method is the best in both.",
        _listed(
            list(NAMES)
        ): "Look for a method that another one beats in both criteria.",
        _listed(
            [name for name in NAMES if name not in right] or ["A"]
        ): "These are beaten.",
    }
    beaten = [name for name in NAMES if name not in right]
    for name in beaten:
        more = _listed(sorted([*right, name]))
        hints.setdefault(more, f"Compare {name} with each of the others: one is better in both.")  # fmt: skip
    hints.pop(_listed(right), None)
    wrong = dict(list(hints.items())[:3])
    why = "; ".join(
        f"{name} is beaten by "
        + NAMES[int(np.flatnonzero((success > success[k]) & (ways > ways[k]))[0])]
        for k, name in enumerate(NAMES)
        if name in beaten
    )
    lines = "; ".join(
        f"{name}: {s} % and {w} %"
        for name, s, w in zip(NAMES, success, ways, strict=True)
    )
    return Question(
        f"Four methods with their success and their SPL: {lines}. Which of them are not beaten, so that no other "
        "method is better in both?",
        Choice(_listed(right), wrong),
        f"{why or 'No method is better than another one in both'}. Not beaten: {_listed(right)}.",
    )


@drill(PAGE, "SPL of four episodes")
def spl_of_four_episodes(rng: Rng) -> Question:
    """Compute the success weighted by path length."""
    success = np.array([True, True, True, False])
    while True:
        shortest = rng.choice([80.0, 90.0, 100.0, 110.0, 120.0], 4)
        lengths = shortest + 10.0 * rng.integers(1, 8, size=4)
        answer = spl(success, lengths, shortest)
        ratios = shortest / lengths
        near = np.sort([answer, 0.75, ratios[:3].mean(), ratios.mean()])
        if np.diff(near).min() > 0.02:
            break
    lines = "; ".join(
        f"{s:g} m and {own:g} m" for s, own in zip(shortest, lengths, strict=True)
    )
    return Question(
        "The lengths of the shortest path and of the robot's own path in four episodes are "
        f"{lines}. The first three episodes arrive, and the last one collides. What is the SPL, from 0 to 1?",
        Number(
            answer,
            wrong={
                "An episode that fails counts as 0, and it is counted.": float(
                    ratios[:3].mean()
                ),
                "This is the success rate alone. An arrival counts less, the longer its way was.": 0.75,
                "The episode that collides has an SPL of 0, whatever its way was.": float(
                    ratios.mean()
                ),
            },
        ),
        f"$({' + '.join(f'{s:g}/{own:g}' for s, own in zip(shortest[:3], lengths[:3], strict=True))} + 0) / 4 "
        f"= {answer:.4g}$.",
    )


@drill(PAGE, "Days with a real robot")
def days_with_a_robot(rng: Rng) -> Question:
    """Compute how long methods take to learn with a real robot."""
    episodes = np.array([50, 100, 150]) + 10 * rng.integers(0, 5, size=3)
    episodes[2] *= 10
    seconds = int(rng.choice([45, 50, 75, 90, 120]))
    answer = episodes * seconds / 3600
    return Question(
        f"With a real robot an episode lasts {seconds} s. DAgger needs {episodes[0]} episodes, NNQL {episodes[1]}, and "
        f"PPO {episodes[2]}. How many hours does the robot of each drive?",
        Table(
            ["DAgger", "NNQL", "PPO"],
            ["hours"],
            [[float(hours)] for hours in answer],
            wrong={
                "These are minutes.": [[60 * float(hours)] for hours in answer],
                "Multiply by the seconds of an episode, too.": [
                    [float(number) / 60] for number in episodes
                ],
            },
        ),
        f"Episodes times {seconds} s, divided by 3,600 s: "
        + ", ".join(
            f"$ {number} \\cdot {seconds} / 3600 = {hours:.4g}$"
            for number, hours in zip(episodes, answer, strict=True)
        )
        + " hours.",
    )


@drill(PAGE, "How many worlds show the difference?")
def worlds_to_see_a_failure(rng: Rng) -> Question:
    """Compute how many worlds are needed until a rare failure is probably seen."""
    success = float(rng.integers(930, 999)) / 10
    surely = int(rng.choice([80, 90, 95, 99]))
    rate, miss = success / 100, 1 - surely / 100
    exact = math.log(miss) / math.log(rate)
    answer = math.ceil(exact)
    return Question(
        f"A policy arrives in {success:g} % of the worlds. In how many worlds must you test it, so that you see at "
        f"least one failure with a probability of {surely} % or more? Round up to a whole number.",
        Number(
            answer,
            tolerance=0.4,
            wrong={
                "After so many worlds you expect one failure on average, which is another question.": 1
                / (1 - rate),
                "With so many worlds the probability is still a little too small. Round up.": math.floor(
                    exact
                ),
                "Take the probability of no failure at all, which is 1 less the one that is given.": math.ceil(
                    math.log(surely / 100) / math.log(rate)
                ),
            },
        ),
        f"All of $n$ worlds go well with the probability ${rate:.4g}^n$. It is at most {miss:.4g} from "
        f"$n = \\ln {miss:.4g} / \\ln {rate:.4g} = {exact:.5g}$ on, so from {answer} on.",
    )
