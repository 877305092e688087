"""Self-check questions answer to a hand and to the keyboard, with no script."""

from __future__ import annotations

import notebooks
import pytest
import quiz
from browser import PHONE, Visit
from playwright.sync_api import expect

CONTENT = """What is $1 + 1$?

- [ ] One

  Count again.
- [x] Two

  So it is,
  every time.
"""


def test_marks_are_taken_out_of_the_list() -> None:
    text, right = quiz.marks(CONTENT)
    assert right == [False, True]
    assert "[" not in text.partition("?")[2]


def test_a_quiz_opens_in_a_notebook_too() -> None:
    plain = notebooks.plain(f"Before.\n\n```{{quiz}}\n{CONTENT}```\n\nAfter.")
    assert "**Check yourself.** What is $1 + 1$?" in plain
    assert (
        "<details><summary>One</summary>\n\n**No.** Count again.\n\n</details>" in plain
    )
    assert (
        "<details><summary>Two</summary>\n\n**Right.** So it is,\nevery time.\n\n</details>"
        in plain
    )
    assert "[x]" not in plain


@pytest.mark.parametrize("page", ["dynamic-programming", "playground", "robot"])
def test_each_answer_says_whether_it_is_right_and_why(
    visit: Visit, http: str, page: str
) -> None:
    visit.page.set_viewport_size(PHONE)
    visit.leave_formulas()
    visit.open(f"{http}/book/{page}.html")
    questions = visit.page.locator(".quiz")
    expect(questions).not_to_have_count(0)
    for question in questions.all():
        expect(question.locator("details.right")).to_have_count(1)
        for place, answer in enumerate(question.locator("details").all()):
            summary = answer.locator("summary")
            if place % 2:
                summary.focus()
                visit.page.keyboard.press("Enter")
            else:
                summary.click()
            verdict = (
                "Right." if "right" in (answer.get_attribute("class") or "") else "No."
            )
            expect(answer.locator("p").first).to_be_visible()
            expect(answer.locator("strong").first).to_have_text(verdict)
    assert visit.errors == []
