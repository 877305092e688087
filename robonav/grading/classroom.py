"""Grade a class: many submissions, several at a time.

``OUT/students/NAME/`` holds a student's grade, feedback page, Gradescope's ``results.json`` and JUnit XML. ``OUT``
itself holds the gradebook and an overview. A student counts as graded when all of the student's files are written, so
an interrupted run can be started again. The new run keeps the existing grades, unless the submission or the tests
changed or the grader failed.
"""

from __future__ import annotations

import hashlib
import importlib.util
import json
import platform
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from filelock import FileLock, Timeout

from robonav import atomic
from robonav._version import __version__
from robonav.processes import in_processes
from robonav.progress import Progress

from . import ledger, paths, report
from .cases import PUBLIC, seed_of, stretched
from .check import graded, remarks, with_public_feedback
from .course import Course, trusted
from .evidence import Evidence
from .grade import fault_grade, grade
from .layouts import Handin, handed_in, on_times, passed_over
from .reference import reference
from .roster import fitting, match, read_roster
from .rules import Rules, read_rules
from .session import Session
from .submission import Refused, Submission
from .variants import EachStudent


@dataclass(frozen=True)
class GradingConfig:
    """How the submissions of a whole class are graded."""

    course: Course
    tier: str
    secret: bytes = b""
    each: EachStudent | None = None  # if each student has exercises of their own

    def of(self, student: str) -> GradingConfig:
        """Return the configuration for a student."""
        if self.each is None:
            return self
        return replace(self, course=self.each.of(student))

    def key(self) -> str:
        """Return a hash of everything that a grade depends on, except the submission."""
        digest = hashlib.sha256(self.secret_hash().encode() + self.tier.encode())
        for folder, pattern in (
            (self.course.tests, "*"),
            (self.course.solutions, "**/*.py"),
            (Path(__file__).parent, "*.py"),
        ):
            for path in sorted(folder.glob(pattern)):
                if path.is_file():
                    digest.update(path.name.encode() + path.read_bytes())
        digest.update(self.each.key().encode() if self.each else b"")
        return digest.hexdigest()

    def secret_hash(self) -> str:
        """Return a hash that tells two secrets apart, or an empty string without a secret.

        No key of the cases follows from it, and it is slow to find the secret by trying words.
        """
        key = stretched(self.secret)
        return hashlib.sha256(b"class/" + key).hexdigest() if self.secret else ""


def grade_submission(
    config: GradingConfig, loaded: Submission | Refused, ids: Collection[str] = ()
) -> dict[str, Any]:
    """Grade one submission, or only the exercises ``ids``, as ``pytest tests/exercises`` does."""
    course = config.course
    exercises = [
        exercise
        for exercise in course.exercises.values()
        if not ids or exercise.id in ids
    ]
    session, known = Session(loaded, config.tier), reference(course)
    seed, began = seed_of(config.secret, _digest(loaded)), ledger.now()
    evidence = {e.id: Evidence(known, course.parameters(e)) for e in exercises}
    try:
        if config.secret:
            session.look(exercises)
        entries = [
            graded(
                course,
                exercise,
                session,
                known,
                seed=seed,
                evidence=evidence[exercise.id],
            )
            for exercise in exercises
        ]
        session.close()
        if config.secret:
            entries = with_public_feedback(course, entries, loaded, config.tier)
        result = grade(entries, config.tier)
    except Exception:  # an error in the grader is not the student's fault
        result = fault_grade(exercises, config.tier)
    finally:
        session.close()
    result |= remarks(loaded, session)
    return result | {"run": _run(result, loaded, seed, began, evidence)}


def students(folder: Path) -> dict[str, Handin]:
    """Return what each student handed in, by name.

    Raises
    ------
    ValueError
        If there is no submission.
    """
    if not folder.is_dir():
        raise ValueError(
            f"the class must be a folder of submissions, got {folder}"
            + (": unpack it first" if folder.is_file() else "")
        )
    found = handed_in(folder)
    if not found:
        raise ValueError(f"no folder, zip or notebook in {folder}")
    return found


def grade_class(
    config: GradingConfig,
    folder: Path,
    out: Path,
    *,
    again: Collection[str] = (),
    ids: Collection[str] = (),
    jobs: int = -1,
    scheduler: str | None = None,
    progress: Progress | None = None,
    new_secret: bool = False,
    roster: Path | None = None,
) -> list[str]:
    """Grade every submission in ``folder`` that is not graded yet, and write all reports to ``out``.

    Parameters
    ----------
    config : GradingConfig
        The course, the sandbox tier and the secret.
    folder : Path
        The class: one folder, zip file or notebook per student.
    out : Path
        The folder for the reports.
    again : collection of str
        Students to grade again, even if they have a grade.
    ids : collection of str
        Exercises to grade again, for the students in ``again`` or else for all. Other exercises keep their grades.
    jobs : int
        Number of submissions to grade at the same time; -1 means one per processor.
    scheduler : str, optional
        Address of a Dask scheduler. Its workers must see this course at the same path.
    progress : Progress, optional
        Called as ``progress(done, total)``.
    new_secret : bool
        Whether a class that was graded with another secret is graded again with this one.
    roster : Path, optional
        The roster, which may tell when submissions were handed in.

    Returns
    -------
    list of str
        The students who must be graded again, because the grader failed.

    Raises
    ------
    ValueError
        If the class, a student's name, the secret or the folder for the reports is not right.
    """
    if out.resolve().is_relative_to(folder.resolve()):
        raise ValueError(
            f"out must not lie in the class folder, where it would be a student, got {out}"
        )
    if importlib.util.find_spec("IPython") is None:
        raise ValueError("notebooks are read with IPython: pip install ipython")
    submissions = students(folder)
    for name in set(again) - set(submissions):
        raise ValueError(f"no submission of {name} in {folder}")
    _check_course(config.course, folder)
    known = _with_time(submissions, roster, read_rules(out, config.course))
    with paths.without_submissions(folder), _locked(out):
        atomic.remove_partial_files(out)
        _remember(out, config, new_secret)
        tasks = _to_grade(config, submissions, out, again, ids)
        records = _marked(config, folder, tasks, jobs, scheduler)
        for done, record in enumerate(records, start=1):
            # First the log, so that there is no grade of which it knows nothing.
            ledger.append(out, "graded", _logged(record))
            report.write_student(
                out / "students" / record["student"], record, config.course
            )
            if progress is not None:
                progress(done, len(tasks))
        _tell(out, submissions)
        return report.write_class(
            out,
            list(submissions),
            passed_over(folder),
            config.course,
            on_times(submissions, known),
        )


def _with_time(
    submissions: Mapping[str, Handin], roster: Path | None, rules: Rules
) -> set[str]:
    """Return the submissions of which the roster or the rules tell the time."""
    known = set(rules.submitted)
    if roster is None:
        return known
    students = read_roster(roster, rules.teams)
    decided = {
        name: fits[0].id if len(fits := fitting(students, word)) == 1 else word
        for name, word in rules.matches.items()
    }
    people = {name: handin.people for name, handin in submissions.items()}
    theirs = match(students, people, decided, {}).submissions
    timed = {one.id for one in students if rules.time(one.submitted) is not None}
    return known | {name for id, name in theirs.items() if id in timed}


def _to_grade(
    config: GradingConfig,
    submissions: Mapping[str, Handin],
    out: Path,
    again: Collection[str],
    ids: Collection[str],
) -> list[Task]:
    """Return the submissions that have no grade yet, and those that are to be graded again."""
    key, tasks = config.key(), []
    for name, handin in submissions.items():
        entry = {"student": name, "submission": _digest(handin.load()), "config": key}
        old = _written(out, entry)
        chosen = name in again if again else bool(ids)
        if old is None or chosen:
            tasks.append((entry, handin, old, ids if chosen and old else ()))
    return tasks


HANDED_IN = "handed-in.json"

Task = tuple[dict[str, str], Handin, dict[str, Any] | None, Collection[str]]


def _marked(
    config: GradingConfig,
    folder: Path,
    tasks: Sequence[Task],
    jobs: int,
    scheduler: str | None,
) -> Iterator[dict[str, Any]]:
    """Yield each task's record when it is done.

    Submissions are read again here, so that memory holds only those that are being graded.
    """
    calls = (
        (
            config.of(entry["student"]),
            {**entry, "submission": _digest(loaded)},
            loaded,
            old,
            ids,
        )
        for entry, handin, old, ids in tasks
        for loaded in [handin.load()]
    )
    if scheduler is None:
        yield from in_processes(_record, calls, jobs)
        return
    try:
        from distributed import Client, as_completed
    except ImportError:
        raise ValueError("a scheduler needs dask: pip install distributed") from None
    with Client(scheduler) as client:
        _check_workers(client, folder)
        at_once = 4 * sum(client.nthreads().values()) + 4
        running = as_completed(
            [
                client.submit(_record, *call, pure=False)
                for call in islice(calls, at_once)
            ]
        )
        for future in running:
            yield future.result()
            for call in islice(calls, 1):
                running.add(client.submit(_record, *call, pure=False))


def _check_course(course: Course, folder: Path) -> None:
    """Refuse tests that a student could have handed in, because they run outside the sandbox."""
    if course.root.resolve().is_relative_to(folder.resolve()):
        raise ValueError(
            f"the tests in {course.tests} lie in the folder of submissions: run this in your own checkout"
        )


def _check_workers(client: Any, folder: Path) -> None:
    """Refuse Dask workers that could import a module from a submission or from the folder they were started in."""
    for worker, entries in client.run(paths.unsafe_here, str(folder)).items():
        if entries:
            raise ValueError(
                f"the Dask worker {worker} imports modules from {entries[0] or 'its current folder'!r}: "
                "start the workers with PYTHONSAFEPATH=1, in another folder than the class"
            )


def _record(
    config: GradingConfig,
    entry: dict[str, str],
    loaded: Submission | Refused,
    old: dict[str, Any] | None,
    ids: Collection[str],
) -> dict[str, Any]:
    """Grade one student. Exercises that are not in ``ids`` keep their old entries."""
    new = grade_submission(config, loaded, ids)
    if config.each is not None:  # the next student's course is another one
        reference.cache_clear()
        trusted.cache_clear()
    if old is not None and ids:
        fresh = {graded["id"]: graded for graded in new["exercises"]}
        entries = [fresh.get(kept["id"], kept) for kept in old["exercises"]]
        said = {name: old[name] for name in ("notes", "problems") if name in old}
        files = {**old.get("files", {}), **new.get("files", {})}
        new = grade(entries, config.tier) | said | {"files": files}
    return {**entry, **new}


def _run(
    result: dict[str, Any],
    loaded: Submission | Refused,
    seed: bytes,
    began: str,
    evidence: dict[str, Evidence],
) -> dict[str, Any]:
    """Return what was run: files, seed, versions, and the number of calls of each part."""
    files = loaded.files if isinstance(loaded, Submission) else {}
    used = set(result["files"].values())
    return {
        "began": began,
        "seed": "public" if seed == PUBLIC else seed.hex(),
        "versions": {
            "python": platform.python_version(),
            "numpy": np.__version__,
            "robonav": __version__,
        },
        "files": {
            name: hashlib.sha256(content).hexdigest()
            for name, content in files.items()
            if name in used
        },
        "calls": {
            id: dict(Counter(call.case.part for call in seen.observations))
            for id, seen in evidence.items()
        },
    }


def _logged(record: dict[str, Any]) -> dict[str, Any]:
    """Take the description of the run out of a record, and return it with the results for the log."""
    run = record.pop("run", {})
    kept = ("student", "submission", "config", "tier", "points", "max_points")
    entries = [
        {
            "id": entry["id"],
            "points": entry["points"],
            "state": entry["state"],
            "parts": entry.get("parts", []) if entry["state"] != "missing" else [],
        }
        for entry in record["exercises"]
        if not run or entry["id"] in run["calls"]
    ]
    where = record.get("files", {})
    return (
        {name: record[name] for name in kept}
        | {"exercises": entries, "where": where}
        | run
    )


def _tell(out: Path, submissions: dict[str, Handin]) -> None:
    """Write down whose submissions these are and when they were handed in, for the gradebook."""
    told = {name: handin.told() for name, handin in submissions.items()}
    # JSON's escapes also hold names that are not valid text.
    atomic.write_text(out / HANDED_IN, json.dumps(told, indent=1))


def _digest(loaded: Submission | Refused) -> str:
    return loaded.digest if isinstance(loaded, Submission) else f"refused: {loaded}"


def _written(out: Path, entry: dict[str, str]) -> dict[str, Any] | None:
    """Return the grade on disk if it is complete and belongs to this submission and configuration."""
    try:
        record = json.loads(
            (out / "students" / entry["student"] / "grade.json").read_bytes()
        )
    except (OSError, ValueError):
        return None
    same = all(record.get(name) == value for name, value in entry.items())
    return (
        record
        if same
        and all(graded["state"] != "grader-fault" for graded in record["exercises"])
        else None
    )


def _remember(out: Path, config: GradingConfig, new_secret: bool) -> None:
    """Write down which secret a class is graded with. Another one is refused, unless it is meant."""
    path = out / "class.json"
    try:
        before = json.loads(path.read_bytes())["secret"]
    except (OSError, ValueError, KeyError, TypeError):
        before = config.secret_hash()
    if before != config.secret_hash() and not new_secret:
        raise ValueError(
            f"{out} was graded {'with another' if before else 'without a'} secret; "
            "give that one, or grade everybody again with --new-secret"
        )
    atomic.write_text(path, json.dumps({"secret": config.secret_hash()}))


@contextmanager
def _locked(out: Path) -> Iterator[None]:
    """Keep a second run out of the same folder; the system releases the lock of a run that died.

    Raises
    ------
    ValueError
        If another run uses the folder, or it cannot be written to.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        with FileLock(out / ".lock", timeout=0):
            yield
    except Timeout:
        raise ValueError(f"another run is grading into {out}") from None
    except OSError as error:
        raise ValueError(
            f"cannot write to {out}: {error.strerror or error}. What is graded is kept; run the command again."
        ) from error
