"""Chapter 5's experiments: what they run, what was chosen, what was published."""

import json

import numpy as np
import pytest

from robonav.experiments import load_results
from robonav.experiments.chapter5 import ablations, ship, tables, transfer
from robonav.experiments.chapter5.setup import (
    CONTROLS,
    NAVIGATIONS,
    SHORTENED,
    SHOWN_WORLDS,
    TEST_WORLDS,
    demonstrations,
    learned,
    new_worlds,
    policy,
    teach,
)
from robonav.experiments.chapter5.tables import CHOSEN, CLONING, RESULTS, settings
from robonav.experiments.chapter5.tuning import (
    DISCOUNTS,
    METHODS,
    SPACE,
    TRIALS,
    TUNING,
    TUNING_SEEDS,
    TUNING_WORLDS,
    best_trials,
    trial_settings,
)
from robonav.networks import load_weights
from robonav.nirl import (
    ZERO_TERMINAL_VALUES,
    LeastSquaresReward,
    SingleGradientStep,
    accuracy,
    balanced_accuracy,
)
from robonav.nnql import NavigationTask, train
from robonav.robot import random_worlds

ALL = (*tables.EXPERIMENTS, *ablations.EXPERIMENTS, *transfer.EXPERIMENTS, TUNING)
SHORT = SHORTENED["quick"]


def test_every_method_has_as_many_trials():
    assert [case["method"] for case in TUNING.cases] == [
        m for m in METHODS for _ in range(len(DISCOUNTS) * TRIALS)
    ]
    for method in METHODS:
        for discount in DISCOUNTS:
            drawn = [trial_settings(method, trial, discount) for trial in range(TRIALS)]
            assert all(set(SPACE[method]) <= set(one) for one in drawn)
            assert len({json.dumps(one, sort_keys=True) for one in drawn}) == TRIALS


@pytest.mark.parametrize("method", METHODS[:4])
def test_trials_differ_from_one_discount_to_the_other_in_that_alone(method):
    for trial in range(TRIALS):
        one, other = (trial_settings(method, trial, discount) for discount in DISCOUNTS)
        assert one.pop("discount") != other.pop("discount")
        assert one == other


def test_cloning_draws_other_trials_instead():
    one, other = (
        [trial_settings("cloning", trial, d) for trial in range(TRIALS)]
        for d in DISCOUNTS
    )
    assert one != other


def test_worlds_to_show_to_tune_on_and_to_test_on_never_meet():
    assert max(experiment.seeds["thesis"] for experiment in ALL) < TUNING_SEEDS
    seeds = {
        "shown": [
            SHOWN_WORLDS + s
            for s in (*range(30), *range(TUNING_SEEDS, TUNING_SEEDS + 20))
        ],
        "tested": [TEST_WORLDS + s for s in range(30)],
        "tuned": [TUNING_WORLDS + s for s in range(20)],
        "chosen by": [ablations.CHOOSING_WORLDS + s for s in range(20)],
    }
    keys = {
        name: {tuple(k) for s in own for k in random_worlds(10, 20, seed=s).keys}
        for name, own in seeds.items()
    }
    assert len(set.union(*keys.values())) == sum(map(len, keys.values()))
    assert (
        demonstrations(0, 3).worlds.keys == random_worlds(3, 20, seed=SHOWN_WORLDS).keys
    ).all()
    assert (
        new_worlds("quick", 0).keys
        == random_worlds(NAVIGATIONS["quick"], 20, seed=TEST_WORLDS).keys
    ).all()


def test_what_was_chosen_is_the_best_of_the_published_trials():
    trials = load_results(RESULTS, TUNING)
    assert best_trials(trials) == CHOSEN
    cloning = [
        trials.summary("success", k).mean
        for k, case in enumerate(TUNING.cases)
        if case["method"] == "cloning"
    ]
    assert DISCOUNTS[int(np.argmax(cloning)) // TRIALS] == CLONING


def test_nirl_reaches_what_it_was_to_reach_and_beats_its_controls():
    table = load_results(RESULTS, tables.TABLE_5_2)
    found = {
        (case["method"], case["discount"]): table.summary("success", k)
        for k, case in enumerate(tables.COMPARED)
    }
    ours = found["nirl", 0.65]
    assert ours.mean > 90
    assert ours.worst > 80
    assert found["nirl", 0.9].mean > 95
    assert max(found[control, 0.65].high for control in CONTROLS) < ours.low
    assert found["freer side", "none"].high < ours.low
    without = load_results(RESULTS, tables.ENDINGS)
    neutral = {
        case["method"]: without.summary("success", k)
        for k, case in enumerate(tables.ENDINGS.cases)
    }
    assert (
        max(neutral[control].best for control in CONTROLS)
        < 25
        < 90
        < neutral["nirl"].worst
    )


def test_from_an_unsteady_hand_a_reward_beats_a_copy():
    """Run by run, from the same drives."""
    table = load_results(RESULTS, tables.TABLE_5_1)
    half = len(tables.TABLE_5_1.cases) // 2
    apart = {
        (case["expert"], case["demonstrations"]): table.values("success", k)
        - table.values("success", k + half)
        for k, case in enumerate(tables.TABLE_5_1.cases[:half])
    }
    human = np.array([runs for (expert, _), runs in apart.items() if expert == "human"])
    assert (human > 0).sum() == 39
    assert human.mean(axis=1).min() > 6


@pytest.mark.parametrize("control", CONTROLS)
def test_controls_practise_as_nirl_does_under_another_reward(control):
    found, ours = (
        learned(name, 0, settings(name), length=SHORT) for name in (control, "nirl")
    )
    assert (found.reward_weights == 0).all() == (control == "zero reward")
    assert settings(control) == settings("nirl")
    first, same = (run.history.networks.weights[0][0] for run in (found, ours))
    np.testing.assert_array_equal(first, same)


def test_two_runs_have_two_rewards_of_chance():
    one, other = (
        learned("random reward", seed, settings("nirl"), length=SHORT).reward_weights
        for seed in (0, 1)
    )
    assert (one != other).all()


def test_neutral_ends_are_told_from_a_bonus():
    assert settings("scirl", ends="neutral") == settings("scirl") | {"ends": "neutral"}
    assert "ends" not in settings("scirl")


def test_learning_twice_in_a_process_is_learning_once():
    first = learned("nirl", 0, settings("nirl"), length=SHORT)
    assert (
        learned("nirl", 0, json.loads(json.dumps(settings("nirl"))), length=SHORT)
        is first
    )
    assert learned("nirl", 1, settings("nirl"), length=SHORT) is not first


def test_steps_begin_with_the_algorithm_as_written_and_add_up():
    written = ablations.up_to("Algorithm 10 as written")
    assert isinstance(written["reward"], LeastSquaresReward)
    assert isinstance(written["improve"], SingleGradientStep)
    assert written["score"] is accuracy
    half = ablations.up_to("chosen by balanced accuracy")
    assert half["score"] is balanced_accuracy
    assert half["target"] == "number"
    assert half["improve"].ends == ZERO_TERMINAL_VALUES
    assert ablations.up_to("discount 0.9")["improve"].discount == 0.9


def test_choices_choose_what_they_say():
    found = learned("nirl", 0, settings("nirl"), length=SHORT)
    worlds = new_worlds("quick", 1)
    chosen = {name: choice(found, worlds) for name, choice in ablations.CHOICES.items()}
    assert (
        found.history.accuracies[chosen["accuracy"]] == found.history.accuracies.max()
    )
    assert chosen["balanced accuracy"] == found.chosen
    assert chosen["the last"] == len(found.history.costs)
    assert chosen["test drives"] % ablations.EVERY == 0
    last = ablations.member(found, chosen["the last"])
    np.testing.assert_array_equal(
        last.network.weights[1], found.history.networks.weights[1][-1]
    )


def test_a_reward_taken_elsewhere_needs_no_more_than_its_weights():
    found = learned("nirl", 0, settings("nirl"), length=SHORT)
    robot = transfer.under(found.reward_weights, 0, SHORT, 10, 1.0)
    assert robot.encoder == found.policy.encoder
    assert transfer.carried(0, SHORT, 10, 1.0) is found.policy
    same = transfer.by_reward(0, SHORT, 10, 1.0)
    np.testing.assert_array_equal(robot.network.weights[0], same.network.weights[0])


def test_robots_trained_together_are_those_trained_alone():
    """Under Table 4.1 seeds share their training, to be quicker."""
    settings_ = transfer.arguments(transfer.TABLE_SETTINGS)
    ground = NavigationTask(10, speed=1.0, starts=[(10, 10)], targets=[(90, 90)])
    alone = train(
        "nnql", [transfer.TOGETHER + 1], 14, task=ground, **settings_
    ).policies[0]
    together = transfer.by_table(transfer.TOGETHER + 1, 0.01, 10, 1.0)
    np.testing.assert_array_equal(together.network.weights[0], alone.network.weights[0])


def test_a_comparison_has_its_controls_beside_it():
    """No reward, one of chance, plain cloning: wherever what was learned is said to be good for something."""
    methods = {
        e.name: {case.get("method") for case in e.cases} for e in tables.EXPERIMENTS
    }
    assert {"zero reward", "random reward", "cloning"} <= methods["table-5.2"]
    assert {"zero reward", "random reward"} <= methods["nirl-controls"]
    assert all(
        "cloning" in methods[name]
        for name in ("table-5.1", "figure-5.10", "figure-5.12")
    )
    assert {
        "a cloned policy",
        "trained there under no reward",
        "trained there under a random reward",
    } <= set(transfer.TAKEN)


def test_ends_without_a_bonus_are_held_against_the_same_runs_with_one():
    """Seed by seed: demonstrations, first weights and maps are those of Table 5.2."""
    assert [case["method"] for case in tables.ENDINGS.cases] == [
        *tables.LEARNERS,
        *CONTROLS,
    ]
    table = [(case["method"], case["discount"]) for case in tables.COMPARED]
    assert all(
        (case["method"], case["discount"]) in table for case in tables.ENDINGS.cases
    )
    assert tables.ENDINGS.seeds["thesis"] <= tables.TABLE_5_2.seeds["thesis"]


def test_methods_refuse_names_they_do_not_know():
    with pytest.raises(KeyError):
        teach("magic", demonstrations(0), 0, settings("nirl"))


def test_a_shipped_network_is_the_best_of_its_seeds():
    weights = ship.best_of("nirl", (0, 1), length=SHORT)
    made = weights.made
    assert made["seeds"] == [0, 1]
    again = policy("nirl", made["seed"], settings("nirl", 0.9), length=SHORT)
    np.testing.assert_array_equal(weights.network.weights[0], again.network.weights[0])
    assert np.shape(made["reward weights"]) == (5, weights.encoder.size + 1)


@pytest.mark.parametrize("method", tables.LEARNERS)
def test_what_ships_says_what_made_it(method):
    weights = load_weights(ship.SHIPPED / f"{method.replace('_', '-')}.safetensors")
    assert weights.method == method
    assert weights.made["settings"] == json.loads(json.dumps(settings(method, 0.9)))
    assert weights.made["success in tuning worlds (%)"] > 90
