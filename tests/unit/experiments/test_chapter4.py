"""Chapter 4's experiments: what they run, what was chosen, what was published."""

import inspect
import json

import numpy as np
import pytest

from robonav.benchmark import policies
from robonav.experiments import load_results
from robonav.experiments.chapter4.ablations import (
    CIRCLES,
    REWARDS_TRIED,
    RawNumbers,
    only_moving_away,
)
from robonav.experiments.chapter4.setup import (
    TEST_WORLDS,
    blocks,
    course,
    judged,
    new_worlds,
)
from robonav.experiments.chapter4.ship import SHIPPED, best_of, ship
from robonav.experiments.chapter4.tables import (
    CHOSEN,
    EXPERIMENTS,
    RESULTS,
    RULES,
    SPEEDS,
    STEPS,
    TABLE_4_2,
    TABLE_4_3,
    TWENTY,
    cold,
    settings,
)
from robonav.experiments.chapter4.tuning import (
    FINALISTS,
    FINALS,
    FIRST,
    SPACE,
    TRIALS,
    TUNING,
    TUNING_SEEDS,
    TUNING_WORLDS,
    arguments,
    ranking,
    trained,
    trial_settings,
)
from robonav.networks import NetworkPolicy, load_weights
from robonav.nnql import METHODS, reward, train
from robonav.nnql.reward import reward_row
from robonav.robot import Sensing

ALL = (*EXPERIMENTS, CIRCLES, TUNING, FINALS)


def test_every_method_has_as_many_trials():
    assert [case["method"] for case in TUNING.cases] == [
        m for m in METHODS for _ in range(TRIALS)
    ]
    for method in METHODS:
        for trial in range(TRIALS):
            drawn = trial_settings(method, trial)
            assert set(drawn) == set(SPACE[method])
    assert all(
        trial_settings("nnql", trial) == trial_settings("online", trial)
        for trial in range(TRIALS)
    )


def test_tuning_and_testing_never_meet():
    assert max(experiment.seeds["thesis"] for experiment in ALL) < min(
        TUNING_SEEDS, TUNING_WORLDS - TEST_WORLDS
    )
    tuned = {
        tuple(key)
        for seed in range(8)
        for key in new_worlds(50, TUNING_WORLDS + seed).keys
    }
    tested = {
        tuple(key)
        for seed in range(50)
        for key in new_worlds(50, TEST_WORLDS + seed).keys
    }
    assert not tuned & tested


def test_what_was_chosen_is_the_best_of_the_published_trials():
    trials, finals = load_results(RESULTS, TUNING), load_results(RESULTS, FINALS)
    assert {
        name: tuple(trials[:4]) for name, trials in ranking(trials).items()
    } == FINALISTS
    assert {name: trials[0] for name, trials in ranking(finals).items()} == CHOSEN


def test_finalists_have_other_seeds_than_the_trials_they_were_picked_by():
    case = FINALS.cases[0]
    tried = {tuple(TUNING.run(case, seed, "quick").values()) for seed in range(4)}
    assert tuple(FINALS.run(case, 0, "quick").values()) not in tried


@pytest.mark.parametrize("method", METHODS)
def test_a_method_comes_with_the_settings_that_were_chosen(method):
    chosen = arguments(settings(method))
    if "fitting" in chosen:
        chosen["sweeps"], chosen["epochs"] = chosen.pop("fitting")
    chosen.pop("target")
    defaults = {
        name: p.default
        for name, p in inspect.signature(METHODS[method]).parameters.items()
    }
    assert {name: defaults[name] for name in chosen} == chosen


def test_table_4_3_holds_what_the_book_says_of_it():
    results = load_results(RESULTS, TABLE_4_3)
    nnql = results.values("success", 0)
    assert len(nnql) >= 50
    assert nnql.mean() >= 98
    assert np.percentile(nnql, 5) >= 95


def test_every_speed_is_driven_well():
    results = load_results(RESULTS, TABLE_4_2)
    for k, case in enumerate(TABLE_4_2.cases):
        if case["robot"] == "nnql":
            assert case["speed"] in SPEEDS
            assert results.summary("success", k).mean >= 95


def test_twenty_obstacles_are_driven_well_with_a_little_chance_and_nearly_so_without():
    results = load_results(RESULTS, TWENTY)
    ours = [
        k
        for k, case in enumerate(TWENTY.cases)
        if case["robot"] == "rates that fall" and case["episodes"] == 600
    ]
    assert results.summary("success, cold", ours[0]).mean >= 94
    assert results.summary("success", ours[0]).mean >= 93


def test_no_method_had_more_learning_steps_than_nnql():
    results, table = load_results(RESULTS, STEPS), load_results(RESULTS, TABLE_4_3)
    nnql = results.values("learning steps", 0)
    np.testing.assert_array_equal(
        results.values("success", 0), table.values("success", 0)
    )
    for k in range(len(STEPS.cases)):
        spent, whole = (
            results.values(name, k)
            for name in ("learning steps", "learning steps, whole training")
        )
        assert (spent <= nnql).all()
        assert (
            (spent == whole) | (spent > 0.9 * nnql)
        ).all()  # it stopped no earlier than it had to


def test_a_method_is_stopped_where_nnqls_steps_end():
    numbers = STEPS.run({"robot": "nfq"}, 1, "quick")
    allowed = trained("nnql", 1, "quick", settings("nnql")).decisions[0].sum()
    training = trained("nfq", 1, "quick", settings("nfq"), record=True)
    last = int(numbers["episodes"])
    assert training.decisions[0, :last].sum() == numbers["learning steps"] <= allowed
    assert training.steps[0, :last].sum() == numbers["seconds driven"]
    assert last == 300 or training.decisions[0, : last + 1].sum() > allowed
    policy = NetworkPolicy(training.history[0, last], training.encoder)
    assert (
        judged(policy, new_worlds(100, TEST_WORLDS + 1))["success"]
        == numbers["success"]
    )


def test_a_rule_is_judged_once_and_a_network_also_when_cold():
    worlds = new_worlds(40, 5)
    assert set(judged(RULES["straight"], worlds)) == {
        "success",
        "collision",
        "out of steps",
    }
    policy = trained("nnql", 3, "quick", settings("nnql"), length=0.1).policies[0]
    numbers = judged(policy, worlds)
    assert set(numbers) == {"success", "collision", "out of steps", "success, cold"}
    assert numbers["success"] + numbers["collision"] + numbers[
        "out of steps"
    ] == pytest.approx(100)


@pytest.mark.parametrize("name", METHODS)
def test_a_network_of_every_method_ships_with_what_made_it(name):
    weights = load_weights(SHIPPED / f"{name}.safetensors")
    assert weights.method == name
    assert weights.temperature == cold(name)
    assert weights.made["settings"] == json.loads(json.dumps(settings(name)))
    assert weights.made["seed"] in weights.made["seeds"]
    policy = policies.method(name)
    assert isinstance(policy, NetworkPolicy)
    assert judged(policy, new_worlds(200, 77))["success"] > 93


def test_the_best_of_several_robots_is_shipped(tmp_path, monkeypatch):
    best = best_of("nnql", (0, 1, 2), length=0.1)
    alone = [
        best_of("nnql", (seed,), length=0.1).made["success in tuning worlds (%)"]
        for seed in range(3)
    ]
    assert best.made["success in tuning worlds (%)"] == max(alone)
    assert best.made["seed"] == int(np.argmax(alone))
    monkeypatch.setattr("robonav.experiments.chapter4.ship.best_of", lambda name: best)
    ship(tmp_path)
    assert sorted(path.stem for path in tmp_path.iterdir()) == sorted(METHODS)


def test_training_twice_in_a_process_is_training_once():
    first = trained("nnql", 3, "quick", settings("nnql"), length=0.1)
    again = trained(
        "nnql", 3, "quick", json.loads(json.dumps(settings("nnql"))), length=0.1
    )
    assert first.outcomes.shape == (1, 30)
    assert np.shares_memory(first.outcomes, again.outcomes)
    dense = trained("nnql", 3, "quick", settings("nnql"), length=0.1, obstacles=20)
    assert not np.shares_memory(first.outcomes, dense.outcomes)


@pytest.mark.parametrize("name", METHODS)
def test_seeds_train_together_as_they_would_alone(name):
    together = trained(name, 11, "thesis", FIRST[name], length=1 / 75)
    options = dict(FIRST[name])
    if "fitting" in options:
        options["sweeps"], options["epochs"] = options.pop("fitting")
    task = course(target=options.pop("target"))
    alone = train(name, [11], 4, task=task, **arguments(options))
    assert together.seeds == alone.seeds == (11,)
    np.testing.assert_array_equal(together.outcomes, alone.outcomes)
    for ours, theirs in zip(
        together.network.weights, alone.network.weights, strict=True
    ):
        np.testing.assert_array_equal(ours, theirs)


def test_blocks_count():
    won = np.array([[1, 0, 1, 1, 1, 0, 1], [0, 0, 0, 1, 0, 0, 1]], dtype=bool)
    np.testing.assert_array_equal(blocks(won, 3), [[2, 2], [0, 1]])


def some_steps(n=400):
    rng = np.random.default_rng(0)

    def read():
        ranges = rng.uniform(1, 12, (n, 9)).clip(max=10)
        return Sensing(
            ranges, np.zeros((n, 9), bool), np.ones(n, int), np.zeros(n, bool)
        )

    return read(), read(), rng.integers(0, 3, n).astype(np.int8)


def test_rewards_that_were_tried_differ_only_where_they_say():
    before, after, outcome = some_steps()
    row, paid = reward_row(before, after, outcome), reward(before, after, outcome)
    farther = after.ranges.min(axis=1) > before.ranges.min(axis=1)
    strict = only_moving_away(before, after, outcome)
    np.testing.assert_array_equal(
        strict, np.where(np.isin(row, (6, 9)) & ~farther, 0, paid)
    )
    for name, changed in (
        ("half as much for evading", {6: 0.3, 9: 0.2}),
        ("0.6 for getting safe, too", {2: 0.6}),
        ("nothing for staying cozy", {6: 0.0}),
    ):
        tried = REWARDS_TRIED[name](before, after, outcome)
        wanted = [changed.get(int(r), p) for r, p in zip(row, paid, strict=True)]
        np.testing.assert_array_equal(tried, wanted)


def test_raw_numbers_are_the_sixteen_of_the_thesis():
    before, _, _ = some_steps(5)
    raw = RawNumbers()(before)
    assert raw.shape == (5, RawNumbers().size) == (5, 16)
    assert raw.max() > 1
    np.testing.assert_allclose(raw[:, :7] / 7, course().encoder(before)[:, :7])
