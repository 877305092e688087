"""The house keeps its order: imports point one way, and ``import robonav`` loads little and at once."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import robonav

PACKAGE = Path(robonav.__file__).parent
BASE = {"errors", "_version", "atomic", "progress", "style", "validation"}
CHAPTERS = {"mdp", "robot", "networks", "lfd", "nnql", "nirl"}
ALLOWED = {
    "mdp": set(),
    "robot": set(),
    "networks": {"robot"},
    "lfd": {"mdp", "robot", "networks"},
    "nnql": {"mdp", "robot", "networks"},
    "nirl": {"mdp", "robot", "networks", "lfd", "nnql"},
    "experiments": CHAPTERS | {"benchmark"},
    "benchmark": CHAPTERS | {"experiments"},
    "plots": CHAPTERS | {"experiments", "benchmark"},
    "widgets": CHAPTERS | {"experiments", "benchmark", "plots"},
    "grading": CHAPTERS,
    "cli": CHAPTERS | {"experiments", "benchmark", "plots", "widgets", "grading"},
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
before = time.perf_counter()
import robonav
print(json.dumps({"seconds": time.perf_counter() - before, "loaded": sorted(sys.modules)}))
"""


def room(path: Path) -> str:
    """The subpackage, or the module, that a file of the package belongs to."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imported_rooms(path: Path) -> Iterator[str]:
    """The rooms of the package that a file imports from, anywhere in it."""
    package = path.relative_to(PACKAGE.parent).parts[:-1]
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            start = (
                ".".join(package[: len(package) - node.level + 1]) if node.level else ""
            )
            origin = ".".join(filter(None, (start, node.module)))
            names = [f"{origin}.{alias.name}" for alias in node.names]
        else:
            continue
        for name in names:
            parts = name.split(".")
            if parts[0] == "robonav" and len(parts) > 1:
                yield parts[1]


SOURCES = [
    path for path in sorted(PACKAGE.rglob("*.py")) if path != PACKAGE / "__init__.py"
]


@pytest.mark.parametrize(
    "path", SOURCES, ids=lambda path: str(path.relative_to(PACKAGE))
)
def test_imports_point_one_way(path: Path) -> None:
    here = room(path)
    allowed = {here} | BASE | (set() if here in BASE else ALLOWED[here])
    rooms = {room(source) for source in SOURCES}
    assert [name for name in imported_rooms(path) if name in rooms - allowed] == []


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


def test_import_loads_nothing_heavy_and_is_quick() -> None:
    runs = []
    for _ in range(3):
        run = subprocess.run(
            [sys.executable, "-c", PROBE], capture_output=True, text=True, check=True
        )
        runs.append(json.loads(run.stdout))
    assert [name for name in LATE if name in runs[0]["loaded"]] == []
    assert (
        min(run["seconds"] for run in runs) < 1
    )  # seconds; the benchmarks say how quick, this says that nothing slipped in
