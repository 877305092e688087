"""Marks for slides in the pages: the directive ``{slide}``, which a reader of the page does not see.

::

    ```{slide} The two processes pull against each other
    :show: fig-2-4
    :minutes: 3

    - Evaluation makes the values fit the policy
    - Improvement makes the policy fit the values

    Ask first where both stop.
    ```

The list is on the slide, and paragraphs are the speaker's notes. ``show`` names parts of the page, separated by spaces:
labels of figures, equations, theorems and algorithms, functions whose code is listed, explorables; or the last part of
a kind before the mark, as ``last-output``, ``last-table`` or ``last-formula``. ``minutes`` is the slide's time, and
``long`` leaves it to the lecture of 90 minutes. ``halves`` puts the lower half of a high picture beside its upper one.
``make slides`` makes a deck of each page with marks (:mod:`make_slides`). A part that no mark shows gets a slide of its
own (:mod:`lecture`).
"""

from __future__ import annotations

from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class SlideMark(nodes.General, nodes.Element):
    """What a page says about one slide."""


def half_minutes(text: str) -> float:
    """Return a number of minutes, whole or and a half."""
    minutes = float(text)
    if minutes <= 0 or minutes % 0.5:
        raise ValueError(f"minutes must be a multiple of 0.5, got {text}")
    return minutes


class Slide(SphinxDirective):
    """The directive ``{slide}``."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {
        "show": directives.unchanged_required,
        "minutes": half_minutes,
        "long": directives.flag,
        "halves": directives.flag,
    }

    def run(self) -> list[nodes.Node]:
        title, messages = self.parse_inline(self.arguments[0])
        mark = SlideMark("", nodes.paragraph("", "", *title))
        mark["show"] = self.options.get("show", "")
        mark["minutes"] = self.options.get("minutes", "")
        mark["long"] = "long" in self.options
        mark["halves"] = "halves" in self.options
        mark += self.parse_content_to_nodes()
        return [mark, *messages]


def open_mark(translator: Any, node: SlideMark) -> None:
    """Begin the mark: a template, which browsers neither draw nor read out."""
    attributes = {"data-show": node["show"], "data-minutes": str(node["minutes"])}
    for flag in ("long", "halves"):
        if node[flag]:
            attributes[f"data-{flag}"] = flag
    translator.body.append(
        translator.starttag(node, "template", CLASS="slide", **attributes)
    )


def close_mark(translator: Any, node: SlideMark) -> None:
    """End the mark."""
    translator.body.append("</template>")


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_node(SlideMark, html=(open_mark, close_mark))
    app.add_directive("slide", Slide)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
