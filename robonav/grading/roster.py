"""Who is in the class, and whose submission is whose. What is not certain is a problem, and never a guess."""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

# The headings of the columns, in small letters, of Moodle, Canvas, Gradescope, GitHub Classroom, and of one's own file.
COLUMNS: dict[str, tuple[str, ...]] = {
    "id": (
        "id number", "sis user id", "sid", "student id", "student_id", "idnumber",
    ),
    "identifier": ("identifier",),
    "number": ("id",),
    "login": ("username", "sis login id", "login", "user"),
    "github": ("github_username", "github username", "github"),
    "email": ("email address", "email", "e-mail"),
    "name": (
        "full name", "student", "student name", "name", "roster_identifier",
    ),
    "first": ("first name", "firstname", "first_name"),
    "last": ("last name", "surname", "lastname", "last_name"),
    "repository": ("student_repository_name",),
    "group": ("group", "group_name"),
    "submitted": (
        "submitted", "last modified (submission)", "submission_timestamp", "submission time",
    ),
}  # fmt: skip
GROUPS = "groups"  # Moodle's: tutorial groups as a rule, which hand in nothing together
PARTICIPANT = re.compile(r"Participant (\d+)")


@dataclass(frozen=True, eq=False)
class Student:
    """One line of the roster.

    Attributes
    ----------
    id : str
        What the gradebook calls the student: the first that the roster has of the student's number, login, GitHub name,
        email address and name.
    name : str
        The full name.
    group : str
        The group whose submission counts for all its members, or an empty string.
    submitted : str
        When the student handed in, as the roster says it, or an empty string.
    keys : frozenset of str
        What only this student is called on a platform, in small letters. ``#17`` is the platform's number 17.
    number : str
        The university's number of the student, or an empty string if the roster does not have it.
    names : frozenset of str
        The name's words in each order that a platform may write them in, without spaces and accents.
    row : dict of str to str
        The line itself.
    """

    id: str
    name: str = ""
    group: str = ""
    submitted: str = ""
    keys: frozenset[str] = frozenset()
    names: frozenset[str] = frozenset()
    github: str = ""
    number: str = ""
    row: Mapping[str, str] | None = None


def read_roster(path: Path, teams: bool = False) -> list[Student]:
    """Read a roster: a CSV file as Moodle, Canvas, Gradescope or GitHub Classroom export it, or one of your own.

    Parameters
    ----------
    path : Path
        The file. Its first line has the headings.
    teams : bool
        Whether the students with the same text in Moodle's column ``Groups`` share a submission, as those with the same
        ``group`` or ``group_name`` always do.

    Returns
    -------
    list of Student
        The students, in the file's order.

    Raises
    ------
    ValueError
        If the file cannot be read, has no column that tells who a student is, or gives two students the same name.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "roster.csv"
    >>> _ = path.write_text("Student,ID,SIS User ID\\n\\"Lovelace, Ada\\",17,s1\\n", "utf-8")
    >>> [(student.id, student.name) for student in read_roster(path)]
    [('s1', 'Lovelace, Ada')]
    """
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"the roster {path} cannot be read: {error}") from None
    try:
        dialect: type[csv.Dialect] = csv.Sniffer().sniff(text.split("\n")[0], ",;\t")
    except csv.Error:
        dialect = csv.excel
    rows = list(csv.DictReader(io.StringIO(text), dialect=dialect))
    found = [
        student
        for row in rows
        if (student := _student({k: v or "" for k, v in row.items() if k}, teams))
        is not None
    ]
    if not found:
        raise ValueError(
            f"the roster {path} names no student: it needs a column such as name, email, id or github_username"
        )
    seen = set[str]()
    for student in found:
        if student.id in seen:
            raise ValueError(
                f"two students of the roster {path} are called {student.id!r}; give each an id of their own"
            )
        seen.add(student.id)
    return found


def ignored_groups(students: Iterable[Student]) -> bool:
    """Whether the roster has groups in Moodle's column ``Groups``, which make no teams unless the rules say so.

    Examples
    --------
    >>> ignored_groups([Student("ada", row={"Groups": "Monday"})])
    True
    >>> ignored_groups([Student("ada", group="Monday", row={"Groups": "Monday"})])
    False
    """
    return any(
        heading.strip().casefold() == GROUPS and text.strip() and not student.group
        for student in students
        for heading, text in (student.row or {}).items()
    )


def _student(row: Mapping[str, str], teams: bool) -> Student | None:
    """Return the student in a line, or None if it is none's."""
    headings = {heading.strip().casefold(): heading for heading in row}
    told = {
        kind: row[headings[title]].strip()
        for kind, titles in COLUMNS.items()
        for title in reversed(titles)  # the first one counts
        if title in headings and row[headings[title]].strip()
    }
    if teams and GROUPS in headings:
        told.setdefault("group", row[headings[GROUPS]].strip())
    name = told.get("name") or f"{told.get('first', '')} {told.get('last', '')}".strip()
    identifier, number = told.get("identifier", ""), told.get("number", "")
    university = told.get("id", "")
    if not university and not of_canvas(row):
        # GitHub Classroom's identifier is often a name, and Moodle's is its own number.
        own = re.search(r"\d", identifier) and not PARTICIPANT.fullmatch(identifier)
        university = number or (identifier if own else "")
    if match := PARTICIPANT.fullmatch(identifier):
        number = match[1]
    elif "sis login id" in headings or "sis user id" in headings:
        number = identifier or number
    else:  # GitHub Classroom's and one's own identifier is not a number of a platform
        told.setdefault("id", identifier or number)
        number = ""
    if name == "Points Possible":  # Canvas's second line
        return None
    id = next(
        (told[kind] for kind in ("id", "login", "github", "email") if told.get(kind)),
        name or number,
    )
    if not id:
        return None
    words = {
        told.get(kind, "") for kind in ("id", "login", "github", "email", "repository")
    }
    words |= {told.get("email", "").partition("@")[0], f"#{number}" if number else ""}
    written = {
        name,
        told.get("id", ""),
        f"{told.get('first', '')} {told.get('last', '')}",
    }
    return Student(
        id=id,
        name=name or id,
        group=told.get("group", ""),
        submitted=told.get("submitted", "").strip("-"),
        keys=frozenset(word.casefold() for word in words - {""}),
        names=frozenset(form for one in written for form in forms(one)),
        github=told.get("github", "").casefold(),
        number=university,
        row=row,
    )


def of_canvas(row: Mapping[str, str]) -> bool:
    """Whether a line is of Canvas's gradebook, where ``ID`` is Canvas's own number.

    Examples
    --------
    >>> of_canvas({"Student": "Ada", "ID": "17", "Section": "A"}), of_canvas({"name": "Ada", "id": "17"})
    (True, False)
    """
    headings = {heading.strip().casefold() for heading in row}
    return bool(headings & {"sis login id", "sis user id"}) or (
        headings >= {"student", "id", "section"}
    )


def forms(name: str) -> set[str]:
    """Return a name's words in each order that keeps neighbours together, without spaces, accents and capitals.

    Examples
    --------
    >>> sorted(forms("Ada Lovelace")), sorted(forms("Lovelace, Ada"))
    (['adalovelace', 'lovelaceada'], ['adalovelace', 'lovelaceada'])
    """
    words = [_plain(word) for word in re.split(r"[\s,]+", name)]
    words = [word for word in words if word]
    return {"".join(words[k:] + words[:k]) for k in range(len(words))}


def _plain(text: str) -> str:
    apart = unicodedata.normalize("NFKD", text)
    return "".join(c for c in apart if c.isalnum()).casefold()


@dataclass(frozen=True, eq=False)
class Matching:
    """Whose submission is whose.

    Attributes
    ----------
    submissions : dict of str to str
        The submission that counts for a student, by the student's id.
    problems : list of str
        What is not certain, each in a sentence. None of it counts.
    unsettled : set of str
        Ids of the students whose submission is not certain.
    """

    submissions: dict[str, str]
    problems: list[str]
    unsettled: set[str]


def match(
    students: Sequence[Student],
    handed_in: Mapping[str, Sequence[Sequence[str]]],
    decided: Mapping[str, str],
    same: Mapping[str, str],
) -> Matching:
    """Find out whose each submission is.

    A platform's number, an id, a login, an email address or a GitHub name decides. A name decides if one student alone
    has it. If both say something and they disagree, or several students fit, or none, nobody gets the submission.

    Parameters
    ----------
    students : sequence of Student
        The roster. Students with the same group share a submission.
    handed_in : dict of str to sequence
        The submissions by name, each with its authors and what the platform calls them.
    decided : dict of str to str
        A student's id, or a group, by submission, where the instructor decides. An empty string, or what is neither,
        sets the submission aside.
    same : dict of str to str
        A hash of each submission. Two equal ones of a group are one.

    Returns
    -------
    Matching
        The submission of each student, and the problems.

    Examples
    --------
    >>> ada, bo = (Student(id, keys=frozenset([id])) for id in ("ada", "bo"))
    >>> found = match([ada, bo], {"ada": [["ada"]], "zoe": [["zoe"]]}, {}, {})
    >>> found.submissions, found.problems
    ({'ada': 'ada'}, ['The submission zoe fits no student of the roster.'])
    """
    by_id = {student.id: student for student in students}
    groups = defaultdict[str, list[str]](list)
    for student in students:
        if student.group:
            groups[student.group].append(student.id)
    theirs = {student.id: list[str]() for student in students}
    problems, unsettled = list[str](), set[str]()
    for submission, people in handed_in.items():
        if submission in decided:
            who = decided[submission]
            owners = [who] if who in by_id else groups.get(who, [])
        else:
            owners, problem, near = _owners(students, groups, submission, people)
            unsettled |= near
            if problem:
                problems.append(f"The submission {submission} {problem}.")
        members = {one for id in owners for one in groups.get(by_id[id].group, [id])}
        for id in members:
            theirs[id].append(submission)
    counted = dict[str, str]()
    several = dict[tuple[str, ...], str]()  # the submissions, and the first they fit
    for id, found in theirs.items():
        if len({same.get(name, name) for name in found}) == 1:
            counted[id] = found[0]
        elif found:
            unsettled.add(id)
            several.setdefault(tuple(found), id)
    problems += [_several_fit(by_id[id], fitting) for fitting, id in several.items()]
    return Matching(counted, problems, unsettled - set(counted))


def _several_fit(student: Student, submissions: Sequence[str]) -> str:
    """Say that several submissions fit a student or a team, and what the instructor can do."""
    advice = "Say under [matches] which one counts."
    if student.group:
        advice = (
            f"If {student.group} is a team, say under [matches] which one counts for all its members. "
            "If it is not, take the group out of the roster or the rules."
        )
    fit = f"Several submissions fit {student.group or student.id}"
    return f"{fit}: {', '.join(submissions)}. {advice}"


def _owners(
    students: Sequence[Student],
    groups: Mapping[str, list[str]],
    submission: str,
    people: Sequence[Sequence[str]],
) -> tuple[list[str], str, set[str]]:
    """Return the owners of a submission, or what is wrong with the students who fit, and who they are."""
    for group, members in groups.items():
        if _ends(submission, group.casefold()):
            return members, "", set()
    owners = list[str]()
    for words in people or [[submission]]:
        sure, likely = set[str](), set[str]()
        called, named = {word.casefold() for word in words}, forms(words[0])
        for student in students:
            if not student.keys.isdisjoint(called):
                sure.add(student.id)
            if not student.names.isdisjoint(named) or (
                student.github and _ends(words[0], student.github)
            ):
                likely.add(student.id)
        fits = sure if sure and (not likely or sure <= likely) else sure | likely
        if len(fits) != 1:
            who = ", ".join(sorted(fits))
            return (
                [],
                f"fits several students: {who}"
                if fits
                else "fits no student of the roster",
                fits,
            )
        owners += fits
    return owners, "", set()


def _ends(name: str, word: str) -> bool:
    """Whether a name is this word, or ends with it as the name of a repository does."""
    return name.casefold() == word or name.casefold().endswith(f"-{word}")


def fitting(students: Iterable[Student], word: str) -> list[Student]:
    """Return the students whom a word may mean: an id, or else a name, login, GitHub name, email address or number.

    Examples
    --------
    >>> [student.id for student in fitting([Student("s1", names=frozenset(forms("Ada Lovelace")))], "Lovelace, Ada")]
    ['s1']
    """
    known = list(students)
    exact = [student for student in known if student.id == word]
    return exact or [
        student
        for student in known
        if word.casefold() in student.keys or student.names & forms(word)
    ]


def one(fits: Sequence[Student], students: Sequence[Student], word: str) -> Student:
    """Return the only one of the students whom a word fits; ``students`` are all there are.

    Raises
    ------
    ValueError
        If there is none, or more than one.

    Examples
    --------
    >>> known = [Student("s1", "Ada Lovelace", names=frozenset(forms("Ada Lovelace")))]
    >>> one(fitting(known, "ada lovelace"), known, "ada lovelace").id
    's1'
    """
    if len(fits) != 1:
        whom = ", ".join(student.id for student in fits or students[:20])
        raise ValueError(
            f"several students fit {word!r}: {whom}"
            if fits
            else f"no student {word!r}; there are {whom}"
        )
    return fits[0]
