"""What a drill asks, and how an answer is judged.

A question has a text, the kind of answer that it asks for, and a worked explanation. There are five kinds of answer:
a :class:`Number`, a :class:`Choice`, a :class:`Place` in the picture, an :class:`Order` of steps, and a
:class:`Table` to fill in. Each knows its right answer and usual wrong ones, each with a hint. Texts are Markdown with
formulas between dollar signs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, pairwise
from typing import Any

from .rounding import decimals, rounded_too_far, too_far, words


@dataclass(frozen=True)
class Verdict:
    """Whether an answer is right, and the hint that a usual wrong answer gets.

    Attributes
    ----------
    right : bool
        Whether the answer is right.
    hint : str
        What went wrong, in a sentence; empty if the answer is right or if the mistake is not a usual one.

    Examples
    --------
    >>> from robonav.drills import Verdict
    >>> Verdict(False, "The discount is missing.").hint
    'The discount is missing.'
    """

    right: bool
    hint: str = ""


RIGHT = Verdict(True)
_Flat = list[float]


SLACK = 1e-7  # pages hold numbers with eight decimals, and judge alike


def _near(number: float, answer: float, tolerance: float) -> bool:
    return abs(number - answer) <= tolerance + SLACK


@dataclass(frozen=True)
class Number:
    """A number is asked for.

    Attributes
    ----------
    answer : float
        The right number.
    tolerance : float
        An answer is right if it differs by at most this much, so that rounding costs nothing.
    wrong : mapping of str to float
        Usual wrong numbers by their hint.
    unit : str
        What stands behind the field, such as "m".

    Examples
    --------
    >>> asked = Number(0.72, wrong={"The reward of the step is missing.": 0.648})
    >>> asked.judge(0.7201).right, asked.judge(0.648).hint
    (True, 'The reward of the step is missing.')
    """

    answer: float
    tolerance: float = 0.0051
    wrong: Mapping[str, float] = field(default_factory=dict)
    unit: str = ""

    def judge(self, answer: float) -> Verdict:
        """Compare a number with the right one, then with the usual wrong ones, then with what rounding makes of it.

        Parameters
        ----------
        answer : float
            What the reader typed.

        Returns
        -------
        Verdict
            Its hint is that of the usual wrong number that the answer is near to, or says that the answer is rounded
            too far.

        Examples
        --------
        >>> from robonav.drills import Number
        >>> Number(0.72, wrong={"The reward of the step is missing.": 0.648}).judge(0.65)
        Verdict(right=False, hint='The reward of the step is missing.')
        """
        if _near(self.answer, answer, self.tolerance):
            return RIGHT
        hints = (
            hint
            for hint, number in self.wrong.items()
            if _near(number, answer, self.tolerance)
        )
        rounded = rounded_too_far(answer, self.answer, self.tolerance)
        return Verdict(False, next(hints, too_far(self.tolerance) if rounded else ""))

    @property
    def clear(self) -> bool:
        """Whether every usual wrong number can be told from the right one and from the others."""
        numbers = sorted((self.answer, *self.wrong.values()))
        gaps = (after - before for before, after in pairwise(numbers))
        return all(map(math.isfinite, numbers)) and all(
            gap > 2 * (self.tolerance + SLACK) for gap in gaps
        )


@dataclass(frozen=True)
class Choice:
    """One of a few answers is asked for.

    Attributes
    ----------
    right : str
        The right answer.
    wrong : mapping of str to str
        The hint of each wrong answer.
    order : sequence of str, optional
        The order in which the answers are shown, if they have an order of their own, as numbers have. A drill shuffles
        the others.

    Examples
    --------
    >>> asked = Choice("up", wrong={"left": "Q(s, left) is smaller."})
    >>> asked.judge("left")
    Verdict(right=False, hint='Q(s, left) is smaller.')
    """

    right: str
    wrong: Mapping[str, str]
    order: Sequence[str] = ()

    @property
    def options(self) -> tuple[str, ...]:
        """All answers in the order in which they are shown."""
        return tuple(self.order or sorted((self.right, *self.wrong)))

    def judge(self, answer: str) -> Verdict:
        """Compare an option with the right one.

        Parameters
        ----------
        answer : str
            The option that the reader chose.

        Returns
        -------
        Verdict
            Its hint is that of the option.

        Examples
        --------
        >>> from robonav.drills import Choice
        >>> Choice("SARSA", {"Q-learning": "It learns off-policy."}).judge("Q-learning").hint
        'It learns off-policy.'
        """
        return RIGHT if answer == self.right else Verdict(False, self.wrong[answer])

    @property
    def clear(self) -> bool:
        """Whether all answers differ."""
        return sorted(self.options) == sorted({self.right, *self.wrong}) and (
            len(self.wrong) + 1 == len(self.options)
        )


@dataclass(frozen=True)
class Place:
    """A click on a place in the picture is asked for.

    Attributes
    ----------
    places : sequence of str
        The names of all places that can be clicked, as the picture has them.
    right : sequence of str
        The places that are right; one of them is enough.
    wrong : mapping of str to str
        Hints of wrong places by name. The others get none.

    Examples
    --------
    >>> Place(["A", "B"], right=["B"], wrong={"A": "A was expanded already."}).judge("A").hint
    'A was expanded already.'
    """

    places: Sequence[str]
    right: Sequence[str]
    wrong: Mapping[str, str] = field(default_factory=dict)

    def judge(self, answer: str) -> Verdict:
        """Look whether a place is one of the right ones.

        Parameters
        ----------
        answer : str
            The name of the place that the reader touched.

        Returns
        -------
        Verdict
            Its hint is that of the place, if it has one.

        Examples
        --------
        >>> from robonav.drills import Place
        >>> Place(["cell-0", "cell-1"], right=["cell-1"], wrong={}).judge("cell-1").right
        True
        """
        if answer in self.right:
            return RIGHT
        return Verdict(False, self.wrong.get(answer, ""))

    @property
    def clear(self) -> bool:
        """Whether some place is right and some place is wrong."""
        return 0 < len(set(self.right)) < len(set(self.places)) and not (
            set(self.right) & set(self.wrong)
        )


@dataclass(frozen=True)
class Order:
    """Steps are to be put in order.

    Attributes
    ----------
    steps : sequence of str
        The steps in the right order.
    hint : str
        What an answer in another order gets, unless a hint of two steps fits.
    before : mapping of (int, int) to str
        Hints of pairs: what is said if step i stands behind step j, although it must come first.

    Examples
    --------
    >>> asked = Order(["sense", "act", "learn"], before={(1, 2): "There is nothing to learn from yet."})
    >>> asked.judge([0, 2, 1]).hint
    'There is nothing to learn from yet.'
    """

    steps: Sequence[str]
    hint: str = ""
    before: Mapping[tuple[int, int], str] = field(default_factory=dict)

    def judge(self, answer: Sequence[int]) -> Verdict:
        """Compare an order, given by the steps' indices, with the right one.

        Parameters
        ----------
        answer : sequence of int
            The indices of the steps, in the reader's order.

        Returns
        -------
        Verdict
            Its hint is that of the first pair of steps that stands the wrong way round, or the general one.

        Examples
        --------
        >>> from robonav.drills import Order
        >>> Order(["evaluate", "improve"], hint="Values come first.").judge([1, 0]).hint
        'Values come first.'
        """
        if list(answer) == list(range(len(self.steps))):
            return RIGHT
        place = {step: k for k, step in enumerate(answer)}
        hints = (hint for (i, j), hint in self.before.items() if place[i] > place[j])
        return Verdict(False, next(hints, self.hint))

    @property
    def clear(self) -> bool:
        """Whether all steps differ."""
        return len(set(self.steps)) == len(self.steps) > 1


@dataclass(frozen=True)
class Table:
    """The empty cells of a table are to be filled with numbers.

    Attributes
    ----------
    rows, columns : sequence of str
        The headings.
    answer : sequence of sequence of float
        The right numbers, row by row.
    tolerance : float
        How much each number may differ.
    wrong : mapping of str to sequence of sequence of float
        Usual wrong tables by their hint. An answer gets the hint of the table that it equals, or else of the first
        table with which it agrees in all cells in which that table is wrong.

    Examples
    --------
    >>> asked = Table(["V"], ["A", "B"], [[1.0, 2.0]], wrong={"B was updated first.": [[1.5, 2.0]]})
    >>> asked.judge([[1.5, 7.0]]).hint
    'B was updated first.'
    """

    rows: Sequence[str]
    columns: Sequence[str]
    answer: Sequence[Sequence[float]]
    tolerance: float = 0.0051
    wrong: Mapping[str, Sequence[Sequence[float]]] = field(default_factory=dict)

    def judge(self, answer: Sequence[Sequence[float]]) -> Verdict:
        """Compare a table with the right one, then with the usual wrong ones, then with what rounding makes of it.

        Parameters
        ----------
        answer : sequence of sequence of float
            The rows that the reader filled in.

        Returns
        -------
        Verdict
            Its hint is that of a wrong table that the answer equals or shares its mistakes with, or says that the
            answer is rounded too far.

        Examples
        --------
        >>> from robonav.drills import Table
        >>> Table(["V"], ["s1"], [[0.9]], wrong={"The discount is missing.": [[1.0]]}).judge([[1.0]]).hint
        'The discount is missing.'
        """
        given, right = _flat(answer), _flat(self.answer)
        if self._equals(given, right, right):
            return RIGHT
        tables = [(hint, _flat(table)) for hint, table in self.wrong.items()]
        equal = (h for h, table in tables if self._equals(given, table, right))
        rounded = [too_far(self.tolerance)] * self._is_rounded(given, right)
        alike = (h for h, table in tables if self._makes_its_mistakes(given, table, right))  # fmt: skip
        return Verdict(False, next(chain(equal, rounded, alike), ""))

    def _is_rounded(self, given: _Flat, right: _Flat) -> bool:
        """Whether each number is right, or would be if it were not rounded too far."""
        return all(
            self._is(a, b) or rounded_too_far(a, b, self.tolerance)
            for a, b in zip(given, right, strict=True)
        )

    def _is(self, number: float, answer: float) -> bool:
        return _near(number, answer, self.tolerance)

    def _equals(self, given: _Flat, table: _Flat, right: _Flat) -> bool:
        return all(self._is(a, b) for a, b in zip(given, table, strict=True))

    def _makes_its_mistakes(self, given: _Flat, table: _Flat, right: _Flat) -> bool:
        cells = zip(given, table, right, strict=True)
        mistaken = [(a, b) for a, b, good in cells if not self._is(b, good)]
        return bool(mistaken) and all(self._is(a, b) for a, b in mistaken)

    @property
    def clear(self) -> bool:
        """Whether every usual wrong table differs from the right one, and from the others, in some cell."""
        tables = [_flat(self.answer), *map(_flat, self.wrong.values())]
        return all(
            any(
                abs(a - b) > 2 * (self.tolerance + SLACK)
                for a, b in zip(one, other, strict=True)
            )
            for k, one in enumerate(tables)
            for other in tables[:k]
        )


def _flat(table: Sequence[Sequence[float]]) -> list[float]:
    return [number for row in table for number in row]


Asked = Number | Choice | Place | Order | Table


@dataclass(frozen=True)
class Question:
    """One question of a drill, with its own numbers.

    Attributes
    ----------
    text : str
        The question, in Markdown.
    asked : Number or Choice or Place or Order or Table
        The kind of answer, with the right one and the usual wrong ones.
    explanation : str
        The way to the answer with the numbers of this question, in Markdown.
    picture : str
        An SVG picture, or nothing.

    Examples
    --------
    >>> question = Question("What is $2 + 3$?", Number(5, wrong={"This is the product.": 6}), "$2 + 3 = 5$.")
    >>> question.asked.judge(6).hint
    'This is the product.'
    """

    text: str
    asked: Asked
    explanation: str
    picture: str = ""

    @property
    def clear(self) -> bool:
        """Whether the right answer can be told from every usual wrong one."""
        return self.asked.clear

    @property
    def decimal_places(self) -> int:
        """How many decimals the numbers of an answer need: 0 where no number is asked for or all numbers are whole."""
        asked = self.asked
        if not isinstance(asked, Number | Table):
            return 0
        if isinstance(asked, Number):
            numbers = [asked.answer, *asked.wrong.values()]
        else:
            numbers = [*chain(*asked.answer), *chain(*chain(*asked.wrong.values()))]
        whole = all(round(float(number), 8).is_integer() for number in numbers)
        return 0 if whole else decimals(asked.tolerance)

    @property
    def decimals(self) -> str:
        """How many decimals the numbers of an answer need, in words; empty where the text says it."""
        return "" if "decimal" in self.text else words(self.decimal_places)

    def judge(self, answer: Any) -> Verdict:
        """Judge an answer of the kind that is asked for.

        Parameters
        ----------
        answer : object
            An answer as the kind of answer that is asked for takes it.

        Returns
        -------
        Verdict

        Examples
        --------
        >>> from robonav.drills import Number, Question
        >>> Question("What is 1 / 4?", Number(0.25), explanation="A quarter.").judge(0.25).right
        True
        """
        return self.asked.judge(answer)
