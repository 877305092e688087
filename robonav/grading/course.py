"""The course: its folders, and its manifest with the id, points and file of each exercise."""

from __future__ import annotations

import ast
import importlib.util
import os
import tomllib
import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from robonav.validation import check_integer, check_one_of

DIFFICULTIES = ("warm-up", "exercise", "project", "open task")


@dataclass(frozen=True)
class Exercise:
    """One exercise. Exercise 2.1, for example, asks for the function ``name`` in ``ch2/name.py``.

    An open task measures what an answer achieves, so chance may decide. It has numbers of ``benchmarks/open_tasks.py``:

    Attributes
    ----------
    draws : int
        How often right answers were graded, each time on other cases.
    passed : tuple of int
        How often each of them passed all parts.
    seconds : tuple of float
        The longest call, and the longest time of all calls together.
    """

    id: str
    name: str
    title: str
    points: int
    difficulty: str
    minutes: int
    page: str
    draws: int = 0
    passed: tuple[int, ...] = ()
    seconds: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        check_integer(f"points of exercise {self.id}", self.points, at_least=1)
        check_integer(f"minutes of exercise {self.id}", self.minutes, at_least=1)
        check_one_of(f"difficulty of exercise {self.id}", self.difficulty, DIFFICULTIES)

    @property
    def chapter(self) -> str:
        """``ch2`` for exercise 2.1."""
        return f"ch{self.id.partition('.')[0]}"

    @property
    def file(self) -> str:
        """The file of a submission that contains the answer."""
        return f"{self.chapter}/{self.name}.py"

    @property
    def fairness(self) -> str:
        """How often right answers pass an open task, in a sentence, or an empty string.

        Examples
        --------
        >>> Exercise("2.9", "steer", "Drive", 8, "open task", 60, "robot", 50, (50, 49)).fairness
        'Two right answers were tried on 50 draws of the cases: they passed all parts 50 and 49 times.'
        """
        if not self.draws:
            return ""
        passed = f"{' and '.join(map(str, self.passed))} times"
        if set(self.passed) == {self.draws}:
            passed = "every time"
        return f"Two right answers were tried on {self.draws} draws of the cases: they passed all parts {passed}."


@dataclass(frozen=True)
class Course:
    """The folders of a checkout. The students' copy has no ``solutions``."""

    root: Path

    @classmethod
    def around(cls, *starts: Path) -> Course:
        """Return the course that contains one of these folders, or else the checkout of this package."""
        for start in (*starts, Path(__file__).parent):
            for folder in (start.resolve(), *start.resolve().parents):
                if (folder / "tests/exercises/manifest.toml").is_file():
                    return cls(folder)
        raise ValueError(
            "no exercises found: run this in the folder that contains tests/exercises"
        )

    @classmethod
    def of_checkout(cls) -> Course:
        """Return the course of the checkout. The current folder counts only if the package stands in none."""
        return cls.around(Path(__file__).parent, Path.cwd())

    @classmethod
    def of_book(cls) -> Course:
        """Return the course that the book shows: a variant in the folder EXERCISES, or the checkout's own."""
        folder = os.environ.get("EXERCISES")
        if folder and not (Path(folder) / "tests/exercises/manifest.toml").is_file():
            raise ValueError(
                f"EXERCISES must name a folder that robonav exercises build wrote, got {folder}"
            )
        return cls(Path(folder).resolve()) if folder else cls.around()

    @property
    def tests(self) -> Path:
        return self.root / "tests/exercises"

    @property
    def solutions(self) -> Path:
        return self.root / "solutions"

    @property
    def stubs(self) -> Path:
        return self.root / "exercises"

    @property
    def recorded(self) -> Path:
        return self.tests / "recorded"

    @cached_property
    def exercises(self) -> Mapping[str, Exercise]:
        """All exercises by id, in the manifest's order."""
        with (self.tests / "manifest.toml").open("rb") as file:
            listed = [_exercise(entry) for entry in tomllib.load(file)["exercise"]]
        found = {exercise.id: exercise for exercise in listed}
        if len(found) < len(listed) or len(
            {exercise.name for exercise in listed}
        ) < len(listed):
            raise ValueError(
                "every exercise in the manifest must have an id and a name of its own"
            )
        return found

    def chapters(self) -> Iterator[tuple[str, list[Exercise]]]:
        """Yield each chapter with its exercises."""
        for chapter in sorted(
            {exercise.chapter for exercise in self.exercises.values()}
        ):
            yield (
                chapter,
                [
                    exercise
                    for exercise in self.exercises.values()
                    if exercise.chapter == chapter
                ],
            )

    def named(self, key: str) -> Exercise:
        """Return the exercise with this id or name."""
        for exercise in self.exercises.values():
            if key in (exercise.id, exercise.name):
                return exercise
        raise ValueError(f"no exercise {key!r}: there are {', '.join(self.exercises)}")

    def selected(self, key: str) -> list[Exercise]:
        """Return the exercises of a chapter, such as ``2``, or the exercise with this id or name."""
        for chapter, exercises in self.chapters():
            if key in (chapter, chapter.removeprefix("ch")):
                return exercises
        return [self.named(key)]

    def parameters(self, exercise: Exercise) -> list[str]:
        """Return the names of the arguments, or an empty list if the students' file does not tell them."""
        try:
            tree = ast.parse((self.stubs / exercise.file).read_bytes())
        except (OSError, ValueError, SyntaxError):
            return []
        for node in tree.body:
            if isinstance(node, ast.FunctionDef) and node.name == exercise.name:
                return [argument.arg for argument in node.args.args]
        return []


def _exercise(entry: Mapping[str, Any]) -> Exercise:
    """Return the exercise of an entry in the manifest, with tuples instead of lists."""
    values: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value
        for key, value in entry.items()
    }
    return Exercise(**values)


@cache
def trusted(path: Path) -> types.ModuleType:
    """Import one of the course's own files: a solution, or a chapter's tests."""
    spec = importlib.util.spec_from_file_location(
        f"robonav_course_{path.parent.name}_{path.stem}", path
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
