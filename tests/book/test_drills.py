"""Drills in the page: from disk, with no network, by keyboard on both screens, by touch; what is mastered is kept."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

import pytest
from answering import (
    Hand,
    Keyboard,
    asked_by,
    drill_of,
    finger_on,
    give,
    open_drill,
    questions_of,
    right_answer,
    shown_by,
    wrong_answer,
)
from browser import DESKTOP, PHONE, Visit, empty_storage, visiting
from playwright.sync_api import Locator, expect

from robonav.drills import DRILLS

PAGES_WITH_DRILLS = list(dict.fromkeys(drill.page for drill in DRILLS.values()))
FORMULA_OR_TAG = re.compile(r"\\\(.*?\\\)|<[^>]+>", re.DOTALL)


def words(text: str) -> list[str]:
    """The words of a text of a page, without its formulas."""
    return unescape(FORMULA_OR_TAG.sub("", text)).split()


def answer_wrongly_and_rightly(hand: Hand, drill: Locator, name: str) -> None:
    """Make a usual mistake, read its hint, and then answer the same question rightly."""
    shown = shown_by(drill)
    asked = questions_of(name)[shown["question"]]
    mistake, hint = wrong_answer(asked, shown["steps"])
    give(hand, drill, asked, mistake)
    shown = shown_by(drill)
    assert words(shown["verdict"]) == ["No.", *words(hint)]
    assert not shown["solved"]
    give(hand, drill, asked, right_answer(asked))
    shown = shown_by(drill)
    assert (shown["verdict"], shown["solved"]) == ("Right.", True)
    assert shown["standing"] == "not mastered yet"  # the first answer counts
    assert shown["overhang"] <= 1, (name, shown)


@pytest.mark.parametrize("page_of_drills", PAGES_WITH_DRILLS)
def test_each_drill_is_answered_by_keyboard_and_by_touch(
    visit: Visit, site: Path, page_of_drills: str
) -> None:
    visit.page.set_viewport_size(DESKTOP)
    visit.open(f"{site.as_uri()}/book/{page_of_drills}.html")
    empty_storage(visit.page)
    names = [drill.name for drill in DRILLS.values() if drill.page == page_of_drills]
    drills = {name: drill_of(visit, name) for name in names}
    keyboard = Keyboard(visit.page)
    for name, drill in drills.items():
        open_drill(keyboard, drill)
        answer_wrongly_and_rightly(keyboard, drill, name)
    visit.page.set_viewport_size(PHONE)
    for drill in drills.values():
        keyboard.press(drill.get_by_role("button", name="Next question"))
        asked = asked_by(drill)
        give(keyboard, drill, asked, right_answer(asked))
        shown = shown_by(drill)
        assert (shown["verdict"], shown["solved"]) == ("Right.", True)
    finger = finger_on(visit.page)
    for name, drill in drills.items():
        finger.press(drill.get_by_role("button", name="Next question"))
        answer_wrongly_and_rightly(finger, drill, name)
    assert visit.errors == []
    assert visit.external == []
    kept = visit.page.evaluate("JSON.parse(localStorage.getItem('robonav-drills'))")
    assert {name: record["wrong"] for name, record in kept.items()} == dict.fromkeys(names, 2)  # fmt: skip


def open_unset(visit: Visit, address: str) -> None:
    """Open a page without setting its formulas and drawing its widgets, and forget all drills."""
    visit.leave_formulas()
    visit.open(address, settled=False)
    empty_storage(visit.page)


def begun(visit: Visit, name: str) -> Locator:
    """A drill that was unfolded by the keyboard."""
    drill = drill_of(visit, name)
    open_drill(Keyboard(visit.page), drill)
    return drill


def give_right_answer(visit: Visit, drill: Locator) -> None:
    """Answer a drill's question rightly, by the keyboard alone."""
    asked = asked_by(drill)
    give(Keyboard(visit.page), drill, asked, right_answer(asked))


def test_an_answer_in_another_tab_is_told_here(visit: Visit, site: Path) -> None:
    address = f"{site.as_uri()}/book/dynamic-programming.html"
    open_unset(visit, address)
    with visiting(visit.page.context) as other:
        other.open(address, settled=False)
        drill = other.page.locator('details.drill[data-drill="bellman-backup"]')
        expect(drill.locator(".drill-standing")).to_have_text("not tried yet")
        give_right_answer(visit, begun(visit, "bellman-backup"))
        expect(drill.locator(".drill-standing")).to_contain_text("1 right in a row")


def test_a_link_unfolds_its_drill(visit: Visit, site: Path) -> None:
    address = f"{site.as_uri()}/book/dynamic-programming.html"
    open_unset(visit, f"{address}#drill-stopping-bound")
    linked = visit.page.locator("#drill-stopping-bound")
    expect(linked.locator("form")).to_be_visible()
    expect(linked.locator("summary").first).to_be_in_viewport()
    other = visit.page.locator("#drill-bellman-backup")
    expect(other.locator("form")).to_have_count(0)
    visit.page.goto(f"{address}#drill-bellman-backup")
    expect(other.locator("form")).to_be_visible()


def tab_to(visit: Visit, element: Locator) -> None:
    """Press Tab until an element has the focus."""
    for _ in range(12):
        visit.page.keyboard.press("Tab")
        if element.evaluate("(element) => element === document.activeElement"):
            return
    raise AssertionError(f"Tab does not reach {element}")


def test_three_in_a_row_are_mastered_with_the_keys_alone(
    visit: Visit, site: Path
) -> None:
    open_unset(visit, f"{site.as_uri()}/book/dynamic-programming.html")
    visit.page.get_by_text("Each drill asks with new numbers").click()  # above them
    drill = drill_of(visit, "bellman-backup")
    tab_to(visit, drill.locator("> summary"))
    visit.page.keyboard.press("Enter")
    verdict = drill.locator(".verdict")
    for _ in range(3):
        expect(verdict).to_be_attached()  # the question is drawn
        expect(verdict).to_be_empty()  # and it is a new one
        asked = asked_by(drill)
        tab_to(visit, drill.get_by_label("Your answer"))
        visit.page.keyboard.type(str(right_answer(asked)))
        visit.page.keyboard.press("Enter")
        expect(verdict).to_have_text("Right.")
        tab_to(visit, drill.get_by_role("button", name="Next question"))
        visit.page.keyboard.press("Enter")
        expect(drill.get_by_label("Your answer")).to_be_focused()
        visit.page.keyboard.press("Shift+Tab")
    expect(drill.locator(".drill-standing")).to_contain_text("mastered; comes back")


KEPT = """localStorage.setItem("robonav-drills", JSON.stringify({
  "bellman-backup": { streak: 3, right: 3, wrong: 0, due: "2999-01-01" },
  "stopping-bound": { streak: 3, right: 4, wrong: 1, due: "2020-02-02" },
  "softmax": { streak: 0, right: 0, wrong: 1, due: "2020-01-01" },
}))"""


def test_the_page_of_progress_lists_what_is_due(visit: Visit, site: Path) -> None:
    open_unset(visit, f"{site.as_uri()}/book/my-progress.html")
    due = visit.page.locator(".drills-due")
    expect(due).to_contain_text("because you have not tried any drill yet")
    visit.page.evaluate(KEPT)
    visit.page.reload()
    summary = visit.page.locator(".drills-summary").first
    expect(summary).to_contain_text(f"2 of {len(DRILLS)} mastered, 2 due today")
    titles = [DRILLS[name].title for name in ("softmax", "stopping-bound")]
    expect(due.get_by_role("link")).to_have_text(titles)
    expect(due.get_by_role("listitem").first).to_contain_text("(not mastered yet)")
    due.get_by_role("link").last.press("Enter")
    drill = drill_of(visit, "stopping-bound")
    expect(drill.locator("form")).to_be_visible()
    expect(drill.locator("> summary")).to_be_in_viewport()
    give_right_answer(visit, drill)
    expect(due.get_by_role("link")).to_have_text(titles[:1])
    drill = begun(visit, "bellman-backup")
    drill.get_by_label("Your answer").fill("99")
    visit.page.keyboard.press("Enter")
    expect(drill.locator(".verdict")).to_contain_text("No.")
    expect(drill.locator(".drill-standing")).to_have_text("not mastered yet")
    expect(due.get_by_role("link").last).to_have_text(DRILLS["bellman-backup"].title)


def test_what_is_no_number_gets_a_sentence_and_costs_nothing(
    visit: Visit, site: Path
) -> None:
    open_unset(visit, f"{site.as_uri()}/book/dynamic-programming.html")
    place = begun(visit, "stopping-bound")
    place.get_by_label("Your answer").fill("a third")
    visit.page.keyboard.press("Enter")
    expect(place.locator(".verdict")).to_have_text("Type a number, such as 0.25.")
    expect(place.locator(".standing")).to_contain_text("not tried yet")


def test_a_drill_that_is_folded_again_at_once_still_opens_later(
    visit: Visit, site: Path
) -> None:
    open_unset(visit, f"{site.as_uri()}/book/dynamic-programming.html")
    place = visit.page.locator('details.drill[data-drill="bellman-backup"]')
    place.evaluate("(place) => { place.open = true; place.open = false; }")
    visit.page.wait_for_timeout(100)
    expect(place.locator("form")).to_have_count(0)
    begun(visit, "bellman-backup")
