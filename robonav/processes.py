"""Calls of a function in several processes of this machine."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import Any


def in_processes(
    function: Callable[..., Any], calls: Iterable[tuple[Any, ...]], jobs: int
) -> Iterator[Any]:
    """Call a function with each tuple of arguments, and yield the results in the order in which they are ready.

    The processes end when the one that began them has died, however it died.

    Parameters
    ----------
    function : callable
    calls : iterable of tuple
        The arguments of each call. They are drawn when a process needs them.
    jobs : int
        How many processes; 1 calls the function in this process, and -1 means one for each core.

    Yields
    ------
    object
        What a call returned.

    Examples
    --------
    >>> list(in_processes(pow, [(2, 3), (3, 2)], jobs=1))
    [8, 9]
    """
    from joblib import Parallel, delayed

    parent = os.getpid()
    yield from Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)(
        delayed(_call)(parent, function, arguments) for arguments in calls
    )


def _call(parent: int, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    if os.getpid() != parent:
        _end_with(parent)
    return function(*arguments)


@cache
def _end_with(parent: int) -> None:
    """End this process soon after its parent. A killed parent tells its children nothing, so they have to look."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
