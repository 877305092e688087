"""The belief lab of the page on partial observation, used as a reader would, and its numbers compared with Python's."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import DESKTOP, PHONE, Visit
from playwright.sync_api import Locator, expect

from robonav import mdp

PLANS = {
    "three doors": "..D.....D.D....",
    "two doors, all alike": "..D.....D..",
    "one door in the middle": "....D....",
    "no door at all": ".........",
}
ACTIONS = {"← Left": 0, "Right →": 1, "Stay and sense": 2}
STATUS = re.compile(
    r"saw a (?P<seen>wall|door) \(probability (?P<probability>[\d.]+) %\)|sensed nothing|knows the plan",
    re.DOTALL,
)
KNOWN = re.compile(
    r"(Likeliest cell (?P<cell>\d+)|All \d+ cells are equally likely,) "
    r"with (?P<share>[\d.]+) %; uncertainty (?P<bits>[\d.]+) bits"
)


@pytest.fixture(params=["desktop", "phone"])
def lab(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Locator]:
    """The lab on the opened page: served to a desktop, or from disk on a phone."""
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    visit.leave_formulas()
    visit.open(
        f"{request.getfixturevalue('http') if desktop else site.as_uri()}/book/partial-observation.html"
    )
    found = visit.page.locator(".belief-lab")
    found.wait_for()
    yield found
    assert visit.errors == []


def choose(lab: Locator, plan: str, sensor: str, wheels: str) -> None:
    for label, option in (
        ("corridor", plan),
        ("door sensor", sensor),
        ("wheels", wheels),
    ):
        lab.get_by_label(label, exact=True).select_option(option)


def status(lab: Locator, step: int) -> str:
    """What the lab says, once it has come to a step."""
    said = lab.locator("[role=status]")
    expect(said).to_contain_text(f"Step {step}: ")
    return said.inner_text()


def bars(lab: Locator) -> list[int]:
    """The whole per cents over the bars, 0 where none is written."""
    return [
        int(text or 0)
        for text in lab.locator("svg text[y]:not([class])").all_text_contents()
    ]


def assert_same(lab: Locator, step: int, belief: np.ndarray) -> None:
    known = KNOWN.search(status(lab, step))
    assert known is not None
    likeliest = int(known["cell"]) if known["cell"] else slice(None)
    assert belief[likeliest] == pytest.approx(belief.max(), abs=1e-9)
    assert float(known["share"]) == pytest.approx(100 * belief.max(), abs=0.0501)
    assert float(known["bits"]) == pytest.approx(mdp.entropy(belief), abs=0.00501)
    written = bars(lab)
    assert len(written) == len(belief)
    np.testing.assert_allclose(
        written, np.where(belief >= 0.005, 100 * belief, 0), atol=0.501
    )


@pytest.mark.parametrize(
    ("plan", "sensor", "accuracy", "wheels", "slip"),
    [
        ("three doors", "right 9 times in 10", 0.9, "1 move in 10 fails", 0.1),
        ("two doors, all alike", "right 7 times in 10", 0.7, "3 moves in 10 fail", 0.3),
        ("one door in the middle", "always right", 1.0, "no move fails", 0.0),
    ],
)
def test_every_click_is_believed_as_python_would(
    lab, plan, sensor, accuracy, wheels, slip
):
    choose(lab, plan, sensor, wheels)
    pomdp = mdp.corridor(PLANS[plan], accuracy=accuracy, slip=slip)
    belief = pomdp.uniform()
    assert_same(lab, 0, belief)
    buttons = [
        "Right →",
        "Right →",
        "Stay and sense",
        "← Left",
        "← Left",
        "← Left",
        "Right →",
    ]
    for step, button in enumerate(buttons, start=1):
        lab.get_by_role("button", name=button).click()
        seen = STATUS.search(status(lab, step))
        assert seen is not None
        observation = ["wall", "door"].index(seen["seen"])
        probability = pomdp.observation_probabilities(belief, ACTIONS[button])[
            observation
        ]
        assert float(seen["probability"]) == pytest.approx(
            100 * probability, abs=0.0501
        )
        belief = pomdp.update(belief, ACTIONS[button], observation)
        assert_same(lab, step, belief)


def test_without_sensing_walls_tell(lab):
    choose(lab, "no door at all", "no sensing at all", "no move fails")
    stage = lab.get_by_role("group", name="The corridor")
    stage.focus()
    for _ in range(8):
        lab.page.keyboard.press("ArrowLeft")
    assert "sensed nothing" in status(lab, 8)
    assert_same(lab, 8, np.eye(9)[0])


def test_a_new_run_an_undo_and_the_robot(lab):
    undo = lab.get_by_role("button", name="Undo")
    expect(undo).to_be_disabled()
    start = status(lab, 0)
    lab.get_by_role("button", name="Right →").click()
    assert status(lab, 1) != start
    undo.click()
    assert status(lab, 0) == start
    robot = lab.locator("svg path[transform]")
    said = lab.locator("[role=status]")
    lab.get_by_label("show the robot").check()
    expect(said).to_contain_text(re.compile(r"It is in cell \d+"))
    expect(robot).to_have_attribute("visibility", "visible")
    lab.get_by_label("show the robot").uncheck()
    expect(said).not_to_contain_text("It is in cell")
    expect(robot).to_have_attribute("visibility", "hidden")
    lab.get_by_role("button", name="Stay and sense").click()
    status(lab, 1)
    lab.get_by_role("button", name="New run").click()
    status(lab, 0)
    expect(lab.get_by_role("img")).to_have_attribute(
        "aria-label", re.compile("doors in 2, 8, 10")
    )
