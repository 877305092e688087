"""Read the definitions that an exercise needs from the cells of a notebook, as IPython reads them.

A cell that Python cannot parse goes through IPython's own input transformer, which turns magics, shell lines and
questions into calls of ``get_ipython()``. These calls are then removed. This file runs in the sandbox, because a
hostile notebook could crash the program that reads it. It needs the standard library and those two files of IPython
that the sandbox holds.
"""

from __future__ import annotations

import ast
import functools
import json
import re
import types
from collections.abc import Iterator, Sequence
from dis import get_instructions
from typing import Any

# the body of a function that is not written yet
STUB = 'raise NotImplementedError("{name} is yours to write")'
# magics whose text is still Python
PYTHON_MAGICS = ("time", "timeit", "capture", "prun")
WRITTEN_FILE = re.compile(
    r"\s*%%(?:writefile|file)[ \t]+(?P<append>-a[ \t]+)?(?P<file>[^\n]+)\n(?P<text>.*)",
    re.DOTALL,
)


def sources(notebook: bytes) -> list[str]:
    """Return the text of each code cell of a notebook, of format 4 or 3.

    Raises
    ------
    ValueError
        If the bytes are not a notebook.
    """
    try:
        content = json.loads(notebook)
        cells = (
            content["cells"]
            if "cells" in content
            else [cell for sheet in content["worksheets"] for cell in sheet["cells"]]
        )
        return [_source(cell) for cell in cells if cell["cell_type"] == "code"]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ValueError("this is not a notebook of format 3 or 4") from None


def definitions(cells: Sequence[str], name: str) -> ast.Module:
    """Return the statements of these cells that define ``name`` and everything that it uses, as one module.

    Other statements, which try something out or plot, are left out. A function that only raises ``NotImplementedError``
    is not a definition. An import that fails is ignored, because only a part of the function may need it.
    """
    statements = [node for cell in cells for node in parsed(cell)]
    statements = [node for node in statements if not is_unwritten(node, name)]
    imports = [
        node for node in statements if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    modules = {name for node in imports for name in _bound(node)}
    bound = [{*_bound(node), *(set(_changed(node)) - modules)} for node in statements]
    kept: set[int] = set()
    needed, before = {name}, -1
    while len(kept) > before:
        before = len(kept)
        for number, node in enumerate(statements):
            if number not in kept and (bound[number] & needed or _is_general(node)):
                kept.add(number)
                needed.update(_used(node))
    chosen = [statements[number] for number in sorted(kept)]
    chosen.sort(key=lambda node: not _is_future(node))  # Python wants these first
    return ast.fix_missing_locations(
        ast.Module([_forgiving(without_stub_line(node)) for node in chosen], [])
    )


def defines(node: ast.stmt, name: str) -> bool:
    """Whether a statement binds ``name``."""
    return name in _bound(node)


def is_unwritten(node: ast.stmt, name: str) -> bool:
    """Whether a statement is the function ``name`` as it was handed out: it only raises ``NotImplementedError``."""
    if not (isinstance(node, ast.FunctionDef) and node.name == name):
        return False
    body = node.body[1:] if ast.get_docstring(node) is not None else node.body
    return len(body) == 1 and _raises_not_implemented(body[0])


def without_stub_line(node: ast.stmt) -> ast.stmt:
    """Remove the line ``raise NotImplementedError("... is yours to write")`` that was left in a written function."""
    if isinstance(node, ast.FunctionDef):
        rest = [step for step in node.body if not _is_stub_line(step)]
        node.body = rest or node.body
    return node


def broken(cells: Sequence[str], name: str) -> SyntaxError | None:
    """Return why Python cannot parse the cell that should define ``name``, or None."""
    for source in cells:
        if re.search(rf"^\s*def {re.escape(name)}\b", source, re.MULTILINE):
            try:
                _tree(source)
            except SyntaxError as error:
                return SyntaxError(
                    f"{error.msg} in line {error.lineno} of the cell that defines {name}"
                )
            except (ValueError, RecursionError, MemoryError):
                return SyntaxError(f"the cell that defines {name} cannot be read")
    return None


def written_files(cells: Sequence[str]) -> Iterator[tuple[str, str, bool]]:
    """Yield the name and text of each file that a cell writes with ``%%writefile``, and whether it is appended."""
    for source in cells:
        if match := WRITTEN_FILE.match(source):
            name = match["file"].strip().strip("\"'")
            yield name, match["text"], bool(match["append"])


def parsed(source: str) -> list[ast.stmt]:
    """Return the statements of a cell, or none where it cannot be parsed."""
    try:
        return _tree(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []


@functools.cache
def transformer() -> Any:
    """Return IPython's input transformer. The sandbox must call this before imports are restricted.

    Raises
    ------
    ImportError
        If IPython is not installed.
    """
    from IPython.core.inputtransformer2 import TransformerManager

    return TransformerManager()


def _tree(source: str) -> list[ast.stmt]:
    try:
        return ast.parse(source).body
    except SyntaxError as error:
        try:
            transformed = transformer().transform_cell(source)
        except ImportError:
            raise error from None
        return WithoutMagics().visit(ast.parse(transformed)).body


class WithoutMagics(ast.NodeTransformer):
    """Replace calls of ``get_ipython()`` by the Python code that they run, or by nothing."""

    def visit_Expr(self, node: ast.Expr) -> Any:
        """Return the statements of a magic such as ``%time``, or ``pass``."""
        match node.value:
            case ast.Call(
                func=ast.Attribute(value=value),
                args=[
                    ast.Constant(value=str(magic)),
                    *_,
                    ast.Constant(value=str(code)),
                ],
            ) if _is_ipython(value):
                found = parsed(code) if magic in PYTHON_MAGICS else []
                return found or ast.copy_location(ast.Pass(), node)
        return self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """Return None as the value of a magic, as in ``files = !ls``."""
        match node.func:
            case ast.Attribute(value=value) if _is_ipython(value):
                return ast.copy_location(ast.Constant(None), node)
        self.generic_visit(node)
        return node


def _is_ipython(node: ast.expr) -> bool:
    match node:
        case ast.Call(func=ast.Name(id="get_ipython")):
            return True
    return False


def _source(cell: dict[str, Any]) -> str:
    source = cell["source"] if "source" in cell else cell["input"]
    return source if isinstance(source, str) else "".join(source)


def _bound(node: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement binds, or of whose value it assigns a part."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        yield node.name
        return
    for part in ast.walk(node):
        match part:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.alias(name=name, asname=other):
                yield other or name.partition(".")[0]
            case ast.Name(id=name, ctx=ast.Store()):
                yield name
            case ast.Subscript(ctx=ast.Store()) | ast.Attribute(ctx=ast.Store()):
                yield _root(part)


def _changed(node: ast.stmt) -> Iterator[str]:
    """Yield the names whose value a statement may change by a method, such as ``table`` in ``table.append(1)``."""
    for part in ast.walk(node):
        match part:
            case ast.Expr(value=ast.Call(func=ast.Attribute() as method)):
                yield _root(method)


def _root(node: ast.expr) -> str:
    """Return ``table`` for ``table.rows[0]``."""
    while isinstance(node, ast.Subscript | ast.Attribute):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _used(node: ast.stmt) -> Iterator[str]:
    """Yield the global names that a statement uses, also within its functions."""
    try:
        waiting = [compile(ast.Module([node], []), "", "exec")]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    while waiting:
        code = waiting.pop()
        for step in get_instructions(code):
            if step.opname.startswith("LOAD") and step.opname.endswith(
                ("NAME", "GLOBAL", "GLOBALS")
            ):
                yield str(step.argval)
        waiting += [
            inner for inner in code.co_consts if isinstance(inner, types.CodeType)
        ]


def _is_general(node: ast.stmt) -> bool:
    """Whether a statement is about the whole module: ``from x import *`` or ``from __future__ import x``."""
    return isinstance(node, ast.ImportFrom) and (
        _is_future(node) or node.names[0].name == "*"
    )


def _is_future(node: ast.stmt) -> bool:
    return isinstance(node, ast.ImportFrom) and node.module == "__future__"


def _raises_not_implemented(node: ast.stmt) -> bool:
    match node:
        case (
            ast.Raise(exc=ast.Name(id="NotImplementedError"))
            | ast.Raise(exc=ast.Call(func=ast.Name(id="NotImplementedError")))
        ):
            return True
    return False


def _is_stub_line(node: ast.stmt) -> bool:
    match node:
        case ast.Raise(exc=ast.Call(args=[ast.Constant(value=str(text))])):
            return _raises_not_implemented(node) and text.endswith("is yours to write")
    return False


def _forgiving(node: ast.stmt) -> ast.stmt:
    """Let an import fail, which only plots may need, and a call of a method, which may only try something out."""
    match node:
        case ast.Import() | ast.ImportFrom() if not _is_future(node):
            error = "ImportError"
        case ast.Expr():
            error = "Exception"
        case _:
            return node
    handler = ast.ExceptHandler(ast.Name(error, ast.Load()), None, [ast.Pass()])
    return ast.copy_location(ast.Try([node], [handler], [], []), node)
