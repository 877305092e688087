"""The search lab, used as a reader would, and its numbers compared with Python's."""

from __future__ import annotations

import re

import pytest
from browser import DESKTOP, PHONE
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.lfd import plan, plan_on_grid
from robonav.robot import random_worlds
from robonav.widgets.search_lab import search_lab

WORLDS = {"ten": random_worlds(1, 10, seed=41), "thirty": random_worlds(1, 30, seed=43)}


@pytest.fixture
def lab(visit, place):
    yield mounted(visit, place, search_lab(WORLDS))
    assert visit.errors == []


def track(lab: Locator) -> Locator:
    return lab.get_by_label("nodes expanded", exact=True).and_(lab.locator("input"))


def told(lab: Locator) -> Locator:
    return lab.locator("figure .told")


PAINTED = """(canvas) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height)
  .data.filter((value, i) => i % 4 === 3 && value).length"""


def painted(lab: Locator, which: int) -> int:
    """How many pixels of a map are not empty."""
    return lab.locator("canvas").nth(which).evaluate(PAINTED)


@pytest.mark.parametrize(
    ("name", "margin", "cell"), [("ten", 2, 1), ("thirty", 4, 2), ("thirty", 1, 4)]
)
@pytest.mark.filterwarnings("ignore:plan found no path")
def test_every_setting_shows_its_own_searches(lab, name, margin, cell):
    lab.get_by_label("map", exact=True).select_option(name)
    lab.get_by_label("margin kept").select_option(f"{margin} m")
    lab.get_by_label("side of a cell").select_option(f"{cell} m")
    by_actions = plan(WORLDS[name], margin=margin, cell=cell)
    on_grid = plan_on_grid(WORLDS[name], margin=margin, cell=cell)
    for which, found in enumerate((by_actions, on_grid)):
        ended = f"done after {found.expanded} nodes: {found.length:.1f} m"
        expect(told(lab).nth(which)).to_have_text(
            ended if found.found else f"{found.expanded} nodes, and no way found"
        )
    cells = lab.locator("tbody tr").first.locator("td")
    if by_actions.found:
        steps = len(by_actions.actions)
        expect(cells.nth(0)).to_have_text(f"{by_actions.length:.1f}")
        expect(cells.nth(2)).to_have_text(f"{steps} actions, {steps} s")
    expect(cells.nth(1)).to_have_text(str(by_actions.expanded))


def test_nodes_appear_as_they_are_expanded(lab):
    most = max(plan(WORLDS["ten"]).expanded, plan_on_grid(WORLDS["ten"]).expanded)
    full = [painted(lab, which) for which in (0, 1)]
    lab.get_by_label("To the start").click()
    expect(told(lab).first).to_have_text("0 nodes, still searching")
    assert painted(lab, 0) < full[0]
    assert painted(lab, 1) < full[1]
    track(lab).press("ArrowRight")
    lab.get_by_label("One on").click()
    expect(told(lab).first).to_have_text(
        f"{round(most * 0.02**2)} nodes, still searching"
    )
    lab.get_by_label("Play").click()
    expect(told(lab).nth(1)).to_have_text(re.compile("^done after"))
    lab.get_by_label("Pause").click()
    track(lab).press("End")
    expect(told(lab).first).to_have_text(re.compile("^done after"))
    assert painted(lab, 0) == full[0]


def test_without_a_kernel_no_target_can_be_put(lab):
    expect(lab.locator("fieldset")).to_be_hidden()
    before = told(lab).first.inner_text()
    lab.locator("canvas").first.click()
    expect(told(lab).first).to_have_text(before)


def test_with_a_kernel_a_target_is_searched_for(visit, http):
    lab = mounted(visit, http, search_lab(WORLDS), kernel=True)
    lab.get_by_label("target x (m)").fill("15")
    lab.get_by_label("target y (m)").fill("200")
    lab.get_by_role("button", name="Search").click()
    expect(lab.locator(".status")).to_contain_text("target")
    before = told(lab).first.inner_text()
    canvas = lab.locator("canvas").first
    canvas.scroll_into_view_if_needed()
    side = canvas.bounding_box()["width"]
    canvas.click(
        position={"x": side * 0.86, "y": side * 0.14}
    )  # by the old target, where no obstacle stands
    expect(lab.get_by_label("target x (m)")).to_have_value("88")
    expect(lab.locator(".status")).to_have_text("")
    expect(told(lab).first).not_to_have_text(before)
    before = told(lab).first.inner_text()
    lab.get_by_label("target x (m)").fill("15")
    lab.get_by_label("target y (m)").fill("10")
    lab.get_by_label("target y (m)").press("Tab")
    lab.page.keyboard.press("Enter")
    expect(told(lab).first).not_to_have_text(before)
    assert visit.errors == []


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_the_page_on_a_star_searches_as_python_does(visit, site, size):
    visit.page.set_viewport_size(size)
    visit.leave_formulas()
    visit.open(f"{site.as_uri()}/book/a-star.html")
    lab = visit.page.locator(".search-lab")
    maps = {
        "20 obstacles": random_worlds(1, 20, seed=42),
        "target off the diagonal": random_worlds(1, 20, seed=12, targets=((90, 40),)),
    }
    for name, world in maps.items():
        lab.get_by_label("map", exact=True).select_option(name)
        for which, found in enumerate((plan(world), plan_on_grid(world))):
            expect(told(lab).nth(which)).to_have_text(
                f"done after {found.expanded} nodes: {found.length:.1f} m"
            )
    assert visit.errors == []
