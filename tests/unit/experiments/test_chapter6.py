"""The tuning of the planners, the variations of PPO, and what the pages say about the results."""

import functools
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robonav.benchmark import method
from robonav.deep import constant_reward, navigation_task, train_gail, train_ppo
from robonav.experiments import read_results
from robonav.experiments.chapter3 import setup as chapter3
from robonav.experiments.chapter4 import setup as chapter4
from robonav.experiments.chapter4 import tuning as learners
from robonav.experiments.chapter5 import setup as chapter5
from robonav.experiments.chapter6 import (
    body,
    curriculum,
    gail,
    planners,
    ppo,
    senses_and_memory,
    sensing,
    team,
    tuning,
)
from robonav.experiments.chapter6.setup import PLANNERS, SETUP, planner, tuned
from robonav.experiments.ship import SEEDS_6, folder_of, gail_weights, ppo_weights
from robonav.networks import load_weights
from robonav.nnql import METHODS
from robonav.planners import DynamicWindow
from robonav.robot import Action, Reflex, Simulator, random_worlds, turn_to_clearer_side


def test_planners_have_as_many_trials_as_the_learners():
    assert (tuning.TRIALS, tuning.FINAL_TRIALS) == (
        learners.TRIALS,
        learners.FINAL_TRIALS,
    )
    assert tuning.SEEDS["thesis"] == learners.TUNING.seeds["thesis"]
    assert tuning.FINAL_SEEDS["thesis"] == learners.FINALS.seeds["thesis"]


def test_finalists_and_settings_are_those_of_the_committed_results():
    ranked = tuning.best_trials(read_results("planner-tuning"), tuning.FINAL_TRIALS)
    cases = [
        (method, int(trial), settings.as_json())
        for method, trials in ranked.items()
        for trial, settings in trials.items()
    ]
    assert cases == [tuple(case.values()) for case in tuning.finals().cases]
    best = tuning.best_trials(read_results("planner-finals"), 1)
    assert tuned() == {name: next(iter(best[name].values())) for name in PLANNERS}


def test_each_trial_makes_a_planner():
    for case in tuning.TUNING.cases:
        made = planner(case["method"], json.loads(case["settings"]), 3.0)
        assert isinstance(made, PLANNERS[case["method"]])
        if isinstance(made, DynamicWindow):
            assert made.speed == 3.0


@pytest.mark.slow
def test_both_stages_and_the_table_by_one_call(tmp_path, monkeypatch):
    """At the quick scale, with two trials of each planner, into other files."""
    few = [case for case in tuning.TUNING.cases if case["trial"] < 2]
    monkeypatch.setattr(tuning, "TUNING", replace(tuning.TUNING, cases=few))
    monkeypatch.setattr(tuning, "FINALISTS", tmp_path / "finalists.toml")
    monkeypatch.setattr(tuning, "HYPERPARAMETERS", tmp_path / "best.toml")
    monkeypatch.setattr(tuning, "FINAL_TRIALS", 1)
    shown = replace(planners.table(), cases=planners.table().cases[:1])
    monkeypatch.setattr(tuning, "table", lambda: shown)
    monkeypatch.setitem(SETUP.navigations, "quick", 5)
    tuning.tune_and_test(tmp_path, scale="quick", jobs=1)
    found = tuning.read_settings(tmp_path / "best.toml")
    assert set(found) == set(PLANNERS)
    assert (tmp_path / "planners.csv").is_file()


published = functools.cache(read_results)


def rate(metric, method, setting):
    results = published("planners")
    place = list(results.experiment.cases).index({"method": method, "setting": setting})
    return results.summary(metric, place).mean


def test_what_the_page_says_about_failures():
    assert rate("out of steps", "vfh", "30 obstacles") > 5 * rate(
        "collision", "vfh", "30 obstacles"
    )
    exact, noisy = (
        rate("success", "vfh", setting)
        for setting in ("20 obstacles", "20, ranges off by 0.5 m")
    )
    assert noisy > exact
    assert rate("success", "bug", "30 obstacles") > rate("success", "vfh", "30 obstacles")  # fmt: skip


def test_what_the_page_says_about_tuning():
    results = read_results("planner-tuning")
    quoted = {"potential-field": (12, 7), "dynamic-window": (7, 9)}  # worst and best
    for name, (worst, best) in quoted.items():
        means = {
            case["trial"]: results.summary("success", place).mean
            for place, case in enumerate(results.experiment.cases)
            if case["method"] == name
        }
        assert (min(means, key=means.get), max(means, key=means.get)) == (worst, best)


def test_known_map_is_the_upper_end():
    for setting in planners.BOARD:
        best = max(rate("success", name, setting) for name in PLANNERS)
        assert rate("success", "known-map", setting) >= best - 1e-9


@pytest.mark.parametrize("method", PLANNERS)
def test_trials_differ(method):
    drawn = {tuning.trial_settings(method, trial) for trial in range(tuning.TRIALS)}
    assert len(drawn) >= 12


PPO_PAGE = Path(__file__).parents[3] / "book/deep-reinforcement-learning.md"


def test_the_page_trains_as_the_committed_variations():
    source = PPO_PAGE.read_text("utf-8")
    assert f"train_ppo(seeds=16, updates={ppo.TRAINING['updates']}, task=task)" in source  # fmt: skip
    assert ppo.TRAINING["actors"] == 16  # the default, which the page leaves out
    assert f"navigation_task(obstacles={ppo.SETUP.obstacles}, reflex=Reflex(" in source


def test_the_wrong_sign_turns_rewards_round():
    right, wrong = (ppo.task(**changes).reward for changes in ({}, {"reward": ppo.wrong_sign}))  # fmt: skip
    outcome = np.array([0, 1, 2], np.int8)
    rewards = right(None, None, outcome)
    assert set(rewards) == {-1.0, 0.0, 1.0}
    np.testing.assert_array_equal(wrong(None, None, outcome), -rewards)


def test_a_seed_of_a_variation_is_a_training_of_this_seed(monkeypatch):
    monkeypatch.setattr(ppo, "TRAINING", {"updates": 2, "actors": 3})
    monkeypatch.setattr(ppo, "SEEDS", {"quick": 2})
    monkeypatch.setitem(ppo.SETUP.navigations, "quick", 4)
    monkeypatch.setattr(ppo, "trained", ppo.trained.__wrapped__)
    numbers = ppo.vary({"variation": "10 epochs"}, 1, "quick")
    alone = train_ppo([1], 2, actors=3, epochs=10, task=ppo.task())
    assert numbers["episodes"] == alone.ended.sum()
    assert (numbers["steps of the actors"], numbers["steps of Adam"]) == (768, 80)
    assert len(numbers["arrivals of an update"]) == 2


def variation(name, statistic="mean"):
    results = published("ppo-variations")
    place = [case["variation"] for case in results.experiment.cases].index(name)
    return getattr(results.summary("success", place), statistic)


def test_what_the_page_says_about_the_faults_of_ppo():
    worst = {name: variation(name, "worst") for name in ppo.VARIATIONS}
    usual = variation("as on the page")
    assert variation("hardly clipped, ε = 0.99", "best") > usual
    assert max(worst[name] for name in ("hardly clipped, ε = 0.99", "λ = 0", "no entropy")) < 30  # fmt: skip
    assert worst["10 times the entropy"] > 80
    assert variation("10 times the entropy", "high") < usual
    assert worst["10 epochs"] == max(worst.values())
    assert variation("rewards with the wrong sign", "high") < 5


def test_the_ppo_that_ships_is_the_best_of_its_seeds_and_drives():
    weights = load_weights(folder_of("deep") / "ppo.safetensors")
    made = weights.made
    assert (weights.method, weights.temperature) == ("ppo", ppo.TEMPERATURE)
    assert made["seeds"] == list(SEEDS_6)
    assert made["seed"] in SEEDS_6
    assert made["settings"] | dict(ppo.TRAINING) == made["settings"]
    policy = method("ppo")
    found = ppo.SETUP.evaluate(policy, ppo.SETUP.worlds(200, 77))
    assert found["success"] > 97


@pytest.mark.parametrize(
    ("name", "setup", "least"),
    [("ppo-curriculum", curriculum.SETUP, 95), ("gail", gail.SETUP, 93)],
)
def test_the_other_networks_of_chapter_6_drive(name, setup, least):
    made = load_weights(folder_of("deep") / f"{name}.safetensors").made
    assert made["seeds"] == list(SEEDS_6)
    assert made["obstacles"] == setup.obstacles
    found = setup.evaluate(method(name), setup.worlds(200, 77))
    assert found["success"] > least


@pytest.mark.slow
def test_the_best_seed_of_gail_ships(monkeypatch):
    monkeypatch.setattr(gail, "TRAINING", {"updates": 3, "actors": 4})
    monkeypatch.setitem(gail.SETUP.navigations, "thesis", 20)
    monkeypatch.setattr(gail, "MOST_DEMONSTRATIONS", 2)
    weights = gail_weights((0, 1))
    assert weights.method == "gail"
    assert weights.made["seed"] in (0, 1)
    assert 0 <= weights.made["success in tuning worlds (%)"] <= 100


@pytest.mark.slow
def test_the_best_seed_of_ppo_ships(monkeypatch):
    monkeypatch.setattr(ppo, "TRAINING", {"updates": 6, "actors": 8})
    monkeypatch.setitem(ppo.SETUP.navigations, "thesis", 40)
    best = ppo_weights((0, 1, 2))
    alone = [ppo_weights((seed,)).made["success in tuning worlds (%)"] for seed in range(3)]  # fmt: skip
    assert best.made["success in tuning worlds (%)"] == max(alone)
    assert best.made["seed"] == int(np.argmax(alone))


def test_what_the_page_says_about_the_leaderboard():
    """PPO is among the methods of chapter 4 with 20 and 30 obstacles, and behind DAgger."""
    board = published("leaderboard")
    success = {
        (case["method"], case["setting"]): board.summary("success", place).mean
        for place, case in enumerate(board.experiment.cases)
    }
    for setting in ("20 obstacles", "30 obstacles"):
        chapter4 = [success[name, setting] for name in METHODS]
        assert min(chapter4) < success["ppo", setting] < max(chapter4)
        assert success["ppo", setting] < success["dagger", setting]


def test_what_the_page_says_about_the_control_of_the_curriculum():
    def after(name, setting):
        if name == "control":
            results = published("ppo-curriculum-control")
            (control,) = curriculum.CONTROLS
            case = {"control": control, "setting": setting}
        else:
            results = published("ppo-curriculum")
            case = {"stage": list(curriculum.STAGES)[name - 1], "setting": setting}
        return results.summary(
            "success", list(results.experiment.cases).index(case)
        ).mean

    def share(setting):
        gain = after(2, setting) - after(1, setting)
        return (after("control", setting) - after(1, setting)) / gain

    assert 0.4 < share("30 obstacles") < 0.6
    assert share("10 and 10 moving") < 0.2
    one, two = (settings for _, settings in list(curriculum.STAGES.values())[:2])
    made = [s["updates"]["thesis"] * s["actors"] for s in (one, two)]
    assert made[1] / made[0] == 25


def test_what_the_page_says_about_the_front():
    """Cloning, DAgger and NIRL are not beaten with 20 obstacles, but PPO in stages beats two of them."""
    board = published("leaderboard")
    found = {
        case["method"]: [board.summary(metric, place).mean for metric in ("success", "SPL")]
        for place, case in enumerate(board.experiment.cases)
        if case["setting"] == "20 obstacles" and case["method"] != "straight"
    }  # fmt: skip

    def front(names):
        return {
            name
            for name in names
            if not any((np.array(found[o]) > found[name]).all() for o in names)
        }

    assert front(found) == {"lfd", "ppo-curriculum"}
    assert front(set(found) - {"ppo-curriculum"}) == {"lfd", "dagger", "nirl"}
    assert found["nirl"] > found["dagger"] > found["lfd"]
    assert found["lfd"][1] > found["dagger"][1] > found["nirl"][1]
    dense = [of_board("dqn", n) - of_board("ppo", n) for n in (20, 30)]
    assert min(dense) > 0


def of_board(name, obstacles):
    board = published("leaderboard")
    case = {"method": name, "setting": f"{obstacles} obstacles"}
    return board.summary("success", list(board.experiment.cases).index(case)).mean


def remembered(metric, network, k):
    results = published("memory")
    case = {"network": network, "k": k, "reflex": "none"}
    return results.summary(metric, list(results.experiment.cases).index(case))


def test_only_a_memory_that_is_long_enough_holds_the_niche():
    assert abs(remembered("niche read", "window", 1).mean - 50) < 5
    assert remembered("niche read", "window", 20).low > 95
    assert remembered("niche read", "gru", 0).low > 95


def test_a_window_of_20_steps_arrives_more_often_in_time_than_none():
    assert (
        remembered("success", "window", 20).mean
        > remembered("success", "window", 1).mean + 15
    )
    assert remembered("success in 300 s", "window", 1).low > 90


def test_a_run_of_gail_is_trained_as_it_would_alone(monkeypatch):
    monkeypatch.setattr(gail, "TRAINING", {"updates": 2, "actors": 3})
    monkeypatch.setattr(gail, "SEEDS", {"quick": 2})
    monkeypatch.setitem(gail.SETUP.navigations, "quick", 4)
    monkeypatch.setattr(gail, "trained", gail.trained.__wrapped__)
    case = {"method": "gail", "reward": "constant 1", "demonstrations": 2}
    numbers = gail.run(case, 1, "quick")
    task = navigation_task(obstacles=10, speed=2.0, reflex=Reflex("exact"))
    own = gail.demonstrations_of_run(2, 1)
    alone = train_gail(own, [1], 2, actors=3, task=task, reward=constant_reward)
    policy = replace(alone.policies[0], temperature=ppo.TEMPERATURE)
    expected = gail.SETUP.evaluate(policy, gail.SETUP.test_worlds(1, "quick"))
    assert numbers == expected


def test_what_the_page_says_about_gail():
    results = published("gail")
    mean = {
        tuple(case.values()): np.mean(results.values("success", k))
        for k, case in enumerate(results.experiment.cases)
    }
    assert mean["gail", "-log D", 10] > 2 * mean["gail", "constant 1", 10]
    assert mean["gail", "log(1 - D)", 10] < 10
    straight = results.values("success", len(mean) - 1)  # in the same worlds
    np.testing.assert_array_equal(results.values("success", 6), straight)
    assert mean["gail", "constant 1", 10] - np.mean(straight) < 10
    odds = results.values("success", 2)
    assert sorted(odds)[-2] < 20 < max(odds)  # nine of ten runs
    for number in (1, 3, 10):
        less = mean["lfd-less-regularised", "no reward", number]
        assert mean["lfd", "no reward", number] < mean["gail", "-log D", number] < less
    steps = gail.TRAINING["updates"] * gail.TRAINING["actors"] * 128
    page = Path("book/adversarial-imitation.md").read_text("utf-8")
    assert f"{steps:,} steps" in page
    assert f"With a regularisation of {gail.LESS} in place of 1" in page


def of_team(metric, name="team", **wanted):
    results = published(name)
    place = list(results.experiment.cases).index(wanted)
    return results.summary(metric, place).mean


def test_what_the_page_says_about_several_robots():
    alone = {
        name: of_team("success", method=name, robots=1)
        for name in ("freer-side", "dagger", "nnql", "nirl", "potential-field")
    }
    assert min(alone.values()) > 98
    assert abs(alone["nirl"] - alone["dagger"]) < 0.1
    for name in alone:
        rates = [of_team("success", method=name, robots=n) for n in (1, 2, 4, 8, 16)]
        assert sorted(rates, reverse=True) == rates
        hit = of_team("collision with a robot", method=name, robots=16)
        assert hit > of_team("collision with an obstacle", method=name, robots=16)


def test_the_first_rule_is_freer_side():
    sensing = Simulator(random_worlds(300, obstacles=30, seed=3)).sense()
    ahead, _ = team.LOOKS
    freer, right = team.TURNS
    rng = np.random.default_rng(0)
    usual = turn_to_clearer_side(sensing, rng)
    np.testing.assert_array_equal(team.rule(ahead, freer)(sensing, rng), usual)
    turned = team.rule(ahead, right)(sensing, rng)
    np.testing.assert_array_equal(
        turned, np.where(usual == Action.L60, Action.R60, usual)
    )
    case = {"looks": ahead, "turns": freer, "robots": 2}
    assert team.evaluate_rule(case, 0, "quick")["collision with a robot"] > 0


def test_what_the_page_says_about_rules():
    """A wider look helps among sixteen robots, and turning right does not."""

    def arrived(looks, turns, robots=16):
        case = {"looks": looks, "turns": turns, "robots": robots}
        return of_team("success", "team-rules", **case)

    ahead, both = team.LOOKS
    freer, right = team.TURNS
    usual = arrived(ahead, freer)
    assert usual == of_team("success", method="freer-side", robots=16)
    assert arrived(both, freer) > usual + 50
    assert abs(arrived(ahead, right) - usual) < 2
    assert arrived(both, right, 1) < 60
    assert arrived(both, freer) > max(
        of_team("success", method=name, robots=16) for name in team.METHODS
    )


def test_what_the_page_says_about_learning_together():
    page = Path("book/several-robots.md").read_text("utf-8")
    updates, learners = team.LEARNING["updates"]["thesis"], team.LEARNING["learners"]
    assert f"A training has {updates} updates with {learners} episodes each" in page

    def arrived(learners, robots):
        case = {"robots in training": learners, "robots": robots}
        return of_team("success", "team-learning", **case)

    assert arrived(8, 16) > arrived(1, 16) + 10
    assert arrived(8, 1) > 95
    assert arrived(1, 1) > 95
    assert abs(arrived(8, 16) - of_team("success", method="dagger", robots=16)) < 10


def sensed(metric, number, network, sensor="sectors"):
    results = published("sensing")
    case = {"sensor": sensor, "number": number, "network": network}
    return results.summary(metric, list(results.experiment.cases).index(case))


def test_what_the_leaderboard_says_about_senses_and_memories():
    """No sensor and no memory is ahead of its control by more than the intervals of both."""
    results = published("senses-and-memory")
    places = list(results.experiment.cases)

    def success(method, setting):
        place = places.index({"method": method, "setting": setting})
        return results.summary("success", place)

    assert {case["method"] for case in places} == {
        *senses_and_memory.SENSORS,
        *senses_and_memory.MEMORIES,
    }
    for setting in senses_and_memory.BOARD:
        for control, others in (
            ("sectors-9", ("sectors-36", "picture")),
            ("window-1", ("window-8", "gru")),
        ):
            for other in others:
                least = success(other, setting).low
                assert least <= success(control, setting).high


def test_a_memory_learns_in_the_worlds_of_the_page_on_sensing(monkeypatch):
    seen = {}

    def trained(policy, rounds, **settings):
        seen.update(policy=policy, rounds=rounds, **settings)
        return policy

    monkeypatch.setattr(senses_and_memory, "dagger_with_memory", trained)
    senses_and_memory.trained.__wrapped__("window-8", 3, "quick")
    assert seen["policy"].network.k == 8
    first = sensing.TRAINING["seed"] + 300
    number = sensing.TRAINING["worlds"]["quick"]
    for k, worlds in enumerate(seen["rounds"]):
        expected = sensing.SETUP.worlds(number, first + k)
        assert worlds.digest() == expected.digest()
    assert seen["reflex"] == sensing.SETUP.reflex


RINGS = [(n, "fully connected") for n in (9, 18, 36, 72)] + [
    (n, "convolutional") for n in (36, 72)
]


def test_what_the_page_says_about_rings():
    """All intervals overlap with that of nine sectors, and half of the preferred actions are the expert's."""
    for metric in ("success", "30 obstacles"):
        few = sensed(metric, 9, "fully connected")
        for ring in RINGS[1:]:
            more = sensed(metric, *ring)
            assert more.low < few.high
            assert few.low < more.high
    found = [sensed("expert's action", *ring).mean for ring in RINGS]
    assert 45 < min(found) < max(found) < 60


def test_what_the_page_says_about_moving_obstacles():
    """One pair with nine sectors is apart: the ring of 18, where obstacles move."""
    apart = [
        (metric, ring)
        for metric in ("10 obstacles", "success", "30 obstacles", "10 and 10 moving")
        for ring in RINGS[1:]
        if sensed(metric, *ring).low > sensed(metric, 9, "fully connected").high
        or sensed(metric, *ring).high < sensed(metric, 9, "fully connected").low
    ]
    assert apart == [("10 and 10 moving", (18, "fully connected"))]


def test_what_the_page_says_about_weights():
    page = Path("book/sensing.md").read_text("utf-8")
    counted = [
        sensed("weights", 32, network, "picture").mean
        for network in ("convolutional", "fully connected")
    ]
    assert "about a third of its weights" in page
    assert counted[0] / counted[1] == pytest.approx(1 / 3, abs=0.05)
    shared, full = (
        sensed("collision", 32, network, "picture")
        for network in ("convolutional", "fully connected")
    )
    assert shared.high < full.low


def test_what_the_page_says_about_randomised_training():
    results = published("sensing-randomised")
    for metric in ("success", "1 m, 0.4", "3 m, 0.8"):
        exact, randomised = (results.summary(metric, case).mean for case in (0, 1))
        assert randomised <= exact


@pytest.mark.slow
def test_a_stage_goes_on_with_the_networks_of_the_one_before(monkeypatch):
    monkeypatch.setattr(curriculum, "SEEDS", {"quick": 2})
    monkeypatch.setitem(curriculum.SETUP.navigations, "quick", 4)
    one, two = list(curriculum.STAGES)[:2]
    first = curriculum.trained(one, (0, 1), "quick")
    worlds, settings = curriculum.STAGES[two]
    alone = train_ppo(
        [1000, 1001], 2, actors=settings["actors"], start=first,
        task=navigation_task(speed=2.0, reflex=Reflex("exact"), **worlds),
    )  # fmt: skip
    numbers = curriculum.run({"stage": two, "setting": "30 obstacles"}, 1, "quick")
    tested = curriculum.SETUP.test_worlds(1, "quick", obstacles=30)
    assert numbers == curriculum.SETUP.evaluate(alone.policies[1], tested)


def after(stage, setting, metric="success"):
    results = published("ppo-curriculum")
    case = {"stage": list(curriculum.STAGES)[stage - 1], "setting": setting}
    return results.summary(metric, list(results.experiment.cases).index(case))


def test_what_the_page_says_about_a_longer_training():
    """More than 99 % among 20 obstacles, 95 % among 30, and 97 % where ten of twenty move."""
    for setting, least in (("20 obstacles", 99), ("30 obstacles", 95), ("10 and 10 moving", 97)):  # fmt: skip
        gains = np.diff([after(stage, setting).mean for stage in (1, 2, 3, 4)])
        assert gains[0] == max(gains)
        assert after(4, setting).low > least
    assert len(published("ppo-curriculum").values("success", 0)) == 10
    assert curriculum.SETUP.navigations["thesis"] == 1000


COMPARED = Path(__file__).parents[3] / "book/methods-compared.md"


def test_the_data_of_the_methods_on_the_page_that_compares_them():
    source = COMPARED.read_text("utf-8")
    maps = chapter3.DEMONSTRATIONS
    assert f"| cloning | {maps} demonstrations |" in source
    every = maps * (1 + chapter3.ROUNDS)
    assert f"labels states of {every} episodes | – | {every - maps} |" in source
    for name in ("NNQL", "DQN"):
        assert f"| {name} | – | in each step | {chapter4.EPISODES} |" in source
    own = chapter5.ITERATIONS * chapter5.EPISODES_PER_ITERATION
    assert f"| NIRL | {chapter5.DEMONSTRATIONS} demonstrations | learned | {own:,} |" in source  # fmt: skip
    assert (
        "| GAIL | 10 demonstrations | learned | about 1,270 |" in source
    )  # seed 0: 1,266
    for number, (_, settings) in enumerate(curriculum.STAGES.values(), start=1):
        assert re.search(rf"^{number}\. .*\b{settings['updates']['thesis']} updates", source, re.M)  # fmt: skip


def of_body(metric, name="body", **wanted):
    results = published(name)
    place = list(results.experiment.cases).index(wanted)
    return results.summary(metric, place).mean


def test_what_the_page_says_about_a_body():
    def lost(name, kind):
        alone = of_body("success", method=name, body="none")
        return alone - of_body("success", method=name, body=kind)

    assert all(lost(name, "usual") < 10 for name in body.METHODS)
    everything = {name: lost(name, "everything worse") for name in body.METHODS}
    assert max(everything, key=everything.get) == "ppo"
    assert min(everything, key=everything.get) == "lfd"
    collided = {
        kind: of_body("collision", method="ppo", body=kind) for kind in body.BODIES
    }
    assert collided["everything worse"] > collided["none"] + everything["ppo"]


def test_what_the_page_says_about_randomised_training_for_a_body():
    def of(metric, training, kind):
        case = {"trained in": training, "body": kind}
        return of_body(metric, "body-training", **case)

    plain, randomised = body.TRAININGS
    assert of("success", plain, "none") > 99
    assert of("success", randomised, "none") > 99
    everything = [of("success", kind, "everything worse") for kind in body.TRAININGS]
    assert everything[1] > everything[0]
    seconds = [of("seconds to the target", kind, "usual") for kind in body.TRAININGS]
    assert seconds[1] > seconds[0]
