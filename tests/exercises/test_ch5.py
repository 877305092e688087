"""Chapter 5: the parts of each exercise. A docstring's first line is what the student reads."""

import numpy as np
import pytest


def trajectories(rng, lengths, k=3):
    return [rng.normal(size=(int(length), k)) for length in lengths]


@pytest.mark.part("5.1", points=2)
def test_expectations_of_one_trajectory(answer, rng):
    """Agrees with the definition on single trajectories."""
    for length in (1, 2, 5, 9):
        answer.agrees(trajectories(rng, [length]), rng.uniform(0.3, 0.95))


@pytest.mark.part("5.1", points=2)
def test_expectations_of_many_trajectories(answer, rng):
    """Gives every trajectory the same weight, whatever its length."""
    for _ in range(5):
        answer.agrees(
            trajectories(rng, rng.integers(1, 9, size=4)), rng.uniform(0.3, 0.95)
        )


@pytest.mark.part("5.1", points=1)
def test_expectations_at_the_extremes(answer, rng):
    """Uses only the first step with a discount of 0, and the plain mean with 1. A feature that is always 1 stays 1."""
    for discount in (0.0, 1.0):
        answer.agrees(trajectories(rng, [3, 6]), discount)
    answer.agrees([np.ones((4, 2)), np.ones((1, 2))], 0.9)


def slippery(rng, actions):
    """How actions slip: mostly not."""
    slip = rng.random((actions, actions)) + 2 * np.eye(actions)
    return slip / slip.sum(axis=1, keepdims=True)


@pytest.mark.part("5.2", points=3)
def test_intended_on_a_slippery_road(answer, rng):
    """Agrees with Bayes' rule where every action can slip into every other."""
    for _ in range(8):
        prior = rng.random(4) ** 3
        recorded = rng.integers(5, size=20), rng.integers(4, size=20)
        answer.agrees(*recorded, slippery(rng, 4), prior / prior.sum(), 6)


@pytest.mark.part("5.2", points=1)
def test_intended_with_zeros(answer, rng):
    """Allows actions that never slip, and actions that the expert never means."""
    slip = np.array([[0.6, 0.4, 0.0], [0.0, 1.0, 0.0], [0.0, 0.3, 0.7]])
    for _ in range(5):
        states = rng.integers(4, size=12)
        done = np.where(
            states % 2 == 0, rng.integers(0, 2, size=12), rng.integers(1, 3, size=12)
        )
        answer.agrees(states, done, slip, np.array([0.3, 0.4, 0.3]), 6)
    answer.agrees(
        np.array([1, 1]), np.array([1, 1]), slip, np.array([0.5, 0.0, 0.5]), 2
    )


@pytest.mark.part("5.2", points=1)
def test_intended_over_a_long_time(answer, rng):
    """Stays right when a state was seen thousands of times."""
    slip = slippery(rng, 3)
    for meant in range(3):
        answer.agrees(
            np.zeros(4000, dtype=int),
            rng.choice(3, p=slip[meant], size=4000),
            slip,
            np.full(3, 1 / 3),
            1,
        )


@pytest.mark.part("5.3", points=2)
def test_projected_between(answer, rng):
    """Finds the nearest point where it lies between the mixture and the new policy."""
    for _ in range(8):
        mixture, found, scale = (
            rng.normal(size=4),
            rng.normal(size=4),
            rng.uniform(0.2, 5, size=4),
        )
        aside = rng.normal(size=4)
        along = (found - mixture) / scale
        aside = (aside - aside @ along / (along @ along) * along) * scale
        answer.agrees(
            mixture,
            found,
            mixture + rng.uniform(0.1, 0.9) * (found - mixture) + aside,
            scale,
        )


@pytest.mark.part("5.3", points=1)
def test_projected_beyond(answer, rng):
    """Stays on the segment where the expert lies beyond either end."""
    for _ in range(8):
        mixture, found, scale = (
            rng.normal(size=3),
            rng.normal(size=3),
            rng.uniform(0.2, 5, size=3),
        )
        answer.agrees(
            mixture, found, mixture + rng.choice([-1.5, 2.5]) * (found - mixture), scale
        )


@pytest.mark.part("5.3", points=1)
def test_projected_onto_itself(answer, rng):
    """Leaves the mixture unchanged where the new policy equals it."""
    mixture = rng.normal(size=4)
    answer.agrees(mixture, mixture, rng.normal(size=4), rng.uniform(0.5, 2, size=4))


def gap(theta, contrasts):
    return float((contrasts @ theta).min())


def game(answer, rng, policies, features):
    """One game: weights on the simplex whose margin is as good as the reference's, within a hundredth."""
    expert, found = rng.normal(size=features), rng.normal(size=(policies, features))
    theta = answer.array(expert, found, shape=(features,))
    on_simplex = theta.min() >= -1e-6 and abs(theta.sum() - 1) < 1e-4
    answer.check(on_simplex, "the weights must not be negative, and sum to one")
    contrasts = expert - found
    best, reached = gap(answer.expected, contrasts), gap(theta, contrasts)
    near = reached >= best - 0.015 * np.abs(contrasts).max()
    answer.check(near, f"a margin of {best:.3f} can be reached, got {reached:.3f}")


@pytest.mark.part("5.4", points=3)
def test_margin_over_one_policy(answer, rng):
    """Gives all weight to the feature in which the expert exceeds a single policy by most."""
    for _ in range(3):
        game(answer, rng, 1, 4)


@pytest.mark.part("5.4", points=7)
def test_margin_over_many_policies(answer, rng):
    """Reaches the greatest margin over the worst of several policies."""
    for policies, features in ((2, 3), (4, 3), (5, 6), (12, 5)):
        game(answer, rng, policies, features)


@pytest.mark.part("5.5", points=3)
def test_reweighted_samples(answer, rng):
    """Agrees with the definition where few weights are clipped."""
    for _ in range(6):
        answer.agrees(
            rng.normal(size=20), rng.normal(size=20), rng.normal(size=(20, 3)), 3.0
        )


@pytest.mark.part("5.5", points=1)
def test_reweighted_samples_without_a_cut(answer, rng):
    """Returns the plain estimate where no weight is clipped, and the mean where all weights are equal."""
    for _ in range(3):
        answer.agrees(
            rng.normal(size=12), rng.normal(size=12), rng.normal(size=(12, 2)), 1000.0
        )
    log_p = rng.normal(size=9)
    answer.agrees(log_p, log_p - 2, rng.normal(size=(9, 2)), 1.0)


@pytest.mark.part("5.5", points=2)
def test_reweighted_samples_far_from_zero(answer, rng):
    """Stays finite where the logarithms are in the thousands."""
    for shift in (-4000.0, 3000.0):
        answer.agrees(
            shift + rng.normal(size=15),
            2 * shift + rng.normal(size=15),
            rng.normal(size=(15, 3)),
            2.0,
        )


@pytest.mark.part("5.6", points=2)
def test_accuracies_of_random_policies(answer, rng):
    """Agrees with the definition on policies that usually agree with the expert."""
    for _ in range(8):
        expert = np.concatenate(
            [np.arange(4), rng.choice(4, p=[0.7, 0.1, 0.1, 0.1], size=20)]
        )
        answer.agrees(
            expert, np.where(rng.random(24) < 0.6, expert, rng.integers(4, size=24)), 4
        )


@pytest.mark.part("5.6", points=1)
def test_accuracies_of_always_forward(answer, rng):
    """Returns zero for a policy that always goes forward, also where some actions never occur."""
    for _ in range(4):
        expert = np.concatenate([[0, 2], rng.choice([0, 0, 0, 2, 3], size=15)])
        answer.agrees(expert, np.zeros(17, dtype=int), 6)
    answer.agrees(np.zeros(9, dtype=int), np.zeros(9, dtype=int), 3)
