"""Chapter 5: the parts of each exercise. A docstring's first line is what the student reads."""

import numpy as np
import pytest

from robonav.grading.compare import as_numbers


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


@pytest.mark.part("5.2", points=2)
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
    alike = np.array([[0.2, 0.8, 0.0], [0.5, 0.5, 0.0], [0.5, 0.5, 0.0]])
    answer.agrees(np.array([0, 0]), np.array([0, 0]), alike, np.full(3, 1 / 3), 1)


@pytest.mark.part("5.2", points=1)
def test_intended_and_excluded(answer, rng):
    """Excludes an action that cannot have led to one of a thousand steps, however well it explains the others."""
    for _ in range(3):
        often = rng.uniform(0.85, 0.95)
        slip = np.array([[often, 1 - often, 0.0], [0.3, 0.4, 0.3], [0.1, 0.1, 0.8]])
        done = rng.permutation(np.repeat([0, 1, 2], [900, 99, 1]))
        states = np.zeros(1000, dtype=int)
        answer.agrees(states, done, slip, np.array([0.5, 0.3, 0.2]), 2)


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


def mixtures(rng, share, n=3, k=4):
    """Policies, and an expert whose nearest point lies at this share of the way to the new policy."""
    weights = rng.uniform(0.1, 1, size=n)
    weights /= weights.sum()
    found, scale = rng.normal(size=(n + 1, k)), rng.uniform(0.2, 5, size=k)
    mixture = weights @ found[:-1]
    along = (found[-1] - mixture) / scale
    aside = rng.normal(size=k)
    aside = aside - aside @ along / (along @ along) * along
    return weights, found, mixture + (share * along + aside) * scale, scale


@pytest.mark.part("5.3", points=1)
def test_projected_between(answer, rng):
    """Finds the probabilities where the nearest point lies between the mixture and the new policy."""
    for _ in range(8):
        answer.agrees(*mixtures(rng, rng.uniform(0.1, 0.9)), at=0)


@pytest.mark.part("5.3", points=1)
def test_projected_distance(answer, rng):
    """Finds the distance that remains between the new mixture and the expert."""
    for _ in range(8):
        answer.agrees(*mixtures(rng, rng.uniform(0.1, 0.9)), at=1)


@pytest.mark.part("5.3", points=1)
def test_projected_beyond(answer, rng):
    """Stays on the segment where the expert lies beyond either end."""
    for share in (-1.5, 2.5, -0.2, 1.1):
        answer.agrees(*mixtures(rng, share), at=0)


@pytest.mark.part("5.3", points=1)
def test_projected_onto_itself(answer, rng):
    """Gives a new policy that equals the mixture the probability zero."""
    policy = rng.integers(-3, 4, size=4).astype(float)
    for weights in ([1.0], [0.25, 0.75]):
        found = np.tile(policy, (len(weights) + 1, 1))
        scale = rng.uniform(0.5, 2, size=4)
        answer.agrees(np.array(weights), found, policy + rng.normal(size=4), scale)


def gap(theta, contrasts):
    return float((contrasts @ theta).min())


def game(answer, expert, found):
    """One game: weights on the simplex whose margin is as good as the reference's, within a hundredth."""
    theta = answer.array(expert, found, shape=expert.shape)
    on_simplex = theta.min() >= -1e-6 and abs(theta.sum() - 1) < 1e-4
    answer.check(on_simplex, "the weights must not be negative, and sum to one")
    contrasts = expert - found
    best, reached = gap(answer.expected, contrasts), gap(theta, contrasts)
    near = reached >= best - 0.015 * np.abs(contrasts).max()
    problem = f"a margin of {best:.3f} can be reached, got {reached:.3f}"
    answer.check(near, problem, advice(theta, contrasts))


def advice(theta, contrasts):
    """What may be wrong with weights that do not reach the greatest margin."""
    if len(contrasts) == 1:
        return (
            "Against one policy, all weight belongs on the feature with the largest difference. If the players learn in "
            "rounds, play more of them, or take a larger step."
        )
    if gap(theta, contrasts) < gap(np.full(theta.shape, 1 / len(theta)), contrasts):
        return "Equal weights reach a larger margin than yours: is a sign exchanged, or is this only the last round?"
    if theta.max() > 0.999:
        return "All weight is on one feature. Against several policies several features usually need some."
    return (
        "If the players learn in rounds, return the mean over all rounds. Its error is about the step plus log(k) / "
        "(step times rounds), so choose a small step first, and then enough rounds."
    )


@pytest.mark.part("5.4", points=2)
def test_margin_over_one_policy(answer, rng):
    """Gives all weight to the feature in which the expert exceeds a single policy by most."""
    for _ in range(3):
        game(answer, rng.normal(size=4), rng.normal(size=(1, 4)))


@pytest.mark.part("5.4", points=3)
def test_margin_over_a_few_policies(answer, rng):
    """Reaches the greatest margin over the worst of a few policies."""
    for policies, features in ((2, 3), (4, 3), (3, 4)):
        game(answer, rng.normal(size=features), rng.normal(size=(policies, features)))


@pytest.mark.part("5.4", points=2)
def test_margin_over_many_policies(answer, rng):
    """Reaches the greatest margin over the worst of many policies."""
    for policies, features in ((5, 6), (12, 5)):
        game(answer, rng.normal(size=features), rng.normal(size=(policies, features)))


@pytest.mark.part("5.4", points=3)
def test_margin_where_the_worst_changes(answer, rng):
    """Reaches the greatest margin where each feature is best against one policy and worst against another."""
    for _ in range(3):
        a, b, c = rng.uniform(0.5, 2, size=3)
        contrasts = np.array([[0, a, -b], [-a, 0, c], [b, -c, 0]])
        expert = rng.normal(size=3)
        game(answer, expert, expert - rng.permutation(contrasts))


def samples(rng, n=20):
    """Logarithms of the probabilities of some samples, and their features."""
    return rng.normal(size=n), rng.normal(size=n), rng.normal(size=(n, 3))


@pytest.mark.part("5.5", points=2)
def test_reweighted_samples(answer, rng):
    """Finds the estimate where few weights are clipped."""
    for _ in range(6):
        answer.agrees(*samples(rng), 3.0, at=0)


@pytest.mark.part("5.5", points=1)
def test_reweighted_samples_and_their_size(answer, rng):
    """Finds the effective sample size where few weights are clipped."""
    for _ in range(6):
        answer.agrees(*samples(rng), 3.0, at=1)


@pytest.mark.part("5.5", points=1)
def test_reweighted_samples_without_a_cut(answer, rng):
    """Returns the plain estimate where no weight is clipped, and the mean where all weights are equal."""
    for _ in range(3):
        answer.agrees(*samples(rng, 12), 1000.0)
    log_p, _, features = samples(rng, 9)
    answer.agrees(log_p, log_p - 2, features, 1.0)


@pytest.mark.part("5.5", points=1)
def test_reweighted_samples_of_very_different_probability(answer, rng):
    """Stays finite where some samples are far less probable than others under both policies."""
    for _ in range(3):
        both = rng.uniform(-4000, 0, size=15)
        answer.agrees(
            both + rng.normal(size=15),
            both + rng.normal(size=15),
            rng.normal(size=(15, 3)),
            2.0,
        )


@pytest.mark.part("5.5", points=1)
def test_reweighted_samples_far_from_zero(answer, rng):
    """Stays finite where the logarithms are in the thousands."""
    for shift in (-4000.0, 3000.0):
        answer.agrees(
            shift + rng.normal(size=15),
            2 * shift + rng.normal(size=15),
            rng.normal(size=(15, 3)),
            2.0,
        )


def imitation(rng):
    """The actions of an expert, and of a policy that usually agrees."""
    often = rng.choice(4, p=[0.7, 0.1, 0.1, 0.1], size=20)
    expert = np.concatenate([np.arange(4), often])
    other = rng.integers(4, size=24)
    return expert, np.where(rng.random(24) < 0.6, expert, other), 4


@pytest.mark.part("5.6", points=1)
def test_accuracies_that_are_plain(answer, rng):
    """Finds the plain accuracy of policies that usually agree with the expert."""
    for _ in range(8):
        answer.agrees(*imitation(rng), at=0)


@pytest.mark.part("5.6", points=1)
def test_accuracies_beyond_chance(answer, rng):
    """Finds the agreement beyond chance of policies that usually agree with the expert."""
    for _ in range(8):
        answer.agrees(*imitation(rng), at=1)


@pytest.mark.part("5.6", points=1)
def test_accuracies_of_always_forward(answer, rng):
    """Returns zero for a policy that always goes forward, also where some actions never occur."""
    for _ in range(4):
        expert = np.concatenate([[0, 2], rng.choice([0, 0, 0, 2, 3], size=15)])
        answer.agrees(expert, np.zeros(17, dtype=int), 6, at=1)
    answer.agrees(np.zeros(9, dtype=int), np.zeros(9, dtype=int), 3, at=1)


MOVES = ((0, 1), (1, 0), (0, -1), (-1, 0))


def terrain(rng, side=7, *, order):
    """A grid whose cells have kinds of terrain, one of them rare and the goal, with moves that slip.

    The features of the kinds stand in this order.
    """
    kinds = len(order)
    kind = rng.integers(kinds - 1, size=(side, side))
    kind[tuple(rng.integers(side, size=2))] = kinds - 1
    transitions = np.zeros((4, side**2, side**2))
    for row, column in np.ndindex(side, side):
        for action in range(4):
            for other in range(4):
                down, right = MOVES[other]
                to = np.clip([row + down, column + right], 0, side - 1) @ [side, 1]
                share = 0.85 if other == action else 0.05
                transitions[action, row * side + column, to] += share
    return transitions, np.eye(kinds)[kind.ravel()][:, order]


def optimal(transitions, reward, discount):
    """The transitions under an optimal policy; of equally good actions, all are taken alike."""
    values = np.zeros(len(reward))
    for _ in range(300):
        values = reward + discount * (transitions @ values).max(axis=0)
    q = transitions @ values
    best = q >= q.max(axis=0) - 1e-9 * (1 + np.abs(q).max())
    return np.einsum("as,ast->st", best / best.sum(axis=0), transitions)


def worth(flow, reward, discount):
    """The mean value over all cells."""
    return np.linalg.solve(np.eye(len(reward)) - discount * flow, reward).mean()


def expert_paths(rng, flow, n=60, length=40):
    """Cells visited in some episodes from random cells."""
    paths = np.empty((n, length), dtype=np.int64)
    paths[:, 0] = rng.integers(len(flow), size=n)
    for t in range(1, length):
        paths[:, t] = [rng.choice(len(flow), p=flow[cell]) for cell in paths[:, t - 1]]
    return paths


def recovered(answer, rng, elsewhere, least):
    """Require a share of the way from a reward of 0 to the expert's in true reward.

    Each grid has another number of kinds of terrain, in another order, so that no weights are right by heart.
    """
    discount, gains, constant = 0.9, [], 0
    for _ in range(4):
        order = rng.permutation(rng.integers(4, 6))
        transitions, features = terrain(rng, order=order)
        theta = np.append(rng.uniform(-1.0, 0.0, size=len(order) - 1), 1.0)[order]
        flow = optimal(transitions, features @ theta, discount)
        got = answer.ask(transitions, features, expert_paths(rng, flow), discount)
        weights = as_numbers(got)
        fits = (
            weights is not None
            and weights.shape == theta.shape
            and bool(np.isfinite(weights).all())
        )
        answer.check(fits, f"the answer must be {len(theta)} finite weights")
        # The scale of a reward changes no policy, and a huge one would overflow.
        weights = weights / max(1.0, np.abs(weights).max())
        constant += bool(np.ptp(weights) < 1e-9)
        if elsewhere:
            transitions, features = terrain(rng, order=order)
        reward = features @ theta
        worths = [
            worth(optimal(transitions, features @ w, discount), reward, discount)
            for w in (weights, theta, np.zeros(len(theta)))
        ]
        gains.append([worths[0] - worths[2], worths[1] - worths[2]])
    own, expert = np.sum(gains, axis=0)
    reached = int(100 * own / expert)
    shares = ", ".join(f"{100 * mine / best:.0f}" for mine, best in gains)
    harmful = sum(mine < 0 for mine, _ in gains)
    answer.check(
        reached >= least,
        f"expected {least} % of the expert's gain, got {reached} %; in the four grids {shares} %",
        "All your weights are equal in some grids. Such a reward is constant: under it every policy is optimal, so it "
        "explains every expert and says nothing about this one."
        if constant
        else "In some grids the robot does worse than one that goes anywhere. Look at the sign of the weights: a kind of "
        "cell that the expert visits more often than the robot needs a larger weight."
        if harmful
        else "No grid is worse than with a reward of 0. Look at how close the feature expectations of an optimal policy "
        "come to the expert's, and let the search go on until they are close.",
    )


@pytest.mark.part("5.7", points=3)
def test_recover_something(answer, rng):
    """Gains half as much true reward as the expert does over a robot that goes anywhere."""
    recovered(answer, rng, False, 50)


@pytest.mark.part("5.7", points=4)
def test_recover_the_demonstrations(answer, rng):
    """Gains nearly as much true reward as the expert does, 95 %."""
    recovered(answer, rng, False, 95)


@pytest.mark.part("5.7", points=3)
def test_recover_the_reward(answer, rng):
    """Gains nine tenths as much true reward as an expert in another grid, where only the reward helps."""
    recovered(answer, rng, True, 90)
