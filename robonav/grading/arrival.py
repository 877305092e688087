"""When a submission came, as far as the platform, the roster or the rules tell it.

Canvas's file names have no time. They only mark the late submissions. One that Canvas does not call late is taken as
handed in by the deadline. How late the others are, the instructor must say. Where nothing tells the time, the
instructor must say it too, unless lateness costs nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from robonav.counting import counted

from .layouts import CANVAS
from .roster import Student
from .rules import RULES, Late, Rules

BY_CANVAS = "in time, as Canvas does not call it late"
BY_RULES = "in time, as assume_in_time says"
LATE_BY_CANVAS = "late, as Canvas says; when is not told"
NOT_TOLD = "not told"
ASSUMED = {BY_CANVAS, BY_RULES}
UNTOLD = {LATE_BY_CANVAS, NOT_TOLD}


@dataclass(frozen=True)
class Arrival:
    """When a submission came.

    Attributes
    ----------
    said : str
        The time, or what is known instead of it.
    late : dict of str to Late
        How late each answer is.
    problem : str
        Why the marks cannot be told, or an empty string.
    """

    said: str = ""
    late: Mapping[str, Late] = field(default_factory=dict)
    problem: str = ""


def of(
    student: Student,
    submission: str,
    told: Mapping[str, Any],
    answered: Sequence[str],
    rules: Rules,
    free: int,
) -> Arrival:
    """Return when a submission came, and how late its answers are.

    Parameters
    ----------
    student : Student
        Whose it is.
    submission : str
        Its name.
    told : dict
        What :meth:`robonav.grading.layouts.Handin.told` says of it.
    answered : sequence of str
        The exercises that it answers.
    rules : Rules
        The deadlines, and what lateness costs.
    free : int
        Free days that the student has left.

    Returns
    -------
    Arrival
        The time, or why it cannot be told.

    Examples
    --------
    >>> of(Student("ada"), "ada", {"platform": "Canvas"}, ["2.1"], Rules(), 0).said
    'in time, as Canvas does not call it late'
    """
    written = told.get("submitted") or student.submitted
    time = rules.submitted.get(submission) or rules.time(written)
    if time is not None:
        late = rules.lateness(student.id, answered, time, free)
        return Arrival(time.isoformat(" ", "minutes"), late)
    late_by_canvas = bool(told.get("late"))
    if told.get("platform") == CANVAS and not late_by_canvas and not written:
        return Arrival(BY_CANVAS)
    if rules.assume_in_time and not late_by_canvas:
        return Arrival(BY_RULES)
    said = LATE_BY_CANVAS if late_by_canvas else NOT_TOLD
    due = any(rules.due(student.id, exercise) for exercise in answered)
    if not (due and rules.lateness_costs):
        return Arrival(said)
    how = f" from {written!r}" if written else ""
    problem = f"It cannot be told{how} when it was handed in"
    if late_by_canvas:
        problem = "Canvas calls it late, and it cannot be told by how much"
    return Arrival(said, problem=f"{problem}: the mark stays open.")


def advice(rules: Rules, untold: Mapping[str, str]) -> list[str]:
    """Say what an instructor can do where the time of submissions is not known and counts.

    Parameters
    ----------
    rules : Rules
        The rules.
    untold : dict of str to str
        What is known instead of the time, by submission.

    Returns
    -------
    list of str
        At most one sentence for those that Canvas calls late, and one for the others.

    Examples
    --------
    >>> from datetime import datetime, UTC
    >>> rules = Rules(deadlines={"2": datetime(2026, 10, 12, tzinfo=UTC)}, penalty=10)
    >>> advice(rules, {"ada": LATE_BY_CANVAS})
    ['Canvas calls 1 submission late and does not tell by how much. Write ... under [submitted]: "ada" = 2026-...]
    """
    if not (rules.deadlines and rules.lateness_costs):
        return []
    example = f"{max(rules.deadlines.values()):%Y-%m-%dT%H:%M:%S}"
    late = [name for name, said in untold.items() if said == LATE_BY_CANVAS]
    others = [name for name, said in untold.items() if said == NOT_TOLD]
    found = []
    if late:
        found.append(
            f"Canvas calls {counted(len(late), 'submission')} late and does not tell by how much. Write when they came "
            f'in {RULES}, under [submitted]: "{late[0]}" = {example}, with the time of each. SpeedGrader shows it.'
        )
    if others:
        found.append(
            f"Nothing tells when {counted(len(others), 'submission')} came. Give a roster that tells it (Moodle's "
            f"grading worksheet, GitHub Classroom's list of an assignment), or write it in {RULES}, under [submitted]: "
            f'"{others[0]}" = {example}. If you know that none is late, write assume_in_time = true under [late].'
        )
    return found


def assumptions(assumed: Mapping[str, str]) -> list[str]:
    """Say which submissions are taken as handed in by the deadline, and why.

    Examples
    --------
    >>> assumptions({"ada": BY_CANVAS, "bo": BY_CANVAS})
    ['2 submissions have no time and no _LATE_ in their names from Canvas. They count as handed in by the deadline...']
    """
    said = list[str]()
    by_canvas = sum(how == BY_CANVAS for how in assumed.values())
    if by_canvas:
        said.append(
            f"{counted(by_canvas, 'submission')} {'have' if by_canvas > 1 else 'has'} no time and no _LATE_ in "
            f"{'their names' if by_canvas > 1 else 'its name'} from Canvas. "
            f"{'They count' if by_canvas > 1 else 'It counts'} as handed in by the deadline: this is right if the "
            f"deadlines of {RULES} are those that Canvas has."
        )
    if by_rules := sum(how == BY_RULES for how in assumed.values()):
        said.append(
            f"{counted(by_rules, 'submission')} {'count' if by_rules > 1 else 'counts'} as handed in by the deadline "
            f"without a known time, because {RULES} says assume_in_time = true."
        )
    return said
