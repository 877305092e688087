"""The training lab, used as a reader would, and its numbers compared with Python's."""

from __future__ import annotations

import re
import threading

import numpy as np
import pytest
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.widgets.training_lab import Curve, training_lab

CONTROLS = {"rate": ["0.1", "0.5", "1"], "units": ["2", "8"]}
STEPS = np.arange(0, 201, 2)


def run(rate: str, units: str) -> dict[str, Curve]:
    arrivals = np.outer([0.8, 1.0, 1.2], STEPS) * float(rate) / 4 + float(units)
    return {
        "cost": Curve(STEPS, np.exp(-float(rate) * STEPS / 50)),
        "success": Curve(STEPS, arrivals),
    }


RUNS = {
    (rate, units): run(rate, units)
    for rate in CONTROLS["rate"]
    for units in CONTROLS["units"]
}
GO = threading.Event()


def train(choices):
    for done in range(1, 4):
        yield (
            done,
            3,
            {
                "cost": Curve(range(done), np.full(done, 0.5)),
                "success": Curve(range(done), np.full(done, 9)),
            },
        )
        if choices == ("1", "8"):
            assert GO.wait(60)
    if choices == ("0.5", "8"):
        raise ValueError("units must be fewer")


def widget():
    measures = {"cost": "cost J", "success": "success (%)"}
    return training_lab(CONTROLS, RUNS, step="episode", measures=measures, train=train)


@pytest.fixture
def lab(visit, place):
    yield mounted(visit, place, widget())
    assert visit.errors == []


def choose(lab: Locator, rate: str, units: str) -> None:
    lab.get_by_label("rate", exact=True).select_option(rate)
    lab.get_by_label("units", exact=True).select_option(units)


def track(lab: Locator) -> Locator:
    return lab.get_by_label("episode", exact=True).and_(lab.locator("input"))


def status(lab: Locator) -> Locator:
    return lab.locator(".status")


@pytest.mark.parametrize(("rate", "units"), [("0.1", "2"), ("0.5", "8"), ("1", "8")])
def test_every_setting_shows_its_own_run(lab, rate, units):
    choose(lab, rate, units)
    track(lab).press("Home")
    expect(status(lab)).to_have_text(
        f"Episode 0: cost J 1; success (%) {units} ({units} to {units})."
    )
    for _ in range(3):
        track(lab).press("ArrowRight")
    expect(status(lab)).to_contain_text("Episode 6: ")
    numbers = [
        float(number)
        for number in re.findall(r"[\d.]+\d|\d+", status(lab).inner_text())
    ]
    curves = RUNS[rate, units]
    cost, arrivals = curves["cost"].values[3], curves["success"].values[:, 3]
    assert numbers[1:] == pytest.approx(
        [cost, arrivals.mean(), arrivals.min(), arrivals.max()], rel=6e-3
    )


def test_time_moves_by_button_touch_and_play(lab):
    lab.get_by_label("To the start").click()
    expect(status(lab)).to_contain_text("Episode 0: ")
    lab.get_by_label("Play").click()
    expect(status(lab)).to_contain_text("Episode 200: ")
    picture = lab.get_by_role("img").first
    picture.scroll_into_view_if_needed()
    box = picture.bounding_box()
    picture.click(position={"x": box["width"] * 54 / 330 + 2, "y": box["height"] / 2})
    expect(status(lab)).to_contain_text(re.compile("Episode [0-4]: "))
    expect(picture).to_have_attribute(
        "aria-label", re.compile("cost J over the training; at episode [0-4]: ")
    )


def test_a_run_is_kept_to_compare(lab):
    choose(lab, "0.1", "2")
    lab.get_by_role("button", name="Keep to compare").click()
    choose(lab, "1", "8")
    expect(lab.locator(".told")).to_contain_text(
        "Kept (dashed; rate 0.1, units 2): cost J 0.67"
    )
    expect(status(lab)).to_contain_text("cost J 0.0183")
    lab.get_by_role("button", name="Drop what is kept").click()
    expect(lab.locator(".told")).to_have_text("")


def test_without_a_kernel_nothing_offers_to_train(lab):
    expect(lab.get_by_role("button", name="Train")).to_be_hidden()


def test_with_a_kernel_a_run_is_trained_watched_and_cancelled(visit, http):
    lab = mounted(visit, http, widget(), kernel=True)
    note = lab.locator("fieldset [role=status]")
    cancel, begin = (
        lab.get_by_role("button", name="Cancel"),
        lab.get_by_role("button", name="Train"),
    )
    for rate in ("0.1", "0.5"):  # the least, and one in between
        choose(lab, rate, "2")
        begin.click()
        expect(note).to_have_text("Trained.")
        expect(lab.get_by_role("progressbar")).to_have_js_property("value", 1)
        expect(cancel).to_be_disabled()
    live = lab.locator("svg path[stroke='#D55E00']")
    expect(live.first).to_have_attribute("d", re.compile("^M.*L.*L"))
    choose(lab, "0.5", "8")
    begin.click()
    expect(note).to_have_text("ValueError: units must be fewer")
    choose(lab, "1", "8")
    GO.clear()
    begin.click()
    expect(note).to_have_text(re.compile("^1 of 3"))
    expect(begin).to_be_disabled()
    cancel.click()
    GO.set()
    expect(note).to_contain_text("Cancelled. The curves so far stay")
    expect(begin).to_be_enabled()
    assert visit.errors == []
