"""Progress of long computations: one optional callback, such as a progress bar."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol


class Progress(Protocol):
    """Called by long-running functions as ``progress(done, total)``."""

    def __call__(self, done: int, total: int) -> None: ...


@contextmanager
def bar(description: str) -> Iterator[Progress]:
    """Show a tqdm bar as a progress callback: ``with bar("training") as progress: train(progress=progress)``."""
    from tqdm.auto import tqdm

    with tqdm(desc=description) as drawn:

        def update(done: int, total: int) -> None:
            drawn.total = total
            drawn.n = done
            drawn.refresh()

        yield update
