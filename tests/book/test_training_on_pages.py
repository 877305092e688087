"""What the book promises, on its built pages: drive, train, learn a reward, cancel; from disk, with the network cut.

At a desk everything is done by keyboard, and on a phone by touch. On a phone the maps are driven in the tests of the
first minutes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import DESKTOP, PHONE, Visit, empty_storage, touch
from driving import drive_map, fast, good_demonstration, keys_of
from playwright.sync_api import Locator, expect

SLOW = 240_000  # milliseconds: a training on a busy machine


@pytest.fixture(params=[DESKTOP, PHONE], ids=["keyboard", "touch"])
def view(request: pytest.FixtureRequest, visit: Visit) -> Iterator[Visit]:
    visit.page.set_viewport_size(request.param)
    yield visit
    empty_storage(visit.page)
    assert visit.errors == visit.external == []


def opened(view: Visit, site: Path, page: str, lab: str) -> Locator:
    """The lab of a page whose reader has trained nothing yet."""
    view.leave_formulas()
    view.open(f"{site.as_uri()}/book/{page}.html")
    empty_storage(view.page)
    return view.page.locator(lab)


def use(lab: Locator, name: str) -> None:
    """Press a button: by touch on a phone, and else by keyboard."""
    button = lab.get_by_role("button", name=name, exact=True)
    if lab.page.viewport_size == PHONE:
        touch(button)
    else:
        button.press("Enter")


def cancel(lab: Locator, name: str) -> None:
    """Begin a training and cancel it."""
    use(lab, name)
    use(lab, "Cancel")
    cancelled = lab.locator(".status", has_text="Cancelled. ")
    expect(cancelled).to_be_visible()
    expect(lab.get_by_role("button", name=name, exact=True)).to_be_enabled()


def rates(sentence: str) -> tuple[float, float]:
    """How often the own robot arrives, and one that always goes straight on, in per cent."""
    own, straight = re.findall(r"in ([\d.]+) %", sentence)
    return float(own), float(straight)


def test_five_maps_are_driven_and_a_robot_is_trained_at_a_desk(visit, site):
    visit.page.set_viewport_size(DESKTOP)
    lab = opened(visit, site, "playground", ".robot-playground")
    fast(lab)
    for number in range(1, 6):
        assert "Arrived" in drive_map(lab, keys_of(good_demonstration(number)))
    link = lab.get_by_role("link", name="Train a robot on your demonstrations")
    link.press("Enter")
    visit.page.wait_for_url(re.compile("policy-learning.html"))
    lab = visit.page.locator(".imitation-lab")
    expect(lab.get_by_label("learn from", exact=True)).to_have_value(
        "my demonstrations"
    )
    iterations = lab.get_by_label("iterations of L-BFGS")
    iterations.press("End")
    expect(iterations).to_have_value("1000")
    cancel(lab, "Train")
    iterations.press("ArrowUp")
    use(lab, "Train")
    said = lab.locator(".training > .status").first
    expect(said).to_contain_text("always goes straight on")
    own, straight = rates(said.inner_text())
    assert own > straight + 10
    empty_storage(visit.page)
    assert visit.errors == visit.external == []


def test_nnql_learns_from_nothing(view, site):
    lab = opened(view, site, "nnql", ".q-learning-lab")
    cancel(lab, "Train")
    use(lab, "Train")
    said = lab.locator(".training .status").first
    expect(said).to_contain_text("new maps: ", timeout=SLOW)
    arrived, maps = re.search(r"crosses (\d+) of (\d+)", said.inner_text()).groups()
    assert int(maps) == 100
    assert int(arrived) >= 80


def test_a_reward_is_learned_and_a_robot_trained_for_it(view, site):
    opened(view, site, "nirl", "body")
    lab = view.page.get_by_role("group", name="Reward lab")
    iterations = lab.get_by_label("iterations", exact=True)
    again = "Train a new robot for this reward"
    cancel(lab, "Learn the reward")
    iterations.fill("30")
    use(lab, "Learn the reward")
    learned = lab.locator(".status", has_text="straight on in")
    expect(learned).to_be_visible(timeout=SLOW)
    own, straight = rates(learned.inner_text())
    assert own > straight + 20
    iterations.fill("1000")
    cancel(lab, again)
    iterations.fill("30")
    use(lab, again)
    trained = lab.locator(".status", has_text="The new robot is kept.")
    expect(trained).to_be_visible(timeout=SLOW)
    own, straight = rates(trained.inner_text())
    assert own > straight
