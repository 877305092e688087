"""Questions as HTML and JSON: what the page and the exports show."""

from __future__ import annotations

from functools import cache
from typing import Any

from .question import Asked, Choice, Number, Order, Place, Question

LONG = 20  # letters of one side of an equation
# A text of a drill is made of sentences. One that begins with "1." or with a minus is not a list.
NOT_READ = (
    *("list", "heading", "lheading", "blockquote", "hr"),
    *("code", "fence", "html_block", "reference"),
)


@cache
def _parser() -> Any:
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    def formula(text: str, options: dict[str, Any]) -> str:
        escaped = text.replace("&", "&amp;").replace("<", "&lt;")
        if options["display_mode"]:
            return rf"\[{escaped}\]"
        return " ".join(rf"\({part}\)" for part in breakable(escaped))

    parser = MarkdownIt("commonmark").disable(NOT_READ)
    return parser.use(dollarmath_plugin, renderer=formula)


def breakable(formula: str) -> list[str]:
    """Return a formula in parts between which a line can break, since MathJax breaks no formula in a line.

    A line can break before an equals sign. A long side of an equation, which a phone is too narrow for, breaks before a
    plus or a minus and after a comma, too.

    Examples
    --------
    >>> breakable("G_0 = 4 + 1 = 5")
    ['G_0', '= 4 + 1', '= 5']
    >>> breakable("0.25 + 0.5 + 0.125 - 0.0625")
    ['0.25', '{+} \\\\: 0.5', '{+} \\\\: 0.125', '{-} \\\\: 0.0625']
    >>> breakable(r"\\sum_{k = 1}^n k")
    ['\\\\sum_{k = 1}^n k']
    """
    parts: list[str] = []
    for side in _split(formula, "="):
        if len(side) <= LONG:
            parts.append(side)
        else:
            first, *others = _split(side, "+-,")
            parts += [first, *map(_signed, others)]
    return parts


def _signed(term: str) -> str:
    """A term that begins with a plus or a minus, with the space behind it that the sign of a sum has."""
    return rf"{{{term[0]}}} \: {term[2:]}" if term[:2] in ("+ ", "- ") else term


def _split(formula: str, signs: str) -> list[str]:
    """Split a formula before each of some signs between spaces, and after a comma, outside of brackets."""
    parts, start, braces, brackets = [], 0, 0, 0
    for at, letter in enumerate(formula):
        braces += (letter == "{") - (letter == "}")
        brackets += (letter in "([") - (letter in ")]")
        before = formula[start:at]
        if letter != " " or braces or brackets or before in ("", "="):
            continue
        sign = formula[at + 1 : at + 3]
        after_comma = before[-1] == "," and "," in signs
        if after_comma or (sign[1:] == " " and sign[0] in signs):
            parts.append(before)
            start = at + 1
    return [*parts, formula[start:]]


@cache
def html(text: str) -> str:
    r"""Return Markdown as HTML, its formulas between ``\(`` and ``\)`` as MathJax and learning platforms read them.

    Parameters
    ----------
    text : str
        Markdown; one paragraph loses its tags, so that it can stand in a line.

    Returns
    -------
    str

    Examples
    --------
    >>> html("The value of $s < t$ is *exact*.")
    'The value of <span class="math inline">\\(s &lt; t\\)</span> is <em>exact</em>.'
    >>> html("1. Sense; 2. act.")
    '1. Sense; 2. act.'
    """
    parser = _parser()
    tokens = parser.parse(text)
    if [token.type for token in tokens] == [
        "paragraph_open",
        "inline",
        "paragraph_close",
    ]:
        return str(parser.renderInline(text))
    return str(parser.render(text))


def plain(text: str) -> str:
    """Return Markdown as plain text, for places where a platform shows tags as they are written.

    Parameters
    ----------
    text : str
        Markdown in one line. Its formulas consist of numbers and signs.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If a formula has a command, an index or an exponent, which plain text cannot show.

    Examples
    --------
    >>> plain("`step` gives the reward $-0.5$ *at once*.")
    'step gives the reward −0.5 at once.'
    """
    shown = ""
    for token in _parser().parseInline(text)[0].children:
        if token.type == "math_inline":
            if set(token.content) & set("\\_^{}"):
                raise ValueError(f"plain text cannot show the formula {token.content}")
            shown += token.content.replace("-", "−")
        elif token.type in ("text", "code_inline", "text_special"):
            shown += token.content
        elif token.type in ("softbreak", "hardbreak"):
            shown += " "
    return shown


def block(text: str) -> str:
    r"""Return Markdown as HTML paragraphs.

    Parameters
    ----------
    text : str
        Markdown.

    Returns
    -------
    str

    Examples
    --------
    >>> block("One."), block("One.\n\nTwo.")
    ('<p>One.</p>', '<p>One.</p>\n<p>Two.</p>\n')
    """
    rendered = html(text)
    return rendered if rendered.endswith("\n") else f"<p>{rendered}</p>"


def _asked(asked: Asked) -> dict[str, Any]:
    """The kind of answer as JSON; texts that a reader sees are HTML."""
    if isinstance(asked, Number):
        wrong = [[html(hint), number] for hint, number in asked.wrong.items()]
        return {
            "kind": "number",
            "answer": asked.answer,
            "tolerance": asked.tolerance,
            "unit": asked.unit,
            "wrong": wrong,
        }
    if isinstance(asked, Choice):
        options = [html(option) for option in asked.options]
        hints = [html(asked.wrong.get(option, "")) for option in asked.options]
        right = asked.options.index(asked.right)
        return {"kind": "choice", "options": options, "right": right, "hints": hints}
    if isinstance(asked, Place):
        by_place = {place: html(hint) for place, hint in asked.wrong.items()}
        return {"kind": "place", "right": list(asked.right), "hints": by_place}
    if isinstance(asked, Order):
        before = [[i, j, html(hint)] for (i, j), hint in asked.before.items()]
        steps = [html(step) for step in asked.steps]
        return {
            "kind": "order",
            "steps": steps,
            "before": before,
            "hint": html(asked.hint),
        }
    wrong = [[html(hint), table] for hint, table in asked.wrong.items()]
    return {
        "kind": "table",
        "rows": [html(row) for row in asked.rows],
        "columns": [html(column) for column in asked.columns],
        "answer": asked.answer,
        "tolerance": asked.tolerance,
        "wrong": wrong,
    }


def as_json(question: Question) -> dict[str, Any]:
    """Return a question as the page's script takes it.

    Parameters
    ----------
    question : Question

    Returns
    -------
    dict
        Plain numbers, texts and lists.

    Examples
    --------
    >>> as_json(Question("$1 + 1$?", Number(2), "Two."))["asked"]["kind"]
    'number'
    """
    return {
        "text": html(question.text),
        "picture": question.picture,
        "asked": _plain(_asked(question.asked)),
        "explanation": html(question.explanation),
    }


def _plain(value: Any) -> Any:
    """Python's own numbers in place of numpy's, rounded to what a reader's answer is compared with."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, bool | int | str):
        return value
    return round(float(value), 8)
