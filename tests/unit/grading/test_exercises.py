"""Every exercise: its solution scores full, however written; its known mistakes score less and get their hints."""

import functools
import inspect
import itertools
from pathlib import Path

import numpy as np
import pytest

from robonav.grading import frames
from robonav.grading.cases import PUBLIC, parts_of
from robonav.grading.check import InProcessCalls, graded
from robonav.grading.course import Course, trusted
from robonav.grading.reference import Solutions, mistakes, solution

pytestmark = pytest.mark.slow

COURSE = Course.around(Path(__file__).parent)
SOLUTIONS = Solutions(
    COURSE
)  # which knows the answers to all cases that were asked before
EXERCISES = list(COURSE.exercises.values())
MISTAKES = [
    pytest.param(exercise, function, id=f"{exercise.name}-{name}")
    for exercise in EXERCISES
    for name, function in mistakes(COURSE, exercise).items()
]


@pytest.fixture(scope="module", params=EXERCISES, ids=lambda exercise: exercise.name)
def exercise(request):
    """Each exercise. Tests of the same one run one after the other, so that they share its answers."""
    return request.param


def grade(exercise, function, seed=PUBLIC):
    with np.errstate(all="ignore"):
        return graded(COURSE, exercise, InProcessCalls(function), SOLUTIONS, seed=seed)


@functools.cache
def remembered(exercise):
    """The solution, which answers from memory what it was asked before: many tests ask the same."""
    function, known = solution(COURSE, exercise), {}

    def answer(*arguments):
        key = frames.encode(list(arguments))
        if key not in known:
            known[key] = function(*arguments)
        return known[key]

    return answer


@functools.cache
def public_run(exercise):
    """The grade of the solution for the public cases, and its calls in their order, as encoded arguments and answer."""
    function, calls = remembered(exercise), []

    def noted(*arguments):
        calls.append((frames.encode(list(arguments)), function(*arguments)))
        return calls[-1][1]

    return grade(exercise, noted), calls


def hints(result):
    """All hints in the feedback."""
    lines = result["feedback"].splitlines()
    return {line.partition("Hint: ")[2] for line in lines if "Hint: " in line}


def as_lists(value):
    """The same answer in Python's own numbers and lists."""
    if isinstance(value, tuple | list):
        return [as_lists(part) for part in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def as_singles(value):
    """The same answer in single precision, whole numbers in 32 bits."""
    if isinstance(value, tuple | list):
        return tuple(as_singles(part) for part in value)
    kinds = {"f": np.float32, "i": np.int32, "b": np.int8}
    return np.asarray(value).astype(kinds[np.asarray(value).dtype.kind])


def test_the_parts_share_out_the_points(exercise):
    assert sum(points for _, points in parts_of(COURSE, exercise)) == exercise.points


def test_the_solution_scores_full(exercise):
    result, _ = public_run(exercise)
    assert result["state"] == "correct", result["feedback"]
    assert result["points"] == exercise.points


@pytest.mark.parametrize("way", [as_lists, as_singles], ids=["lists", "singles"])
def test_the_solution_scores_full_with_other_types(exercise, way):
    function = remembered(exercise)
    result = grade(exercise, lambda *arguments: way(function(*arguments)))
    assert result["state"] == "correct", result["feedback"]
    assert result["points"] == exercise.points


def test_another_way_to_write_it_scores_full(exercise):
    result = grade(
        exercise,
        getattr(trusted(COURSE.solutions / "otherwise" / exercise.file), exercise.name),
    )
    assert result["state"] == "correct", result["feedback"]


@pytest.mark.parametrize(("exercise", "mistake"), MISTAKES)
def test_a_known_mistake_scores_less_and_gets_its_hint(exercise, mistake):
    result = grade(exercise, mistake)
    assert result["state"] in ("partial", "wrong", "error")
    assert result["points"] < exercise.points
    if exercise.difficulty == "open task":  # which the check measures
        assert "expected " in result["feedback"].lower()
        return
    assert hints(result) == {" ".join(inspect.getdoc(mistake).split())}
    assert result["feedback"].count("Hint: ") == result["feedback"].count("✗")


NOT_USED = {
    "remembers_nothing": "No robot remembers anything",
    "wipes_its_memory": "No robot remembers anything",
    "unchanged": "The policy has not learned",
}


def test_an_open_task_says_what_an_answer_never_uses():
    """And it does not say so of answers that use it."""
    named = {"escape": "never_leaves", "reinforce": "upside_down"}
    for exercise in EXERCISES:
        for name, mistake in mistakes(COURSE, exercise).items():
            if exercise.name in named and name in {*NOT_USED, *named.values()}:
                told = hints(grade(exercise, mistake))
                said = {
                    words
                    for words in NOT_USED.values()
                    if any(words in hint for hint in told)
                }
                assert said == ({NOT_USED[name]} if name in NOT_USED else set())


@pytest.mark.parametrize(("exercise", "mistake"), MISTAKES)
def test_a_known_mistake_is_no_matter_of_luck(exercise, mistake, passes):
    """On the cases of other secrets it scores less, too."""
    for seed in (b"seed100", b"seed106"):
        assert not passes(COURSE, SOLUTIONS, exercise, mistake, seed)


@pytest.mark.parametrize(
    "seed",
    [
        b"seed100",
        pytest.param(b"seed106", marks=pytest.mark.exhaustive),
        pytest.param(b"seed112", marks=pytest.mark.exhaustive),
    ],
)
@pytest.mark.parametrize(
    "exercise",
    [exercise for exercise in EXERCISES if exercise.difficulty == "open task"],
    ids=lambda exercise: exercise.name,
)
def test_an_open_task_is_no_matter_of_luck(exercise, seed):
    """On the cases of other secrets, both ways to write it score full, too."""
    other = trusted(COURSE.solutions / "otherwise" / exercise.file)
    for function in (solution(COURSE, exercise), getattr(other, exercise.name)):
        result = grade(exercise, function, seed)
        assert result["state"] == "correct", result["feedback"]


def test_every_exercise_knows_some_mistakes(exercise):
    assert len(mistakes(COURSE, exercise)) >= 3


@pytest.mark.parametrize(
    "nonsense",
    [
        None,
        0,
        -1.5,
        float("nan"),
        True,
        "text",
        [],
        [[1], [1, 2]],
        {},
        {"a": 1},
        (),
        np.zeros(0),
        np.zeros((1, 1, 1)),
    ],
    ids=repr,
)
def test_nonsense_scores_little_and_never_blames_the_grader(exercise, nonsense):
    result = grade(exercise, lambda *arguments: nonsense)
    assert result["state"] in ("wrong", "partial", "error")
    assert result["points"] < exercise.points / 2


def test_answers_of_the_right_shape_are_not_enough(exercise):
    """NaN, zeros and a far too large number in every place of the right answer."""
    function = remembered(exercise)

    def spoiled(fill):
        def spoil(value):
            if isinstance(value, tuple | list):
                return [spoil(part) for part in value]
            return np.full(np.shape(value), fill)

        return lambda *arguments: spoil(function(*arguments))

    for fill in (np.nan, 1e300, 2**62):
        result = grade(exercise, spoiled(fill))
        assert result["state"] in ("wrong", "partial")
        assert result["points"] < exercise.points / 2


def test_an_axis_too_many_is_wrong_though_it_would_broadcast(exercise):
    function = remembered(exercise)

    def widened(value):
        return (
            [widened(part) for part in value]
            if isinstance(value, tuple)
            else np.asarray(value)[..., None]
        )

    assert (
        grade(exercise, lambda *arguments: widened(function(*arguments)))["points"] == 0
    )


def test_the_solution_leaves_its_arguments_alone(exercise):
    function = solution(COURSE, exercise)

    def watched(*arguments):
        before = repr(arguments)
        answer = function(*arguments)
        assert repr(arguments) == before
        return answer

    assert grade(exercise, watched)["state"] == "correct"


def test_answers_known_by_heart_earn_nothing_on_other_cases(exercise):
    """No case is the same under every secret."""
    result, calls = public_run(exercise)
    assert result["points"] == exercise.points
    known = dict(calls)

    def repeated(*arguments):
        return known[frames.encode(list(arguments))]

    assert grade(exercise, repeated)["points"] == exercise.points
    assert grade(exercise, repeated, b"another")["points"] == 0


def test_the_public_answers_in_their_order_earn_nothing_on_other_cases(exercise):
    """As a submission would answer that counts its calls. Nothing is right whatever the case is."""
    result, calls = public_run(exercise)
    assert result["points"] == exercise.points
    answers = itertools.cycle(answer for _, answer in calls)
    repeated = grade(exercise, lambda *_: next(answers), b"another secret")
    assert repeated["points"] == 0
