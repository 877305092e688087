"""Chapter 3's experiments: what they run, what ships, what was published."""

import numpy as np
import pytest

from robonav.benchmark import evaluate
from robonav.experiments.chapter3.setup import (
    DAGGER_SEED,
    DEMONSTRATION_SEED,
    INPUTS,
    SETUP,
    cloned_policy,
    demonstrations,
    policy_of,
    training,
)
from robonav.experiments.chapter3.tables import (
    EXPERIMENTS,
    FIGURE_3_5,
    FIGURE_3_8,
    OTHERS,
    TABLE_3_2,
    learned_policy,
    with_demonstrations,
)
from robonav.experiments.ship import SEED, folder_of, lfd_weights
from robonav.lfd import demonstrate, labelled_states, plan, plan_on_grid
from robonav.networks import fit, load_weights
from robonav.robot import navigate, random_worlds, straight


def test_worlds_shown_met_and_driven_never_meet():
    most = max(experiment.seeds["thesis"] for experiment in EXPERIMENTS)
    assert most <= OTHERS
    assert most + OTHERS <= DAGGER_SEED - DEMONSTRATION_SEED
    assert 10 * most <= SETUP.test_seed - DAGGER_SEED


def test_more_demonstrations_begin_with_the_same_ones():
    few, more = demonstrations(3, number=5), demonstrations(3, number=8)
    assert np.array_equal(more.select_trajectories(np.arange(5)).actions, few.actions)
    assert few.worlds.digest() == random_worlds(5, seed=DEMONSTRATION_SEED + 3).digest()


def test_the_shortest_way_goes_nearer():
    near, far = (
        demonstrations(0, number=8, expert="shortest path"),
        demonstrations(0, number=8),
    )
    assert near.sensing.ranges.min() < far.sensing.ranges.min() - 0.5
    assert len(near) < len(far)
    again = demonstrate(far.worlds, reflex=SETUP.reflex)
    assert np.array_equal(far.actions, again.actions)


def test_degrees_from_0_to_7_are_folded_into_the_weights():
    """The policy's network answers to the encoder's inputs what the trained one answered to seven times as much."""
    trained = training(0, "keeps clear", "0 to 7", number=5, iterations=20)
    policy = policy_of(trained.network, "0 to 7")
    x, y = labelled_states(demonstrations(0, number=5), policy.encoder)
    assert policy.network.forward(x) == pytest.approx(
        trained.network.forward(x * np.array([7] * 9 + [9, 1]))
    )
    assert (
        trained.costs[-1]
        == fit(x * INPUTS["0 to 7"], y, iterations=20, seed=0).costs[-1]
    )
    plain = training(0, "keeps clear", "0 to 1", number=5, iterations=20)
    assert plain.costs[-1] == fit(x, y, iterations=20, seed=0).costs[-1]


def test_fewer_iterations_are_the_same_training_cut_short():
    few, more = (
        training(1, "keeps clear", "0 to 1", number=5, iterations=n) for n in (10, 15)
    )
    assert np.array_equal(few.network.weights[0], more.networks[10].weights[0])


def test_success_is_what_navigate_gives():
    case = TABLE_3_2.cases[0]
    numbers = with_demonstrations(case, 1, "quick")
    worlds = random_worlds(SETUP.navigations["quick"], seed=SETUP.test_seed + 1)
    assert SETUP.test_worlds(1, "quick").digest() == worlds.digest()
    again = SETUP.evaluate(learned_policy("straight", 1), worlds)
    assert (
        again["success"]
        == 100 * navigate(straight, worlds, reflex=SETUP.reflex).success.mean()
    )
    assert numbers["success"] > again["success"] + 30
    assert sum(again.values()) == pytest.approx(100)


def test_plans_are_counted_up_to_the_target():
    numbers = FIGURE_3_5.run(FIGURE_3_5.cases[0], 0, "quick")
    worlds = random_worlds(20, 10, seed=SETUP.test_seed)
    made = [
        (plan(world, margin=2.0), plan_on_grid(world, margin=2.0)) for world in worlds
    ]
    ours, grid = (
        [p.length + np.linalg.norm(p.points[-1] - (90, 90)) for p in plans]
        for plans in zip(*made, strict=True)
    )
    assert numbers["length, modified A*"] == pytest.approx(np.mean(ours))
    assert numbers["length, grid A*"] == pytest.approx(np.mean(grid))
    assert numbers["modified A* shorter"] == 100 * np.mean(
        np.subtract(grid, ours) > 1e-6
    )


def test_methods_by_name():
    names = {case["method"] for case in FIGURE_3_8.cases}
    assert {"straight", "lfd", "dagger"} <= names
    assert learned_policy("5-neighbours", 0).k == 5


@pytest.mark.slow
def test_what_ships_is_what_the_command_makes():
    policy = cloned_policy(SEED)
    kept = load_weights(folder_of("lfd") / "lfd.safetensors")
    sensing = demonstrate(random_worlds(5, 10, seed=1)).effective.sensing
    rng = np.random.default_rng(0)
    assert (
        method_of(kept)(sensing, rng) == policy(sensing, rng)
    ).mean() > 0.98  # other machines, other last bits
    assert kept.made == lfd_weights()["lfd"].made
    dagger = load_weights(folder_of("lfd") / "dagger.safetensors")
    assert (dagger.method, dagger.temperature, dagger.made["rounds"]) == (
        "dagger",
        0.4,
        3,
    )
    assert all(path.stat().st_size < 4000 for path in folder_of("lfd").iterdir())


def method_of(weights):
    from robonav.networks import NetworkPolicy

    return NetworkPolicy(weights.network, weights.encoder, weights.temperature)


@pytest.mark.parametrize(
    ("name", "obstacles", "least"),
    [("lfd", 10, 0.95), ("dagger", 10, 0.98), ("dagger", 20, 0.95)],
)
def test_what_ships_drives(name, obstacles, least):
    result = evaluate(
        name, obstacles=obstacles, moving=0, speed=2.0, worlds=300, seed=77
    )
    assert result["success"] >= least
