"""Chapter 5's experiments: what they run, what was chosen, what was published."""

import json
from pathlib import Path

import numpy as np
import pytest

from robonav.experiments.chapter5 import ablations, tables, transfer
from robonav.experiments.chapter5.setup import (
    CONTROLS,
    DEFAULTS,
    DEMONSTRATION_SEED,
    DISCOUNT,
    HYPERPARAMETERS,
    LEARNERS,
    METHODS,
    SETUP,
    SHORTENED,
    demonstrations,
    train_irl,
    trained,
    trained_policy,
    tuned,
)
from robonav.experiments.chapter5.tuning import (
    DISCOUNTS,
    SPACE,
    TRIALS,
    TUNING,
    TUNING_SEEDS,
    trial_settings,
    write_tuned,
)
from robonav.experiments.runner.settings import Settings
from robonav.experiments.ship import folder_of, nirl_weights
from robonav.networks import load_weights
from robonav.nirl import (
    ZERO_TERMINAL_VALUES,
    FullBatchDescent,
    LeastSquaresReward,
    RobotTask,
    accuracy,
    balanced_accuracy,
    learn,
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
            assert len({one.as_json() for one in drawn}) == TRIALS


@pytest.mark.parametrize("method", METHODS[:4])
def test_trials_differ_from_one_discount_to_the_other_in_that_alone(method):
    for trial in range(TRIALS):
        one, other = (
            dict(trial_settings(method, trial, discount)) for discount in DISCOUNTS
        )
        assert one.pop("discount") != other.pop("discount")
        assert one == other


def test_cloning_draws_other_trials_instead():
    one, other = (
        [trial_settings("lfd", trial, d) for trial in range(TRIALS)] for d in DISCOUNTS
    )
    assert one != other


def test_worlds_to_show_to_tune_on_and_to_test_on_never_meet():
    assert max(experiment.seeds["thesis"] for experiment in ALL) < TUNING_SEEDS
    seeds = {
        "demonstrated": [
            DEMONSTRATION_SEED + s
            for s in (*range(30), *range(TUNING_SEEDS, TUNING_SEEDS + 20))
        ],
        "tested": [SETUP.test_seed + s for s in range(30)],
        "tuned": [SETUP.tuning_seed + s for s in range(20)],
        "chosen by": [ablations.CHOOSING_SEED + s for s in range(20)],
    }
    keys = {
        name: {tuple(k) for s in own for k in random_worlds(10, 20, seed=s).keys}
        for name, own in seeds.items()
    }
    assert len(set.union(*keys.values())) == sum(map(len, keys.values()))
    assert (
        demonstrations(0, 3).worlds.keys
        == random_worlds(3, 20, seed=DEMONSTRATION_SEED).keys
    ).all()
    assert (
        SETUP.test_worlds(0, "quick").keys
        == random_worlds(SETUP.navigations["quick"], 20, seed=SETUP.test_seed).keys
    ).all()


@pytest.mark.slow
@pytest.mark.parametrize("control", CONTROLS)
def test_controls_practise_as_nirl_does_under_another_reward(control):
    found, ours = (
        trained(name, 0, tuned(name), length=SHORT) for name in (control, "nirl")
    )
    assert (found.reward_weights == 0).all() == (control == "zero-reward")
    assert tuned(control) == tuned("nirl")
    first, same = (run.history.networks.weights[0][0] for run in (found, ours))
    np.testing.assert_array_equal(first, same)


@pytest.mark.slow
def test_two_runs_have_two_rewards_of_chance():
    one, other = (
        trained("random-reward", seed, tuned("nirl"), length=SHORT).reward_weights
        for seed in (0, 1)
    )
    assert (one != other).all()


def test_neutral_ends_are_told_from_a_bonus():
    neutral = tuned("scirl", terminal_values="neutral")
    assert neutral == tuned("scirl") | {"terminal_values": "neutral"}
    assert "terminal_values" not in tuned("scirl")


@pytest.mark.slow
def test_learning_twice_in_a_process_is_learning_once():
    first = trained("nirl", 0, tuned("nirl"), length=SHORT)
    same = Settings.of(json.loads(tuned("nirl").as_json()))
    assert trained("nirl", 0, same, length=SHORT) is first
    assert trained("nirl", 1, tuned("nirl"), length=SHORT) is not first


def test_steps_begin_with_one_gradient_step_and_add_up():
    written = ablations.options_up_to("Algorithm 10, one gradient step an iteration")
    assert isinstance(written["reward_update"], LeastSquaresReward)
    assert isinstance(written["improver"], FullBatchDescent)
    assert written["score"] is accuracy
    half = ablations.options_up_to("policy chosen by balanced accuracy")
    assert half["score"] is balanced_accuracy
    assert half["target"] == "number"
    assert half["improver"].terminal_values == ZERO_TERMINAL_VALUES
    assert ablations.options_up_to("discount 0.9")["improver"].discount == 0.9


@pytest.mark.slow
def test_the_defaults_are_those_of_the_method():
    """Figs. 5.7, 5.8 and 5.11: what the page on NIRL runs, ``nirl.learn`` without options but for the reflex."""
    settings = DEFAULTS | {"discount": DISCOUNT}
    ours = train_irl("nirl", demonstrations(0), 3, settings, length=SHORT)
    iterations, task = len(ours.history.costs), RobotTask(reflex=SETUP.reflex)
    plain = learn(demonstrations(0), seed=3, task=task, iterations=iterations)
    np.testing.assert_array_equal(ours.history.costs, plain.history.costs)


@pytest.mark.parametrize("method", ablations.REWARDS)
def test_one_gradient_step_is_one_reading(method):
    """With one step the settings are those of the first two rows of ``nirl-steps``."""
    options = ablations.options_up_to(
        "Algorithm 10, one gradient step an iteration"
        if "5.14" in method
        else "reward: feature gaps in the expert's states"
    )
    assert options["reward_update"] == ablations.REWARDS[method]
    assert options["improver"] == FullBatchDescent(1)


@pytest.mark.slow
def test_choices_choose_what_they_say():
    found = trained("nirl", 0, tuned("nirl"), length=SHORT)
    worlds = SETUP.test_worlds(1, "quick")
    chosen = {name: choice(found, worlds) for name, choice in ablations.CHOICES.items()}
    assert (
        found.history.accuracies[chosen["accuracy"]] == found.history.accuracies.max()
    )
    assert chosen["balanced accuracy"] == found.chosen
    assert chosen["the last"] == len(found.history.costs)
    assert chosen["navigation"] % ablations.EVERY == 0
    last = ablations.policy_at(found, chosen["the last"])
    np.testing.assert_array_equal(
        last.network.weights[1], found.history.networks.weights[1][-1]
    )


@pytest.mark.slow
def test_a_reward_taken_elsewhere_needs_no_more_than_its_weights():
    found = trained("nirl", 0, tuned("nirl"), length=SHORT)
    robot = transfer.train_under_reward(found.reward_weights, 0, SHORT, 10, 1.0)
    assert robot.encoder == found.policy.encoder
    assert transfer.same_policy(0, SHORT, 10, 1.0, method="nirl") is found.policy
    same = transfer.learned_reward(0, SHORT, 10, 1.0)
    np.testing.assert_array_equal(robot.network.weights[0], same.network.weights[0])


@pytest.mark.slow
def test_robots_trained_together_are_those_trained_alone():
    """Under Table 4.1 seeds share their training, to be quicker."""
    settings_ = dict(transfer.NNQL)
    ground = NavigationTask(
        10, speed=1.0, starts=[(10, 10)], targets=[(90, 90)], reflex=SETUP.reflex
    )
    alone = train(
        "nnql", [transfer.SEEDS_PER_BATCH + 1], 14, task=ground, **settings_
    ).policies[0]
    together = transfer.reward_table(transfer.SEEDS_PER_BATCH + 1, 0.01, 10, 1.0)
    np.testing.assert_array_equal(together.network.weights[0], alone.network.weights[0])


def test_a_comparison_has_its_controls_beside_it():
    """Zero and random rewards and cloning stand beside every learned reward that is said to help."""
    methods = {
        e.name: {case.get("method") for case in e.cases} for e in tables.EXPERIMENTS
    }
    assert {"zero-reward", "random-reward", "lfd"} <= methods["table-5.2"]
    assert {"zero-reward", "random-reward"} <= methods["nirl-controls"]
    assert all(
        "lfd" in methods[name] for name in ("table-5.1", "figure-5.10", "figure-5.12")
    )
    assert {
        "kept-clone",
        "zero-reward-there",
        "random-reward-there",
    } <= set(transfer.POLICIES)


def test_ends_without_a_bonus_are_held_against_the_same_runs_with_one():
    """Seed by seed: demonstrations, first weights and maps are those of Table 5.2."""
    assert [case["method"] for case in tables.WITHOUT_BONUS.cases] == [
        *LEARNERS,
        *CONTROLS,
    ]
    table = [(case["method"], case["discount"]) for case in tables.COMPARED]
    assert all(
        (case["method"], case["discount"]) in table
        for case in tables.WITHOUT_BONUS.cases
    )
    assert tables.WITHOUT_BONUS.seeds["thesis"] <= tables.TABLE_5_2.seeds["thesis"]


def test_methods_refuse_names_they_do_not_know():
    with pytest.raises(KeyError):
        train_irl("magic", demonstrations(0), 0, tuned("nirl"))


@pytest.mark.slow
def test_a_shipped_network_is_the_best_of_its_seeds():
    weights = nirl_weights("nirl", (0, 1), length=SHORT)
    made = weights.made
    assert made["seeds"] == [0, 1]
    again = trained_policy("nirl", made["seed"], tuned("nirl", 0.9), length=SHORT)
    np.testing.assert_array_equal(weights.network.weights[0], again.network.weights[0])
    assert np.shape(made["reward weights"]) == (5, weights.encoder.size + 1)


@pytest.mark.parametrize("method", LEARNERS)
def test_what_ships_says_what_made_it(method):
    weights = load_weights(folder_of("nirl") / f"{method}.safetensors")
    assert weights.method == method
    assert weights.made["settings"] == json.loads(tuned(method, 0.9).as_json())
    assert weights.made["success in tuning worlds (%)"] > 90


def test_the_tuning_writes_the_hyperparameters(tmp_path):
    """From the published trials, byte for byte what the tables read."""
    write_tuned(path=tmp_path / "hyperparameters.toml")
    assert (
        tmp_path / "hyperparameters.toml"
    ).read_bytes() == HYPERPARAMETERS.read_bytes()


def test_the_page_says_how_the_tuned_settings_differ_from_its_own():
    page = Path(__file__).parents[3] / "book/nirl-in-practice.md"
    chosen = tuned("nirl")
    differ = {key for key in DEFAULTS if DEFAULTS[key] != chosen[key]}
    assert differ == {"hidden", "replay", "gradient_step", "target"}
    said = (
        f"{chosen['hidden']} hidden units in place of {DEFAULTS['hidden']}, the decisions of the last "
        f"{chosen['replay']} iterations in place of {DEFAULTS['replay']}, a gradient step $\\sigma$ that stays at "
        f"{chosen['gradient_step'][1]}, and the target's sector as one {chosen['target']} number"
    )
    assert said in page.read_text("utf-8")
