"""Chapter 3: the parts of each exercise. A docstring's first line is what the student reads."""

from itertools import pairwise

import numpy as np
import pytest


def network(rng, *sizes, scale=1.0):
    """Weights of a network of these sizes, the bias in column 0."""
    return [
        scale * rng.normal(size=(after, before + 1))
        for before, after in pairwise(sizes)
    ]


@pytest.mark.part("3.1", points=2)
def test_forward_through_one_hidden_layer(answer, rng):
    """Agrees with the definition on networks with one hidden layer."""
    for _ in range(8):
        answer.agrees(network(rng, 4, 5, 3), rng.normal(size=(6, 4)))


@pytest.mark.part("3.1", points=1)
def test_forward_through_any_depth(answer, rng):
    """Works without a hidden layer and with several."""
    for sizes in ((3, 4), (3, 6, 5, 2), (2, 3, 3, 3, 4)):
        answer.agrees(network(rng, *sizes), rng.normal(size=(5, sizes[0])))


@pytest.mark.part("3.1", points=1)
def test_forward_of_large_inputs(answer, rng):
    """Stays finite where the weighted sums are in the thousands."""
    for _ in range(5):
        answer.agrees(network(rng, 3, 4, scale=300.0), 10 * rng.normal(size=(4, 3)))


def readings(rng, reach, n=8):
    """Ranges, bearings and distances; no bearing lies within a degree of a region's border."""
    bearings = np.radians(
        40 * rng.integers(-12, 13, size=n) + rng.uniform(-19, 19, size=n)
    )
    return (
        rng.uniform(0, 1.1 * reach, size=(n, 9)),
        bearings,
        rng.uniform(0, 2 * reach, size=n),
        reach,
    )


@pytest.mark.part("3.2", points=2)
def test_encode_readings(answer, rng):
    """Agrees with the definition for ranges of 10 m, 30 cm and others."""
    for reach in (10.0, 0.3, 3.0, 25.0):
        answer.agrees(*readings(rng, reach))


@pytest.mark.part("3.2", points=2)
def test_encode_all_around(answer, rng):
    """Gives the region of targets in all directions, also where the bearing contains full turns."""
    for turns in (-1, 0, 2):
        bearings = np.radians(40.0 * np.arange(9) + 360 * turns) + rng.uniform(
            -0.3, 0.3, size=9
        )
        answer.agrees(np.full((9, 9), 5.0), bearings, np.full(9, 20.0), 10.0)


@pytest.mark.part("3.2", points=1)
def test_encode_on_the_borders(answer, rng):
    """Gives a reading on a border the lesser danger, and counts a target at exactly the range as in range."""
    borders = np.array([3.0, 7.0, 11.0, 15.0, 20.0, 25.0, 30.0])
    answer.agrees(
        rng.choice(borders, size=(6, 9)),
        np.zeros(6),
        np.array([29.0, 30.0, 31.0, 30.0, 0.0, 30.5]),
        30.0,
    )


def examples(rng, m, n, k):
    return rng.normal(size=(m, n)), rng.integers(k, size=m)


@pytest.mark.part("3.3", points=3)
def test_gradients_without_decay(answer, rng):
    """Agrees with the definition on networks with one hidden layer, without weight decay."""
    for _ in range(5):
        answer.agrees(network(rng, 4, 5, 3), *examples(rng, 7, 4, 3), 0.0)


@pytest.mark.part("3.3", points=2)
def test_gradients_with_decay(answer, rng):
    """Applies weight decay to the weights but not to the biases."""
    for _ in range(5):
        answer.agrees(
            network(rng, 3, 4, 3), *examples(rng, 6, 3, 3), rng.uniform(0.5, 2)
        )


@pytest.mark.part("3.3", points=2)
def test_gradients_through_two_hidden_layers(answer, rng):
    """Propagates the error back through two hidden layers."""
    for _ in range(3):
        answer.agrees(network(rng, 3, 5, 4, 3), *examples(rng, 6, 3, 3), 0.3)


def cost(weights, inputs, labels, decay):
    for number, layer in enumerate(weights):
        z = layer[:, 0] + inputs @ layer[:, 1:].T
        inputs = np.tanh(z) if number < len(weights) - 1 else z
    log_p = z - np.log(np.exp(z).sum(axis=1, keepdims=True))
    decays = decay / 2 * sum((layer[:, 1:] ** 2).sum() for layer in weights)
    return (decays - log_p[np.arange(len(labels)), labels].sum()) / len(labels)


@pytest.mark.part("3.3", points=1)
def test_gradients_against_differences(answer, rng):
    """Predicts how the cost changes along a random direction."""
    for _ in range(3):
        weights, data = network(rng, 3, 4, 2), examples(rng, 5, 3, 2)
        slopes = answer.agrees(weights, *data, 0.5)
        direction = [rng.normal(size=layer.shape) for layer in weights]
        after, before = (
            [w + sign * 1e-5 * v for w, v in zip(weights, direction, strict=True)]
            for sign in (1, -1)
        )
        measured = (cost(after, *data, 0.5) - cost(before, *data, 0.5)) / 2e-5
        predicted = sum(
            (np.asarray(slope, dtype=float) * v).sum()
            for slope, v in zip(slopes, direction, strict=True)
        )
        answer.check(
            abs(predicted - measured) < 1e-4 * (1 + abs(measured)),
            "a measured derivative differs",
        )


@pytest.mark.part("3.4", points=2)
def test_successors_in_the_open(answer, rng):
    """Returns all five actions where nothing is near, each with its pose and its cost."""
    for _ in range(8):
        pose = np.array([*rng.uniform(40, 60, size=2), rng.uniform(-np.pi, np.pi)])
        answer.agrees(
            pose,
            rng.uniform(1, 4),
            rng.uniform(0.2, 2),
            np.zeros((0, 2)),
            np.zeros(0),
            100.0,
            1.0,
        )


@pytest.mark.part("3.4", points=2)
def test_successors_among_obstacles(answer, rng):
    """Leaves out steps that come too near to an obstacle between their ends."""
    for _ in range(15):
        pose = np.array([50.0, 50.0, rng.uniform(-np.pi, np.pi)])
        far, around = rng.uniform(0.8, 4.5, size=4), rng.uniform(-np.pi, np.pi, size=4)
        centres = pose[:2] + far[:, None] * np.column_stack(
            [np.cos(around), np.sin(around)]
        )
        answer.agrees(
            pose, 4.0, 0.5, centres, rng.uniform(0.1, 0.4, size=4), 100.0, 0.3
        )


@pytest.mark.part("3.4", points=1)
def test_successors_by_the_border(answer, rng):
    """Keeps the margin to the borders of the map."""
    for _ in range(12):
        pose = np.array([*rng.uniform(1.2, 4, size=2), rng.uniform(-np.pi, np.pi)])
        pose[:2] = np.where(rng.random(2) < 0.5, pose[:2], 20 - pose[:2])
        answer.agrees(pose, 3.0, 1.0, np.zeros((0, 2)), np.zeros(0), 20.0, 1.0)


@pytest.mark.part("3.4", points=1)
def test_successors_where_there_are_none(answer, rng):
    """Returns no row where no action is possible, and allows a step that keeps exactly the margin."""
    answer.agrees(
        np.array([10.0, 10.0, 0.0]),
        2.0,
        1.0,
        np.array([[10.0, 11.0]]),
        np.array([1.0]),
        20.0,
        0.5,
    )
    answer.agrees(
        np.array([10.0, 10.0, 0.0]),
        2.0,
        1.0,
        np.array([[14.0, 10.0]]),
        np.array([1.0]),
        20.0,
        1.0,
    )


def demonstration(rng, length, few=3):
    """States that repeat and are often safe, and their actions."""
    kinds = rng.integers(8, size=(few, 11)) * (rng.random((few, 11)) < 0.3)
    kinds[0, :9] = 0
    kinds[1:, 0] += 1
    kinds[:, 9], kinds[:, 10] = rng.integers(1, 10, size=few), rng.integers(2, size=few)
    return kinds[rng.integers(few, size=length)], rng.integers(2, size=length)


@pytest.mark.part("3.5", points=2)
def test_effective_pairs(answer, rng):
    """Keeps the pairs with something in range, without repetitions, in their order."""
    for _ in range(10):
        answer.agrees(*demonstration(rng, 25))


@pytest.mark.part("3.5", points=1)
def test_no_effective_pairs(answer, rng):
    """Keeps no pair if nothing was in range, or if there are no steps."""
    for length in (6, 0):
        states, actions = demonstration(rng, length)
        states[:, :9] = 0
        answer.agrees(states, actions)


def known(rng, n, k=2):
    """States, all different, and their labels."""
    cells = rng.permutation(4**k)[:n]
    return np.stack(np.unravel_index(cells, (4,) * k), axis=1).reshape(
        n, k
    ), rng.integers(5, size=n)


@pytest.mark.part("3.6", points=2)
def test_aggregate_new_states(answer, rng):
    """Adds new states with the expert's labels."""
    for _ in range(5):
        states, labels = known(rng, 12)
        answer.agrees(states[:6], labels[:6], states[6:], labels[6:], 100)


@pytest.mark.part("3.6", points=2)
def test_aggregate_known_states(answer, rng):
    """Replaces the labels of states already in the data, and ignores labels of -1."""
    for _ in range(8):
        answer.agrees(
            *known(rng, 8),
            rng.integers(4, size=(10, 2)),
            rng.integers(-1, 5, size=10),
            100,
        )


@pytest.mark.part("3.6", points=2)
def test_aggregate_beyond_the_memory(answer, rng):
    """Removes the oldest pairs when there are too many."""
    for capacity in (1, 4, 7):
        answer.agrees(
            *known(rng, 6),
            rng.integers(4, size=(9, 2)),
            rng.integers(-1, 5, size=9),
            capacity,
        )
    answer.agrees(
        *known(rng, 5), np.zeros((0, 2), dtype=int), np.zeros(0, dtype=int), 3
    )


def maze(rng, rows, columns, share):
    """Blocked cells, with the corners free."""
    blocked = rng.random((rows, columns)) < share
    blocked[0, 0] = blocked[-1, -1] = False
    return blocked


@pytest.mark.part("3.7", points=4)
def test_cheapest_in_the_open(answer, rng):
    """Finds the cheapest path in rooms without obstacles."""
    for _ in range(8):
        rows, columns = rng.integers(3, 7, size=2)
        goal = (int(rng.integers(rows)), int(rng.integers(columns)))
        start = (
            int(rng.integers(rows)),
            int(rng.integers(columns)),
            int(rng.integers(8)),
        )
        answer.agrees(
            np.zeros((rows, columns), dtype=bool),
            start,
            goal,
            round(rng.uniform(0.2, 1.5), 2),
        )


@pytest.mark.part("3.7", points=5)
def test_cheapest_through_mazes(answer, rng):
    """Finds the cheapest path around obstacles without cutting corners."""
    for _ in range(12):
        blocked = maze(rng, 7, 8, 0.3)
        answer.agrees(
            blocked,
            (0, 0, int(rng.integers(8))),
            (6, 7),
            round(rng.uniform(0.1, 1.0), 2),
        )


@pytest.mark.part("3.7", points=2)
def test_cheapest_without_a_path(answer, rng):
    """Returns infinity where there is no path, and 0 where the start is at the goal."""
    blocked = np.zeros((4, 4), dtype=bool)
    blocked[:, 2] = True
    answer.agrees(blocked, (0, 0, 0), (3, 3), 0.5)
    answer.agrees(blocked, (1, 1, 3), (1, 1), 0.5)


@pytest.mark.part("3.7", points=1)
def test_cheapest_across_a_large_map(answer, rng):
    """Ends in time on a map of 25 by 25 cells."""
    answer.agrees(maze(rng, 25, 25, 0.15), (0, 0, 1), (24, 24), 0.3)
