"""The student's function for the tests: calls run in the sandbox, and answers are compared in this process."""

from __future__ import annotations

import builtins
import itertools
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from . import compare, sandbox
from .course import Exercise
from .grade import Unaccepted
from .reference import Case, Reference
from .sandbox import Garbled, Limits, TimedOut, Worker
from .submission import Refused, Submission


class Calls(Protocol):
    """An object that calls a student's function."""

    secret: bool

    def call(self, exercise: Exercise, arguments: Sequence[Any]) -> Any: ...


class Session:
    """One submission in one sandbox. The sandbox starts with the first call, and starts again after it was killed."""

    def __init__(
        self,
        submission: Submission | Refused,
        tier: str,
        *,
        limits: Limits | None = None,
        secret: bool = False,
        python: str | None = None,
    ) -> None:
        self.tier = tier
        self.secret = secret
        self._files = submission.files if isinstance(submission, Submission) else {}
        self._refused = submission if isinstance(submission, Refused) else None
        self._limits = limits or Limits()
        self._python = python
        self._worker: Worker | None = None
        self._serving: Exercise | None = None
        # by exercise, so that a file that hangs is loaded only once
        self._failed: dict[str, Unaccepted] = {}
        self._left: dict[str, float] = {}  # seconds by exercise
        self._asked = 0

    def call(self, exercise: Exercise, arguments: Sequence[Any]) -> Any:
        """Return what the student's function answers, as plain values.

        Raises
        ------
        Unaccepted
            If it answers with an error, too late, or not at all.
        SandboxFault
            If the sandbox itself fails.
        """
        if self._refused:
            raise Unaccepted("error", f"The submission was refused: {self._refused}.")
        if exercise.id in self._failed:
            raise self._failed[exercise.id]
        self._serve(exercise)
        return self._ask(exercise, {"do": "call", "args": list(arguments)})

    def close(self) -> None:
        """End the sandbox."""
        if self._worker is not None:
            self._worker.end()
        self._worker = self._serving = None

    def _serve(self, exercise: Exercise) -> None:
        """Load the student's function into a process that has run no other exercise."""
        if self._serving == exercise:
            return
        self._dismiss()
        used = self._worker is not None
        try:
            self._load(exercise)
        except Unaccepted as failure:
            spoiled = used and self._worker is None and failure.state == "error"
            if spoiled:  # perhaps by the previous exercise: this one gets a new sandbox
                self._load(exercise)
                return
            self._failed[exercise.id] = failure
            raise

    def _load(self, exercise: Exercise) -> None:
        if self._worker is None:
            self._worker = sandbox.start(
                self.tier, self._files, self._limits, python=self._python
            )
        self._serving = exercise
        self._ask(
            exercise, {"do": "load", "chapter": exercise.chapter, "name": exercise.name}
        )

    def _dismiss(self) -> None:
        """End the previous exercise's child process. If that fails, end the whole sandbox."""
        if self._worker is None or self._serving is None:
            return
        self._serving = None
        try:
            reply = self._worker.ask({"do": "end"}, 1.0) if self._worker.forks else None
        except (TimedOut, EOFError, Garbled):
            reply = None
        match reply:
            case {"ended": int(status)} if status == 0:
                return
        self.close()

    def _ask(self, exercise: Exercise, request: dict[str, Any]) -> Any:
        assert self._worker is not None
        self._asked += 1
        left = self._left.setdefault(exercise.id, self._limits.exercise_seconds)
        if left <= 0:
            raise Unaccepted(
                "timeout",
                f"The {self._limits.exercise_seconds:g} seconds for this exercise are used up.",
            )
        seconds = min(self._limits.call_seconds, left)
        start = time.monotonic()
        try:
            reply = self._worker.ask({"id": self._asked, **request}, seconds)
        except TimedOut:
            self.close()
            raise Unaccepted(
                "timeout", f"No answer came within {seconds:.1f} seconds."
            ) from None
        except EOFError:
            self.close()
            raise Unaccepted(
                "error", "Your code ended the process it ran in."
            ) from None
        except Garbled as error:
            self.close()
            raise Unaccepted(
                "error", self._told("The reply is not an answer", f": {error}.")
            ) from None
        finally:
            self._left[exercise.id] = left - (time.monotonic() - start)
        # match types first, because comparing an array with == gives no truth value
        match reply:
            case {"id": int(number), "value": value, **rest} if (
                number == self._asked and not rest
            ):
                return value
            case {
                "id": int(number),
                "raised": {"kind": str(kind), "message": str(message), "where": where},
            } if number == self._asked:
                raise self._raised(kind, message, where)
            case {"ended": int(status)}:
                self._serving = None
                raise self._ended(status)
        self.close()
        raise Unaccepted("error", "The reply does not belong to the request.")

    def _raised(self, kind: str, message: str, where: Any) -> Unaccepted:
        """Describe an error that the student's code raised."""
        match where:
            case [str(file), int(line)] if file in self._files:
                place = f" ({file}, line {line})."
            case _:
                place = "."
        if kind == "NotImplementedError":
            return Unaccepted("missing", "Not attempted.")
        if kind == "MemoryError":
            return Unaccepted(
                "memory",
                self._told("Your code needs more memory than the limit", place),
            )
        if kind == "FrameError":
            said = "The answer must be numbers, strings, lists, dicts or arrays"
            return Unaccepted("error", self._told(said, f", not {message}."))
        known = not self.secret or isinstance(getattr(builtins, kind, None), type)
        return Unaccepted(
            "error",
            self._told(
                kind if known else "An error of your own", f": {message}{place}"
            ),
        )

    def _ended(self, status: int) -> Unaccepted:
        if status == -9:
            return Unaccepted(
                "memory",
                "The system stopped your code, because it used too much memory or processor time.",
            )
        if status < 0:
            return Unaccepted(
                "error",
                self._told(
                    "Your code crashed the process it ran in", f" (signal {-status})."
                ),
            )
        return Unaccepted(
            "error",
            self._told(
                "Your code ended the process it ran in", f" (exit code {status})."
            ),
        )

    def _told(self, said: str, more: str) -> str:
        """Omit ``more`` when the cases are secret, because the student's code could reveal a case in it."""
        return f"{said}; try robonav check at home." if self.secret else f"{said}{more}"


class Answer:
    """The student's function in one part of an exercise.

    Attributes
    ----------
    expected : object
        The reference's answer to the last call.
    """

    def __init__(
        self, calls: Calls, reference: Reference, exercise: Exercise, part: str
    ) -> None:
        self._calls, self._reference, self._exercise = calls, reference, exercise
        self._cases = (Case(exercise, part, number) for number in itertools.count())
        self._case: Case
        self._got: Any = None
        self.expected: Any = None

    def agrees(self, *arguments: Any) -> Any:
        """Call the function, compare its answer with the reference's, and return it for further checks."""
        self._call(arguments)
        if problem := compare.difference(self._got, self.expected):
            raise self._wrong(problem)
        return self._got

    def array(self, *arguments: Any, shape: tuple[int, ...]) -> np.ndarray:
        """Call the function and return its answer as an array of finite floats of this shape."""
        self._call(arguments)
        array = compare.as_numbers(self._got)
        if array is None or array.shape != shape:
            raise self._wrong(
                f"expected {compare.kind(np.zeros(shape))}, got {compare.kind(self._got)}"
            )
        if not np.isfinite(array).all():
            raise self._wrong("the answer holds NaN or infinity")
        return array.astype(float)

    def check(self, holds: bool, otherwise: str) -> None:
        """Require a property of the last answer. ``otherwise`` tells the student what is wrong if it does not hold."""
        if not holds:
            raise self._wrong(otherwise)

    def _call(self, arguments: tuple[Any, ...]) -> None:
        self._case = replace(next(self._cases), arguments=arguments)
        self.expected = self._reference.expected(self._case)
        self._got = self._calls.call(self._exercise, arguments)

    def _wrong(self, problem: str) -> Unaccepted:
        if self._calls.secret:
            problem = compare.without_answer(problem)
        called = compare.call(
            self._exercise.name, self._case.arguments, numbers=not self._calls.secret
        )
        hints = [
            f"Hint: {hint}" for hint in self._reference.hints(self._case, self._got)
        ]
        return Unaccepted(
            "wrong", "\n".join([called, f"{problem[0].upper()}{problem[1:]}.", *hints])
        )
