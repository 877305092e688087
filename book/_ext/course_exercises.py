"""The exercises: the directives ``{course-exercises}`` and ``{exercises}``.

``{course-exercises} ch2`` shows all exercises of a chapter. ``{exercises}`` lists the exercises that belong to the page
it stands on, or to the page that it names, with difficulty and time; each entry is a link. The manifest
``tests/exercises/manifest.toml`` says which page an exercise belongs to. ``{open-tasks}`` is a table of what each part
of the open tasks asks for, and of how often right answers pass.

``make book EXERCISES=DIR`` shows the variant of the exercises in that folder instead of the book's.

Each exercise shows its question and the file that students fill in, from ``exercises/``. The instructors' build,
``make book SOLUTIONS=1``, also has its solution and the known mistakes with their hints in a folded section. No other
build contains them.
"""

from __future__ import annotations

import inspect
import os

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robonav.grading.build import code, how_fair, question
from robonav.grading.cases import parts_of
from robonav.grading.course import Course, Exercise
from robonav.grading.reference import mistakes


class CourseExercises(SphinxDirective):
    """The directive ``{course-exercises}``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        course = Course.of_book()
        chosen = [
            exercise
            for exercise in course.exercises.values()
            if exercise.chapter == self.arguments[0]
        ]
        if not chosen and course != Course.around():
            return self.parse_text_to_nodes(
                "This term has no exercise of this chapter."
            )
        if not chosen:
            raise self.error(f"no chapter {self.arguments[0]} in the manifest")
        self.env.note_dependency(str(course.tests / "manifest.toml"))
        text = "\n".join(self._exercise(course, exercise) for exercise in chosen)
        return self.parse_text_to_nodes(text, allow_section_headings=True)

    def _exercise(self, course: Course, exercise: Exercise) -> str:
        """Return one exercise in MyST Markdown."""
        stub = course.stubs / exercise.file
        self.env.note_dependency(str(stub))
        key = f"exercise-{exercise.id.replace('.', '-')}"
        about = (
            f"{exercise.difficulty}, about {exercise.minutes} minutes, {exercise.points} points; "
            f"belongs to the page {{doc}}`{exercise.page}`"
        )
        source = stub.read_text("utf-8")
        fair = f"\n\n{how_fair(exercise)}" if exercise.draws else ""
        asked = f"*{about[0].upper()}{about[1:]}.*\n\n{question(source)}{fair}"
        parts = [
            f"({key})=\n## {exercise.id} {exercise.title}",
            f"`````{{exercise}} {exercise.id}\n:label: {key}-question\n:nonumber:\n\n{asked}\n`````",
            f"````{{code-block}} python\n:caption: exercises/{exercise.file}\n\n{code(source)}````",
        ]
        if self.config.course_solutions:
            parts.append(self._solution(course, exercise))
        return "\n\n".join(parts) + "\n"

    def _solution(self, course: Course, exercise: Exercise) -> str:
        for path in (
            course.solutions / exercise.file,
            course.solutions / "wrong" / exercise.file,
        ):
            self.env.note_dependency(str(path))
        lines = [
            line
            for line in code(
                (course.solutions / exercise.file).read_text("utf-8")
            ).splitlines()
            if "### " not in line
        ]
        hints = [
            f"- `{name}`: {' '.join((inspect.getdoc(function) or '').split())}"
            for name, function in mistakes(course, exercise).items()
        ]
        solved = "````{code-block} python\n" + "\n".join(lines) + "\n````"
        return (
            f"`````{{dropdown}} Solution, for instructors\n{solved}\n\nKnown mistakes:\n\n"
            + "\n".join(hints)
            + "\n`````"
        )


def exercises_of(course: Course, page: str) -> str:
    """Return the list of the exercises that belong to a page, in MyST Markdown; empty if there is none.

    In a variant of the course, which may leave exercises out, a sentence says so.
    """
    listed = "\n".join(
        f"- {{ref}}`{exercise.id} {exercise.title} <exercise-{exercise.id.replace('.', '-')}>`: "
        f"{exercise.difficulty}, about {exercise.minutes} minutes"
        for exercise in course.exercises.values()
        if exercise.page == page
    )
    if not listed and course != Course.around() and exercises_of(Course.around(), page):
        return "No exercise of this term belongs to this page."
    return listed


class PageExercises(SphinxDirective):
    """The directive ``{exercises}``: a list of the exercises that belong to a page."""

    optional_arguments = 1

    def run(self) -> list[nodes.Node]:
        course = Course.of_book()
        here = self.env.docname.rpartition("/")[2]
        page = self.arguments[0] if self.arguments else here
        self.env.note_dependency(str(course.tests / "manifest.toml"))
        listed = exercises_of(course, page)
        if not listed:
            raise self.error(f"no exercise in the manifest belongs to the page {page}")
        return self.parse_text_to_nodes(listed)


def open_tasks(course: Course) -> str:
    """Return a table of the open tasks in MyST Markdown."""
    lines = [
        "| open task | the parts, and their points | right answers that passed all parts | all calls took at most |",
        "|---|---|---|---|",
    ]
    for exercise in course.exercises.values():
        if not exercise.draws:
            continue
        link = f"{{ref}}`{exercise.id} {exercise.title} <exercise-{exercise.id.replace('.', '-')}>`"
        parts = "<br>".join(
            f"{(test.__doc__ or '').strip().splitlines()[0]} ({points})"
            for test, points in parts_of(course, exercise)
        )
        passed = ", ".join(f"{one} of {exercise.draws}" for one in exercise.passed)
        lines.append(
            f"| {link} | {parts} | {passed} | {max(0.1, exercise.seconds[1]):.1f} s |"
        )
    return "\n".join(lines) + "\n"


class OpenTasks(SphinxDirective):
    """The directive ``{open-tasks}``."""

    def run(self) -> list[nodes.Node]:
        course = Course.of_book()
        self.env.note_dependency(str(course.tests / "manifest.toml"))
        for chapter, _ in course.chapters():
            self.env.note_dependency(str(course.tests / f"test_{chapter}.py"))
        return self.parse_text_to_nodes(open_tasks(course))


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_config_value("course_solutions", os.environ.get("SOLUTIONS") == "1", "env")
    app.add_directive("course-exercises", CourseExercises)
    app.add_directive("exercises", PageExercises)
    app.add_directive("open-tasks", OpenTasks)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
