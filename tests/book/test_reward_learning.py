"""Learning a reward in the page: learn, look, try, train elsewhere, cancel, take away."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from accessibility import AXE, RUN_FROM_DISK
from browser import DESKTOP, PHONE, Visit, empty_storage
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.benchmark.policies import method
from robonav.lfd import demonstrate
from robonav.networks import load_weights
from robonav.nirl import RobotTask, learn, learn_under_reward
from robonav.robot import random_worlds
from robonav.widgets.reward_learning import reward_learning
from robonav.widgets.simulator import page_world

SLOW = 240_000  # milliseconds: a training on a busy machine
DEMONSTRATIONS = demonstrate(random_worlds(6, 20, seed=3))


@pytest.fixture(params=[DESKTOP, PHONE], ids=["desktop", "phone"])
def lab(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Locator]:
    """The widget alone on a page, from disk, with no network."""
    visit.page.set_viewport_size(request.param)
    widget = reward_learning(
        {"six": DEMONSTRATIONS},
        random_worlds(1, 20, seed=8),
        {"the book's NIRL": method("nirl")},
        n_worlds=100,
        seed=55_000,
    )
    found = mounted(visit, site.as_uri(), widget)
    empty_storage(visit.page)
    yield found
    empty_storage(visit.page)
    assert visit.errors == visit.external == []
    assert visit.page.evaluate(
        "document.documentElement.scrollWidth <= window.innerWidth"
    )


KEPT_NAMES = """() => Object.entries(localStorage)
  .filter(([key]) => key.startsWith("robonav.robot."))
  .map(([, text]) => JSON.parse(text).name)"""
ENDED = """() => {
  const statuses = [...document.querySelectorAll("#mounted .training .status")];
  const said = statuses.some((one) => one.textContent.startsWith("Done"));
  const driven = document.querySelector("#mounted caption")?.textContent ?? "";
  if (said && !driven.startsWith("100 of 100")) throw new Error(`Done is said at ${driven}`);
  return said;
}"""


def set_number(lab: Locator, label: str, value: float) -> None:
    field = lab.get_by_label(label, exact=True)
    field.fill(str(value))
    field.press("Tab")


def test_reward_is_learned_tried_used_elsewhere_and_taken_away(lab, tmp_path):
    set_number(lab, "iterations", 30)
    expect(lab.get_by_role("button", name="Download the policy")).to_be_disabled()
    lab.get_by_role("button", name="Learn the reward").click()
    lab.page.wait_for_function(ENDED, timeout=SLOW)  # it fails if the maps come after
    expect(lab.locator(".status").nth(1)).to_contain_text("is kept")
    expect(lab.locator("caption").first).to_contain_text("100 of 100")
    rates = [
        int(re.match(r"(\d+) %", text)[1])
        for text in lab.locator("table").first.locator("td").all_inner_texts()
    ]
    assert rates[0] > rates[1] + 30  # straight on, with twenty obstacles
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download the reward").click()
    download.value.save_as(tmp_path / "reward.npz")
    theta = np.load(tmp_path / "reward.npz")["reward_weights"]
    expected = learn(DEMONSTRATIONS, "nirl", seed=0, iterations=30)
    assert theta.shape == expected.reward_weights.shape == (5, 18)
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download the policy").click()
    download.value.save_as(tmp_path / "policy.safetensors")
    policy = load_weights(tmp_path / "policy.safetensors")
    assert policy.network.sizes == (17, 10, 5)
    made = policy.made
    assert (made["source"], made["demonstrations"], made["iterations"], made["seed"]) == (
        "six", 6, 30, 0,
    )  # fmt: skip
    assert made["reward"] == theta.tolist()
    assert "learned by NIRL from six with" in made["about"]

    verdict = f"It arrives in {rates[0]} % of 100 new maps, one that always goes straight on in {rates[1]} %."
    expect(lab.locator(".status").nth(1)).to_contain_text(verdict)

    set_number(lab, "moving obstacles", 5)
    lab.get_by_role("button", name="Train a new robot for this reward").click()
    elsewhere = lab.locator("caption", has_text="10 standing and 5 moving")
    expect(elsewhere).to_contain_text("100 of 100 new maps", timeout=SLOW)
    first = "100 of 100 new maps: 20 standing and 0 moving"
    expect(lab.locator("caption").first).to_contain_text(first)
    expect(lab.locator(".status").last).to_contain_text("straight on in", timeout=SLOW)
    expect(lab.get_by_text("The new robot is kept. It arrives in")).to_be_visible()
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download the new robot's policy").click()
    download.value.save_as(tmp_path / "new.safetensors")
    first, new = (
        load_weights(tmp_path / f"{name}.safetensors").network
        for name in ("policy", "new")
    )
    assert new.sizes == first.sizes
    assert abs(new.weights[0] - first.weights[0]).max() > 0
    first_name, new_name = sorted(lab.page.evaluate(KEPT_NAMES), key=len)
    assert first_name == "NIRL, 30 iterations, seed 0, six"
    assert new_name == (
        f"{first_name}, trained with 10 standing and 5 moving obstacles at 2 m/s"
    )


def test_a_reward_from_a_file_is_shown_and_a_robot_trained_for_it(lab, tmp_path):
    """The file is one that Python saved; with the same seed Python trains the same robot, up to rounding."""
    upload = lab.get_by_label("File of a reward")
    (tmp_path / "bad.npz").write_bytes(b"nothing")
    upload.set_input_files(tmp_path / "bad.npz")
    expect(lab.get_by_text("The file must hold a reward, an array")).to_be_visible()
    reward = learn(DEMONSTRATIONS, "nirl", seed=3, iterations=3).reward_weights
    np.savez(tmp_path / "python.npz", reward_weights=reward)
    upload.set_input_files(tmp_path / "python.npz")
    expect(lab.get_by_text("The map shows the reward in python.npz.")).to_be_visible()
    assert min(lab.locator("canvas").evaluate(COLOURS)) > 200
    lab.get_by_text("The weights of the reward").click()
    cells = lab.locator("details table td").all_inner_texts()
    shown = np.array(cells, dtype=float).reshape(-1, 5)
    np.testing.assert_allclose(shown, reward.T, atol=0.0051)
    expect(lab.get_by_role("button", name="Download the policy")).to_be_disabled()
    set_number(lab, "iterations", 2)
    lab.get_by_role("button", name="Train a new robot for this reward").press("Enter")
    expect(lab.get_by_text("The new robot is kept. It arrives in")).to_be_visible(
        timeout=SLOW
    )
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download the new robot's policy").click()
    download.value.save_as(tmp_path / "new.safetensors")
    new = load_weights(tmp_path / "new.safetensors")
    task = RobotTask(obstacles=10, moving=10)
    expected = learn_under_reward(
        DEMONSTRATIONS, reward, task=task, seed=1, iterations=2
    )
    np.testing.assert_allclose(
        new.network.weights[0], expected.network.weights[0], atol=1e-9
    )
    assert new.made["rewardFrom"] == "reward python.npz"
    np.testing.assert_allclose(new.made["reward"], reward, atol=1e-12)
    lab.page.evaluate("() => { window.define = undefined; }")
    lab.page.evaluate(AXE.read_text("utf-8"))
    assert lab.page.evaluate(RUN_FROM_DISK.replace("document", "'#mounted'")) == []


COLOURS = """(map) => {
  const { width, height } = map, pixels = map.getContext("2d").getImageData(0, 0, width, height).data;
  let [red, blue] = [0, 0];
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 3] === 0) continue;
    if (pixels[i] > pixels[i + 2] + 20) red += 1;
    if (pixels[i + 2] > pixels[i] + 20) blue += 1;
  }
  return [red, blue];
}"""


def test_map_shows_the_reward_of_the_chosen_action(lab):
    set_number(lab, "iterations", 2)
    lab.get_by_role("button", name="Learn the reward").click()
    said = lab.locator(".status").nth(1)
    expect(said).to_contain_text("straight on in", timeout=SLOW)
    own, straight = map(int, re.findall(r"in (\d+) %", said.inner_text()))
    assert own < straight + 5
    expect(said).to_contain_text("Few iterations were made: let it learn for more.")
    canvas = lab.locator("canvas")
    drawn = lab.get_by_text("Once a reward is learned").or_(
        lab.get_by_text("above or below its mean over the map")
    )
    expect(drawn).to_contain_text("the reward of the action F")
    expect(lab.locator(".legend").first).to_contain_text(
        "no colour: nothing is in range"
    )
    red, blue = canvas.evaluate(COLOURS)
    assert min(red, blue) > 200  # centred on the mean, both are seen
    ahead = canvas.evaluate("(canvas) => canvas.toDataURL()")
    lab.get_by_label("reward of the action", exact=True).select_option("L60")
    assert canvas.evaluate("(canvas) => canvas.toDataURL()") != ahead


def test_cancelled_training_leaves_the_tables_of_the_one_before(lab):
    set_number(lab, "iterations", 2)
    learn = lab.get_by_role("button", name="Learn the reward")
    learn.click()
    expect(lab.locator(".status").nth(1)).to_contain_text("is kept", timeout=SLOW)
    table = lab.locator("table").first
    before = table.inner_text()
    assert "100 of 100 new maps" in before
    set_number(lab, "iterations", 1000)
    for button in (learn, lab.get_by_role("button", name="Train a new robot")):
        button.click()
        lab.get_by_role("button", name="Cancel").click()
        expect(lab.get_by_text("Cancelled. Nothing of this run")).to_be_visible()
        assert table.inner_text() == before
        expect(lab.locator("caption", has_text="of 100 new maps")).to_have_count(1)
        lab.locator(".status", has_text="Cancelled").evaluate(
            "(one) => { one.textContent = ''; }"
        )


def test_wrong_number_is_one_sentence(lab):
    set_number(lab, "iterations", 0)
    sentence = "iterations must be a whole number from 1 to 1000."
    expect(lab.get_by_role("alert")).to_have_text(sentence)
    set_number(lab, "seed", -1)
    lab.get_by_role("button", name="Learn the reward").click()
    expect(lab.locator(".status").nth(1)).to_have_text(sentence)
    set_number(lab, "seed", 0)
    expect(lab.get_by_role("alert")).to_have_text(sentence)
    set_number(lab, "iterations", 5)
    expect(lab.get_by_role("alert")).to_have_text("")


def test_without_own_demonstrations_one_sentence_says_where_to_drive(lab):
    lab.get_by_label("demonstrations").select_option("my own demonstrations (0)")
    expect(lab.locator(".about")).to_contain_text("in the playground first")
    lab.get_by_role("button", name="Learn the reward").click()
    expect(lab.locator(".status").nth(1)).to_contain_text("in the playground first")


KEPT = """(demonstrations) => {
  demonstrations.forEach((shown, k) => localStorage.setItem(`robonav.drive.test.${k}`, JSON.stringify(shown)));
  window.dispatchEvent(new StorageEvent("storage", { key: null }));
}"""


def kept_demonstrations():
    """Demonstrations as the playground keeps them."""
    for number in range(len(DEMONSTRATIONS.worlds)):
        rows = DEMONSTRATIONS.trajectory == number
        sensing = DEMONSTRATIONS.sensing[rows]
        yield {
            "world": page_world(DEMONSTRATIONS.worlds[number]),
            "speed": DEMONSTRATIONS.speed,
            "outcome": "arrived",
            "map": number,
            "actions": DEMONSTRATIONS.actions[rows].tolist(),
            "poses": DEMONSTRATIONS.poses[rows].tolist(),
            "ranges": sensing.ranges.tolist(),
            "walls": (sensing.walls @ (1 << np.arange(9))).tolist(),
            "regions": sensing.target_region.tolist(),
            "seen": sensing.target_seen.astype(int).tolist(),
        }


def test_own_demonstrations_are_chosen_and_those_that_collided_left_out(lab):
    chosen, about = lab.get_by_label("demonstrations"), lab.locator(".about")
    assert lab.evaluate(MAP_IN_SIGHT) < PHONE["height"] - 100
    expect(chosen).to_have_value("six")
    demonstrations = list(kept_demonstrations())
    lab.page.evaluate(
        KEPT, [*demonstrations[:1], demonstrations[1] | {"outcome": "collided"}]
    )
    expect(chosen).to_have_value("my own demonstrations (1)")
    expect(about).to_contain_text(
        "1 of your demonstrations did not arrive and is left out. 1"
    )
    empty_storage(lab.page)
    expect(chosen).to_have_value("six")


MAP_IN_SIGHT = """(lab) => {
  const [button, map] = [".training button", "canvas"].map((what) => lab.querySelector(what).getBoundingClientRect());
  return map.bottom - button.top;
}"""


def test_own_demonstrations_teach_what_the_same_demonstrations_teach(lab, tmp_path):
    lab.page.evaluate(KEPT, list(kept_demonstrations()))
    set_number(lab, "iterations", 2)
    rewards = []
    for name in ("six", "my own demonstrations (6)"):
        lab.get_by_label("demonstrations").select_option(name)
        lab.get_by_role("button", name="Learn the reward").click()
        expect(lab.locator(".status").nth(1)).to_contain_text("is kept", timeout=SLOW)
        with lab.page.expect_download() as download:
            lab.get_by_role("button", name="Download the reward").click()
        download.value.save_as(tmp_path / f"{len(rewards)}.npz")
        rewards.append(np.load(tmp_path / f"{len(rewards)}.npz")["reward_weights"])
    np.testing.assert_allclose(rewards[0], rewards[1], atol=1e-12)
    assert abs(rewards[0]).max() > 0
