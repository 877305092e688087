"""Keep submissions off every path from which the grader imports modules or starts programs.

A student's ``pickle.py`` would otherwise run as the instructor. Most processes that joblib, multiprocessing and Dask
start look for modules in the current folder first, and the current folder may be the class.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2]  # the folder that robonav lies in
VARIABLES = ("PYTHONSAFEPATH", "PYTHONPATH")


@contextmanager
def without_submissions(folder: Path) -> Iterator[None]:
    """Import nothing from a folder of submissions or from the current folder, in this process and those it starts."""
    before = list(sys.path), {name: os.environ.get(name) for name in VARIABLES}
    given = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    sys.path[:] = safe(sys.path, folder)
    os.environ["PYTHONSAFEPATH"] = "1"
    os.environ["PYTHONPATH"] = os.pathsep.join(safe(filter(None, given), folder))
    try:
        yield
    finally:
        sys.path[:] = before[0]
        for name, value in before[1].items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


def safe(entries: Iterator[str] | Sequence[str], folder: Path) -> list[str]:
    """Return the entries of a path without the current folder and a folder of submissions, as absolute paths."""
    return [
        os.path.abspath(entry) for entry in entries if not _is_unsafe(entry, folder)
    ]


def unsafe_here(folder: str) -> list[str]:
    """Return the entries of this process's path from which it should import nothing. A Dask worker runs this."""
    return [entry for entry in sys.path if _is_unsafe(entry, Path(folder))]


def _is_unsafe(entry: str, folder: Path) -> bool:
    place, submissions = Path(entry).resolve(), folder.resolve()
    if place == PACKAGE or place.is_relative_to(Path(sys.prefix).resolve()):
        return False
    return place == Path.cwd() or place.is_relative_to(submissions)
