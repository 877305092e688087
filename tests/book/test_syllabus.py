"""The syllabus's pages show all sessions, with their headline, and all goals."""

from __future__ import annotations

import html
import re
from pathlib import Path

import pytest
import syllabus

from robonav.grading.course import Course


def article(site: Path, page: str) -> str:
    """The text of a built page, without its tags."""
    source = (site / "book" / f"{page}.html").read_text("utf-8")
    inside = re.search(r"<article\b.*?</article>", source, re.DOTALL)
    assert inside
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", inside[0])).split()).replace(
        "’", "'"
    )


@pytest.mark.parametrize(
    ("page", "name"), [("syllabus", "weeks"), ("syllabus-five-days", "days")]
)
def test_headline_and_sessions_are_shown(site: Path, page: str, name: str) -> None:
    text, plan = article(site, page), syllabus.plan(name)
    assert syllabus.headline(plan, Course.of_book()) in text
    for number, session in enumerate(plan.sessions, 1):
        assert f"{plan.unit} {number}: {session.title}" in text
        assert session.purpose in text


def test_plain_goals_are_shown(site: Path) -> None:
    text = article(site, "syllabus")
    plain = [
        goal.text for goal in syllabus.goals() if not set(goal.text) & set("$`*\\'\"")
    ]
    assert len(plain) > 80
    for goal in plain:
        assert goal[1:] in text
