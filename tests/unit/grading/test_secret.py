"""Marks under a secret: no feedback tells a case, and no number of submissions adds up to an answer."""

import textwrap
from pathlib import Path

import numpy as np
import pytest

from robonav.grading import sandbox_check
from robonav.grading.cases import PUBLIC, parts_of, seed_of, stretched
from robonav.grading.check import graded
from robonav.grading.classroom import GradingConfig, grade_submission
from robonav.grading.course import Course
from robonav.grading.evidence import Evidence
from robonav.grading.grade import Unaccepted
from robonav.grading.reference import Solutions, solution
from robonav.grading.session import Answer
from robonav.grading.submission import Refused, Submission

COURSE = Course.around(Path(__file__).parent)
SOLUTIONS = Solutions(COURSE)
IMPROVE, CHEAPEST = COURSE.named("improve"), COURSE.named("cheapest")


class Replies:
    """Calls of a function, which may raise Unaccepted, with a record of the arguments."""

    printed, changed = "", ()

    def __init__(self, function):
        self.function, self.asked = function, []

    def call(self, exercise, arguments):
        self.asked.append(arguments)
        return self.function(*arguments)


def cases(exercise, seed):
    """The arguments of all calls under a seed, as text."""
    replies = Replies(solution(COURSE, exercise))
    graded(COURSE, exercise, replies, SOLUTIONS, seed=seed)
    return {str(arguments) for arguments in replies.asked}


@pytest.mark.slow
def test_every_change_of_a_submission_draws_its_cases_anew():
    seeds = [seed_of(b"a secret", content) for content in ("one", "two", "one")]
    first, second, again = (cases(CHEAPEST, seed) for seed in seeds)
    assert first == again
    assert not first & second
    assert not first & cases(CHEAPEST, PUBLIC)
    assert seed_of(b"another", "one") != seeds[0]
    assert seed_of(b"", "one") == PUBLIC


def test_a_short_secret_is_not_found_by_trying_words():
    """What is written to a student's files is a hash that takes long to compute for one word."""
    stretched.cache_clear()
    key = GradingConfig(COURSE, "official", b"a secret").key()
    assert stretched.cache_info().misses == 1
    assert key != GradingConfig(COURSE, "official", b"b secret").key()


def test_an_answer_from_the_last_feedback_is_worth_nothing_in_the_next_submission():
    """Twenty submissions, each of which answers what the feedback to the earlier ones said was expected."""
    learned = {}
    for number in range(20):
        count = iter(range(10**6))

        def answer(*arguments):
            return learned.get(next(count), number)  # noqa: B023

        seed = seed_of(b"a secret", str(number))
        result = graded(COURSE, CHEAPEST, Replies(answer), SOLUTIONS, seed=seed)
        assert result["points"] == 0
        assert "expected" not in result["feedback"]


def raises(state, name):
    def answer(q, policy, tolerance):
        raise Unaccepted(state, f"{name}: {q[0, 0]}", raised=name)

    return answer


def is_wrong(place):
    def answer(q, policy, tolerance):
        right = np.array(solution(COURSE, IMPROVE)(q, policy, tolerance))
        right[place] = -1
        return right

    return answer


@pytest.mark.parametrize(
    "answers",
    [
        [raises(state, name) for name in ("KeyError", "OSError", "Mine")]
        for state in ("error", "timeout", "memory", "missing")
    ]
    + [[*map(is_wrong, range(8)), lambda *_: [1], lambda *_: None, lambda *_: "text"]],
    ids=["error", "timeout", "memory", "missing", "wrong"],
)
def test_feedback_under_a_secret_depends_on_the_state_alone(answers):
    """Not on an exception's name or message, on the place of a wrong number, on a shape, or on a hint."""
    seed = seed_of(b"a secret", "")
    said = {
        graded(COURSE, IMPROVE, Replies(answer), SOLUTIONS, seed=seed)["feedback"]
        for answer in answers
    }
    assert len(said) == 1


LEAKS = {
    "in the name of an exception": """
        def improve(q, policy, tolerance):
            raise [KeyError, ValueError, OSError, IndexError][int(q.sum()) % 4](q)
    """,
    "in the class of its own exception": """
        def improve(q, policy, tolerance):
            raise type(f"E{q[0].tolist()}", (Exception,), {})(q)
    """,
    "in the place of a wrong number": """
        def improve(q, policy, tolerance):
            answer = [99] * len(policy)
            answer[int(q.sum()) % len(policy)] = -1
            return answer
    """,
    "in the shape of the answer": """
        def improve(q, policy, tolerance): return [0] * (100 + int(q.sum()))
    """,
    "in what it prints": """
        def improve(q, policy, tolerance):
            print(q)
            return [99] * len(policy)
    """,
    "in the line of the error": """
        lines = "\\n" * 500
        def improve(q, policy, tolerance):
            exec(compile("\\n" * int(q.sum()) + "raise ValueError", "ch2/improve.py", "exec"))
    """,
    "in a change of an argument": """
        def improve(q, policy, tolerance):
            (q if int(q.sum()) % 2 else policy)[:] = 0
            return [99] * len(policy)
    """,
    "in a file that is read on the public cases": """
        import os
        places = [".", "..", "/submission", "/tmp", "/dev/shm", "/var/tmp", os.path.dirname(__file__)]
        def improve(q, policy, tolerance):
            found = []
            for place in places:
                try:
                    found += sorted(n for n in os.listdir(place) if n.startswith("leak"))
                    open(os.path.join(place, f"leak{int(q.sum())}"), "w").close()
                except OSError: pass
            raise ValueError(found[:1])
    """,
}  # fmt: skip


@pytest.mark.sandbox
@pytest.mark.parametrize("leak", LEAKS)
def test_feedback_is_the_same_under_every_secret(leak):
    """Whatever the code does with a case: the students' files tell nothing that depends on it."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    loaded = Submission({IMPROVE.file: textwrap.dedent(LEAKS[leak]).encode()})
    entries = []
    for secret in (b"one", b"two", b"three"):
        config = GradingConfig(COURSE, "official", secret)
        entries.append(grade_submission(config, loaded, [IMPROVE.id])["exercises"][0])
    assert entries[0] == entries[1] == entries[2]
    assert entries[0]["points"] == 0
    assert "On the public cases, as with robonav check:" in entries[0]["feedback"]


SPEAKS_FOR_THE_NEXT = """
import json, os, struct, sys
def send(value):
    header = json.dumps({"value": value, "arrays": []}).encode()
    for descriptor in range(3, 20):
        try: os.write(descriptor, struct.pack(">II", len(header), 0) + header)
        except OSError: pass
def stay(status):
    send({"dict": {"ended": 0}})
    found = {"dict": {"path": "a.py", "origin": "a.py", "unwritten": ""}}
    send({"dict": {"id": number + 1, "value": found, "changed": [], "printed": ""}})
    while True: pass
os._exit = stay
def improve(q, policy, tolerance):
    global number
    number = sys._getframe(1).f_locals["request"]["id"]
    return 0
"""


@pytest.mark.sandbox
def test_which_file_holds_an_answer_is_found_before_any_code_runs():
    """A process that says it has ended, and stays, could name one of 200 files for the next exercise."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    bounds = (COURSE.solutions / "ch2/bounds.py").read_bytes()
    files = {IMPROVE.file: SPEAKS_FOR_THE_NEXT.encode(), "a.py": b""}
    loaded = Submission(files | {"ch2/bounds.py": bounds})
    config = GradingConfig(COURSE, "official", b"a secret")
    grade = grade_submission(config, loaded, ["2.2", "2.3"])
    assert list(grade["files"].values()) == [IMPROVE.file, "ch2/bounds.py"]


@pytest.mark.sandbox
def test_the_public_cases_tell_what_is_wrong_under_a_secret():
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    source = b"def improve(q, policy, tolerance): return q.argmax(axis=1)"
    config = GradingConfig(COURSE, "official", b"a secret")
    grade = grade_submission(config, Submission({IMPROVE.file: source}), [IMPROVE.id])
    said = grade["exercises"][0]["feedback"]
    assert "An answer was wrong in a case that is kept secret." in said
    assert "At [6] expected 3, got 1." in said
    assert "Hint: " in said


def test_a_refused_submission_is_told_why_under_a_secret():
    config = GradingConfig(COURSE, "practice", b"a secret")
    grade = grade_submission(config, Refused("it is a link"), [IMPROVE.id])
    (entry,) = grade["exercises"]
    assert entry["feedback"].count("it is a link") == 1


def test_of_a_right_answer_only_what_counted_is_kept():
    """Else large values beside the right one would fill the grader's memory."""
    bounds, evidence = COURSE.named("bounds"), Evidence(SOLUTIONS)

    def answer(previous, values, discount):
        right = solution(COURSE, bounds)(previous, values, discount)
        return right[0], np.zeros(1000)

    test = next(test for test, _ in parts_of(COURSE, bounds))
    name = test.__name__
    test(Answer(Replies(answer), evidence, bounds, name), np.random.default_rng(0))
    assert len(evidence.observations) == 10
    assert max(np.size(one.got[1]) for one in evidence.observations) == 6


def test_weights_that_overflow_are_no_fault_of_the_grader():
    recover = COURSE.named("recover")

    def answer(transitions, features, paths, discount):
        return np.resize([1e308, -1e308], features.shape[1])

    result = graded(COURSE, recover, Replies(answer), SOLUTIONS)
    assert result["state"] in ("wrong", "partial")
