"""Read the definitions of a notebook from its syntax tree. No other code of the notebook runs.

This file uses the standard library only, because it runs in the sandbox: a hostile notebook could crash the program
that reads it.
"""

from __future__ import annotations

import ast
import json
import re
from typing import Any

# cell magics whose cell is still Python
PYTHON_CELLS = (
    "%%time",
    "%%timeit",
    "%%capture",
    "%%prun",
)


def definitions(notebook: bytes) -> ast.Module:
    """Return the functions, named lambdas, classes, imports and constants of all code cells as one module.

    Cells that Python cannot parse, magics (``%matplotlib inline``) and shell lines are left out. An import that fails
    is ignored, because only the cells that plot need a plotting library.

    Raises
    ------
    ValueError
        If the bytes are not a notebook.
    """
    kept = [
        node
        for source in _sources(notebook)
        for node in _parsed(source)
        if _defines(node)
    ]
    return ast.fix_missing_locations(
        ast.Module([_forgiving(node) for node in kept], type_ignores=[])
    )


def names(node: ast.stmt) -> str | None:
    """Return the name that a definition binds."""
    match node:
        case (
            ast.FunctionDef(name=name)
            | ast.ClassDef(name=name)
            | ast.Assign(targets=[ast.Name(id=name)])
        ):
            return name
    return None


def broken(notebook: bytes, name: str) -> SyntaxError | None:
    """Return why Python cannot parse the cell that should define ``name``, or None."""
    for source in _sources(notebook):
        if re.search(
            rf"^def {re.escape(name)}\b", source, re.MULTILINE
        ) and not _parsed(source):
            try:
                ast.parse(_without_magics(source))
            except SyntaxError as error:
                return SyntaxError(
                    f"{error.msg} in line {error.lineno} of the cell that defines {name}"
                )
    return None


def _sources(notebook: bytes) -> list[str]:
    try:
        cells = json.loads(notebook)["cells"]
        return [_source(cell) for cell in cells if cell["cell_type"] == "code"]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ValueError("this is not a notebook of format 4") from None


def _source(cell: dict[str, Any]) -> str:
    source = cell["source"]
    return source if isinstance(source, str) else "".join(source)


def _parsed(source: str) -> list[ast.stmt]:
    for text in (source, _without_magics(source)):
        try:
            return ast.parse(text).body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            continue
    return []


def _without_magics(source: str) -> str:
    """Blank the magics of a cell, so that line numbers do not change."""
    if source.lstrip().startswith("%%") and source.split()[0] not in PYTHON_CELLS:
        return ""
    return "\n".join(
        "" if line.lstrip().startswith(("%", "!")) else line
        for line in source.splitlines()
    )


def _defines(node: ast.stmt) -> bool:
    match node:
        case ast.FunctionDef() | ast.ClassDef() | ast.Import() | ast.ImportFrom():
            return True
        case ast.Assign(targets=[ast.Name()], value=value):
            return isinstance(value, ast.Lambda) or _is_literal(value)
        case ast.AnnAssign(target=ast.Name(), value=ast.expr() as value):
            return _is_literal(value)
    return False


def _is_literal(value: ast.expr) -> bool:
    try:
        ast.literal_eval(value)
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        return False
    return True


def _forgiving(node: ast.stmt) -> ast.stmt:
    if isinstance(node, ast.Import | ast.ImportFrom):
        handler = ast.ExceptHandler(
            type=ast.Name("ImportError", ast.Load()), name=None, body=[ast.Pass()]
        )
        return ast.copy_location(
            ast.Try(body=[node], handlers=[handler], orelse=[], finalbody=[]), node
        )
    return node
