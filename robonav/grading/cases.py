"""The parts of an exercise, the random cases that each part draws, and the result of running one.

A part is a test function ``test_...(answer, rng)`` in ``tests/exercises/test_chN.py``, marked with its exercise and
points. The first line of its docstring tells the student what the part asks for.
"""

from __future__ import annotations

import functools
import hashlib
import hmac
import os
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from .course import Course, Exercise, trusted
from .grade import FAULT, Part, State, Unaccepted, printable

PUBLIC = b"2015"  # the seed of the cases when no secret is given
# What feedback says of a part that failed in secret cases. Nothing in it is chosen by the student's code, which could
# otherwise tell a case.
KEPT_SECRET: dict[State, str] = {
    "wrong": "An answer was wrong in a case that is kept secret.",
    "error": "Your code ended in an error.",
    "timeout": "No answer came in time.",
    "memory": "Your code needs more memory than the limit.",
    "missing": "Not attempted.",
}

SECRET = "ROBONAV_SECRET"

Test = Callable[..., None]


def secret_from(path: str | Path | None) -> bytes:
    """Return the secret seed of the cases, from a file or from ROBONAV_SECRET, or None if neither is given."""
    if path is None:
        return os.environ.get(SECRET, "").encode()
    try:
        content = Path(path).read_bytes().strip()
    except OSError as error:
        raise ValueError(f"the secret cannot be read: {error}") from None
    if not content:
        raise ValueError(f"the secret in {path} is empty")
    return content


@functools.cache
def stretched(secret: bytes) -> bytes:
    """Return a key for the secret. It takes long to compute, so that nobody finds a short secret by trying words."""
    return hashlib.scrypt(secret, salt=b"robonav", n=1 << 14, r=8, p=1)


def seed_of(secret: bytes, digest: str) -> bytes:
    """Return the seed of the cases for a submission with this digest.

    Under a secret, every change of a submission draws all its cases again. What is learnt about the cases of one
    submission is of no use for the next.
    """
    if not secret:
        return PUBLIC
    return hmac.digest(stretched(secret), digest.encode(), "sha256")


def parts_of(course: Course, exercise: Exercise) -> Iterator[tuple[Test, int]]:
    """Yield each part's test and points, in order."""
    for test in vars(trusted(course.tests / f"test_{exercise.chapter}.py")).values():
        for mark in getattr(test, "pytestmark", []):
            if mark.name == "part" and mark.args[0] == exercise.id:
                yield test, mark.kwargs["points"]


def generator(seed: bytes, name: str) -> np.random.Generator:
    """Return the random generator of the part with this name."""
    return np.random.default_rng(
        int.from_bytes(hashlib.sha256(seed + b"/" + name.encode()).digest()[:16], "big")
    )


def outcome(
    test: Test, points: int, error: BaseException | None, *, secret: bool = False
) -> Part:
    """Return a part's state and feedback from what its test raised. Any unexpected error is a fault of the grader.

    Under a secret, the feedback tells no more than the state.
    """
    name = (test.__doc__ or test.__name__).strip().partition("\n")[0]
    state: State
    match error:
        case None:
            state, feedback = "correct", ""
        case Unaccepted():
            state, feedback = error.state, printable(error.feedback)
        case AssertionError():  # pytest's message would show the cases
            state, feedback = "wrong", "This does not hold for your answer."
        case _:
            state, feedback = "grader-fault", FAULT
    if secret and not (isinstance(error, Unaccepted) and error.refused):
        feedback = KEPT_SECRET.get(state, feedback)
    return Part(name, points, state, feedback, test.__name__)
