"""Whose submission each file in a class is, by the names that learning platforms give to what they export.

=============== ======================================================================================
Canvas          ``lovelaceada_LATE_123_456_improve-2.py``
Moodle          ``Ada Lovelace_123_assignsubmission_file_/``, or flat, the name of the file at its end
Blackboard      ``Exercises 2_ada_attempt_2024-05-01-10-30-00_improve.py``
Gradescope      ``submission_123/`` beside ``submission_metadata.yml``, which has the names
anything else   a folder, archive, notebook or Python file with the student's name
=============== ======================================================================================
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import submission
from .submission import Refused, Submission

LAYOUTS = [
    re.compile(r"(?P<student>[^_]+)(?P<late>_LATE)?_(?P<user>\d+)_\d+_(?P<file>.+)"),
    re.compile(
        r"(?P<student>.+)_(?P<user>\d+)_assignsubmission_(file|onlinetext)(_(?P<file>.*))?"
    ),
    re.compile(
        r".+_(?P<student>[^_]+)_attempt_(?P<date>\d{4}(-\d\d)+)(_(?P<file>.+)|(?P<receipt>\.txt))"
    ),
    re.compile(r"submission_(?P<user>\d+)"),
]
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
    """

    parts: dict[str, Path] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    people: list[list[str]] = field(default_factory=list)
    submitted: str = ""
    late: bool = False

    def told(self) -> dict[str, Any]:
        """Return whose it is and when it was handed in, for the gradebook."""
        return {"people": self.people, "submitted": self.submitted, "late": self.late}

    def load(self) -> Submission | Refused:
        """Return the submission, or the reason why it is refused."""
        try:
            return submission.gather(self.parts, self.notes)
        except Refused as refused:
            return refused


def handed_in(folder: Path) -> dict[str, Handin]:
    """Return what each student handed in, by the student's name."""
    people: dict[tuple[str, str], dict[str, list[tuple[str, Path]]]] = defaultdict(
        lambda: defaultdict(list)
    )
    for path in _entries(folder):
        if person := _person(path):
            student, user, date, name = person
            people[student, user][date].append((name, path))
    listed, found = _listed(folder), dict[str, Handin]()
    same = Counter(student for student, _ in people)
    for (student, user), attempts in sorted(people.items()):
        handin = Handin(notes=_notes_on(attempts))
        for name, path in attempts[max(attempts)]:
            handin.parts[name if name not in handin.parts else path.name] = path
            handin.late |= "_LATE_" in path.name
        handin.submitted = max(attempts)
        handin.people = [[student, *([f"#{user}"] if user else [])]] if student else []
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


def passed_over(folder: Path) -> list[str]:
    """Return the names of the files in a class that are nobody's submission."""
    return [
        path.name
        for path in _entries(folder)
        if _person(path) is None and path.name != METADATA
    ]


def _entries(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.name[0] != ".")


def _person(path: Path) -> tuple[str, str, str, str] | None:
    """Return the student, the student's number, the date and the name within the submission, as far as told."""
    for layout in LAYOUTS:
        if match := layout.fullmatch(path.name):
            told = match.groupdict()
            return (
                told.get("student") or "",
                told.get("user") or "",
                told.get("date") or "",
                told.get("file") or path.name,
            )
    if path.is_dir():
        return path.name, "", "", path.name
    if submission.is_handed_in(path.name):
        return submission.stem(path.name), "", "", path.name
    return None


def _notes_on(attempts: dict[str, list[tuple[str, Path]]]) -> list[str]:
    """Say which attempt counts, and that several files count as one submission."""
    last = max(attempts)
    names = [path.name for _, path in attempts[last]]
    notes = (
        [f"{' and '.join(names)} are one submission"]
        if 1 < len(names) < 4
        else [f"{len(names)} files are one submission"]
        if len(names) > 1
        else []
    )
    if len(attempts) > 1:
        notes.append(f"the attempt of {last} counts, the last of {len(attempts)}")
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
