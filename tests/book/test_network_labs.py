"""The two labs of the network's page, used as a reader would, and their numbers compared with Python's."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import DESKTOP, PHONE, Visit
from playwright.sync_api import Locator, expect

from robonav import networks
from robonav.networks import toy_datasets

PAGE = "book/neural-network.html"
ACTIONS = ["F", "L30", "L60", "R30", "R60"]


@pytest.fixture(params=["desktop", "phone"])
def labs(
    request: pytest.FixtureRequest, visit: Visit, site: Path
) -> Iterator[list[Locator]]:
    """The boundary lab and the network lab on the opened page: served to a desktop, or from disk on a phone."""
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    visit.leave_formulas()
    visit.open(
        f"{request.getfixturevalue('http') if desktop else site.as_uri()}/{PAGE}"
    )
    found = visit.page.locator(".robonav:not(.explorable)")
    found.nth(1).wait_for()
    yield [found.nth(0), found.nth(1)]
    assert visit.errors == []


def status(lab: Locator) -> str:
    return lab.locator(".status").inner_text()


def numbers(lab: Locator) -> list[float]:
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", status(lab))]


def set_slider(lab: Locator, label: str, step: int) -> None:
    """Move a slider as a hand does: the page hears the same event."""
    lab.get_by_label(label, exact=True).and_(lab.locator("input")).evaluate(
        "(input, step) => { input.value = step; input.dispatchEvent(new Event('input')); }",
        step,
    )


def held(lab: Locator, key: str) -> dict[str, Any]:
    """The data that the page keeps for the widget which holds ``key``."""
    text = lab.page.locator(
        'script[type="application/vnd.jupyter.widget-state+json"]'
    ).first.text_content()
    states = json.loads(text or "")["state"].values()
    return next(
        state["state"]["data"]
        for state in states
        if key in state["state"].get("data", {})
    )


def unpacked(array: dict[str, Any]) -> np.ndarray:
    return np.frombuffer(base64.b64decode(array["data"]), dtype=array["dtype"]).reshape(
        array["shape"]
    )


@pytest.mark.parametrize(
    ("problem", "hidden", "first", "rate", "iteration"),
    [
        ("xor", 2, "random", 3, 150),
        ("disc", 3, "all zero", 30, 7),
        ("moons", 8, "random again", 0.3, 56),
    ],
)
def test_every_setting_shows_its_own_training(
    labs, problem, hidden, first, rate, iteration
):
    lab = labs[0]
    for label, option in {
        "problem": problem,
        "hidden units": str(hidden),
        "first weights": first,
        "trained by": f"gradient descent, rate {rate:g}",
    }.items():
        lab.get_by_label(label, exact=True).select_option(option)
    set_slider(lab, "iteration", held(lab, "runs")["frames"].index(iteration))
    set_slider(lab, "probe x₁", 10)
    set_slider(lab, "probe x₂", 45)

    seed, spread = {"random": (1, 1.0), "random again": (2, 1.0), "all zero": (1, 0.0)}[
        first
    ]
    start = networks.random_network((2, hidden, 1), seed=seed, spread=spread)
    x, y = toy_datasets.TOY_DATASETS[problem](100, seed=0)
    training = networks.gradient_descent(
        start,
        x,
        y,
        gradient_step=rate,
        iterations=iteration,
        regularisation=0.01,
        objective=networks.CROSS_ENTROPY,
    )
    expect(lab.locator(".status")).to_have_text(
        re.compile(rf"^Iteration {iteration}\b")
    )
    shown, cost, right, *probe, answer = numbers(lab)
    assert shown == iteration
    assert cost == pytest.approx(training.costs[-1], abs=6e-4)
    assert right == pytest.approx(100 * training.accuracies[-1], abs=0.51)
    assert probe == pytest.approx([-1, 0.75], abs=0.006)
    assert answer == pytest.approx(training.network.forward([-1, 0.75])[0], abs=6e-4)


def test_the_probe_follows_a_touch_on_the_plane(labs):
    plane = labs[0].locator(".plane svg")
    plane.scroll_into_view_if_needed()
    box = plane.bounding_box()
    plane.click(position={"x": box["width"] * 0.25, "y": box["height"] * 0.75})
    expect(labs[0].locator(".status")).to_contain_text(
        re.compile(r"-0\.7[3-7], -0\.7[3-7]")
    )


@pytest.mark.parametrize("which", [0, 1])
def test_time_moves_by_button_keyboard_and_play(labs, which):
    lab = labs[which]
    said = lab.locator(".status")

    def comes_to(iteration: int) -> None:
        expect(said).to_have_text(re.compile(rf"^Iteration {iteration}\b"))

    track = lab.get_by_label("iteration", exact=True).and_(lab.locator("input"))
    last = int(numbers(lab)[0])
    lab.get_by_label("To the start").click()
    comes_to(0)
    lab.get_by_label("One on").click()
    comes_to(1)
    track.press("ArrowRight")
    comes_to(2)
    lab.get_by_label("One back").click()
    comes_to(1)
    lab.get_by_label("Play").click()
    expect(said).not_to_have_text(re.compile(r"^Iteration 1\b"))
    lab.get_by_label("Pause").click()
    lab.get_by_label("Play").wait_for()
    stopped = status(lab)
    lab.page.wait_for_timeout(400)  # more than two of its steps
    assert status(lab) == stopped
    track.press("End")
    comes_to(last)


def test_the_robots_network_answers_as_python_does(labs):
    lab = labs[1]
    data = held(lab, "situations")
    stack = networks.NetworkStack(
        tuple(unpacked(weight) for weight in data["networks"]["weights"]),
        tuple(unpacked(bias) for bias in data["networks"]["biases"]),
    )
    lab.locator("summary").click()
    rng = np.random.default_rng(0)
    for _ in range(5):
        state = [*rng.integers(0, 8, 9), rng.integers(1, 10), rng.integers(0, 2)]
        frame = int(rng.integers(len(data["frames"])))
        set_slider(lab, "iteration", frame)
        for sector in range(9):
            set_slider(lab, f"danger in sector {sector + 1}", int(state[sector]))
        set_slider(lab, "target in sector", int(state[9]) - 1)
        set_slider(lab, "target seen", int(state[10]))
        p = stack[frame].forward(np.array(state) / np.array([7] * 9 + [9, 1]))
        shown = lab.locator("svg text").filter(
            has_text=re.compile(r"^(F|[LR][36]0) \d")
        )
        expect(shown).to_have_text(
            [f"{name} {answer:.2f}" for name, answer in zip(ACTIONS, p, strict=True)]
        )
        expect(lab.locator(".status")).to_contain_text(f"({ACTIONS[p.argmax()]})")


def test_touching_a_sector_puts_an_obstacle_there(labs):
    lab = labs[1]
    picture = lab.locator("svg.dial")
    picture.scroll_into_view_if_needed()
    width = picture.bounding_box()["width"]
    ahead = {
        "x": width / 2,
        "y": width / 2 - width * (110 / 284) * 0.3,
    }  # 3 m ahead of the robot: degree 5
    picture.click(position=ahead)
    expect(picture).to_have_attribute("aria-label", re.compile("danger 5,"))
    picture.click(
        position={"x": width / 2, "y": 4}
    )  # outside the circle: the target, ahead
    expect(picture).to_have_attribute("aria-label", re.compile("target in sector 1$"))


def test_moments_of_the_demonstrations_come_back(labs):
    lab = labs[1]
    data = held(lab, "situations")
    for index in (0, 3, len(data["situations"]) - 1):
        lab.get_by_label("a moment of a demonstration").select_option(index=index)
        degrees = ", ".join(map(str, data["situations"][index]["state"][:9]))
        expect(lab.locator("svg.dial")).to_have_attribute(
            "aria-label", re.compile(f"danger {degrees};")
        )
        expect(lab.locator(".status")).to_contain_text("the expert")
