"""Imports point one way, no two files import each other, and ``import robonav`` loads little."""

from __future__ import annotations

import ast
import graphlib
import json
import subprocess
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

import pytest

import robonav

PACKAGE = Path(robonav.__file__).parent
BASE = {
    "errors",
    "_version",
    "archive",
    "atomic",
    "compilation",
    "counting",
    "processes",
    "progress",
    "style",
    "validation",
    "documentation",
}
CHAPTERS = {
    "mdp",
    "robot",
    "networks",
    "lfd",
    "nnql",
    "nirl",
    "planners",
    "deep",
    "memory",
    "sensing",
    "body",
}
ALLOWED = {
    "mdp": set(),
    "robot": set(),
    "networks": {"robot"},
    "lfd": {"mdp", "robot", "networks"},
    "nnql": {"mdp", "robot", "networks"},
    "nirl": {"mdp", "robot", "networks", "lfd", "nnql"},
    "planners": {"robot", "lfd"},
    "deep": {"mdp", "robot", "networks", "lfd", "nnql"},
    "memory": {"robot", "networks", "lfd", "nnql", "deep"},
    "sensing": {"robot", "networks", "lfd"},
    "body": {"robot", "networks", "lfd", "nnql", "deep"},
    "experiments": CHAPTERS | {"benchmark"},
    "benchmark": CHAPTERS,
    "plots": CHAPTERS | {"experiments", "benchmark"},
    "widgets": CHAPTERS | {"experiments", "benchmark", "plots"},
    "grading": CHAPTERS,
    "drills": CHAPTERS | {"experiments", "benchmark"},
    "cli": CHAPTERS
    | {"experiments", "benchmark", "plots", "widgets", "grading", "drills"},
}
LATE = (
    "numba",
    "torch",
    "matplotlib",
    "ipywidgets",
    "anywidget",
    "IPython",
    "scipy",
    "pandas",
)
PROBE = """
import json, sys, time
before = time.process_time()
import robonav
print(json.dumps({"seconds": time.process_time() - before, "loaded": sorted(sys.modules)}))
"""


def room(path: Path) -> str:
    """The subpackage, or the module, that a file of the package belongs to."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imports(path: Path, *, typing: bool = True) -> Iterator[str]:
    """The dotted names that a file imports, anywhere in it; without ``typing`` not those under TYPE_CHECKING."""
    package = path.relative_to(PACKAGE.parent).parts[:-1]
    for name, only_typing in import_statements(path.read_text("utf-8"), package):
        if typing or not only_typing:
            yield name


@cache
def import_statements(
    text: str, package: tuple[str, ...]
) -> tuple[tuple[str, bool], ...]:
    """The names that a file of a package imports, and whether they stand under TYPE_CHECKING.

    Imports are statements, so expressions are not searched. The same text is parsed once.
    """

    def visit(
        statements: Iterable[ast.AST], only_typing: bool
    ) -> Iterator[tuple[str, bool]]:
        for node in statements:
            if isinstance(node, ast.Import):
                yield from ((alias.name, only_typing) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                start = package[: len(package) - node.level + 1] if node.level else ()
                origin = ".".join(filter(None, (*start, node.module)))
                yield from ((f"{origin}.{own.name}", only_typing) for own in node.names)
            else:
                checks = isinstance(node, ast.If) and ast.unparse(node.test).endswith(
                    "TYPE_CHECKING"
                )
                for part in ("body", "orelse", "finalbody", "handlers", "cases"):
                    under = checks and part == "body"
                    yield from visit(getattr(node, part, ()), only_typing or under)

    return tuple(visit(ast.parse(text).body, False))


def imported_rooms(path: Path) -> Iterator[str]:
    """The rooms of the package that a file imports from, anywhere in it."""
    for name in imports(path):
        parts = name.split(".")
        if parts[0] == "robonav" and len(parts) > 1:
            yield parts[1]


def imported_files(path: Path) -> set[Path]:
    """The files of the package that a file imports when it runs, at its top or inside a function."""
    found = set()
    for name in imports(path, typing=False):
        parts = name.split(".")
        while parts and parts[0] == "robonav":
            place = PACKAGE.parent.joinpath(*parts)
            if place.with_suffix(".py").is_file():
                found.add(place.with_suffix(".py"))
                break
            if (place / "__init__.py").is_file():
                found.add(place / "__init__.py")
                break
            parts.pop()
    return found - {path}


SOURCES = [
    path for path in sorted(PACKAGE.rglob("*.py")) if path != PACKAGE / "__init__.py"
]
ROOMS = {room(source) for source in SOURCES}


@pytest.mark.parametrize(
    "path", SOURCES, ids=lambda path: str(path.relative_to(PACKAGE))
)
def test_imports_point_one_way(path: Path) -> None:
    here = room(path)
    allowed = {here} | BASE | (set() if here in BASE else ALLOWED[here])
    assert [name for name in imported_rooms(path) if name in ROOMS - allowed] == []


def test_every_import_form_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "robonav"
    (package / "mdp").mkdir(parents=True)
    source = package / "mdp" / "models.py"
    source.write_text(
        "import numpy, robonav.lfd.astar\nfrom robonav import nirl\nfrom robonav.robot import navigate\n"
        "def late():\n    from ..nnql import train\n    from .. import plots\n    from . import values\n"
    )
    monkeypatch.setattr(f"{__name__}.PACKAGE", package)
    assert list(imported_rooms(source)) == [
        "lfd",
        "nirl",
        "robot",
        "nnql",
        "plots",
        "mdp",
    ]


def circle(files: list[Path]) -> list[str]:
    """Files that import each other in a circle, or nothing."""
    graph = {path: imported_files(path) for path in files}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return [str(path.relative_to(PACKAGE)) for path in error.args[1]]
    return []


def test_no_files_import_each_other_in_a_circle() -> None:
    assert circle(SOURCES) == []


@pytest.mark.parametrize(
    ("late", "closed"),
    [
        ("from . import models", True),
        ("import robonav.mdp.models", True),
        ("def f():\n    from .models import FiniteMDP", True),
        ("if TYPE_CHECKING:\n    from .models import FiniteMDP", False),
        ("from .values import sweep", False),
    ],
)
def test_circle_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, late: str, closed: bool
) -> None:
    package = tmp_path / "robonav"
    (package / "mdp").mkdir(parents=True)
    models, grid = package / "mdp" / "models.py", package / "mdp" / "gridworld.py"
    values = package / "mdp" / "values.py"
    models.write_text("from .gridworld import Grid\n")
    grid.write_text(late + "\n")
    values.write_text("")
    monkeypatch.setattr(f"{__name__}.PACKAGE", package)
    assert bool(circle([models, grid, values])) is closed


def test_import_loads_nothing_heavy_and_is_quick() -> None:
    runs = []
    for _ in range(3):
        run = subprocess.run(
            [sys.executable, "-c", PROBE], capture_output=True, text=True, check=True
        )
        runs.append(json.loads(run.stdout))
    assert [name for name in LATE if name in runs[0]["loaded"]] == []
    # Processor seconds, which other programs do not lengthen much. The benchmarks measure the time of the import.
    assert min(run["seconds"] for run in runs) < 1


def test_plain_pytest_has_no_option_of_the_grader(tmp_path: Path) -> None:
    """The grading plugin is opt-in: installing robonav changes nobody's pytest."""
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "--help"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "--basetemp" in run.stdout
    assert "--secret" not in run.stdout
    assert "--submission" not in run.stdout


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_text_is_read_and_written_as_utf8(path: Path) -> None:
    """On Windows the locale's encoding is another one."""
    for call in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
            named = {keyword.arg for keyword in call.keywords}
            places = {"read_text": 1, "write_text": 2}.get(call.func.attr, 0)
            assert len(call.args) >= places or "encoding" in named, ast.unparse(call)
