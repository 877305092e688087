"""The drills of a page: the directives ``{drills}``, ``{progress}`` and ``{due}``.

``{drills}`` shows the drills of the page that it stands on, each folded. ``{progress}`` lists all drills of the book by
page, and ``{due}`` those of them that the reader should answer again today. The questions are drawn while the book is
built, :data:`QUESTIONS` different ones of each drill, into a script of their own, ``_static/drills/NAME.js``, which a
page loads when a reader opens the drill.

Without scripts, and on paper, a drill shows its first question with its solution.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

import yaml
from check_site import ROOT, pages
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import robonav.drills
from robonav.drills import DRILLS, Drill, Question, of_page
from robonav.drills.export import seen
from robonav.drills.markup import as_json, html
from robonav.widgets.shared import front_end, style_sheet

QUESTIONS = 100  # different ones of each drill
SEEDS = 500  # of which they are drawn
SHARED = 20  # letters of a text that is worth being shared
FORMULA = re.compile(r'<span class="math inline">(\\\(.*?\\\))</span>', re.DOTALL)
FOLDER = "drills"
MARK = "drills"  # the class of what the directives make


def different_questions(drill: Drill) -> list[Question]:
    """Return questions of a drill, no two of which look alike to a reader."""
    found: dict[tuple[object, ...], Question] = {}
    for seed in range(SEEDS):
        question = drill.question(seed)
        found.setdefault(seen(question), question)
        if len(found) == QUESTIONS:
            break
    return list(found.values())


def every_text(value: Any) -> Iterator[str]:
    """Yield all texts in lists and dictionaries."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, list | dict):
        for one in value.values() if isinstance(value, dict) else value:
            yield from every_text(one)


def packed(questions: list[Any]) -> tuple[list[Any], list[str]]:
    """Return questions with less text, and the texts that several of them share.

    A shared text is replaced by its number behind an at sign. The elements around formulas are left out, and the page's
    script puts them back.
    """
    counts = Counter(every_text(questions))
    shared = [text for text, n in counts.items() if n > 1 and len(text) >= SHARED]
    number = {text: f"@{k}" for k, text in enumerate(shared)}

    def short(value: Any) -> Any:
        if isinstance(value, str):
            return number.get(value) or FORMULA.sub(r"\1", value)
        if isinstance(value, list):
            return [short(one) for one in value]
        if isinstance(value, dict):
            return {key: short(one) for key, one in value.items()}
        return value

    return short(questions), [FORMULA.sub(r"\1", text) for text in shared]


def script(drill: Drill) -> str:
    """Return the script with a drill's questions."""
    questions, texts = packed(list(map(as_json, different_questions(drill))))
    parts = (
        json.dumps(part, ensure_ascii=False, separators=(",", ":"))
        for part in (drill.name, questions, texts)
    )
    return f"robonavDrill({','.join(parts)});\n"


def page_script() -> str:
    """Return the script of all pages with drills: a plain one, because modules do not load from disk."""
    plain = re.sub(
        r"^export ", "", front_end("drills", "drills_page"), flags=re.MULTILINE
    )
    return f"(() => {{\n{plain}\n}})();\n"


def folded(drill: Drill, static: str) -> str:
    """Return a folded drill as HTML, with its first question for readers without scripts."""
    first = drill.question(0)
    return (
        f'<details id="drill-{drill.name}" class="robonav drill" data-drill="{drill.name}" '
        f'data-source="{static}/{FOLDER}/{drill.name}.js">'
        f'<summary>{escape(drill.title)}<span class="drill-standing"></span></summary>'
        f'<div class="drill-place"><noscript><p>{html(first.text)}</p>{first.picture}'
        f"<details><summary>Solution</summary><p>{html(first.explanation)}</p></details></noscript></div></details>"
    )


def as_node(text: str) -> nodes.Node:
    """Return HTML as a part of a page."""
    return nodes.container("", nodes.raw("", text, format="html"), classes=[MARK])


class _Drills(SphinxDirective):
    """What the directives with drills share."""

    def static(self) -> str:
        """Return the path of the folder of static files from the page."""
        return "../" * self.env.docname.count("/") + "_static"

    def run(self) -> list[nodes.Node]:
        """Show the drills, after noting that the page depends on the package's."""
        for path in Path(robonav.drills.__file__).parent.rglob("*.py"):
            self.env.note_dependency(str(path))
        return self.parts()

    def parts(self) -> list[nodes.Node]:
        """Return what the directive shows."""
        raise NotImplementedError


class PageDrills(_Drills):
    """The directive ``{drills}``."""

    def parts(self) -> list[nodes.Node]:
        page = self.env.docname.rpartition("/")[2]
        drills = of_page(page)
        if not drills:
            raise self.error(f"no drill belongs to the page {page}")
        return [as_node("".join(folded(drill, self.static()) for drill in drills))]


class DueDrills(SphinxDirective):
    """The directive ``{due}``: a list that the page's script fills with the drills of the page that are due."""

    def run(self) -> list[nodes.Node]:
        """Show an empty place, in which readers without scripts are told why it is empty."""
        told = "<noscript><p>What is due is shown by a script.</p></noscript>"
        return [as_node(f'<div class="drills-due">{told}</div>')]


class Progress(_Drills):
    """The directive ``{progress}``."""

    def parts(self) -> list[nodes.Node]:
        parts: list[nodes.Node] = [
            as_node(f'<p class="drills-summary" data-drills="{" ".join(DRILLS)}"></p>')
        ]
        contents = yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))
        for page in (address.rpartition("/")[2] for address in pages(contents)):
            drills = of_page(page)
            if not drills:
                continue
            names = " ".join(drill.name for drill in drills)
            parts += self.parse_text_to_nodes(f"**{{doc}}`/book/{page}`**")
            parts.append(
                as_node(f'<p class="drills-summary" data-drills="{names}"></p>')
            )
            parts += [as_node(folded(drill, self.static())) for drill in drills]
        return parts


def load_mathjax(app: Sphinx, doctree: nodes.document) -> None:
    """Let a page with drills load MathJax, even if its own text has no formula."""
    if any(MARK in part["classes"] for part in doctree.findall(nodes.container)):
        math: Any = app.env.get_domain("math")
        math.data["has_equations"][app.env.docname] = True


def write_files(app: Sphinx, error: Exception | None) -> None:
    """Write the scripts beside the pages."""
    if error or app.builder.format != "html":
        return
    folder = Path(app.outdir) / "_static"
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    (folder / "drills.js").write_text(page_script(), "utf-8")
    (folder / "drills.css").write_text(style_sheet("drills"), "utf-8")
    for drill in DRILLS.values():
        (folder / FOLDER / f"{drill.name}.js").write_text(script(drill), "utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("drills", PageDrills)
    app.add_directive("progress", Progress)
    app.add_directive("due", DueDrills)
    app.add_js_file("drills.js")
    app.add_css_file("drills.css")
    app.connect("doctree-read", load_mathjax)
    app.connect("build-finished", write_files)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
