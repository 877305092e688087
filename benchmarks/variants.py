"""How long a variant of all exercises takes, for a term or for each student.

    python benchmarks/variants.py --students 3

Writes ``benchmarks/variants.json``: seconds of processor time for one variant. By the clock it takes as long on a core
that does nothing else.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import tempfile
from pathlib import Path

from robonav.grading.build import students_zip
from robonav.grading.course import Course
from robonav.grading.variants import EachStudent

ROOT = Path(__file__).parents[1]


def processor_seconds() -> float:
    """Of this process and of its children that have ended."""
    usages = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def seconds(course: Course, secret: str, students: int) -> list[float]:
    """Return the time for each student's variant, with the zip file of it."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        each = EachStudent(course, secret, Path(folder))
        for number in range(students):
            begin = processor_seconds()
            own = each.of(f"student{number}")
            students_zip(own, own.root / "robonav-exercises.zip")
            found.append(processor_seconds() - begin)
    return found


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--students", type=int, default=3)
    parser.add_argument("--secret", default="autumn")
    parser.add_argument("--out", type=Path, default=ROOT / "benchmarks/variants.json")
    chosen = parser.parse_args()
    course = Course(ROOT)
    found = seconds(course, chosen.secret, chosen.students)
    result = {
        "students": chosen.students,
        "exercises": len(course.exercises),
        "processor seconds": round(statistics.median(found), 1),
    }
    chosen.out.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
