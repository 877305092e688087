"""Questions as Moodle XML, which a course's question bank imports."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape
from xml.etree import ElementTree

from ..markup import block, html
from ..question import Choice, Number, Order, Place, Table
from .answers import (
    Cell,
    asked_text,
    cells,
    mistakes,
    number_text,
    options,
    points,
)
from .selection import Drawn, chapter_of
from .svg import png, read

Element = ElementTree.Element
PICTURE = "picture.png"


def moodle_xml(questions: Sequence[Drawn], title: str = "Robot learning") -> bytes:
    """Return questions as Moodle XML: a category for each page of the book, a question type for each kind of answer.

    A number becomes a numerical question, a choice or a place in a picture a multiple choice, an order an ordering
    question (Moodle 4.4 or later), and a table an embedded-answers (cloze) question. The usual wrong answers have their
    hints as feedback, and the worked explanation is the general feedback. Pictures are in the file.

    Parameters
    ----------
    questions : sequence of Drawn
    title : str, default "Robot learning"
        The name of the category that holds all others.

    Returns
    -------
    bytes
        The file, in UTF-8.

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> xml = moodle_xml(drawn(selected(drills=["td-error"])))
    >>> [question.get("type") for question in ElementTree.fromstring(xml)]
    ['category', 'numerical']
    """
    quiz = ElementTree.Element("quiz")
    category = ""
    for one in questions:
        folder = f"{title.replace('/', '//')}/Chapter {chapter_of(one.drill)}/{one.drill.page}"
        if folder != category:
            category = folder
            node = ElementTree.SubElement(quiz, "question", type="category")
            _text(node, "category", f"$course$/top/{folder}")
        quiz.append(_question(one))
    ElementTree.indent(quiz)
    return ElementTree.tostring(quiz, encoding="utf-8", xml_declaration=True)


def _question(one: Drawn) -> Element:
    question, asked = one.question, one.question.asked
    node = ElementTree.Element("question", type=_type(one))
    _text(node, "name", f"{one.drill.title} {one.number}")
    body = [block(asked_text(question))]
    if isinstance(asked, Number) and asked.unit:
        body.append(f"<p>Answer in {html(asked.unit)}.</p>")
    if question.picture:
        alt = escape(read(question.picture).title)
        body.append(f'<p><img src="@@PLUGINFILE@@/{PICTURE}" alt="{alt}"></p>')
    if isinstance(asked, Table):
        body.append(_cloze_table(asked))
    text = _html(node, "questiontext", "".join(body))
    if question.picture:
        file = ElementTree.SubElement(
            text, "file", name=PICTURE, path="/", encoding="base64"
        )
        file.text = base64.b64encode(png(question.picture)).decode()
    _html(node, "generalfeedback", block(question.explanation))
    if not isinstance(asked, Table):  # a cloze question counts its cells
        ElementTree.SubElement(node, "defaultgrade").text = str(points(asked))
    ElementTree.SubElement(node, "penalty").text = "0.3333333"
    ElementTree.SubElement(node, "hidden").text = "0"
    if isinstance(asked, Number):
        _numerical(node, asked)
    elif isinstance(asked, Choice | Place):
        _multichoice(node, asked)
    elif isinstance(asked, Order):
        _ordering(node, asked)
    tags = ElementTree.SubElement(node, "tags")
    for tag in (one.drill.page, one.drill.name):
        _text(tags, "tag", tag)
    return node


def _type(one: Drawn) -> str:
    asked = one.question.asked
    if isinstance(asked, Number):
        return "numerical"
    if isinstance(asked, Order):
        return "ordering"
    return "cloze" if isinstance(asked, Table) else "multichoice"


def _text(node: Element, tag: str, text: str) -> Element:
    child = ElementTree.SubElement(node, tag)
    ElementTree.SubElement(child, "text").text = text
    return child


def _html(node: Element, tag: str, text: str) -> Element:
    child = _text(node, tag, text)
    child.set("format", "html")
    return child


def _answer(node: Element, text: str, right: bool, hint: str, kind: str) -> Element:
    answer = _text(node, "answer", text)
    answer.set("fraction", "100" if right else "0")
    answer.set("format", kind)
    _html(answer, "feedback", html(hint))
    return answer


def _numerical(node: Element, asked: Number) -> None:
    for hint, number in (("", asked.answer), *mistakes(asked)):
        answer = _answer(
            node, number_text(number), not hint, hint, "moodle_auto_format"
        )
        tolerance = ElementTree.SubElement(answer, "tolerance")
        tolerance.text = number_text(_tolerance(asked, hint))
    for tag, text in (
        ("unitgradingtype", "0"),
        ("unitpenalty", "0.1"),
        ("showunits", "3"),
        ("unitsleft", "0"),
    ):
        ElementTree.SubElement(node, tag).text = text


def _tolerance(asked: Number, hint: str) -> float:
    """How much an answer may differ from the right number or a usual wrong one; a rounded number is exact."""
    return asked.tolerance if not hint or hint in asked.wrong else 0.0


def _multichoice(node: Element, asked: Choice | Place) -> None:
    ElementTree.SubElement(node, "single").text = "true"
    shuffled = "true" if isinstance(asked, Choice) else "false"
    ElementTree.SubElement(node, "shuffleanswers").text = shuffled
    ElementTree.SubElement(node, "answernumbering").text = "abc"
    for option in options(asked):
        _answer(node, html(option.text), option.right, option.hint, "html")


def _ordering(node: Element, asked: Order) -> None:
    for tag, text in (
        ("layouttype", "VERTICAL"),
        ("selecttype", "ALL"),
        ("selectcount", "0"),
        ("gradingtype", "ALL_OR_NOTHING"),
        ("showgrading", "SHOW"),
        ("numberingstyle", "none"),
    ):
        ElementTree.SubElement(node, tag).text = text
    for place, step in enumerate(asked.steps, start=1):
        answer = _html(node, "answer", html(step))
        answer.set("fraction", str(place))
        _html(answer, "feedback", "")
    hints = [hint for hint in (*asked.before.values(), asked.hint) if hint]
    _html(node, "incorrectfeedback", "".join(map(block, hints)))


def _cloze_table(table: Table) -> str:
    """A table whose cells are fields, in Moodle's notation of embedded answers."""
    head = "".join(f"<th>{html(column)}</th>" for column in table.columns)
    rows = "".join(
        f"<tr><th>{html(row[0].row)}</th>"
        + "".join(f"<td>{_field(cell)}</td>" for cell in row)
        + "</tr>"
        for row in cells(table)
    )
    return f"<table><tr><td></td>{head}</tr>{rows}</table>"


def _field(cell: Cell) -> str:
    """A field for a number: braces, tildes and hash signs of its feedback are written as character references."""
    answers = [
        f"={number_text(cell.number.answer)}:{number_text(cell.number.tolerance)}"
    ]
    for hint, number in mistakes(cell.number):
        feedback, tolerance = html(hint), number_text(_tolerance(cell.number, hint))
        for sign in "}~":
            feedback = feedback.replace(sign, f"&#{ord(sign)};")
        answers.append(f"%0%{number_text(number)}:{tolerance}#{feedback}")
    return "{1:NUMERICAL:" + "~".join(answers) + "}"
