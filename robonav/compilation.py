"""Compile the fast twins with numba, also kernels that call kernels of other files."""

from __future__ import annotations

import hashlib
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

from numba import njit
from numba.core.caching import FunctionCache


def compiler(
    *used: ModuleType, inline: bool = False, signature: str = ""
) -> Callable[[Any], Any]:
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
    signature : str
        numba's types of the arguments and the result, if the functions are to be compiled for these types alone.
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
        """Compile a kernel, with a cache that depends on the files it uses."""
        kernel: Any = njit(nogil=True, error_model="numpy", inline=where)(function)
        try:
            kernel._cache = Cache(function)
        except RuntimeError:  # no folder to write in: see NUMBA_CACHE_DIR
            warn_without_cache()
        if signature:
            kernel.compile(signature)
            kernel.disable_compile()
        return kernel

    return compiled


@cache
def warn_without_cache() -> None:
    """Warn, once in a process, that compiled functions cannot be kept."""
    warnings.warn(
        "robonav compiles its fast functions again in each process, which takes some seconds: neither its folder nor "
        "the home folder can be written to. Set NUMBA_CACHE_DIR to a folder that can",
        stacklevel=2,
    )
