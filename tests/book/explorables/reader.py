"""A reader who uses an explorable, by keyboard or by touch, and looks after each act at what it shows."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

from browser import Visit, tap
from mounting import mounted_alone
from playwright.sync_api import Locator, TimeoutError

from robonav.widgets.explorables import explorable

from .shown import LOOK, RECORD_MAPS, Act, Shown
from .table import EXPECTED

SEGMENTS = "fieldset.segments:not(.guess *)"
CHANGED = f"""([widget, before]) => {{
  const [controls, contents] = ({LOOK})(widget);
  return contents !== before && [controls, contents];
}}"""
Look = list[Any]
"""What ``LOOK`` returns: the controls, and all that is shown besides."""


class Hand(Protocol):
    """How a reader uses controls."""

    def press(self, button: Locator) -> None:
        """Press a button."""

    def slide(self, slider: Locator, share: float) -> None:
        """Move a slider to about a share of its length."""

    def choose(self, group: Locator, option: str) -> None:
        """Choose one of the options that exclude each other."""


class Keyboard:
    """Uses controls by keyboard."""

    def press(self, button: Locator) -> None:
        button.press("Enter")

    def slide(self, slider: Locator, share: float) -> None:
        tenths = int(10 * share)
        from_start = ["Home", *["PageUp"] * tenths, "ArrowRight"]
        from_end = ["End", *["PageDown"] * (10 - tenths)]
        for key in from_end if share > 0.5 else from_start:
            slider.press(key)

    def choose(self, group: Locator, option: str) -> None:
        for _ in group.locator("input").all():
            if group.get_by_role("radio", name=option, exact=True).is_checked():
                return
            group.locator("input:checked").press("ArrowRight")


class Finger:
    """Uses controls by touch."""

    def press(self, button: Locator) -> None:
        touch(button)

    def slide(self, slider: Locator, share: float) -> None:
        touch(slider, share)

    def choose(self, group: Locator, option: str) -> None:
        touch(group.get_by_role("radio", name=option, exact=True))


def touch(part: Locator, share: float = 0.5) -> None:
    """Tap a part of a page, at a share of its width."""
    part.scroll_into_view_if_needed()
    box = part.bounding_box()
    assert box is not None
    tap(part.page, box["x"] + share * box["width"], box["y"] + box["height"] / 2)


class Reader:
    """Uses one explorable, and fails where it shows something else than Python computes for the same settings."""

    def __init__(self, visit: Visit, name: str, hand: Hand) -> None:
        widget = explorable(name)
        self.page, self.hand, self.expected = visit.page, hand, EXPECTED[name]
        self.given: dict[str, Any] = widget.data["given"]
        self.widget = mounted_alone(visit, widget, first=RECORD_MAPS)
        self.acts: list[Act] = []
        self.first: Look = self.widget.evaluate(LOOK)
        self.see(self.first)
        self.seen_first = self.seen

    def see(self, now: Look) -> None:
        """Take in what is shown, and compare it with what Python computes."""
        controls, self.contents = now
        contents = json.loads(self.contents)
        self.seen = Shown(controls, contents, self.given, tuple(self.acts))
        self.expected.check(self.seen)

    @contextmanager
    def doing(self, act: str) -> Iterator[None]:
        """Fails unless what is shown changes, and unless it is then right."""
        self.acts.append(Act(act, self.seen))
        yield
        self.see(self.changed(act))

    def changed(self, act: str) -> Look:
        """What is shown as soon as it is something else than before."""
        now: Look = self.widget.evaluate(LOOK)
        if now[1] != self.contents:
            return now
        try:
            arguments = [self.widget.element_handle(), self.contents]
            found = self.page.wait_for_function(CHANGED, arg=arguments, timeout=3_000)
        except TimeoutError as error:
            raise AssertionError(f"{act} changes nothing") from error
        return found.json_value()

    @contextmanager
    def setting(self, control: str) -> Iterator[None]:
        """Like ``doing``, of a control that may be set to what it was set to before."""
        self.acts.append(Act(control, self.seen))
        yield
        self.see(self.widget.evaluate(LOOK))

    def reset(self) -> None:
        """Press Reset, which brings back what was shown first; what was done before does not count any more."""
        self.button("Reset").click()
        self.acts.clear()
        assert self.widget.evaluate(LOOK) == self.first
        self.seen, self.contents = self.seen_first, self.first[1]

    def button(self, name: str) -> Locator:
        """A button by its name."""
        return self.widget.get_by_role("button", name=name, exact=True)

    def buttons(self) -> list[Locator]:
        """Its buttons that can be pressed now, without Reset."""
        return [
            button
            for button in self.widget.locator("button").all()
            if button.inner_text() != "Reset" and button.is_enabled()
        ]

    def sliders(self) -> list[Locator]:
        """All its sliders."""
        return self.widget.locator("input[type=range]").all()


Move = Callable[[Reader], None]
"""Something that a reader does."""


def press(name: str) -> Move:
    """Press a button."""

    def move(reader: Reader) -> None:
        with reader.doing(name):
            reader.hand.press(reader.button(name))

    return move


def slide(label: str, share: float) -> Move:
    """Move a slider to about a share of its length."""

    def move(reader: Reader) -> None:
        with reader.setting(label):
            slider = reader.widget.get_by_role("slider", name=label, exact=True)
            reader.hand.slide(slider, share)

    return move


def choose(label: str, option: str) -> Move:
    """Choose one of the options that exclude each other."""

    def move(reader: Reader) -> None:
        with reader.setting(label):
            group = reader.widget.get_by_role("group", name=label, exact=True)
            reader.hand.choose(group, option)

    return move


def write(label: str, number: str) -> Move:
    """Write a number into a field."""

    def move(reader: Reader) -> None:
        with reader.doing(label):
            field = reader.widget.get_by_role("spinbutton", name=label, exact=True)
            field.fill(number)
            field.press("Tab")

    return move


def keys(names: str) -> Move:
    """Press keys on the part that takes keys."""

    def move(reader: Reader) -> None:
        for key in names.split():
            with reader.doing(key):
                reader.widget.locator("[data-keys]").press(key)

    return move


def touch_part(selector: str, number: int = 0) -> Move:
    """Touch a part of a picture."""

    def move(reader: Reader) -> None:
        with reader.doing("touch"):
            touch(reader.widget.locator(selector).nth(number))

    return move


def slide_all(reader: Reader) -> None:
    """Move each slider away from its ends, one after the other."""
    for number, slider in enumerate(reader.sliders()):
        share = (0.3, 0.6, 0.8, 0.4)[number % 4]
        with reader.setting(slider.get_attribute("aria-label") or ""):
            reader.hand.slide(slider, share)
