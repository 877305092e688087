"""The robot on the first screen of the book: it drives, stops, meets obstacles, and lets the reader steer."""

from __future__ import annotations

import re
from collections.abc import Iterator
from copy import deepcopy

import numpy as np
import pytest
from accessibility import violations
from browser import PHONE, Visit, swipe
from mounting import mounted, mounted_alone
from playwright.sync_api import Locator, Page, expect

from robonav.benchmark.policies import method
from robonav.networks import NetworkPolicy
from robonav.robot import random_worlds
from robonav.widgets.first_screen import first_screen

ABOUT = "A network steers."


@pytest.fixture
def screen(visit: Visit, place: str) -> Iterator[Locator]:
    """The first screen alone on a page."""
    widget = first_screen(
        method("dagger"), ABOUT, {"Train a robot of your own": "here.html"}, seed=2015
    )
    yield mounted(visit, place, widget)
    assert visit.errors == []


def pixels(screen: Locator) -> str:
    """What the map shows now."""
    return screen.locator("canvas").evaluate("(canvas) => canvas.toDataURL()")


def wait_for_change(screen: Locator, before: str) -> None:
    """Wait until the map shows something else than before."""
    screen.page.wait_for_function(
        "([canvas, before]) => canvas.toDataURL() !== before",
        arg=[screen.locator("canvas").element_handle(), before],
    )


def test_robot_crosses_maps_by_itself(screen):
    expect(screen.locator(".status")).to_have_text(ABOUT)
    expect(screen.locator(".status")).to_contain_text(
        re.compile(r"So far [1-9]\d* arrived"), timeout=60_000
    )


def test_robot_stops_and_goes_on(screen):
    screen.get_by_role("button", name="Stop").click()
    expect(screen.locator(".status")).to_have_text("Stopped.")
    screen.page.wait_for_timeout(300)
    before = pixels(screen)
    screen.page.wait_for_timeout(300)
    assert pixels(screen) == before
    screen.get_by_role("button", name="Go on").click()
    wait_for_change(screen, before)


def test_reader_steers_by_button_and_by_key(screen):
    screen.get_by_role("button", name="Steer it yourself").click()
    expect(screen.locator(".status")).to_contain_text("You steer")
    screen.page.wait_for_timeout(300)
    before = pixels(screen)
    screen.get_by_role("button", name="left 30°").click()
    wait_for_change(screen, before)
    screen.page.wait_for_timeout(300)
    turned = pixels(screen)
    screen.locator("canvas").press("ArrowUp")
    wait_for_change(screen, turned)
    screen.get_by_role("button", name="Let the network steer").click()
    expect(screen.locator(".status")).to_have_text(ABOUT)


def on_map(screen: Locator, x: float, y: float) -> tuple[float, float]:
    """Where a place of the map is in the window."""
    canvas = screen.locator("canvas")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    margin = 14 * box["width"] / 520
    scale = (box["width"] - 2 * margin) / 100
    return (
        box["x"] + margin + x * scale,
        box["y"] + box["height"] - margin - y * scale,
    )


def drag_by_mouse(
    page: Page, start: tuple[float, float], end: tuple[float, float]
) -> None:
    """Press the mouse's button at one position of the window, and let it go at another."""
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end, steps=4)
    page.mouse.up()


def test_target_is_dragged(screen):
    screen.get_by_role("button", name="Stop").click()
    screen.page.wait_for_timeout(300)
    before = pixels(screen)
    drag_by_mouse(screen.page, on_map(screen, 90, 90), on_map(screen, 70, 80))
    assert pixels(screen) != before


@pytest.fixture
def still(visit: Visit, place: str) -> Locator:
    """The first screen of a reader who wants no motion: the robot waits at its start."""
    visit.page.emulate_media(reduced_motion="reduce")
    return mounted(visit, place, first_screen(method("dagger"), ABOUT, {}, seed=2015))


def test_obstacles_and_target_are_moved_by_keyboard_and_dragged(still):
    status, keyboard = still.locator(".status"), still.page.keyboard
    hold = still.get_by_role("button", name="Move an obstacle")
    expect(hold).to_have_attribute("aria-pressed", "false")
    hold.press("Enter")  # the map has the focus now
    expect(hold).to_have_attribute("aria-pressed", "true")
    world = random_worlds(1, 15, seed=2015)
    distances = np.linalg.norm(world.centres[0] - world.starts[0], axis=1)
    x, y = world.centres[0, distances.argmin()]

    def is_at(x: float, y: float, what: str = "An obstacle") -> None:
        place = f"{what}, {x:.0f} m from the left and {y:.0f} m from below."
        expect(status).to_contain_text(place)

    is_at(x, y)
    before = pixels(still)
    keyboard.press("ArrowRight")
    is_at(x + 2, y)
    keyboard.press("Shift+ArrowUp")
    is_at(x + 2, y + 10)
    assert pixels(still) != before
    for _ in range(15):
        keyboard.press("Enter")
    is_at(90, 90, "The target")
    keyboard.press("Shift+ArrowLeft")
    is_at(80, 90, "The target")
    keyboard.press("Escape")
    expect(hold).to_have_attribute("aria-pressed", "false")
    expect(status).to_have_text("Stopped.")
    drag = swipe if still.page.viewport_size == PHONE else drag_by_mouse
    drag(still.page, on_map(still, x + 2, y + 10), on_map(still, 17, 17))
    hold.press("Enter")
    is_at(17, 17)  # it is the nearest: it stands before the robot now
    keyboard.press("Escape")
    keyboard.press("ArrowUp")  # steers the robot again
    expect(status).to_contain_text("You steer")


def test_nothing_of_axe_core_is_violated_while_an_obstacle_is_moved(still):
    still.get_by_role("button", name="Move an obstacle").click()
    assert violations(still.page) == []


def test_a_robot_that_lost_its_way_is_taken_to_the_next_map(visit):
    """A network that only turns to the left, before time runs faster."""
    visit.page.clock.install()
    network = deepcopy(method("dagger").network)
    network.biases[-1][:] = [-9, -9, 9, -9, -9]
    turns = NetworkPolicy(network, encoder=method("dagger").encoder)
    screen = mounted_alone(visit, first_screen(turns, ABOUT, {}, seed=2015))
    said = []
    for _ in range(60):
        visit.page.clock.run_for(2_000)
        said.append(screen.locator(".status").inner_text())
        if "Not arrived" in said[-1]:
            break
    assert said[-1].startswith("Not arrived after 300 s.")
    visit.page.clock.run_for(3_000)
    expect(screen.locator(".status")).to_contain_text(ABOUT)


def test_buttons_are_below_the_map(screen):
    board, stop = (
        place.bounding_box()
        for place in (screen.locator("canvas"), screen.get_by_role("button").first)
    )
    if board["x"] + board["width"] > stop["x"]:  # one above the other, on a phone
        assert stop["y"] - board["y"] - board["height"] < 60


def test_one_click_leads_to_training(screen):
    link = screen.get_by_role("link", name="Train a robot of your own")
    assert link.get_attribute("href") == "here.html"


def test_negative_obstacles_are_refused():
    with pytest.raises(ValueError, match="obstacles"):
        first_screen(method("dagger"), ABOUT, {}, obstacles=-1, seed=1)
