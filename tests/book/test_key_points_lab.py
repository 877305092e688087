"""Key points by pointer and by keyboard: the path, the robot that follows it, and the demonstration that is kept."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

import pytest
from accessibility import AXE, RUN, ours
from browser import DESKTOP, PHONE, Visit, swipe, tap
from mounting import BLANK, mounted_alone
from playwright.sync_api import Locator, expect

from robonav.lfd import demonstrate_by_hand, sketch
from robonav.robot import random_worlds
from robonav.widgets.key_points_lab import FIRST_MAP, key_points_lab

WORLD = random_worlds(1, 10, seed=FIRST_MAP + 1)
(POINTS,) = (each.round().tolist() for each in sketch(WORLD, seed=0))
EDGE, SIDE = 14, 520  # pixels of the map's canvas, as in maps.js


@pytest.fixture(params=[DESKTOP, PHONE], ids=["desktop", "phone"])
def lab(request: pytest.FixtureRequest, visit: Visit) -> Iterator[Locator]:
    visit.page.set_viewport_size(request.param)
    visit.page.emulate_media(reduced_motion="reduce")
    visit.open(BLANK.as_uri())
    visit.page.evaluate("() => localStorage.clear()")
    yield mounted_alone(visit, key_points_lab())
    assert visit.errors == []


def place(lab: Locator, point: list[float]) -> dict[str, float]:
    """Where a point of the map is on the canvas."""
    box = lab.locator("canvas.map").bounding_box()
    x, y = (EDGE + (SIDE - 2 * EDGE) * value / 100 for value in point)
    scale = box["width"] / SIDE
    return {"x": x * scale, "y": (SIDE - y) * scale}


def test_key_points_stand_where_the_pointer_was(lab: Locator) -> None:
    for point in POINTS:
        lab.locator("canvas.map").click(position=place(lab, point))
    chosen = lab.get_by_label("key point", exact=True)
    expect(chosen.locator("option")).to_have_count(len(POINTS))
    for k, point in enumerate(POINTS):  # a pointer is not exact
        chosen.select_option(index=k)
        text = chosen.locator("option").nth(k).inner_text()
        x, y = map(float, re.findall(r"[\d.]+", text)[1:])
        assert (x, y) == pytest.approx(point, abs=0.4)
    chosen.select_option(index=0)
    lab.get_by_role("button", name="Remove it").click()
    expect(chosen.locator("option")).to_have_count(len(POINTS) - 1)
    lab.get_by_role("button", name="Remove all").click()
    expect(chosen).to_be_disabled()


def test_a_demonstration_by_keyboard_is_that_of_python_and_is_kept(
    lab: Locator,
) -> None:
    board = lab.locator("canvas.map")
    chosen = lab.get_by_label("key point", exact=True)
    for k, (x, y) in enumerate(POINTS):
        board.press("Enter")
        text = chosen.locator("option").nth(k).inner_text()
        at = map(float, re.findall(r"[\d.]+", text)[1:])
        keys = ("ArrowLeft", "ArrowRight"), ("ArrowDown", "ArrowUp")
        for value, goal, (less, more) in zip(at, (x, y), keys, strict=True):
            left = round(10 * (goal - value))
            while abs(left) >= 10:
                board.press(more if left > 0 else less)
                left -= 10 if left > 0 else -10
    python = lab.locator("pre").text_content()
    assert f"seed={FIRST_MAP + 1}" in python
    lab.get_by_role("button", name="Let the robot follow the path").click()
    told = lab.locator(".told")
    expect(told).to_contain_text("This demonstration is kept. It is your first.")
    worlds = random_worlds(1, obstacles=10, seed=FIRST_MAP + 1)
    points = ast.literal_eval(re.search(r"worlds, (\[\[.*\]\])\)", python)[1])
    expected = demonstrate_by_hand(worlds, points)
    steps, effective = len(expected), len(expected.effective)
    expect(told).to_contain_text(
        f"arrived after {steps} s, with {effective} steps to learn from"
    )
    expect(lab.locator(".my-demonstrations summary")).to_have_text(
        "My demonstrations (1)"
    )
    lab.get_by_role("button", name="Another map").click()
    expect(told).to_contain_text("Map 2.")


def test_a_point_on_the_path_is_inserted_and_one_in_an_obstacle_stops_the_robot(
    lab: Locator,
) -> None:
    board = lab.locator("canvas.map")
    board.press("Enter")  # (50, 50), half way to the target
    board.click(position=place(lab, [30, 30]))  # on the straight path before it
    options = lab.get_by_label("key point", exact=True).locator("option")
    expect(options).to_have_text([re.compile(r"1: \((29|30)\."), "2: (50.0, 50.0)"])
    circle = WORLD.centres[0, 0].tolist()
    board.click(position=place(lab, circle))
    expect(lab.locator(".told")).to_contain_text("comes nearer than 1 m")
    expect(lab.get_by_role("button", name="Let the robot follow")).to_be_disabled()
    board.press("Delete")
    expect(options).to_have_count(2)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESKTOP, PHONE])
def test_axe_finds_nothing_serious(visit: Visit, size: dict, theme: str) -> None:
    visit.page.set_viewport_size(size)
    visit.page.emulate_media(color_scheme=theme, reduced_motion="reduce")
    lab = mounted_alone(visit, key_points_lab(), theme=theme)
    lab.locator("canvas.map").press("Enter")
    visit.page.evaluate(AXE.read_text("utf-8"))
    assert [bad for bad in visit.page.evaluate(RUN) if ours(bad)] == []
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= size["width"]


def test_a_finger_adds_a_key_point_and_drags_it(visit: Visit) -> None:
    visit.page.set_viewport_size(PHONE)
    visit.open(BLANK.as_uri())
    visit.page.evaluate("() => localStorage.clear()")
    lab = mounted_alone(visit, key_points_lab())
    board = lab.locator("canvas.map")
    board.scroll_into_view_if_needed()
    corner = board.bounding_box()

    def on_screen(point: list[float]) -> tuple[float, float]:
        at = place(lab, point)
        return corner["x"] + at["x"], corner["y"] + at["y"]

    options = lab.get_by_label("key point", exact=True).locator("option")
    tap(visit.page, *on_screen([20, 50]))
    expect(options).to_have_text([re.compile(r"1: \((19|20)\.\d, (49|50)\.")])
    swipe(visit.page, on_screen([20, 50]), on_screen([40, 70]))
    expect(options).to_have_text([re.compile(r"1: \((39|40)\.\d, (69|70)\.")])
    assert visit.errors == []
