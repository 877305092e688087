"""The directives ``{syllabus}`` and ``{goals}``: courses with this book, and who practises which goal.

``{syllabus} weeks`` shows a course of ``book/syllabus.toml``, session by session. ``{goals}`` shows the learning goals
of each page with the drills and exercises that practise them, from ``book/goals.toml``. Titles of drills come from the
package, those and the minutes of exercises from their manifest, and goals from the top of each page.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from check_site import ROOT
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from robonav.drills import DRILLS, Choice, Drill
from robonav.grading.course import Course, Exercise

BOOK = ROOT / "book"
GOALS, COURSES = BOOK / "goals.toml", BOOK / "syllabus.toml"
EXAM = 2026  # the seed of the example questions
SHORT, LONG = 45, 90  # minutes of a deck
GOAL = re.compile(r"^- (.+)$", re.MULTILINE)


@dataclass(frozen=True)
class Goal:
    """A learning goal of a page, and what practises it."""

    page: str
    id: str
    text: str
    drills: list[str] = field(default_factory=list)
    exercises: list[str] = field(default_factory=list)


def goals_on(page: str) -> list[str]:
    """Return the goals at the top of a page, after "you can", as Markdown."""
    top = (BOOK / f"{page}.md").read_text("utf-8").partition("\n## ")[0]
    listed = re.search(r"(?:you can|be able to)\n\n((?:- .+\n)+)", top)
    return [goal.rstrip(";.") for goal in GOAL.findall(listed[1])] if listed else []


def goals() -> list[Goal]:
    """Return all goals of ``goals.toml``, in its order, with their full texts."""
    table: dict[str, dict[str, Any]] = tomllib.loads(GOALS.read_text("utf-8"))
    return [
        Goal(
            page,
            name,
            _full_text(page, entry["goal"]),
            entry.get("drills", []),
            entry.get("exercises", []),
        )
        for page, entries in table.items()
        for name, entry in entries.items()
    ]


def _full_text(page: str, beginning: str) -> str:
    found = [text for text in goals_on(page) if text.startswith(beginning)]
    if len(found) != 1:
        raise ValueError(
            f'{len(found)} goals of the page {page} begin with "{beginning}"; it must be one'
        )
    return found[0]


@dataclass(frozen=True)
class Session:
    """A week or a day of a course."""

    title: str
    purpose: str
    pages: list[str]
    class_drills: list[str]
    lab: list[str]
    homework: list[str]
    exam: list[str]
    exam_drills: list[str]
    written: dict[str, str] = field(default_factory=dict)
    written_in: str = ""
    lecture: list[str] = field(default_factory=list)
    long_lecture: list[str] = field(default_factory=list)
    minutes: dict[str, int] = field(default_factory=dict)  # the plan's, or its own

    @property
    def lecture_minutes(self) -> int:
        """How long the decks take."""
        return SHORT * len(self.lecture) + LONG * len(self.long_lecture)


@dataclass(frozen=True)
class Plan:
    """A course: what its sessions are called, how many minutes each part of a session takes, and the sessions."""

    unit: str
    minutes: dict[str, int]
    sessions: list[Session]

    @property
    def session_minutes(self) -> int:
        """Minutes of one session."""
        return sum(self.minutes.values())

    @property
    def total_minutes(self) -> int:
        """Minutes of all sessions."""
        return self.session_minutes * len(self.sessions)


@dataclass(frozen=True)
class Further:
    """A page with a deck that no session of the courses holds: after which page it can be taught, and what for."""

    page: str
    after: str
    purpose: str


def further() -> list[Further]:
    """Return the pages of ``syllabus.toml`` for more lectures, in its order."""
    tables = tomllib.loads(COURSES.read_text("utf-8"))
    return [Further(**table) for table in tables["further"]]


def further_text(course_plan: Plan) -> str:
    """Return the list of more lectures in MyST Markdown."""
    unit = course_plan.unit.lower()
    lines = [
        "## More lectures",
        "",
        f"These pages of chapter 6 have decks and drills, too. Take one in place of another lecture, or add a {unit}.",
        "",
        *(
            f"- {{doc}}`/book/{one.page}`, `{one.page}.html` ({SHORT} min), after {{doc}}`/book/{one.after}`. "
            f"{one.purpose}"
            for one in further()
        ),
    ]
    return "\n".join(lines) + "\n"


def plan(name: str) -> Plan:
    """Return a course of ``syllabus.toml``: "weeks" or "days"."""
    tables = tomllib.loads(COURSES.read_text("utf-8"))
    table = tables[name]
    written = {one["title"]: one["written"] for one in tables["weeks"]["session"]}
    for session in table["session"]:
        session.setdefault("minutes", table["minutes"])
        if title := session.get("written_in"):
            session["written"] = written[title]
    sessions = [Session(**session) for session in table["session"]]
    return Plan(table["unit"], table["minutes"], sessions)


def minutes_of(exercises: list[str], course: Course) -> int:
    """Return how long some exercises take, by the manifest."""
    return sum(course.exercises[name].minutes for name in exercises)


def _exercise(exercise: Exercise) -> str:
    label = f"exercise-{exercise.id.replace('.', '-')}"
    return f"{{ref}}`{exercise.id} {exercise.title} <{label}>` ({exercise.minutes} min)"


def _exercises(names: list[str], course: Course) -> str:
    return "; ".join(_exercise(course.exercises[name]) for name in names)


def _drills(names: list[str]) -> str:
    titles = (DRILLS[name].title.replace("*", r"\*") for name in names)
    return "; ".join(f"*{title}*" for title in titles)


def _example(drill: Drill) -> str:
    """Return a question of a drill, after a link to the drill on its page."""
    question, title = drill.question(EXAM), drill.title.replace("*", r"\*")
    link = f'<a href="{drill.page}.html#drill-{drill.name}">{title}</a>'
    options = ""
    if isinstance(question.asked, Choice):
        options = f" *{'; or: '.join(question.asked.options)}?*"
    return f"{link} (`{drill.name}`). {question.text}{options}"


def headline(course_plan: Plan, course: Course) -> str:
    """Return how long a course is."""
    hours = course_plan.total_minutes / 60
    home = sum(minutes_of(session.homework, course) for session in course_plan.sessions)
    parts = ", ".join(
        f"{part} {minutes}" for part, minutes in course_plan.minutes.items()
    )
    return (
        f"{len(course_plan.sessions)} {course_plan.unit.lower()}s of {course_plan.session_minutes} minutes ({parts}): "
        f"{hours:g} hours in class. The exercises for home take {home / 60:.0f} more hours."
    )


def session_text(
    number: int, session: Session, course_plan: Plan, course: Course
) -> str:
    """Return one session in MyST Markdown."""
    decks = [f"`{page}.html` ({SHORT} min)" for page in session.lecture]
    decks += [f"`{page}.html?long` ({LONG} min)" for page in session.long_lecture]
    home = "- **At home**: the drills of these pages, until they are mastered"
    if session.homework:
        home += f"; {_exercises(session.homework, course)}"
    if len(session.homework) > 1:
        home += f", together {minutes_of(session.homework, course)} minutes"
    lines = [
        f"## {course_plan.unit} {number}: {session.title}",
        "",
        session.purpose,
        "",
        "- **Pages**: " + "; ".join(f"{{doc}}`/book/{page}`" for page in session.pages),
        f"- **Lecture**, {session.minutes['lecture']} minutes, slides: "
        + ", ".join(decks),
        f"- **Drills in class**, {session.minutes['drills']} minutes: {_drills(session.class_drills)}",
        f"- **Lab**, {session.minutes['lab']} minutes: {_exercises(session.lab, course)}. The rest of the time "
        "is for the notebooks of the pages and for questions.",
        home,
        "- **An exam may ask**: " + " ".join(session.exam),
        "- **Example questions for an exam**",
        *(f"  - {_example(DRILLS[name])}" for name in session.exam_drills),
        f"  - *In writing.* {session.written['question']} *Expected:* {session.written['answer']}",
    ]
    return "\n".join(lines) + "\n"


class Syllabus(SphinxDirective):
    """The directive ``{syllabus}``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        note_sources(self)
        course, course_plan = Course.of_book(), plan(self.arguments[0])
        text = "\n".join(
            session_text(k, session, course_plan, course)
            for k, session in enumerate(course_plan.sessions, 1)
        )
        text += "\n" + further_text(course_plan)
        # by itself: MyST drops what stands before the first heading of a parsed text
        first = self.parse_text_to_nodes(headline(course_plan, course))
        return first + self.parse_text_to_nodes(text, allow_section_headings=True)


def goals_text(course: Course) -> str:
    """Return all goals with what practises them, in MyST Markdown."""
    lines: list[str] = []
    page = ""
    for goal in goals():
        if goal.page != page:
            page = goal.page
            lines += ["", f"**{{doc}}`/book/{page}`**", ""]
        parts = [f"{goal.text[0].upper()}{goal.text[1:]}."]
        if goal.drills:
            parts.append(f"Drills: {_drills(goal.drills)}")
        if goal.exercises:
            parts.append(f"Exercises: {_exercises(goal.exercises, course)}")
        lines.append("- " + "\\\n  ".join(parts))
    return "\n".join(lines) + "\n"


class Goals(SphinxDirective):
    """The directive ``{goals}``."""

    def run(self) -> list[nodes.Node]:
        note_sources(self)
        for page in {goal.page for goal in goals()}:
            self.env.note_dependency(str(BOOK / f"{page}.md"))
        return self.parse_text_to_nodes(goals_text(Course.of_book()))


def note_sources(directive: SphinxDirective) -> None:
    """Note that the page depends on the two tables, on the manifest and on the drills."""
    manifest = Course.of_book().tests / "manifest.toml"
    package = Path(ROOT, "robonav", "drills").rglob("*.py")
    for path in (GOALS, COURSES, manifest, *package):
        directive.env.note_dependency(str(path))


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("syllabus", Syllabus)
    app.add_directive("goals", Goals)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
