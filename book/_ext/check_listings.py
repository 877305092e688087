"""Check the code on the built pages: ``python book/_ext/check_listings.py [PAGE ...]``.

A listing of the package's code has at most 40 lines of at most 88 columns. It shows no imports, no input checks and no
warnings; its syntax tree is searched for them. A decorator may check the arguments, since it stands outside the code.
Each numbered equation of a page has a listing on that page whose comments carry its number.
Equations that only introduce a symbol (``symbols.toml``) need no listing. A code cell of the page that is not folded
has at most 88 columns, and so has an exercise's file.
"""

from __future__ import annotations

import ast
import os
import re
import sys
import textwrap
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

import citations
import yaml
from bs4 import BeautifulSoup
from check_site import pages
from thesis_numbers import thesis_number

ROOT = Path(__file__).resolve().parents[2]
SITE = Path(os.environ.get("BOOK_SITE", ROOT / "_build" / "html"))
NODES: dict[type[ast.AST], str] = {
    ast.Import: "an import",
    ast.ImportFrom: "an import",
    ast.Raise: "an input check",
    ast.Assert: "an input check",
}
NAMES = {
    "an input check": re.compile(
        r"_?(?:check|validat|requir|ensur|verif)\w*|isinstance|issubclass|callable|hasattr|valid_\w+|as(?:_\w+|\w*array)"
    ),
    "a warning": re.compile(r"\w*warn\w*"),
}
CONVERSIONS = {"as_module", "as_network", "as_single_steps", "as_tensor"}
"""Names as of a check, of functions that make another kind of object and refuse nothing."""


def named(node: ast.AST) -> str:
    """Return the name or the attribute that a node of a syntax tree refers to, or nothing."""
    return getattr(node, "id", None) or getattr(node, "attr", None) or ""


def plumbing(code: str) -> list[str]:
    """Return the kinds of things in a listing that are not its algorithm: imports, input checks, warnings."""
    tree = ast.parse(textwrap.dedent(code))
    for node in ast.walk(tree):
        if isinstance(node, citations.Definition):
            node.decorator_list.clear()
    nodes = list(ast.walk(tree))
    names = {named(node) for node in nodes} - CONVERSIONS
    found = {NODES[type(node)] for node in nodes if type(node) in NODES}
    found |= {kind for kind in NAMES if any(map(NAMES[kind].fullmatch, names))}
    return sorted(found)


@lru_cache(maxsize=4)
def parsed(html: str) -> BeautifulSoup:
    """Return the elements of a page. Several checks look at the same page one after the other."""
    return BeautifulSoup(html, "html.parser")


def wide_cells(html: str) -> Iterator[str]:
    """Yield one sentence for each line of a page's own code cells that is too wide."""
    soup = parsed(html)
    for number, cell in enumerate(soup.select("div.cell"), start=1):
        for code in cell.select("div.cell_input pre"):
            if code.find_parent("details") is None:
                for line in code.get_text().splitlines():
                    if len(line) > citations.MOST_COLUMNS:
                        yield f"code cell {number} has {len(line)} columns: {line}"


def wide_stubs(html: str) -> Iterator[str]:
    """Yield one sentence for each line of an exercise's file that is too wide. Imports may be shown there."""
    soup = parsed(html)
    for caption in soup.select("div.literal-block-wrapper > div.code-block-caption"):
        name = caption.select_one("span.caption-text").get_text()
        if name.startswith("exercises/"):
            for line in caption.parent.select_one("pre").get_text().splitlines():
                if len(line) > citations.MOST_COLUMNS:
                    yield f"{name} has {len(line)} columns: {line}"


def faults(html: str) -> Iterator[str]:
    """Yield one sentence for each fault of the listings of one page."""
    soup = parsed(html)
    equations: list[str] = []  # the numbers of the page's equations, in its order
    listed: set[citations.Number] = set()  # those that its listings carry
    for found in soup.select("div.math[id^=equation-eq-], div.function-source"):
        if "math" in (found.get("class") or ()):
            number = _number(str(found["id"]))
            if number and citations.key(number) not in citations.symbols():
                equations.append(number)
            continue
        text = found.get_text().strip("\n")
        caption = found.find_previous_sibling(class_="code-block-caption")
        name = caption.select_one("code").get_text() if caption else "a listing"
        lines = text.splitlines()
        widest = max(map(len, lines), default=0)
        if len(lines) > citations.MOST_LINES:
            yield f"{name} has {len(lines)} lines"
        if widest > citations.MOST_COLUMNS:
            yield f"{name} has {widest} columns"
        for kind in plumbing(text):
            yield f"{name} shows {kind}"
        listed |= citations.cited("equations", text)
    for number in equations:
        if citations.key(number) not in listed:
            yield f"no listing carries the number of Eq. ({number})"


def _number(anchor: str) -> str | None:
    """Return the thesis's number of an equation from its anchor, or None for an equation of the page's own."""
    label = anchor.removeprefix("equation-")
    return thesis_number(re.sub(r"-(\d+)$", r".\1", label))


def _all_faults(html: str) -> list[str]:
    return [*faults(html), *wide_cells(html), *wide_stubs(html)]


def main() -> None:
    """Print the faults of the named pages, or of all pages. Exit with 1 if there are any."""
    names = sys.argv[1:] or pages(
        yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))
    )
    found = []
    for name in names:
        html = (SITE / f"{name}.html").read_text("utf-8")
        found += [f"{name}: {fault}" for fault in _all_faults(html)]
    print("\n".join(found))
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
