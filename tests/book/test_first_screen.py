"""The robot on the first screen of the book: it drives, stops, meets obstacles, and lets the reader steer."""

from __future__ import annotations

import re
from collections.abc import Iterator
from copy import deepcopy

import pytest
from browser import DESKTOP, PHONE, Visit
from mounting import mounted, mounted_alone
from playwright.sync_api import Locator, expect

from robonav.benchmark.policies import method
from robonav.networks import NetworkPolicy
from robonav.widgets.first_screen import first_screen

ABOUT = "A network steers."


@pytest.fixture(params=["desktop", "phone"])
def screen(
    request: pytest.FixtureRequest, visit: Visit, http: str
) -> Iterator[Locator]:
    """The first screen alone on a page."""
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    widget = first_screen(
        method("dagger"), ABOUT, {"Train a robot of your own": "here.html"}, seed=2015
    )
    yield mounted(visit, http, widget)
    assert visit.errors == []


def pixels(screen: Locator) -> str:
    """What the map shows now."""
    return screen.locator("canvas").evaluate("(canvas) => canvas.toDataURL()")


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
    screen.page.wait_for_timeout(300)
    assert pixels(screen) != before


def test_reader_steers_by_button_and_by_key(screen):
    screen.get_by_role("button", name="Steer it yourself").click()
    expect(screen.locator(".status")).to_contain_text("You steer")
    screen.page.wait_for_timeout(300)
    before = pixels(screen)
    screen.get_by_role("button", name="left 30°").click()
    screen.page.wait_for_timeout(300)
    turned = pixels(screen)
    assert turned != before
    screen.locator("canvas").press("ArrowUp")
    screen.page.wait_for_timeout(300)
    assert pixels(screen) != turned
    screen.get_by_role("button", name="Let the network steer").click()
    expect(screen.locator(".status")).to_have_text(ABOUT)


def test_target_is_dragged(screen):
    screen.get_by_role("button", name="Stop").click()
    screen.page.wait_for_timeout(300)
    before = pixels(screen)
    box = screen.locator("canvas").bounding_box()
    scale = (box["width"] - 28 * box["width"] / 520) / 100
    target = (
        box["x"] + 14 * box["width"] / 520 + 90 * scale,
        box["y"] + box["height"] - 14 * box["height"] / 520 - 90 * scale,
    )
    screen.page.mouse.move(*target)
    screen.page.mouse.down()
    screen.page.mouse.move(target[0] - 60, target[1] + 20, steps=4)
    screen.page.mouse.up()
    assert pixels(screen) != before


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
