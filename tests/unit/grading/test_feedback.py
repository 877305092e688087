"""What a student reads at home: hints that follow from all answers, prints, rows, and the failing call as a file."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from robonav.cli import app
from robonav.grading.cases import outcome
from robonav.grading.check import InProcessCalls, check_submission, graded
from robonav.grading.course import Course
from robonav.grading.evidence import Evidence
from robonav.grading.grade import Part, Unaccepted, exercise_grade
from robonav.grading.reference import Case, Solutions, solution
from robonav.grading.session import Session
from robonav.grading.submission import Submission

COURSE = Course.around(Path(__file__).parent)
SOLUTIONS = Solutions(COURSE)
ROBONAV = [sys.executable, "-c", "from robonav.cli import main; main()"]


def feedback(key, function):
    exercise = COURSE.named(key)
    with np.errstate(all="ignore"):
        return graded(COURSE, exercise, InProcessCalls(function), SOLUTIONS)


def submitted(folder, name, source):
    path = folder / "ch2" / f"{name}.py"
    path.parent.mkdir(exist_ok=True)
    path.write_text(source)
    return folder


def test_a_hint_never_contradicts_a_part_that_passed():
    """Keeping ties but ignoring the tolerance passes the part on ties, so it is not "always a best action"."""

    def improve(q, policy, tolerance):
        current = q[np.arange(len(q)), policy]
        return np.where(q.max(axis=1) > current, q.argmax(axis=1), policy)

    said = feedback("2.2", improve)["feedback"]
    assert "Keep the current action where the gain is at most the tolerance" in said
    assert "always" not in said


@pytest.mark.parametrize("chances_are_right", [True, False])
def test_a_number_is_called_nearly_right_only_if_no_other_is_far_off(chances_are_right):
    """A distance can come near by chance if the probabilities are wrong."""

    def projected(weights, found, expert, scale):
        right, left = solved(weights, found, expert, scale)
        equal = np.full(len(right), 1 / len(right))
        return right if chances_are_right else equal, 1.003 * left

    solved = solution(COURSE, COURSE.named("5.3"))
    said = feedback("5.3", projected)["feedback"]
    assert ("All numbers are nearly right." in said) == chances_are_right


def test_numbers_that_are_none_get_a_hint():
    said = feedback("2.2", lambda q, policy, tolerance: np.full(len(q), np.nan))
    assert said["feedback"].count("Hint: The answer holds nan.") == 3
    said = feedback("2.3", lambda p, values, d: (values, values + np.inf))
    assert "Hint: The answer holds infinity." in said["feedback"]


def test_an_exchange_of_rows_and_columns_is_named_where_the_shape_does_not_tell_it():
    class Nothing:
        def mistakes(self, case):
            return []

    evidence = Evidence(Nothing())
    square = np.arange(9.0).reshape(3, 3)
    case = Case(COURSE.named("2.1"), "a part", 0)
    evidence.observe(case, square.T, square, "wrong")
    part, unrelated = evidence.explained(
        [Part("", 1, "wrong", "It differs.", name) for name in ("a part", "another")]
    )
    assert part.feedback.endswith("the transpose of your answer is right.")
    assert unrelated.feedback == "It differs."


def test_a_changed_argument_costs_one_part():
    def shaped(rewards, potentials, ended, discount):
        if ended:
            potentials[-1] = 0.0
        return rewards + discount * potentials[1:] - potentials[:-1]

    result = feedback("4.2", shaped)
    assert result["feedback"].count("changes potentials in place") == 1
    assert "Hint" not in result["feedback"]
    assert 0 < result["points"] < result["max_points"]


def test_the_rows_of_a_wrong_answer_are_shown():
    said = feedback("2.2", lambda q, policy, tolerance: q.argmax(axis=1))["feedback"]
    assert "At [6] expected 3, got 1." in said
    assert "There: q[6] = [1., 2., 0., 2., 1.], policy[6] = 3." in said


@pytest.mark.sandbox
def test_an_exception_is_told_once_with_its_call_and_what_was_printed(tmp_path):
    submitted(
        tmp_path,
        "bounds",
        "def bounds(previous, values, discount):\n    print('so far', discount)\n    return 1 / 0\n",
    )
    grade, _ = check_submission(COURSE, [COURSE.named("2.3")], tmp_path)
    said = grade["exercises"][0]["feedback"]
    assert (
        said.count("ZeroDivisionError: division by zero (ch2/bounds.py, line 3)") == 1
    )
    assert "    bounds([" in said
    assert said.count("Printed: so far") == 1
    assert "The same error as above." in said


@pytest.mark.sandbox
def test_a_failing_call_becomes_a_file(tmp_path):
    submitted(
        tmp_path,
        "first_visits",
        "def first_visits(states, rewards, discount, size):\n    return [0.0] * size, [1] * size\n",
    )
    path = tmp_path / "case.npz"
    done = subprocess.run(
        [*ROBONAV, "check", "2.6", "--submission", tmp_path, "--case", path],
        cwd=COURSE.root,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1, done.stderr
    case = np.load(path)
    assert set(case) >= {
        "discount",
        "size",
        "expected_0",
        "expected_1",
        "got",
        "call",
    }
    called = []
    eval(  # the call as it is printed
        str(case["call"]),
        {"case": case, "first_visits": lambda *arguments: called.append(arguments)},
    )
    states, rewards, discount, size = called[0]
    assert isinstance(states[0], list)
    assert [len(one) for one in states] == [len(one) for one in rewards]
    assert (discount, size) == (0.5, 6)
    assert str(case["call"]) in done.stdout


@pytest.mark.sandbox
def test_a_chapter_is_checked_at_once(tmp_path):
    done = subprocess.run(
        [*ROBONAV, "check", "5", "--submission", tmp_path],
        cwd=COURSE.root,
        capture_output=True,
        text=True,
    )
    assert [
        line.split()[0] for line in done.stdout.splitlines() if "points" in line
    ] == [
        *(exercise.id for exercise in COURSE.selected("ch5")),
        "Total:",
    ]


@pytest.mark.sandbox
def test_an_open_task_has_no_call_that_failed_and_says_so(tmp_path):
    """Answers that are allowed and achieve nothing, a right answer, and one that raises."""
    submitted(
        tmp_path,
        "escape",
        "def escape(ranges, bearings, distances, memory):\n    return [0] * len(ranges), memory\n",
    )
    path = tmp_path / "case.npz"
    command = ["check", "6.6", "--submission", str(tmp_path)]
    plain = CliRunner().invoke(app, command)
    assert "got 0" in plain.output or "arrivals in 100 worlds" in plain.output
    assert "--case" not in plain.output
    done = CliRunner().invoke(app, [*command, "--case", str(path)])
    assert done.exit_code == 1
    assert "case.npz was not written: 6.6 is an open task" in done.output
    assert not path.exists()
    # With an exercise whose call fails, there is a file.
    submitted(tmp_path, "improve", "def improve(q, policy, tolerance):\n    return policy\n")  # fmt: skip
    done = CliRunner().invoke(app, ["check", "2.2", *command[1:], "--case", str(path)])
    assert "The first call that failed is in" in done.output
    assert "expected" in np.load(path)
    # An exception in an open task is a call that failed, without an expected answer.
    submitted(tmp_path, "escape", "def escape(ranges, bearings, distances, memory):\n    return 1 / 0\n")  # fmt: skip
    done = CliRunner().invoke(app, [*command, "--case", str(path)])
    assert "escape(" in str(np.load(path)["call"])
    assert "expected" not in np.load(path)
    assert 'compare with case["expected"]' not in done.output


def test_nothing_that_failed_is_said(tmp_path):
    path = tmp_path / "case.npz"
    command = ["check", "2.2", "--submission", str(tmp_path), "--case", str(path)]
    done = CliRunner().invoke(app, command)
    assert "case.npz was not written: nothing was begun." in done.output


def test_a_file_that_cannot_be_written_is_named(tmp_path):
    done = subprocess.run(
        [*ROBONAV, "check", "2.2", "--case", tmp_path / "nowhere" / "case.npz"],
        cwd=COURSE.root,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 2
    assert done.stderr.startswith("robonav: case must be a file to write in a folder")


def test_a_reply_that_claims_to_have_printed_is_not_believed():
    """Student code may forge a reply, and the feedback of a class must not hold what it chose."""

    class Forged:
        forks = False

        def ask(self, request, seconds):
            found = {"path": "ch2/improve.py", "origin": "", "unwritten": ""}
            value = found if request["do"] == "find" else None
            said = {"value": value, "changed": [], "printed": "a secret case"}
            return {"id": request["id"], **said}

        def end(self):
            pass

    session = Session(Submission({}), "official")
    session._worker = Forged()
    session.call(COURSE.named("2.2"), [1])
    assert session.printed == ""


@pytest.mark.sandbox
def test_a_check_needs_little_time(tmp_path):
    resource = pytest.importorskip("resource")

    def spent():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    begin = spent()
    subprocess.run(
        [*ROBONAV, "check", "2.2", "--submission", tmp_path],
        cwd=COURSE.root,
        capture_output=True,
    )
    assert spent() - begin < 3


def test_a_hint_is_whole_however_long_the_feedback_of_all_parts_is():
    """Four parts may show calls with many tables each, and the hint of the last one is not cut off."""
    told = Unaccepted("wrong", "a call with many tables " * 200)
    parts = [
        replace(part, feedback=f"{part.feedback}\nHint: Raise it.")
        for part in [
            outcome(test_a_number_that_is_none_may_have_been_put_there, 1, told)
        ]
        * 5
    ]
    result = exercise_grade(COURSE.named("6.4"), parts)
    assert len(result["feedback"]) > 15_000
    assert result["feedback"].count("Hint: Raise it.") == 5


@pytest.mark.parametrize(
    "price", [np.inf, np.nan, 0.0, -1.0], ids=["infinity", "nan", "0", "-1"]
)
def test_a_price_for_blocked_bins_gets_the_hint_that_each_bin_has_its_cost(price):
    """No division by zero is to be looked for: the student put the number there."""

    def direction(histogram, blocked, low, high, target, last, weights):
        now = (histogram >= high) | (blocked & (histogram > low))
        apart = abs(np.arange(len(now)) - np.array([target, 0, last])[:, None])
        cost = weights @ np.minimum(apart, len(now) - apart)
        best = int(np.where(now, np.inf, cost).argmin())
        return now, np.where(now, price, cost), -1 if now.all() else best

    said = feedback("6.2", direction)["feedback"]
    assert said.count("Hint: ") == 1
    assert "Hint: The cost is asked for each bin, whether free or not" in said


def test_a_number_that_is_none_may_have_been_put_there():
    said = feedback("2.2", lambda q, policy, tolerance: np.full(len(q), np.nan))
    assert "If you do not put it there yourself, look for" in said["feedback"]


@pytest.mark.parametrize("choice", ["lowest", "nearest to the target"])
def test_the_chosen_bin_depends_on_the_cost(choice):
    """Neither the lowest free number nor the free bin nearest to the target is enough."""

    def direction(histogram, blocked, low, high, target, last, weights):
        now = (histogram >= high) | (blocked & (histogram > low))
        apart = abs(np.arange(len(now)) - np.array([target, 0, last])[:, None])
        angles = np.minimum(apart, len(now) - apart)
        by = np.arange(len(now)) if choice == "lowest" else angles[0]
        best = int(np.where(now, np.inf, by).argmin())
        return now, weights @ angles, -1 if now.all() else best

    result = feedback("6.2", direction)
    assert result["points"] < result["max_points"]
    assert result["feedback"].count("Hint: ") == result["feedback"].count("✗")


@pytest.mark.parametrize(
    ("turn", "end", "hint"),
    [(0, "collisions: 100", "collide"), (2, "out of time: 100", "drive on")],
    ids=["straight on", "round and round"],
)
def test_an_open_task_says_how_episodes_ended_and_what_that_suggests(turn, end, hint):
    def escape(ranges, bearing, distance, memory):
        return np.full(len(ranges), turn), memory + 1  # it counts its steps

    result = feedback("6.6", escape)
    in_pockets = result["feedback"].split("✗")[2]
    assert f"Expected 75 arrivals in 100 worlds, got 0; {end}" in in_pockets.replace(
        "collisions: 0, ", ""
    )
    assert f"Hint: Most robots that fail {hint}" in in_pockets
    assert all(hint in part["hint"] for part in result["parts"][1:2])
