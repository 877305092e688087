"""Check the code on the built pages: ``python book/_ext/check_listings.py [PAGE ...]``.

A listing of the package's code has at most 40 lines of at most 88 columns. It shows no imports, no input checks and no
warnings, keeps no record of its iterations, and names no parameter ``record`` that its body never reads; its syntax
tree is searched for them. A decorator may check the arguments and keep the record, since it stands outside the code.
The listing calls no helper of the package that checks its input: a function that a package does not export, and that
raises an error or calls a check.
Each numbered equation of a page is followed by a listing on that page whose comments carry its number.
Equations that only introduce a symbol (``symbols.toml``) need no listing. A code cell of the page that is not folded
has at most 88 columns, and so has an exercise's file.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import os
import re
import sys
import textwrap
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from types import FunctionType
from typing import Any

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
    "a record": re.compile(r"ValueHistory|\w*recorder|_?NOT_RECORDED"),
}
HELPERS_CHECK = re.compile(
    r"_?(?:check|validat|requir|ensur|verif)\w*|valid_\w+|as_(?:\w+_)?polic\w+|as_distributions|as_belief"
)
"""Names of checks in a helper. A conversion by NumPy is none, since a helper may need an array to compute with."""
CONVERSIONS = {"as_module", "as_network", "as_single_steps", "as_tensor"}
"""Names as of a check, of functions that make another kind of object and refuse nothing."""


def named(node: ast.AST) -> str:
    """Return the name or the attribute that a node of a syntax tree refers to, or nothing."""
    return getattr(node, "id", None) or getattr(node, "attr", None) or ""


def undecorated_nodes(code: str) -> list[ast.AST]:
    """Return the nodes of the syntax tree of a listing, but for its decorators."""
    tree = ast.parse(textwrap.dedent(code))
    for node in ast.walk(tree):
        if isinstance(node, citations.Definition):
            node.decorator_list.clear()
    return list(ast.walk(tree))


def plumbing(code: str) -> list[str]:
    """Return the kinds of things in a listing that are not its algorithm: imports, input checks, warnings."""
    nodes = undecorated_nodes(code)
    names = {named(node) for node in nodes} - CONVERSIONS
    found = {NODES[type(node)] for node in nodes if type(node) in NODES}
    found |= {kind for kind in NAMES if any(map(NAMES[kind].fullmatch, names))}
    return sorted(found)


def unread_record(code: str) -> bool:
    """Return whether a listing has a parameter ``record`` that its body never reads."""
    nodes = undecorated_nodes(code)
    parameters = {node.arg for node in nodes if isinstance(node, ast.arg)}
    return "record" in parameters - {named(node) for node in nodes}


def function_named(name: str) -> FunctionType | None:
    """Return the function of the package with this dotted name, without its decorators, or None if there is none."""
    parts = name.split(".")
    for end in range(len(parts) - 1, 0, -1):
        try:
            found: Any = importlib.import_module(".".join(parts[:end]))
        except ImportError:
            continue
        for part in parts[end:]:
            found = getattr(found, part, None)
        return undecorated(found)
    return None


def undecorated(found: Any) -> FunctionType | None:
    """Return the Python function that decorators and the compiler have wrapped, or None if it is something else."""
    inner = inspect.unwrap(found) if callable(found) else None
    inner = getattr(inner, "py_func", inner)
    return inner if isinstance(inner, FunctionType) else None


def helpers(function: FunctionType, code: str) -> Iterator[FunctionType]:
    """Yield the functions of the package that a listing calls and that no package exports."""
    seen = set()
    for node in undecorated_nodes(code):
        called = node.func if isinstance(node, ast.Call) else None
        names = function.__globals__
        if isinstance(called, ast.Attribute):
            module = names.get(named(called.value))
            names = vars(module) if inspect.ismodule(module) else {}
        helper = undecorated(names.get(named(called))) if called else None
        if helper and helper not in seen and not exported(helper):
            seen.add(helper)
            yield helper


def exported(function: FunctionType) -> bool:
    """Return whether a function is public in its package, or does not belong to robonav at all."""
    package, _, _ = function.__module__.rpartition(".")
    if not package.startswith("robonav"):
        return True
    return function.__name__ in getattr(importlib.import_module(package), "__all__", ())


def checks_input(helper: FunctionType) -> bool:
    """Return whether the body of a helper raises an error or calls a check."""
    return any(
        isinstance(node, ast.Raise)
        or (isinstance(node, ast.Call) and HELPERS_CHECK.fullmatch(named(node.func)))
        for node in undecorated_nodes(inspect.getsource(helper))
    )


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
    # The numbers of the equations that no listing below them has carried so far, in the order of the page.
    open_numbers: dict[citations.Number, str] = {}
    for found in soup.select("div.math[id^=equation-eq-], div.function-source"):
        if "math" in (found.get("class") or ()):
            number = _number(str(found["id"]))
            if number and citations.key(number) not in citations.symbols():
                open_numbers[citations.key(number)] = number
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
        if unread_record(text):
            yield f"{name} has a parameter record that its body never reads"
        function = function_named(name)
        for helper in helpers(function, text) if function else ():
            if checks_input(helper):
                yield f"{name} calls {helper.__name__}, which checks its input"
        for key in citations.cited("equations", text):
            open_numbers.pop(key, None)
    for number in open_numbers.values():
        yield f"no listing below Eq. ({number}) carries its number"


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
