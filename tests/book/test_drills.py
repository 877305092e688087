"""Drills in the page: from disk, with the network cut, by keyboard, at both widths; what is mastered is kept."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from browser import DESKTOP, PHONE, Visit, visiting
from playwright.sync_api import Locator, expect

from robonav.drills import DRILLS

PAGES_WITH_DRILLS = list(dict.fromkeys(drill.page for drill in DRILLS.values()))
# What the shown question asks; the script of the drill is loaded once more for it.
ASKED = """async (place) => {
  const { drill, source } = place.dataset;
  const questions = await new Promise((resolve) => {
    const before = globalThis.robonavDrill;
    globalThis.robonavDrill = (name, loaded) => { globalThis.robonavDrill = before; resolve(loaded); };
    document.head.append(Object.assign(document.createElement("script"), { src: source }));
  });
  return questions[place.querySelector("form").dataset.question].asked;
}"""


def open_drill(visit: Visit, name: str) -> Locator:
    """Unfold a drill by the keyboard."""
    place = visit.page.locator(f'details.drill[data-drill="{name}"]')
    place.locator("> summary").focus()
    visit.page.keyboard.press("Enter")
    expect(place.locator("form")).to_be_visible()
    return place


def give_right_answer(visit: Visit, place: Locator) -> None:
    """Answer a drill's question rightly, by the keyboard alone."""
    asked, keyboard = place.evaluate(ASKED), visit.page.keyboard
    if asked["kind"] == "number":
        place.get_by_label("Your answer").focus()
        keyboard.type(str(asked["answer"]))
    elif asked["kind"] == "choice":
        place.locator("input[type=radio]").nth(asked["right"]).focus()
        keyboard.press("Space")
    elif asked["kind"] == "place":
        place.locator(f'.place[data-place="{asked["right"][0]}"]').focus()
        keyboard.press("Enter")
    elif asked["kind"] == "order":
        for step in range(len(asked["steps"])):
            at = place.locator(".steps li").nth(step).locator("[data-step]")
            row = place.locator(f'.steps li:has([data-step="{step}"])')
            while at.get_attribute("data-step") != str(step):
                row.get_by_role("button", name="up").focus()
                keyboard.press("Enter")
    else:
        cells = [number for row in asked["answer"] for number in row]
        for field, number in zip(place.locator("td input").all(), cells, strict=True):
            field.focus()
            keyboard.type(str(number))
    place.get_by_role("button", name="Check").focus()
    keyboard.press("Enter")


def too_wide(visit: Visit) -> list[str]:
    """The open drills that are wider than their place."""
    found: list[str] = visit.page.evaluate(
        """() => [...document.querySelectorAll("details.drill[open]")]
          .filter((place) => place.scrollWidth > place.clientWidth + 1).map((place) => place.dataset.drill)"""
    )
    return found


@pytest.mark.parametrize("page_of_drills", PAGES_WITH_DRILLS)
def test_each_drill_is_answered_by_keyboard(
    visit: Visit, site: Path, page_of_drills: str
) -> None:
    """On a phone, and then each answered drill is as wide as its place on a desktop, too."""
    visit.page.set_viewport_size(PHONE)
    visit.open(f"{site.as_uri()}/book/{page_of_drills}.html")
    visit.page.evaluate("localStorage.removeItem('robonav-drills')")
    names = [drill.name for drill in DRILLS.values() if drill.page == page_of_drills]
    for name in names:
        place = open_drill(visit, name)
        give_right_answer(visit, place)
        expect(place.locator(".verdict")).to_have_text("Right.")
        expect(place.locator(".solution")).to_be_visible()
        expect(place.locator(".drill-standing")).to_contain_text("1 right in a row")
    assert too_wide(visit) == []
    visit.page.set_viewport_size(DESKTOP)
    assert too_wide(visit) == []
    assert visit.errors == []
    assert visit.external == []
    visit.page.reload()
    standings = visit.page.locator("details.drill .drill-standing")
    expect(standings).to_have_text([re.compile("1 right in a row")] * len(names))


def test_an_answer_in_another_tab_is_told_here(visit: Visit, site: Path) -> None:
    address = f"{site.as_uri()}/book/dynamic-programming.html"
    visit.open(address)
    visit.page.evaluate("localStorage.removeItem('robonav-drills')")
    with visiting(visit.page.context) as other:
        other.open(address, settled=False)
        drill = other.page.locator('details.drill[data-drill="bellman-backup"]')
        expect(drill.locator(".drill-standing")).to_have_text("not tried yet")
        give_right_answer(visit, open_drill(visit, "bellman-backup"))
        expect(drill.locator(".drill-standing")).to_contain_text("1 right in a row")


def test_a_link_unfolds_its_drill(visit: Visit, site: Path) -> None:
    address = f"{site.as_uri()}/book/dynamic-programming.html"
    visit.open(f"{address}#drill-stopping-bound")
    linked = visit.page.locator("#drill-stopping-bound")
    expect(linked.locator("form")).to_be_visible()
    expect(linked.locator("summary").first).to_be_in_viewport()
    other = visit.page.locator("#drill-bellman-backup")
    expect(other.locator("form")).to_have_count(0)
    visit.page.goto(f"{address}#drill-bellman-backup")
    expect(other.locator("form")).to_be_visible()


def test_three_in_a_row_are_mastered_and_a_mistake_begins_anew(
    visit: Visit, site: Path
) -> None:
    visit.open(f"{site.as_uri()}/book/dynamic-programming.html")
    visit.page.evaluate("localStorage.removeItem('robonav-drills')")
    place = open_drill(visit, "bellman-backup")
    for _ in range(3):
        give_right_answer(visit, place)
        expect(place.locator(".verdict")).to_have_text("Right.")
        place.get_by_role("button", name="Next question").click()
    expect(place.locator(".drill-standing")).to_contain_text("mastered; comes back")
    visit.page.goto(f"{site.as_uri()}/book/my-progress.html")
    summary = visit.page.locator(".drills-summary").first
    expect(summary).to_contain_text(f"1 of {len(DRILLS)} mastered")
    place = open_drill(visit, "bellman-backup")
    place.get_by_label("Your answer").fill("99")
    visit.page.keyboard.press("Enter")
    expect(place.locator(".verdict")).to_contain_text("No.")
    expect(place.locator(".drill-standing")).to_have_text("not mastered yet")


def test_what_is_no_number_gets_a_sentence_and_costs_nothing(
    visit: Visit, site: Path
) -> None:
    visit.open(f"{site.as_uri()}/book/dynamic-programming.html")
    visit.page.evaluate("localStorage.removeItem('robonav-drills')")
    place = open_drill(visit, "stopping-bound")
    place.get_by_label("Your answer").fill("a third")
    visit.page.keyboard.press("Enter")
    expect(place.locator(".verdict")).to_have_text("Type a number, such as 0.25.")
    expect(place.locator(".standing")).to_contain_text("not tried yet")


def test_a_drill_that_is_folded_again_at_once_still_opens_later(
    visit: Visit, site: Path
) -> None:
    visit.open(f"{site.as_uri()}/book/dynamic-programming.html")
    place = visit.page.locator('details.drill[data-drill="bellman-backup"]')
    place.evaluate("(place) => { place.open = true; place.open = false; }")
    visit.page.wait_for_timeout(100)
    expect(place.locator("form")).to_have_count(0)
    open_drill(visit, "bellman-backup")
