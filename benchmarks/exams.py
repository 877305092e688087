"""How long the exams of a class take: 200 different papers of 10 and 20 questions, with their solutions.

python benchmarks/exams.py
"""

from __future__ import annotations

import argparse
import time

from robonav.drills.export import (
    Paper,
    drawn,
    exam_pdf,
    selected,
    solutions_pdf,
    spread,
)

PAPERS = 200


def seconds(questions: int, papers: int) -> dict[str, float]:
    """Time of each part, of this process alone."""
    drills = spread(selected(), questions)
    times, began = {}, time.process_time()
    made = [Paper(seed, drawn(drills, seed)) for seed in range(1, papers + 1)]
    for part, write in (
        ("questions", None),
        ("papers", exam_pdf),
        ("solutions", solutions_pdf),
    ):
        if write:
            write(made)
        times[part], began = time.process_time() - began, time.process_time()
    return times


def main() -> None:
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    first = sum(seconds(10, 1).values())
    print(f"the first paper: {first:.1f} s")
    for questions in (10, 20):
        times = seconds(questions, PAPERS)
        parts = ", ".join(f"{part} {time:.1f} s" for part, time in times.items())
        print(f"{PAPERS} papers of {questions}: {sum(times.values()):.1f} s ({parts})")


if __name__ == "__main__":
    main()
