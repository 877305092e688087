"""Every control of every widget, on its page, from disk, on a phone: each changes what the widget shows.

Explorables have tests of their own; here each of them is drawn, and takes a guess.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from browser import PHONE, ROOT, Visit
from playwright.sync_api import Error as PlaywrightError
from playwright.sync_api import Locator, expect

WITH_WIDGETS = [
    path.stem
    for path in sorted(ROOT.glob("book/*.md"))
    if "robonav.widgets" in path.read_text("utf-8")
]
MIDDLE = """(lab) => lab.querySelectorAll(".player input").forEach((track) => {
  track.value = Math.ceil(track.max / 2);
  track.dispatchEvent(new Event("input"));
})"""
SHOWN = """(lab) => [
  ...[...lab.querySelectorAll("p, td, figcaption, .values, .fields, .player button")].map((text) => text.outerHTML),
  ...[...lab.querySelectorAll("svg:not(button svg)")].map((picture) => picture.outerHTML),
  ...[...lab.querySelectorAll("canvas")].map((picture) => picture.toDataURL()),
  ...[...lab.querySelectorAll("details")].map((fold) => fold.open),
].join()"""
CHANGED = f"([lab, before]) => ({SHOWN})(lab) !== before"
NEXT_STEP = (
    "door sensor",
    "wheels",
    "speed",
    "steps a second",
)  # set what is shown from the next step on


@contextmanager
def something_changes(lab: Locator, control: str) -> Iterator[None]:
    """Fails if the widget shows the same afterwards."""
    lab.evaluate(MIDDLE)
    before = lab.evaluate(SHOWN)
    yield
    try:
        lab.page.wait_for_function(CHANGED, arg=[lab.element_handle(), before])
    except PlaywrightError as error:
        raise AssertionError(f"{control} changes nothing") from error


def visible(lab: Locator, what: str) -> list[Locator]:
    return [
        control
        for control in lab.locator(what).all()
        if control.is_visible() and control.is_enabled()
    ]


def choose_everything(lab: Locator) -> None:
    """The last choice of every list, and the first again."""
    for chooser in visible(lab, "select"):
        name = chooser.get_attribute("aria-label")
        if name in NEXT_STEP:
            continue
        count, first = (
            chooser.locator("option").count(),
            chooser.evaluate("(list) => list.selectedIndex"),
        )
        for index in (0 if first == count - 1 else count - 1, first):
            with something_changes(lab, f"choice {index} of {name}"):
                chooser.select_option(index=index)


def slide_everything(lab: Locator) -> None:
    """Every slider to its ends."""
    for slider in visible(lab, "input[type=range]"):
        name = slider.get_attribute("aria-label")
        for key in ("End", "Home") if name not in NEXT_STEP else ():
            with something_changes(lab, f"{key} of {name}"):
                slider.press(key)


def press_everything(lab: Locator) -> None:
    """Every button, tick and fold; a second time where the name changes, as from Play to Pause."""
    for button in visible(lab, "button, input[type=checkbox], summary"):
        if button.is_disabled() or "Download" in button.inner_text():
            continue
        with something_changes(
            lab, button.get_attribute("aria-label") or button.inner_text()
        ):
            button.click()
        if (
            button.get_attribute("aria-label") == "Pause"
            or button.inner_text() == "Pause"
        ):
            button.click()


OPENED = """(lab) => lab.querySelectorAll("details:not([open])").forEach((fold) => {
  fold.dataset.folded = "";
  fold.open = true;
})"""
FOLDED_AGAIN = "(lab) => lab.querySelectorAll('[data-folded]').forEach((fold) => { fold.open = false; })"
SMALL = """(lab) => {
  const seen = (part) => part.checkVisibility() && part.getBoundingClientRect().width > 0;
  const faults = [];
  for (const text of lab.querySelectorAll("svg text")) {
    const { a, b } = text.getScreenCTM();
    const size = parseFloat(getComputedStyle(text).fontSize) * Math.hypot(a, b);
    if (seen(text) && text.textContent.trim() && size < 9) faults.push(`${text.textContent}: ${size.toFixed(1)} px`);
  }
  for (const control of lab.querySelectorAll("button, select, input, summary, a[href]")) {
    const target = ["radio", "checkbox"].includes(control.type) ? control.closest("label") : control;
    const { width, height } = target.getBoundingClientRect();
    if (seen(control) && Math.min(width, height) < 24) faults.push(`${control.outerHTML}: ${width} x ${height} px`);
  }
  return faults;
}"""
"""Words in pictures of less than nine pixels, and controls of less than 24."""


@pytest.mark.parametrize("page", WITH_WIDGETS)
def test_controls_are_large_enough_and_each_does_something(
    visit: Visit, site: Path, page: str
) -> None:
    visit.page.set_viewport_size(PHONE)
    visit.leave_formulas()
    visit.open(f"{site.as_uri()}/book/{page}.html")
    for lab in visit.page.locator(".robonav:not(.explorable)").all():
        lab.evaluate(OPENED)
        assert lab.evaluate(SMALL) == []
        lab.evaluate(FOLDED_AGAIN)
        choose_everything(lab)
        slide_everything(lab)
        press_everything(lab)
    for asked in visit.page.locator(".explorable").all():
        asked.locator(".guess input").first.check(force=True)
        expect(asked.locator(".guess .told")).to_contain_text("try it")
    assert visit.errors == []
