"""The robot playground, used as a reader would, and its demonstrations compared with Python's."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from accessibility import AXE, RUN_FROM_DISK
from browser import DESKTOP, PHONE, Visit, empty_storage, swipe
from driving import keep_robots, kept_robot, playground
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.benchmark.policies import method, methods
from robonav.lfd import load_demonstrations
from robonav.networks import (
    NetworkPolicy,
    Weights,
    load_weights,
    random_network,
    save_weights,
)
from robonav.robot import (
    Encoder,
    navigate,
    random_worlds,
    sense,
    straight,
    turn_to_clearer_side,
)
from robonav.robot.team import navigate_team, random_teams

ME = "you"
WIDER = "document.documentElement.scrollWidth - innerWidth"
GREEDY = [
    name
    for name in methods()
    if isinstance(method(name), NetworkPolicy) and method(name).temperature == 0
]


@pytest.fixture(params=["desktop", "phone"])
def lab(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Locator]:
    """The playground on its page: served to a desktop, or from disk on a phone."""
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    visit.leave_formulas()
    visit.open(
        f"{request.getfixturevalue('http') if desktop else site.as_uri()}/book/playground.html"
    )
    found = visit.page.locator(".robot-playground")
    found.locator("canvas").wait_for()
    empty_storage(visit.page)
    yield found
    assert visit.errors == []


def choose(lab: Locator, label: str, option: str) -> None:
    lab.get_by_label(label, exact=True).select_option(option)


def status(lab: Locator) -> Locator:
    return lab.locator(".status:not(.kept)")


def drive_to_the_end(lab: Locator) -> str:
    """Lets the chosen driver go as fast as it may, and gives what is said at the end."""
    pace = lab.get_by_label("steps a second", exact=True).and_(lab.locator("input"))
    pace.evaluate(
        "(input) => { input.value = input.max; input.dispatchEvent(new Event('input')); }"
    )
    lab.get_by_role("button", name="Drive", exact=True).click()
    expect(status(lab)).to_contain_text(re.compile("Arrived|Collided"))
    return status(lab).inner_text()


def test_rules_end_as_in_python(lab):
    for world, made in (
        ("20 obstacles", random_worlds(1, 20, seed=42)),
        ("10 standing, 10 moving", None),
    ):
        choose(lab, "world", world)
        choose(lab, "who drives", "rule: freer-side")
        expected = navigate(
            turn_to_clearer_side, made or random_worlds(1, 10, 10, seed=44)
        )
        said = drive_to_the_end(lab)
        assert (
            said == f"{expected.outcome[0].capitalize()} after {expected.steps[0]} s."
        )
    several_end_as_in_python(lab)
    the_reader_drives_among_others(lab)


def several_end_as_in_python(lab: Locator) -> None:
    """Robot 1 has another rule than the others, and the ends of all are counted."""
    choose(lab, "world", "nothing at all")
    crowd = lab.get_by_role("slider", name="robots on the map", exact=True)
    crowd.press("End")
    choose(lab, "who drives the others", "rule: freer-side")
    choose(lab, "who drives", "rule: straight")
    teams = random_teams(1, 16, 0, seed=0)
    policies = [straight, *[turn_to_clearer_side] * 15]
    expected = navigate_team(policies, teams)
    lab.get_by_role("button", name="Drive", exact=True).click()
    expect(lab.locator(".tally")).to_have_text(
        f"{expected.steps.max()} s, 16 robots: {expected.success.sum()} arrived, "
        f"{expected.collision.sum()} collided ({expected.met.sum()} with a robot)."
    )
    first = f"{expected.outcome[0, 0].capitalize()} after {expected.steps[0, 0]} s."
    expect(status(lab)).to_have_text(f"Robot 1: {first}")


def the_reader_drives_among_others(lab: Locator) -> None:
    """The others go on when the reader does, and nothing of it is a demonstration."""
    lab.get_by_role("slider", name="robots on the map", exact=True).press("ArrowLeft")
    choose(lab, "who drives", ME)
    lab.get_by_label("the robot goes on by itself").uncheck()
    lab.get_by_role("button", name="ahead").click()
    lab.locator("canvas").press("ArrowLeft")
    expect(lab.locator(".tally")).to_have_text(
        "2 s, 15 robots: 0 arrived, 0 collided, 15 on the way."
    )
    save = lab.get_by_role("button", name="Download this demonstration")
    expect(save).to_be_disabled()
    choose(lab, "world", "30 obstacles")
    expect(lab.get_by_text(re.compile(r"^Left out: \d+ obstacle"))).to_be_visible()
    assert lab.page.evaluate(WIDER) <= 0


def test_every_driver_drives(lab):
    drivers = (
        lab.get_by_label("who drives", exact=True).locator("option").all_text_contents()
    )
    assert len(drivers) == 1 + len(methods())
    for driver in drivers:
        choose(lab, "who drives", driver)
        if driver != ME:
            lab.get_by_role("button", name="Back to the start").click()
            for _ in range(3):
                lab.get_by_role("button", name="One step").click()
            expect(status(lab)).to_contain_text("3 s, target in sector")


def test_readings_are_pythons(lab):
    choose(lab, "world", "30 obstacles")
    world = random_worlds(1, 30, seed=43)
    choose(lab, "who drives", "rule: straight")
    for _ in range(6):
        lab.get_by_role("button", name="One step").click()
    expect(status(lab)).to_contain_text("6 s, target in sector")
    path = navigate(
        lambda seen, rng: np.zeros(len(seen), dtype=int),
        world,
        max_steps=6,
        record_paths=True,
    ).paths[0]
    seen = sense(world, path[-1:])
    rows = lab.locator(".readings tbody tr").all()
    for row, distance in zip(rows, seen.ranges[0], strict=True):
        expect(row.locator("td").first).to_have_text(f"{distance:.2f}")


def test_obstacles_are_added_dragged_resized_and_removed(lab):
    choose(lab, "world", "nothing at all")
    lab.get_by_role("button", name="Add a circle").click()
    thing = lab.get_by_label("Thing to change")
    expect(thing).to_have_value("0")
    canvas = lab.locator("canvas")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    mouse = lab.page.mouse
    mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    mouse.down()
    mouse.move(box["x"] + box["width"] * 0.3, box["y"] + box["height"] / 2, steps=4)
    mouse.up()
    x = lab.get_by_label("x (m)")
    expect(x).to_have_value(re.compile(r"^(2[89]|30)"))
    x.fill("140")
    x.press("Enter")
    expect(x).to_have_value("100")  # the map's border
    lab.get_by_label("radius (m)").fill("5")
    lab.get_by_label("radius (m)").press("Tab")
    lab.get_by_label("speed (m/s)").fill("0.5")
    lab.get_by_label("speed (m/s)").press("Tab")
    expect(canvas).to_have_attribute("aria-label", re.compile("1 obstacles"))
    lab.get_by_role("button", name="Add a rectangle").click()
    expect(lab.get_by_label("length (m)")).to_have_value("6")
    lab.get_by_role("button", name="Remove").click()
    expect(canvas).to_have_attribute("aria-label", re.compile("1 obstacles"))
    expect(thing).to_have_value("robot")
    expect(lab.get_by_role("button", name="Remove")).to_have_count(0)


def test_fields_follow_what_moves_but_not_while_one_types(lab):
    choose(lab, "world", "10 standing, 10 moving")
    lab.get_by_label("Thing to change").select_option(index=21)
    x, y = lab.get_by_label("x (m)"), lab.get_by_label("y (m)")
    before = x.input_value(), y.input_value()
    x.focus()
    for _ in range(3):
        lab.get_by_role("button", name="One step").evaluate(
            "(button) => button.click()"
        )  # the focus stays
    expect(status(lab)).to_contain_text("3 s")
    assert x.input_value() == before[0]
    expect(y).not_to_have_value(before[1])


def test_a_finger_drags_things_and_scrolls_elsewhere(visit, http):
    visit.page.set_viewport_size(PHONE)
    visit.open(f"{http}/book/playground.html")
    lab = visit.page.locator(".robot-playground")
    choose(lab, "world", "nothing at all")
    lab.get_by_role("button", name="Add a circle").click()
    canvas = lab.locator("canvas")
    canvas.evaluate("(map) => map.scrollIntoView({ block: 'center' })")
    box = canvas.bounding_box()
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    x = lab.get_by_label("x (m)")
    swipe(visit.page, middle, (middle[0] - 0.2 * box["width"], middle[1]))
    expect(x).to_have_value(re.compile(r"^(2[89]|30)"))
    scrolled = visit.page.evaluate("scrollY")
    swipe(visit.page, (middle[0], middle[1] + 100), (middle[0], middle[1] - 100))
    visit.page.wait_for_function("(before) => scrollY > before + 50", arg=scrolled)
    expect(x).to_have_value(re.compile(r"^(2[89]|30)"))


def test_a_demonstration_of_ones_own_is_a_demonstration_for_python(lab, tmp_path):
    choose(lab, "world", "10 obstacles")
    save = lab.get_by_role("button", name="Download this demonstration")
    expect(save).to_be_disabled()
    canvas = lab.locator("canvas")
    lab.get_by_label("the robot goes on by itself").uncheck()
    canvas.focus()
    for key in ("ArrowUp", "ArrowLeft", "Shift+ArrowRight", "ArrowUp"):
        lab.page.keyboard.press(key)
    lab.get_by_role("button", name="right 30°").click()
    expect(lab.get_by_label("who drives", exact=True)).to_have_value(ME)
    expect(status(lab)).to_contain_text("5 s, target in sector")
    with lab.page.expect_download() as download:
        save.click()
    download.value.save_as(tmp_path / "mine.npz")
    mine = load_demonstrations(tmp_path / "mine.npz")
    world = random_worlds(1, 10, seed=41)
    assert mine.worlds.digest() == world.digest()
    assert len(mine) == 5
    np.testing.assert_allclose(
        sense(world[np.zeros(5, dtype=int)], mine.poses).ranges,
        mine.sensing.ranges,
        atol=1e-9,
    )


def test_weights_of_ones_own_drive(lab, tmp_path):
    encoder = Encoder(target="signed")
    own = NetworkPolicy(
        random_network((encoder.size, 4, 5), seed=5, spread=3.0), encoder
    )
    save_weights(tmp_path / "own.safetensors", Weights(own.network, "own", encoder))
    (tmp_path / "bad.safetensors").write_bytes(b"nothing")
    upload = lab.get_by_label("Weights to drive with")
    upload.set_input_files(tmp_path / "bad.safetensors")
    expect(
        lab.get_by_text("The file must hold weights saved by robonav")
    ).to_be_visible()
    for name in ("own.safetensors", "own.safetensors (2)"):
        upload.set_input_files(tmp_path / "own.safetensors")
        expect(lab.get_by_text(f"{name} drives now.")).to_be_visible()
    choose(lab, "world", "20 obstacles")
    expected = navigate(
        own, random_worlds(1, 20, seed=42), max_steps=40, record_paths=True
    )
    for _ in range(len(expected.paths[0]) - 1):
        lab.get_by_role("button", name="One step").click()
    x, y = (f"{value:.1f}".removesuffix(".0") for value in expected.paths[0][-1][:2])
    expect(lab.locator("canvas")).to_have_attribute(
        "aria-label", re.compile(re.escape(f"Robot at {x}, {y}. "))
    )


def test_robots_that_were_trained_and_kept_drive(lab):
    drivers = lab.get_by_label("who drives", exact=True)
    expect(drivers.locator("optgroup")).to_have_count(0)
    policy, world = method("lfd"), random_worlds(1, 20, seed=42)
    keep_robots(lab.page, kept_robot("first", policy), kept_robot("second", policy))
    own = drivers.locator("optgroup[label='robots of yours'] option")
    expect(own).to_have_text(["second", "first"])  # the latest first
    choose(lab, "world", "20 obstacles")
    choose(lab, "who drives", "first")
    expected = navigate(policy, world)
    assert (
        drive_to_the_end(lab)
        == f"{expected.outcome[0].capitalize()} after {expected.steps[0]} s."
    )
    empty_storage(lab.page)
    expect(own).to_have_count(0)
    expect(drivers).to_have_value("LfD, then DAgger")  # the first of the list


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_robots_are_listed_renamed_taken_along_and_deleted(visit, site, size, tmp_path):
    visit.page.set_viewport_size(size)
    lab = mounted(visit, site.as_uri(), playground())
    empty_storage(visit.page)
    drivers = lab.get_by_label("who drives", exact=True)
    own = drivers.locator("optgroup[label='robots of yours'] option")
    policy = method("lfd")
    first, second = (kept_robot(name, policy) for name in ("first", "second"))
    about = {
        "about": "Learned from five demonstrations.",
        "made": {"demonstrations": 5},
    }
    keep_robots(lab.page, first | about, second)
    robots = lab.locator(".my-robots")
    robots.get_by_text("My robots (2)").press("Enter")
    items = robots.locator("li")
    expect(items.first).to_contain_text("second")  # the latest first
    expect(items.last).to_contain_text("Learned from five demonstrations.")
    with lab.page.expect_download() as download:
        robots.get_by_role("button", name="Download first").press("Enter")
    assert download.value.suggested_filename == "first.safetensors"
    download.value.save_as(tmp_path / "first.safetensors")
    weights = load_weights(tmp_path / "first.safetensors")
    assert weights.made["demonstrations"] == 5
    assert weights.made["about"] == "Learned from five demonstrations."
    np.testing.assert_array_equal(weights.network.weights[0], policy.network.weights[0])
    choose(lab, "who drives", "first")
    robots.get_by_role("button", name="Rename first").press("Enter")
    field = robots.get_by_label("new name of first")
    expect(field).to_be_focused()
    field.fill("")
    field.press("Enter")
    heard = robots.get_by_role("status")
    expect(heard).to_have_text("A robot needs a name.")
    field.fill("second")
    field.press("Enter")
    expect(robots.get_by_role("button", name="Rename second (2)")).to_be_focused()
    expect(own).to_have_text(["second", "second (2)"])
    expect(drivers.locator("option:checked")).to_have_text("second (2)")
    robots.get_by_role("button", name="Delete second (2)").press("Enter")
    expect(own).to_have_text(["second"])
    expect(drivers).to_have_value("LfD")  # the first of the list
    expect(heard).to_have_text("second (2) is deleted.")
    undo = robots.get_by_role("button", name="Undo")
    expect(undo).to_be_focused()
    assert lab.page.evaluate(WIDER) <= 0
    lab.page.evaluate("() => { window.define = undefined; }")
    lab.page.evaluate(AXE.read_text("utf-8"))
    assert lab.page.evaluate(RUN_FROM_DISK.replace("document", "'.my-robots'")) == []
    undo.press("Enter")
    expect(own).to_have_text(["second", "second (2)"])
    expect(items.last).to_contain_text("Learned from five demonstrations.")
    expect(undo).to_be_hidden()
    empty_storage(visit.page)
    assert visit.errors == visit.external == []


@pytest.mark.parametrize("name", GREEDY[:1])
def test_what_a_network_thinks_is_pythons(lab, name):
    choose(lab, "world", "30 obstacles")
    policy, world = method(name), random_worlds(1, 30, seed=43)
    lab.get_by_label("who drives", exact=True).select_option(
        index=methods()[2:].index(name)
    )
    path = navigate(policy, world, max_steps=6, record_paths=True).paths[0]
    for _ in range(6):
        lab.get_by_role("button", name="One step").click()
    expect(status(lab)).to_contain_text("6 s, target in sector")
    values = policy.network.forward(policy.encoder(sense(world, path[6:7])))[0]
    shown = lab.locator(".values span")
    expect(shown).to_have_text([re.compile(f" {value:.2f}$") for value in values])
