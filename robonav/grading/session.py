"""The student's function for the tests: calls run in the sandbox, and answers are compared in this process."""

from __future__ import annotations

import itertools
import re
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from . import compare, sandbox
from .course import Exercise
from .evidence import Evidence
from .grade import Unaccepted
from .reference import Case
from .sandbox import Garbled, Limits, TimedOut, Worker
from .submission import Refused, Submission
from .worker import MOST_TEXT

MOST_ROWS = 8  # as many rows have their first numbers shown
ROWS = 5  # answers with as many rows have the arguments' rows shown


class Calls(Protocol):
    """An object that calls a student's function."""

    changed: list[int]  # the arguments that the last call changed
    printed: str  # what the last call printed, where that is shown

    def call(self, exercise: Exercise, arguments: Sequence[Any]) -> Any: ...


class Session:
    """One submission in one sandbox. The sandbox starts with the first call, and starts again after it was killed.

    Parameters
    ----------
    submission : Submission or Refused
        The files.
    tier : str
        The tier of the sandbox.
    limits : Limits, optional
        What the submission may use.
    show : bool
        Whether feedback shows what the student's code prints.
    instead : sequence of str
        Tiers to try where a sandbox of the given tier does not start.
    python : str, optional
        The interpreter for the student's code.
    """

    def __init__(
        self,
        submission: Submission | Refused,
        tier: str,
        *,
        limits: Limits | None = None,
        show: bool = False,
        instead: Sequence[str] = (),
        python: str | None = None,
    ) -> None:
        self.tier = tier
        self.changed: list[int] = []
        self.printed = ""
        self._show, self._instead = show, list(instead)
        self._files = submission.files if isinstance(submission, Submission) else {}
        self._refused = submission if isinstance(submission, Refused) else None
        self._limits = limits or Limits()
        self._python = python
        self._worker: Worker | None = None
        self._serving: Exercise | None = None
        # by exercise, so that a file that hangs is loaded only once
        self._failed: dict[str, Unaccepted] = {}
        self.found: dict[str, str] = {}  # the file with the answer, by exercise
        self.unwritten: set[str] = set()  # exercises whose function is as handed out
        self.damaged: set[str] = set()  # notebooks that cannot be read
        self._opened = False  # whether these are known
        self._looked = False
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
            said = f"The submission was refused: {self._refused}."
            raise Unaccepted("error", said, refused=True)
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
            failure.raised = None  # not by a call
            spoiled = used and self._worker is None and failure.state == "error"
            if spoiled:  # perhaps by the previous exercise: this one gets a new sandbox
                self._load(exercise)
                return
            self._failed[exercise.id] = failure
            raise

    def look(self, exercises: Iterable[Exercise]) -> None:
        """Find the files with the answers before any of the student's code runs, which could name any file later."""
        for exercise in exercises if self._refused is None else ():
            with suppress(Unaccepted):
                self._find(exercise)
            self._dismiss()
        self._looked = True

    def _load(self, exercise: Exercise) -> None:
        path = self._find(exercise)
        request = {"do": "load", "path": path, "name": exercise.name}
        if self._ask(exercise, request) is not None:
            self.found.pop(exercise.id, None)
            raise Unaccepted("error", f"{path} defines no {exercise.name}.")

    def _find(self, exercise: Exercise) -> str:
        """Return the path of the file with the answer, and note which file of the submission it is."""
        if self._worker is None:
            self._worker = self._start()
        self._serving = exercise
        if not self._opened:  # before any of the student's code runs
            self._opened = True
            match self._ask(exercise, {"do": "damaged"}):
                case [*names]:
                    told = {name for name in names if isinstance(name, str)}
                    self.damaged = told & set(self._files)
        request = {"do": "find", "chapter": exercise.chapter, "name": exercise.name}
        match self._ask(exercise, request):
            case {"path": "", "unwritten": str(unwritten)}:
                if unwritten and not self._looked:
                    self.unwritten.add(exercise.id)
                raise Unaccepted("missing", "Not attempted.")
            case {"path": str(path), "origin": str(origin)}:
                if origin in self._files and not self._looked:
                    self.found[exercise.id] = origin
                return path
        raise Unaccepted("error", "The reply does not belong to the request.")

    def _start(self) -> Worker:
        while True:
            try:
                return sandbox.start(
                    self.tier,
                    self._files,
                    self._limits,
                    python=self._python,
                    show=self._show,
                )
            except sandbox.SandboxFault:
                if not self._instead:
                    raise
                self.tier = self._instead.pop(0)

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
        self.changed, self.printed = [], ""
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
            raise Unaccepted("error", f"The reply is not an answer: {error}.") from None
        finally:
            self._left[exercise.id] = left - (time.monotonic() - start)
        # match types first, because comparing an array with == gives no truth value
        match reply:
            case {
                "id": int(number),
                "value": value,
                "changed": [*changed],
                "printed": str(printed),
                **rest,
            } if number == self._asked and not rest:
                places = range(len(request.get("args", ())))
                self.changed = [n for n in changed if type(n) is int and n in places]
                self.printed = printed[:MOST_TEXT] if self._show else ""
                return value
            case {
                "id": int(number),
                "raised": {"kind": str(kind), "message": str(message), "where": where},
                "printed": str(printed),
            } if number == self._asked:
                self.printed = printed[:MOST_TEXT] if self._show else ""
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
                f"Your code needs more memory than the limit{place}",
            )
        if kind == "FrameError":
            said = "The answer must be numbers, strings, lists, dicts or arrays"
            return Unaccepted("error", f"{said}, not {message}.")
        return Unaccepted("error", f"{kind}: {message}{place}", raised=kind)

    def _ended(self, status: int) -> Unaccepted:
        if status == -9:
            return Unaccepted(
                "memory",
                "The system stopped your code, because it used too much memory or processor time.",
            )
        if status < 0:
            return Unaccepted(
                "error",
                f"Your code crashed the process it ran in (signal {-status}).",
            )
        return Unaccepted(
            "error", f"Your code ended the process it ran in (exit code {status})."
        )


class Answer:
    """The student's function in one part of an exercise.

    Attributes
    ----------
    expected : object
        The reference's answer to the last call.
    """

    def __init__(
        self, calls: Calls, evidence: Evidence, exercise: Exercise, part: str
    ) -> None:
        self._calls, self._evidence, self._exercise = calls, evidence, exercise
        self._cases = (Case(exercise, part, number) for number in itertools.count())
        self._case: Case
        self._got: Any = None
        self.expected: Any = None

    def agrees(self, *arguments: Any, at: Any = None) -> Any:
        """Call the function, compare its answer with the reference's, and return it for further checks.

        With ``at``, an index into the answer, only these places count.
        """
        self._call(arguments, at)
        if problem := compare.difference(self._got, self.expected):
            raise self._wrong(problem, self._rows(problem))
        self._evidence.judge("right")
        return self._got

    def array(self, *arguments: Any, shape: tuple[int, ...]) -> np.ndarray:
        """Call the function and return its answer as an array of finite floats of this shape."""
        self._call(arguments)
        self._evidence.leave_free()
        array = compare.as_numbers(self._got)
        if array is None or array.shape != shape:
            raise self._wrong(
                f"expected {compare.kind(np.zeros(shape))}, got {compare.kind(self._got)}"
            )
        if not np.isfinite(array).all():
            raise self._wrong("the answer holds NaN or infinity")
        return array.astype(float)

    def ask(self, *arguments: Any) -> Any:
        """Call the function and return its answer as it came. There is no single right answer to this call."""
        self._case = replace(next(self._cases), arguments=arguments)
        self._got = self._called_with(arguments, None, None)
        self._evidence.observe(self._case, self._got, None, "asked")
        return self._got

    def check(self, holds: bool, otherwise: str, hint: str | None = None) -> None:
        """Require a property of the last answer.

        ``otherwise`` tells the student what is wrong if it does not hold, and ``hint`` what may be the reason if the
        answer is not that of a known mistake.
        """
        if not holds:
            self._evidence.advise(hint)
            raise self._wrong(otherwise)

    def _call(self, arguments: tuple[Any, ...], at: Any = None) -> None:
        self._case = replace(next(self._cases), arguments=arguments)
        self.expected = self._evidence.reference.expected(self._case)
        self._got = self._called_with(arguments, self.expected, at)
        self._evidence.observe(self._case, self._got, self.expected, at=at)
        if at is not None:
            self._got = compare.only(self._got, self.expected, at)
        if self._calls.changed and not self._evidence.changed:
            self._evidence.changed = True
            raise self._wrong(self._changing())

    def _called_with(self, arguments: tuple[Any, ...], expected: Any, at: Any) -> Any:
        try:
            return self._calls.call(self._exercise, arguments)
        except Unaccepted as error:
            if error.state != "missing":
                got = {"raised": error.raised}
                self._evidence.observe(self._case, got, expected, "wrong", at)
            if error.raised is not None:
                error.feedback = self._told(error.feedback, self._called())
            raise

    def _changing(self) -> str:
        """Describe which arguments the last call changed."""
        names = self._evidence.names
        which = " and ".join(
            names[n] if n < len(names) else f"argument {n}"
            for n in self._calls.changed[: len(self._case.arguments)]
        )
        return f"your function changes {which} in place; it must work on a copy"

    def _wrong(self, problem: str, rows: str = "") -> Unaccepted:
        self._evidence.judge("wrong")
        found = f"{problem[0].upper()}{problem[1:]}."
        return Unaccepted(
            "wrong", self._told(self._called(), found, *rows.splitlines())
        )

    def _rows(self, problem: str) -> str:
        """Show the arguments' rows that belong to the first wrong row of an answer of many rows."""
        if problem.startswith("expected an array"):
            return self._beginnings()
        place = re.match(r"at \[(\d+)", problem)
        rows = len(self.expected) if place else 0
        if place is None or rows < ROWS:
            return ""
        shown = [
            f"{name}{compare.row(argument, int(place[1]))}"
            for name, argument in zip(
                self._evidence.names, self._case.arguments, strict=False
            )
            if isinstance(argument, np.ndarray) and argument.shape[:1] == (rows,)
        ]
        return f"There: {', '.join(shown)}." if shown else ""

    def _beginnings(self) -> str:
        """Show how the rows begin where there are too many or too few of them."""
        tables = [compare.as_numbers(value) for value in (self.expected, self._got)]
        if any(
            table is None or table.ndim != 2 or not 0 < len(table) <= MOST_ROWS
            for table in tables
        ):
            return ""
        right, own = (
            ", ".join(f"{row[0]:zg}" for row in table.tolist())
            for table in tables
            if table is not None
        )
        return f"The rows begin with {right}; yours begin with {own}."

    def _called(self) -> str:
        return compare.call(self._exercise.name, self._case.arguments)

    def _told(self, *lines: str) -> str:
        """Return the lines, with what the call printed below."""
        printed = [f"Printed: {line}" for line in self._calls.printed.splitlines()]
        return "\n".join([*lines, *printed])
