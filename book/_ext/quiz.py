"""Self-check questions: the directive ``{quiz}``, a question and a list of answers, each with its explanation.

::

    ```{quiz}
    What is the return of an episode?

    - [ ] The last reward

      That is one term of it.
    - [x] The discounted sum of its rewards

      As in the definition.
    ```

Every answer is a folded section that tells whether it is right, and why. It is plain HTML, so it works without a
script, with the keyboard and with a screen reader.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ANSWER = re.compile(r"^- \[(?P<mark>[ x])\] ", re.MULTILINE)
VERDICTS = {True: "Right.", False: "No."}


def marks(content: str) -> tuple[str, list[bool]]:
    """Return the content as a plain list, and whether each answer is right."""
    return ANSWER.sub("- ", content), [
        found["mark"] == "x" for found in ANSWER.finditer(content)
    ]


class QuizAnswer(nodes.General, nodes.Element):
    """An answer that opens to its explanation."""


class QuizChoice(nodes.General, nodes.TextElement):
    """The line of an answer that is always visible."""


class Quiz(SphinxDirective):
    """The directive ``{quiz}``."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        text, right = marks("\n".join(self.content))
        self.content = StringList(text.splitlines(), source=self.get_source_info()[0])
        parsed = self.parse_content_to_nodes()
        if (
            not parsed
            or not isinstance(parsed[-1], nodes.bullet_list)
            or len(parsed[-1]) != len(right)
        ):
            raise self.error(
                "a quiz must be a question and then a list of answers that begin with [ ] or [x]"
            )
        if sum(right) != 1 or len(right) < 2:
            raise self.error("a quiz must have two answers or more, one of them right")
        *question, answers = parsed
        box = nodes.container("", *question, classes=["quiz"])
        for item, is_right in zip(answers, right, strict=True):
            assert isinstance(item, nodes.list_item)
            box += self.answer(item, is_right)
        return [box]

    def answer(self, item: nodes.list_item, is_right: bool) -> nodes.Node:
        """Return one answer: its first paragraph is visible, and the rest is folded."""
        first, *why = item.children
        if not why or not isinstance(why[0], nodes.paragraph):
            raise self.error(f"an answer must be explained: {item.astext()}")
        why[0].insert(0, [nodes.strong("", VERDICTS[is_right]), nodes.Text(" ")])
        choice = QuizChoice("", "", *first.children)
        return QuizAnswer("", choice, *why, classes=["right" if is_right else "wrong"])


def _open(tag: str) -> Any:
    def visit(translator: Any, node: nodes.Element) -> None:
        translator.body.append(translator.starttag(node, tag, ""))

    return visit


def _close(tag: str) -> Any:
    def depart(translator: Any, node: nodes.Element) -> None:
        translator.body.append(f"</{tag}>")

    return depart


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_node(QuizAnswer, html=(_open("details"), _close("details")))
    app.add_node(QuizChoice, html=(_open("summary"), _close("summary")))
    app.add_directive("quiz", Quiz)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
