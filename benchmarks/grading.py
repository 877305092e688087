"""How long a class takes: students who answer every exercise rightly, otherwise, wrongly or not at all, graded in full.

    python benchmarks/grading.py --students 300 --jobs 2

Prints seconds by the clock and of processor time, and from the latter what a course of 100,000 would need.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import random
import resource
import tempfile
import time
from contextlib import suppress
from pathlib import Path

from robonav import progress
from robonav.grading import sandbox_check
from robonav.grading.classroom import GradingConfig, grade_class
from robonav.grading.course import Course, Exercise
from robonav.grading.notebook import STUB
from robonav.grading.reference import mistakes

HOSTILE = "def {name}(*arguments):\n    while True:\n        pass\n"


def answer(
    course: Course, exercise: Exercise, chance: random.Random, hostile: float
) -> str:
    """A student's file: 55 % right, 15 % right in another way, 20 % a known mistake, 10 % not begun; or hostile."""
    draw = chance.random()
    if chance.random() < hostile:
        return HOSTILE.format(name=exercise.name)
    if draw < 0.55:
        return (course.solutions / exercise.file).read_text("utf-8")
    if draw < 0.7:
        return (course.solutions / "otherwise" / exercise.file).read_text("utf-8")
    if draw < 0.9:
        wrong = chance.choice(sorted(mistakes(course, exercise)))
        return (course.solutions / "wrong" / exercise.file).read_text(
            "utf-8"
        ) + f"\n\n{exercise.name} = {wrong}\n"
    return f"def {exercise.name}(*arguments):\n    {STUB.format(name=exercise.name)}\n"


def a_class(course: Course, folder: Path, students: int, hostile: float) -> None:
    chance = random.Random(2015)
    for number in range(students):
        for exercise in course.exercises.values():
            path = folder / f"student{number:06}" / exercise.file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(answer(course, exercise, chance, hostile), "utf-8")


def adopt_orphans() -> None:
    """A sandbox that is killed leaves its time to nobody; as its nearest reaper this process inherits it (Linux)."""
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER


def processor_seconds() -> float:
    """Of this process and of all its descendants that have ended."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    usages = (
        resource.getrusage(who)
        for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--students", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument(
        "--hostile", type=float, default=0.0, help="share of answers that never end"
    )
    chosen = parser.parse_args()
    course = Course.around(Path(__file__).parent)
    adopt_orphans()
    with tempfile.TemporaryDirectory() as folder:
        a_class(course, Path(folder, "class"), chosen.students, chosen.hostile)
        config = GradingConfig(course, sandbox_check.best())
        clock, processor = time.monotonic(), processor_seconds()
        with progress.bar("grading") as shown:
            grade_class(
                config,
                Path(folder, "class"),
                Path(folder, "out"),
                jobs=chosen.jobs,
                progress=shown,
            )
        clock = time.monotonic() - clock
    from joblib.externals.loky import get_reusable_executor

    get_reusable_executor().shutdown(
        wait=True
    )  # only the dead have told how long they worked
    processor = processor_seconds() - processor
    each = processor / chosen.students
    print(
        f"{chosen.students} submissions, {len(course.exercises)} exercises, {config.tier} sandbox, {chosen.jobs} jobs"
    )
    print(
        f"{clock:.0f} s by the clock, {processor:.0f} s of processor time, {each:.2f} s a submission"
    )
    print(
        f"100,000 submissions: {each * 100_000 / 3600:.0f} hours of one core, {each * 100_000 / 3600 / 64:.1f} of 64"
    )


if __name__ == "__main__":
    main()
