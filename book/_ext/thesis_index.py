"""From the thesis to the code: ``{thesis-index} equations`` (or ``algorithms``, ``tables``, ``figures``).

Docstrings of the package cite what they compute, as ``Eq. (2.24)``, ``Algorithm 5``, ``Table 3.1`` or ``Fig. 4.6``. The
directive collects these citations and lists, for each number, everything in the package that cites it. An equation is a
link to the page that shows it.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import directives
from package_code import code_reference
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from thesis_numbers import equation_reference

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "robonav"

# Each kind of citation: the words that open it, then a list of numbers.
NUMBER = r"\(?\d\.\d+\)?"
LIST = rf"{NUMBER}(?:(?:,? and |, |-| to ){NUMBER})*"
KINDS = {
    "equations": re.compile(rf"\b(?:Eqs?\.|Equations?)\s+({LIST})"),
    "tables": re.compile(rf"\bTables?\s+({LIST})"),
    "figures": re.compile(rf"\b(?:Figs?\.|Figures?)\s+({LIST})"),
    "algorithms": re.compile(r"\bAlgorithms?\s+(\d+(?:(?:,? and |, |-| to )\d+)*)"),
}
RANGE = re.compile(r"\(?(\d+(?:\.\d+)?)\)?(?:-| to )\(?(\d+(?:\.\d+)?)\)?")
SINGLE = re.compile(r"\d+(?:\.\d+)?")

Number = tuple[int, ...]


def key(number: str) -> Number:
    """A number of the thesis as something that sorts: chapter, then place in it."""
    return tuple(map(int, number.split(".")))


def numbers(text: str) -> set[Number]:
    """Every number in a list of them, ranges filled in."""
    found: set[Number] = set()
    for first, last in RANGE.findall(text):
        *chapter, start = key(first)
        found.update((*chapter, place) for place in range(start, key(last)[-1] + 1))
    found.update(key(number) for number in SINGLE.findall(text))
    return found


def documented(path: Path) -> Iterator[tuple[str, str]]:
    """Dotted name and docstring of every public function, class and method of a module."""
    module = ".".join(
        path.relative_to(PACKAGE.parent).with_suffix("").parts
    ).removesuffix(".__init__")

    def visit(node: ast.Module | ast.ClassDef, name: str) -> Iterator[tuple[str, str]]:
        for child in node.body:
            if isinstance(
                child, ast.FunctionDef | ast.ClassDef
            ) and not child.name.startswith("_"):
                yield f"{name}.{child.name}", ast.get_docstring(child) or ""
                if isinstance(child, ast.ClassDef):
                    yield from visit(child, f"{name}.{child.name}")

    return visit(ast.parse(path.read_text("utf-8")), module)


def cited(kind: str) -> dict[Number, list[str]]:
    """For each number of a kind, the names whose docstrings cite it, in the order of the package."""
    found: dict[Number, list[str]] = defaultdict(list)
    for path in sorted(PACKAGE.rglob("*.py")):
        for name, docstring in documented(path):
            for number in {
                number
                for text in KINDS[kind].findall(docstring)
                for number in numbers(text)
            }:
                found[number].append(name)
    return dict(sorted(found.items()))


class ThesisIndex(SphinxDirective):
    """The directive ``{thesis-index}``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        kind = directives.choice(self.arguments[0], tuple(KINDS))
        for path in PACKAGE.rglob("*.py"):
            self.env.note_dependency(str(path))
        title = kind.removesuffix("s")
        head = nodes.thead(
            "", _row([nodes.Text(title)], [nodes.Text("in the package")])
        )
        body = nodes.tbody()
        for parts, names in cited(kind).items():
            number = ".".join(map(str, parts))
            shown = nodes.Text(f"{title.capitalize()} {number}")
            code = [
                code_reference(name, name.removeprefix("robonav."), self.env.docname)
                for name in names
            ]
            body += _row(
                [
                    equation_reference(number, self.env.docname)
                    if kind == "equations"
                    else shown
                ],
                [part for name in code for part in (name, nodes.Text(", "))][:-1],
            )
        columns = [nodes.colspec(colwidth=width) for width in (15, 85)]
        return [nodes.table("", nodes.tgroup("", *columns, head, body, cols=2))]


def _row(*cells: list[nodes.Node]) -> nodes.row:
    return nodes.row(
        "", *(nodes.entry("", nodes.paragraph("", "", *content)) for content in cells)
    )


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("thesis-index", ThesisIndex)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
