"""A readable function and its fast twin: a test holds the two equal, and the twin is what runs."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def runs(twin: Callable[P, R]) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a readable function: calls go to its twin. ``inspect.unwrap`` gives the function as written.

    Examples
    --------
    >>> import inspect
    >>> from robonav.nirl.twins import runs
    >>> def gauss(n):
    ...     return n * (n + 1) // 2
    >>> @runs(gauss)
    ... def total(n):
    ...     return sum(range(n + 1))
    >>> total(10**12), inspect.unwrap(total)(4)
    (500000000000500000000000, 10)
    """

    def decorate(readable: Callable[P, R]) -> Callable[P, R]:
        """Let the twin run under the name and the docstring of this function."""

        @wraps(readable)
        def run(*args: P.args, **kwargs: P.kwargs) -> R:
            """Call the twin."""
            return twin(*args, **kwargs)

        return run

    return decorate
