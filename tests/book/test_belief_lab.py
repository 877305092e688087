"""The belief lab of the page on partial observation, used as a reader would, and its numbers compared with Python's."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import DESKTOP, PHONE, Visit
from playwright.sync_api import Locator

from robonav import mdp

PLANS = {
    "three doors": "..D.....D.D....",
    "two doors, all alike": "..D.....D..",
    "one door in the middle": "....D....",
    "no door at all": ".........",
}
ACTIONS = {"← Left": 0, "Right →": 1, "Stay and sense": 2}
STATUS = re.compile(
    r"saw a (?P<seen>wall|door) \(chance (?P<chance>[\d.]+) %\)|sensed nothing|knows the plan", re.DOTALL
)
KNOWN = re.compile(r"Likeliest cell (?P<cell>\d+) with (?P<share>[\d.]+) %; uncertainty (?P<bits>[\d.]+) bits")


@pytest.fixture(params=["desktop", "phone"])
def lab(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Locator]:
    """The lab on the opened page: served to a desktop, or from disk on a phone."""
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    visit.open(f"{request.getfixturevalue('http') if desktop else site.as_uri()}/book/partial-observation.html")
    found = visit.page.locator(".belief-lab")
    found.wait_for()
    yield found
    assert visit.errors == []


def choose(lab: Locator, plan: str, sensor: str, wheels: str) -> None:
    for label, option in (("corridor", plan), ("door sensor", sensor), ("wheels", wheels)):
        lab.get_by_label(label, exact=True).select_option(option)


def status(lab: Locator) -> str:
    return lab.locator("[role=status]").inner_text()


def bars(lab: Locator) -> list[int]:
    """The whole per cents over the bars, 0 where none is written."""
    return [int(text or 0) for text in lab.locator("svg text[y]:not([class])").all_text_contents()]


def assert_same(lab: Locator, belief: np.ndarray) -> None:
    known = KNOWN.search(status(lab))
    assert known is not None
    assert belief[int(known["cell"])] == pytest.approx(belief.max(), abs=1e-9)
    assert float(known["share"]) == pytest.approx(100 * belief.max(), abs=0.0501)
    assert float(known["bits"]) == pytest.approx(mdp.entropy(belief), abs=0.00501)
    written = bars(lab)
    assert len(written) == len(belief)
    np.testing.assert_allclose(written, np.where(belief >= 0.005, 100 * belief, 0), atol=0.501)


@pytest.mark.parametrize(
    ("plan", "sensor", "accuracy", "wheels", "slip"),
    [
        ("three doors", "right 9 times in 10", 0.9, "1 move in 10 fails", 0.1),
        ("two doors, all alike", "right 7 times in 10", 0.7, "3 moves in 10 fail", 0.3),
        ("one door in the middle", "always right", 1.0, "no move fails", 0.0),
    ],
)
def test_every_click_is_believed_as_python_would(lab, plan, sensor, accuracy, wheels, slip):
    choose(lab, plan, sensor, wheels)
    pomdp = mdp.corridor(PLANS[plan], accuracy=accuracy, slip=slip)
    belief = pomdp.uniform()
    assert_same(lab, belief)
    for button in ["Right →", "Right →", "Stay and sense", "← Left", "← Left", "← Left", "Right →"]:
        lab.get_by_role("button", name=button).click()
        seen = STATUS.search(status(lab))
        assert seen is not None
        observation = ["wall", "door"].index(seen["seen"])
        chance = pomdp.observation_probabilities(belief, ACTIONS[button])[observation]
        assert float(seen["chance"]) == pytest.approx(100 * chance, abs=0.0501)
        belief = pomdp.update(belief, ACTIONS[button], observation)
        assert_same(lab, belief)


def test_without_sensing_walls_tell(lab):
    choose(lab, "no door at all", "no sensing at all", "no move fails")
    stage = lab.get_by_role("group", name="The corridor")
    stage.focus()
    for _ in range(8):
        lab.page.keyboard.press("ArrowLeft")
    assert "sensed nothing" in status(lab)
    assert_same(lab, np.eye(9)[0])


def test_a_new_run_an_undo_and_the_robot(lab):
    assert lab.get_by_role("button", name="Undo").is_disabled()
    start = status(lab)
    lab.get_by_role("button", name="Right →").click()
    assert status(lab) != start
    lab.get_by_role("button", name="Undo").click()
    assert status(lab) == start
    lab.get_by_label("show the robot").check()
    place = re.search(r"It is in cell (\d+)", status(lab))
    assert place is not None
    robot = lab.locator("svg path[transform]")
    assert robot.get_attribute("visibility") == "visible"
    lab.get_by_label("show the robot").uncheck()
    assert robot.get_attribute("visibility") == "hidden"
    lab.get_by_role("button", name="Stay and sense").click()
    lab.get_by_role("button", name="New run").click()
    assert "Step 0" in status(lab)
    picture = lab.get_by_role("img").get_attribute("aria-label")
    assert "doors in 2, 8, 10" in (picture or "")
