"""The code that a run depends on, and its digest. A kept run is used again only as long as that code is the same."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

PACKAGE = Path(__file__).parents[2]


def code_digest(run: Callable[..., Any]) -> str:
    """Return the SHA-256 of the files of this package that a function's module imports, directly or through others.

    A function outside the package, such as a reader's own, may use any part of it, so its digest includes all files.
    """
    while isinstance(run, partial):
        run = run.func
    return _digest_of(getattr(run, "__module__", "") or "")


@cache
def _digest_of(module: str) -> str:
    inside = module.startswith("robonav.")
    files = dependencies(_file_of(module)) if inside else set(PACKAGE.rglob("*.py"))
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update(path.relative_to(PACKAGE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def dependencies(path: Path | None) -> set[Path]:
    """Return a file of the package with all files of the package that it imports, and the TOML files next to them."""
    found: set[Path] = set()
    waiting = [path]
    while waiting:
        file = waiting.pop()
        if file is None or file in found:
            continue
        found.add(file)
        waiting += [_file_of(name) for name in _imports(file)]
    return found | {toml for file in found for toml in file.parent.glob("*.toml")}


def _imports(path: Path) -> Iterator[str]:
    """Return the names that a file imports, as ``robonav.robot.rollout`` or ``robonav.robot.rollout.navigate``.

    Imports inside functions are included.
    """
    package = ("robonav", *path.relative_to(PACKAGE).parts[:-1])
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            origin = ".".join([*above, *([node.module] if node.module else [])])
            yield origin
            yield from (f"{origin}.{alias.name}" for alias in node.names)


def _file_of(name: str) -> Path | None:
    """Return the file of a module of this package, or None for any other name."""
    root, *parts = name.split(".")
    if root != "robonav" or not parts:
        return None
    path = PACKAGE.joinpath(*parts)
    for file in (path.with_suffix(".py"), path / "__init__.py"):
        if file.is_file():
            return file
    return None
