"""Questions, each drawn once for all tests, and the numbers in their texts, from which a test works the answer out."""

from __future__ import annotations

import functools
import re

from robonav.drills import DRILLS, Question

SEEDS = range(50)
NAMES = re.compile(
    r"TD\(0\)|Eq\. \(\d\.\d+\)|Table 3\.1|[A-Za-z]_\{?[\w+]+\}?|[LR][36]0"
    r"|sensors? 1( to 9)?|0 to 7|0 to 1|0 becomes \$1/2\$"
)


def numbers(text: str) -> list[float]:
    """All numbers of a text, in order; those in names such as G_0, TD(0) and L30 are left out."""
    return [
        float(number)
        for number in re.findall(r"(?<![\w.])-?\d+\.?\d*", NAMES.sub("", text))
    ]


@functools.cache
def question_of(name: str, seed: int) -> Question:
    """The question of a drill with a seed. Many tests look at the same ones, and some take long to draw."""
    return DRILLS[name].question(seed)


def drawn(name: str) -> list[Question]:
    """Some questions of a drill."""
    return [question_of(name, seed) for seed in SEEDS]
