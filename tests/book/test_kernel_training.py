"""Trainings in the kernel: hidden without one; with one, trained, watched, cancelled, and the result used."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from accessibility import AXE, RUN
from browser import DESKTOP, PHONE, Visit
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav import mdp
from robonav.benchmark.policies import method
from robonav.lfd import demonstrate
from robonav.networks import NetworkPolicy, fit, toy_datasets
from robonav.robot import random_worlds
from robonav.widgets.boundary_lab import boundary_lab
from robonav.widgets.dagger_lab import dagger_lab
from robonav.widgets.grid_lab import Replay, grid_lab
from robonav.widgets.imitation_lab import imitation_lab
from robonav.widgets.key_points_lab import key_points_lab
from robonav.widgets.reward_learning import reward_learning


def grids() -> Any:
    grid = mdp.GridWorld("S . .\n. # G", step_reward=-1)
    nothing = np.zeros((1, grid.n_states))
    run = {"Q-learning": Replay(nothing, nothing.astype(int), ["before"])}
    learners = {"Q-learning": mdp.q_learning, "SARSA": mdp.sarsa}
    return grid_lab({"map": grid}, {}, {("map",): run}, learners=learners)


def imitation() -> Any:
    policy = method("lfd")
    assert isinstance(policy, NetworkPolicy)
    return imitation_lab(policy, demonstrations=5, maps=20)


def rewards() -> Any:
    demonstrations = {"three": demonstrate(random_worlds(3, 20, seed=3))}
    world = random_worlds(1, 20, seed=8)
    return reward_learning(demonstrations, world, {}, maps=10, seed=55_000)


def boundaries() -> Any:
    examples = {"disc": toy_datasets.disc(40, seed=0)}
    runs = {("disc",): fit(*examples["disc"], iterations=20, record=True)}
    return boundary_lab({"problem": ["disc"]}, runs, examples, frames=[0, 1, 20])


LABS: dict[str, Callable[[], Any]] = {
    "boundaries": boundaries,
    "dagger": lambda: dagger_lab(method("dagger"), maps=10),
    "experts": key_points_lab,
    "grids": grids,
    "imitation": imitation,
    "rewards": rewards,
}


@pytest.fixture(params=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit) -> Visit:
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    return visit


def panel(lab: Locator) -> Locator:
    return lab.locator("fieldset.kernel")


def train(lab: Locator, sentence: str) -> None:
    """Train by keyboard, and wait for the sentence at the end."""
    panel(lab).get_by_role("button", name="Train in Python").press("Enter")
    expect(panel(lab).locator(".status")).to_have_text(
        re.compile(rf"^Done in [\d.]+ s\. {sentence}")
    )
    expect(panel(lab).get_by_role("progressbar")).to_have_attribute(
        "aria-valuenow", "100"
    )


def set_slider(lab: Locator, label: str, key: str) -> None:
    panel(lab).get_by_label(label).and_(lab.locator("input")).press(key)


def iterations(lab: Locator, number: int) -> None:
    field = lab.get_by_label("iterations", exact=True)
    field.fill(str(number))
    field.press("Tab")


def all_right(visit: Visit) -> None:
    """No error, nothing wider than the page, and nothing that axe-core finds."""
    assert visit.errors == []
    width = "document.documentElement.scrollWidth - innerWidth"
    assert visit.page.evaluate(width) <= 0
    visit.page.evaluate(AXE.read_text("utf-8"))
    assert visit.page.evaluate(RUN.replace("document", "'#mounted'")) == []


@pytest.mark.parametrize("name", LABS)
def test_without_a_kernel_nothing_speaks_of_python(view, http, name):
    lab = mounted(view, http, LABS[name]())
    expect(panel(lab)).to_have_count(0)
    expect(lab.get_by_text("Train in Python")).to_have_count(0)
    assert view.errors == []


def test_a_method_learns_on_a_map_of_ones_own(view, http):
    widget = grids()
    lab = mounted(view, http, widget, kernel=True)
    panel(lab).get_by_label("map: ").fill("S . . G")
    panel(lab).get_by_label("method", exact=True).select_option("SARSA")
    set_slider(lab, "learning rate α", "End")
    set_slider(lab, "exploring ε", "Home")
    train(lab, "The greedy policy ends 100 of 100 episodes")
    (learned,) = widget.trainings
    env = mdp.GridWorld("S . . G", step_reward=-1).environment()
    expected = mdp.sarsa(
        env, 500, discount=1.0, learning_rate=1.0, epsilon=0.0, max_steps=500
    )
    np.testing.assert_array_equal(learned.q, expected.q)
    texts = lab.locator("figure svg text[text-anchor='middle']").all_text_contents()
    shown = [float(text.replace("−", "-")) for text in texts[:3]]
    np.testing.assert_allclose(shown, expected.q.max(axis=1)[:3], atol=0.006)
    expect(lab.locator("figure .told")).to_contain_text("after episode 500")
    expect(panel(lab).get_by_role("img", name="mean return")).to_have_attribute(
        "aria-label", re.compile("after 500$")
    )
    panel(lab).get_by_label("map: ").fill("S ? G")
    panel(lab).get_by_role("button", name="Train in Python").press("Enter")
    expect(panel(lab).locator(".status")).to_contain_text("symbols of the legend")
    all_right(view)


def test_robots_imitate_and_the_best_drives_in_the_page(view, http):
    widget = imitation()
    lab = mounted(view, http, widget, kernel=True)
    lab.get_by_label("learn from", exact=True).select_option(
        "the expert's demonstrations"
    )
    best = panel(lab).get_by_role("button", name="Let the best robot of Python drive")
    expect(best).to_be_disabled()
    train(lab, "4 robots cross ")
    assert len(widget.trainings) == 4
    best.press("Enter")
    row = lab.get_by_role("row", name=re.compile("trained in Python"))
    expect(row).to_be_visible()
    expect(lab.locator(".training .status").first).to_contain_text("Your robot arrives")
    all_right(view)


def test_a_network_of_python_is_shown_in_the_plane(view, http):
    widget = boundaries()
    lab = mounted(view, http, widget, kernel=True)
    set_slider(lab, "hidden units", "Home")
    panel(lab).get_by_label("method", exact=True).select_option("L-BFGS")
    train(lab, r"The cost is [\d.]+, and \d+ % of the examples are right\.")
    (history,) = widget.trainings
    assert history.network.sizes == (2, 1, 1)
    expect(lab.get_by_role("img", name="The network: two inputs")).to_have_attribute(
        "aria-label", re.compile(", 1 hidden units")
    )
    expect(lab.get_by_text("Iteration 20: cost")).to_contain_text(
        f"cost {history.costs[-1]:.3f}"
    )
    all_right(view)


def test_an_expert_that_slips_is_learned_from(view, http):
    widget = key_points_lab()
    lab = mounted(view, http, widget, kernel=True)
    set_slider(lab, "the computer's demonstrations", "Home")
    set_slider(lab, "slip with probability", "End")
    panel(lab).get_by_label("robots, each").select_option("1")
    train(lab, r"5 demonstrations with \d+ steps to learn from\. One robot crosses ")
    panel(lab).get_by_label("who demonstrates").select_option(index=1)
    panel(lab).get_by_role("button", name="Train in Python").press("Enter")
    expect(panel(lab).locator(".status")).to_contain_text("There is nothing to learn")
    all_right(view)


def test_dagger_runs_in_python(view, http):
    widget = dagger_lab(method("dagger"), maps=10)
    lab = mounted(view, http, widget, kernel=True)
    set_slider(lab, "rounds", "Home")
    set_slider(lab, "maps in each round", "Home")
    panel(lab).get_by_label("robots, each").select_option("1")
    train(lab, r"One robot crosses .* Before the first round it was [\d.]+ %\.")
    assert len(widget.trainings[0].policies) == 2
    curve = panel(lab).get_by_role("img", name=re.compile("^arrived"))
    expect(curve).to_have_attribute("aria-label", re.compile("after 1$"))
    all_right(view)


def test_a_reward_of_python_is_drawn_and_used(view, http):
    widget = rewards()
    lab = mounted(view, http, widget, kernel=True)
    iterations(lab, 3)
    panel(lab).get_by_label("method", exact=True).select_option("SCIRL")
    panel(lab).get_by_label("robots, each").select_option("1")
    set_slider(lab, "hidden units", "Home")
    train(lab, "One robot crosses ")
    (result,) = widget.trainings
    assert result.network.sizes == (17, 1, 5)
    lab.get_by_text("The weights of the reward").click()
    cells = lab.locator("details table td").all_inner_texts()
    np.testing.assert_allclose(
        np.array(cells, dtype=float).reshape(-1, 5),
        result.reward_weights.T,
        atol=0.0051,
    )
    expect(lab.locator("caption").first).to_contain_text("10 of 10")
    expect(lab.get_by_role("button", name="Download the reward")).to_be_enabled()
    expect(
        lab.get_by_role("button", name="Train a new robot for this reward")
    ).to_be_visible()
    all_right(view)


@pytest.mark.parametrize("name", ["grids", "rewards"])
def test_a_training_is_cancelled_and_begun_again(visit, http, name):
    widget = LABS[name]()
    lab = mounted(visit, http, widget, kernel=True)
    if name == "grids":  # all episodes are long, because a wall encloses the goal
        panel(lab).get_by_label("map: ").fill("S . . # G")
        set_slider(lab, "episodes", "End")
    begin = panel(lab).get_by_role("button", name="Train in Python")
    begin.press("Enter")
    expect(
        panel(lab).get_by_role("img", name=re.compile("at first")).first
    ).to_be_visible()
    panel(lab).get_by_role("button", name="Cancel").press("Enter")
    expect(panel(lab).locator(".status")).to_contain_text("Cancelled. ")
    widget._thread.join(timeout=60)
    assert not widget._thread.is_alive()
    assert widget.trainings == []
    if name == "grids":
        set_slider(lab, "episodes", "Home")
    else:
        iterations(lab, 2)
    train(lab, "")
    assert len(widget.trainings) in (1, 4)
    assert visit.errors == []
