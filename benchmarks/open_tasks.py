"""How fair the open tasks are: how often right answers pass, each time on other cases, and how long they take.

    python benchmarks/open_tasks.py --draws 100 --jobs 2

Two right answers to each open task, its solution and another one, are graded with many draws of the cases, as those of
as many submissions. The script writes how often each passed each part to ``benchmarks/open_tasks.json``. It prints what
``tests/exercises/manifest.toml`` repeats, and what stubs, notebooks and pages tell students.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from joblib import Parallel, delayed

from robonav.grading.cases import generator, parts_of, seed_of
from robonav.grading.check import InProcessCalls
from robonav.grading.course import Course, Exercise, trusted
from robonav.grading.evidence import Evidence
from robonav.grading.grade import Unaccepted
from robonav.grading.reference import reference, solution
from robonav.grading.session import Answer

TARGET = Path(__file__).with_suffix(".json")
COURSE = Course.around(Path(__file__).parent)


class TimedCalls(InProcessCalls):
    """Calls in this process that note how much processor time each took."""

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        self.seconds: list[float] = []

    def call(self, exercise: Exercise, arguments: Sequence[Any]) -> Any:
        start = time.process_time()
        try:
            return super().call(exercise, arguments)
        finally:
            self.seconds.append(time.process_time() - start)


def answers(exercise: Exercise) -> dict[str, Any]:
    """Return the right answers to an exercise, by where they stand."""
    other = trusted(COURSE.solutions / "otherwise" / exercise.file)
    return {
        "solutions": solution(COURSE, exercise),
        "solutions/otherwise": getattr(other, exercise.name),
    }


def graded_once(id: str, where: str, number: int) -> dict[str, Any]:
    """Return which parts an answer passes in one draw of the cases, and the seconds of its longest and of all calls."""
    exercise = COURSE.exercises[id]
    calls = TimedCalls(answers(exercise)[where])
    seed = seed_of(b"fairness of the open tasks", f"submission {number}")
    passed = {}
    for test, _ in parts_of(COURSE, exercise):
        evidence = Evidence(reference(COURSE), COURSE.parameters(exercise))
        try:
            with np.errstate(all="ignore"):
                test(
                    Answer(calls, evidence, exercise, test.__name__),
                    generator(seed, test.__name__),
                )
            passed[test.__name__] = True
        except Unaccepted:
            passed[test.__name__] = False
    return {"passed": passed, "seconds": (max(calls.seconds), sum(calls.seconds))}


def measured(exercise: Exercise, draws: int, jobs: int) -> dict[str, Any]:
    """Return how often each right answer passes each part and all of them, and the longest times."""
    found: dict[str, Any] = {"draws": draws}
    longest = np.zeros(2)
    for where in answers(exercise):
        runs = Parallel(n_jobs=jobs)(
            delayed(graded_once)(exercise.id, where, number) for number in range(draws)
        )
        parts = {
            name: sum(run["passed"][name] for run in runs) for name in runs[0]["passed"]
        }
        passed = sum(all(run["passed"].values()) for run in runs)
        longest = np.maximum(longest, [run["seconds"] for run in runs]).max(axis=0)
        found[where] = {"all parts": passed, "parts": parts}
    return found | {"seconds": [round(float(one), 2) for one in longest]}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--draws", type=int, default=100)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", action="append", help="an id; may be repeated")
    chosen = parser.parse_args()
    results = json.loads(TARGET.read_text("utf-8")) if TARGET.exists() else {}
    for exercise in COURSE.exercises.values():
        if exercise.difficulty != "open task":
            continue
        if chosen.only and exercise.id not in chosen.only:
            continue
        found = results[exercise.id] = measured(exercise, chosen.draws, chosen.jobs)
        TARGET.write_text(json.dumps(results, indent=1) + "\n", "utf-8")
        passed = [found[where]["all parts"] for where in answers(exercise)]
        print(f"{exercise.id} {exercise.title}")
        for where in answers(exercise):
            print(f"  {where}: {found[where]['parts']}")
        print(f"  draws = {chosen.draws}\n  passed = {passed}")
        print(f"  seconds = {found['seconds']}", flush=True)


if __name__ == "__main__":
    main()
