"""What the kernel trains for explorables: what is asked for, what the page is told, and what the notebook gets."""

from __future__ import annotations

import threading

import gymnasium as gym
import numpy as np
import pytest

from robonav import mdp, nirl, nnql
from robonav.lfd import demonstrate, plan_on_grid
from robonav.robot import navigate, random_worlds, straight
from robonav.widgets.explorables import (
    EXPLORABLES,
    explorable,
    nirl_trainings,
    robot_trainings,
)
from robonav.widgets.explorables.training import TRAININGS, Dial, Menu
from robonav.widgets.kernel_training import Cancelled, Report

QUICK = {
    "maps": 20,
    "fastest": 2,
    "episodes": 200,
    "iterations": 5,
    "demonstrations": 5,
    "trainings": 2,
    "steps": 5,
    "hidden": 2,
}
FEWER_EPISODES = {
    "moving_together": {"episodes": 20},
    "seeds_to_tell_apart": {"episodes": 25},
    "shared_tiles": {"episodes": 10},
    "td_step_size": {"episodes": 100},
}


def at_first(name: str) -> dict:
    """The settings with which a page begins, but with less work."""
    settings = {
        key: own.options[0] if isinstance(own, Menu) else own.value
        for key, own in TRAININGS[name].settings.items()
    }
    less = QUICK | FEWER_EPISODES.get(name, {})
    return settings | {key: less[key] for key in settings.keys() & less.keys()}


class Page:
    """Trains for an explorable, and keeps what its page is told."""

    def __init__(self, name: str) -> None:
        self.lab = explorable(name)
        self.told: list[dict] = []
        self.cancelled = threading.Event()

    def train(self, **settings):
        asked = {"settings": at_first(self.lab_name()) | settings}
        return self.lab.train(asked, Report(self.told.append, self.cancelled))

    def lab_name(self) -> str:
        titles = {question.title: name for name, question in EXPLORABLES.items()}
        return titles[self.lab.data["title"]]

    def points(self, name: str) -> list[float]:
        live = [point for message in self.told for point in message.get("live", [])]
        return [point[name] for point in live if name in point]


@pytest.mark.parametrize("name", TRAININGS)
def test_its_settings_can_be_sent_and_are_checked(name):
    part = TRAININGS[name]
    assert name in EXPLORABLES
    begin = at_first(name)
    assert part.checked(begin) == begin
    for key, own in part.settings.items():
        if isinstance(own, Dial):
            steps = (own.stop - own.start) / own.step
            assert abs(steps - round(steps)) < 1e-9
            assert own.start <= own.value <= own.stop
            wrong = [own.start - 1, own.stop + 1, None, "many"]
        else:
            wrong = ["another", None, 0]
        for value in wrong:
            with pytest.raises((ValueError, TypeError), match=key):
                part.checked(begin | {key: value})
    assert isinstance(part.length, int) or part.length in part.settings


@pytest.mark.slow
@pytest.mark.parametrize("name", TRAININGS)
def test_it_tells_the_page_how_far_it_is_and_gives_it_numbers_of_its_own_form(name):
    page = Page(name)
    ended = page.train()
    assert page.lab.trainings
    assert page.told[-1]["done"] == page.told[-1]["total"]
    done = [message["done"] for message in page.told]
    assert done == sorted(done)
    for curve in TRAININGS[name].curves:
        assert page.points(curve), curve
    assert ended["sentence"].endswith(".")
    own = page.lab.data["given"]
    assert ended["given"].keys() <= own.keys()
    for key, value in ended["given"].items():
        kinds = {type(own[key]), type(value)}
        assert len(kinds) == 1 or kinds <= {int, float}


@pytest.mark.parametrize("name", TRAININGS)
def test_a_cancelled_one_ends_at_its_next_report_and_leaves_nothing(name):
    page = Page(name)
    page.cancelled.set()
    with pytest.raises(Cancelled):
        page.train()
    assert page.lab.trainings == []


@pytest.mark.parametrize("name", sorted(EXPLORABLES.keys() - TRAININGS.keys())[:3])
def test_an_explorable_without_a_training_asks_for_no_kernel(name):
    lab = explorable(name)
    assert not lab.uses_kernel()
    assert lab.data["kernel"] is None
    assert "kernelPanel({" not in str(lab._esm)


@pytest.mark.parametrize("guess", ["projection", "widest margin"])
def test_apprenticeship_on_the_ground(guess):
    page = Page("projection_steps")
    page.train(guess=guess, features="mud and road", iterations=10, demonstrations=0)
    (found,) = page.lab.trainings
    _, terrain = nirl.terrain()
    features = terrain.features[:, :, [1, 2]]
    expert = mdp.policy_iteration(terrain.with_reward(nirl.TRUE_WEIGHTS)).policy
    task = nirl.RewardFreeMDP(terrain.transitions, features, 0.9, terrain.starts)
    np.testing.assert_allclose(found.expert, nirl.initial_expectations(task, expert))
    np.testing.assert_allclose(page.points("distance"), found.distances)
    assert found.distances[-1] < 0.1 * found.distances[0]
    assert min(page.points("lost")) >= 0


@pytest.mark.slow
def test_the_reward_of_maximum_entropy():
    page = Page("trajectory_features")
    ended = page.train(demonstrations=0, iterations=40, regularisation=0.1)
    (found,) = page.lab.trainings
    _, task = nirl.terrain()
    expert = mdp.policy_iteration(task.with_reward(nirl.TRUE_WEIGHTS)).policy
    goal = nirl.initial_expectations(task, expert)
    again = nirl.maximum_causal_entropy(
        task, goal, regularisation=0.1, tolerance=1e-3, iterations=40
    )
    np.testing.assert_array_equal(found.weights, again.weights)
    np.testing.assert_allclose(ended["given"]["weights"], found.weights, atol=0.0251)
    np.testing.assert_allclose(page.points("gap")[1:], found.gaps, atol=0.02)


@pytest.mark.slow
def test_a_reward_moves_with_the_target_and_copied_actions_do_not():
    page = Page("reward_transfer")
    terrains = page.train(demonstrations=50)["given"]["terrains"]
    values = [
        [terrain[who]["values"][terrain["start"]] for who in ("copied", "reward")]
        for terrain in terrains
    ]
    assert values[0][0] == pytest.approx(values[0][1], abs=0.5)
    assert all(copied < learned for copied, learned in values[1:])


def test_a_network_learns_as_without_a_watcher():
    page = Page("moving_together")
    ended = page.train(rescale="clip", seed=4)
    (training,) = page.lab.trainings
    alone = nnql.train("nnql", [4], 20, hidden=2, rescale="clip")
    np.testing.assert_array_equal(training.outcomes, alone.outcomes)
    np.testing.assert_array_equal(training.network.weights[0], alone.network.weights[0])
    hits = (training.outcomes == "collided").sum()
    assert page.points("collided")[-1] == pytest.approx(100 * hits / 20)
    assert ended["given"]["actions"] == ["F", "L30", "L60", "R30", "R60"]


@pytest.mark.slow
def test_two_methods_are_compared():
    page = Page("seeds_to_tell_apart")
    given = page.train(one="online", other="NNQL", seed=10)["given"]
    one, other = page.lab.trainings
    assert (one.method, other.method) == ("online", "nnql")
    assert one.seeds == other.seeds == (10, 11)
    assert given["seeds"] == 2
    assert given["scatter"] % 0.25 == given["difference"] % 0.25 == 0


@pytest.mark.slow
@pytest.mark.parametrize("ends", ["1/2", "0"])
def test_a_reward_is_learned_with_ends_of_a_chosen_value(ends):
    page = Page("value_of_an_end")
    given = page.train(ends=ends, method="SCIRL")["given"]
    (result,) = page.lab.trainings
    assert len(result.history.costs) == 5
    assert given["end"] == {"1/2": 0.5, "0": 0.0}[ends]
    assert 0 <= given["reward"] <= 1


def test_a_rule_drives_as_navigate_does():
    page = Page("reflex_map")
    given = page.train(rule="straight on", maps=60, speed=3)["given"]
    (result,) = page.lab.trainings
    worlds = random_worlds(60, 10, 0, seed=robot_trainings.SEED)
    alone = navigate(straight, worlds, 3, record_paths=True)
    np.testing.assert_array_equal(result.outcome, alone.outcome)
    np.testing.assert_array_equal(result.steps, alone.steps)
    assert page.points("arrived")[-1] == pytest.approx(100 * alone.success.mean())
    for world in given["worlds"]:
        (outcome,) = (
            own for own, said in robot_trainings.SAID.items() if said == world["name"]
        )
        at = np.flatnonzero(alone.outcome == outcome)[0]
        np.testing.assert_allclose(world["path"], alone.paths[at][:, :2], atol=0.006)


def test_a_robot_gets_faster():
    page = Page("speed_and_sight")
    given = page.train(sight="4 m", fastest=6)["given"]
    results = page.lab.trainings
    assert len(results) == 6
    assert page.points("collided") == [100 * r.collision.mean() for r in results]
    assert results[given["speed"] - 1].collision.any()
    assert given["turnAt"] == 4


def learned_alone(method: str, seed: int) -> mdp.PredictionResult:
    """What the package's function learns in the five rooms, in 100 episodes."""
    rooms = gym.make("FrozenLake-v1", desc=["HFFSFFG"], is_slippery=False)
    coin = np.tile([0.5, 0.0, 0.5, 0.0], (7, 1))
    options = {"discount": 1.0, "record": True, "seed": seed}
    if method == "TD(0)":
        return mdp.td_prediction(
            rooms, coin, 100, learning_rate=0.15, initial=0.5, **options
        )
    visit = "first" if "first" in method else "every"
    return mdp.monte_carlo_prediction(rooms, coin, 100, visit=visit, **options)


@pytest.mark.slow
@pytest.mark.parametrize("method", TRAININGS["td_step_size"].settings["method"].options)
def test_values_of_the_rooms_are_those_of_the_package(method):
    page = Page("td_step_size")
    given = page.train(method=method, learning_rate=0.15, seed=40)["given"]
    runs = page.lab.trainings
    assert len(runs) == len(given["episodes"]) == 20
    assert given["rate"] == 0.15
    for run, seed in ((runs[0], 40), (runs[19], 59)):
        alone = learned_alone(method, seed)
        inside = slice(1, 6)
        np.testing.assert_array_equal(
            run.history[:, inside], np.nan_to_num(alone.history, nan=0.5)[:, inside]
        )
        np.testing.assert_array_equal(run.visits, alone.visits)
    histories = np.array([run.history for run in runs])[:, ::20, 1:6]
    errors = np.sqrt(((histories - np.arange(1, 6) / 6) ** 2).mean(axis=2)).mean(axis=0)
    np.testing.assert_allclose(page.points("error"), errors)
    for run, episodes in zip(runs, given["episodes"], strict=True):
        assert len(episodes.split()) == 100
        if method != "Monte Carlo, first visit":
            passed = "".join(episode[:-1] for episode in episodes.split())
            assert [passed.count(str(room)) for room in range(7)] == run.visits.tolist()


@pytest.mark.slow
def test_a_car_learns_with_the_reader_s_tilings():
    page = Page("shared_tiles")
    ended = page.train(tilings=4, learning_rate=0.8, episodes=20, seed=3)
    (learned,) = page.lab.trainings
    car = gym.make("MountainCar-v0", max_episode_steps=2000)
    tiles = mdp.Tiles((-1.2, -0.07), (0.6, 0.07), (8, 8), 4, n_actions=3)
    options = {"discount": 1.0, "learning_rate": 0.2, "epsilon": 0.0, "seed": 3}
    alone = mdp.linear_sarsa(car, 20, tiles, **options)
    np.testing.assert_array_equal(learned.weights, alone.weights)
    assert page.points("steps") == alone.lengths.tolist()
    assert f"The first episode takes {alone.lengths[0]} steps" in ended["sentence"]
    assert ended["given"] == {"tilings": 4}
    assert alone.lengths[-5:].mean() < alone.lengths[:5].mean() / 2


def test_plans_for_the_reader_s_tiger():
    page = Page("tiger_vectors")
    page.train(accuracy=85, bite=100, beliefs=40, steps=60)
    (plan,) = page.lab.trainings
    full = mdp.point_based_value_iteration(
        mdp.tiger(), mdp.spread_beliefs(mdp.tiger(), [0.5, 0.5], 40)
    )
    # After 60 steps the discount has left 5 % of what is to come.
    assert plan.value([0.5, 0.5]) == pytest.approx(full.value([0.5, 0.5]), rel=0.06)
    assert page.points("value")[-1] == plan.value([0.5, 0.5])
    page.train(bite=300)
    assert page.lab.trainings[0].value([0.5, 0.5]) < plan.value([0.5, 0.5])


def test_the_mean_return_is_the_value():
    page = Page("turn_arrows")
    page.train(episodes=2000, policy="an optimal one", slip=0.3, discount=0.9)
    (returns,) = page.lab.trainings
    model = mdp.four_by_three(slip=0.3).mdp(0.9)
    value = mdp.policy_iteration(model).values[mdp.four_by_three().start.argmax()]
    error = returns.std() / np.sqrt(len(returns))
    assert returns.mean() == pytest.approx(value, abs=4 * error)
    assert page.points("error")[-1] == pytest.approx(error, rel=1e-3)


def test_paths_through_many_maps_are_the_planner_s():
    page = Page("astar_by_hand")
    ended = page.train(search="A* on a grid", margin=4.0, obstacles=40, seed=1, maps=40)
    plans = page.lab.trainings
    start, target = robot_trainings.START, robot_trainings.TARGET
    worlds = random_worlds(
        40, 40, seed=robot_trainings.SEED + 1, starts=(start,), targets=(target,)
    )
    alone = [plan_on_grid(worlds[k], margin=4.0) for k in range(40)]
    for one, other in zip(plans, alone, strict=True):
        np.testing.assert_array_equal(one.points, other.points)
    found = [made for made in alone if made.found]
    assert 0 < len(found) < 40
    assert f"found in {len(found)} of 40 maps" in ended["sentence"]
    left = [np.hypot(*(made.points[-1] - target)) for made in found]
    longer = np.mean([made.length for made in found] + np.array(left)) / np.hypot(
        75, 75
    )
    assert page.points("longer")[-1] == pytest.approx(100 * (longer - 1))
    assert page.points("expanded")[-1] == np.mean([made.expanded for made in alone])
    given = ended["given"]
    assert given["points"][given["start"]] == start
    assert given["points"][given["target"]] == target
    assert len(given["obstacles"]) == 40


def test_no_path_in_any_map_is_said(monkeypatch):
    nowhere = plan_on_grid(random_worlds(1, 0, seed=0), margin=50.0)
    assert not nowhere.found
    searches = {"modified A*": lambda _world, margin: nowhere}
    monkeypatch.setattr(robot_trainings, "SEARCHES", searches)
    page = Page("astar_by_hand")
    ended = page.train()
    assert "found in 0 of 20 maps. A search expands" in ended["sentence"]
    assert page.points("longer") == []


@pytest.mark.parametrize("right", [0.5, 0.7, 0.85])
def test_the_weight_of_the_samples_tends_to_the_exact_one(right):
    page = Page("weights_of_samples")
    exact = np.log(0.8 / 0.2) - np.log(right / (1 - right))
    ended = page.train(right=right, samples=1000, demonstrations=100, slack=0.0)
    (found,) = page.lab.trainings
    given = ended["given"]
    samples = np.array(given["features"])[:, None]
    again = nirl.relative_entropy_weights([given["expert"]], samples, np.zeros(1000))
    np.testing.assert_array_equal(found.weights, again.weights)
    assert found.weights[0] / 20 == pytest.approx(exact, abs=0.5)
    assert f"tends to {exact:.2f}" in ended["sentence"]
    assert given["theta"] == pytest.approx(found.weights[0] / 20, abs=0.0251)
    assert page.points("theta")[-1] == found.weights[0] / 20
    assert page.points("gap")[-1] < 0.005
    assert page.points("effective")[-1] == found.effective_samples
    assert len(page.points("gap")) == nirl_trainings.POINTS


def test_samples_near_the_expert_s_count_for_more():
    counted = []
    for right in (0.5, 0.65, 0.8):
        page = Page("weights_of_samples")
        page.train(right=right)
        counted.append(page.points("effective")[-1])
    assert counted == sorted(counted)
    assert counted[0] < 25 < 400 < counted[-1]


@pytest.mark.slow
@pytest.mark.parametrize("measure", nirl_trainings.MEASURES)
def test_the_policy_is_kept_by_the_chosen_measure(measure):
    page = Page("accuracy_or_balance")
    ended = page.train(measure=measure, caution=0.0, seed=0, iterations=10)
    (result,) = page.lab.trainings
    history = result.history
    of = {"accuracy": history.accuracies, "balanced accuracy": history.balanced}
    assert result.chosen == of[measure].argmax()
    assert history.accuracies.argmax() != history.balanced.argmax()
    np.testing.assert_allclose(page.points("accuracy"), 100 * history.accuracies[1:])
    np.testing.assert_allclose(page.points("balanced"), 100 * history.balanced[1:])
    begun = f"{measure.capitalize()} keeps the policy after iteration {result.chosen}, "
    assert ended["sentence"].startswith(begun)
    shown = demonstrate(
        random_worlds(5, 20, seed=nirl_trainings.DEMONSTRATION_SEED), caution=0.0
    )
    forward = (nirl.expert_decisions(shown).actions == 0).mean()
    assert ended["given"]["forward"] == pytest.approx(forward, abs=0.0251)
    balanced = history.balanced[result.chosen]
    careful = ended["given"]["careful"]
    assert careful == pytest.approx(max(balanced, 0.2), abs=0.0251)
