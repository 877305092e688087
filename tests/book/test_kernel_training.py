"""Trainings in the kernel: hidden without one; with one, trained, watched, cancelled, and the result used."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from accessibility import AXE, RUN
from browser import DESKTOP, PHONE, Visit, empty_storage
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav import mdp, nirl
from robonav.benchmark.policies import method
from robonav.lfd import demonstrate, plan_on_grid
from robonav.networks import NetworkPolicy, fit, toy_datasets
from robonav.robot import Sensing, random_worlds
from robonav.style import BLUE
from robonav.widgets.boundary_lab import boundary_lab
from robonav.widgets.dagger_lab import dagger_lab
from robonav.widgets.explorables import explorable, robot_trainings
from robonav.widgets.explorables.training import TRAININGS
from robonav.widgets.grid_lab import Replay, grid_lab
from robonav.widgets.imitation_lab import imitation_lab
from robonav.widgets.key_points_lab import key_points_lab
from robonav.widgets.reward_learning import reward_learning
from robonav.widgets.simulator import page_world


def grids() -> Any:
    grid = mdp.GridWorld("S . .\n. # G", step_reward=-1)
    nothing = np.zeros((1, grid.n_states))
    run = {"Q-learning": Replay(nothing, nothing.astype(int), ["before"])}
    learners = {"Q-learning": mdp.q_learning, "SARSA": mdp.sarsa}
    return grid_lab({"map": grid}, {}, {("map",): run}, learners=learners)


def imitation() -> Any:
    policy = method("lfd")
    assert isinstance(policy, NetworkPolicy)
    return imitation_lab(policy, demonstrations=5, n_worlds=20)


def rewards() -> Any:
    demonstrations = {"three": demonstrate(random_worlds(3, 20, seed=3))}
    world = random_worlds(1, 20, seed=8)
    return reward_learning(demonstrations, world, {}, n_worlds=10, seed=55_000)


def boundaries() -> Any:
    examples = {"disc": toy_datasets.disc(40, seed=0)}
    runs = {("disc",): fit(*examples["disc"], iterations=20, record=True)}
    return boundary_lab({"problem": ["disc"]}, runs, examples, frames=[0, 1, 20])


LABS: dict[str, Callable[[], Any]] = {
    "boundaries": boundaries,
    "dagger": lambda: dagger_lab(method("dagger"), n_worlds=10),
    "experts": key_points_lab,
    "grids": grids,
    "imitation": imitation,
    "rewards": rewards,
    **{name: partial(explorable, name) for name in TRAININGS},
}


@pytest.fixture(params=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit) -> Visit:
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    return visit


def panel(lab: Locator) -> Locator:
    return lab.locator("fieldset.kernel")


def train(lab: Locator, sentence: str, action: str = "Train in Python") -> None:
    """Train by keyboard, and wait for the sentence at the end."""
    panel(lab).get_by_role("button", name=action).press("Enter")
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
    expect(lab.get_by_text("Firefox")).to_have_count(
        0
    )  # pages over http share demonstrations
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
    expect(lab.locator(".training .status").first).to_contain_text("robot arrives")
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
    empty_storage(
        view.page
    )  # from demonstrations that another test has left, Python learns
    set_slider(lab, "the computer's demonstrations", "Home")
    set_slider(lab, "slip with probability", "End")
    panel(lab).get_by_label("robots, each").select_option("1")
    train(lab, r"5 demonstrations with \d+ steps to learn from\. One robot crosses ")
    panel(lab).get_by_label("who demonstrates").select_option(index=1)
    panel(lab).get_by_role("button", name="Train in Python").press("Enter")
    expect(panel(lab).locator(".status")).to_contain_text("There is nothing to learn")
    all_right(view)


def test_dagger_runs_in_python(view, http):
    widget = dagger_lab(method("dagger"), n_worlds=10)
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


def number_after(lab: Locator, words: str) -> float:
    """The number that follows some words below the pictures of an explorable."""
    text = lab.locator(".pictures + .status").inner_text()
    found = re.search(rf"{re.escape(words)}:? ([−-]?[\d.]+[\d])", text)
    assert found, text
    return float(found[1].replace("−", "-"))


def mixture_is_shown(lab: Locator, found: Any) -> None:
    words = "Distance of the mixture to the expert"
    assert number_after(lab, words) == pytest.approx(found.distances[0], abs=6e-4)
    lab.get_by_role("slider", name="policies found after the first").press("End")
    assert number_after(lab, words) <= found.distances[-1] + 6e-4


def weights_are_shown(lab: Locator, found: Any) -> None:
    for kind, weight in zip(nirl.TERRAIN_KINDS, found.weights, strict=True):
        output = lab.get_by_text(f"reward of {kind}: ").locator("output")
        shown = float(output.inner_text().replace("−", "-"))
        assert shown == pytest.approx(weight, abs=0.026)


def transfer_is_shown(lab: Locator, found: Any) -> None:
    _, task = nirl.terrain()
    learned = mdp.policy_iteration(task.with_reward(found.weights)).policy
    values = mdp.policy_evaluation(task.with_reward(nirl.TRUE_WEIGHTS), learned)
    shown = number_after(lab, "With the best actions for the learned reward")
    assert shown == pytest.approx(task.starts @ values, abs=0.006)
    lab.get_by_role("radio", name="top left").check(force=True)
    copied = number_after(lab, "Value of the start with the copied actions")
    assert copied < number_after(lab, "With the best actions for the learned reward")


def ends_are_shown(lab: Locator, result: Any) -> None:
    assert result.network.sizes[-1] == 5
    assert number_after(lab, "Ending now") == 0.5
    assert 0 <= number_after(lab, "Never") <= 1


def network_is_shown(lab: Locator, training: Any) -> None:
    assert training.network.sizes[1] == 1
    picture = lab.locator(".pictures svg").first
    expect(picture).to_contain_text("R60")
    encoder = training.encoder
    ranges = np.full((1, 9), 10.0)
    ranges[0, 0] = 4.5
    nothing = np.zeros((1, 9), bool)
    ahead = encoder(Sensing(ranges, nothing, np.ones(1, int), np.zeros(1, bool)))
    before = training.network[0].forward(ahead)[0]
    lab.get_by_role("slider", name="its target").press("Home")
    lab.get_by_role("slider", name="steps of gradient descent").press("End")
    fallen = number_after(lab, "State A: F changed by")
    assert -before[0] <= fallen < 0


def methods_are_shown(lab: Locator, training: Any) -> None:
    assert training.method == "online"
    expect(lab.get_by_role("slider", name="trainings of each method")).to_have_value(
        "1"
    )


def speed_is_shown(lab: Locator, slowest: Any) -> None:
    assert len(slowest.outcome) == 20
    expect(lab.get_by_role("radio", name="4 m", exact=True)).to_be_checked()
    picture = lab.locator(".pictures canvas")
    expect(picture).to_have_attribute("aria-label", re.compile("Forty episodes"))


def rooms_are_shown(lab: Locator, first_run: Any) -> None:
    lab.get_by_role("slider", name="episodes", exact=True).press("End")
    assert number_after(lab, "TD(0) with α =") == 0.5
    dots = lab.locator(".pictures svg").first.locator(f"circle[fill='{BLUE}']")
    assert dots.count() == 5
    heights = [float(dot.get_attribute("cy") or "nan") for dot in dots.all()]
    values = first_run.history[100, 1:6]
    slopes = np.diff(heights) / np.diff(values)
    np.testing.assert_allclose(slopes, slopes[0], rtol=1e-6)
    assert slopes[0] < 0


def tilings_are_shown(lab: Locator, learned: Any) -> None:
    assert learned.features.tilings == 1
    tilings = lab.get_by_role("slider", name="tilings", exact=True)
    expect(tilings).to_have_value("0")  # the first of its steps
    expect(lab.locator(".pictures + .status")).to_contain_text("shares 1 of 1 tile ")


def vectors_are_shown(lab: Locator, plan: Any) -> None:
    lab.get_by_role("slider", name="steps to go").first.press("End")
    shown = number_after(lab, "Value")
    assert shown == pytest.approx(plan.value([0.5, 0.5]), abs=0.006)


def paths_are_shown(lab: Locator, driven: Any) -> None:
    assert len(driven.outcome) == 20
    for outcome in set(driven.outcome):
        ended = lab.get_by_role("radio", name=robot_trainings.SAID[outcome])
        expect(ended).to_be_enabled()


def grid_is_shown(lab: Locator, returns: Any) -> None:
    assert len(returns) == 200
    expect(lab.locator(".pictures + .status")).to_contain_text("this policy is optimal")
    values = lab.locator("figure svg text[text-anchor='middle']").all_text_contents()
    best = mdp.policy_iteration(mdp.four_by_three(step_reward=-2.0).mdp(0.95)).values
    shown = [float(text.replace("−", "-")) for text in values[:3]]
    np.testing.assert_allclose(shown, best[:3], atol=0.006)


def search_is_shown(lab: Locator, made: Any) -> None:
    world = random_worlds(
        1,
        40,
        seed=robot_trainings.SEED,
        starts=(robot_trainings.START,),
        targets=(robot_trainings.TARGET,),
    )
    np.testing.assert_array_equal(
        made.points, plan_on_grid(world, margin=1.0, cell=1.0).points
    )
    shapes = page_world(world)["obstacles"]
    rectangles = lab.locator("svg.search rect[transform]")
    turned = rectangles.evaluate_all(
        "all => all.map((r) => r.getAttribute('transform'))"
    )
    np.testing.assert_allclose(
        [float(text.removeprefix("rotate(").split()[0]) for text in turned],
        [-math.degrees(o["turned"]) for o in shapes if not o["circle"]],
    )
    lab.get_by_role("button", name="Run to the end").press("Enter")
    coarse = plan_on_grid(world, margin=1.0, cell=robot_trainings.COARSE)
    assert coarse.found
    assert number_after(lab, "the path is") == pytest.approx(coarse.length, abs=0.06)


def samples_are_shown(lab: Locator, found: Any) -> None:
    theta = lab.get_by_text("θ, per step to the right").locator("output")
    shown = float(theta.inner_text().replace("−", "-"))
    assert shown == pytest.approx(found.weights[0] / 20, abs=0.026)
    dots = lab.locator(".pictures svg circle")
    expect(dots).to_have_count(1000)
    counted = number_after(lab, "The weighted samples correspond to")
    assert counted == pytest.approx(found.effective_samples, rel=0.2)


def measures_are_shown(lab: Locator, result: Any) -> None:
    best = result.history.balanced.max()
    assert result.history.balanced[result.chosen] == best
    assert number_after(lab, "Balanced accuracy") == pytest.approx(
        max(best, 0.2), abs=0.03
    )


EXPLORED: dict[str, tuple[dict[str, str], str, Callable[[Locator, Any], None]]] = {
    "projection_steps": (
        {"features of the reward": "mud and road", "policies to find at most": "Home"},
        r"After 1 more policy the distance is [\d.]+\. Under the expert's own reward",
        mixture_is_shown,
    ),
    "trajectory_features": (
        {"demonstrations (0: exact expectations)": "End"},
        r"The weights of the reward are -?[\d.]+ for grass, .* for target\. The learner's likeliest",
        weights_are_shown,
    ),
    "reward_transfer": (
        {"the expert's action is random in": "ArrowRight"},
        r"The demonstrations visit \d+ of 41 cells\. With the target at the top left, ",
        transfer_is_shown,
    ),
    "value_of_an_end": (
        {"value of an end": "1/2", "demonstrations": "Home", "iterations": "Home"},
        r"One robot crosses [\d.]+ % of 400 new maps\. It collides in [\d.]+ %, ",
        ends_are_shown,
    ),
    "moving_together": (
        {"targets are rescaled by": "clip", "hidden units": "Home", "episodes": "Home"},
        r"One robot crosses [\d.]+ % of 400 new maps\. State A is an object ahead",
        network_is_shown,
    ),
    "seeds_to_tell_apart": (
        {
            "one method": "online",
            "trainings of each": "Home",
            "episodes of each training": "Home",
        },
        r"online arrives in [\d.]+ % .*; double DQN arrives in .* The means differ by ",
        methods_are_shown,
    ),
    "speed_and_sight": (
        {"turns when something ahead": "4 m", "maps for each speed": "Home"},
        r"At 1 m/s it arrives in [\d.]+ % of 20 maps, and at 9 m/s in ",
        speed_is_shown,
    ),
    "tiger_vectors": (
        {"a wrong door costs": "End", "beliefs to back up": "Home"},
        r"Beliefs backed up: 1\. Vectors with 30 steps to go: \d\. The uniform belief has ",
        vectors_are_shown,
    ),
    "astar_by_hand": (
        {
            "search": "A* on a grid",
            "obstacles": "End",
            "margin": "Home",
            "maps": "Home",
        },
        r"With A\* on a grid, a path was found in 20 of 20 maps\. On average it is [\d.]+ % longer ",
        search_is_shown,
    ),
    "weights_of_samples": (
        {"a step goes to the right": "ArrowRight", "random walks": "End"},
        r"θ is [\d.]+ per step to the right\. Without slack it tends to 1\.19 as ",
        samples_are_shown,
    ),
    "accuracy_or_balance": (
        {"the policy is kept by": "balanced accuracy", "iterations": "Home"},
        r"Balanced accuracy keeps the policy after iteration \d, and accuracy the one ",
        measures_are_shown,
    ),
    "reflex_map": (
        {"rule": "straight on", "obstacles that move": "End", "maps": "Home"},
        r"It arrives in [\d.]+ % of 20 maps, collides in ",
        paths_are_shown,
    ),
    "turn_arrows": (
        {"policy": "an optimal one", "reward of a step": "Home", "episodes": "Home"},
        r"The mean return is -[\d.]+, with a standard error of ",
        grid_is_shown,
    ),
    "td_step_size": (
        {"learning rate α of TD(0)": "End", "episodes of each run": "Home"},
        r"TD\(0\) with α = 0\.50: after 100 episodes the error is [\d.]+, mean of 20 runs\.",
        rooms_are_shown,
    ),
    "shared_tiles": (
        {"tilings of 8 × 8 tiles": "Home", "episodes": "Home"},
        r"The first episode takes \d+ steps, and the last 10 take ",
        tilings_are_shown,
    ),
}
"""For each explorable: keys for sliders and options of lists, the sentence at the end, and what is shown."""


@pytest.mark.parametrize("name", TRAININGS)
def test_an_explorable_shows_what_python_has_trained(view, http, name):
    asked, sentence, is_shown = EXPLORED[name]
    widget = explorable(name)
    lab = mounted(view, http, widget, kernel=True)
    pictures = lab.locator(".row:has(> .pictures)")
    before = pictures.inner_html()
    for label, chosen in asked.items():
        listed = panel(lab).get_by_label(label).and_(lab.locator("select"))
        if listed.count():
            listed.select_option(chosen)
        else:
            set_slider(lab, label, chosen)
    train(lab, sentence, TRAININGS[name].action)
    for curve in TRAININGS[name].curves.values():
        grown = panel(lab).get_by_role(
            "img", name=re.compile(f"^{re.escape(curve.label)}:")
        )
        expect(grown).to_be_visible()
    assert pictures.inner_html() != before
    is_shown(lab, widget.trainings[0])
    lab.get_by_role("button", name="Reset").press("Enter")
    expect(lab.get_by_role("button", name="Reset")).to_be_focused()
    assert pictures.inner_html() == before
    all_right(view)


@pytest.mark.parametrize("name", ["grids", "rewards", "value_of_an_end"])
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
    elif name in TRAININGS:
        set_slider(lab, "iterations", "Home")
    else:
        iterations(lab, 2)
    train(lab, "")
    assert len(widget.trainings) in (1, 4)
    assert visit.errors == []
