"""Equations that have the numbers of the thesis.

An equation labelled ``eq-2.24`` is shown and referred to as (2.24), so that a reader can compare the thesis with the
book. Every other labelled equation belongs to the book and is counted 1, 2, 3 on its page.

The role ``{thesis}`2.24``` also gives (2.24), but no page needs to show the equation. It is a link if a page does.

An algorithm of the thesis has the label ``alg-8``. The book's search finds it by "Algorithm 8".
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.addnodes import index, pending_xref
from sphinx.application import Sphinx
from sphinx.domains.math import MathDomain
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxRole

THESIS_LABEL = re.compile(r"eq-(\d+\.\d+)")
ALGORITHM_LABEL = re.compile(r"alg-(\d+)")


def thesis_number(label: str) -> str | None:
    """Return the thesis's number in a label, or None for an equation of the book."""
    match = THESIS_LABEL.fullmatch(label)
    return match[1] if match else None


class ThesisMathDomain(MathDomain):
    """Sphinx's domain for mathematics, with numbers from the labels."""

    def note_equation(self, docname: str, labelid: str, location: Any = None) -> None:
        number = thesis_number(labelid)
        if number is None or labelid in self.equations:
            super().note_equation(
                docname, labelid, location
            )  # it warns about a label that is used twice
        else:
            self.equations[labelid] = (docname, number)


def equation_reference(number: str, docname: str) -> nodes.Node:
    """Return the number in brackets, with a link if a page shows the equation."""
    target = {
        "refdomain": "math",
        "reftype": "eq",
        "reftarget": f"eq-{number}",
        "refdoc": docname,
    }
    return pending_xref("", nodes.Text(f"({number})"), **target)


class ThesisEquation(SphinxRole):
    """The role ``{thesis}``: numbers of equations of the thesis, each in brackets."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        found: list[nodes.Node] = []
        for number in (part.strip() for part in self.text.split(",")):
            reference = equation_reference(number, self.env.docname)
            found += [nodes.Text(", "), reference] if found else [reference]
        return found, []


def leave_plain(
    app: Sphinx, env: BuildEnvironment, node: pending_xref, content: nodes.Element
) -> nodes.Node | None:
    """Leave the number of an equation that no page shows as plain text. The strict role ``{eq}`` fails instead."""
    if (
        node.get("refdomain") == "math"
        and thesis_number(node["reftarget"])
        and isinstance(content, nodes.Text)
    ):
        return content
    return None


def index_algorithms(app: Sphinx, doctree: nodes.document) -> None:
    """Add an index entry "Algorithm 8" to each algorithm of the thesis.

    The search ignores numbers, but compares the whole text searched for with the index entries.
    """
    for node in list(doctree.findall(nodes.Element)):
        match = ALGORITHM_LABEL.fullmatch(node.get("label", ""))
        if match:
            entry = ("single", f"Algorithm {match[1]}", node["ids"][0], "main", None)
            node.parent.insert(node.parent.index(node), index(entries=[entry]))


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_domain(ThesisMathDomain, override=True)
    app.add_role("thesis", ThesisEquation())
    app.connect("missing-reference", leave_plain)
    app.connect("doctree-read", index_algorithms)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
