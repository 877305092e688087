"""Each goal is practised, each drill and exercise serves a goal, and the courses' sessions add up."""

from __future__ import annotations

from collections import Counter

import make_slides
import pytest
import syllabus
import yaml

from robonav.drills import DRILLS
from robonav.grading.course import Course

COURSE = Course.around()
PLANS = {name: syllabus.plan(name) for name in ("weeks", "days")}
both_plans = pytest.mark.parametrize("name", PLANS)


def chapter_pages() -> list[str]:
    """The pages of the chapters, in the order of the table of contents."""
    contents = yaml.safe_load((syllabus.ROOT / "_toc.yml").read_text("utf-8"))
    return [
        entry["file"].removeprefix("book/")
        for part in contents["parts"]
        if part["caption"].startswith("Chapter")
        for entry in part["chapters"]
    ]


def later_pages() -> list[str]:
    """The pages beyond the thesis."""
    contents = yaml.safe_load((syllabus.ROOT / "_toc.yml").read_text("utf-8"))
    return [
        entry["file"].removeprefix("book/")
        for part in contents["parts"]
        if part["caption"].startswith("Beyond the thesis")
        for entry in part["chapters"]
    ]


def test_goals_are_those_of_the_pages_in_their_order() -> None:
    listed = [(goal.page, goal.text) for goal in syllabus.goals()]
    expected = [
        (page, text)
        for page in chapter_pages() + later_pages()
        for text in syllabus.goals_on(page)
    ]
    assert listed == expected
    without = [page for page in chapter_pages() if not syllabus.goals_on(page)]
    assert without == ["playground"]


def test_each_goal_is_practised() -> None:
    assert [
        goal.id for goal in syllabus.goals() if not goal.drills + goal.exercises
    ] == []


def test_each_drill_and_each_exercise_serves_a_goal() -> None:
    goals = syllabus.goals()
    assert {drill for goal in goals for drill in goal.drills} == set(DRILLS)
    assert {name for goal in goals for name in goal.exercises} == set(COURSE.exercises)


def test_no_goal_names_anything_twice() -> None:
    for goal in syllabus.goals():
        for names in (goal.drills, goal.exercises):
            assert len(names) == len(set(names)), goal.id


def test_each_chapter_page_has_a_deck() -> None:
    """A page of chapter 6 may say instead why it is no lecture."""
    lectures = {page for part in make_slides.lectures().values() for page in part}
    reasons = make_slides.without_deck()
    assert set(chapter_pages()) <= lectures
    assert set(later_pages()) <= lectures | set(reasons)
    assert lectures.isdisjoint(reasons)
    assert set(reasons) == set(make_slides.WITHOUT_DECK)


def test_a_page_without_a_deck_and_without_a_reason_stops_the_slides(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    marked = make_slides.has_marks
    monkeypatch.setattr(make_slides, "has_marks", lambda name: marked(name) and name != "memory")  # fmt: skip
    every = [page for part in make_slides.lectures().values() for page in part]
    assert make_slides.make(every) == 1
    assert "no slides are marked in memory: mark them" in capsys.readouterr().err


def test_further_lectures_follow_a_page_of_a_session() -> None:
    lectures = {page for part in make_slides.lectures().values() for page in part}
    pages = [page for session in PLANS["weeks"].sessions for page in session.pages]
    for one in syllabus.further():
        assert one.page in lectures
        assert one.page not in pages
        assert one.after in pages
        assert f"`{one.page}.html` (45 min)" in syllabus.further_text(PLANS["weeks"])


@both_plans
def test_each_chapter_page_and_each_deck_occurs(name: str) -> None:
    sessions = PLANS[name].sessions
    pages = [page for session in sessions for page in session.pages]
    lectures = {page for part in make_slides.lectures().values() for page in part}
    further = {one.page for one in syllabus.further()}
    assert lectures <= set(pages) | further
    assert len(pages) == len(set(pages))
    decks = [d for session in sessions for d in session.lecture + session.long_lecture]
    assert sorted(decks) == sorted(lectures - further - {"playground"})
    for session in sessions:
        assert set(session.lecture + session.long_lecture) <= set(session.pages)


@both_plans
def test_minutes_add_up(name: str) -> None:
    plan = PLANS[name]
    for session in plan.sessions:
        assert session.minutes.keys() == plan.minutes.keys()
        assert sum(session.minutes.values()) == plan.session_minutes, session.title
        assert session.lecture_minutes == session.minutes["lecture"], session.title
        lab = syllabus.minutes_of(session.lab, COURSE)
        assert 0 < lab <= session.minutes["lab"], session.title
    total = sum(sum(session.minutes.values()) for session in plan.sessions)
    words = syllabus.headline(plan, COURSE)
    assert words.startswith(f"{len(plan.sessions)} {plan.unit.lower()}s of ")
    assert f"{total / 60:g} hours in class" in words


def test_the_headlines_are_those_of_the_pages_titles() -> None:
    assert [len(PLANS[name].sessions) for name in ("weeks", "days")] == [12, 5]
    assert [PLANS[name].total_minutes for name in ("weeks", "days")] == [2160, 1800]


@both_plans
def test_drills_in_class_belong_to_the_session_s_pages(name: str) -> None:
    plan = PLANS[name]
    for session in plan.sessions:
        assert {DRILLS[drill].page for drill in session.class_drills} <= set(
            session.pages
        )
        for drill in session.class_drills:
            assert 3 * len(session.class_drills) <= session.minutes["drills"], drill


@both_plans
def test_each_session_has_example_questions_of_its_pages(name: str) -> None:
    plan = PLANS[name]
    for number, session in enumerate(plan.sessions, 1):
        assert len(session.exam_drills) == 2, session.title
        text = syllabus.session_text(number, session, plan, COURSE)
        for drill in (DRILLS[one] for one in session.exam_drills):
            question = drill.question(syllabus.EXAM)
            assert drill.page in session.pages, (session.title, drill.name)
            assert not question.picture, drill.name  # the text says all
            assert question.text in text
            assert f'href="{drill.page}.html#drill-{drill.name}"' in text
        assert f"{session.written['question']} *Expected:* " in text
        assert session.written["answer"] in text


@both_plans
def test_no_exercise_comes_twice_or_before_its_page(name: str) -> None:
    seen: set[str] = set()
    done: Counter[str] = Counter()
    for session in PLANS[name].sessions:
        seen |= set(session.pages)
        for exercise in session.lab + session.homework:
            done[exercise] += 1
            assert COURSE.exercises[exercise].page in seen, exercise
    assert set(done.values()) == {1}
    if name == "weeks":
        assert set(done) == set(COURSE.exercises)
    open_tasks = {
        e.id for e in COURSE.exercises.values() if e.difficulty == "open task"
    }
    assert open_tasks <= set(done)  # in both courses


@both_plans
def test_homework_is_spread_over_the_sessions(name: str) -> None:
    """Each week has homework, and no week or evening of the five days more than 225 minutes."""
    for session in PLANS[name].sessions:
        home = syllabus.minutes_of(session.homework, COURSE)
        assert home <= 225, (session.title, home)
        assert name == "days" or home > 0, session.title


def test_each_page_shows_what_the_tables_say() -> None:
    plan = PLANS["weeks"]
    text = syllabus.session_text(1, plan.sessions[0], plan, COURSE)
    assert "## Week 1: A robot that moves" in text
    assert "{doc}`/book/playground`" in text
    assert "{ref}`2.9 Drive the robot <exercise-2-9>` (60 min)" in text
    goals = syllabus.goals_text(COURSE)
    assert goals.count("\n- ") == len(syllabus.goals())


def test_a_goal_that_no_page_has_is_reported() -> None:
    with pytest.raises(ValueError, match='0 goals of the page robot begin with "fly"'):
        syllabus._full_text("robot", "fly")
