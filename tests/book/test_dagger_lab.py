"""DAgger by hand, from disk, with the network cut: the robot is corrected by keyboard and by touch, and learns."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from accessibility import AXE, RUN, ours
from browser import DESKTOP, PHONE, Visit, empty_storage
from driving import KEYS
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.benchmark.policies import method
from robonav.networks.policy import NetworkPolicy
from robonav.widgets.dagger_lab import dagger_lab

NAMES = dict(
    zip(("ahead", "left 30°", "left 60°", "right 30°", "right 60°"), KEYS, strict=False)
)
ENDED = "(told) => /collided|Arrived|circles/.test(told.textContent)"
# In one task of the page, so that the training cannot end before it is cancelled.
TRAIN_AND_CANCEL = """(train) => {
  const panel = train.closest(".training");
  train.click();
  [...panel.querySelectorAll("button")].find((button) => button.textContent === "Cancel").click();
}"""
STEERED = "(told) => /collided|Arrived|waits for you|would take/.test(told.textContent)"


@pytest.fixture(params=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Visit]:
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    yield visit
    assert visit.errors == []


@pytest.fixture
def lab(view: Visit, site: Path) -> Locator:
    learned = method("dagger")
    assert isinstance(learned, NetworkPolicy)
    found = mounted(view, site.as_uri(), dagger_lab(learned))
    empty_storage(view.page)
    return found


def train(lab: Locator) -> float:
    """Train, and give the rate of the robot in per cent."""
    lab.get_by_role("button", name="Train").press("Enter")
    said = lab.locator(".training > .status")
    expect(said).to_contain_text(re.compile("arrives in"))
    return float(re.search(r"arrives in ([\d.]+) %", said.inner_text())[1])


def correct(lab: Locator, *, touch: bool) -> None:
    """Let the robot fail, go back, and steer as the expert says."""
    told = lab.locator(".told")
    lab.get_by_role("button", name="Drive", exact=True).click()
    lab.page.wait_for_function(ENDED, arg=told.element_handle())
    lab.get_by_role("button", name="Back 5 s").click()
    for _ in range(80):
        lab.page.wait_for_function(STEERED, arg=told.element_handle())
        if re.search("collided|Arrived", told.inner_text()):
            return
        lab.get_by_role("button", name="Ask the expert").click()
        action = re.search(r"would take (.+) here", told.inner_text())[1]
        if touch:
            lab.get_by_role("button", name=action).click()
        else:
            lab.locator(".stage canvas").press(NAMES[action])


def test_corrections_by_hand_raise_the_rate(lab):
    before = train(lab)
    assert 40 < before < 60
    for touch in (False, True, False):
        correct(lab, touch=touch)
        told = lab.locator(".told")
        expect(told).to_contain_text("corrections of yours. Correct another map")
        expect(told).to_contain_text("last until you leave the page or change what")
        lab.get_by_role("button", name="Next map where it fails").click()
    lab.get_by_role("button", name="Train").click()
    said = lab.locator(".training > .status")
    expect(said).to_contain_text(f"Before this training it arrived in {before:.1f} %.")
    after = float(re.search(r"arrives in ([\d.]+) %", said.inner_text())[1])
    assert after > before + 20
    expect(lab.locator("tbody tr").first).to_contain_text(
        re.compile(r"robot 2: .* corrections")
    )


def test_without_demonstrations_one_sentence_and_cancel(lab):
    lab.get_by_label("the robot first learns from").select_option("my demonstrations")
    lab.get_by_role("button", name="Train").click()
    expect(lab.locator(".training > .status")).to_contain_text(
        "There is nothing to learn from"
    )
    expect(lab.locator(".stage")).to_be_hidden()
    lab.get_by_label("the robot first learns from").select_option(
        "one demonstration of the expert"
    )
    lab.get_by_role("button", name="Train").evaluate(TRAIN_AND_CANCEL)
    expect(lab.locator(".training > .status")).to_contain_text("Cancelled. ")


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESKTOP, PHONE])
def test_axe_finds_nothing_serious(visit, site, size, scheme):
    visit.page.set_viewport_size(size)
    visit.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    learned = method("dagger")
    assert isinstance(learned, NetworkPolicy)
    lab = mounted(visit, site.as_uri(), dagger_lab(learned))
    train(lab)
    visit.page.evaluate("() => { window.define = undefined; }")
    visit.page.evaluate(AXE.read_text("utf-8"))
    assert [bad for bad in visit.page.evaluate(RUN) if ours(bad)] == []
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= size["width"]
