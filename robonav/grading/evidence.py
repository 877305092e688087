"""All that one submission answered to one exercise, and the hint that follows from it.

A wrong answer often fits several known mistakes. Only what all parts together show tells which one it is: a mistake
that would have failed a call which the student answered rightly is not the student's. Hints are therefore chosen when
all parts have run.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from . import compare
from .grade import Part
from .reference import Case, Reference

NOT_FINITE = (
    "The answer holds {what}. Look for a division by zero, the logarithm of zero, an exponential that is too large, or "
    "infinity times zero."
)
TRANSPOSED = "Rows and columns are exchanged: the transpose of your answer is right."


@dataclass(eq=False)
class Observation:
    """One call of the student's function.

    Attributes
    ----------
    case : Case
        The call.
    got : object
        The answer, or ``{"raised": kind}`` for an exception.
    expected : object
        The right answer.
    verdict : str
        ``open`` where a right answer need not equal the expected one.
    """

    case: Case
    got: Any
    expected: Any
    verdict: Literal["open", "right", "wrong"]


class Evidence:
    """The calls of one student's function, in all parts of an exercise."""

    def __init__(self, reference: Reference, names: Sequence[str] = ()) -> None:
        self.reference = reference
        self.names = names  # of the function's arguments
        self.observations: list[Observation] = []
        self.changed = False  # whether a change of an argument has cost a part already

    def observe(
        self,
        case: Case,
        got: Any,
        expected: Any,
        verdict: Literal["open", "right", "wrong"] = "open",
    ) -> None:
        """Keep a call and its answer."""
        self.observations.append(Observation(case, got, expected, verdict))

    def judge(self, verdict: Literal["right", "wrong"]) -> None:
        """Say whether the last answer was right."""
        self.observations[-1].verdict = verdict

    def explained(self, parts: Iterable[Part]) -> list[Part]:
        """Return the parts, those that failed with the hint for them."""
        return [self._explained(part) for part in parts]

    def first_failure(self) -> Observation | None:
        """Return the first call that was answered wrongly, or None."""
        wrong = [one for one in self.observations if one.verdict == "wrong"]
        return wrong[0] if wrong else None

    def _explained(self, part: Part) -> Part:
        if part.state not in ("wrong", "error"):
            return part
        failed = [
            one
            for one in self.observations
            if one.case.part == part.test and one.verdict == "wrong"
        ]
        hint = self._hint(failed[0]) if failed else None
        return (
            replace(part, feedback=f"{part.feedback}\nHint: {hint}") if hint else part
        )

    def _hint(self, observation: Observation) -> str | None:
        """Return the hint of the known mistake that fits this call and contradicts no other."""
        best, hint = 0, None
        for name, said, value in self.reference.mistakes(observation.case):
            if compare.difference(observation.got, value) is not None:
                continue
            if (fits := self._fits(name)) > best:
                best, hint = fits, said
        return hint or _plain_hint(observation)

    def _fits(self, name: str) -> int:
        """Return how many wrong answers a mistake explains, or 0 if an answer that was right excludes it."""
        fits = 0
        for observation in self.observations:
            would_be = {
                known: value
                for known, _, value in self.reference.mistakes(observation.case)
            }
            if name not in would_be:
                continue
            if observation.verdict == "right":
                return 0
            fits += compare.difference(observation.got, would_be[name]) is None
        return fits


def _plain_hint(observation: Observation) -> str | None:
    """Return a hint that needs no known mistake."""
    got, expected = (
        compare.as_numbers(value) for value in (observation.got, observation.expected)
    )
    several = isinstance(observation.got, list | tuple)
    for value in [observation.got, *(observation.got if several else [])]:
        numbers = compare.as_numbers(value)
        if numbers is not None and not np.isfinite(numbers).all():
            what = "nan" if np.isnan(numbers).any() else "infinity"
            return NOT_FINITE.format(what=what)
    if got is None or expected is None or got.ndim != 2:
        return None
    return TRANSPOSED if compare.difference(got.T, expected) is None else None
