"""The grid lab of the page on dynamic programming, used as a reader would, and its numbers compared with Python's."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from browser import DESKTOP, PHONE, Visit
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav import mdp
from robonav.widgets.grid_lab import grid_lab, replay

EXITS = {"+": mdp.Cell(reward=1, ends=True), "-": mdp.Cell(reward=-1, ends=True)}
TWO_ROOMS = """
    S . . # . . .
    . . . # . X .
    . # . . . . .
    . # X . # . .
    . . . . # . G
"""


@pytest.fixture(params=["desktop", "phone"])
def lab(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Locator]:
    """The lab on the opened page: served to a desktop, or from disk on a phone."""
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    visit.leave_formulas()
    visit.open(
        f"{request.getfixturevalue('http') if desktop else site.as_uri()}/book/dynamic-programming.html"
    )
    found = visit.page.locator(".grid-lab")
    found.wait_for()
    yield found
    assert visit.errors == []


def choose(lab: Locator, *options: str) -> None:
    for label, option in zip(
        ("map", "discount", "slip", "cost of a step"), options, strict=True
    ):
        lab.get_by_label(label, exact=True).select_option(option)


def track(lab: Locator) -> Locator:
    return lab.get_by_label("step", exact=True).and_(lab.locator("input"))


def shown(lab: Locator, which: int) -> tuple[list[float], list[int]]:
    """The values and arrows of one picture, ends left out."""
    texts = (
        lab.locator("figure")
        .nth(which)
        .locator('svg text[text-anchor="middle"]')
        .all_text_contents()
    )
    values = [float(text.replace("−", "-")) for text in texts if "." in text]
    turns = (
        lab.locator("figure")
        .nth(which)
        .locator("svg path[transform]")
        .evaluate_all(
            "(paths) => paths.map((path) => Number(/rotate\\((\\d+)\\)/.exec(path.getAttribute('transform'))[1]))"
        )
    )
    return values, [turn // 90 for turn in turns]


@pytest.mark.parametrize(
    ("name", "discount", "slip", "cost", "frame"),
    [
        ("two rooms", "0.9", "0.2", "0.04", 3),
        ("two rooms", "0.99", "0.5", "0.3", 20),
        ("4 x 3", "0.5", "0", "0", 2),
    ],
)
def test_every_setting_shows_its_own_sweeps_and_policies(
    lab, name, discount, slip, cost, frame
):
    choose(lab, name, discount, slip, cost)
    track(lab).evaluate(
        "(input, at) => { input.value = at; input.dispatchEvent(new Event('input')); }",
        frame,
    )
    settings = {"slip": float(slip), "step_reward": -float(cost)}
    grid = (
        mdp.four_by_three(**settings)
        if name == "4 x 3"
        else mdp.GridWorld(TWO_ROOMS, legend=EXITS, **settings)
    )
    model = grid.mdp(float(discount))
    swept = mdp.value_iteration(model, 0.02, record=True)
    iterated = mdp.policy_iteration(
        model, start=np.zeros(model.n_states, dtype=int), record=True
    )
    for which, (history, policies) in enumerate(
        ((swept.history, swept.policies), (iterated.history, iterated.policies))
    ):
        at = min(frame, len(history) - 1)
        said = lab.locator("figure .told").nth(which)
        expect(said).to_have_text(re.compile(f"^{('sweep', 'policy')[which]} {at}: "))
        values, arrows = shown(lab, which)
        np.testing.assert_allclose(values, history[at][~grid.terminal], atol=0.0051)
        assert arrows == policies[at][~grid.terminal].tolist()


def test_time_moves_by_button_keyboard_and_play(lab):
    said = lab.locator("figure .told").first

    def comes_to(step: int) -> None:
        expect(said).to_have_text(re.compile(f"^sweep {step}: "))

    comes_to(0)
    lab.get_by_label("One on").click()
    comes_to(1)
    track(lab).press("ArrowRight")
    comes_to(2)
    lab.get_by_label("One back").click()
    comes_to(1)
    lab.get_by_label("Play").click()
    expect(said).not_to_have_text(re.compile("^sweep 1: "))
    lab.get_by_label("Pause").click()
    lab.get_by_label("Play").wait_for()
    stopped = said.inner_text()
    lab.page.wait_for_timeout(800)  # more than two of its steps
    assert said.inner_text() == stopped
    track(lab).press("End")
    expect(said).to_contain_text("arrows optimal")
    lab.get_by_label("To the start").click()
    comes_to(0)


def test_the_mark_follows_touch_and_arrow_keys(lab):
    status = lab.locator(".status").first
    expect(status).to_contain_text("Row 1, column 1: ")
    grids = lab.get_by_role("group", name="Grids")
    grids.focus()
    for key in (
        "ArrowRight",
        "ArrowRight",
        "ArrowRight",
        "ArrowDown",
    ):  # over the wall in between
        lab.page.keyboard.press(key)
    expect(status).to_contain_text("Row 2, column 5: ")
    lab.locator("figure").nth(1).locator("rect.cell").last.click()
    expect(status).to_have_text(
        "Row 5, column 7: the episode ends here. Arriving earns 1 on top of the step."
    )
    lab.page.keyboard.press("ArrowUp")
    expect(status).to_contain_text("Row 4, column 7")
    lab.page.keyboard.press("ArrowDown")
    expect(status).to_contain_text("Row 5, column 7")
    lab.page.keyboard.press("ArrowDown")
    lab.page.keyboard.press("ArrowRight")
    expect(status).to_contain_text("Row 5, column 7")


def test_a_map_of_ones_own_is_offered_only_where_a_kernel_can_solve_it(lab):
    expect(lab.get_by_text("Draw a map of your own")).to_be_hidden()


def test_pictures_say_what_they_show(lab):
    labels = re.compile(r"(value|policy) iteration: (sweep|policy) 0: values")
    pictures = lab.locator("figure svg")
    expect(pictures).to_have_count(2)
    for picture in pictures.all():
        expect(picture).to_have_attribute("aria-label", labels)
    assert lab.evaluate("(element) => element.scrollWidth <= element.clientWidth")


def test_the_best_with_time_short_is_pythons(visit, site):
    visit.leave_formulas()
    visit.open(f"{site.as_uri()}/book/decision-processes.html")
    lab = visit.page.locator(".grid-lab")
    lab.get_by_label("slip", exact=True).select_option("0.2")
    lab.get_by_label("cost of a step").select_option("0.04")
    track(lab).evaluate(
        "(input) => { input.value = 12; input.dispatchEvent(new Event('input')); }"
    )
    expect(lab.locator("figure .told")).to_have_text("12 steps to go")
    grid = mdp.four_by_three(slip=0.2, step_reward=-0.04)
    plan = mdp.backward_induction(grid.mdp(1.0), 12)
    values, arrows = shown(lab, 0)
    np.testing.assert_allclose(values, plan.values[0][~grid.terminal], atol=0.0051)
    assert arrows == plan.policy[0][~grid.terminal].tolist()


def test_learners_and_their_trajectories_are_pythons(visit, site):
    visit.leave_formulas()
    visit.open(f"{site.as_uri()}/book/model-free-learning.html")
    lab = visit.page.locator(".grid-lab")
    lab.get_by_label("exploring ε").select_option("0.2")
    lab.get_by_label("learning rate α").select_option("0.5")
    track(lab).evaluate(
        "(input) => { input.value = 9; input.dispatchEvent(new Event('input')); }"
    )
    ends = {"X": mdp.Cell(reward=-99.0, ends=True), "G": mdp.Cell(ends=True)}
    cliff = mdp.GridWorld(
        "." * 7 + "\n" + "." * 7 + "\n" + "." * 7 + "\nSXXXXXG",
        legend=ends,
        step_reward=-1.0,
    )
    for which, learn in enumerate((mdp.q_learning, mdp.sarsa)):
        options = {
            "discount": 1.0,
            "learning_rate": 0.5,
            "epsilon": 0.2,
            "seed": 1,
            "record": True,
        }
        learned = learn(cliff.environment(), 50, **options)
        said = f"after episode 50, with a return of {learned.returns[49]:.0f}"
        expect(lab.locator("figure .told").nth(which)).to_have_text(said)
        values, arrows = shown(lab, which)
        q = learned.history[50][~cliff.terminal]
        np.testing.assert_allclose(values, q.max(axis=1), atol=0.051)
        assert arrows == q.argmax(axis=1).tolist()
        trajectory = (
            lab.locator("figure")
            .nth(which)
            .locator("svg path[stroke='#E69F00']")
            .get_attribute("d")
        )
        places = [
            tuple(map(float, place.split()))
            for place in re.split("[ML]", trajectory)[1:]
        ]
        assert places == [
            (64 * (c + 0.5), 64 * (r + 0.5))
            for r, c in cliff.cells[learned.visited_states[49]]
        ]


def test_with_a_kernel_a_map_of_ones_own_is_solved(visit, http):
    def solve(grid, choices=()):
        swept = mdp.value_iteration(grid.mdp(0.9), record=True)
        steps = [f"sweep {k}" for k in range(len(swept.history))]
        return {
            "sweeps": replay(
                grid.mdp(0.9),
                swept.history,
                swept.policies,
                best=swept.values,
                steps=steps,
            )
        }

    given, drawn = mdp.GridWorld("S.G"), mdp.GridWorld("S..\n.#G")
    widget = grid_lab({"map": given}, {}, {("map",): solve(given)}, solve=solve)
    lab = mounted(visit, http, widget, kernel=True)
    lab.get_by_text("Draw a map of your own").click()
    editor = lab.locator("textarea")
    expect(editor).to_have_value("S.G")
    editor.fill("S.?")
    lab.get_by_role("button", name="Solve").click()
    lab.get_by_text("symbols of the legend").wait_for()
    editor.fill(drawn.text)
    lab.get_by_role("button", name="Solve").click()
    lab.locator("rect.cell").nth(4).wait_for()
    track(lab).press("End")
    expect(lab.locator("figure .told")).to_contain_text("arrows optimal")
    values, arrows = shown(lab, 0)
    np.testing.assert_allclose(
        values, mdp.value_iteration(drawn.mdp(0.9)).values[:4], atol=0.0051
    )
    assert arrows[2] == 2
    assert visit.errors == []
