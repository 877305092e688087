"""The parts of an exercise: one test function each, its own random numbers, and what becomes of its outcome.

A part is a function ``test_...(answer, rng)`` in ``tests/exercises/test_chN.py``, marked with its exercise and points;
the first line of its docstring tells the student what it asks for.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from .course import Course, Exercise, trusted
from .grade import FAULT, Part, Unaccepted, printable

PUBLIC = b"2015"  # what the cases are drawn from where no secret is given

SECRET = "ROBONAV_SECRET"

Test = Callable[..., None]


def secret_from(path: str | Path | None) -> bytes:
    """What the cases for marks are drawn from: a file's content, or the environment's, or nothing."""
    if path is None:
        return os.environ.get(SECRET, "").encode()
    try:
        content = Path(path).read_bytes().strip()
    except OSError as error:
        raise ValueError(f"the secret cannot be read: {error}") from None
    if not content:
        raise ValueError(f"the secret in {path} is empty")
    return content


def parts_of(course: Course, exercise: Exercise) -> Iterator[tuple[Test, int]]:
    """Each part's test and points, in order."""
    for test in vars(trusted(course.tests / f"test_{exercise.chapter}.py")).values():
        for mark in getattr(test, "pytestmark", []):
            if mark.name == "part" and mark.args[0] == exercise.id:
                yield test, mark.kwargs["points"]


def generator(seed: bytes, name: str) -> np.random.Generator:
    """The random numbers of the part of this name."""
    return np.random.default_rng(
        int.from_bytes(hashlib.sha256(seed + b"/" + name.encode()).digest()[:16], "big")
    )


def outcome(test: Test, points: int, error: BaseException | None) -> Part:
    """A part's state and feedback from what its test raised; whatever is no judgement is the grader's own fault."""
    name = (test.__doc__ or test.__name__).strip().partition("\n")[0]
    match error:
        case None:
            return Part(name, points, "correct", "")
        case Unaccepted():
            return Part(name, points, error.state, printable(error.feedback))
        case AssertionError():  # pytest's message would show the cases
            return Part(name, points, "wrong", "This does not hold for your answer.")
    return Part(name, points, "grader-fault", FAULT)
