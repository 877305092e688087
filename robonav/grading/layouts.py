"""Whose submission each file in a class is, by the names that learning platforms give to what they export.

=============== ======================================================================================
Canvas          ``lovelaceada_LATE_123_456_improve-2.py``
Moodle          ``Ada Lovelace_123_assignsubmission_file_/``, or flat, the name of the file at its end
Blackboard      ``Exercises 2_ada_attempt_2024-05-01-10-30-00_improve.py``
Gradescope      ``submission_123/`` beside ``submission_metadata.yml``, which has the names
anything else   a folder, archive, notebook or Python file with the student's name
=============== ======================================================================================

Blackboard's names and Gradescope's list have the time of each submission. Canvas's names only say which ones are late,
and the other names say nothing about time.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from robonav.counting import counted

from . import submission
from .submission import Refused, Submission

CANVAS = "Canvas"
LAYOUTS = {
    CANVAS: re.compile(
        r"(?P<student>[^_]+)(?P<late>_LATE)?_(?P<user>\d+)_\d+_(?P<file>.+)"
    ),
    "Moodle": re.compile(
        r"(?P<student>.+)_(?P<user>\d+)_assignsubmission_(file|onlinetext)(_(?P<file>.*))?"
    ),
    "Blackboard": re.compile(
        r".+_(?P<student>[^_]+)_attempt_(?P<date>\d{4}(-\d\d)+)(_(?P<file>.+)|(?P<receipt>\.txt))"
    ),
    "Gradescope": re.compile(r"submission_(?P<user>\d+)"),
}
METADATA = "submission_metadata.yml"


@dataclass
class Handin:
    """The files and folders of one student in a class, by name.

    Attributes
    ----------
    parts : dict of str to Path
        What the student handed in.
    notes : list of str
        How it was told from the other students' files.
    people : list of str
        The names, numbers and addresses of its authors, as far as the platform tells them.
    submitted : str
        When it was handed in, as the platform writes it, or an empty string.
    late : bool
        Whether the platform calls it late.
    platform : str
        The platform whose names it has, or an empty string.
    """

    parts: dict[str, Path] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    people: list[list[str]] = field(default_factory=list)
    submitted: str = ""
    late: bool = False
    platform: str = ""

    def told(self) -> dict[str, Any]:
        """Return whose it is and when it was handed in, for the gradebook."""
        return {
            "people": self.people,
            "submitted": self.submitted,
            "late": self.late,
            "platform": self.platform,
        }

    def load(self) -> Submission | Refused:
        """Return the submission, or the reason why it is refused."""
        try:
            return submission.gather(self.parts, self.notes)
        except Refused as refused:
            return refused


class _Part(NamedTuple):
    """What the name of a file tells: whose it is, and its name within the submission."""

    path: Path
    name: str
    student: str = ""
    user: str = ""
    date: str = ""
    late: bool = False
    platform: str = ""


def handed_in(folder: Path) -> dict[str, Handin]:
    """Return what each student handed in, by the student's name."""
    people: dict[tuple[str, str], list[_Part]] = defaultdict(list)
    for path in _entries(folder):
        if part := _part(path):
            people[part.student, part.user].append(part)
    listed, found = _listed(folder), dict[str, Handin]()
    same = Counter(student for student, _ in people)
    for (student, user), parts in sorted(people.items()):
        handin = _handin(parts)
        name = student or f"submission_{user}"
        if not student and user in listed and listed[user].people:
            name = " and ".join(names[0] for names in listed[user].people)
            handin.people, handin.submitted = (
                listed[user].people,
                listed[user].submitted,
            )
        if same[student] > 1 and student and user:
            name = f"{student} ({user})"
        name = _printable(name, handin)
        found[name if name not in found else f"{name} ({user or len(found)})"] = handin
    return found


def _handin(parts: list[_Part]) -> Handin:
    """Return the last attempt of a student."""
    last = max(part.date for part in parts)
    handin = Handin(notes=_notes_on(parts, last), submitted=last)
    for part in parts:
        if part.date == last:
            new = part.name not in handin.parts
            handin.parts[part.name if new else part.path.name] = part.path
            handin.late |= part.late
            handin.platform = part.platform
            user = [f"#{part.user}"] if part.user else []
            handin.people = [[part.student, *user]] if part.student else []
    return handin


def on_times(handins: Mapping[str, Handin], known: Collection[str] = ()) -> list[str]:
    """Say what the names of the files tell about when submissions were handed in, where it is not a time.

    Nothing is said of the submissions ``known``, of which the roster or the rules tell the time.

    Examples
    --------
    >>> on_times({"ada": Handin(platform="Canvas"), "bo": Handin(submitted="2026-10-12-22-14-00")})
    ["Canvas's names tell no time: the submission without _LATE_ in its name counts as handed in by the deadline."]
    """
    handins = {name: one for name, one in handins.items() if name not in known}
    canvas = {name: one for name, one in handins.items() if one.platform == CANVAS}
    late = [name for name, one in canvas.items() if one.late and not one.submitted]
    untold = [n for n, one in handins.items() if not one.submitted and n not in canvas]
    said = []
    if in_time := len(canvas) - len(late):
        which = (
            f"the {in_time} submissions without _LATE_ in their names count"
            if in_time > 1
            else "the submission without _LATE_ in its name counts"
        )
        said.append(
            f"Canvas's names tell no time: {which} as handed in by the deadline."
        )
    if late:
        said.append(
            f"Canvas calls {_some(late)} late, and does not tell by how much. If lateness costs points in your rules, "
            "write under [submitted] in rules.toml when they came."
        )
    if untold:
        said.append(
            f"The files do not tell when {_some(untold)} came. If there is a deadline, the roster must tell it: "
            "Moodle's grading worksheet and GitHub Classroom's list of an assignment do. Or write it in rules.toml."
        )
    return said


def _some(names: list[str]) -> str:
    """Return the names, or how many they are."""
    return ", ".join(names) if len(names) <= 10 else counted(len(names), "submission")


def passed_over(folder: Path) -> list[str]:
    """Return the names of the files in a class that are nobody's submission."""
    return [
        path.name
        for path in _entries(folder)
        if _part(path) is None and path.name != METADATA
    ]


def _entries(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.name[0] != ".")


def _part(path: Path) -> _Part | None:
    """Return what the name of a file tells, or None if it is nobody's."""
    for platform, layout in LAYOUTS.items():
        if match := layout.fullmatch(path.name):
            told = match.groupdict()
            return _Part(
                path,
                told.get("file") or path.name,
                told.get("student") or "",
                told.get("user") or "",
                told.get("date") or "",
                bool(told.get("late")),
                platform,
            )
    if path.is_dir():
        return _Part(path, path.name, path.name)
    if submission.is_handed_in(path.name):
        return _Part(path, path.name, submission.stem(path.name))
    return None


def _notes_on(parts: list[_Part], last: str) -> list[str]:
    """Say which attempt counts, and that several files count as one submission."""
    names = [part.path.name for part in parts if part.date == last]
    notes = (
        [f"{' and '.join(names)} are one submission"]
        if 1 < len(names) < 4
        else [f"{len(names)} files are one submission"]
        if len(names) > 1
        else []
    )
    attempts = len({part.date for part in parts})
    if attempts > 1:
        notes.append(f"the attempt of {last} counts, the last of {attempts}")
    return notes


def _listed(folder: Path) -> dict[str, Handin]:
    """Return the authors and the times by the number of the submission, from Gradescope's list."""
    try:
        lines = (folder / METADATA).read_text("utf-8", "replace").splitlines()
    except OSError:
        return {}
    found, current = dict[str, Handin](), Handin()
    for line in lines:
        if match := re.match(r"['\"]?submission_(\d+)['\"]?:", line):
            found[match[1]] = current = Handin()
        elif match := re.match(r"\s*(-?)\s*:(name|sid|email|created_at): (.+)", line):
            value = match[3].strip(" '\"")
            if match[2] == "name":
                current.people.append([value.replace("/", "_")])
            elif match[2] == "created_at":
                current.submitted = value
            elif current.people:
                current.people[-1].append(value)
    return found


def _printable(name: str, handin: Handin) -> str:
    """Return the name in characters that every report can hold."""
    shown = "".join(c if c.isprintable() else "_" for c in name)
    if shown != name:
        handin.notes.append(f"the student's name is written {shown}")
    return shown
