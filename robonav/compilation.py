"""Compile the fast twins with numba, also kernels that call kernels of other files."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

from numba import njit
from numba.core.caching import FunctionCache


def compiler(*used: ModuleType, inline: bool = False) -> Callable[[Any], Any]:
    """Return a decorator that compiles kernels and caches them on disk.

    numba recompiles a cached kernel when its own file changes, but not when a file changes whose kernels it calls.
    The cache of this decorator therefore also depends on the contents of the files of ``used``.

    Parameters
    ----------
    *used : module
        The modules with the kernels that the decorated kernels call.
    inline : bool
        Whether numba copies the decorated functions into the kernels that call them. Use it where a call with many
        arrays costs more than the work of the function.
    """
    where: Literal["always", "never"] = "always" if inline else "never"
    digests = tuple(
        hashlib.sha256(Path(str(module.__file__)).read_bytes()).hexdigest()
        for module in used
    )

    class Cache(FunctionCache):
        def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
            return (*super()._index_key(sig, codegen), *digests)

    def compiled(function: Any) -> Any:
        kernel: Any = njit(nogil=True, error_model="numpy", inline=where)(function)
        kernel._cache = Cache(function)
        return kernel

    return compiled
