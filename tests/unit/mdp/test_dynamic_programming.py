"""The planners against closed forms, published utilities, a linear program, and each other."""

import contextlib
import inspect
import itertools
import math
import warnings

import gymnasium as gym
import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from robonav.errors import ConvergenceWarning
from robonav.mdp import (
    Cell,
    FiniteMDP,
    GridWorld,
    four_by_three,
    in_place_value_iteration,
    is_optimal,
    modified_policy_iteration,
    policy_evaluation,
    policy_iteration,
    prioritized_sweeping,
    value_iteration,
)
from robonav.mdp.solutions import first_policy, first_values_below

PLANNERS = [
    value_iteration,
    policy_iteration,
    modified_policy_iteration,
    in_place_value_iteration,
    prioritized_sweeping,
]
each_planner = pytest.mark.parametrize("planner", PLANNERS)


def sampled(seed, *, sparse=None, discount=None):
    """A random model of random size, many of its rewards and probabilities equal, so that actions often tie."""
    rng = np.random.default_rng(seed)
    states, actions, successors = (
        rng.integers(1, 12),
        rng.integers(1, 5),
        rng.integers(1, 4),
    )
    transitions = np.zeros((actions, states, states))
    for _ in range(successors):
        reached = rng.integers(states, size=(actions, states))
        np.add.at(
            transitions, (*np.indices((actions, states)), reached), 1 / successors
        )
    rewards = rng.integers(-2, 3, (states, actions)).astype(float)
    discount = rng.choice([0, 0.3, 0.9, 0.99]) if discount is None else discount
    sparse = rng.random() < 0.5 if sparse is None else sparse
    return FiniteMDP(
        [sp.csr_array(t) for t in transitions] if sparse else transitions,
        rewards,
        discount,
    )


def by_linear_program(mdp):
    """The least values no backup exceeds: min sum V with V >= r + gamma T V for every action (Puterman, 6.9)."""
    each = np.repeat(np.eye(mdp.n_states), mdp.n_actions, axis=0)
    rows = mdp.discount * mdp.rows.toarray() - each
    found = linprog(
        np.ones(mdp.n_states), A_ub=rows, b_ub=-mdp.rewards.ravel(), bounds=(None, None)
    )
    assert found.status == 0
    return found.x


def two_states(discount):
    """Puterman (2005), Section 3.1: two states, two actions in the first, one (given twice) in the second."""
    transitions = [[[0.5, 0.5], [0, 1]], [[0, 1], [0, 1]]]
    return FiniteMDP(transitions, [[5, 10], [-1, -1]], discount)


@each_planner
@pytest.mark.parametrize("discount", [0, 0.5, 0.9, 0.92, 0.95, 0.99])
def test_two_states_in_closed_form(planner, discount):
    """The second state has the value -1 / (1 - gamma); in the first it pays to stay from gamma = 10/11 on."""
    second = -1 / (1 - discount)
    stay, leave = (
        (5 + 0.5 * discount * second) / (1 - 0.5 * discount),
        10 + discount * second,
    )
    solution = planner(two_states(discount), 1e-8)
    np.testing.assert_allclose(solution.values, [max(stay, leave), second], atol=1e-8)
    assert solution.policy[0] == (0 if discount > 10 / 11 else 1)


@each_planner
def test_utilities_of_the_4x3_world(planner):
    """Russell and Norvig (2010), Fig. 17.3: published to three decimals, without discount."""
    grid = four_by_three()
    published = [
        [0.812, 0.868, 0.918, 0],
        [0.762, np.nan, 0.660, 0],
        [0.705, 0.655, 0.611, 0.388],
    ]
    solution = planner(grid.mdp(1.0))
    np.testing.assert_allclose(grid.on_map(solution.values), published, atol=6e-4)
    assert solution.policy[[0, 1, 2, 4, 5, 7, 8, 9, 10]].tolist() == [
        1,
        1,
        1,
        0,
        0,
        0,
        3,
        3,
        3,
    ]


@each_planner
@pytest.mark.parametrize(
    ("step_reward", "beside_the_pit", "two_below", "below_the_pit"),
    [(-2, 1, 1, 0), (-0.3, 0, 0, 3), (-0.04, 0, 3, 3), (-0.01, 3, 3, 2)],
)
def test_policies_of_the_4x3_world(
    planner, step_reward, beside_the_pit, two_below, below_the_pit
):
    """Russell and Norvig (2010), Fig. 17.2: where life is painful dying is fine, where it is mild safety is first."""
    policy = planner(four_by_three(step_reward=step_reward).mdp(1.0)).policy
    assert policy[[5, 9, 10]].tolist() == [beside_the_pit, two_below, below_the_pit]


@each_planner
def test_frozen_lake_is_crossed_in_14_of_17_tries(planner):
    """The known optimal success rate of the slippery lake without a limit of steps: 0.8235."""
    mdp = FiniteMDP.from_gymnasium(gym.make("FrozenLake-v1", is_slippery=True), 1.0)
    solution = planner(mdp, 1e-10)
    assert solution.values[0] == pytest.approx(14 / 17, abs=1e-6)
    assert policy_evaluation(mdp, solution.policy)[0] == pytest.approx(
        14 / 17, abs=1e-9
    )


@each_planner
def test_cliff_costs_13_steps(planner):
    mdp = FiniteMDP.from_gymnasium(gym.make("CliffWalking-v1"), 1.0)
    solution = planner(mdp)
    assert solution.values[36] == pytest.approx(-13)
    assert policy_evaluation(mdp, solution.policy)[36] == pytest.approx(-13)


@each_planner
def test_taxi_earns_what_its_shortest_rides_earn(planner):
    """20 for the passenger, less 1 for every other step; the rides are counted by walking the table breadth first."""
    env = gym.make("Taxi-v4" if "Taxi-v4" in gym.registry else "Taxi-v3")
    mdp = FiniteMDP.from_gymnasium(env, 1.0)
    solution = planner(mdp)
    table, starts = env.unwrapped.P, env.unwrapped.initial_state_distrib
    for start in np.flatnonzero(starts)[::17]:
        assert solution.values[start] == pytest.approx(
            20 - fewest_steps(table, int(start)) + 1
        )
    assert starts @ solution.values == pytest.approx(7.93, abs=0.005)


def fewest_steps(table, start):
    """Steps to the delivery of the passenger, breadth first."""
    seen, frontier, steps = {start}, [start], 0
    while frontier:
        steps += 1
        found = []
        for state in frontier:
            for ((_, reached, _, ended),) in table[state].values():
                if ended:
                    return steps
                if reached not in seen:
                    seen.add(reached)
                    found.append(reached)
        frontier = found
    return math.inf


@pytest.mark.parametrize(
    "batch",
    [
        pytest.param(batch, marks=pytest.mark.slow if batch >= 4 else ())
        for batch in range(20)
    ],
)
def test_planners_and_a_linear_program_agree(batch):
    """On 20 x 15 random models, all planners, dense and sparse."""
    for seed in range(15 * batch, 15 * batch + 15):
        mdp = sampled(seed)
        expected = by_linear_program(mdp)
        for planner in PLANNERS:
            solution = planner(mdp, 1e-7)
            np.testing.assert_allclose(
                solution.values,
                expected,
                atol=2e-7,
                err_msg=f"{planner.__name__}, seed {seed}",
            )
            assert is_optimal(mdp, solution.policy, tolerance=1e-6)


@settings(deadline=None)
@given(st.integers(0, 100_000), st.sampled_from([0.3, 0.9, 0.99]), st.floats(1e-4, 10))
def test_policies_lose_no_more_than_the_tolerance(seed, discount, tolerance):
    mdp = sampled(seed, discount=discount)
    best = policy_iteration(mdp).values
    for planner in PLANNERS:
        solution = planner(mdp, tolerance)
        assert (best - policy_evaluation(mdp, solution.policy)).max() <= tolerance
        bound = tolerance if planner is policy_iteration else tolerance / 2
        assert abs(solution.values - best).max() <= bound * (1 + 1e-9) + 1e-9


def test_the_bound_is_needed():
    """Stopping at a change below epsilon, as Algorithm 2 is printed, leaves the values far more than epsilon short."""
    patient, epsilon = (
        FiniteMDP([[[1.0]]], [[1.0]], 0.99),
        0.05,
    )  # 1 a step forever: a value of 100
    as_printed = value_iteration(patient, epsilon / patient.residual_for(1))
    assert as_printed.residual <= epsilon
    assert 100 - as_printed.values[0] > 90 * epsilon
    assert 100 - value_iteration(patient, epsilon).values[0] <= epsilon / 2


def tie_rich_grid(discount):
    """An open slippery grid with pockets behind walls: whole regions in which all actions have the same value."""
    rng = np.random.default_rng(0)
    symbols = np.where(rng.random((40, 40)) < 0.3, "#", ".")
    symbols[-1, -1] = "G"
    text = "\n".join("".join(row) for row in symbols)
    goal = {"G": Cell(ends=True)}
    return GridWorld(text, legend=goal, slip=0.2, step_reward=-1).mdp(discount)


@pytest.mark.parametrize(
    ("discount", "tolerance"),
    [(0.5, 1e-9), (0.95, 1e-9), (0.99, 1e-9), (0.999, 1e-8), (0.99999, 1e-4)],
)
def test_policy_iteration_ends_where_actions_tie(discount, tolerance):
    """A ConvergenceWarning, which fails this test, would say that it went round in circles."""
    mdp = tie_rich_grid(discount)
    solution = policy_iteration(mdp, tolerance, max_iterations=60)
    assert is_optimal(mdp, solution.policy, tolerance=1e-7)


def two_ways_round(stay, go, back, discount):
    """State 0 pays ``stay`` forever, or ``go`` on to state 1, which pays ``back`` and returns."""
    return FiniteMDP(
        [[[1, 0], [1, 0]], [[0, 1], [1, 0]]], [[stay, go], [back, back]], discount
    )


def test_a_small_gain_is_seen_in_large_values():
    """Going round pays a millionth more a step than staying, and all values are 100,000."""
    mdp = two_ways_round(1, 1 - 1e-6, 1 + 3e-6, 0.99999)
    solution = policy_iteration(mdp)
    assert solution.policy[0] == 1
    round_trip = (1 - 1e-6 + 0.99999 * (1 + 3e-6)) / (1 - 0.99999**2)
    assert solution.values[0] == pytest.approx(round_trip, rel=1e-14)


def test_what_rounding_hides_is_told():
    """At a discount of 1 - 1e-7 a gain of one rounding error amounts to more than the tolerance."""
    with pytest.warns(
        ConvergenceWarning, match=r"its policy may lose \S*e-0[89], where 1e-09 was"
    ):
        solution = policy_iteration(two_ways_round(1, 0.99, 1.03, 1 - 1e-7))
    assert solution.policy[0] == 1


def test_policy_iteration_keeps_an_action_that_ties():
    same = FiniteMDP(np.stack([np.full((4, 4), 0.25)] * 3), np.ones((4, 3)), 0.9)
    start = np.array([2, 1, 0, 1])
    solution = policy_iteration(same, start=start)
    assert (solution.policy == start).all()
    assert solution.iterations == 1


@pytest.mark.parametrize(
    "planner", [value_iteration, policy_iteration, modified_policy_iteration]
)
def test_without_discount_waiting_does_not_pass_for_going(planner):
    """Where only the goal pays, all actions of a corridor tie at discount 1, standing still among them."""
    mdp = GridWorld(". . . . G").mdp(1.0)
    solution = planner(mdp)
    np.testing.assert_allclose(solution.values[:4], 1)
    np.testing.assert_allclose(policy_evaluation(mdp, solution.policy)[:4], 1)


def test_planners_agree_on_a_slippery_grid_without_discount():
    """A policy to start from that got to the goal by slips alone would take longer than numbers can say."""
    rng = np.random.default_rng(3)
    symbols = np.where(rng.random((15, 15)) < 0.1, "#", ".")
    symbols[[-1, 0, -1], [-1, 0, 0]] = "G"
    mdp = GridWorld(
        "\n".join("".join(row) for row in symbols), slip=0.2, step_reward=-1
    ).mdp(1.0)
    values = [planner(mdp).values for planner in PLANNERS]
    for found in values[1:]:
        np.testing.assert_allclose(found, values[0], atol=1e-4)


@each_planner
def test_without_discount_a_free_wait_beats_a_bad_end(planner):
    """The end at hand costs 1: best is to wait forever, which no proper policy does. Beyond it a goal pays."""
    mdp = GridWorld(". . X . G").mdp(1.0)
    solution = planner(mdp)
    np.testing.assert_array_equal(solution.values, [0, 0, 0, 1, 0])
    np.testing.assert_array_equal(
        policy_evaluation(mdp, solution.policy), solution.values
    )
    assert is_optimal(mdp, solution.policy)
    assert not is_optimal(
        mdp, [1, 1, 0, 1, 0]
    )  # goes into the pit: no action alone looks better
    assert not is_optimal(mdp, [0, 0, 0, 0, 0])  # waits beside the goal


def test_policy_iteration_leaves_a_bad_end_it_was_started_on():
    solution = policy_iteration(
        GridWorld(". . X").mdp(1.0), start=[1, 1, 0], record=True
    )
    assert solution.history.tolist() == [[-1, -1, 0], [0, 0, 0]]


@settings(deadline=None)
@given(st.integers(0, 10**6))
def test_without_discount_no_policy_of_all_does_better(seed):
    """Small models with free waits, costs, and prizes and fines at the end, all their policies tried out.

    A policy that pays forever has no value and is passed over.
    """
    rng = np.random.default_rng(seed)
    transitions = rng.multinomial(2, np.full(5, 0.2), (2, 5)) / 2
    transitions[:, 4] = np.eye(5)[4]
    ending = (transitions[:, :, 4] == 1).T
    rewards = np.where(ending, rng.integers(-2, 3, (5, 2)), -rng.integers(0, 2, (5, 2)))
    rewards[4] = 0
    try:
        mdp = FiniteMDP(transitions, rewards, 1.0)
    except ValueError:
        assume(False)
    best = np.full(5, -np.inf)
    for policy in itertools.product(range(2), repeat=4):
        with contextlib.suppress(ValueError):
            best = np.maximum(best, policy_evaluation(mdp, [*policy, 0]))
    for planner in PLANNERS:
        solution = planner(mdp, 1e-9)
        np.testing.assert_allclose(solution.values, best, atol=1e-6)
        np.testing.assert_allclose(
            policy_evaluation(mdp, solution.policy), best, atol=1e-6
        )
        assert is_optimal(mdp, solution.policy, tolerance=1e-6)


def loan():
    """Where waiting is free one may borrow 1, which is then paid back; sweeps from 0 believe in never paying."""
    wait, borrow, end = [1, 0, 0], [0, 1, 0], [0, 0, 1]
    return FiniteMDP(
        [[wait, end, end], [borrow, end, end]], [[0, 1], [-1, -1], [0, 0]], 1.0
    )


@each_planner
def test_without_discount_values_are_those_of_a_policy(planner):
    mdp = loan()
    solution = planner(mdp)
    np.testing.assert_allclose(solution.values, [0, -1, 0], atol=1e-12)
    np.testing.assert_allclose(
        policy_evaluation(mdp, solution.policy), solution.values, atol=1e-12
    )


@pytest.mark.parametrize("planner", [p for p in PLANNERS if p is not policy_iteration])
def test_without_discount_a_start_too_high_is_no_answer(planner):
    """All would be content with 9 in a corridor where one may wait."""
    np.testing.assert_allclose(
        planner(GridWorld(". . . . G").mdp(1.0), start=np.full(5, 9.0)).values[:4], 1
    )


def test_without_discount_endless_reward_is_refused():
    mdp = GridWorld("..G", step_reward=1).mdp(1.0)
    with pytest.raises(ValueError, match="policy must not collect rewards forever"):
        policy_iteration(mdp)
    with pytest.raises(ValueError, match="start must not collect rewards forever"):
        policy_iteration(mdp, start=[0, 0, 0])
    with pytest.warns(
        ConvergenceWarning,
        match="value_iteration gave up after 50 iterations: .* by 1,",
    ):
        value_iteration(mdp, max_iterations=50)


@pytest.mark.parametrize(
    ("planner", "limit"),
    [
        (value_iteration, {"max_iterations": 2}),
        (in_place_value_iteration, {"max_iterations": 2}),
        (modified_policy_iteration, {"max_iterations": 2}),
        (policy_iteration, {"max_iterations": 1}),
        (prioritized_sweeping, {"max_backups": 3}),
    ],
)
def test_giving_up_warns_and_still_answers(planner, limit):
    mdp = tie_rich_grid(0.95)
    with pytest.warns(
        ConvergenceWarning,
        match=rf"{planner.__name__} gave up after \d .* where .* was asked for",
    ):
        solution = planner(mdp, **limit)
    assert solution.residual > 0
    assert solution.values.shape == solution.policy.shape == (mdp.n_states,)


def test_histories_are_the_steps_of_the_algorithms():
    mdp = sampled(7, discount=0.9)
    swept = value_iteration(mdp, record=True)
    assert (
        swept.history.shape
        == swept.policies.shape
        == (swept.iterations + 1, mdp.n_states)
    )
    for before, after, policy in zip(
        swept.history[:-1], swept.history[1:], swept.policies[:-1], strict=True
    ):
        np.testing.assert_allclose(
            after, mdp.action_values(before).max(axis=1), atol=1e-12
        )
        assert (policy == mdp.greedy(before)).all()
    iterated = policy_iteration(mdp, record=True)
    assert (
        iterated.history.shape
        == iterated.policies.shape
        == (iterated.iterations, mdp.n_states)
    )
    for values, policy in zip(iterated.history, iterated.policies, strict=True):
        np.testing.assert_allclose(values, policy_evaluation(mdp, policy), atol=1e-9)
    assert (
        np.diff(iterated.history, axis=0) >= -1e-9
    ).all()  # no policy is worse than the one before
    modified = modified_policy_iteration(mdp, record=True)
    assert (
        modified.history.shape
        == modified.policies.shape
        == (modified.iterations + 1, mdp.n_states)
    )
    np.testing.assert_array_equal(modified.history[-1], modified.values)
    assert value_iteration(mdp).history is None


@pytest.mark.parametrize("discount", [0.5, 0.9, 1.0])
def test_modified_policy_iteration_climbs_from_below(discount):
    """From its own start no step lowers a value; the last one only centres what is known by then."""
    history = modified_policy_iteration(
        four_by_three().mdp(discount), record=True
    ).history
    assert len(history) > 4
    assert (np.diff(history[:-1], axis=0) >= -1e-12).all()
    assert (
        history[0] <= policy_iteration(four_by_three().mdp(discount)).values + 1e-12
    ).all()


def test_starting_at_the_answer_ends_at_once():
    mdp = sampled(11, discount=0.9)
    best = policy_iteration(mdp)
    assert policy_iteration(mdp, start=best.policy).iterations == 1
    for planner in (
        value_iteration,
        in_place_value_iteration,
        modified_policy_iteration,
    ):
        assert planner(mdp, start=best.values).iterations == 1
    assert prioritized_sweeping(mdp, start=best.values).iterations == 0


def test_modified_policy_iteration_without_sweeps_is_value_iteration():
    mdp = sampled(5, discount=0.9)
    start = np.zeros(mdp.n_states)
    modified = modified_policy_iteration(mdp, sweeps=0, start=start, record=True)
    shared = modified.iterations - 1
    plain = value_iteration(mdp, record=True).history
    np.testing.assert_array_equal(modified.history[1:shared], plain[1:shared])


@each_planner
@pytest.mark.parametrize("tolerance", [0, -1.0, math.nan])
def test_wrong_tolerances_are_refused(planner, tolerance):
    with pytest.raises(ValueError, match="tolerance must be"):
        planner(two_states(0.9), tolerance)


@pytest.mark.parametrize(
    ("options", "error", "sentence"),
    [
        ({"start": [0.5, 0.5]}, TypeError, "start must hold whole numbers"),
        ({"start": [0, 2]}, ValueError, "start must hold actions from 0 to 1"),
        ({"max_iterations": 0}, ValueError, "max_iterations must be at least 1"),
    ],
)
def test_wrong_options_of_policy_iteration_are_refused(options, error, sentence):
    with pytest.raises(error, match=sentence):
        policy_iteration(two_states(0.9), **options)


LEAVE_OR_STAY = FiniteMDP(
    np.stack([np.eye(3), np.eye(3)[[2, 1, 2]]]),
    rewards=[[0, 2], [2, 2], [0, 0]],
    discount=0.99,
)
"""State 0 may leave for the terminal state 2 with reward 2, or stay with 0; state 1 loops with 2."""


@pytest.mark.parametrize("sweeps", [0, 1, 8, 50])
def test_modified_policy_iteration_with_a_terminal_state(sweeps):
    """Shifting all values but those of terminal states would make staying look better than leaving."""
    solution = modified_policy_iteration(LEAVE_OR_STAY, tolerance=0.05, sweeps=sweeps)
    assert solution.policy[0] == 1
    np.testing.assert_allclose(solution.values, [2, 200, 0], atol=0.025 + 1e-9)


def with_terminal_states(seed, discount):
    """A random model of ten states, two of them terminal, with rewards of both signs."""
    rng = np.random.default_rng(seed)
    transitions = rng.dirichlet(np.full(10, 0.2), size=(3, 10))
    rewards = rng.normal(rng.choice([-3, 0, 3]), 1, size=(10, 3))
    transitions[:, :2], rewards[:2] = np.eye(10)[:2], 0
    return FiniteMDP(transitions, rewards, discount)


@pytest.mark.parametrize("discount", [0.5, 0.9, 0.99])
@pytest.mark.parametrize("tolerance", [1e-4, 0.05, 1.0, 10.0])
@each_planner
def test_promised_loss_with_terminal_states(planner, tolerance, discount):
    for seed in range(12):
        mdp = with_terminal_states(seed, discount)
        best = policy_iteration(mdp).values
        solution = planner(mdp, tolerance)
        loss = best - policy_evaluation(mdp, solution.policy)
        assert loss.max() <= tolerance + 1e-9
        assert abs(solution.values - best).max() <= tolerance + 1e-9
        np.testing.assert_allclose(solution.values[:2], 0, atol=1e-9)


COMPILED = [
    value_iteration,
    modified_policy_iteration,
    in_place_value_iteration,
]


@pytest.mark.parametrize("planner", COMPILED)
@pytest.mark.parametrize("seed", range(6))
def test_compiled_twins(planner, seed):
    """On sparse models, what runs and what the page shows give the same bits."""
    ended = with_terminal_states(seed, 0.9)
    sparse = FiniteMDP(
        [sp.csr_array(matrix) for matrix in ended.transitions], ended.rewards, 0.9
    )
    algorithm = inspect.unwrap(planner)
    for mdp in (sparse, four_by_three().mdp(0.99), sampled(seed, sparse=True)):
        for options in ({}, {"max_iterations": 3}):
            start = (
                first_values_below(mdp, None)
                if planner is modified_policy_iteration
                else np.zeros(mdp.n_states)
            )
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", ConvergenceWarning)
                compiled = planner(mdp, 1e-3, record=True, **options)
            readable = algorithm(mdp, 1e-3, **options)
            for name in ("values", "policy", "iterations", "residual", "converged"):
                np.testing.assert_array_equal(
                    getattr(compiled, name), getattr(readable, name)
                )
            np.testing.assert_array_equal(compiled.history[0], start)
            np.testing.assert_array_equal(compiled.history[-1], readable.values)
            for count in range(1, min(compiled.iterations, 10)):
                stopped = algorithm(mdp, 1e-3, max_iterations=count)
                np.testing.assert_array_equal(compiled.history[count], stopped.values)


@pytest.mark.parametrize("seed", range(6))
def test_recorded_policy_iteration_is_what_the_page_shows(seed):
    algorithm = inspect.unwrap(policy_iteration)
    for mdp in (
        with_terminal_states(seed, 0.9),
        four_by_three().mdp(0.99),
        sampled(seed, sparse=True),
        sampled(seed, sparse=False),
    ):
        start = first_policy(mdp, None)
        recorded = policy_iteration(mdp, 1e-9, record=True)
        readable = algorithm(mdp, 1e-9)
        for name in ("policy", "iterations", "converged"):
            np.testing.assert_array_equal(
                getattr(recorded, name), getattr(readable, name)
            )
        for name in ("values", "residual"):  # another solver rounds otherwise
            np.testing.assert_allclose(
                getattr(recorded, name), getattr(readable, name), rtol=0, atol=1e-12
            )
        np.testing.assert_array_equal(recorded.policies[0], start)
        assert len(recorded.policies) == len(recorded.history) == readable.iterations
        for count in range(1, readable.iterations):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", ConvergenceWarning)
                stopped = algorithm(mdp, 1e-9, max_iterations=count)
            np.testing.assert_allclose(
                recorded.history[count - 1], stopped.values, rtol=0, atol=1e-12
            )
            np.testing.assert_array_equal(recorded.policies[count], stopped.policy)


def test_policy_iteration_as_written_ends_where_actions_tie():
    """Its twin solves so many equations by another method, so the two agree to rounding."""
    mdp = tie_rich_grid(0.95)
    readable, recorded = inspect.unwrap(policy_iteration)(mdp), policy_iteration(mdp)
    assert readable.converged
    assert readable.iterations == recorded.iterations
    np.testing.assert_array_equal(readable.policy, recorded.policy)
    np.testing.assert_allclose(readable.values, recorded.values, atol=1e-11)


@pytest.mark.parametrize(
    "seeds",
    [range(4), pytest.param(range(4, 20), marks=pytest.mark.slow)],
    ids=["few", "more"],
)
@pytest.mark.parametrize("planner", COMPILED)
def test_compiled_twins_on_dense_models(planner, seeds):
    """Dense products sum in BLAS's order: values agree to rounding, policies up to ties.

    Modified policy iteration may evaluate another of two equal actions, and then agrees to the tolerance only.
    """
    tolerance = 1e-3
    algorithm = inspect.unwrap(planner)
    for seed in seeds:
        rng = np.random.default_rng(seed)
        states, actions = rng.integers(2, 30), rng.integers(1, 5)
        full = FiniteMDP(
            rng.dirichlet(np.ones(states), (actions, states)),
            rng.integers(-2, 3, (states, actions)),
            rng.choice([0.3, 0.9, 0.99]),
        )
        for mdp in (full, sampled(seed, sparse=False)):
            compiled = planner(mdp, tolerance)
            readable = algorithm(mdp, tolerance)
            exact = planner is not modified_policy_iteration
            error = 1e-10 if exact else tolerance
            np.testing.assert_allclose(compiled.values, readable.values, 0, error)
            q = mdp.action_values(readable.values)
            chosen = [
                np.take_along_axis(q, policy[:, None], axis=1)
                for policy in (compiled.policy, readable.policy)
            ]
            np.testing.assert_allclose(*chosen, 0, 2 * error)


@each_planner
def test_converged_says_whether_the_tolerance_was_met(planner):
    mdp = tie_rich_grid(0.95)
    limit = {"max_backups" if planner is prioritized_sweeping else "max_iterations": 1}
    assert planner(mdp).converged is True
    with pytest.warns(ConvergenceWarning):
        assert planner(mdp, **limit).converged is False
