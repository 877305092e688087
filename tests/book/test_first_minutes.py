"""The first minutes of a reader who has never programmed, on a phone: drive three maps, and train a good robot."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from browser import PHONE, chromium, visiting
from driving import KEYS, WAITS, good_demonstration, keys_of
from playwright.sync_api import Locator, Page, expect

NAMES = ("ahead", "left 30°", "left 60°", "right 30°", "right 60°")
"""The buttons below the map, in the order of ``KEYS``."""


def drive_by_touch(lab: Locator, number: int) -> None:
    """Drive the reader's next map with the buttons below it, as a reader would who sees the way."""
    lab.get_by_role("button", name="Drive a new map yourself").tap()
    expect(lab.locator(".kept")).to_contain_text(f"Map {number}.")
    turns = [NAMES[KEYS.index(key)] for key in keys_of(good_demonstration(number))]
    if "waits for you" not in lab.locator(".status").first.inner_text():
        lab.get_by_role("button", name="ahead").tap()
    while True:
        said = str(
            lab.page.wait_for_function(WAITS, arg=lab.element_handle()).json_value()
        )
        if "waits" not in said:
            break
        lab.get_by_role("button", name=turns.pop(0)).tap()
    assert "Arrived" in said


def go(page: Page, link: Locator, address: str) -> Locator:
    """Touch a link, and give the lab of the page that opens."""
    link.tap()
    page.wait_for_url(re.compile(re.escape(address)))
    lab = page.locator(".robonav:not(.explorable)").first
    lab.wait_for()
    return lab


@pytest.mark.long
def test_three_maps_are_driven_and_a_robot_is_trained(site: Path) -> None:
    with (
        chromium(viewport=PHONE, has_touch=True, is_mobile=True) as phone,
        visiting(phone) as visit,
    ):
        page = visit.page
        visit.open(f"{site.as_uri()}/book/intro.html")
        link = page.get_by_role("link", name="Drive in the playground")
        lab = go(page, link, "playground.html")
        for number in (1, 2, 3):
            drive_by_touch(lab, number)
        link = lab.get_by_role("link", name="Train a robot on your demonstrations")
        lab = go(page, link, "policy-learning.html")
        expect(lab.get_by_label("learn from", exact=True)).to_have_value(
            "my demonstrations"
        )
        train = lab.get_by_role("button", name="Train", exact=True)
        said = lab.locator(".training > .status").first
        train.tap()
        lab.get_by_role("button", name="Cancel", exact=True).tap()
        expect(said).to_contain_text("Cancelled. ")
        train.tap()
        expect(said).to_contain_text("always goes straight on")
        expect(said).to_be_in_viewport(ratio=1)  # and so is much of the map
        expect(lab.locator(".viewer canvas")).to_be_in_viewport(ratio=0.9)
        own, straight = map(float, re.findall(r"in ([\d.]+) %", said.inner_text()))
        assert own > straight + 20
        lab = go(
            page, lab.get_by_role("link", name="Let your robot drive"), "playground"
        )
        lab.get_by_label("who drives", exact=True).select_option(
            label="robot 1: 3 of my demonstrations, 8 hidden, λ 0.1"
        )
        lab.get_by_role("button", name="Drive", exact=True).tap()
        expect(lab.locator(".status").first).to_contain_text("s, target in sector")
        assert visit.errors == visit.external == []
