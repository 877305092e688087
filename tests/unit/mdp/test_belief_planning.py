"""QMDP and point-based value iteration, against the tiger's exact value and brute force over observations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.errors import ConvergenceWarning
from robonav.mdp import (
    POMDP,
    AlphaVectors,
    BeliefMDP,
    FiniteMDP,
    belief_rollout,
    fork,
    point_based_value_iteration,
    qmdp,
    spread_beliefs,
    tiger,
    without_sensing,
)
from robonav.mdp.belief_planning import backup
from robonav.mdp.dynamic_programming import value_iteration


def tiger_by_counting(accuracy, discount, furthest=12):
    """The tiger's exact value when nothing is known.

    All that counts is how often more it was heard left than right: a chain of 2 * furthest + 1 states, solved by plain
    repetition, without any vector.
    """
    heard = np.arange(-furthest, furthest + 1)
    left = accuracy**heard / (accuracy**heard + (1 - accuracy) ** heard)
    up = accuracy * left + (1 - accuracy) * (1 - left)
    values = np.zeros(len(heard))
    for _ in range(int(40 / (1 - discount))):
        above, below = (
            np.append(values[1:], values[-1]),
            np.append(values[0], values[:-1]),
        )
        listen = -1 + discount * (up * above + (1 - up) * below)
        open_left = -100 * left + 10 * (1 - left) + discount * values[furthest]
        open_right = -100 * (1 - left) + 10 * left + discount * values[furthest]
        values = np.max([listen, open_left, open_right], axis=0)
    return values[furthest]


def expectimax(pomdp, belief, horizon):
    """Best expected discounted reward over a horizon, by trying every action and observation."""
    if horizon == 0:
        return 0.0
    beliefs = BeliefMDP(pomdp)
    best = -np.inf
    for action in range(pomdp.mdp.n_actions):
        successors, probabilities = beliefs.successors(belief, action)
        ahead = sum(
            p * expectimax(pomdp, b, horizon - 1)
            for b, p in zip(successors, probabilities, strict=True)
        )
        best = max(best, beliefs.reward(belief, action) + pomdp.mdp.discount * ahead)
    return best


@pytest.mark.parametrize(
    ("accuracy", "discount"), [(0.85, 0.95), (0.85, 0.75), (0.65, 0.9)]
)
def test_the_tigers_value(accuracy, discount):
    pomdp = tiger(accuracy=accuracy, discount=discount)
    policy = point_based_value_iteration(
        pomdp, spread_beliefs(pomdp, [0.5, 0.5], 40), tolerance=1e-9
    )
    assert policy.value([0.5, 0.5]) == pytest.approx(
        tiger_by_counting(accuracy, discount), abs=1e-5
    )


def test_the_tigers_value_as_published():
    pomdp = tiger()
    policy = point_based_value_iteration(pomdp, spread_beliefs(pomdp, [0.5, 0.5], 40))
    assert policy.value([0.5, 0.5]) == pytest.approx(19.371, abs=1e-3)
    assert [policy.action([p, 1 - p]) for p in (0.02, 0.15, 0.5, 0.85, 0.98)] == [
        1,
        0,
        0,
        0,
        2,
    ]


@pytest.mark.slow
def test_the_policy_earns_what_it_says():
    pomdp = tiger(discount=0.75)
    policy = point_based_value_iteration(pomdp, spread_beliefs(pomdp, [0.5, 0.5], 40))
    weights = 0.75 ** np.arange(40)
    earned = [
        weights @ belief_rollout(pomdp, policy.action, 40, seed=seed).rewards
        for seed in range(400)
    ]
    assert np.mean(earned) == pytest.approx(
        float(policy.value([0.5, 0.5])), abs=3 * np.std(earned) / 20
    )


def test_qmdp_listens_for_another_reason_and_promises_too_much():
    """Believing that all will be known after one step, it waits for that as long as opening looks worse."""
    pomdp = tiger()
    optimist = qmdp(pomdp)
    assert optimist.value([0.5, 0.5]) == pytest.approx(
        10 / 0.05 - 1 - 10, abs=1e-4
    )  # 10 forever, except for one listen
    exact = point_based_value_iteration(pomdp, spread_beliefs(pomdp, [0.5, 0.5], 40))
    beliefs = np.stack([np.linspace(0, 1, 21), 1 - np.linspace(0, 1, 21)], axis=1)
    assert (optimist.value(beliefs) > exact.value(beliefs)).all()


def test_qmdp_never_pays_for_a_look():
    """Waiting costs nothing and, so it believes, tells as much as the sign: QMDP waits forever."""
    pomdp = fork()
    doubt = [0.5, 0.5, 0.0]
    assert qmdp(pomdp).action(doubt) == 0
    assert (
        belief_rollout(
            pomdp, qmdp(pomdp).action, 20, belief=doubt, seed=0
        ).rewards.sum()
        == 0
    )
    policy = point_based_value_iteration(pomdp, spread_beliefs(pomdp, doubt, 10))
    assert policy.value(doubt) == pytest.approx(-1 + 0.9 * 10)
    for seed in range(5):
        run = belief_rollout(pomdp, policy.action, 2, belief=doubt, seed=seed)
        assert run.actions.tolist() == [1, 2 + run.states[0]]
        assert run.rewards.tolist() == [-1, 10]


def test_a_sign_that_costs_too_much_is_not_read():
    policy = point_based_value_iteration(
        fork(sign_cost=9.5), spread_beliefs(fork(), [0.5, 0.5, 0.0], 10)
    )
    assert policy.value([0.5, 0.5, 0.0]) == pytest.approx(0, abs=1e-5)


def random_pomdp(seed, discount=0.6):
    rng = np.random.default_rng(seed)
    mdp = FiniteMDP(
        rng.dirichlet(np.ones(3), (2, 3)), rng.normal(size=(3, 2)), discount
    )
    return POMDP(mdp, rng.dirichlet(np.ones(2), (2, 3)))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6))
def test_backups_from_zero_are_the_finite_horizon(seed):
    """At the points themselves a backup is exact if the values ahead are: two steps by brute force.

    The points hold each belief that can follow, so that value of s where s' is meant would show at once.
    """
    pomdp = random_pomdp(seed)
    start = np.full(3, 1 / 3)
    reachable = np.concatenate(
        [[start], *(BeliefMDP(pomdp).successors(start, a)[0] for a in range(2))]
    )
    values = AlphaVectors(np.zeros((1, 3)), np.zeros(1, dtype=int))
    for horizon in (1, 2):
        values = backup(pomdp, reachable, values)
        assert values.value(start) == pytest.approx(expectimax(pomdp, start, horizon))


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10**6))
@pytest.mark.slow
def test_point_based_values_lie_below_the_truth_and_qmdp_above(seed):
    pomdp = random_pomdp(seed)
    start = np.full(3, 1 / 3)
    below = point_based_value_iteration(pomdp, spread_beliefs(pomdp, start, 60)).value(
        start
    )
    above = qmdp(pomdp).value(start)
    horizon = 6
    tail = 0.6**horizon * abs(pomdp.mdp.rewards).max() / 0.4
    exact = expectimax(pomdp, start, horizon)
    assert below <= exact + tail + 1e-6
    assert above >= exact - tail - 1e-6
    assert below >= exact - tail - 0.05  # sixty points are nearly enough


def test_with_a_clear_view_both_are_the_mdps_own_plan():
    rng = np.random.default_rng(0)
    mdp = FiniteMDP(rng.dirichlet(np.ones(4), (3, 4)), rng.normal(size=(4, 3)), 0.9)
    clear = POMDP(mdp, np.stack([np.eye(4)] * 3))
    planned = value_iteration(mdp, 1e-9)
    policy = point_based_value_iteration(clear, np.eye(4), tolerance=1e-10)
    np.testing.assert_allclose(policy.value(np.eye(4)), planned.values, atol=1e-6)
    np.testing.assert_allclose(
        qmdp(clear, tolerance=1e-9).value(np.eye(4)), planned.values, atol=1e-6
    )
    assert [policy.action(b) for b in np.eye(4)] == planned.policy.tolist()


def test_without_sensing_a_plan_is_a_fixed_sequence():
    """Blind, the tiger is best left alone: listening tells nothing, and opening at random loses 45 a time."""
    blind = without_sensing(tiger().mdp)
    policy = point_based_value_iteration(blind, spread_beliefs(blind, [0.5, 0.5], 5))
    assert policy.value([0.5, 0.5]) == pytest.approx(-1 / 0.05, abs=1e-4)
    assert policy.action([0.5, 0.5]) == 0


def test_spread_beliefs_are_reachable_far_apart_and_no_more_than_there_are():
    pomdp = tiger()
    few = spread_beliefs(pomdp, [0.5, 0.5], 3)
    np.testing.assert_allclose(sorted(few[:, 0]), [0.15, 0.5, 0.85])
    counts = np.arange(-13, 14)
    reachable = 0.85**counts / (0.85**counts + 0.15**counts)
    many = spread_beliefs(pomdp, [0.5, 0.5], 15)[:, 0]
    assert abs(many[:, None] - reachable).min(axis=1).max() < 1e-9
    assert len(spread_beliefs(without_sensing(pomdp.mdp), [0.5, 0.5], 9)) == 1


def test_a_reward_beyond_all_points_is_found():
    """Six cells in a row, the reward in the last, points only in the first five: no point itself sees any reward."""
    forward = np.eye(6)[[1, 2, 3, 4, 5, 5]]
    rewards = np.zeros((6, 1))
    rewards[-1] = 1
    blind = without_sensing(FiniteMDP([forward], rewards, 0.9))
    policy = point_based_value_iteration(blind, spread_beliefs(blind, np.eye(6)[0], 5))
    assert policy.value(np.eye(6)[0]) == pytest.approx(0.9**5 / 0.1, abs=1e-5)
    assert policy.value(np.eye(6)[0]) <= 0.9**5 / 0.1


def test_there_are_no_more_vectors_than_points():
    pomdp = random_pomdp(1, discount=0.9)
    points = spread_beliefs(pomdp, np.full(3, 1 / 3), 12)
    policy = point_based_value_iteration(pomdp, points)
    assert policy.iterations > 12
    assert len(policy.vectors) == len(policy.actions) <= 12


@pytest.mark.parametrize(
    ("beliefs", "sentence"),
    [
        (np.zeros((0, 2)), "beliefs must hold at least one belief"),
        ([0.5, 0.5], r"beliefs must have shape \(N, 2\)"),
        (
            [[0.5, 0.5], [1, 1]],
            "beliefs must be a distribution over the 2 states, got sum 2",
        ),
        (
            [[0.5, 0.5], [1.5, -0.5]],
            "beliefs must be a distribution over the 2 states, got a probability of -0.5",
        ),
    ],
)
def test_points_are_beliefs(beliefs, sentence):
    with pytest.raises(ValueError, match=sentence):
        point_based_value_iteration(tiger(), beliefs)


def test_only_beliefs_have_a_value():
    policy = qmdp(tiger())
    for wrong in ([1, 1], [1.0], [[0.5, 0.5], [0.5, 0.6]], 1.0):
        with pytest.raises(ValueError, match="belief must"):
            policy.value(wrong)
    with pytest.raises(ValueError, match=r"belief must have shape"):
        policy.action([[0.5, 0.5]])


@pytest.mark.parametrize(
    "plan",
    [
        qmdp,
        lambda m: spread_beliefs(m, [1, 0], 2),
        lambda m: point_based_value_iteration(m, [[1, 0]]),
    ],
)
def test_a_model_without_observations_is_refused(plan):
    with pytest.raises(TypeError, match="pomdp must be POMDP, got FiniteMDP"):
        plan(tiger().mdp)


def test_too_few_backups_warn_and_say_how_far_it_was():
    pomdp = tiger()
    with pytest.warns(
        ConvergenceWarning,
        match="gave up after 3 iterations: the last one still changed a value by",
    ):
        point_based_value_iteration(pomdp, [[0.5, 0.5]], max_iterations=3)


def test_without_discount_there_is_nothing_to_start_from():
    mdp = FiniteMDP(np.ones((1, 1, 1)), np.zeros((1, 1)), 1.0)
    with pytest.raises(ValueError, match="needs a discount below 1"):
        point_based_value_iteration(without_sensing(mdp), [[1.0]])
