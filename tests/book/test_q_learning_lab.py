"""The Q-learning lab from disk, with no network: train from nothing, cancel, set, go wrong, look back, take away."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
import pytest
from accessibility import AXE, RUN
from browser import DESKTOP, PHONE, Visit, empty_storage, touch
from mounting import mounted, mounted_alone
from playwright.sync_api import Locator, expect
from scipy.stats import binomtest
from test_controls import choose_everything, press_everything

from robonav.networks import (
    NetworkPolicy,
    Weights,
    load_weights,
    random_network,
    save_weights,
)
from robonav.nnql import STARTS, TARGETS, NavigationTask, nnql
from robonav.robot import Encoder, navigate, random_worlds
from robonav.widgets.q_learning_faults import FAULTS, OF_THE_TABLES
from robonav.widgets.q_learning_lab import MAPS_SEED, q_learning_lab
from robonav.widgets.q_learning_settings import QLearningSettings

PAYS_FOR_SAFETY = FAULTS[0]
KEPT_NAMES = """() => Object.entries(localStorage)
  .filter(([key]) => key.startsWith("robonav.robot."))
  .map(([, text]) => JSON.parse(text).name)"""
CROSSES = re.compile(
    r"^Done in [\d.]+ s\. Your robot crosses (\d+) of (\d+) new maps: "
)


@pytest.fixture(params=[DESKTOP, PHONE], ids=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit) -> Iterator[Visit]:
    visit.page.set_viewport_size(request.param)
    yield visit
    empty_storage(visit.page)
    assert visit.errors == visit.external == []


def said(lab: Locator) -> Locator:
    return lab.locator(".training .status").first


def train(lab: Locator) -> tuple[int, int]:
    """Train, and give how many of how many new maps the robot crosses."""
    lab.get_by_role("button", name="Train", exact=True).press("Enter")
    expect(said(lab)).to_have_text(CROSSES)
    found = CROSSES.match(said(lab).inner_text())
    assert found
    return int(found[1]), int(found[2])


def group(lab: Locator, title: str) -> None:
    """Opens a group of settings by keyboard."""
    lab.locator("summary", has_text=title).press("Enter")


def cells(lab: Locator, robot: str) -> list[str]:
    row = lab.locator("table.results tr").filter(
        has=lab.page.get_by_role("rowheader", name=robot, exact=True)
    )
    return row.locator("td").all_inner_texts()


def test_a_robot_learns_from_nothing_and_crosses_new_maps(view):
    lab = mounted_alone(view, q_learning_lab())
    arrived, maps = train(lab)
    assert (arrived >= 80, maps) == (True, 100)
    for robot, least in [
        ("your robot", 80),
        ("the book's NNQL", 90),
        ("straight on", 30),
    ]:
        rate, interval, collided, endless = cells(lab, robot)
        number = round(float(rate))
        assert number >= least
        assert number + int(collided) + int(endless) == 100
        ends = binomtest(number, 100).proportion_ci(method="wilson")
        assert interval == f"{100 * ends.low:.1f} to {100 * ends.high:.1f}"
    assert float(cells(lab, "straight on")[0]) < 70
    curve = lab.get_by_role("img", name=re.compile("^arrivals in 30"))
    expect(curve).to_have_attribute(
        "aria-label", re.compile(r"at first, \d+ after 300$")
    )
    grey = lab.locator(".curves path[stroke-opacity]")
    assert [path.get_attribute("d") for path in grey.all()] == [""] * 4
    beyond = lab.get_by_role("img", name=re.compile(r"^targets out of \[0, 1\] \(%\)"))
    share = re.search(r"(\d+) after 300$", beyond.get_attribute("aria-label"))
    assert 15 < int(share[1]) < 40
    lab.get_by_label("afterwards, test in").select_option("200 new maps")
    group(lab, "Robot and maps")
    lab.get_by_label("seed of the random numbers").fill("1")
    assert train(lab)[1] == 200
    assert all(path.get_attribute("d").startswith("M") for path in grey.all())


BETWEEN = """(lab) => {
  const [button, map] = [".training button", "canvas"].map((what) => lab.querySelector(what).getBoundingClientRect());
  return map.bottom - button.top;
}"""


def test_map_of_the_episodes_is_in_sight_of_the_button(view):
    lab = mounted_alone(view, q_learning_lab())
    assert lab.evaluate(BETWEEN) < PHONE["height"] - 100
    button = lab.get_by_role("button", name="Train", exact=True)
    button.click()
    waiting = lab.get_by_role("button", name="Cancel", exact=True)
    expect(lab.get_by_label("look at")).to_be_disabled()
    waiting.click()
    assert lab.evaluate(BETWEEN) < PHONE["height"] - 100  # nothing has moved it away


def test_the_episodes_and_the_new_maps_are_looked_at(view):
    lab = mounted_alone(view, q_learning_lab())
    arrived, maps = train(lab)
    small = lab.get_by_role("group", name="Eight episodes of the training")
    expect(small.get_by_role("button")).to_have_count(8)
    assert small.get_by_role("button").all_inner_texts()[1].strip().startswith("20: ")
    touch(small.get_by_role("button").nth(1))
    board = lab.get_by_role("img", name=re.compile("^Map with the path"))
    expect(board).to_have_attribute("aria-label", re.compile("Episode 20 of 300, "))
    lab.get_by_label("One on").first.press("Enter")
    expect(board).to_have_attribute("aria-label", re.compile("Episode 21 of 300, "))
    second = lab.get_by_label("second", exact=True).and_(lab.locator("input"))
    picture, whole = (
        "(map) => map.toDataURL()",
        board.evaluate("(map) => map.toDataURL()"),
    )
    second.press("Home")
    expect(second).to_have_attribute("aria-valuetext", re.compile("^0 of "))
    assert board.evaluate(picture) != whole
    second.press("End")
    assert board.evaluate(picture) == whole
    lab.get_by_label("look at").select_option("new maps that it crossed")
    expect(board).to_have_attribute(
        "aria-label", re.compile(f"Map 1 of {arrived}, arrived after")
    )
    lab.get_by_label("look at").select_option("new maps where it failed")
    failed = (
        f"Map 1 of {maps - arrived}, "
        if arrived < maps
        else "There are no new maps where it failed."
    )
    expect(lab.get_by_text(failed).first).to_be_visible()


def test_a_training_is_cancelled_while_the_page_answers(view):
    lab = mounted_alone(view, q_learning_lab("robot"))
    lab.get_by_label("episodes", exact=True).fill("2000")
    lab.get_by_role("button", name="Train", exact=True).press("Enter")
    expect(lab.get_by_role("button", name=re.compile("^1: "))).to_be_enabled()
    lab.get_by_role("button", name="The thesis's settings").click()
    expect(
        lab.get_by_text(re.compile("Changed: .*discount 0.7 instead of 0.6"))
    ).to_be_visible()
    lab.get_by_role("button", name="Cancel").press("Enter")
    expect(said(lab)).to_contain_text("Cancelled. ")
    expect(lab.get_by_role("button", name="Download the weights")).to_be_disabled()
    expect(lab.get_by_label("look at")).to_be_visible()
    lab.get_by_label("episodes", exact=True).fill("60")
    train(lab)


@pytest.mark.parametrize(
    ("title", "label", "value", "sentence"),
    [
        ("Exploration", "temperature, start", "0", "Temperature, start must be greater than 0 and at most 100, got 0."),
        ("Reward", "reward for any to safe", "11", "Reward for any to safe must be from -10 to 10, got 11."),
        ("Robot", "episodes", "2.5", "Episodes must be a whole number, got 2.5."),
        ("Learning", "discount", "", "Discount must be a number."),
    ],
)  # fmt: skip
def test_a_wrong_number_gets_one_sentence(view, title, label, value, sentence):
    lab = mounted_alone(view, q_learning_lab())
    group(lab, title)
    field = lab.get_by_label(label, exact=True)
    field.fill(value)
    field.press("Tab")
    expect(lab.locator(".note")).to_have_text(sentence)
    expect(field).to_have_attribute("aria-invalid", "true")
    expect(lab.get_by_text("Nothing is changed")).to_have_count(0)
    group(lab, title)
    lab.get_by_role("button", name="Train", exact=True).click()
    expect(said(lab)).to_have_text(sentence)
    expect(lab.get_by_text(sentence)).to_have_count(1)
    expect(lab.get_by_role("button", name="Cancel")).to_have_count(0)
    expect(field).to_be_focused()
    lab.get_by_role("button", name="The book's settings").click()
    expect(field).to_have_attribute("aria-invalid", "false")
    expect(lab.get_by_text("Nothing is changed")).to_be_visible()


def test_train_is_pressed_while_a_number_is_typed(view):
    lab = mounted_alone(view, q_learning_lab("robot"))
    for label in (
        "obstacles that stand still",
        "obstacles that move",
        "speed of the robot (m/s)",
    ):
        lab.get_by_label(label).fill("3")
    lab.get_by_label("episodes", exact=True).fill("30")
    lab.get_by_role("button", name="Train", exact=True).click()
    expect(said(lab)).to_have_text(CROSSES)


def test_a_fault_is_watched_and_cured(view):
    lab = mounted_alone(
        view, q_learning_lab(settings=OF_THE_TABLES, presets=[PAYS_FOR_SAFETY])
    )
    expect(lab.get_by_text(PAYS_FOR_SAFETY.watch)).to_be_visible()
    group(lab, "Reward")
    paid = lab.get_by_label("reward for any to safe")
    expect(paid).to_have_value("0.6")
    train(lab)
    assert int(cells(lab, "your robot")[3]) >= 5
    lab.get_by_label("look at").select_option("new maps where it failed")
    expect(
        lab.get_by_text(re.compile("Map 1 of .* never ended after 400 s")).first
    ).to_be_visible()
    touch(lab.get_by_role("button", name="Cure it"))
    expect(
        lab.get_by_text(re.compile(f"^{re.escape(PAYS_FOR_SAFETY.cure)}"))
    ).to_be_visible()
    expect(paid).to_have_value("0")
    failed = cells(lab, "your robot")
    train(lab)
    assert int(cells(lab, "your robot")[3]) <= 1
    assert cells(lab, "the run before") == failed


@pytest.mark.parametrize("inputs", ["number", "raw"])
def test_the_weights_drive_in_python_as_in_the_page(visit, tmp_path, inputs):
    lab_settings = QLearningSettings(inputs=inputs, episodes=90, seed=3)
    lab = mounted_alone(visit, q_learning_lab(settings=lab_settings))
    empty_storage(visit.page)
    arrived, _ = train(lab)
    with visit.page.expect_download() as download:
        lab.get_by_role("button", name="Download the weights").click()
    download.value.save_as(tmp_path / "mine.safetensors")
    weights = load_weights(tmp_path / "mine.safetensors")
    made = weights.made
    assert (weights.method, weights.temperature) == ("nnql", 0.4)
    assert QLearningSettings.from_page(made) == lab_settings
    changed = [
        "episodes 90 instead of 300",
        "seed of the random numbers 3 instead of 0",
    ]
    raw = ["target's sector: a number; no input is scaled"] if inputs == "raw" else []
    assert made["changed"] == changed + raw
    inputs_changed = "inputs raw, " if inputs == "raw" else ""
    assert made["name"] == f"nnql, {inputs_changed}90 episodes, seed 3"
    worlds = random_worlds(100, 10, seed=MAPS_SEED, starts=STARTS, targets=TARGETS)
    policy = NetworkPolicy(weights.network, weights.encoder)
    assert navigate(policy, worlds, 2.5, 400).success.sum() == arrived


def test_a_robot_is_trained_on_and_every_robot_has_a_name_that_tells_it(view, tmp_path):
    """A policy of chapter 3, saved by Python, goes on by NNQL, and the robot that comes of it by the online method."""
    lab = mounted_alone(view, q_learning_lab("learning", "robot", "exploration"))
    empty_storage(view.page)
    begin = lab.get_by_label("begin with", exact=True)
    expect(begin).to_be_disabled()
    encoder = Encoder()
    network = random_network((encoder.size, 6, 5), seed=3)
    save_weights(tmp_path / "lfd.safetensors", Weights(network, "lfd", encoder))
    lab.get_by_label("Weights to begin with").set_input_files(
        tmp_path / "lfd.safetensors"
    )
    expect(begin).to_have_value("lfd.safetensors")
    hidden, reads = (
        lab.get_by_label("hidden units"),
        lab.get_by_label("target's sector"),
    )
    expect(hidden).to_be_disabled()
    expect(reads).to_be_disabled()
    expect(
        lab.get_by_text("It begins with the weights of lfd.safetensors")
    ).to_be_visible()
    lab.get_by_label("episodes", exact=True).fill("1")
    lab.get_by_label("temperature, start").fill("0.2")
    lab.get_by_label("seed of the random numbers").fill("5")
    train(lab)
    with view.page.expect_download() as download:
        lab.get_by_role("button", name="Download the weights").click()
    download.value.save_as(tmp_path / "mine.safetensors")
    mine = load_weights(tmp_path / "mine.safetensors")
    env = NavigationTask(encoder=encoder).environment()
    further = nnql(env, network, episodes=1, temperature=(0.2, 0.1), seed=5)
    for ours, theirs in zip(mine.network.weights, further.weights, strict=True):
        np.testing.assert_allclose(ours, theirs, atol=1e-9)
    first = "nnql, on from lfd.safetensors, 1 episode, temperature 0.2 to 0.1, seed 5"
    begin.select_option(first)
    lab.get_by_label("method", exact=True).select_option(
        "online: the latest pair alone"
    )
    train(lab)
    begin.select_option("random weights")
    expect(hidden).to_be_enabled()
    train(lab)
    names = view.page.evaluate(KEPT_NAMES)
    second = "online, on from nnql, on from lfd.safet…, 1 episode, temperature 0.2 to 0.1, seed 5"
    third = "online, 1 episode, temperature 0.2 to 0.1, seed 5"
    assert sorted(names) == sorted([first, second, third])


def test_dqn_takes_a_step_of_its_own_and_learns(view):
    lab = mounted_alone(view, q_learning_lab("learning"))
    step, rate = (
        lab.get_by_label("step of gradient descent, start"),
        lab.get_by_label("learning rate, start"),
    )
    lab.get_by_label("method", exact=True).select_option("double DQN: replay, Adam")
    expect(step).to_have_value("0.003")
    expect(rate).to_be_disabled()
    assert train(lab)[0] >= 80
    assert cells(lab, "your robot at T = 0.04")
    lab.get_by_label("method", exact=True).select_option(
        "NNQL: all pairs of the episode"
    )
    expect(step).to_have_value("0.3")
    expect(rate).to_be_enabled()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_out_of_reach(view, scheme):
    view.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    lab = mounted_alone(
        view,
        q_learning_lab(
            "reward", "exploration", "learning", "robot", presets=[PAYS_FOR_SAFETY]
        ),
    )
    lab.get_by_label("episodes", exact=True).fill("60")
    train(lab)
    width = view.page.evaluate("document.documentElement.scrollWidth - innerWidth")
    assert width <= 0
    view.page.evaluate(AXE.read_text("utf-8"))
    assert view.page.evaluate(RUN) == []


def test_every_control_does_something(visit):
    visit.page.set_viewport_size(PHONE)
    lab = mounted_alone(
        visit,
        q_learning_lab("reward", "exploration", "learning", "robot", presets=FAULTS),
    )
    choose_everything(lab)
    press_everything(lab)
    expect(said(lab)).to_have_text(CROSSES)
    for name in ("look at", "Play", "One back"):
        expect(lab.get_by_label(name).first).to_be_enabled()
    assert visit.errors == visit.external == []


def test_moving_obstacles_move_when_an_episode_is_looked_at(visit):
    settings = QLearningSettings(obstacles=0, moving=6, episodes=1)
    lab = mounted_alone(visit, q_learning_lab(settings=settings))
    train(lab)
    board = lab.get_by_role("img", name=re.compile("^Map with the path"))
    second = lab.get_by_label("second", exact=True).and_(lab.locator("input"))
    purple = """(map) => {
      const { width, height } = map, pixels = map.getContext("2d").getImageData(0, 0, width, height).data;
      let where = [];
      for (let i = 0; i < width * height; i += 1) if (pixels[4 * i] === 204 && pixels[4 * i + 1] === 121) where.push(i);
      return [where.length, where.reduce((sum, i) => sum + i, 0)];
    }"""
    (before, first), _ = board.evaluate(purple), second.press("Home")
    after, moved = board.evaluate(purple)
    assert min(before, after) > 100
    assert first != moved


def test_without_a_kernel_nothing_speaks_of_python(view):
    lab = mounted_alone(view, q_learning_lab())
    expect(lab.get_by_text("in Python")).to_have_count(0)


def test_with_a_kernel_several_robots_are_trained_watched_and_cancelled(visit, http):
    widget = q_learning_lab(settings=QLearningSettings(episodes=30))
    lab = mounted(visit, http, widget, kernel=True)
    begin = lab.get_by_role("button", name="Train in Python")
    note = lab.locator("fieldset .training .status")
    begin.click()
    expect(note).to_have_text(
        re.compile(
            r"^Done in [\d.]+ s\. 4 robots cross [\d.]+ % of 400 new maps on average, "
        )
    )
    assert len(widget.trainings) == 4
    lab.get_by_label("robots, each").select_option("16")
    begin.click()
    lab.get_by_role("button", name="Cancel").click()
    expect(note).to_contain_text("Cancelled. ")
    lab.get_by_label("robots, each").select_option("1")
    begin.click()
    expect(note).to_have_text(re.compile("One robot crosses"))
    lab.locator("summary", has_text="Learning").click()
    lab.get_by_label("discount").fill("2")
    begin.click()
    expect(note).to_have_text("Discount must be from 0 to 1, got 2.")
    assert visit.errors == []
