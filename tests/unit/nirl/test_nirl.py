"""Neural policy iteration and NIRL: targets, gradients, choice, gridworlds (sections 5.5.3 and 5.5.4, Algorithm 10)."""

import inspect

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robonav.networks.multilayer_perceptron import (
    Network,
    cross_entropy_cost,
    random_network,
)
from robonav.nirl import (
    METHODS,
    NEUTRAL_TERMINAL_VALUES,
    ZERO_TERMINAL_VALUES,
    Decisions,
    FullBatchDescent,
    LeastSquaresReward,
    ReplaySGD,
    SubgradientMaxMargin,
    TabularTask,
    _fast,
    accuracy,
    all_action_features,
    balanced_accuracy,
    decision_rewards,
    discounted_feature_sums,
    feature_gap,
    greedy_actions,
    inverse_frequency_weights,
    maximum_margin,
    neural_action_values,
    nirl,
    policy_cost,
    sarsa_descent,
    sarsa_targets,
    scale_to_unit_interval,
    train_under_reward,
)
from robonav.nirl.policy_improvement import compiled_sarsa_descent
from robonav.nirl.reward_update import least_squares_objective

RNG = np.random.default_rng(0)


def made_up(decisions=12, inputs=3, actions=4, trajectories=3, seed=0):
    """Decisions with random contents."""
    rng = np.random.default_rng(seed)
    trajectory = np.sort(rng.integers(trajectories, size=decisions))
    return Decisions(
        rng.normal(size=(decisions, inputs)),
        rng.integers(actions, size=decisions),
        trajectory,
        np.arange(decisions),
        np.arange(trajectories) % 2 == 1,
        np.arange(trajectories) % 2 == 0,
    )


# -- rewards and targets -----------------------------------------------------------------------------------------------


def test_rewards_are_theta_times_the_blocks():
    steps, theta = made_up(), RNG.normal(size=(4, 4))
    blocks = all_action_features(steps.features, 4)[np.arange(12), steps.actions]
    np.testing.assert_allclose(decision_rewards(theta, steps), blocks @ theta.ravel())


def test_sarsa_by_hand():
    """0.5 + 0.8 (1 + 0.65 * 0.4 - 0.5)."""
    np.testing.assert_allclose(
        sarsa_targets([0.5], [1.0], [0.4], learning_rate=0.8, discount=0.65), [1.108]
    )


@pytest.mark.parametrize(
    ("arguments", "learning_rate", "sentence"),
    [
        (([0.5], [1.0, 2.0], [0.4]), 0.8, r"rewards must have the shape \(1,\) of q, got \(2,\)"),
        (([0.5], [np.nan], [0.4]), 0.8, "rewards must hold finite numbers only"),
        (([0.5], ["high"], [0.4]), 0.8, "rewards must be an array of numbers, got list"),
        (([0.5], [1.0], [0.4]), 2, "learning_rate must be at least 0 and at most 1, got 2"),
    ],
)  # fmt: skip
def test_wrong_arguments_of_sarsa_get_a_sentence(arguments, learning_rate, sentence):
    with pytest.raises((ValueError, TypeError), match=sentence):
        sarsa_targets(*arguments, learning_rate=learning_rate, discount=0.65)


@settings(deadline=None)
@given(
    arrays(float, 20, elements=st.floats(-9, 9).map(lambda x: round(x, 3))),
    st.floats(0.1, 50),
)
def test_scaled_rewards_lie_in_the_unit_interval_whatever_their_unit(rewards, unit):
    scaled = scale_to_unit_interval(rewards)
    assert scaled.min() >= 0
    assert scaled.max() <= 1
    np.testing.assert_allclose(
        scale_to_unit_interval(unit * rewards), scaled, atol=1e-9
    )
    np.testing.assert_allclose(scale_to_unit_interval(-rewards), 1 - scaled, atol=1e-9)
    assert (np.diff(scaled[np.argsort(rewards)]) >= 0).all()


def test_no_reward_is_neither_good_nor_bad():
    assert scale_to_unit_interval(np.zeros(3)).tolist() == [0.5, 0.5, 0.5]


def test_after_is_the_next_decision_of_the_same_episode():
    steps = Decisions(
        np.zeros((4, 1)),
        np.zeros(4, int),
        np.array([0, 0, 2, 2]),
        np.arange(4),
        *np.zeros((2, 3), bool),
    )
    assert steps.next_index.tolist() == [1, -1, 3, -1]


# -- the compiled descent ----------------------------------------------------------------------------------------------


def cross_entropy(network, x, action, target):
    q = network.forward(x)[action]
    return -(target * np.log(q) + (1 - target) * np.log(1 - q))


def moved(network, part, index, by):
    """The network with one number changed."""
    arrays_ = {
        "weights": [w.copy() for w in network.weights],
        "biases": [b.copy() for b in network.biases],
    }
    arrays_[part[0]][part[1]][index] += by
    return Network(tuple(arrays_["weights"]), tuple(arrays_["biases"]))


@pytest.mark.parametrize("follows", [True, False])
def test_one_step_is_minus_rate_times_the_numerical_gradient(follows):
    network = random_network((3, 5, 4), seed=1)
    x = np.array([[0.3, 0.0, -1.2], [0.7, 0.1, 0.4]])
    actions, rewards, ends = (
        np.array([2, 1]),
        np.array([0.2, 0.0]),
        np.array([0.9, 0.9]),
    )
    after = np.array([1, -1]) if follows else np.array([-1, -1])
    q, following = (
        network.forward(x[0])[2],
        network.forward(x[1])[1] if follows else 0.9,
    )
    target = q + 0.8 * (0.2 + 0.65 * following - q)
    w1, w2 = (np.ascontiguousarray(w.T) for w in network.weights)
    b1, b2 = (b.copy() for b in network.biases)
    cost = _fast.sarsa_descent(
        w1, b1, w2, b2, x, actions, rewards, after, ends, np.array([0]), 0.8, 0.65, 1e-4
    )
    assert cost == pytest.approx(cross_entropy(network, x[0], 2, target))
    after_step = {
        ("weights", 0): w1.T,
        ("biases", 0): b1,
        ("weights", 1): w2.T,
        ("biases", 1): b2,
    }
    for part, reached in after_step.items():
        before = getattr(network, part[0])[part[1]]
        for index in np.ndindex(before.shape):
            up, down = (
                cross_entropy(moved(network, part, index, e), x[0], 2, target)
                for e in (1e-6, -1e-6)
            )
            slope = (up - down) / 2e-6
            assert (reached - before)[index] == pytest.approx(-1e-4 * slope, abs=1e-9)


def test_it_finds_the_values_of_a_chain():
    """Three decisions in a row with rewards 1, 0, 1 (in [0, 1]) and then the best forever: y = (1 - gamma) Q."""
    inputs = np.eye(3)
    steps = Decisions(
        inputs,
        np.zeros(3, int),
        np.zeros(3, int),
        np.arange(3),
        np.array([False]),
        np.array([True]),
    )
    theta = np.array([[1.0, -1.0, 1.0, 0.0]])
    improve = ReplaySGD(
        discount=0.5, learning_rate=1.0, gradient_step=(2.0, 2.0), n_samples=20_000
    )
    rewards = decision_rewards(theta, steps)
    network = improve.improve(
        random_network((3, 6, 1), seed=0), steps, rewards, 0.0, np.random.default_rng(0)
    ).network
    third = 0.5 * 1 + 0.5 * 1
    second = 0.5 * 0 + 0.5 * third
    first = 0.5 * 1 + 0.5 * second
    np.testing.assert_allclose(
        network.forward(inputs)[:, 0], [first, second, third], atol=0.02
    )


@pytest.mark.parametrize(
    "improver", [ReplaySGD(replay=1, n_samples=50), ReplaySGD(replay=2, n_samples=50), FullBatchDescent()]
)  # fmt: skip
def test_network_trains_on_the_decisions_of_the_last_iterations(terrain, improver):
    seen = []

    class Watched:
        replay = improver.replay

        def improve(self, network, decisions, *rest):
            seen.append(decisions)
            return improver.improve(network, decisions, *rest)

    task = TabularTask(terrain.task)
    demonstrations = task.demonstrate(terrain.expert, 5, seed=1)
    found = nirl(demonstrations, task, iterations=3, improver=Watched(), seed=0)
    made = found.history.decisions
    expected = [sum(made[max(k - improver.replay, 0) : k]) for k in (1, 2, 3)]
    assert [len(decisions) for decisions in seen] == expected


def test_the_step_to_the_letter_is_a_gradient_step():
    """With targets (5.16), cut to [0, 1], for the taken action, and no change asked of the others."""
    steps, theta = made_up(), RNG.normal(size=(4, 4))
    network = random_network((3, 5, 4), seed=1)
    improver = FullBatchDescent(gradient_step=0.1)
    rewards = decision_rewards(theta, steps)
    stepped, cost = improver.improve(network, steps, rewards, 0.0, RNG)
    again, lower = improver.improve(stepped, steps, rewards, 0.0, RNG)
    assert lower < cost
    outputs = network.forward(steps.inputs)
    q = outputs[np.arange(12), steps.actions]
    following = np.where(steps.next_index >= 0, np.append(q[1:], 0), 0)
    target = np.clip(
        q + 0.8 * (decision_rewards(theta, steps) + 0.65 * following - q), 0, 1
    )
    slope = np.zeros(4)
    np.add.at(slope, steps.actions, (q - target) / 12)
    np.testing.assert_allclose(
        stepped.biases[1], network.biases[1] - 0.1 * slope, atol=1e-12
    )
    assert again is not stepped


def test_full_batch_descent_minimises_the_cost_for_targets_that_stay():
    """Many steps with the targets of the first one: the network's output becomes the target, Eq. (5.16)."""
    steps, theta = made_up(), RNG.normal(size=(4, 4))
    network = random_network((3, 20, 4), seed=1)
    rewards = decision_rewards(theta, steps)

    def after(n_steps):
        improver = FullBatchDescent(n_steps, gradient_step=2.0)
        return improver.improve(network, steps, rewards, 0.0, RNG)

    rows = np.arange(12), steps.actions
    q = network.forward(steps.inputs)[rows]
    following = np.where(steps.next_index >= 0, np.append(q[1:], 0), 0)
    target = np.clip(q + 0.8 * (rewards + 0.65 * following - q), 0, 1)
    errors = [
        abs(after(n).network.forward(steps.inputs)[rows] - target).mean()
        for n in (1, 30, 3000)
    ]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.05
    assert after(1).cost == after(30).cost


def test_full_batch_descent_rejects_wrong_settings():
    with pytest.raises(ValueError, match="n_steps must be at least 1, got 0"):
        FullBatchDescent(n_steps=0)


@pytest.mark.parametrize("seed", range(3))
def test_readable_descent_equals_compiled_twin(seed):
    rng = np.random.default_rng(seed)
    decisions = made_up(decisions=30, seed=seed)
    arguments = {
        "network": random_network((3, 5, 4), seed=seed),
        "decisions": decisions,
        "rewards": 0.35 * rng.random(30),
        "terminal_values": rng.random(30),
        "order": rng.integers(30, size=400),
        "learning_rate": 0.8,
        "discount": 0.65,
        "gradient_step": 0.4,
    }
    readable, compiled = (
        f(**arguments) for f in (sarsa_descent, compiled_sarsa_descent)
    )
    assert readable.cost == pytest.approx(compiled.cost, rel=1e-12)
    for one, other in zip(
        readable.network.weights + readable.network.biases,
        compiled.network.weights + compiled.network.biases,
        strict=True,
    ):
        np.testing.assert_allclose(one, other, rtol=1e-10, atol=1e-13)


def test_policy_cost_is_the_cross_entropy_of_chapter_3():
    network, rng = random_network((3, 5, 4), seed=1), np.random.default_rng(0)
    inputs, targets = rng.normal(size=(6, 3)), rng.random((6, 4))
    assert policy_cost(
        network, inputs, targets, regularisation=0.3
    ) == cross_entropy_cost(network, inputs, targets, regularisation=0.3)


def test_neural_action_values_are_the_outputs_of_the_network():
    network, inputs = random_network((3, 5, 4), seed=1), RNG.normal(size=(6, 3))
    np.testing.assert_array_equal(
        neural_action_values(network, inputs), network.forward(inputs)
    )
    np.testing.assert_array_equal(
        greedy_actions(network, inputs), network.decide(inputs)
    )


# -- rewards from demonstrations ---------------------------------------------------------------------------------------


def test_contrast_is_the_gradient_of_the_margin():
    demonstrations, theta = made_up(), RNG.normal(size=(4, 4))
    action_probabilities = RNG.dirichlet(np.ones(4), 12)
    weights = inverse_frequency_weights(demonstrations.actions, 4)

    def margin(t):
        r = demonstrations.features @ t.T
        return weights @ (
            r[np.arange(12), demonstrations.actions]
            - (action_probabilities * r).sum(axis=1)
        )

    slope = feature_gap(demonstrations, action_probabilities, weights)
    for index in np.ndindex(4, 4):
        step = np.zeros((4, 4))
        step[index] = 1e-5
        assert (margin(theta + step) - margin(theta - step)) / 2e-5 == pytest.approx(
            slope[index], abs=1e-8
        )


def test_nothing_to_learn_from_an_expert_one_already_equals():
    demonstrations = made_up()
    np.testing.assert_allclose(
        feature_gap(
            demonstrations,
            np.eye(4)[demonstrations.actions],
            inverse_frequency_weights(demonstrations.actions, 4),
        ),
        0,
        atol=1e-15,
    )


def test_balance_makes_actions_count_alike():
    actions = np.array([0] * 8 + [2] * 2)
    weights = inverse_frequency_weights(actions, 5)
    assert weights[actions == 0].sum() == pytest.approx(weights[actions == 2].sum())
    np.testing.assert_allclose(inverse_frequency_weights(actions, 5, power=0.0), 0.1)


def test_equation_514_finds_the_least_squares_fit():
    """Without a constraint that binds, it is what numpy's least squares finds: the learner's own values, explained."""
    demonstrations = made_up(decisions=40)
    values = np.full((40, 4), 0.01) + 0.001 * RNG.random((40, 4))
    theta = LeastSquaresReward(discount=0.65, regularisation=0.0, iterations=20_000)(
        demonstrations, values, values, np.zeros((4, 4)), 1
    )
    mu = discounted_feature_sums(
        all_action_features(demonstrations.features, 4)[
            np.arange(40), demonstrations.actions
        ],
        demonstrations.trajectory,
        0.65,
    )
    fitted, *_ = np.linalg.lstsq(
        mu, values[np.arange(40), demonstrations.actions], rcond=None
    )
    np.testing.assert_allclose(mu @ theta.ravel(), mu @ fitted, atol=1e-4)
    assert np.linalg.norm(theta) <= 1


def test_the_gradient_of_equation_514_is_its_difference_quotient():
    rng, theta = np.random.default_rng(0), np.array([0.3, -0.2, 0.5])
    mu, q = rng.random((7, 3)), rng.random(7)
    _, gradient = least_squares_objective(theta, mu, q, 0.7)
    for place, step in enumerate(1e-6 * np.eye(3)):
        above, below = (
            least_squares_objective(theta + h, mu, q, 0.7)[0] for h in (step, -step)
        )
        assert gradient[place] == pytest.approx((above - below) / 2e-6, rel=1e-6)


# -- choice ------------------------------------------------------------------------------------------------------------


def test_plain_accuracy_likes_one_action_for_everything():
    """The trap: three quarters go forward. Balanced accuracy knows better."""
    expert = np.array([0] * 75 + [1] * 10 + [2] * 5 + [3] * 10)
    forward = np.zeros(100, int)
    careful = expert.copy()
    careful[:35] = 1
    assert accuracy(forward, expert) == 0.75 > accuracy(careful, expert)
    assert balanced_accuracy(forward, expert) == pytest.approx(0.25)
    assert balanced_accuracy(careful, expert) == pytest.approx((40 / 75 + 3) / 4)


# -- the whole algorithm, where the truth is known ---------------------------------------------------------------------


def learn(case):
    tabular = TabularTask(case.task, max_steps=30)
    demonstrations = tabular.demonstrate(case.expert, 100, seed=1)
    improve = ReplaySGD(discount=case.task.discount, n_samples=8000)
    return nirl(
        demonstrations,
        tabular,
        iterations=150,
        hidden=30,
        improver=improve,
        reward_update=SubgradientMaxMargin(power=0.5),
        seed=0,
    )


def greedy(case, found):
    return found.network.decide(np.eye(case.task.n_states))


@pytest.mark.slow
def test_nirl_on_ground_of_four_kinds(terrain):
    found = learn(terrain)
    assert terrain.loss(greedy(terrain, found)) < 0.05
    history = found.history
    assert history.margins[-20:].mean() < 0.2 * history.margins[0]
    assert history.balanced[found.chosen] == history.balanced.max()
    assert (np.linalg.norm(history.weights, axis=(1, 2)) <= 1 + 1e-9).all()
    assert history.changes.shape == (150, 2)


def test_changes_of_weights_count_the_biases(terrain):
    """In Eq. (5.8) the biases are column 0 of the weight matrices."""
    tabular = TabularTask(terrain.task)
    demonstrations = tabular.demonstrate(terrain.expert, 5, seed=1)
    history = nirl(demonstrations, tabular, iterations=2, seed=0).history
    before, after = history.networks[1], history.networks[2]
    by_hand = [
        abs(after.weights[k] - before.weights[k]).sum()
        + abs(after.biases[k] - before.biases[k]).sum()
        for k in (0, 1)
    ]
    np.testing.assert_allclose(history.changes[1], by_hand)


@pytest.mark.slow
def test_nirl_on_random_rewards(scattered):
    assert scattered.loss(greedy(scattered, learn(scattered))) < 0.05


def test_without_a_reward_nothing_is_learned(terrain):
    """The control: equal rewards and neutral terminal values leave all actions equal, whatever the training."""
    tabular = TabularTask(terrain.task, max_steps=30)
    demonstrations = tabular.demonstrate(terrain.expert, 20, seed=1)
    nothing = np.zeros((4, terrain.task.n_states + 1))
    found = train_under_reward(
        demonstrations,
        tabular,
        nothing,
        iterations=20,
        improver=ReplaySGD(terminal_values=NEUTRAL_TERMINAL_VALUES),
        seed=0,
    )
    latest = found.history.networks[-1]
    assert np.ptp(latest.forward(np.eye(terrain.task.n_states))) < 0.1


@pytest.mark.slow
def test_the_true_reward_makes_an_expert(terrain):
    """The solver alone: expected rewards of each cell and action given, training finds a policy as good."""
    task = terrain.task
    theta = np.zeros((4, task.n_states + 1))
    theta[:, :-1] = (task.features @ terrain.truth).T
    tabular = TabularTask(task, max_steps=30)
    demonstrations = tabular.demonstrate(terrain.expert, 20, seed=1)
    improve = ReplaySGD(discount=task.discount, terminal_values=(0.5, 0.5))
    found = train_under_reward(
        demonstrations,
        tabular,
        theta,
        iterations=150,
        hidden=30,
        improver=improve,
        seed=0,
    )
    assert terrain.loss(greedy(terrain, found)) < 0.15


def test_it_stops_before_it_trains(terrain):
    """Lines 6 to 8 of Algorithm 10 stand before lines 9 and 10: a small margin ends the run with the latest policy."""
    tabular = TabularTask(terrain.task)
    demonstrations = tabular.demonstrate(terrain.expert, 5, seed=1)
    trained = []

    class Watched(ReplaySGD):
        def improve(self, *arguments):
            trained.append(arguments)
            return super().improve(*arguments)

    found = nirl(
        demonstrations,
        tabular,
        iterations=50,
        tolerance=1e9,
        improver=Watched(),
        seed=0,
    )
    assert trained == []
    assert len(found.history.margins) == 0
    assert found.chosen == 0
    again = nirl(demonstrations, tabular, iterations=50, improver=Watched(), seed=0)
    margins = again.history.margins
    tolerance = margins[:10].min() + 1e-12
    stopped = nirl(demonstrations, tabular, iterations=50, tolerance=tolerance, seed=0)
    assert len(stopped.history.margins) == np.argmax(margins <= tolerance)


def test_the_result_records_what_the_algorithm_yields(terrain):
    """With the network and the random numbers that the decorator makes, the algorithm yields its own history."""
    task = TabularTask(terrain.task)
    shown, rng = task.demonstrate(terrain.expert, 5, seed=1), np.random.default_rng(4)
    network = random_network((task.n_inputs, 6, task.n_actions), seed=rng)
    algorithm = inspect.unwrap(nirl)
    yielded = list(algorithm(shown, task, network, iterations=3, rng=rng))
    done = []
    found = nirl(
        shown, task, iterations=3, hidden=6, seed=4, progress=lambda *n: done.append(n)
    )
    assert done == [(1, 3), (2, 3), (3, 3)]
    assert found.history.costs.tolist() == [one.cost for one in yielded]
    np.testing.assert_array_equal(found.history.weights, [one.theta for one in yielded])
    networks = [network, *(one.network for one in yielded)]
    for kept, own in zip(found.history.networks.weights[0], networks, strict=True):
        np.testing.assert_array_equal(kept, own.weights[0])


def test_the_same_seed_gives_the_same_numbers(terrain):
    tabular = TabularTask(terrain.task)
    demonstrations = tabular.demonstrate(terrain.expert, 5, seed=1)
    one, same, other = (
        nirl(
            demonstrations,
            tabular,
            iterations=3,
            improver=ReplaySGD(terminal_values=ZERO_TERMINAL_VALUES),
            seed=s,
        ).history.networks.weights[0]
        for s in (0, 0, 1)
    )
    np.testing.assert_array_equal(one, same)
    assert (one != other).any()


def test_nothing_shown_gets_a_sentence(terrain):
    tabular = TabularTask(terrain.task)
    demonstrations = tabular.demonstrate(terrain.expert, 5, seed=1)
    with pytest.raises(
        ValueError,
        match="demonstrations must hold at least one decision of the expert, got none",
    ):
        nirl(made_up(decisions=0, trajectories=1), tabular, seed=0)
    with pytest.raises(
        ValueError, match="actions must lie between 0 and 3, got 7 to 7"
    ):
        nirl(
            demonstrations.with_actions(np.full(len(demonstrations), 7)),
            tabular,
            seed=0,
        )
    with pytest.raises(
        ValueError, match="actions must hold at least one decision, got none"
    ):
        balanced_accuracy([], [])


@pytest.mark.parametrize(
    "setting",
    [
        {"discount": 1.0},
        {"learning_rate": 0.0},
        {"n_samples": 0},
        {"terminal_values": (0.0, 2.0)},
    ],
)
def test_settings_out_of_bounds_get_a_sentence(setting):
    with pytest.raises(ValueError, match=next(iter(setting))):
        ReplaySGD(**setting)


@pytest.mark.slow
@pytest.mark.filterwarnings(
    # the expert never errs, so that no reward makes random segments like its own
    "ignore:relative_entropy_weights ended:robonav.errors.ConvergenceWarning"
)
@pytest.mark.parametrize("method", ["apprenticeship", "relative-entropy", "scirl"])
def test_baselines_run_on_a_finite_mdp(terrain, method):
    task = TabularTask(terrain.task)
    expert = task.demonstrate(terrain.expert, 20, seed=1)
    found = METHODS[method](expert, task, iterations=14, seed=0)
    assert found.policy.shape == (terrain.task.n_states,)
    assert found.reward_weights.shape == (4, terrain.task.n_states + 1)


def test_results_can_be_compared():
    """Comparing two results with == does not raise."""
    one, other = (maximum_margin([1.0, 0.0], [[0.0, 0.0]]) for _ in range(2))
    assert one == one
    assert one != other
