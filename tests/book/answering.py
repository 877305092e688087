"""Answering drills in the page: by the keyboard alone, and by a finger."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import cache
from typing import Any, Protocol

from browser import SITE, Visit
from playwright.sync_api import CDPSession, Locator, Page, expect

# What the drill shows, the verdict without its formulas.
SHOWN = r"""(place) => {
  const verdict = place.querySelector(".verdict").cloneNode(true);
  for (const formula of verdict.querySelectorAll(".math, mjx-container")) formula.remove();
  return {
    question: Number(place.querySelector("form").dataset.question),
    verdict: verdict.textContent,
    solved: !place.querySelector(".solution").hidden,
    standing: place.querySelector(".drill-standing").textContent,
    overhang: place.scrollWidth - place.clientWidth,
    steps: [...place.querySelectorAll("[data-step]")].map((step) => Number(step.dataset.step)),
  };
}"""
# Scrolls to an element and returns its middle when it lies still there, with nothing above it. A click on anything
# else, because the page has moved in between, is caught.
AIMED = """async (element) => {
  if (!globalThis.aim) {
    globalThis.aim = {};
    addEventListener("click", (event) => {
      aim.hit = aim.element.contains(event.target);
      if (aim.hit) return;
      event.preventDefault();
      event.stopImmediatePropagation();
    }, { capture: true });
  }
  Object.assign(aim, { element, hit: null });
  for (let frame = 0, before = []; ; frame += 1) {
    element.scrollIntoView({ block: "center", behavior: "instant" });
    const { left, top, width, height } = element.getBoundingClientRect();
    const middle = [left + width / 2, top + height / 2];
    const still = middle.every((place, k) => place === before[k]);
    const free = element.contains(document.elementFromPoint(...middle));
    if ((still && free) || frame > 600) return middle;
    before = middle;
    await new Promise(requestAnimationFrame);
  }
}"""
HIT = """async () => {
  for (let frame = 0; frame < 120 && aim.hit === null; frame += 1) await new Promise(requestAnimationFrame);
  return aim.hit;
}"""
TOUCHES = 5  # until one meets an element of a page that moves


class Hand(Protocol):
    """How a reader uses a page."""

    def press(self, element: Locator) -> None:
        """Press a button, or something else that can be chosen."""

    def write(self, field: Locator, text: str) -> None:
        """Write into a field, in place of what stands there."""


@dataclass
class Keyboard:
    """Works with the keys alone; only the way to an element is shortened."""

    page: Page

    def press(self, element: Locator) -> None:
        radio = element.evaluate("(it) => { it.focus(); return it.type === 'radio'; }")
        self.page.keyboard.press("Space" if radio else "Enter")

    def write(self, field: Locator, text: str) -> None:
        field.evaluate("(field) => { field.focus(); field.select(); }")
        self.page.keyboard.insert_text(text)


@dataclass
class Finger:
    """Touches the screen; text comes as from a keyboard on the screen."""

    page: Page
    session: CDPSession

    def press(self, element: Locator) -> None:
        for _ in range(TOUCHES):
            self.touch(*element.evaluate(AIMED))
            if self.page.evaluate(HIT):
                return
        raise AssertionError(f"no touch meets {element}")

    def touch(self, x: float, y: float) -> None:
        """Touch a position on the screen briefly."""
        for kind, points in (("touchStart", [{"x": x, "y": y}]), ("touchEnd", [])):
            self.session.send(
                "Input.dispatchTouchEvent", {"type": kind, "touchPoints": points}
            )

    def write(self, field: Locator, text: str) -> None:
        self.press(field)
        expect(field).to_be_focused()
        field.evaluate("(field) => field.select()")
        self.page.keyboard.insert_text(text)


def finger_on(page: Page) -> Finger:
    """A finger on the screen of a page."""
    session = page.context.new_cdp_session(page)
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": True})
    return Finger(page, session)


def drill_of(visit: Visit, name: str) -> Locator:
    """The folded or open drill with a name."""
    return visit.page.locator(f'details.drill[data-drill="{name}"]')


def open_drill(hand: Hand, drill: Locator) -> None:
    """Unfold a drill."""
    hand.press(drill.locator("> summary"))
    expect(drill.locator("form")).to_be_visible()


@cache
def questions_of(name: str) -> list[dict[str, Any]]:
    """What each question of a drill asks, from its file in the site, with each shared text in its places."""
    script = (SITE / "_static" / "drills" / f"{name}.js").read_text("utf-8")
    arguments = script.strip().removeprefix("robonavDrill(").removesuffix(");")
    _, questions, texts = json.loads(f"[{arguments}]")

    def whole(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: whole(one) for key, one in value.items()}
        if isinstance(value, list):
            return [whole(one) for one in value]
        shared = isinstance(value, str) and re.fullmatch(r"@(\d+)", value)
        return texts[int(shared[1])] if shared else value

    return [whole(question["asked"]) for question in questions]


def asked_by(drill: Locator) -> dict[str, Any]:
    """What the shown question of an open drill asks."""
    name = drill.get_attribute("data-drill")
    assert name is not None
    return questions_of(name)[shown_by(drill)["question"]]


def right_answer(asked: dict[str, Any]) -> Any:
    """The right answer in the form in which :func:`give` takes it."""
    if asked["kind"] == "order":
        return list(range(len(asked["steps"])))
    right = asked["right" if asked["kind"] in ("choice", "place") else "answer"]
    return right[0] if asked["kind"] == "place" else right


def wrong_answer(asked: dict[str, Any], shown: list[int]) -> tuple[Any, str]:
    """A usual wrong answer and its hint. Steps stay as they are shown, which is never in order."""
    kind = asked["kind"]
    if kind == "order":
        hints = (hint for i, j, hint in asked["before"] if shown.index(i) > shown.index(j))  # fmt: skip
        return shown, next(hints)
    if kind == "choice":
        hinted = [(k, hint) for k, hint in enumerate(asked["hints"]) if hint]
    elif kind == "place":
        hinted = [*asked["hints"].items()]
    else:
        hinted = [(answer, hint) for hint, answer in asked["wrong"]]
    return hinted[0]


def give(hand: Hand, drill: Locator, asked: dict[str, Any], answer: Any) -> None:
    """Give an answer, and have it checked."""
    kind = asked["kind"]
    if kind == "number":
        hand.write(drill.get_by_label("Your answer"), str(answer))
    elif kind == "choice":
        hand.press(drill.locator("input[type=radio]").nth(answer))
    elif kind == "place":
        hand.press(drill.locator(f'.place[data-place="{answer}"]'))
    elif kind == "order":
        put_in_order(hand, drill, answer)
    else:
        fields = drill.locator("td input")
        for k, number in enumerate(n for row in answer for n in row):
            hand.write(fields.nth(k), str(number))
    hand.press(drill.get_by_role("button", name="Check"))


def put_in_order(hand: Hand, drill: Locator, wanted: list[int]) -> None:
    """Move steps up until they stand in an order."""
    steps: list[int] = shown_by(drill)["steps"]
    for place, step in enumerate(wanted):
        for k in range(steps.index(step), place, -1):
            hand.press(drill.locator(".steps li").nth(k).locator(".up"))
            steps[k - 1], steps[k] = steps[k], steps[k - 1]


def shown_by(drill: Locator) -> dict[str, Any]:
    """What a drill shows now."""
    shown: dict[str, Any] = drill.evaluate(SHOWN)
    return shown
