"""Kinds of answers as papers and learning platforms know them: numbers, options, and steps in order."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ..question import Asked, Choice, Number, Order, Place, Question, Table
from ..rounding import roundings, too_far

CLICK = re.compile(r"\b([Cc])lick (?:on|at)\b")


@dataclass(frozen=True)
class Option:
    """One of the answers that a reader chooses from.

    Attributes
    ----------
    text : str
        The answer, in Markdown.
    right : bool
        Whether it is right.
    hint : str
        What is said to a reader who chooses it, in Markdown; empty if it is right or no usual mistake.
    """

    text: str
    right: bool
    hint: str = ""


@dataclass(frozen=True)
class Cell:
    """One cell of a table that a reader fills in.

    Attributes
    ----------
    row, column : str
        The headings, in Markdown.
    number : Number
        The right number, and the usual wrong ones with the hints of the tables that have them there.
    """

    row: str
    column: str
    number: Number


def options(asked: Choice | Place) -> list[Option]:
    """Return the options of a choice, or the places of a picture.

    Parameters
    ----------
    asked : Choice or Place

    Returns
    -------
    list of Option

    Examples
    --------
    >>> [(option.text, option.right) for option in options(Place(["A", "B"], right=["B"]))]
    [('A', False), ('B', True)]
    """
    if isinstance(asked, Choice):
        return [
            Option(text, text == asked.right, asked.wrong.get(text, ""))
            for text in asked.options
        ]
    return [
        Option(place, place in asked.right, asked.wrong.get(place, ""))
        for place in asked.places
    ]


def cells(table: Table) -> list[list[Cell]]:
    """Return the cells of a table, row by row, each as a number with usual wrong ones.

    Parameters
    ----------
    table : Table

    Returns
    -------
    list of list of Cell

    Examples
    --------
    >>> table = Table(["V"], ["A", "B"], [[1.0, 2.0]], wrong={"B was updated first.": [[1.5, 2.0]]})
    >>> [(cell.column, cell.number.answer, dict(cell.number.wrong)) for cell in cells(table)[0]]
    [('A', 1.0, {'B was updated first.': 1.5}), ('B', 2.0, {})]
    """
    return [
        [
            Cell(row, column, _number_of_cell(table, i, j))
            for j, column in enumerate(table.columns)
        ]
        for i, row in enumerate(table.rows)
    ]


def _number_of_cell(table: Table, i: int, j: int) -> Number:
    """One cell; a wrong number that several tables share there has the hint of the first."""
    answer, tolerance = float(table.answer[i][j]), table.tolerance
    wrong: dict[str, float] = {}
    for hint, mistaken in table.wrong.items():
        number = float(mistaken[i][j])
        others = [answer, *wrong.values()]
        if all(abs(number - other) > 2 * tolerance for other in others):
            wrong[hint] = number
    return Number(answer, tolerance, wrong)


def mistakes(asked: Number) -> list[tuple[str, float]]:
    """Return the wrong numbers that have a hint: usual ones, and the right one rounded too far.

    Parameters
    ----------
    asked : Number

    Returns
    -------
    list of (str, float)
        The hint of each, and the number.

    Examples
    --------
    >>> mistakes(Number(0.72, wrong={"The reward of the step is missing.": 0.648}))[1]
    ('This is rounded too far: give two decimals.', 0.7)
    """
    hint = too_far(asked.tolerance)
    rounded = roundings(asked.answer, asked.tolerance)
    told = [(hint, number) for number in rounded if asked.judge(number).hint == hint]
    return [*asked.wrong.items(), *told]


def points(asked: Asked) -> int:
    """Return what an answer counts: 1 for a choice, 2 for a number or an order, and 1 for each cell of a table.

    Parameters
    ----------
    asked : Number, Choice, Place, Order or Table

    Returns
    -------
    int

    Examples
    --------
    >>> points(Number(0.5)), points(Choice("up", {"left": ""}))
    (2, 1)
    """
    if isinstance(asked, Table):
        return len(asked.rows) * len(asked.columns)
    return 2 if isinstance(asked, Number | Order) else 1


def asked_text(question: Question) -> str:
    """Return what a question asks, for readers who have neither the page's picture to click on nor its form.

    Parameters
    ----------
    question : Question

    Returns
    -------
    str
        Markdown.

    Examples
    --------
    >>> asked_text(Question("Click on the goal.", Place(["A", "B"], ["B"]), "B."))
    'Choose the goal.'
    >>> asked_text(Question("What is $1 / 3$?", Number(1 / 3), "A third."))
    'What is $1 / 3$? Give two decimals.'
    """
    if question.decimals:
        return f"{question.text} Give {question.decimals}."
    if not isinstance(question.asked, Place):
        return question.text
    return CLICK.sub(lambda found: f"{found[1]}hoose", question.text)


def number_text(number: float) -> str:
    """Return a number with at most 15 significant digits, as files have it.

    Examples
    --------
    >>> number_text(0.1 + 0.2), number_text(3)
    ('0.3', '3')
    """
    text = f"{float(number):.15g}"
    return "0" if text == "-0" else text
