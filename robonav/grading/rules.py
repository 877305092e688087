"""The rules of a class: deadlines, extensions, late days, groups, and what the instructor decided about submissions."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

from .course import Course

RULES = "rules.toml"
TEMPLATE = """\
# The rules of this class. Remove the # in front of what you need; `robonav gradebook update` applies them.

# timezone = "Europe/Paris"       # of all times without an offset; the default is UTC

# exercises = ["2", "3.1"]        # what counts here, by chapter or exercise; the default is everything

# teams = true                    # Moodle's column `Groups` of the roster names teams, which share a submission

# [deadlines]                     # by chapter or exercise; the more particular one counts
# 2 = 2026-10-12T23:59:00
# "2.9" = 2026-10-26T23:59:00

# [late]
# grace_minutes = 10              # as much is not late
# free_days = 3                   # of each student, over all deadlines, for which nothing is taken off
# penalty = 10                    # per cent of the points for each day begun after them
# most = 50                       # per cent at most
# closed_after = 7                # days after which an exercise gives no points
# earlier = ["../graded-ch2"]     # folders of grades in which free days were used before
# assume_in_time = true           # a submission whose time nobody tells was handed in by the deadline

# [[extensions]]
# student = "ada"                 # here and below: an id, name, email address or account of the roster
# exercises = ["2"]
# until = 2026-10-19T23:59:00
# reason = "ill, certificate of 11 October"

# [groups]                        # one submission counts for all; a column `group` of the roster does the same
# team-1 = ["ada", "bo"]

# [matches]                       # whose a submission is, where the names do not tell; "" sets one aside
# "submission_17" = "ada"

# [submitted]                     # when a submission came, where the platform does not tell
# "submission_17" = 2026-10-12T21:30:00
"""
KEYS: dict[str, set[str]] = {
    "": {
        "timezone", "exercises", "teams", "deadlines", "late", "extensions", "groups", "matches", "submitted",
    },
    "late": {
        "grace_minutes", "free_days", "penalty", "most", "closed_after", "earlier", "assume_in_time",
    },
    "extensions": {"student", "exercises", "until", "reason"},
}  # fmt: skip
# As Moodle, Blackboard, Gradescope and GitHub Classroom write times.
FORMATS = (
    "%A, %d %B %Y, %I:%M %p", "%A, %B %d, %Y, %I:%M %p", "%A, %d %B %Y, %H:%M",
    "%d %B %Y, %I:%M %p", "%Y-%m-%d-%H-%M-%S", "%Y-%m-%d %H:%M:%S %Z",
)  # fmt: skip


@dataclass(frozen=True)
class Late:
    """How late an answer is, and what it costs.

    Attributes
    ----------
    days : int
        Days after the deadline, each that has begun.
    free : int
        How many of them are free.
    share : float
        The share of the points that is taken off.
    said : str
        The same in words, or an empty string if the answer is on time.
    due : datetime or None
        The deadline, or None if there is none.
    """

    days: int = 0
    free: int = 0
    share: float = 0.0
    said: str = ""
    due: datetime | None = None


@dataclass(frozen=True, eq=False)
class Rules:
    """The rules of a class, as the file has them.

    Attributes
    ----------
    deadlines : dict of str to datetime
        Deadlines by exercise or chapter.
    extensions : sequence of dict
        Other deadlines for some students.
    groups, matches : dict
        Members by group, and students by submission. The file may have a student's name, address or account instead of
        the id; :func:`robonav.grading.gradebook.with_ids` finds the ids.
    submitted : dict of str to datetime
        Times by submission.
    zone : tzinfo
        The time zone.
    grace : timedelta
        How much is not late.
    free_days : int
        Days that cost a student nothing.
    penalty, most : float
        Per cent for each day, and at most.
    closed_after : int or None
        Days after which there are no points.
    earlier : sequence of str
        Folders in which free days were used before.
    assume_in_time : bool
        Whether a submission whose time is not known, and which no platform calls late, was handed in by the deadline.
    exercises : frozenset of str
        Ids of the exercises that count. If it is empty, all do.
    teams : bool
        Whether Moodle's column ``Groups`` of the roster names teams, which share a submission.
    """

    deadlines: Mapping[str, datetime] = field(default_factory=dict)
    extensions: Sequence[Mapping[str, Any]] = ()
    groups: Mapping[str, Sequence[str]] = field(default_factory=dict)
    matches: Mapping[str, str] = field(default_factory=dict)
    submitted: Mapping[str, datetime] = field(default_factory=dict)
    zone: tzinfo = UTC
    grace: timedelta = timedelta(0)
    free_days: int = 0
    penalty: float = 0.0
    most: float = 100.0
    closed_after: int | None = None
    earlier: Sequence[str] = ()
    assume_in_time: bool = False
    exercises: frozenset[str] = frozenset()
    teams: bool = False

    @property
    def lateness_costs(self) -> bool:
        """Whether anything is taken off an answer that is late enough."""
        return self.closed_after is not None or self.penalty * self.most > 0

    def due(self, student: str, exercise: str) -> datetime | None:
        """Return the deadline of a student's exercise, or None if it has none."""
        chapter = exercise.partition(".")[0]
        key = next((key for key in (exercise, chapter) if key in self.deadlines), None)
        if key is None:
            return None
        times = [
            extension["until"]
            for extension in self.extensions
            if extension["student"] == student
            and {exercise, chapter} & set(extension["exercises"])
        ]
        return max([self.deadlines[key], *times])

    def lateness(
        self, student: str, exercises: Sequence[str], time: datetime, free: int
    ) -> dict[str, Late]:
        """Return how late each exercise of a student is.

        Parameters
        ----------
        student : str
            The student's id.
        exercises : sequence of str
            The exercises that the student answered.
        time : datetime
            When they were handed in.
        free : int
            Free days that the student has left. They go to the deadlines in order. Exercises that are due at the same
            time share them.

        Returns
        -------
        dict of str to Late
            The exercises that have a deadline.

        Examples
        --------
        >>> due = datetime(2026, 10, 12, tzinfo=UTC)
        >>> rules = Rules(deadlines={"2": due}, penalty=10)
        >>> rules.lateness("ada", ["2.1"], due + timedelta(days=2), free=1)["2.1"].share
        0.1
        """
        dues = {
            exercise: due
            for exercise in exercises
            if (due := self.due(student, exercise)) is not None
        }
        late = dict[datetime, Late]()
        for due in sorted(set(dues.values())):
            late[due] = self._late(due, time, free)
            free -= late[due].free
        return {exercise: late[due] for exercise, due in dues.items()}

    def _late(self, due: datetime, time: datetime, free: int) -> Late:
        """Return how late something is that was due at a time, with so many free days left."""
        days = max(0, math.ceil((time - due - self.grace) / timedelta(days=1)))
        if days == 0:
            return Late(due=due)
        said = f"{days} day{'s' * (days > 1)} late"
        if self.closed_after is not None and days > self.closed_after:
            return Late(
                days, 0, 1.0, f"{said}, no points after {self.closed_after}", due
            )
        free = min(days, free)
        share = min(self.most, self.penalty * (days - free)) / 100
        free_said = f", {free} of them free" if free else ""
        return Late(days, free, share, f"{said}{free_said}, {100 * share:g} % off", due)

    def time(self, written: str) -> datetime | None:
        """Return the time that a platform wrote down, or None if it cannot be told.

        Examples
        --------
        >>> Rules().time("Wednesday, 10 June 2026, 2:14 PM").isoformat()
        '2026-06-10T14:14:00+00:00'
        """
        written = re.sub(r"(:\d\d\.\d{6})\d+", r"\1", written.strip())
        written = re.sub(r" ([+-]\d\d:?\d\d)$", r"\1", written.replace(" Z", "+00:00"))
        try:
            return self.zoned(datetime.fromisoformat(written))
        except ValueError:
            pass
        for format in FORMATS:
            try:
                return self.zoned(datetime.strptime(written, format))
            except ValueError:
                continue
        return None

    def zoned(self, time: datetime) -> datetime:
        """Return a time with its offset, which is that of the class's time zone if it has none."""
        return time if time.tzinfo else time.replace(tzinfo=self.zone)


def read_rules(folder: Path, course: Course) -> Rules:
    """Read the rules in a folder of grades. Without a file there are none.

    Parameters
    ----------
    folder : Path
        The folder of grades.
    course : Course
        The course, whose exercises the file may name.

    Returns
    -------
    Rules
        The rules.

    Raises
    ------
    ValueError
        If the file has something that it should not, in one sentence.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = (folder / RULES).write_text("[late]\\npenalty = 10\\n", "utf-8")
    >>> read_rules(folder, Course.around(folder)).penalty
    10.0
    """
    path = folder / RULES
    try:
        written = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except (FileNotFoundError, NotADirectoryError):
        return Rules()
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ValueError(f"{path} cannot be read: {error}") from None
    try:
        return _rules(written, course)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _rules(written: Mapping[str, Any], course: Course) -> Rules:
    _check_keys("", written)
    late, zone = _table(written, "late"), written.get("timezone", "UTC")
    _check_keys("late", late)
    try:
        plain = Rules(zone=UTC if zone == "UTC" else ZoneInfo(zone))
    except (ValueError, TypeError, OSError, LookupError):
        raise ValueError(f"there is no timezone {zone!r} on this machine") from None
    extensions = written.get("extensions", [])
    if not isinstance(extensions, list):
        raise ValueError("extensions must be written as [[extensions]]")
    for extension in extensions:
        _check_keys("extensions", extension)
        for name in ("student", "exercises", "until"):
            if name not in extension:
                raise ValueError(f"an extension needs {name}")
        if not isinstance(extension["exercises"], list):
            raise ValueError('exercises of an extension must be a list such as ["2"]')
    groups = _table(written, "groups")
    for name, members in groups.items():
        if not (isinstance(members, list) and all(isinstance(x, str) for x in members)):
            raise ValueError(f"group {name} must be a list of students")
    earlier = late.get("earlier", [])
    if not (isinstance(earlier, list) and all(isinstance(x, str) for x in earlier)):
        raise ValueError("earlier must be a list of folders")
    counted = written.get("exercises", [])
    if not isinstance(counted, list):
        raise ValueError('exercises must be a list such as ["2", "3.1"]')
    closed = late.get("closed_after")
    return Rules(
        deadlines={
            _exercises(course, key): _time(plain, f"the deadline of {key}", value)
            for key, value in _table(written, "deadlines").items()
        },
        extensions=[
            {
                **extension,
                "student": str(extension["student"]),
                "exercises": [
                    _exercises(course, key) for key in extension["exercises"]
                ],
                "until": _time(plain, "until", extension["until"]),
            }
            for extension in extensions
        ],
        groups=groups,
        matches={k: str(v) for k, v in _table(written, "matches").items()},
        submitted={
            name: _time(plain, f"the time of {name}", value)
            for name, value in _table(written, "submitted").items()
        },
        zone=plain.zone,
        grace=timedelta(minutes=_number(late, "grace_minutes", 0, 100_000)),
        free_days=int(_number(late, "free_days", 0, 1000)),
        penalty=_number(late, "penalty", 0, 100),
        most=_number(late, "most", 100, 100),
        closed_after=None
        if closed is None
        else int(_number(late, "closed_after", 0, 1000)),
        earlier=earlier,
        assume_in_time=_truth(late, "assume_in_time"),
        exercises=frozenset(
            one.id for key in counted for one in course.selected(str(key))
        ),
        teams=_truth(written, "teams"),
    )


def _check_keys(table: str, written: Mapping[str, Any]) -> None:
    if not isinstance(written, Mapping):
        raise ValueError(f"{table} must be a table")
    for key in written.keys() - KEYS[table]:
        where = f" in {table}" if table else ""
        raise ValueError(f"unknown {key!r}{where}: there are {', '.join(sorted(KEYS[table]))}")  # fmt: skip


def _table(written: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = written.get(name, {})
    if not isinstance(table, Mapping):
        raise ValueError(f"{name} must be a table")
    return table


def _exercises(course: Course, key: Any) -> str:
    """Return the id of an exercise, or the number of a chapter."""
    selected = course.selected(str(key))
    if str(key) in (selected[0].id, selected[0].name):
        return selected[0].id
    return str(key).removeprefix("ch")


def _time(rules: Rules, what: str, value: Any) -> datetime:
    time = rules.time(value) if isinstance(value, str) else value
    if not isinstance(time, datetime):
        raise ValueError(f"{what} must be a time such as 2026-10-12T23:59:00, got {value}")  # fmt: skip
    return rules.zoned(time)


def _number(table: Mapping[str, Any], name: str, default: float, most: float) -> float:
    value = table.get(name, default)
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= most:  # fmt: skip
        raise ValueError(f"{name} must be a number from 0 to {most:g}, got {value}")
    return float(value)


def _truth(table: Mapping[str, Any], name: str) -> bool:
    value = table.get(name, False)
    if not isinstance(value, bool):
        raise ValueError(f"{name} must be true or false, got {value}")
    return value
