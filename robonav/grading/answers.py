"""Find the file of a submission that answers an exercise, and run it as a module. This file runs in the sandbox.

The function ``improve`` of chapter 2 is taken from the first of these that defines it: ``ch2/improve.py``, another
``improve.py``, a notebook, any other Python file. A function that was handed out and not changed is not an answer, and
neither is an empty file.
"""

from __future__ import annotations

import ast
import re
import sys
import types
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from . import notebook


@dataclass(frozen=True)
class Found:
    """Where the answer to an exercise is.

    Attributes
    ----------
    path : str
        The file with the answer, or an empty string if there is none.
    origin : str
        The file as it was handed in: a notebook, if one of its cells writes the file.
    unwritten : str
        A file that holds the function as it was handed out, if there is no answer.
    problem : Exception or None
        Why the file that should hold the answer cannot be read.
    """

    path: str = ""
    origin: str = ""
    unwritten: str = ""
    problem: Exception | None = None


def find(folder: Path, chapter: str, name: str) -> Found:
    """Return where the folder defines the function ``name`` of a chapter."""
    origins = dict(_write_files_of_cells(folder))
    unwritten, without, problem = "", "", None
    for path in _candidates(folder, chapter, name):
        where = str(path.relative_to(folder))
        try:
            state = _state(path, name)
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            state = "written" if _is_named(path, name) else ""
            problem = problem or error
        if state == "written":
            return Found(where, origins.get(where, where))
        if state == "unwritten":
            unwritten = unwritten or where
        elif _is_named(path, name) and not _is_empty(path):
            without = without or where
    if without:  # running it may define the function, or tells what is wrong
        return Found(without, origins.get(without, without))
    return Found(unwritten=unwritten, problem=problem)


def load(folder: Path, where: str, name: str) -> types.ModuleType:
    """Run a file as a module. Of a file that does not bear the function's name, only what the function needs runs."""
    path = folder / where
    if _is_named(path, name):
        tree = ast.parse(path.read_bytes(), str(path))
        tree.body = [
            notebook.without_stub_line(node)
            for node in tree.body
            if not notebook.is_unwritten(node, name)
        ]
    else:
        tree = notebook.definitions(_cells(path), name)
    module = types.ModuleType(name)
    module.__file__ = where
    sys.modules[name] = module
    # At the end of the path, so that a student's random.py does not replace Python's.
    sys.path += [str(path.parent), str(folder)]
    exec(compile(tree, str(path), "exec"), module.__dict__)
    return module


def damaged(folder: Path) -> list[str]:
    """Return the names of the notebooks in a folder that cannot be read, as one of which a part is missing."""
    found = []
    for path in sorted(folder.rglob("*.ipynb")):
        try:
            notebook.sources(path.read_bytes())
        except ValueError:
            found.append(str(path.relative_to(folder)))
        except (OSError, MemoryError):  # nothing is known of it
            continue
    return found


def modules_of_cells(contents: Iterable[bytes]) -> set[str]:
    """Return the names of the modules that cells of notebooks write with ``%%writefile``."""
    written = re.compile(
        rb"%%(?:write)?file[ \t]+(?:-a[ \t]+)?([^\s\"\\]{1,200}\.py)\b"
    )
    return {
        Path(name.decode(errors="replace")).stem
        for content in contents
        for name in written.findall(content)
    }


def _candidates(folder: Path, chapter: str, name: str) -> list[Path]:
    """Return the files that mention the function, the likeliest first."""

    def unlikely(path: Path) -> tuple[bool | int | str, ...]:
        inside, stem = path.relative_to(folder), path.stem.casefold()
        return (
            not _is_named(path, name),
            path.parent.name.casefold() != chapter
            if _is_named(path, name)
            else chapter not in str(inside).casefold(),
            name not in stem,
            path.suffix == ".py",
            len(inside.parts),
            -int("".join(re.findall(r"(\d{1,3})\)?$", stem)) or 0),
            str(inside),
        )

    mentioned = re.compile(rf"\b{re.escape(name)}\b".encode())
    found = [
        path
        for path in folder.rglob("*")
        if path.suffix in (".py", ".ipynb")
        and path.is_file()
        and (_is_named(path, name) or mentioned.search(path.read_bytes()))
    ]
    return sorted(found, key=unlikely)


def _is_named(path: Path, name: str) -> bool:
    return path.suffix == ".py" and path.stem.casefold() == name


def _is_empty(path: Path) -> bool:
    """Whether a Python file has no statement: it is blank, or has only comments and a docstring."""
    statements = ast.parse(path.read_bytes()).body
    return not any(
        not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))
        for node in statements
    )


def _cells(path: Path) -> list[str]:
    content = path.read_bytes()
    if path.suffix == ".ipynb":
        return notebook.sources(content)
    return [content.decode("utf-8-sig", "replace")]


def _state(path: Path, name: str) -> str:
    """Return "written" or "unwritten" if a file defines the function, and an empty string otherwise.

    Raises
    ------
    SyntaxError
        If Python cannot parse the file, or the cell of the definition.
    ValueError
        If the file is not a notebook.
    """
    cells = _cells(path)
    if _is_named(path, name):
        statements = ast.parse(path.read_bytes()).body
    else:
        statements = [node for cell in cells for node in notebook.parsed(cell)]
    defining = [node for node in statements if notebook.defines(node, name)]
    if any(not notebook.is_unwritten(node, name) for node in defining):
        return "written"
    if error := notebook.broken(cells, name):
        raise error
    return "unwritten" if defining else ""


def _write_files_of_cells(folder: Path) -> Iterator[tuple[str, str]]:
    """Write the Python files that cells write with ``%%writefile``, and yield each with its notebook.

    A file is written beside its notebook, and replaces only a file with a function that was not written.
    """
    for path in sorted(folder.rglob("*.ipynb")):
        content = path.read_bytes()
        if b"%%writefile" not in content and b"%%file" not in content:
            continue
        try:
            cells = notebook.sources(content)
        except ValueError:
            continue
        for name, text, append in notebook.written_files(cells):
            target = path.parent / Path(name).name
            with suppress(OSError, SyntaxError, ValueError, RecursionError):
                if target.suffix == ".py" and _may_be_written(target):
                    with target.open("a" if append else "w", encoding="utf-8") as file:
                        file.write(text)
                    yield str(target.relative_to(folder)), str(path.relative_to(folder))


def _may_be_written(path: Path) -> bool:
    return not path.exists() or _state(path, path.stem.casefold()) == "unwritten"
