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
    "The answer holds {what}. If you do not put it there yourself, look for a division by zero, the logarithm of zero, "
    "an exponential that is too large, or infinity times zero."
)
NEAR = "All numbers are nearly right. Perhaps an iteration stops too early, or a number is rounded."
NONE = "Your function returned None: does every way through it end in a return?"
TRANSPOSED = "Rows and columns are exchanged: the transpose of your answer is right."


Verdict = Literal["asked", "open", "right", "wrong"]


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
        ``open`` where a right answer need not equal the expected one, ``asked`` where there is no expected one.
    """

    case: Case
    got: Any
    expected: Any
    verdict: Verdict
    at: Any = None  # the places that counted, or None for all
    free: bool = False  # whether several answers are right
    advice: str | None = None  # a hint for an answer that matches no known mistake

    def counted(self, value: Any) -> Any:
        """Return a value with only those places that counted."""
        return value if self.at is None else compare.only(value, self.expected, self.at)


class Evidence:
    """The calls of one student's function, in all parts of an exercise."""

    def __init__(self, reference: Reference, names: Sequence[str] = ()) -> None:
        self.reference = reference
        self.names = names  # of the function's arguments
        self.observations: list[Observation] = []
        self.changed = False  # whether a change of an argument has cost a part already
        self._wrong: dict[Observation, dict[str, tuple[str, Any]]] = {}

    def observe(
        self,
        case: Case,
        got: Any,
        expected: Any,
        verdict: Verdict = "open",
        at: Any = None,
    ) -> None:
        """Keep a call and its answer."""
        self.observations.append(Observation(case, got, expected, verdict, at))

    def judge(self, verdict: Literal["right", "wrong"]) -> None:
        """Say whether the last answer was right. Of a right one, only the places that counted are kept."""
        last = self.observations[-1]
        if last.verdict != "asked":
            last.verdict = verdict
        if verdict == "right":
            last.got = last.counted(last.got)

    def leave_free(self) -> None:
        """Mark the last call as one with several right answers, in which wrong ones may agree by chance."""
        self.observations[-1].free = True

    def advise(self, hint: str | None) -> None:
        """Keep a hint for the last answer, in case it matches no known mistake."""
        self.observations[-1].advice = hint

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
            if one.case.part == part.test and (one.verdict == "wrong" or one.advice)
        ]
        hint = self._hint(failed[0]) if failed else None
        if not hint:
            return part
        return replace(part, feedback=f"{part.feedback}\nHint: {hint}", hint=hint)

    def _hint(self, observation: Observation) -> str | None:
        """Return the hint of the known mistake that fits this call and contradicts no other."""
        if _is_right(observation):
            return observation.advice
        best, hint = 0, None
        for name, (said, value) in self._mistakes(observation).items():
            if compare.difference(observation.counted(observation.got), value):
                continue
            if (fits := self._fits(name)) > best:
                best, hint = fits, said
        hint = hint or observation.advice or _plain_hint(observation)
        return None if hint == NEAR and self._any_is_far() else hint

    def _any_is_far(self) -> bool:
        """Whether a wrong answer is not even nearly right, so that another one may be near by chance."""
        return any(
            one.verdict == "wrong"
            and not compare.is_near(one.counted(one.got), one.expected)
            for one in self.observations
        )

    def _fits(self, name: str) -> int:
        """Return how many wrong answers a mistake explains, or 0 if an answer that was right excludes it."""
        fits = 0
        for observation in self.observations:
            if (found := self._mistakes(observation).get(name)) is None:
                continue
            if observation.verdict == "right":
                return 0
            got = observation.counted(observation.got)
            same = compare.difference(got, found[1]) is None
            if observation.free and not same:
                return 0
            fits += same
        return fits

    def _mistakes(self, observation: Observation) -> dict[str, tuple[str, Any]]:
        """Return hint and answer of the known mistakes that are wrong in the places that counted.

        They are kept, because each mistake that fits one call is compared with all others.
        """
        if observation not in self._wrong:
            self._wrong[observation] = self._wrong_where_counted(observation)
        return self._wrong[observation]

    def _wrong_where_counted(
        self, observation: Observation
    ) -> dict[str, tuple[str, Any]]:
        if observation.verdict == "asked" or observation.expected is None:
            return {}
        known = {
            name: (hint, observation.counted(value))
            for name, hint, value in self.reference.mistakes(observation.case)
        }
        if observation.at is None:
            return known
        return {
            name: (hint, value)
            for name, (hint, value) in known.items()
            if compare.difference(value, observation.expected) is not None
        }


def _not_finite(numbers: np.ndarray) -> str:
    """Return what an array holds besides finite numbers.

    Examples
    --------
    >>> _not_finite(np.array([1.0, -np.inf, np.nan]))
    'nan and infinity'
    """
    found = {"nan": np.isnan(numbers), "infinity": np.isinf(numbers)}
    return " and ".join(what for what, where in found.items() if where.any())


def _is_right(observation: Observation) -> bool:
    """Whether the answer is the expected one. The call failed for another reason, as if it changed an argument."""
    if observation.expected is None:
        return False
    answer = observation.counted(observation.got)
    return compare.difference(answer, observation.counted(observation.expected)) is None


def _plain_hint(observation: Observation) -> str | None:
    """Return a hint that needs no known mistake."""
    answer = observation.counted(observation.got)
    if answer is None and observation.expected is not None:
        return NONE
    several = isinstance(answer, list | tuple)
    for value in [answer, *(answer if several else [])]:
        numbers = compare.as_numbers(value)
        if numbers is not None and not np.isfinite(numbers).all():
            return NOT_FINITE.format(what=_not_finite(numbers))
    table = compare.as_numbers(answer)
    turned = table.T if table is not None and table.ndim == 2 else None
    if turned is not None and not compare.difference(turned, observation.expected):
        return TRANSPOSED
    return NEAR if compare.is_near(answer, observation.expected) else None
