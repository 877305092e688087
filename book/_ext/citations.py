"""The equations and algorithms of the thesis that the package cites, and where. The source is read, not imported.

A function, class or method *defines* an equation or an algorithm when the first line of its docstring names it, as in
``Greedy policy with respect to V, Eq. (2.25).`` Everything below the first line, and everything outside the packages
of the chapters, only *uses* what it cites. Equations that introduce a symbol and compute nothing are listed in
``symbols.toml``.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "robonav"
SYMBOLS_FILE = Path(__file__).with_name("symbols.toml")
CHAPTERS = ("mdp", "robot", "networks", "lfd", "nnql", "nirl")

Number = tuple[int, ...]
# The number of numbered equations in each chapter of the thesis.
COUNTS = {2: 30, 3: 31, 4: 12, 5: 16}
EQUATIONS: list[Number] = [
    (chapter, place)
    for chapter, count in COUNTS.items()
    for place in range(1, count + 1)
]
ALGORITHMS: list[Number] = [(number,) for number in range(1, 11)]
MOST_LINES = 40  # the largest size of an algorithm and of a listing on a page
MOST_COLUMNS = 88

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

Definition = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


def key(number: str) -> Number:
    """Return a number of the thesis as a key for sorting: chapter, then place in it."""
    return tuple(map(int, number.split(".")))


def written(number: Number) -> str:
    """Return a number as the thesis writes it."""
    return ".".join(map(str, number))


def numbers(text: str) -> set[Number]:
    """Return every number in a list of numbers, with those inside its ranges."""
    found: set[Number] = set()
    for first, last in RANGE.findall(text):
        *chapter, start = key(first)
        found.update((*chapter, place) for place in range(start, key(last)[-1] + 1))
    found.update(key(number) for number in SINGLE.findall(text))
    return found


def cited(kind: str, text: str) -> set[Number]:
    """Return the numbers of one kind that a text cites."""
    return {number for found in KINDS[kind].findall(text) for number in numbers(found)}


@dataclass(frozen=True)
class Documented:
    """One function, class or method of the package, with its source."""

    path: Path
    name: str  # dotted, as in robonav.mdp.models.FiniteMDP
    node: Definition
    source: str

    @property
    def docstring(self) -> str:
        return ast.get_docstring(self.node) or ""

    @property
    def public(self) -> bool:
        return not any(part.startswith("_") for part in self.name.split("."))

    def defines(self, kind: str) -> set[Number]:
        """Return the numbers that the first line of the docstring names, in the packages of the chapters."""
        if self.name.split(".")[1] not in CHAPTERS:
            return set()
        return cited(kind, self.docstring.partition("\n")[0])

    @property
    def listing(self) -> str:
        """Return the source as a page shows it, without the docstring."""
        return without_docstring(self.source)

    def commented(self, kind: str) -> set[Number]:
        """Return the numbers cited in comments that share their line with code."""
        code, found = set(), []
        for token in tokenize.generate_tokens(io.StringIO(self.listing).readline):
            if token.type == tokenize.COMMENT:
                found.append((token.start[0], token.string))
            elif token.string.strip():
                code.update(range(token.start[0], token.end[0] + 1))
        return {
            number
            for line, comment in found
            if line in code
            for number in cited(kind, comment)
        }


def without_docstring(source: str) -> str:
    """Return the source without the docstring of its outermost definition."""
    definition = ast.parse(source).body[0]
    if not isinstance(definition, Definition) or ast.get_docstring(definition) is None:
        return source
    docstring = definition.body[0]
    lines = source.splitlines(keepends=True)
    after = docstring.end_lineno or docstring.lineno
    while after < len(lines) and not lines[after].strip():
        after += 1
    return "".join(lines[: docstring.lineno - 1] + lines[after:])


def in_file(path: Path) -> tuple[Documented, ...]:
    """Return every function, class and method of one file of the package."""
    return _in_text(path, path.read_text("utf-8"), PACKAGE.parent)


@cache
def _in_text(path: Path, text: str, root: Path) -> tuple[Documented, ...]:
    """Return what :func:`in_file` returns. The same text is parsed once."""
    lines = text.splitlines(keepends=True)
    module = ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(
        ".__init__"
    )

    def visit(node: ast.Module | ast.ClassDef, name: str) -> Iterator[Documented]:
        for child in node.body:
            if not isinstance(child, Definition):
                continue
            first = min([child.lineno, *(d.lineno for d in child.decorator_list)])
            part = lines[first - 1 : child.end_lineno]
            source = "".join(line[child.col_offset :] or "\n" for line in part)
            yield Documented(path, f"{name}.{child.name}", child, source)
            if isinstance(child, ast.ClassDef):
                yield from visit(child, f"{name}.{child.name}")

    return tuple(visit(ast.parse(text), module))


def documented(package: Path = PACKAGE) -> list[Documented]:
    """Return every function, class and method of the package, in the order of its files."""
    return [found for path in sorted(package.rglob("*.py")) for found in in_file(path)]


def definitions(kind: str, package: Path = PACKAGE) -> dict[Number, list[Documented]]:
    """Return the definitions of each number of a kind."""
    return _defined_by(documented(package), kind)


def _defined_by(
    items: Iterable[Documented], kind: str
) -> dict[Number, list[Documented]]:
    found: dict[Number, list[Documented]] = defaultdict(list)
    for item in items:
        for number in item.defines(kind):
            found[number].append(item)
    return found


def uses(kind: str, package: Path = PACKAGE) -> dict[Number, list[Documented]]:
    """Return, for each number of a kind, the public names whose docstrings cite it without defining it."""
    found: dict[Number, list[Documented]] = defaultdict(list)
    for item in documented(package):
        if item.public:
            for number in cited(kind, item.docstring) - item.defines(kind):
                found[number].append(item)
    return found


@cache
def symbols() -> dict[Number, str]:
    """Return the equations that introduce a symbol and compute nothing, each with a sentence on the symbol."""
    table = tomllib.loads(SYMBOLS_FILE.read_text("utf-8"))
    return {key(number): sentence for number, sentence in table.items()}


def faults(package: Path = PACKAGE) -> list[str]:
    """Return one sentence for each fault in the definitions of equations and algorithms."""
    found: list[str] = []
    items = documented(package)
    equations = _defined_by(items, "equations")
    for number in EQUATIONS:
        name = f"Eq. ({written(number)})"
        places = equations.pop(number, [])
        if number in symbols():
            if places:
                found.append(
                    f"{name} is in symbols.toml, but {_names(places)} defines it"
                )
        elif len(places) != 1:
            found.append(f"{name} has {len(places)} definitions {_names(places)}")
        elif number not in places[0].commented("equations"):
            found.append(
                f"{name}: no line of code in {places[0].name} carries the number"
            )
    found += [
        f"Eq. ({written(number)}) is not an equation of the thesis: {_names(places)}"
        for number, places in equations.items()
    ]
    algorithms = _defined_by(items, "algorithms")
    for number in ALGORITHMS:
        name = f"Algorithm {written(number)}"
        places = algorithms.pop(number, [])
        if len(places) != 1:
            found.append(f"{name} has {len(places)} definitions {_names(places)}")
        elif isinstance(places[0].node, ast.ClassDef):
            found.append(f"{name}: {places[0].name} is a class, not a function")
        elif (lines := len(places[0].listing.splitlines())) > MOST_LINES:
            found.append(f"{name}: {places[0].name} has {lines} lines")
    return found


def _names(places: list[Documented]) -> str:
    """Return the names of definitions as one string."""
    return ", ".join(place.name for place in places)
