"""The methods of Table 5.2 on the robot: what is kept of an episode, errors, and that they run and repeat."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest

from robonav.lfd.computer_expert import demonstrate
from robonav.lfd.demonstrations import LEARNED
from robonav.nirl import (
    ENCODER,
    METHODS,
    NEUTRAL_TERMINAL_VALUES,
    FullBatchDescent,
    LeastSquaresReward,
    ReplaySGD,
    RobotTask,
    TabularTask,
    accuracy,
    apprenticeship,
    expert_decisions,
    from_all_states,
    from_initial_state,
    heuristic_estimate,
    learn,
    learn_under_reward,
    lstd_estimate,
    max_margin_guess,
    most_frequent,
    random_segments,
    segment_features,
    state_action_features,
)
from robonav.nirl.learning import robot_decisions
from robonav.nirl.tasks import collect
from robonav.robot import Reflex, Simulator, navigate, random_worlds

SMALL = {"improver": ReplaySGD(n_samples=500), "iterations": 3}
TASK = RobotTask(n_episodes=3, obstacles=10)


@pytest.fixture(scope="module")
def demonstrations():
    return demonstrate(random_worlds(4, 20, seed=5))


def always(action):
    return lambda inputs: np.eye(LEARNED)[np.full(len(inputs), action)]


@pytest.mark.parametrize("action", [0, 1])
def test_a_training_episode_is_an_episode_of_navigate(action):
    """The same policy ends in the same way in training and in ``navigate``."""
    worlds = random_worlds(40, 20, seed=3)
    driven = navigate(
        lambda sensing, rng: np.full(len(sensing), action), worlds, max_steps=200
    )
    steps = collect(
        Simulator(worlds, 2.0, max_steps=200),
        always(action),
        ENCODER,
        np.random.default_rng(0),
    )
    np.testing.assert_array_equal(steps.collided, driven.collision)
    np.testing.assert_array_equal(steps.arrived, driven.success)
    assert (steps.actions == action).all()
    assert (np.diff(steps.trajectory) >= 0).all()
    same = np.diff(steps.trajectory) == 0
    assert (np.diff(steps.times)[same] > 0).all()
    np.testing.assert_array_less(steps.times, driven.steps[steps.trajectory])


def test_experts_and_learners_are_recorded_in_the_same_way(demonstrations):
    """An expert's decisions are its effective pairs, with the seconds at which they were made."""
    decisions = expert_decisions(demonstrations)
    pairs = demonstrations.effective
    np.testing.assert_array_equal(decisions.actions, pairs.actions)
    np.testing.assert_array_equal(decisions.inputs, ENCODER(pairs.sensing))
    first = np.searchsorted(demonstrations.trajectory, decisions.trajectory)
    np.testing.assert_array_equal(
        demonstrations.poses[first + decisions.times], pairs.poses
    )
    assert decisions.arrived.all()


def test_segments_stop_after_their_horizon(demonstrations):
    decisions = expert_decisions(demonstrations)
    found = segment_features(decisions, LEARNED, 0.65, 3)
    block = state_action_features(decisions.features, decisions.actions, LEARNED)
    for t in range(len(decisions) - 3):
        inside = [
            block[t + k] * 0.65**k
            for k in range(3)
            if decisions.trajectory[t + k] == decisions.trajectory[t]
        ]
        np.testing.assert_allclose(found[t], sum(inside), atol=1e-9)


def test_random_segments_begin_where_the_expert_decided(demonstrations):
    rng = np.random.default_rng(0)
    steps = random_segments(expert_decisions(demonstrations), RobotTask(), 50, 4, rng)
    assert (np.bincount(steps.trajectory) <= 4).all()
    begun = steps.inputs[np.flatnonzero(np.diff(steps.trajectory, prepend=-1))]
    known = {tuple(row) for row in expert_decisions(demonstrations).inputs.round(9)}
    assert all(tuple(row) in known for row in begun.round(9))


@pytest.mark.parametrize("estimate", [lstd_estimate, heuristic_estimate])
def test_expectations_of_the_experts_actions_are_known(demonstrations, estimate):
    decisions = expert_decisions(demonstrations)
    mu = estimate(decisions, LEARNED, 0.65)
    assert mu.shape == (len(decisions), LEARNED, LEARNED * (ENCODER.size + 1))
    assert np.isfinite(mu).all()


def test_two_kinds_of_expectations(demonstrations):
    decisions = expert_decisions(demonstrations)
    start, everywhere = (
        f(decisions, LEARNED, 0.65) for f in (from_initial_state, from_all_states)
    )
    constants = (np.arange(1, LEARNED + 1) * (ENCODER.size + 1)) - 1
    assert start[constants].sum() == pytest.approx(
        1 / 0.35, rel=1e-3
    )  # a constant feature adds up to 1 / (1 - gamma)
    assert everywhere[constants].sum() < 1 / 0.35


@pytest.mark.parametrize("method", METHODS)
def test_every_method_learns_and_repeats(demonstrations, method):
    settings = dict(SMALL, task=TASK) | (
        {"n_rewards": 3} if method == "apprenticeship" else {}
    )
    one, same = (learn(demonstrations, method, seed=1, **settings) for _ in range(2))
    assert one.reward_weights.shape == (LEARNED, ENCODER.size + 1)
    np.testing.assert_array_equal(
        one.policy.network.weights[0], same.policy.network.weights[0]
    )
    np.testing.assert_array_equal(one.reward_weights, same.reward_weights)
    assert len(one.history.costs) == 3
    assert np.isfinite(one.history.costs).all()
    assert navigate(
        one.policy, random_worlds(3, 10, seed=0), max_steps=20
    ).outcome.shape == (3,)


@pytest.mark.parametrize(("n_rewards", "guessed"), [(3, 3), (7, 7), (9, 7)])
def test_rewards_share_all_iterations(terrain, n_rewards, guessed):
    """Also where their numbers do not divide, and where there are more rewards than iterations."""
    task = TabularTask(terrain.task)
    shown, done = task.demonstrate(terrain.expert, 5, seed=1), []
    found = apprenticeship(
        shown,
        task,
        n_rewards=n_rewards,
        iterations=7,
        progress=lambda *n: done.append(n),
    )
    assert done == [(k, 7) for k in range(1, 8)]
    assert len(np.unique(found.history.weights, axis=0)) == guessed


@pytest.mark.parametrize("method", METHODS)
def test_one_trajectory_is_enough(demonstrations, method):
    settings = dict(SMALL, task=TASK) | (
        {"n_rewards": 3} if method == "apprenticeship" else {}
    )
    learned = learn(
        demonstrations[demonstrations.trajectory == 0], method, seed=0, **settings
    )
    assert np.isfinite(learned.reward_weights).all()


def test_algorithm_10_to_the_letter_runs(demonstrations):
    to_the_letter = {
        "reward_update": LeastSquaresReward(),
        "improver": FullBatchDescent(),
        "score": accuracy,
    }
    learned = learn(demonstrations, seed=0, task=TASK, iterations=3, **to_the_letter)
    assert (
        learned.history.accuracies[learned.chosen] == learned.history.accuracies.max()
    )
    assert np.isfinite(learned.history.costs).all()


@pytest.mark.parametrize("expectations", [from_initial_state, from_all_states])
def test_an_apprentice_by_the_widest_margin(demonstrations, expectations):
    learned = learn(
        demonstrations, "apprenticeship", seed=0, task=TASK, guess=max_margin_guess, n_rewards=2,
        expectations=expectations, **(SMALL | {"iterations": 4}),
    )  # fmt: skip
    assert len(learned.history.costs) == 4
    first, second, third, fourth = learned.history.weights
    np.testing.assert_array_equal(first, second)
    np.testing.assert_array_equal(third, fourth)
    assert (first != third).any()


@pytest.mark.parametrize("method", METHODS)
def test_an_action_never_shown(demonstrations, method):
    lefts = demonstrations[~np.isin(demonstrations.actions, [3, 4])]
    settings = dict(SMALL, task=TASK) | (
        {"n_rewards": 3} if method == "apprenticeship" else {}
    )
    learned = learn(lefts, method, seed=0, **settings)
    assert np.isfinite(learned.reward_weights).all()
    assert np.isfinite(learned.history.balanced).all()


@pytest.mark.parametrize("method", METHODS)
def test_nothing_to_learn_from_gets_a_sentence(demonstrations, method):
    nothing = demonstrations[:0]
    with pytest.raises(
        ValueError, match=r"must hold an effective pair.*got none in 0 steps"
    ):
        learn(nothing, method, seed=0)
    safe = demonstrations[demonstrations.sensing.safe]
    with pytest.raises(
        ValueError, match=rf"must hold an effective pair.*got none in {len(safe)} steps"
    ):
        learn(safe, method, seed=0)


def test_arguments_of_another_type(demonstrations):
    expert, task = expert_decisions(demonstrations), RobotTask()
    for call, sentence in (
        (lambda: learn([1]), "demonstrations must be Demonstrations, got list"),
        (lambda: learn(demonstrations, task=4), "task must be RobotTask, got int"),
        (
            lambda: learn_under_reward([1], np.zeros((5, 18))),
            "demonstrations must be Demonstrations, got list",
        ),
    ):
        with pytest.raises(TypeError, match=sentence):
            call()
    for method in METHODS.values():
        for arguments, sentence in (
            ((demonstrations, task), "demonstrations must be Decisions, got Demonst"),
            ((expert, gymnasium.make("CartPole-v1")), "task must be a task such as"),
            ((expert, RobotTask), "task must be a task such as"),
        ):
            with pytest.raises(TypeError, match=sentence):
                method(*arguments)
        with pytest.raises(TypeError, match="improver must have a method improve"):
            method(expert, task, improver=3)
        if method in (METHODS["nirl"], METHODS["apprenticeship"]):
            with pytest.raises(TypeError, match="score must be callable, got str"):
                method(expert, task, score="accuracy", iterations=1)


def test_another_method_gets_a_sentence(demonstrations):
    with pytest.raises(
        ValueError,
        match="method must be one of nirl, apprenticeship, relative-entropy, scirl",
    ):
        learn(demonstrations, "magic")


def test_refinement_makes_demonstrations_consistent(demonstrations):
    """The same sensing with two actions: the rarer one goes."""
    pairs = demonstrations.effective
    thrice = np.repeat(np.arange(5), 3)
    actions = np.where(
        np.arange(15) % 3 == 0, (pairs.actions[thrice] + 1) % 5, pairs.actions[thrice]
    )
    doubled = replace(
        pairs[np.zeros(0, int)],
        trajectory=np.zeros(15, int),
        sensing=pairs.sensing[thrice],
        actions=actions,
        poses=pairs.poses[thrice],
    )
    refined = robot_decisions(doubled, RobotTask(), most_frequent)
    states, counts = np.unique(refined.inputs, axis=0, return_counts=True)
    for state in states:
        assert len(set(refined.actions[(refined.inputs == state).all(axis=1)])) == 1
    assert counts.sum() == 15


def test_a_reward_can_be_taken_elsewhere(demonstrations):
    theta = np.zeros((LEARNED, ENCODER.size + 1))
    learned = learn_under_reward(
        demonstrations, theta, task=replace(TASK, speed=1.0), seed=0, iterations=2
    )
    assert (learned.reward_weights == 0).all()
    neutral = ReplaySGD(terminal_values=NEUTRAL_TERMINAL_VALUES, n_samples=2000)
    idle = learn_under_reward(
        demonstrations, theta, task=TASK, seed=0, iterations=2, improver=neutral
    )
    outputs = idle.history.networks[-1].forward(expert_decisions(demonstrations).inputs)
    assert abs(outputs - 0.5).mean() < 0.1


def test_episodes_of_a_task_have_its_reflex():
    rolled = {
        direction: RobotTask(3, reflex=Reflex(direction)).rollout(
            lambda inputs: np.full((len(inputs), 5), 0.2), np.random.default_rng(0)
        )
        for direction in ("exact", "sector")
    }
    none = RobotTask(3, reflex=None).rollout(
        lambda inputs: np.full((len(inputs), 5), 0.2), np.random.default_rng(0)
    )
    assert len(rolled["exact"].times) != len(rolled["sector"].times)
    np.testing.assert_array_equal(none.times[:10], np.arange(10))  # asked every second
