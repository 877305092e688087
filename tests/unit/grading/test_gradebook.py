"""The gradebook: who is who, what counts and why, and nothing lost when it is killed."""

import csv
import io
import json
import multiprocessing
import os
import random
import re
import shutil
import signal
import time
import zipfile
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading import classroom, commands, exports, ledger, objection, variants
from robonav.grading.class_statistics import counts
from robonav.grading.classroom import GradingConfig, grade_class
from robonav.grading.commands import write_all
from robonav.grading.course import Course
from robonav.grading.gradebook import ROSTER, Account, Mark, change, read_gradebook
from robonav.grading.roster import Student, match, read_roster
from robonav.grading.rules import RULES, TEMPLATE, Rules, read_rules

COURSE = Course.around(Path(__file__).parent)
HERE = GradingConfig(COURSE, "official")
DUE = datetime(2026, 10, 12, 23, 59, tzinfo=UTC)

MOODLE = """\
Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,\
Last modified (submission),Last modified (grade),Feedback comments
Participant 17,Ada Lovelace,ada@uni.edu,Submitted,,100.00,Yes,"Monday, 12 October 2026, 10:14 PM",-,
Participant 18,Bo Diddley,bo@uni.edu,Submitted,,100.00,Yes,"Wednesday, 14 October 2026, 2:14 PM",-,
Participant 19,Zoë Saldaña,zoe@uni.edu,No submission,,100.00,Yes,-,-,
"""
CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Old work (55)
    Points Possible,,,,,10
"Lovelace, Ada",17,s1,alovelace,A,
"Diddley, Bo",18,s2,bdiddley,A,
"""
GITHUB = """\
identifier,github_username,github_id,name
Ada Lovelace,countess,1,
"Diddley, Bo",bo-d,2,
Ulf,d,3,
"""


def graded_points(name):
    """Points of 2.1 and 2.2 in the classes of these tests: as the student's file says."""
    return {"2.1": 3, "2.2": 1} if "half" in name else {"2.1": 4, "2.2": 4}


@pytest.fixture
def quick(monkeypatch):
    """Grading without a sandbox, from what stands in the file."""

    def read(config, loaded, ids=()):
        text = b"".join(loaded.files.values()).decode()
        entries = []
        for exercise in list(COURSE.exercises.values())[:2]:
            if ids and exercise.id not in ids:
                continue
            points = graded_points(text)[exercise.id]
            right = points == exercise.points
            part = {
                "test": "test_it",
                "name": "It holds.",
                "points": exercise.points,
                "state": "correct" if right else "wrong",
                "hint": "" if right else "Look at the <sign>.",
            }
            entries.append(
                {
                    "id": exercise.id,
                    "points": points,
                    "max_points": exercise.points,
                    "state": "correct" if right else "partial",
                    "feedback": "as it is",
                    "parts": [part],
                }
            )
        points = sum(entry["points"] for entry in entries)
        return {
            "points": points,
            "max_points": 8,
            "tier": config.tier,
            "exercises": entries,
            "files": {entry["id"]: "a.py" for entry in entries},
        }

    monkeypatch.setattr(classroom, "grade_submission", read)


def handed_over(folder, names, text="full"):
    """Folders of submissions."""
    for name in names:
        (folder / name).mkdir(parents=True, exist_ok=True)
        (folder / name / "a.py").write_text(text)
    return folder


def book_of(tmp_path, names, roster=None, rules=""):
    folder, out = tmp_path / "class", tmp_path / "out"
    handed_over(folder, names)
    grade_class(HERE, folder, out, jobs=1)
    if roster:
        (out / ROSTER).write_text(roster, "utf-8")
    (out / RULES).write_text(rules, "utf-8")
    return read_gradebook(out, COURSE)


def rows(text):
    return list(csv.reader(io.StringIO(text.removeprefix("\ufeff"))))


def roster(tmp_path, text):
    path = tmp_path / "roster.csv"
    path.write_text(text, "utf-8-sig")
    return read_roster(path)


@pytest.mark.parametrize(
    ("text", "handed_in", "expected"),
    [
        (
            MOODLE,
            {
                "Ada Lovelace": [["Ada Lovelace", "#17"]],
                "Zoe Saldana": [["Zoe Saldana", "#19"]],
            },
            {"ada@uni.edu": "Ada Lovelace", "zoe@uni.edu": "Zoe Saldana"},
        ),
        (CANVAS, {"lovelaceada": [["lovelaceada", "#17"]]}, {"s1": "lovelaceada"}),
        (CANVAS, {"diddleybo": [["diddleybo"]]}, {"s2": "diddleybo"}),
        (CANVAS, {"bdiddley": [["bdiddley"]]}, {"s2": "bdiddley"}),
        (
            GITHUB,
            {"hw-2-countess": [["hw-2-countess"]]},
            {"Ada Lovelace": "hw-2-countess"},
        ),
        (
            "First Name,Last Name,SID,Email\nAda,Lovelace,s1,a@u.edu\nBo,Diddley,s2,b@u.edu\n",
            {
                "A and B": [
                    ["Ada Lovelace", "s1", "a@u.edu"],
                    ["Bo Diddley", "s2", "b@u.edu"],
                ]
            },
            {"s1": "A and B", "s2": "A and B"},
        ),
    ],
)
def test_names_and_numbers_of_platforms_are_matched(
    tmp_path, text, handed_in, expected
):
    found = match(roster(tmp_path, text), handed_in, {}, {})
    assert found.problems == []
    assert found.submissions == expected


@pytest.mark.parametrize(
    ("text", "handed_in", "said"),
    [
        (CANVAS, {"eve": [["eve"]]}, "eve fits no student"),
        # The number is one student's, the name is another's.
        (
            CANVAS,
            {"lovelaceada": [["lovelaceada", "#18"]]},
            "fits several students: s1, s2",
        ),
        # Two accounts end alike.
        (GITHUB, {"hw-bo-d": [["hw-bo-d"]]}, "fits several students: Diddley, Bo, Ulf"),
        (
            "name,id\nAda Lovelace,s1\nLovelace Ada,s2\n",
            {"Ada Lovelace": [["Ada Lovelace"]]},
            "fits several students: s1, s2",
        ),
        (CANVAS, {"s1": [["s1"]], "lovelaceada": [["lovelaceada"]]}, "Several subm"),
    ],
)
def test_what_is_not_certain_is_a_problem_and_no_guess(tmp_path, text, handed_in, said):
    students = roster(tmp_path, text)
    found = match(students, handed_in, {}, {})
    assert found.submissions == {}
    assert len(found.problems) == 1
    assert said in found.problems[0]
    decided = match(
        students, handed_in, dict.fromkeys(handed_in, "") | {"eve": "s1"}, {}
    )
    assert decided.problems == []


def test_a_roster_that_is_none_is_one_sentence(tmp_path):
    for text in ("", "a,b\n1,2\n", "name\nada\nada\n"):
        with pytest.raises(ValueError, match="roster"):
            roster(tmp_path, text)
    with pytest.raises(ValueError, match="cannot be read"):
        read_roster(tmp_path / "none.csv")


def test_one_submission_counts_for_all_of_a_group(tmp_path, quick):
    text = "name,id,group\nAda,ada,t1\nBo,bo,t1\nCy,cy,\n"
    book = book_of(tmp_path, ["bo", "cy"], text)
    assert [a.submission for a in book.accounts] == ["bo", "bo", "cy"]
    assert [a.points for a in book.accounts] == [8, 8, 8]
    # Two different ones are not certain; two equal ones are one.
    handed_over(tmp_path / "class", ["ada"])
    grade_class(HERE, tmp_path / "class", tmp_path / "out", jobs=1)
    assert read_gradebook(tmp_path / "out", COURSE).accounts[0].points == 8
    handed_over(tmp_path / "class", ["ada"], "half")
    grade_class(HERE, tmp_path / "class", tmp_path / "out", jobs=1)
    book = read_gradebook(tmp_path / "out", COURSE)
    assert [a.submission for a in book.accounts] == ["", "", "cy"]
    assert "Several submissions fit t1: ada, bo" in book.problems[0]
    (tmp_path / "out" / RULES).write_text('[matches]\nada = ""\n')
    assert [
        a.submission for a in read_gradebook(tmp_path / "out", COURSE).accounts
    ] == ["bo", "bo", "cy"]


def test_moodles_groups_are_teams_only_if_the_rules_say_so(tmp_path, quick):
    text = "Full name,Email address,Groups\nAda,ada@u.edu,Monday\nBo,bo@u.edu,Monday\n"
    book = book_of(tmp_path, ["ada", "bo"], text)
    assert [a.submission for a in book.accounts] == ["ada", "bo"]
    assert [a.student.group for a in book.accounts] == ["", ""]
    assert book.problems == []
    (tmp_path / "moodle.csv").write_text(text)
    done = invoke("start", tmp_path / "out", "--roster", tmp_path / "moodle.csv")
    assert "The column Groups makes no teams" in done.output
    book = book_of(tmp_path, [], text, "teams = true\n")  # two equal ones are one
    done = invoke("start", tmp_path / "out", "--roster", tmp_path / "moodle.csv")
    assert "makes no teams" not in done.output
    assert [a.student.group for a in book.accounts] == ["Monday", "Monday"]
    assert [a.points for a in book.accounts] == [8, 8]
    handed_over(tmp_path / "class", ["ada"], "half")
    grade_class(HERE, tmp_path / "class", tmp_path / "out", jobs=1)
    book = read_gradebook(tmp_path / "out", COURSE)
    assert [a.submission for a in book.accounts] == ["", ""]
    assert "If Monday is a team, say under [matches]" in book.problems[0]
    assert "If it is not, take the group out of the roster" in book.problems[0]
    for column in ("group", "group_name"):
        told = roster(tmp_path, f"name,{column},Groups\nAda,t1,Monday\n")
        assert [student.group for student in told] == ["t1"]


def test_groups_of_the_rules_need_no_roster(tmp_path, quick):
    book = book_of(
        tmp_path, ["ada", "cy"], rules='[groups]\nteam = ["ada", "nobody"]\n'
    )
    assert [a.student.group for a in book.accounts] == ["team", ""]
    assert "nobody, who is not in the roster" in book.problems[0]


@pytest.mark.parametrize(
    ("after", "days", "share"),
    [
        (timedelta(minutes=10), 0, 0),
        (timedelta(minutes=11), 1, 0),
        (timedelta(days=1), 1, 0),
        (timedelta(days=1, minutes=11), 2, 0),
        (timedelta(days=3), 3, 0.1),
        (timedelta(days=8), 8, 0.5),
        (timedelta(days=12), 12, 1.0),
    ],
)
def test_lateness(after, days, share):
    rules = Rules(
        deadlines={"2": DUE},
        grace=timedelta(minutes=10),
        penalty=10,
        most=50,
        closed_after=10,
    )
    late = rules.lateness("ada", ["2.1", "3.1"], DUE + after, free=2)
    assert list(late) == ["2.1"]
    assert (late["2.1"].days, late["2.1"].share) == (days, share)


def test_extensions_and_free_days_in_the_order_of_deadlines():
    rules = Rules(
        deadlines={"2": DUE, "3": DUE + timedelta(days=1), "2.9": DUE},
        extensions=[
            {"student": "ada", "exercises": ["2.9"], "until": DUE + timedelta(days=9)}
        ],
        penalty=10,
    )
    late = rules.lateness("ada", ["2.1", "2.9", "3.1"], DUE + timedelta(days=2), free=2)
    assert [(one.days, one.free, one.share) for one in late.values()] == [
        (2, 2, 0),
        (0, 0, 0),
        (1, 0, 0.1),
    ]


def test_exercises_that_are_due_at_the_same_time_share_a_free_day():
    """The deadline of one and the extension of the other coincide, so one late day is one late day."""
    later = DUE + timedelta(days=7)
    rules = Rules(
        deadlines={"2": DUE, "2.9": later, "3": later},
        extensions=[{"student": "ada", "exercises": ["2"], "until": later}],
        penalty=10,
        closed_after=3,
    )
    everything = ["2.1", "2.9", "3.1"]
    late = rules.lateness("ada", everything, later + timedelta(days=1), free=1)
    assert [(one.days, one.free, one.share) for one in late.values()] == [(1, 1, 0)] * 3
    marks = {id: Mark(id, 4, 4, "correct", late=one) for id, one in late.items()}
    assert Account(Student("ada"), "ada", marks).free_days == 1
    # Free days that would not open an exercise again go to the next deadline.
    late = rules.lateness("bo", everything, later + timedelta(days=1), free=1)
    assert [(one.days, one.free, one.share) for one in late.values()] == [
        (8, 0, 1.0),
        (1, 1, 0),
        (1, 1, 0),
    ]


@pytest.mark.parametrize(
    "who", ["s1", "Ada Lovelace", "lovelace, ada", "ALovelace", "ada@uni.edu"]
)
def test_the_rules_name_students_as_people_do(tmp_path, quick, who):
    """An id, the name in either order, the account, and the address, in each table of the rules."""
    text = CANVAS.replace("Section", "Email").replace(",A,", ",ada@uni.edu,", 1)
    rules = f"""
[deadlines]
2 = 2026-10-12T23:59:00
[late]
penalty = 10
[[extensions]]
student = "{who}"
exercises = ["2"]
until = 2026-10-19T23:59:00
[groups]
team = ["{who}", "s2"]
[matches]
one = "{who}"
[submitted]
one = 2026-10-14T12:00:00
"""
    book = book_of(tmp_path, ["one"], text, rules)
    assert book.problems == []
    assert [a.student.group for a in book.accounts] == ["team", "team"]
    assert [a.submission for a in book.accounts] == ["one", "one"]
    assert [a.points for a in book.accounts] == [8, 6.4]


def test_a_name_in_the_rules_that_is_not_one_student_is_one_sentence(tmp_path, quick):
    text = "id,name\ns1,Ada Lovelace\ns2,Ada Lovelace\n"
    rules = (
        '[groups]\nteam = ["Ada Lovelace", "Zoe"]\n[matches]\none = "Ada Lovelace"\n'
        'two = "Yo"\n[[extensions]]\nstudent = "Zoe"\nexercises = ["2"]\n'
        "until = 2026-10-19T23:59:00\n"
    )
    book = book_of(tmp_path, ["one", "two"], text, rules)
    assert book.problems == [
        "The rules name Zoe, who is not in the roster.",
        "The rules name Ada Lovelace, but several students are called so: write s1 or s2 instead.",
        "The rules give one to Ada Lovelace, but several students are called so: write s1 or s2 instead.",
        "The rules give two to Yo, who is not in the roster.",
    ]
    assert [a.submission for a in book.accounts] == ["", ""]
    assert [a.student.group for a in book.accounts] == ["", ""]


def test_the_template_is_valid_with_and_without_its_marks(tmp_path):
    (tmp_path / RULES).write_text(TEMPLATE)
    assert read_rules(tmp_path, COURSE).deadlines == {}
    lines = [re.sub(r"^# (?=[\[a-z0-9\"])", "", x) for x in TEMPLATE.splitlines()[1:]]
    (tmp_path / RULES).write_text("\n".join(lines))
    rules = read_rules(tmp_path, COURSE)
    assert rules.due("ada", "2.1").isoformat() == "2026-10-19T23:59:00+02:00"
    assert rules.due("bo", "2.9").isoformat() == "2026-10-26T23:59:00+01:00"
    assert rules.matches == {"submission_17": "ada"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[late]\npenalty = -1", "penalty must be a number from 0 to 100, got -1"),
        ("[late]\npenalties = 1", "unknown 'penalties' in late"),
        ("[deadlines]\n9 = 2026-10-12T00:00:00", "no exercise '9'"),
        ("[deadlines]\n2 = 5", "the deadline of 2 must be a time"),
        ("[[extensions]]\nstudent = 'ada'", "an extension needs exercises"),
        ("timezone = 'Mars/Olympus'", "no timezone"),
        ("[groups]\na = 'ada'", "group a must be a list"),
        ("[late", "cannot be read"),
        ("exercises = '2'", "must be a list"),
        ("teams = 'yes'", "teams must be true or false, got yes"),
    ],
)
def test_wrong_rules_are_one_sentence(tmp_path, text, said):
    (tmp_path / RULES).write_text(text)
    with pytest.raises(ValueError, match=said) as raised:
        read_rules(tmp_path, COURSE)
    assert RULES in str(raised.value)


@pytest.mark.parametrize(
    "written",
    [
        "Monday, 12 October 2026, 10:14 PM",
        "Monday, October 12, 2026, 10:14 PM",
        "2026-10-12-22-14-00",
        "2026-10-12 22:14:00.397482000 Z",
        "2026-10-12 15:14:00 -07:00",
        "2026-10-12T22:14:00Z",
        "2026-10-12 22:14:00 UTC",
    ],
)
def test_times_of_platforms(written):
    time = Rules().time(written)
    assert time.replace(microsecond=0) == datetime(2026, 10, 12, 22, 14, tzinfo=UTC)


def test_lateness_counts_and_a_time_that_is_not_known_is_a_problem(tmp_path, quick):
    rules = "[deadlines]\n2 = 2026-10-12T23:59:00\n[late]\npenalty = 10\n"
    book = book_of(tmp_path, ["ada", "bo"], MOODLE, rules)
    assert [a.points for a in book.accounts] == [8, 6.4, 0]
    assert book.accounts[1].marks["2.1"].late.said == "2 days late, 20 % off"
    (tmp_path / "out" / ROSTER).write_text(MOODLE.replace("Wednesday, 14", "14th"))
    account = read_gradebook(tmp_path / "out", COURSE).accounts[1]
    assert "cannot be told from '14th October" in account.problems[0]
    assert account.points == 8


@pytest.mark.parametrize(
    ("files", "told"),
    [
        (
            {
                "submission_5/a.py": "",
                "submission_metadata.yml": "submission_5:\n  :submitters:\n  - :name: Ada Lovelace\n    :sid: 's1'\n"
                "    :email: a@u.edu\n  - :name: Bo Diddley\n    :sid: s2\n"
                "  :created_at: 2026-10-12 22:14:00.397482000 Z\n",
            },
            {
                "people": [["Ada Lovelace", "s1", "a@u.edu"], ["Bo Diddley", "s2"]],
                "submitted": "2026-10-12 22:14:00.397482000 Z",
                "late": False,
                "platform": "Gradescope",
            },
        ),
        (
            {"lovelaceada_LATE_17_99_a.py": ""},
            {
                "people": [["lovelaceada", "#17"]],
                "submitted": "",
                "late": True,
                "platform": "Canvas",
            },
        ),
        (
            {"Work_ada_attempt_2026-10-12-22-14-00_a.py": ""},
            {
                "people": [["ada"]],
                "submitted": "2026-10-12-22-14-00",
                "late": False,
                "platform": "Blackboard",
            },
        ),
        (
            {"Ada Lovelace_17_assignsubmission_file_/a.py": ""},
            {
                "people": [["Ada Lovelace", "#17"]],
                "submitted": "",
                "late": False,
                "platform": "Moodle",
            },
        ),
        (
            {"ada/a.py": ""},
            {"people": [["ada"]], "submitted": "", "late": False, "platform": ""},
        ),
    ],
    ids=["gradescope", "canvas", "blackboard", "moodle", "folder"],
)
def test_what_the_platforms_tell_is_written_down(tmp_path, quick, files, told):
    for name, text in files.items():
        (tmp_path / "class" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "class" / name).write_text(text or "full")
    grade_class(HERE, tmp_path / "class", tmp_path / "out", jobs=1)
    found = json.loads((tmp_path / "out" / classroom.HANDED_IN).read_text())
    assert list(found.values()) == [told]


CANVAS_FILES = ["lovelaceada_17_99_a.py", "diddleybo_18_98_a.py"]
COSTS = "[deadlines]\n2 = 2026-10-12T23:59:00\n[late]\npenalty = 10\n"


def class_of(tmp_path, files, roster, rules):
    """The gradebook of files with these names, all with right answers."""
    for name in files:
        path = tmp_path / "class" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("full")
    out = tmp_path / "out"
    grade_class(HERE, tmp_path / "class", out, jobs=1)
    (out / ROSTER).write_text(roster, "utf-8")
    (out / RULES).write_text(rules, "utf-8")
    return read_gradebook(out, COURSE)


def test_who_handed_in_nothing_has_no_mark_rather_than_zero(tmp_path, quick):
    """Until a mark is given by hand."""
    text = CANVAS + '"Yu, Zoe",19,s3,zyu,A,\n'
    book = class_of(tmp_path, CANVAS_FILES, text, "")
    write_all(tmp_path / "out")

    def columns(*names):
        heading, *lines = rows((tmp_path / "out/marks.csv").read_text())
        return [[line[heading.index(name)] for name in names] for line in lines]

    nothing = "nothing handed in"
    assert columns("status", "points") == [["graded", "8.0"]] * 2 + [[nothing, ""]]
    page = (tmp_path / "out/marks.html").read_text()
    assert f">{nothing}</td>" in page
    assert "\N{EN DASH} of 8" in page
    change(book, book.account("Zoe Yu"), "2.1", 0, "Did not come.", "Dr B.")
    write_all(tmp_path / "out")
    assert columns("status", "points")[2] == ["graded", "0.0"]


def test_a_student_is_found_by_the_name_of_the_submission(tmp_path, quick):
    book = class_of(tmp_path, CANVAS_FILES, CANVAS, "")
    assert book.account("diddleybo").student.id == "s2"
    with pytest.raises(ValueError, match="no student 'zoe'"):
        book.account("zoe")
    with pytest.raises(ValueError, match="no student ''"):
        book.account("")
    pair = replace(
        book, accounts=[replace(a, submission="pair") for a in book.accounts]
    )
    with pytest.raises(ValueError, match="several students fit 'pair': s1, s2"):
        pair.account("pair")
    ada, bo = book.accounts
    clash = replace(book, accounts=[replace(ada, submission="bdiddley"), bo])
    with pytest.raises(ValueError, match="several students fit 'bdiddley': s1, s2"):
        clash.account("bdiddley")
    assert clash.account("s1") is clash.accounts[0]


def test_canvas_names_tell_who_is_in_time_and_the_others_stay_open(tmp_path, quick):
    """Canvas marks the late ones with _LATE_ and tells no times; a student's own file name tells nothing."""
    files = ["lovelaceada_17_99_a.py", "diddleybo_LATE_18_98_a.py", "yuzoe_19_97_my_LATE_try.py"]  # fmt: skip
    text = CANVAS + '"Yu, Zoe",19,s3,zyu,A,\n'
    book = class_of(tmp_path, files, text, COSTS)
    out = tmp_path / "out"
    assert [a.total for a in book.accounts] == [8, None, 8]
    assert [row[5] for row in rows(exports.marks_for(book, "canvas", "W"))[2:]] == [
        "8", "", "8",
    ]  # fmt: skip
    done = invoke("export", out, tmp_path / "m.csv", "--format", "canvas")
    assert done.exit_code == 1
    assert "Left empty, because they are not settled: s2." in done.stderr
    assert "s2: Canvas calls it late, and it cannot be told by how much" in done.stderr
    write_all(out)
    page, line = (out / "marks.html").read_text(), rows((out / "marks.csv").read_text())
    assert "2 submissions have no time and no _LATE_ in their names" in page
    assert "Write when they came in rules.toml, under [submitted]" in page
    assert "&#34;diddleybo&#34; = 2026-10-12T23:59:00" in page
    heading = line[0].index("handed_in")
    assert [one[heading] for one in line[1:]] == [
        "in time, as Canvas does not call it late",
        "late, as Canvas says; when is not told",
        "in time, as Canvas does not call it late",
    ]
    assert [one[line[0].index("points")] for one in line[1:]] == ["8.0", "", "8.0"]
    overview = (out / "index.html").read_text()
    assert "the 2 submissions without _LATE_ in their names count as handed in by the deadline" in overview  # fmt: skip
    assert "Canvas calls diddleybo late, and does not tell by how much" in overview
    # The instructor says when it came, or lateness costs nothing.
    told = COSTS + "[submitted]\ndiddleybo = 2026-10-14T12:00:00\n"
    assert class_of(tmp_path, files, text, told).accounts[1].total == 6.4
    free = "[deadlines]\n2 = 2026-10-12T23:59:00\n"
    assert [a.total for a in class_of(tmp_path, files, text, free).accounts] == [8] * 3
    # The rules may not take as in time what Canvas calls late.
    kind = class_of(tmp_path, files, text, COSTS + "assume_in_time = true\n")
    assert kind.accounts[1].total is None


@pytest.mark.parametrize(
    "names",
    [
        ["Ada Lovelace_17_assignsubmission_file_/a.py", "Bo Diddley_18_assignsubmission_file_/a.py"],
        ["submission_17/a.py", "submission_18/a.py"],
        ["week2-ada/a.py", "week2-bo/a.py"],
    ],
    ids=["moodle", "gradescope without its list", "github"],
)  # fmt: skip
def test_where_nobody_tells_a_time_the_marks_stay_open_and_one_sentence_says_why(
    tmp_path, quick, names
):
    text = "name,id,github_username\nAda Lovelace,17,ada\nBo Diddley,18,bo\n"
    decided = '[matches]\nsubmission_17 = "17"\nsubmission_18 = "18"\n'
    rules = COSTS + (decided if "submission_17" in names[0] else "")
    book = class_of(tmp_path, names, text, rules)
    assert [a.total for a in book.accounts] == [None, None]
    assert len(book.problems) == 1
    assert book.problems[0].startswith("Nothing tells when 2 submissions came.")
    assert "assume_in_time = true under [late]" in book.problems[0]
    overview = (tmp_path / "out/index.html").read_text()
    assert "The files do not tell when" in overview
    kind = rules.replace("penalty = 10\n", "penalty = 10\nassume_in_time = true\n")
    book = class_of(tmp_path, names, text, kind)
    assert [a.total for a in book.accounts] == [8, 8]
    assert book.problems == []
    assert "2 submissions count as handed in by the deadline" in book.notes[0]


def test_the_overview_asks_for_no_time_that_the_roster_or_the_rules_tell(
    tmp_path, quick
):
    people = ["Ada L", "Bo D", "Cy F", "Di G"]
    names = [f"{name}_{k}_assignsubmission_file_" for k, name in enumerate(people)]
    folder, out = handed_over(tmp_path / "class", names), tmp_path / "out"
    roster = tmp_path / "moodle.csv"
    roster.write_text(
        "Identifier,Full name,Last modified (submission)\n"
        'Participant 0,Ada L,"Wednesday, 10 June 2026, 2:14 PM"\n'
        "Participant 1,Bo D,-\nParticipant 2,Cy F,\n"
        'Participant 7,Dina Gray,"Wednesday, 10 June 2026, 3:14 PM"\n'
    )
    out.mkdir()
    decided = '"Di G" = "Dina Gray"\n[submitted]\n"Cy F" = 2026-06-10T12:00:00\n'
    (out / RULES).write_text(f"[matches]\n{decided}")
    command = ["grade", str(folder), "--out", str(out), "--practice", "--jobs", "1"]
    told = []
    for options in (["--roster", str(roster)], []):  # it is kept for the next time
        done = CliRunner().invoke(app, [*command, *options])
        assert done.exit_code == 0, done.output
        told.append("The files do not tell when Bo D came." in (out / "index.html").read_text())  # fmt: skip
    assert told == [True, True]
    arrived = [a.handed_in[:16] for a in read_gradebook(out, COURSE).accounts]
    assert arrived == ["2026-06-10 14:14", "not told", "2026-06-10 12:00", "2026-06-10 15:14"]  # fmt: skip


def test_blackboard_and_the_rosters_tell_the_time(tmp_path, quick):
    files = ["Work_ada_attempt_2026-10-14-12-00-00_a.py", "Work_bo_attempt_2026-10-12-12-00-00_a.py"]  # fmt: skip
    book = class_of(tmp_path, files, "name,id\nAda,ada\nBo,bo\n", COSTS)
    assert [a.total for a in book.accounts] == [6.4, 8]
    assert book.accounts[0].handed_in == "2026-10-14 12:00+00:00"
    assert (book.problems, book.notes) == ([], [])


def test_a_name_of_no_submission_in_the_rules_is_one_sentence(tmp_path, quick):
    rules = '[matches]\nbo = "ada"\n[submitted]\nadda = 2026-10-12T12:00:00\n'
    book = book_of(tmp_path, ["ada"], "name,id\nAda,ada\n", rules)
    assert book.problems == [
        "The rules name the submission bo in [matches], but there is none of this name.",
        "The rules name the submission adda in [submitted], but there is none of this name.",
    ]


def test_a_submission_that_is_given_to_a_student_later_was_not_graded_again(
    tmp_path, quick
):
    """A mark by hand for a student without a submission; then [matches] finds one."""
    text = "name,id\nAda,s1\nBo,s2\n"
    book = book_of(tmp_path, ["one", "Bo"], text)
    change(book, book.account("s1"), "2.1", 2, "oral exam", "Dr B.")
    (tmp_path / "out" / RULES).write_text('[matches]\none = "s1"\n')
    write_all(tmp_path / "out")
    account = read_gradebook(tmp_path / "out", COURSE).account("s1")
    assert account.problems == [
        "Another submission counts for 2.1 than when its mark was changed by hand: look whether the change still holds."
    ]
    assert "4 (then –)" in (tmp_path / "out/marks.html").read_text()
    change(book, account, "2.1", 2, "I looked", "Dr B.")
    assert read_gradebook(tmp_path / "out", COURSE).account("s1").problems == []


def test_an_exercise_that_does_not_count_or_was_not_graded_has_no_mark(tmp_path, quick):
    book = book_of(tmp_path, ["ada"], rules='exercises = ["2.1", "2.3"]\n')
    out, who = tmp_path / "out", book.account("ada")
    said = {
        "2.2": "2.2 does not count, because exercises in rules.toml does not name it: add it there first.",
        "2.3": "2.3 was not graded for ada: grade it first, with robonav grade ... --exercise 2.3.",
    }
    for id, words in said.items():
        with pytest.raises(ValueError, match=re.escape(words)):
            change(book, who, id, 1, "oral", "Dr B.")
        done = invoke("mark", out, "ada", id, "1", "--reason", "oral", "--by", "B")
        assert str(done.exception) == words
        with pytest.raises(ValueError, match=re.escape(words)):
            objection.explain(book, who, COURSE.named(id))
    # A mark that was changed by hand before the rules left the exercise out does not vanish without a word.
    change(book, who, "2.1", 1, "oral", "Dr B.")
    (out / RULES).write_text('exercises = ["2.2"]\n')
    assert read_gradebook(out, COURSE).problems == [
        "ada: the mark for 2.1 that was changed by hand does not count. "
        "2.1 does not count, because exercises in rules.toml does not name it: add it there first."
    ]


def test_the_headlines_count_what_was_graded(tmp_path, quick):
    book = book_of(tmp_path, ["ada", "bo"], rules='exercises = ["2.2"]\n')
    overview = (tmp_path / "out/index.html").read_text()
    assert "On average 8.0 of 8 points in the 2 exercises that anyone answered." in overview  # fmt: skip
    assert "257" not in overview
    path = exports.write_feedback(book, tmp_path / "zips")[0]
    with zipfile.ZipFile(path) as archive:
        page = archive.read("feedback.html").decode()
    assert "<h1>ada: 4 of 4 points</h1>" in page
    assert "2.1" not in page.split("<h1>")[1]


def test_a_name_that_is_no_text_ends_no_class(tmp_path, quick):
    folder, out = handed_over(tmp_path / "class", ["bo"]), tmp_path / "out"
    try:
        (folder / "a\udcff\n.py").write_text("full")
    except OSError:
        pytest.skip("no such names here")
    grade_class(HERE, folder, out, jobs=1)
    (out / ROSTER).write_text("name,id\nBo,bo\n")
    book = write_all(out)
    assert [a.points for a in book.accounts] == [8]
    assert book.problems == ["The submission a__ fits no student of the roster."]
    assert [path.name for path in exports.write_feedback(book, out / "z")] == ["bo.zip"]


def test_only_the_exercises_of_the_rules_count(tmp_path, quick):
    book = book_of(tmp_path, ["ada"], MOODLE, 'exercises = ["2.2"]\n')
    assert [(a.points, a.most) for a in book.accounts] == [(4, 4), (0, 4), (0, 4)]


def test_free_days_that_earlier_work_used_are_gone(tmp_path, quick):
    rules = (
        "[deadlines]\n2 = 2026-10-12T23:59:00\n[late]\npenalty = 10\nfree_days = 3\n"
    )
    book_of(tmp_path / "one", ["ada", "bo"], MOODLE, rules)
    book = book_of(
        tmp_path / "two", ["ada", "bo"], MOODLE, rules + 'earlier = ["../../one/out"]\n'
    )
    assert book.accounts[1].marks["2.1"].late.said == (
        "2 days late, 1 of them free, 10 % off"
    )


def test_a_change_by_hand_stays_through_grading_again(tmp_path, quick):
    book = book_of(tmp_path, ["ada", "bo"])
    out, folder = tmp_path / "out", tmp_path / "class"
    change(book, book.account("ada"), "2.1", 2, "<b>copied</b>", "Dr B.")
    grade_class(HERE, folder, out, jobs=1, again=["ada"])
    account = write_all(out).account("ada")
    assert (account.marks["2.1"].points, account.marks["2.1"].graded) == (2, 4)
    assert account.points == 6
    assert account.problems == []
    page = (out / "marks.html").read_text()
    assert "&lt;b&gt;copied" in page
    assert "<b>copied" not in page
    # The submission changed, and with it the grade: both are shown, and it is pointed out.
    handed_over(folder, ["ada"], "half")
    grade_class(HERE, folder, out, jobs=1)
    book = write_all(out)
    mark = book.account("ada").marks["2.1"]
    assert (mark.points, mark.graded, mark.by_hand["graded"]) == (2, 3, 4)
    assert "graded again since" in book.account("ada").problems[0]
    assert "3 (then 4)" in (out / "marks.html").read_text()
    change(book, book.account("ada"), "2.1", None, "seen again", "Dr B.")
    assert read_gradebook(out, COURSE).account("ada").points == 4
    assert len(ledger.read(out).of_kind("mark")) == 2


@pytest.mark.parametrize(
    ("points", "reason", "by", "said"),
    [
        (5, "r", "b", "from 0 to 4"),
        (-1, "r", "b", "from 0 to 4"),
        (1, " ", "b", "needs a reason"),
        (1, "r", "", "needs the name"),
        (float("nan"), "r", "b", "from 0 to 4"),
    ],
)
def test_a_change_needs_points_that_are_possible_a_reason_and_a_name(
    tmp_path, quick, points, reason, by, said
):
    book = book_of(tmp_path, ["ada"])
    with pytest.raises(ValueError, match=said):
        change(book, book.account("ada"), "2.1", points, reason, by)
    assert ledger.read(tmp_path / "out").of_kind("mark") == []


def test_a_log_shows_what_was_torn_and_what_was_changed(tmp_path):
    for number in range(4):
        ledger.append(tmp_path, "mark", {"number": number})
    path = tmp_path / ledger.LOG
    assert ledger.read(tmp_path).broken == []
    whole = path.read_bytes()
    path.write_bytes(whole[:-20])
    assert [event["number"] for event in ledger.read(tmp_path).events] == [0, 1, 2]
    ledger.append(tmp_path, "mark", {"number": 4})
    log = ledger.read(tmp_path)
    assert [event["number"] for event in log.events] == [0, 1, 2, 4]
    assert (log.torn, log.broken) == ([4], [])
    lines = whole.splitlines(keepends=True)
    for changed, broken in (
        (lines[0] + lines[2] + lines[3], [2]),
        (lines[0] + lines[1].replace(b"1", b"7", 1) + lines[2], [3]),
        (lines[1] + lines[0], [1, 2]),
    ):
        path.write_bytes(changed)
        assert ledger.read(tmp_path).broken == broken


def test_a_long_torn_line_does_not_hide_the_line_before_it(tmp_path):
    ledger.append(tmp_path, "mark", {"text": "x" * 100_000})
    with (tmp_path / ledger.LOG).open("ab") as file:
        file.write(b'{"kind": "mark", "text": "' + b"y" * 300_000)
    ledger.append(tmp_path, "mark", {"text": "z"})
    log = ledger.read(tmp_path)
    assert (len(log.events), log.torn, log.broken) == (2, [2], [])


@pytest.mark.slow
def test_the_gradebook_of_a_variant_has_its_exercises(tmp_path, quick):
    book_of(tmp_path, ["ada"])
    variants.write(COURSE, "autumn", tmp_path / "out/exercises")
    assert write_all(tmp_path / "out").course.root == tmp_path / "out/exercises"


EVIL = '=HYPERLINK("http://x")'


def test_moodle_gets_its_own_worksheet_back(tmp_path, quick):
    book = book_of(tmp_path, ["ada", "bo"], MOODLE)
    before, after = rows(MOODLE), rows(exports.marks_for(book, "moodle", "Work"))
    assert after[0] == before[0]
    grade = before[0].index("Grade")
    assert [row[grade] for row in after[1:]] == ["8", "8", ""]
    for one, other in zip(before, after, strict=True):
        one[grade] = other[grade]
        assert other == one


@pytest.mark.parametrize(
    ("most", "said"), [("8.00", False), ("8,0", False), ("100.00", True), ("A", True)]
)
def test_another_maximum_in_moodle_is_said(tmp_path, quick, most, said):
    text = f'Identifier,Full name,Grade,Maximum grade\nParticipant 17,ada,,"{most}"\n'
    book_of(tmp_path, ["ada"], text)
    done = invoke("export", tmp_path / "out", tmp_path / "m.csv", "--format", "moodle")
    assert done.exit_code == 0
    words = f"The worksheet's maximum grade is {most}, but the exercises that count have 8 points"
    assert (words in done.stderr) == said
    assert done.stderr.count("\n") == said


def test_the_class_is_graded_with_its_roster(tmp_path, monkeypatch):
    """A roster that cannot be read is told before the work; one that can is kept, and the marks follow it."""
    done = []
    monkeypatch.setattr(classroom, "grade_class", lambda *_, **__: done.append(1) or [])
    monkeypatch.setattr(commands, "write_all", lambda out: done.append(out / ROSTER))
    out, path = tmp_path / "out", tmp_path / "class.csv"
    (tmp_path / "class").mkdir()
    path.write_text("colour\nred\n")
    grade = ["grade", tmp_path / "class", "--out", out, "--practice", "--roster", path]
    refused = CliRunner().invoke(app, [str(word) for word in grade])
    assert "names no student" in str(refused.exception)
    assert done == []
    path.write_text("name,id\nAda,1\nBo,2\n")
    told = CliRunner().invoke(app, [str(word) for word in grade])
    assert told.exit_code == 0
    assert "2 students: " in told.output
    assert done == [1, out / ROSTER]
    assert (out / ROSTER).read_bytes() == path.read_bytes()


def test_canvas_gets_its_columns_and_the_points_possible(tmp_path, quick):
    book = book_of(tmp_path, ["lovelaceada"], CANVAS)
    assert rows(exports.marks_for(book, "canvas", "Chapter 2 (99)")) == [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Chapter 2 (99)"],
        ["    Points Possible", "", "", "", "", str(book.accounts[0].most)],
        ["Lovelace, Ada", "17", "s1", "alovelace", "A", "8"],
        ["Diddley, Bo", "18", "s2", "bdiddley", "A", ""],
    ]


@pytest.mark.parametrize(
    ("text", "number", "said"),
    [
        ("name,id\nada,1001\n", "1001", "finds the students by SIS User ID"),
        ("Full name,ID number\nada,1001\n", "1001", "by SIS User ID"),
        ("name,identifier\nada,1001\n", "1001", "by SIS User ID"),
        ("identifier,github_username\nada,ada\n", "", "no number of some students"),
        ("Identifier,Full name\nParticipant 17,ada\n", "", "no number of some"),
        (None, "", "no number of some"),
        ("Student,ID,Section\nada,17,A\n", "", ""),
        ("Student,ID,SIS User ID\nada,17,s1\n", "s1", ""),
    ],
)
def test_canvas_gets_the_students_number_without_its_own_roster(
    tmp_path, quick, text, number, said
):
    book_of(tmp_path, ["ada"], text)
    done = invoke("export", tmp_path / "out", tmp_path / "c.csv", "--format", "canvas")
    line = rows((tmp_path / "c.csv").read_text())[2]
    assert line[:3] == ["ada", "" if said else "17", number]
    assert line[5] == "8"
    assert done.exit_code == 0
    assert said in done.stderr
    assert done.stderr.count("\n") == bool(said)


def test_gradescope_gets_names_numbers_and_exercises(tmp_path, quick):
    text = "First Name,Last Name,SID,Email\nAda,Lovelace,s1,a@u.edu\n"
    book = book_of(tmp_path, ["s1"], text)
    heading, ada = rows(exports.marks_for(book, "gradescope", ""))
    assert heading[:6] == [
        *("First Name", "Last Name", "SID", "Email", "Total Score", "Max Points")
    ]
    assert ada[:5] == ["Ada", "Lovelace", "s1", "a@u.edu", "8"]
    assert heading[7].startswith("2.1: ")
    assert ada[7:9] == ["4", "4"]
    with pytest.raises(ValueError, match="format must be one of"):
        exports.marks_for(book, "excel", "")


def test_what_a_student_chose_breaks_no_table_and_no_page(tmp_path, quick):
    name = "=1+1 <script>alert(1)<"
    text = f'name,id,group\n"{EVIL.replace(chr(34), chr(34) * 2)}",{name},@x\nBo,bo,\n'
    book = book_of(tmp_path, [name], text)
    change(book, book.accounts[0], "2.1", 1, "=cmd|x", "+Dr")
    out = tmp_path / "out"
    book = write_all(out)
    texts = [exports.marks_for(book, kind, EVIL) for kind in exports.FORMATS]
    texts += [(out / f"{x}.csv").read_text() for x in ("marks", "statistics")]
    for cell in (cell for text in texts for row in rows(text) for cell in row):
        assert not cell.startswith(("=", "+", "-", "@", "\t", "\r"))
    for page in ("marks.html", "statistics.html"):
        assert "<script>" not in (out / page).read_text()
    for path in exports.write_feedback(book, tmp_path / "zips"):
        assert path.parent == tmp_path / "zips"
        with zipfile.ZipFile(path) as archive:
            assert b"<script>" not in archive.read("feedback.html")


def test_feedback_is_a_zip_a_student_with_the_marks_that_count(tmp_path, quick):
    text = "name,id,group\nAda,a/d,t\nBo,a\\d,t\nCy,cy,\n"
    book = book_of(tmp_path, ["ada"], text)
    change(book, book.account("a/d"), "2.1", 1, "spoke about it", "Dr B.")
    book = read_gradebook(tmp_path / "out", COURSE)
    written = exports.write_feedback(book, tmp_path / "zips")
    assert [path.name for path in written] == ["a_d.zip", "a_d_2.zip"]
    pages = []
    for path in written:
        with zipfile.ZipFile(path) as archive:
            assert archive.namelist() == ["feedback.html", "marks.csv"]
            pages.append(archive.read("feedback.html").decode())
    assert "1 points, changed by Dr B. on" in pages[0]
    assert "spoke about it" not in pages[1]
    before = [path.read_bytes() for path in written]
    exports.write_feedback(book, tmp_path / "zips")
    assert [path.read_bytes() for path in written] == before


def test_statistics_count_parts_and_hints(tmp_path, quick):
    book_of(tmp_path, ["ada", "bo", "cy"])
    handed_over(tmp_path / "class", ["ada", "bo"], "half")
    grade_class(HERE, tmp_path / "class", tmp_path / "out", jobs=1)
    book = write_all(tmp_path / "out")
    found = counts(book)["2.1"]
    assert found.attempted == 3
    assert found.parts["test_it"].states == {"correct": 1, "wrong": 2}
    assert found.hints == {"Look at the <sign>.": {"ada", "bo"}}
    lines = rows((tmp_path / "out/statistics.csv").read_text())
    assert ["2.1", "hint", "Look at the <sign>.", "2", "3"] in lines
    assert "&lt;sign&gt;" in (tmp_path / "out/statistics.html").read_text()


def invoke(*arguments):
    return CliRunner().invoke(app, ["gradebook", *map(str, arguments)])


def test_the_commands(tmp_path, quick):
    out = tmp_path / "out"
    book_of(tmp_path, ["lovelaceada"], rules="")
    (out / RULES).unlink()
    (tmp_path / "export.csv").write_text(CANVAS)
    assert invoke("start", out, "--roster", tmp_path / "export.csv").exit_code == 0
    assert (out / RULES).read_text() == TEMPLATE
    assert invoke("update", out).exit_code == 0
    done = invoke("mark", out, "ada lovelace", "2.1", "1", "--reason", "oral", "--by", "Dr B.")  # fmt: skip
    assert done.output == "s1 2.1: 1 of 4 points count\n"
    done = invoke("mark", out, "s1", "2.1", "many", "--reason", "oral", "--by", "B")
    assert isinstance(done.exception, ValueError)
    done = invoke("explain", out, "s1", "2.1")
    assert done.exit_code == 0
    assert "By hand" in done.output
    assert "1 points instead of the grader's 4, by Dr B.: oral" in done.output
    done = invoke("export", out, tmp_path / "c.csv", "--format", "canvas", "--title", "T")  # fmt: skip
    assert done.exit_code == 0
    assert rows((tmp_path / "c.csv").read_text())[2][5] == "5"
    done = invoke("feedback", out, tmp_path / "zips")
    assert "1 zip files" in done.output
    done = invoke("update", tmp_path / "nowhere")
    assert "holds no grades" in str(done.exception)
    done = invoke("explain", out, "nobody", "2.1")
    assert "no student 'nobody'; there are s1, s2" in str(done.exception)


@pytest.mark.parametrize(
    "secret", [b"", pytest.param(b"a secret", marks=pytest.mark.slow)]
)
@pytest.mark.slow
def test_an_objection_is_answered_with_what_was_run(tmp_path, secret):
    """In this process, without a sandbox, which is the same but for the tier."""
    folder, out = tmp_path / "class", tmp_path / "out"
    wrong = (COURSE.solutions / "ch2/improve.py").read_text().replace("> tol", ">= tol")
    (folder / "ada/ch2").mkdir(parents=True)
    (folder / "ada/ch2/improve.py").write_text(wrong)
    config = GradingConfig(COURSE, "practice", secret)
    grade_class(config, folder, out, jobs=1)
    book = read_gradebook(out, COURSE)
    exercise, account = COURSE.named("2.2"), book.account("ada")
    said = objection.explain(book, account, exercise)
    for word in (
        "File with the answer: ch2/improve.py, sha256 ",
        "Sandbox: practice",
        "numpy ",
        "Began: 20",
        "Seed of the cases: " + ("" if secret else "public"),
        "(test_improve_within_the_tolerance)",
        "hint: ",
        "Feedback of the grade that counts",
    ):
        assert word in said
    again = objection.repeat(book, account, exercise, folder)
    result = f"{account.marks['2.2'].graded:g} of 4 points"
    assert result in said
    assert result in again
    assert "expected [" in again
    assert again.count("call ") >= 1
    (folder / "ada/ch2/improve.py").write_text(wrong + "\n")
    with pytest.raises(ValueError, match="its hash differs"):
        objection.repeat(book, account, exercise, folder)


def assert_whole(text, book, platform):
    """An export has every line to its end; the marks in it may be older than the gradebook's."""
    read, now = rows(text), rows(exports.marks_for(book, platform, "Chapter 2"))
    assert text.endswith("\n")
    assert [len(line) for line in read] == [len(line) for line in now]
    assert [line[:2] for line in read] == [line[:2] for line in now]


def exported_until_the_file_takes_its_place(out, file, platform):
    """Export, and end by SIGKILL when all is written but the file has not got its name."""
    os.replace = lambda *_: os.kill(os.getpid(), signal.SIGKILL)
    commands.export(out, file, platform, "Chapter 2")


@pytest.mark.parametrize("platform", exports.FORMATS)
def test_a_killed_export_leaves_the_file_as_it_was(tmp_path, quick, platform):
    book_of(tmp_path, ["ada", "bo"])
    out, file = tmp_path / "out", tmp_path / "marks.csv"
    process = multiprocessing.get_context("fork").Process(
        target=exported_until_the_file_takes_its_place, args=(out, file, platform)
    )
    process.start()
    process.join()
    assert process.exitcode == -signal.SIGKILL
    assert not file.exists()
    commands.export(out, file, platform, "Chapter 2")
    assert_whole(file.read_text(), read_gradebook(out, COURSE), platform)


def busy(out, folder, acknowledged):
    """Grade, change marks by hand and write pages for ever, and say which changes were confirmed."""
    with acknowledged.open("a") as file:
        for number in range(10_000):
            book = read_gradebook(out, COURSE)
            event = change(book, book.account("ada"), "2.1", number % 5, f"r{number}", "B")  # fmt: skip
            file.write(event["time"] + event["after"] + "\n")
            file.flush()
            write_all(out)
            grade_class(HERE, folder, out, jobs=1, again=["bo"])
            exports.write_feedback(book, out / "zips")
            for platform in exports.FORMATS:
                commands.export(out, out / f"{platform}.csv", platform, "Chapter 2")


@pytest.mark.slow
def test_killed_twenty_times_nothing_confirmed_is_lost(tmp_path, quick):
    """SIGKILL at random moments."""
    book_of(tmp_path, ["ada", "bo"])
    folder, out, moments = tmp_path / "class", tmp_path / "out", random.Random(1)
    write_all(out)
    context, acknowledged = multiprocessing.get_context("fork"), tmp_path / "said"
    acknowledged.touch()
    for kill in range(20):
        before = acknowledged.stat().st_size
        process = context.Process(target=busy, args=(out, folder, acknowledged))
        process.start()
        begin = time.monotonic()
        while acknowledged.stat().st_size == before and time.monotonic() < begin + 60:
            time.sleep(0.002)
        time.sleep(moments.uniform(0, 0.15))
        process.kill()
        process.join()
        log = ledger.read(out)
        assert log.broken == []
        marks = {event["time"] + event["after"] for event in log.of_kind("mark")}
        said = acknowledged.read_text().splitlines()
        assert set(said) <= marks, f"kill {kill} lost a mark"
        assert len(marks) <= len(said) + kill + 1
        for name in ("ada", "bo"):
            json.loads((out / "students" / name / "grade.json").read_text())
        assert (out / "marks.html").read_text().endswith("</html>")
        assert (out / "statistics.html").read_text().endswith("</html>")
        assert len(rows((out / "marks.csv").read_text())) == 3
        for path in (out / "zips").glob("*.zip") if (out / "zips").exists() else ():
            assert zipfile.ZipFile(path).testzip() is None
        book = read_gradebook(out, COURSE)
        for platform in exports.FORMATS:
            if (exported := out / f"{platform}.csv").exists():
                assert_whole(exported.read_text(), book, platform)
        last = log.of_kind("mark")[-1]
        assert book.account("ada").marks["2.1"].points == last["points"]
    assert shutil.disk_usage(out)
    grade_class(HERE, folder, out, jobs=1)
    assert not list(out.rglob("*.partial-*"))


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("Ada Lovelace", ("Ada", "Lovelace")),
        ("Lovelace, Ada", ("Ada", "Lovelace")),
        ("Ana de la Cruz", ("Ana de la", "Cruz")),
        ("Plato", ("", "Plato")),
    ],
)
def test_first_and_last_name(name, parts):
    assert exports._first_and_last(name) == parts
