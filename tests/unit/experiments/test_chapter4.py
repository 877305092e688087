"""Chapter 4's experiments: what they run, what was chosen, what was published."""

import inspect
import json

import numpy as np
import pytest

from robonav.benchmark import BASELINES, policies
from robonav.experiments import read_results
from robonav.experiments.chapter4.ablations import (
    CIRCLES,
    REWARDS_TRIED,
    RawNumbers,
    only_moving_away,
)
from robonav.experiments.chapter4.setup import (
    EVALUATION_TEMPERATURE,
    HYPERPARAMETERS,
    SETUP,
    THESIS,
    VARIANTS,
    blocks,
    evaluate,
    task,
    training,
    tuned,
)
from robonav.experiments.chapter4.tables import EQUAL_STEPS, EXPERIMENTS, TABLE_4_3
from robonav.experiments.chapter4.tuning import (
    FINALISTS,
    FINALS,
    SPACE,
    TRIALS,
    TUNING,
    TUNING_SEEDS,
    trial_settings,
    write_finalists,
    write_tuned,
)
from robonav.experiments.runner.settings import Settings
from robonav.experiments.ship import folder_of, nnql_weights
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
            names = set(SPACE[method])
            if "sweeps and epochs" in names:
                names = names - {"sweeps and epochs"} | {"sweeps", "epochs"}
            assert set(drawn) == names
    assert all(
        trial_settings("nnql", trial) == trial_settings("online", trial)
        for trial in range(TRIALS)
    )


def test_tuning_and_testing_never_meet():
    assert max(experiment.seeds["thesis"] for experiment in ALL) < min(
        TUNING_SEEDS, SETUP.tuning_seed - SETUP.test_seed
    )
    tuned = {
        tuple(key)
        for seed in range(8)
        for key in SETUP.worlds(50, SETUP.tuning_seed + seed).keys
    }
    tested = {
        tuple(key)
        for seed in range(50)
        for key in SETUP.worlds(50, SETUP.test_seed + seed).keys
    }
    assert not tuned & tested


@pytest.mark.slow
def test_finalists_have_other_seeds_than_the_trials_they_were_picked_by():
    case = FINALS.cases[0]
    tried = {tuple(TUNING.run(case, seed, "quick").values()) for seed in range(4)}
    assert tuple(FINALS.run(case, 0, "quick").values()) not in tried


@pytest.mark.parametrize("method", METHODS)
def test_a_method_comes_with_the_settings_that_were_chosen(method):
    chosen = dict(tuned()[method])
    chosen.pop("target")
    defaults = {
        name: p.default
        for name, p in inspect.signature(METHODS[method]).parameters.items()
    }
    assert {name: defaults[name] for name in chosen} == chosen


def test_no_method_had_more_learning_steps_than_nnql():
    results, table = read_results(EQUAL_STEPS), read_results(TABLE_4_3)
    nnql = results.values("learning steps", 0)
    np.testing.assert_array_equal(
        results.values("success", 0), table.values("success", 0)
    )
    for k in range(len(EQUAL_STEPS.cases)):
        spent, whole = (
            results.values(name, k)
            for name in ("learning steps", "learning steps, whole training")
        )
        assert (spent <= nnql).all()
        assert (
            (spent == whole) | (spent > 0.9 * nnql)
        ).all()  # it stopped no earlier than it had to


@pytest.mark.slow
def test_a_method_is_stopped_where_nnqls_steps_end():
    numbers = EQUAL_STEPS.run({"method": "nfq"}, 1, "quick")
    allowed = training("nnql", 1, "quick", tuned()["nnql"]).decisions[0].sum()
    trained = training("nfq", 1, "quick", tuned()["nfq"], record=True)
    last = int(numbers["episodes"])
    assert trained.decisions[0, :last].sum() == numbers["learning steps"] <= allowed
    assert trained.steps[0, :last].sum() == numbers["simulated seconds"]
    assert last == 300 or trained.decisions[0, : last + 1].sum() > allowed
    policy = NetworkPolicy(trained.history[0, last], trained.encoder)
    assert (
        evaluate(policy, SETUP.test_worlds(1, "quick"))["success"] == numbers["success"]
    )


def test_a_rule_is_judged_once_and_a_network_also_when_cold():
    worlds = SETUP.worlds(40, 5)
    assert set(evaluate(BASELINES["straight"], worlds)) == {
        "success",
        "collision",
        "out of steps",
    }
    policy = training("nnql", 3, "quick", tuned()["nnql"], length=0.1).policies[0]
    numbers = evaluate(policy, worlds)
    assert set(numbers) == {
        "success",
        "collision",
        "out of steps",
        "success, low temperature",
    }
    assert numbers["success"] + numbers["collision"] + numbers[
        "out of steps"
    ] == pytest.approx(100)


@pytest.mark.parametrize("name", METHODS)
def test_a_network_of_every_method_ships_with_what_made_it(name):
    weights = load_weights(folder_of("nnql") / f"{name}.safetensors")
    assert weights.method == name
    assert weights.temperature == EVALUATION_TEMPERATURE[name]
    assert weights.made["settings"] == json.loads(json.dumps(dict(tuned()[name])))
    assert weights.made["seed"] in weights.made["seeds"]
    policy = policies.method(name)
    assert isinstance(policy, NetworkPolicy)
    assert evaluate(policy, SETUP.worlds(200, 77))["success"] > 93


@pytest.mark.slow
def test_training_twice_in_a_process_is_training_once():
    first = training("nnql", 3, "quick", tuned()["nnql"], length=0.1)
    same = Settings.of(json.loads(tuned()["nnql"].as_json()))
    again = training("nnql", 3, "quick", same, length=0.1)
    assert first.outcomes.shape == (1, 30)
    assert np.shares_memory(first.outcomes, again.outcomes)
    dense = training("nnql", 3, "quick", tuned()["nnql"], length=0.1, obstacles=20)
    assert not np.shares_memory(first.outcomes, dense.outcomes)


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
    np.testing.assert_allclose(raw[:, :7] / 7, task().encoder(before)[:, :7])


def test_the_tuning_writes_the_hyperparameters(tmp_path):
    """From the published trials, byte for byte what the tables read."""
    write_finalists(path=tmp_path / "finalists.toml")
    write_tuned(path=tmp_path / "hyperparameters.toml")
    assert (tmp_path / "finalists.toml").read_bytes() == FINALISTS.read_bytes()
    assert (
        tmp_path / "hyperparameters.toml"
    ).read_bytes() == HYPERPARAMETERS.read_bytes()


@pytest.mark.slow
def test_the_best_of_several_seeds_ships():
    best = nnql_weights("nnql", (0, 1, 2), length=0.1)
    alone = [
        nnql_weights("nnql", (seed,), length=0.1).made["success in tuning worlds (%)"]
        for seed in range(3)
    ]
    assert best.made["success in tuning worlds (%)"] == max(alone)
    assert best.made["seed"] == int(np.argmax(alone))


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow if name == "dqn" else ())
        for name in METHODS
    ],
)
def test_seeds_in_a_batch_train_as_alone(name):
    together = training(name, 11, "thesis", THESIS[name], length=1 / 75)
    options = dict(THESIS[name]) | VARIANTS.get(name, {})
    where = task(target=options.pop("target"))
    alone = train(name, [11], 4, task=where, **options)
    assert together.seeds == alone.seeds == (11,)
    np.testing.assert_array_equal(together.outcomes, alone.outcomes)
    for ours, theirs in zip(
        together.network.weights, alone.network.weights, strict=True
    ):
        np.testing.assert_array_equal(ours, theirs)
