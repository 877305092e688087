"""Every explorable, from disk, with no network: by keyboard and by touch, its looks and its accessibility."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml
from accessibility import AXE, COLOURS, RUN
from browser import DESKTOP, PHONE, ROOT, Visit
from explorables.expected import EXPECTED
from explorables.reader import SEGMENTS, Finger, Keyboard, Reader, touch
from mounting import mounted_alone
from playwright.sync_api import Locator, expect

from robonav.widgets.explorables import EXPLORABLES, explorable

PICTURES = ROOT / "_build" / "widgets"


def test_every_explorable_is_compared_with_python() -> None:
    assert EXPECTED.keys() == EXPLORABLES.keys()


@pytest.mark.parametrize("name", EXPLORABLES)
def test_by_keyboard_on_a_desktop(visit: Visit, name: str) -> None:
    """Each control does something, and what is shown then is what Python computes; see ``explorables``."""
    visit.page.set_viewport_size(DESKTOP)
    reader = Reader(visit, name, Keyboard())
    widget = reader.widget
    for slider in reader.sliders():
        for key in ("End", "Home"):
            with reader.doing(f"{key} of {slider}"):
                slider.press(key)
        reader.reset()
    for group in widget.locator(SEGMENTS).all():
        chosen = group.locator("input:checked")
        with reader.doing(f"arrows on {group}"):
            (chosen if chosen.count() else group.locator("input").first).press(
                "ArrowRight"
            )
    for number in widget.locator("input[type=number]").all():
        with reader.doing(f"number {number}"):
            number.press("ArrowDown")
            number.press("Tab")
    for button in reader.buttons():
        reader.reset()
        if button.is_enabled():
            with reader.doing(button.inner_text()):
                button.press("Enter")
    reader.reset()
    for picture in widget.locator("[data-keys]").all():
        for key in (picture.get_attribute("data-keys") or "").split():
            with reader.doing(key):
                picture.press(key)
    reader.reset()
    for move in EXPECTED[name].by_keyboard:
        move(reader)
    assert visit.errors == visit.external == []


@pytest.mark.parametrize("name", EXPLORABLES)
def test_by_touch_on_a_phone(visit: Visit, name: str) -> None:
    """As by keyboard."""
    visit.page.set_viewport_size(PHONE)
    reader = Reader(visit, name, Finger())
    widget = reader.widget
    for slider in reader.sliders():
        reader.reset()
        for share in (0.93, 0.07):
            with reader.doing(f"touching {slider}"):
                touch(slider, share)
    for group in widget.locator(SEGMENTS).all():
        reader.reset()
        with reader.doing(f"touching {group}"):
            touch(group.locator("label:not(:has(:checked))").last)
    for button in reader.buttons():
        reader.reset()
        if button.is_enabled():
            with reader.doing(button.inner_text()):
                touch(button)
    for part in widget.locator("[data-touch]").all():
        reader.reset()
        with reader.doing("touch"):
            touch(part)
    reader.reset()
    for move in EXPECTED[name].by_touch:
        move(reader)
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
    elif (enabled := widget.locator("button:enabled", has_not_text="Reset")).count():
        enabled.first.press("Enter")
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
    visit.leave_formulas()
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
    """In the dark, only colours are examined, on a phone: the colour scheme changes nothing else."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    for size in (DESKTOP, PHONE) if theme == "light" else (PHONE,):
        visit.page.set_viewport_size(size)
        widget = mounted_alone(visit, explorable(name), theme=theme)
        widget.screenshot(path=PICTURES / f"{name}-{theme}-{size['width']}.png")
        visit.page.evaluate(AXE.read_text("utf-8"))
        assert visit.page.evaluate(RUN, COLOURS if theme == "dark" else None) == []
        if theme == "light":
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
    """Twice with an answer that is folded, and at least once with an explorable."""
    source = (ROOT / f"{page}.md").read_text("utf-8")
    answers = re.findall(r"^```\{dropdown\} (?:Answers?|The answer)$", source, re.M)
    assert len(answers) >= 2
    assert asked_on(ROOT / f"{page}.md")
