"""Chapter 4's experiments: what they run, what was chosen, what was published."""

import inspect
import json

import numpy as np
import pytest

from robonav.experiments import load_results
from robonav.experiments.nnql import CHOSEN, EXPERIMENTS, RESULTS, settings
from robonav.experiments.nnql_circles import CIRCLES, REWARDS_TRIED, RawNumbers, only_moving_away
from robonav.experiments.nnql_course import TEST_WORLDS, blocks, course, new_worlds
from robonav.experiments.nnql_tuning import (
    SPACE,
    TRIALS,
    TUNING,
    TUNING_SEEDS,
    TUNING_WORLDS,
    best_trials,
    trained,
    trial_settings,
)
from robonav.nnql import METHODS, reward
from robonav.nnql.rewards import reward_row
from robonav.robot import Sensing

ALL = (*EXPERIMENTS, CIRCLES, TUNING)


@pytest.mark.parametrize("experiment", ALL, ids=lambda experiment: experiment.name)
def test_every_experiment_gives_numbers_for_a_case(experiment):
    case = experiment.cases[-1] if experiment.name != "nnql-20-obstacles" else experiment.cases[0]
    numbers = experiment.run(case, 0, "quick")
    assert numbers
    for values in numbers.values():
        assert np.isfinite(np.asarray(values, dtype=float)).all()
    again = experiment.run(case, 0, "quick")
    for name, values in numbers.items():
        np.testing.assert_array_equal(values, again[name])


def test_every_method_has_as_many_trials():
    assert [case["method"] for case in TUNING.cases] == [m for m in METHODS for _ in range(TRIALS)]
    for method in METHODS:
        for trial in range(TRIALS):
            drawn = trial_settings(method, trial)
            assert set(drawn) == set(SPACE[method])
    assert all(trial_settings("nnql", trial) == trial_settings("online", trial) for trial in range(TRIALS))


def test_tuning_and_testing_never_meet():
    assert max(experiment.seeds["thesis"] for experiment in ALL) < min(TUNING_SEEDS, TUNING_WORLDS - TEST_WORLDS)
    tuned = {tuple(key) for seed in range(8) for key in new_worlds(50, TUNING_WORLDS + seed).keys}
    tested = {tuple(key) for seed in range(50) for key in new_worlds(50, TEST_WORLDS + seed).keys}
    assert not tuned & tested


def test_what_was_chosen_is_the_best_of_the_published_trials():
    assert best_trials(load_results(RESULTS, TUNING)) == CHOSEN


@pytest.mark.parametrize("method", METHODS)
def test_a_method_comes_with_the_settings_that_were_chosen(method):
    chosen = settings(method)
    if "fitting" in chosen:
        chosen["sweeps"], chosen["epochs"] = chosen.pop("fitting")
    chosen.pop("target")
    defaults = {name: p.default for name, p in inspect.signature(METHODS[method]).parameters.items()}
    assert {name: defaults[name] for name in chosen} == chosen


@pytest.mark.parametrize("experiment", ALL, ids=lambda experiment: experiment.name)
def test_results_at_the_thesiss_scale_are_published_whole(experiment):
    results = load_results(RESULTS, experiment)
    assert results.scale == "thesis"
    about = json.loads((RESULTS / f"{experiment.name}.json").read_text())
    assert about["settings"] == json.loads(json.dumps(dict(experiment.settings)))
    metric = results.rows[0].metric
    for case in range(len(experiment.cases)):
        assert len(results.values(metric, case)) == experiment.seeds["thesis"]


def test_training_twice_in_a_process_is_training_once():
    first = trained("nnql", 3, 4, settings("nnql"))
    assert trained("nnql", 3, 4, json.loads(json.dumps(settings("nnql")))) is first
    assert trained("nnql", 3, 4, settings("nnql"), obstacles=20) is not first


def test_blocks_count():
    won = np.array([[1, 0, 1, 1, 1, 0, 1], [0, 0, 0, 1, 0, 0, 1]], dtype=bool)
    np.testing.assert_array_equal(blocks(won, 3), [[2, 2], [0, 1]])


def some_steps(n=400):
    rng = np.random.default_rng(0)

    def read():
        ranges = rng.uniform(1, 12, (n, 9)).clip(max=10)
        return Sensing(ranges, np.zeros((n, 9), bool), np.ones(n, int), np.zeros(n, bool))

    return read(), read(), rng.integers(0, 3, n).astype(np.int8)


def test_rewards_that_were_tried_differ_only_where_they_say():
    before, after, outcome = some_steps()
    row, paid = reward_row(before, after, outcome), reward(before, after, outcome)
    farther = after.ranges.min(axis=1) > before.ranges.min(axis=1)
    strict = only_moving_away(before, after, outcome)
    np.testing.assert_array_equal(strict, np.where(np.isin(row, (6, 9)) & ~farther, 0, paid))
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
