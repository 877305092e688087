"""Exams as PDF: papers with room to answer, and the same papers with worked solutions."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from robonav.counting import counted

from ..question import Asked, Choice, Number, Order, Place, Question, Table
from .answers import asked_text, options, points
from .boxes import BOLD, ITALIC, UPRIGHT, Box, Run, registered, width
from .selection import Drawn
from .svg import Label, read
from .typeset import base_lines, height, lines

MM = 72 / 25.4
SIZES = {"a4": (210 * MM, 297 * MM), "letter": (8.5 * 72, 11 * 72)}
MARGIN = 22 * MM
FOOT = 15 * MM
INDENT = 9 * MM  # of a question's text, so that its number stands out
TEXT, SMALL = 11.0, 9.0
PICTURE = 0.75  # points for each pixel
ROOM = {Number: 30 * MM, Table: 24 * MM, Choice: 4 * MM, Place: 4 * MM, Order: 4 * MM}
ROW = 22.0  # height of a table's row
GREY = 0.45


@dataclass(frozen=True)
class Paper:
    """One student's exam.

    Attributes
    ----------
    number : int
        Printed on each page. It is the seed of its questions, so that the paper can be made again.
    questions : sequence of Drawn
        In the order in which they are printed.

    Examples
    --------
    >>> from robonav.drills import DRILLS
    >>> from robonav.drills.export import Drawn, Paper
    >>> td_error = DRILLS["td-error"]
    >>> len(Paper(7, [Drawn(td_error, 1, td_error.question(seed=7))]).questions)
    1
    """

    number: int
    questions: Sequence[Drawn]


@dataclass(frozen=True)
class _Block:
    """A part of a page that is not broken: its height, and how it is drawn from its upper left corner."""

    height: float
    draw: Callable[[Any, float, float], None]


def exam_pdf(papers: Iterable[Paper], title: str = "Exam", size: str = "a4") -> bytes:
    """Return papers to print: name line, points, questions with pictures, and room to answer.

    If there are several, each takes an even number of pages, so that they can be printed on both sides.

    Parameters
    ----------
    papers : iterable of Paper
    title : str, default "Exam"
        Printed at the top of each paper.
    size : str, default "a4"
        "a4" or "letter".

    Returns
    -------
    bytes
        One PDF with all papers.

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> exam_pdf([Paper(7, drawn(selected(drills=["td-error"]), seed=7))])[:5]
    b'%PDF-'
    """
    return _pdf(papers, title, size, solved=False)


def solutions_pdf(
    papers: Iterable[Paper], title: str = "Exam", size: str = "a4"
) -> bytes:
    """Return the solutions of papers: each question with its answer, the way to it, and the usual mistakes.

    Parameters
    ----------
    papers : iterable of Paper
    title : str, default "Exam"
    size : str, default "a4"
        "a4" or "letter".

    Returns
    -------
    bytes
        One PDF with all papers.

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> solutions_pdf([Paper(7, drawn(selected(drills=["td-error"]), seed=7))])[:5]
    b'%PDF-'
    """
    return _pdf(papers, title, size, solved=True)


def _pdf(papers: Iterable[Paper], title: str, size: str, *, solved: bool) -> bytes:
    if size not in SIZES:
        raise ValueError(f"paper must be one of {', '.join(SIZES)}, got {size}")
    for font in (UPRIGHT, BOLD, ITALIC):
        registered(font)
    from reportlab.pdfgen.canvas import Canvas

    file = io.BytesIO()
    canvas = Canvas(file, pagesize=SIZES[size], invariant=1, pageCompression=1)
    canvas.setTitle(f"{title}: solutions" if solved else title)
    every = list(papers)
    for paper in every:
        _draw_paper(canvas, paper, title, SIZES[size], solved, even=len(every) > 1)
    canvas.save()
    return file.getvalue()


def _draw_paper(
    canvas: Any,
    paper: Paper,
    title: str,
    size: tuple[float, float],
    solved: bool,
    even: bool,
) -> None:
    measure = size[0] - 2 * MARGIN
    head = _solved_head if solved else _head
    blocks = head(paper, title, measure)
    for number, one in enumerate(paper.questions, start=1):
        blocks.append(_question(number, one, measure, solved))
    pages = _pages(blocks, size[1] - MARGIN - MARGIN)
    if even and len(pages) % 2:
        pages.append([])
    for number, page in enumerate(pages, start=1):
        top = size[1] - MARGIN
        for block in page:
            block.draw(canvas, MARGIN, top)
            top -= block.height
        what = "Solutions of paper" if solved else "Paper"
        _letters(canvas, MARGIN, FOOT, title, SMALL, grey=True)
        foot = f"{what} {paper.number}, page {number} of {len(pages)}"
        right = size[0] - MARGIN - width(foot, UPRIGHT, SMALL)
        _letters(canvas, right, FOOT, foot, SMALL, grey=True)
        canvas.showPage()


def _pages(blocks: Sequence[_Block], room: float) -> list[list[_Block]]:
    """Fill pages with blocks."""
    pages: list[list[_Block]] = [[]]
    left = room
    for block in blocks:
        if pages[-1] and block.height > left:
            pages.append([])
            left = room
        pages[-1].append(block)
        left -= block.height
    return pages


def _letters(
    canvas: Any,
    x: float,
    y: float,
    text: str,
    size: float,
    font: str = UPRIGHT,
    *,
    grey: bool = False,
) -> None:
    if grey:
        canvas.setFillGray(GREY)
    canvas.setFont(registered(font), size)
    canvas.drawString(x, y, text)
    canvas.setFillGray(0)


def _draw_box(canvas: Any, box: Box, x: float, y: float) -> None:
    for run in _merged(box.runs):
        canvas.setFont(run.font, run.size)
        canvas.drawString(x + run.x, y + run.y, run.text)
    for rule in box.rules:
        canvas.rect(x + rule.x, y + rule.y, rule.width, rule.height, stroke=0, fill=1)


def _merged(runs: Sequence[Run]) -> list[Run]:
    """Join neighbours of one font, so that words and lines are whole in the file."""
    joined: list[Run] = []
    for run in runs:
        before = joined[-1] if joined else None
        if before and (before.font, before.size, before.y) == (
            run.font,
            run.size,
            run.y,
        ):
            gap = run.x - before.x - width(before.text, before.font, before.size)
            blank = width(" ", run.font, run.size)
            for space, distance in (("", 0.0), (" ", blank)):
                if abs(gap - distance) < 0.01:
                    text = before.text + space + run.text
                    joined[-1] = Run(before.x, before.y, text, run.font, run.size)
                    break
            else:
                joined.append(run)
            continue
        joined.append(run)
    return joined


def _stacked(*blocks: _Block, gap: float = 0.0, indent: float = 0.0) -> _Block:
    """Blocks below each other as one."""

    def draw(canvas: Any, x: float, top: float) -> None:
        for block in blocks:
            block.draw(canvas, x + indent, top)
            top -= block.height + gap

    return _Block(sum(block.height + gap for block in blocks), draw)


def _space(amount: float) -> _Block:
    return _Block(amount, lambda canvas, x, top: None)


def _text(text: str, measure: float, size: float = TEXT, font: str = UPRIGHT) -> _Block:
    set_ = lines(text, measure, size, font)

    def draw(canvas: Any, x: float, top: float) -> None:
        for line, base in zip(set_, base_lines(set_, top, size), strict=True):
            _draw_box(canvas, line, x, base)

    return _Block(height(set_, size), draw)


def _head(paper: Paper, title: str, measure: float) -> list[_Block]:
    total = sum(points(one.question.asked) for one in paper.questions)

    def draw(canvas: Any, x: float, top: float) -> None:
        _letters(canvas, x, top - 18, title, 20, BOLD)
        number = f"Paper {paper.number}"
        _letters(
            canvas, x + measure - width(number, BOLD, 14), top - 18, number, 14, BOLD
        )
        canvas.setLineWidth(0.6)
        y = top - 52
        _letters(canvas, x, y, "Name", TEXT)
        canvas.line(x + 34, y - 2, x + 0.46 * measure, y - 2)
        _letters(canvas, x + 0.49 * measure, y, "Student number", TEXT)
        canvas.line(x + 0.49 * measure + 78, y - 2, x + 0.80 * measure, y - 2)
        out_of = f"/ {total}"
        canvas.rect(x + 0.84 * measure, y - 8, 0.16 * measure, 24)
        _letters(
            canvas,
            x + measure - width(out_of, UPRIGHT, TEXT) - 6,
            y,
            out_of,
            TEXT,
        )

    questions = counted(len(paper.questions), "question")
    rules = f"This paper has {questions} and {counted(total, 'point')}. Show your work."
    return [
        _Block(76, draw),
        _text(rules, measure, SMALL + 1, ITALIC),
        _space(16),
    ]


def _solved_head(paper: Paper, title: str, measure: float) -> list[_Block]:
    def draw(canvas: Any, x: float, top: float) -> None:
        _letters(canvas, x, top - 18, title, 20, BOLD)
        number = f"Solutions of paper {paper.number}"
        _letters(
            canvas, x + measure - width(number, BOLD, 14), top - 18, number, 14, BOLD
        )

    return [_Block(44, draw)]


def _question(number: int, one: Drawn, measure: float, solved: bool) -> _Block:
    """A question with its number, points, picture, and fields or solution."""
    question, asked = one.question, one.question.asked
    inner = measure - INDENT
    count = points(asked)

    def head(canvas: Any, x: float, top: float) -> None:
        _letters(canvas, x, top - TEXT, f"{number}.", TEXT, BOLD)
        _letters(canvas, x + INDENT, top - TEXT, one.drill.title, TEXT, BOLD)
        worth = f"{count} point{'s' * (count > 1)}"
        at = x + measure - width(worth, UPRIGHT, SMALL)
        _letters(canvas, at, top - TEXT, worth, SMALL, grey=True)

    parts = [_text(asked_text(question), inner), _space(6)]
    if question.picture:
        parts += [_picture(question.picture, inner), _space(6)]
    parts += _solution(one, inner) if solved else _fields(asked, inner)
    return _stacked(
        _Block(TEXT * 1.5, head),
        _stacked(*parts, indent=INDENT),
        _space(14 if solved else 18),
    )


def _picture(svg: str, measure: float) -> _Block:
    drawing = read(svg)
    scale = min(PICTURE, measure / drawing.width)

    def draw(canvas: Any, x: float, top: float) -> None:
        canvas.saveState()
        canvas.translate(x, top)
        canvas.scale(scale, scale)
        for shape in drawing.shapes:
            if isinstance(shape, Label):
                canvas.setFillColorRGB(*shape.colour)
                font = registered(
                    BOLD if shape.bold else ITALIC if shape.italic else UPRIGHT
                )
                canvas.setFont(font, shape.size)
                place = {
                    "start": canvas.drawString,
                    "middle": canvas.drawCentredString,
                    "end": canvas.drawRightString,
                }[shape.anchor]
                place(shape.x, -shape.y, shape.text)
                continue
            outline = canvas.beginPath()
            outline.moveTo(shape.points[0][0], -shape.points[0][1])
            for px, py in shape.points[1:]:
                outline.lineTo(px, -py)
            if shape.closed:
                outline.close()
            canvas.setFillColorRGB(*(shape.fill or (0, 0, 0)))
            canvas.setStrokeColorRGB(*(shape.stroke or (0, 0, 0)))
            canvas.setLineWidth(shape.width)
            canvas.setDash(*([list(shape.dashes)] if shape.dashes else []))
            canvas.drawPath(
                outline, stroke=int(bool(shape.stroke)), fill=int(bool(shape.fill))
            )
        canvas.restoreState()

    return _Block(drawing.height * scale, draw)


def _fields(asked: Asked, measure: float) -> list[_Block]:
    """Where the student answers."""
    room = _space(ROOM[type(asked)])
    if isinstance(asked, Number):
        return [room, _blank("Answer", asked.unit)]
    if isinstance(asked, Choice):
        return [_option(one.text, measure, False) for one in options(asked)]
    if isinstance(asked, Place):
        return [room, _blank("Answer", "")]
    if isinstance(asked, Order):
        return [*_steps(asked, measure), room, _blank("Order", "")]
    empty = [["" for _ in asked.columns] for _ in asked.rows]
    return [room, _table(asked, empty, measure)]


def _blank(word: str, after: str) -> _Block:
    """A line to write on."""

    def draw(canvas: Any, x: float, top: float) -> None:
        y = top - 14
        _letters(canvas, x, y, f"{word}:", TEXT, BOLD)
        start = x + width(f"{word}:", BOLD, TEXT) + 6
        canvas.setLineWidth(0.6)
        canvas.line(start, y - 2, start + 50 * MM, y - 2)
        if after:
            _letters(canvas, start + 50 * MM + 5, y, after, TEXT)

    return _Block(20, draw)


def _option(text: str, measure: float, marked: bool) -> _Block:
    """A choice with its box."""
    block = _text(text, measure - 18)

    def draw(canvas: Any, x: float, top: float) -> None:
        y = top - 12.5
        canvas.setLineWidth(0.7)
        canvas.rect(x + 1, y, 9, 9)
        if marked:
            canvas.line(x + 2.5, y + 1.5, x + 8.5, y + 7.5)
            canvas.line(x + 2.5, y + 7.5, x + 8.5, y + 1.5)
        block.draw(canvas, x + 18, top)

    return _Block(block.height + 3, draw)


def _letter(place: int) -> str:
    return chr(ord("a") + place)


def _steps(asked: Order, measure: float) -> list[_Block]:
    """The steps in the order of the alphabet, each with a letter."""
    blocks = []
    for place, step in enumerate(sorted(asked.steps)):
        block = _text(step, measure - 18)

        def draw(
            canvas: Any,
            x: float,
            top: float,
            block: _Block = block,
            letter: str = _letter(place),
        ) -> None:
            _letters(canvas, x, top - 11.2, letter, TEXT, BOLD)
            block.draw(canvas, x + 18, top)

        blocks.append(_Block(block.height + 2, draw))
    return blocks


def _table(asked: Table, content: Sequence[Sequence[str]], measure: float) -> _Block:
    """A table with its headings, and what is in its cells."""
    head = [lines(column, measure)[0] for column in asked.columns]
    side = [lines(row, measure)[0] for row in asked.rows]
    first = max(box.width for box in side) + 14
    column = min(
        max(26 * MM, *(box.width + 14 for box in head)), (measure - first) / len(head)
    )
    edges = [0.0, first, *(first + column * (k + 1) for k in range(len(head)))]
    rows = len(side) + 1

    def draw(canvas: Any, x: float, top: float) -> None:
        canvas.setLineWidth(0.6)
        for k in range(rows + 1):
            y = top - k * ROW
            canvas.line(x + (first if k == 0 else 0), y, x + edges[-1], y)
        for edge in edges:
            start = top - (ROW if edge == 0 else 0)
            canvas.line(x + edge, start, x + edge, top - rows * ROW)
        for box, (left, right) in zip(head, pairwise(edges[1:]), strict=True):
            _draw_box(canvas, box, x + (left + right - box.width) / 2, top - 15)
        for i, box in enumerate(side):
            y = top - (i + 1) * ROW - 15
            _draw_box(canvas, box, x + 7, y)
            for text, (left, right) in zip(
                content[i], pairwise(edges[1:]), strict=True
            ):
                at = x + (left + right - width(text, BOLD, TEXT)) / 2
                _letters(canvas, at, y, text, TEXT, BOLD)

    return _Block(rows * ROW + 4, draw)


def _solution(one: Drawn, measure: float) -> list[_Block]:
    """The answer, the way to it, and the usual mistakes."""
    asked = one.question.asked
    parts = [*_answer(one.question, measure), _space(3)]
    parts.append(_text(one.question.explanation, measure))
    if mistakes := _mistakes(asked):
        parts += [_space(4), _text("Usual mistakes", measure, SMALL, ITALIC)]
        parts += [_text(line, measure, SMALL) for line in mistakes]
    return parts


def _answer(question: Question, measure: float) -> list[_Block]:
    """The right answer, with as many decimals as a student is asked for."""
    asked = question.asked
    if isinstance(asked, Choice):
        return [_option(one.text, measure, one.right) for one in options(asked)]
    if isinstance(asked, Table):
        content = [
            [with_decimals(number, question.decimal_places) for number in row]
            for row in asked.answer
        ]
        return [_table(asked, content, measure)]
    if isinstance(asked, Order):
        shown = sorted(asked.steps)
        order = " ".join(_letter(shown.index(step)) for step in asked.steps)
        return [*_steps(asked, measure), _text(f"**Order: {order}**", measure)]
    if isinstance(asked, Place):
        return [_text(f"**Answer: {' or '.join(asked.right)}**", measure)]
    unit = f" {asked.unit}" if asked.unit else ""
    number = with_decimals(asked.answer, question.decimal_places)
    return [_text(f"**Answer: {number}{unit}**", measure)]


def _mistakes(asked: Asked) -> list[str]:
    """Usual wrong answers, each with its hint."""
    if isinstance(asked, Number):
        return [f"{printed(number)}: {hint}" for hint, number in asked.wrong.items()]
    if isinstance(asked, Choice | Place):
        return [
            f"{one.text.rstrip('.')}: {one.hint}" for one in options(asked) if one.hint
        ]
    if isinstance(asked, Order):
        return [hint for hint in (*asked.before.values(), asked.hint) if hint]
    return [
        "; ".join(", ".join(printed(number) for number in row) for row in table)
        + f": {hint}"
        for hint, table in asked.wrong.items()
    ]


def with_decimals(number: float, places: int) -> str:
    """Return a number with so many decimals, or as a person writes it if none are asked for.

    Examples
    --------
    >>> with_decimals(0.625, 1), with_decimals(-2, 2), with_decimals(0.625, 0)
    ('0.6', '−2.00', '0.625')
    """
    if places == 0:
        return printed(number)
    return f"{round(float(number), places) + 0.0:.{places}f}".replace("-", "−")


def printed(number: float) -> str:
    """Return a number as a person writes it: four decimals at most, and more for small ones.

    Examples
    --------
    >>> printed(0.1 + 0.2), printed(-1458), printed(0.00012346)
    ('0.3', '−1458', '0.0001235')
    """
    decimals, rest = 4, abs(float(number))
    while 0 < rest < 0.1 and decimals < 12:
        rest, decimals = 10 * rest, decimals + 1
    text = f"{float(number):.{decimals}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text.replace("-", "−")
