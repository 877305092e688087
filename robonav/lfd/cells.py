"""The warning of a search whose cells are larger than a move, so that it may have missed a path."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import Any, ParamSpec

P = ParamSpec("P")
Found = tuple[bool, list[Any], int]


def warn_if_cells_hide_paths(name: str, cell: float, move: float) -> None:
    """Warn, if cells are larger than a move, that a move which stays in its cell leads to no new node.

    Examples
    --------
    >>> from robonav.lfd.cells import warn_if_cells_hide_paths
    >>> warn_if_cells_hide_paths("plan", cell=1.0, move=2.0)
    """
    if cell > move:
        warnings.warn(
            f"{name} found no path with cells of {cell:g} m and moves of {move:g} m: a move that ends in the cell it "
            f"began in leads to no new node, so cell should be at most {move:g}",
            stacklevel=3,
        )


def warns_if_cells_hide_paths(search: Callable[P, Found]) -> Callable[P, Found]:
    """Let a search warn where it finds no path and its cells are larger than a move of length ``speed``."""

    @wraps(search)
    def warning(*args: P.args, **kwargs: P.kwargs) -> Found:
        """Search, and warn."""
        found, path, expanded = search(*args, **kwargs)
        if not found:
            given = signature(search).bind(*args, **kwargs)
            given.apply_defaults()
            cell, speed = given.arguments["cell"], given.arguments["speed"]
            warn_if_cells_hide_paths(search.__name__, cell, speed)
        return found, path, expanded

    return warning
