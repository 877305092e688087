"""Every explorable, from disk, with no network: by keyboard and by touch, its looks and its accessibility."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import yaml
from accessibility import AXE, RUN
from browser import DESKTOP, PHONE, ROOT, Visit, tap
from mounting import mounted_alone
from playwright.sync_api import Locator, expect

from robonav.widgets.explorables import EXPLORABLES, explorable

PICTURES = ROOT / "_build" / "widgets"
SHOWN = """(widget) => [
  ...[...widget.querySelectorAll(".status, .sum, td")].map((text) => text.textContent),
  ...[...widget.querySelectorAll("svg:not(button svg)")].map((picture) => picture.outerHTML),
  ...[...widget.querySelectorAll("canvas")].map((picture) => picture.toDataURL()),
].join()"""
SEGMENTS = "fieldset.segments:not(.guess *)"
CHANGED = f"([widget, before]) => ({SHOWN})(widget) !== before"


@contextmanager
def something_changes(widget: Locator, control: str) -> Iterator[None]:
    """Fails if pictures and text are the same afterwards."""
    before = widget.evaluate(SHOWN)
    yield
    try:
        arguments = [widget.element_handle(), before]
        widget.page.wait_for_function(CHANGED, arg=arguments, timeout=3_000)
    except Exception as error:
        raise AssertionError(f"{control} changes nothing") from error


def reset(widget: Locator) -> None:
    widget.get_by_role("button", name="Reset", exact=True).click()


def buttons(widget: Locator) -> list[Locator]:
    """Its buttons that can be pressed now, without Reset."""
    return [
        button
        for button in widget.locator("button").all()
        if button.inner_text() != "Reset" and button.is_enabled()
    ]


@pytest.mark.parametrize("name", EXPLORABLES)
def test_by_keyboard_on_a_desktop(visit: Visit, name: str) -> None:
    visit.page.set_viewport_size(DESKTOP)
    widget = mounted_alone(visit, explorable(name))
    first = widget.evaluate(SHOWN)
    for slider in widget.locator("input[type=range]").all():
        for key in ("End", "Home"):
            with something_changes(widget, f"{key} of {slider}"):
                slider.press(key)
        reset(widget)
    for group in widget.locator(SEGMENTS).all():
        chosen = group.locator("input:checked")
        with something_changes(widget, f"arrows on {group}"):
            (chosen if chosen.count() else group.locator("input").first).press(
                "ArrowRight"
            )
    for number in widget.locator("input[type=number]").all():
        with something_changes(widget, f"number {number}"):
            number.press("ArrowDown")
            number.press("Tab")
    for button in buttons(widget):
        reset(widget)
        if button.is_enabled():
            with something_changes(widget, f"button {button.inner_text()}"):
                button.press("Enter")
    reset(widget)
    for picture in widget.locator("[data-keys]").all():
        for key in (picture.get_attribute("data-keys") or "").split():
            with something_changes(widget, f"{key} on {picture}"):
                picture.press(key)
    reset(widget)
    assert widget.evaluate(SHOWN) == first
    assert visit.errors == visit.external == []


def touch(control: Locator, share: float = 0.5) -> None:
    """Tap a control, at a share of its width."""
    control.scroll_into_view_if_needed()
    box = control.bounding_box()
    assert box is not None
    tap(control.page, box["x"] + share * box["width"], box["y"] + box["height"] / 2)


@pytest.mark.parametrize("name", EXPLORABLES)
def test_by_touch_on_a_phone(visit: Visit, name: str) -> None:
    visit.page.set_viewport_size(PHONE)
    widget = mounted_alone(visit, explorable(name))
    for slider in widget.locator("input[type=range]").all():
        reset(widget)
        for share in (0.93, 0.07):
            with something_changes(widget, f"touching {slider}"):
                touch(slider, share)
    for group in widget.locator(SEGMENTS).all():
        reset(widget)
        with something_changes(widget, f"touching {group}"):
            touch(group.locator("label:not(:has(:checked))").last)
    for button in buttons(widget):
        reset(widget)
        if button.is_enabled():
            with something_changes(widget, f"touching {button.inner_text()}"):
                touch(button)
    for part in widget.locator("[data-touch]").all():
        reset(widget)
        with something_changes(widget, f"touching {part}"):
            touch(part)
    width = visit.page.evaluate("document.documentElement.scrollWidth")
    assert width <= PHONE["width"]
    assert visit.errors == visit.external == []


def move_something(widget: Locator) -> None:
    """Use the first control there is."""
    slider = widget.locator("input[type=range]")
    if slider.count():
        slider.first.press("ArrowRight")
        slider.first.press("ArrowLeft")
    elif widget.locator(SEGMENTS).count():
        group = widget.locator(SEGMENTS).first
        group.locator("input:checked").press("ArrowRight")
    elif buttons(widget):
        buttons(widget)[0].press("Enter")
    else:
        picture = widget.locator("[data-keys]").first
        picture.press((picture.get_attribute("data-keys") or "").split()[0])


@pytest.mark.parametrize("name", EXPLORABLES)
def test_a_guess_is_judged_after_something_was_moved(visit: Visit, name: str) -> None:
    """By keyboard, for every guess; what is said is in a live region, which screen readers speak."""
    visit.page.set_viewport_size(PHONE)
    asked = EXPLORABLES[name]
    widget = mounted_alone(visit, explorable(name))
    guess = widget.locator(".guess")
    told, ask = guess.get_by_role("status"), guess.get_by_role("button")
    guess.get_by_role("radio", name=asked.guesses[0], exact=True).press("Space")
    assert "try it" in told.inner_text()
    assert ask.is_disabled()
    move_something(widget)
    ask.press("Enter")
    for number, own in enumerate(asked.guesses):
        if number:
            guess.locator("input:checked").press("ArrowRight")
        verdict = "is right" if own == asked.right else "is not right"
        assert told.inner_text().startswith(f"Your guess “{own}” {verdict}")
        assert f"“{asked.right}”" in told.inner_text()
        assert asked.because in told.inner_text()
    assert visit.errors == []


@pytest.mark.parametrize("name", ["turn_arrows", "pocket"])
def test_opening_the_answer_judges_the_guess(
    visit: Visit, site: Path, name: str
) -> None:
    visit.page.set_viewport_size(PHONE)
    (page,) = [page for page in ROOT.glob("book/*.md") if asked_on(page, name=name)]
    visit.open(f"{site.as_uri()}/book/{page.stem}.html")
    asked = EXPLORABLES[name]
    widget = visit.page.locator(".explorable", has_text=asked.question)
    told = widget.locator(".guess").get_by_role("status")
    summary = visit.page.locator(
        f".cell:has(.explorable[aria-label='{asked.title}']) + details > summary"
    )
    summary.press("Enter")
    expect(told).to_have_text(f"The answer is “{asked.right}”. {asked.because}")
    wrong = next(own for own in asked.guesses if own != asked.right)
    widget.get_by_role("radio", name=wrong, exact=True).check(force=True)
    expect(told).to_contain_text("is not right")


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("name", EXPLORABLES)
def test_looks_and_accessibility(visit: Visit, name: str, theme: str) -> None:
    PICTURES.mkdir(parents=True, exist_ok=True)
    for size in (DESKTOP, PHONE):
        visit.page.set_viewport_size(size)
        widget = mounted_alone(visit, explorable(name), theme=theme)
        widget.screenshot(path=PICTURES / f"{name}-{theme}-{size['width']}.png")
        visit.page.evaluate(AXE.read_text("utf-8"))
        assert visit.page.evaluate(RUN) == []
        assert small_words(widget) == []
        assert widget.evaluate(FAULTS) == []


FAULTS = """(widget) => {
  const faults = [];
  for (const picture of widget.querySelectorAll("svg:not(button svg)")) {
    const frame = picture.getBoundingClientRect();
    const texts = [...picture.querySelectorAll("text")].filter((text) => text.textContent.trim());
    const boxes = texts.map((text) => text.getBoundingClientRect());
    boxes.forEach((box, i) => {
      for (const arrow of picture.querySelectorAll(".arrow")) {
        const other = arrow.getBoundingClientRect();
        const across = Math.min(box.right, other.right) - Math.max(box.left, other.left);
        const down = Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top);
        if (across > 2 && down > 4) faults.push(`arrow over ${texts[i].textContent}`);
      }
      const across = box.left > frame.left - 2 && box.right < frame.right + 2;
      const down = box.top > frame.top - 3 && box.bottom < frame.bottom + 3;
      if (!across || !down) faults.push(`clipped: ${texts[i].textContent}`);
      boxes.slice(i + 1).forEach((other, k) => {
        const across = Math.min(box.right, other.right) - Math.max(box.left, other.left);
        const down = Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top);
        if (across > 2 && down > 4) faults.push(`overlap: ${texts[i].textContent}, ${texts[i + 1 + k].textContent}`);
      });
    });
  }
  for (const control of widget.querySelectorAll("button, input, [tabindex]")) {
    const { width, height } = (control.type === "radio" ? control.closest("label") : control).getBoundingClientRect();
    if (width < 24 || height < 24) faults.push(`small: ${control.outerHTML}`);
  }
  return faults;
}"""
"""Texts of pictures that are cut off or overlap, and controls of less than 24 pixels."""


def small_words(widget: Locator) -> list[str]:
    """Words in pictures that are smaller than ten pixels on this screen."""
    return widget.locator("svg text").evaluate_all(
        "(texts) => texts.filter((text) => text.textContent && parseFloat(getComputedStyle(text).fontSize)"
        " * Math.hypot(text.getScreenCTM().a, text.getScreenCTM().b) < 10).map((text) => text.textContent)"
    )


@pytest.mark.parametrize("name", EXPLORABLES)
def test_is_small_and_on_one_page_with_its_answer_folded(name: str) -> None:
    widget = explorable(name)
    assert len(widget._esm) + len(str(widget.data)) < 100_000
    cells = [
        cell for page in ROOT.glob("book/*.md") for cell in asked_on(page, name=name)
    ]
    assert len(cells) == 1


def asked_on(page: Path, name: str = r"\w+") -> list[str]:
    """The explorables on a page whose answers are folded below them."""
    cell = (
        rf"""explorable\("({name})"[^)]*\)\n(?:\w+\n)?```\n\n```{{dropdown}} Answer\n"""
    )
    return re.findall(cell, page.read_text("utf-8"))


def chapter_pages() -> list[str]:
    """The pages of chapters 2 to 6 that teach, without exercises and results."""
    parts = yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))["parts"]
    files = [
        chapter["file"]
        for part in parts
        if re.match(r"Chapter [2-5]|Beyond the thesis", part["caption"])
        for chapter in part["chapters"]
    ]
    return [file for file in files if "exercises" not in file]


@pytest.mark.parametrize("page", chapter_pages())
def test_every_page_of_a_chapter_asks_twice_or_more(page: str) -> None:
    assert len(asked_on(ROOT / f"{page}.md")) >= 2
