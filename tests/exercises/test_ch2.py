"""Chapter 2: the parts of each exercise. A docstring's first line is what the student reads."""

import numpy as np
import pytest


def probabilities(rng, *shape):
    """Probabilities along the last axis, about half of them zero."""
    weights = rng.random(shape) * (rng.random(shape) < 0.5)
    weights[..., 0] += 0.1
    return weights / weights.sum(axis=-1, keepdims=True)


def process(rng, states=5, actions=3):
    """A random decision process: transitions (A, S, S) and rewards (S, A)."""
    return probabilities(rng, actions, states, states), rng.normal(
        size=(states, actions)
    )


@pytest.mark.part("2.1", points=2)
def test_backup_in_random_worlds(answer, rng):
    """Agrees with the definition in random decision processes without terminal states."""
    for _ in range(10):
        transitions, _ = process(rng)
        rewards, values = rng.normal(size=transitions.shape), rng.normal(size=5)
        answer.agrees(
            transitions,
            rewards,
            rng.uniform(0.3, 0.95),
            values,
            np.zeros(5, dtype=bool),
        )


@pytest.mark.part("2.1", points=1)
def test_backup_into_the_end(answer, rng):
    """Gives terminal states the value 0, also as next states."""
    for _ in range(10):
        transitions, _ = process(rng, states=6, actions=2)
        rewards, values = rng.normal(size=transitions.shape), rng.normal(size=6)
        answer.agrees(transitions, rewards, 0.9, values, rng.permutation(6) < 2)


@pytest.mark.part("2.1", points=1)
def test_backup_without_a_future(answer, rng):
    """Uses only the next reward with a discount of 0, and all later values in full with 1."""
    for discount in (0.0, 1.0):
        transitions, _ = process(rng, states=4, actions=4)
        terminal = np.array([False, True, False, False])
        answer.agrees(
            transitions,
            rng.normal(size=transitions.shape),
            discount,
            rng.normal(size=4),
            terminal,
        )


@pytest.mark.part("2.2", points=1)
def test_improve_where_one_is_best(answer, rng):
    """Takes the best action where it is clearly better."""
    for _ in range(10):
        q = rng.permuted(np.arange(40.0).reshape(8, 5), axis=1)
        answer.agrees(q, rng.integers(5, size=8), 0.5)


@pytest.mark.part("2.2", points=2)
def test_improve_where_actions_tie(answer, rng):
    """Keeps the current action where none is better; takes the first of several that are."""
    for _ in range(10):
        answer.agrees(
            rng.integers(3, size=(12, 5)).astype(float), rng.integers(5, size=12), 0.0
        )


@pytest.mark.part("2.2", points=1)
def test_improve_within_the_tolerance(answer, rng):
    """Does not change for a gain of the tolerance or less."""
    for _ in range(10):
        answer.agrees(
            rng.integers(6, size=(12, 4)).astype(float), rng.integers(4, size=12), 2.0
        )


@pytest.mark.part("2.3", points=2)
def test_bounds_of_random_sweeps(answer, rng):
    """Agrees with the definition on two successive value tables."""
    for _ in range(10):
        previous = rng.normal(size=6)
        answer.agrees(
            previous,
            previous + rng.normal(rng.normal(), 1, size=6),
            rng.uniform(0.3, 0.95),
        )


@pytest.mark.part("2.3", points=2)
def test_bounds_enclose_the_optimum(answer, rng):
    """Has the optimal values between the bounds, after every sweep of value iteration."""
    for _ in range(3):
        (transitions, rewards), discount = process(rng), 0.8

        def sweep(values, transitions=transitions, rewards=rewards, discount=discount):
            return (rewards + discount * (transitions @ values).T).max(axis=1)

        optimum = np.zeros(5)
        for _ in range(200):
            optimum = sweep(optimum)
        previous, values = np.zeros(5), sweep(np.zeros(5))
        for _ in range(4):
            lower, upper = answer.agrees(previous, values, discount)
            enclosed = np.all(np.asarray(lower) <= optimum + 1e-6) and np.all(
                optimum <= np.asarray(upper) + 1e-6
            )
            answer.check(enclosed, "the optimal values lie outside of the bounds")
            previous, values = values, sweep(values)


def a_run(rng, states, readings, length, *, certain=False):
    """A belief, a world, and what happened in it; ``certain`` leaves each state some readings that it cannot give."""
    transitions, observations = (
        probabilities(rng, 2, states, states),
        probabilities(rng, 2, states, readings),
    )
    if not certain:
        observations = 0.5 * observations + 0.5 / readings
    belief = rng.random(states)
    return (
        belief / belief.sum(),
        transitions,
        observations,
        rng.integers(2, size=length),
        length,
    )


@pytest.mark.part("2.4", points=2)
def test_track_one_step(answer, rng):
    """Agrees with Bayes' rule on a single step with a reading."""
    for _ in range(10):
        *world, length = a_run(rng, 5, 3, 1)
        answer.agrees(*world, rng.integers(3, size=length))


@pytest.mark.part("2.4", points=2)
def test_track_through_gaps(answer, rng):
    """Predicts from the moves where readings are missing."""
    for _ in range(10):
        *world, length = a_run(rng, 4, 3, 8)
        answer.agrees(*world, rng.integers(-1, 3, size=length))


@pytest.mark.part("2.4", points=1)
def test_track_through_lies(answer, rng):
    """Ignores a reading that is impossible."""
    for last in (False, True) * 5:
        belief, transitions, observations, actions, length = a_run(
            rng, 4, 6, 6, certain=True
        )
        readings = rng.integers(-1, 6, size=length)
        if last:  # a reading that no state gives
            observations[:, :, 5] = 0
            observations /= observations.sum(axis=2, keepdims=True)
            readings[-1] = 5
        answer.agrees(belief, transitions, observations, actions, readings)


@pytest.mark.part("2.4", points=1)
def test_track_stays_a_belief(answer, rng):
    """Returns probabilities that sum to one, and the given belief after zero steps."""
    for length in (0, 30):
        *world, length = a_run(rng, 5, 3, length)
        belief = answer.array(*world, rng.integers(-1, 3, size=length), shape=(5,))
        answer.check(
            abs(belief.sum() - 1) < 1e-4 and bool((belief >= 0).all()),
            "this is no belief",
        )
    *world, _ = a_run(rng, 5, 3, 0)
    answer.agrees(*world, np.zeros(0, dtype=int))


def batch(rng, q, steps=8):
    """Rewards, next states and actions, and ends of some recorded steps."""
    states, actions = q.shape
    return (
        rng.normal(size=steps),
        rng.integers(states, size=steps),
        rng.integers(actions, size=steps),
        rng.random(steps) < 0.3,
    )


@pytest.mark.part("2.5", points=3)
def test_targets_of_random_steps(answer, rng):
    """Agrees with the three definitions on random steps."""
    for _ in range(10):
        q = rng.normal(size=(6, 4))
        answer.agrees(q, *batch(rng, q), rng.uniform(0.3, 0.95), rng.uniform(0.1, 0.9))


@pytest.mark.part("2.5", points=1)
def test_targets_where_actions_tie(answer, rng):
    """Gives all best actions the same probability."""
    for _ in range(10):
        q = rng.integers(2, size=(5, 4)).astype(float)
        answer.agrees(q, *batch(rng, q), 0.9, 0.3)


@pytest.mark.part("2.5", points=1)
def test_targets_at_the_extremes(answer, rng):
    """Makes expected SARSA equal to Q-learning for epsilon 0, and takes the mean of all actions for epsilon 1."""
    for epsilon in (0.0, 1.0):
        q = rng.normal(size=(5, 3))
        answer.agrees(q, *batch(rng, q), 0.9, epsilon)


def wander(rng, states, episodes, longest):
    """Episodes as lists of states and of rewards."""
    lengths = rng.integers(1, longest + 1, size=episodes)
    return [rng.integers(states, size=n).tolist() for n in lengths], [
        rng.integers(-3, 4, size=n).tolist() for n in lengths
    ]


@pytest.mark.part("2.6", points=2)
def test_first_visits_of_one_episode(answer, rng):
    """Agrees with the definition on a single episode."""
    for _ in range(6):
        answer.agrees(*wander(rng, 6, 1, 10), 0.5, 6)


@pytest.mark.part("2.6", points=2)
def test_first_visits_of_many_episodes(answer, rng):
    """Averages over the episodes that visited a state, once each."""
    for _ in range(6):
        answer.agrees(*wander(rng, 5, 6, 8), 0.9, 5)


@pytest.mark.part("2.6", points=1)
def test_first_visits_of_nothing(answer, rng):
    """Returns zero for unvisited states, also without discounting."""
    states, rewards = wander(rng, 3, 4, 6)
    answer.agrees(states, rewards, 1.0, 7)
    answer.agrees([], [], 0.9, 3)


@pytest.mark.part("2.7", points=2)
def test_battery_of_unit_costs(answer, rng):
    """Agrees with planning for a number of steps where every action uses one unit."""
    for _ in range(5):
        answer.agrees(*process(rng), np.ones(3, dtype=int), 6)


@pytest.mark.part("2.7", points=3)
def test_battery_of_random_costs(answer, rng):
    """Plans with actions of different costs, rewards of both signs, and charges with which no action is possible."""
    for _ in range(10):
        transitions, rewards = process(rng, states=4)
        answer.agrees(transitions, rewards - 0.5, rng.integers(2, 5, size=3), 9)


@pytest.mark.part("2.7", points=1)
def test_battery_empty(answer, rng):
    """Returns zero for an empty battery."""
    answer.agrees(*process(rng, states=3, actions=2), np.array([1, 2]), 0)
    answer.agrees(*process(rng, states=3, actions=2), np.array([3, 4]), 2)


def seen(rng, states, actions, steps):
    """Steps of a robot that wandered, their rewards and ends."""
    visited = np.stack(
        [rng.integers(n, size=steps) for n in (states, actions, states)], axis=1
    )
    return (
        visited,
        rng.integers(-2, 3, size=steps).astype(float),
        rng.random(steps) < 0.2,
        (states, actions),
    )


@pytest.mark.part("2.8", points=5)
def test_explorer_after_many_steps(answer, rng):
    """Plans in the estimated model, optimistic where it is not known."""
    for _ in range(5):
        answer.agrees(*seen(rng, 4, 2, 30), 3, 2.0, 0.8)


@pytest.mark.part("2.8", points=2)
def test_explorer_that_knows_all(answer, rng):
    """Plans in the estimated model if all pairs are known."""
    for _ in range(3):
        steps, rewards, terminated, size = seen(rng, 3, 2, 30)
        everywhere = np.array(
            [[s, a, rng.integers(3)] for s in range(3) for a in range(2)]
        )
        steps, rewards = (
            np.concatenate([steps, everywhere]),
            np.concatenate([rewards, np.ones(6)]),
        )
        answer.agrees(
            steps,
            rewards,
            np.concatenate([terminated, np.zeros(6, dtype=bool)]),
            size,
            1,
            2.0,
            0.9,
        )


@pytest.mark.part("2.8", points=2)
def test_explorer_on_the_border(answer, rng):
    """Takes a pair for known after exactly the given number of tries, and not one try earlier."""
    for tries in (1, 2, 3):
        steps = np.tile([[0, 0, 1]], (tries, 1))
        answer.agrees(
            steps,
            rng.integers(-2, 2, size=tries).astype(float),
            np.zeros(tries, dtype=bool),
            (2, 1),
            2,
            1.0,
            0.5,
        )


@pytest.mark.part("2.8", points=1)
def test_explorer_that_has_seen_nothing(answer, rng):
    """Gives all pairs the largest possible value before the first step."""
    nothing = np.zeros((0, 3), dtype=int), np.zeros(0), np.zeros(0, dtype=bool)
    answer.agrees(*nothing, (3, 2), 1, 1.5, 0.75)
