"""Running a kernel over many worlds in threads."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

_pool: ThreadPoolExecutor | None = None
_CORES = (
    len(os.sched_getaffinity(0))
    if hasattr(os, "sched_getaffinity")
    else os.cpu_count() or 1
)


def _forget_pool() -> None:
    global _pool
    _pool = None


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_pool)  # threads do not survive a fork


def in_threads(
    kernel: Callable[..., None], worlds: int, *arguments: Any, least: int = 256
) -> None:
    """Run ``kernel(start, stop, *arguments)`` over 0..worlds, split over the machine's cores.

    A thread gets at least ``least`` worlds; for fewer, handing over takes longer than the work.
    """
    global _pool
    if worlds < 2 * least or _CORES == 1:
        kernel(0, worlds, *arguments)
        return
    if _pool is None:
        _pool = ThreadPoolExecutor(_CORES - 1, thread_name_prefix="robonav")
    parts = min(_CORES, worlds // least)
    cuts = [worlds * k // parts for k in range(parts + 1)]
    others = [
        _pool.submit(kernel, cuts[k], cuts[k + 1], *arguments) for k in range(1, parts)
    ]
    kernel(0, cuts[1], *arguments)  # a part for this thread, which would only wait
    for other in others:
        other.result()
