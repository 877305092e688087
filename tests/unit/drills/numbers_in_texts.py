"""The numbers in the text of a question, from which a test works the answer out in its own way."""

from __future__ import annotations

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


def drawn(name: str) -> list[Question]:
    """Some questions of a drill."""
    return [DRILLS[name].question(seed) for seed in SEEDS]
