"""Questions as items of a QTI package: one number, one choice or one order each, with texts in HTML."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from ..markup import block, html
from ..question import Choice, Number, Order, Place, Table
from .answers import (
    Cell,
    Option,
    asked_text,
    cells,
    mistakes,
    number_text,
    options,
    points,
)
from .selection import Drawn
from .svg import png, read


@dataclass(frozen=True)
class Item:
    """One item, whose answer is one number, one choice or one order.

    Attributes
    ----------
    name : str
        Letters, digits and hyphens, such as "td-error-1".
    title : str
        What a list of questions shows.
    text : str
        The question in HTML, with its picture.
    asked : Number, list of Option, or Order
        The kind of answer.
    mistakes : str
        Hints for wrong answers in HTML; empty if each option has its own.
    explanation : str
        The worked explanation in HTML.
    points : int
        What it counts.
    picture : bytes
        A PNG picture, or nothing. Its file is named after the item.
    """

    name: str
    title: str
    text: str
    asked: Number | list[Option] | Order
    mistakes: str
    explanation: str
    points: int
    picture: bytes = b""

    @property
    def file(self) -> str:
        """The name of the picture's file."""
        return f"{self.name}.png"


def items(questions: Sequence[Drawn]) -> list[Item]:
    """Return questions as items. A table becomes an item for each of its cells.

    Parameters
    ----------
    questions : sequence of Drawn

    Returns
    -------
    list of Item

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> [item.name for item in items(drawn(selected(drills=["td-error", "softmax"])))]
    ['td-error-1', 'softmax-1-a', 'softmax-1-b']
    """
    made = []
    for one in questions:
        asked = one.question.asked
        if isinstance(asked, Table):
            fields = [cell for row in cells(asked) for cell in row]
            made += [
                _item(one, f"-{chr(ord('a') + k)}", cell.number, _place_of(cell), 1)
                for k, cell in enumerate(fields)
            ]
        else:
            plain = options(asked) if isinstance(asked, Choice | Place) else asked
            made.append(_item(one, "", plain, "", points(asked)))
    return made


def _place_of(cell: Cell) -> str:
    """Which cell is asked for."""
    return f"<p>Answer for: {html(cell.row)}, {html(cell.column)}.</p>"


def _item(
    one: Drawn, letter: str, asked: Number | list[Option] | Order, more: str, worth: int
) -> Item:
    question, name = one.question, one.name + letter
    text = block(asked_text(question))
    if question.picture:
        alt = escape(read(question.picture).title)
        text += f'<p><img src="{name}.png" alt="{alt}" /></p>'
    if isinstance(asked, Number) and asked.unit:
        more += f"<p>Answer in {html(asked.unit)}.</p>"
    return Item(
        name,
        f"{one.drill.title} {one.number}{letter.replace('-', '')}",
        text + more,
        asked,
        _mistakes(asked),
        block(question.explanation),
        worth,
        png(question.picture) if question.picture else b"",
    )


def _mistakes(asked: Number | list[Option] | Order) -> str:
    """The hints of wrong answers that a platform cannot tell apart."""
    if isinstance(asked, Number) and (told := mistakes(asked)):
        lines = "".join(
            f"<li>{number_text(round(number, 4))}: {html(hint)}</li>"
            for hint, number in told
        )
        return f"<p>Is this your answer?</p><ul>{lines}</ul>"
    if isinstance(asked, Order):
        hints = [*asked.before.values(), asked.hint]
        return "".join(block(hint) for hint in hints if hint)
    return ""
