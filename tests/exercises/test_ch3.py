"""Chapter 3: the parts of each exercise. A docstring's first line is what the student reads."""

from itertools import pairwise

import numpy as np
import pytest

from robonav.grading.compare import as_numbers


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


@pytest.mark.part("3.2", points=1)
def test_encode_readings(answer, rng):
    """Finds the degrees of danger for ranges of 10 m, 30 cm and others."""
    for reach in (10.0, 0.3, 3.0, 25.0):
        answer.agrees(*readings(rng, reach), at=np.s_[:, :9])


@pytest.mark.part("3.2", points=2)
def test_encode_all_around(answer, rng):
    """Gives the region of targets in all directions, also where the bearing contains full turns."""
    for turns in (-1, 0, 2):
        bearings = np.radians(40.0 * np.arange(9) + 360 * turns) + rng.uniform(
            -0.3, 0.3, size=9
        )
        ranges, _, distance, reach = readings(rng, 10.0, 9)
        answer.agrees(ranges, bearings, distance, reach, at=np.s_[:, 9])


@pytest.mark.part("3.2", points=1)
def test_encode_whether_the_target_is_seen(answer, rng):
    """Tells whether the target is in range, also at exactly the range."""
    for reach in (30.0, 8.0):
        ranges, bearing, distance, _ = readings(rng, reach)
        distance[0] = reach
        answer.agrees(ranges, bearing, distance, reach, at=np.s_[:, 10])


@pytest.mark.part("3.2", points=1)
def test_encode_on_the_borders(answer, rng):
    """Gives a reading on a border the lesser danger."""
    borders = np.array([3.0, 7.0, 11.0, 15.0, 20.0, 25.0, 30.0])
    answer.agrees(
        rng.choice(borders, size=(6, 9)),
        np.zeros(6),
        rng.uniform(0, 60, size=6),
        30.0,
        at=np.s_[:, :9],
    )


def examples(rng, m, n, k):
    return rng.normal(size=(m, n)), rng.integers(k, size=m)


@pytest.mark.part("3.3", points=1)
def test_gradients_of_the_last_layer(answer, rng):
    """Finds the derivatives of the last layer, without weight decay."""
    for _ in range(5):
        answer.agrees(network(rng, 4, 5, 3), *examples(rng, 7, 4, 3), 0.0, at=-1)


@pytest.mark.part("3.3", points=1)
def test_gradients_of_the_hidden_layer(answer, rng):
    """Propagates the error back through one hidden layer, without weight decay."""
    for _ in range(5):
        answer.agrees(network(rng, 4, 5, 3), *examples(rng, 7, 4, 3), 0.0, at=0)


@pytest.mark.part("3.3", points=2)
def test_gradients_with_decay(answer, rng):
    """Applies weight decay to the weights but not to the biases."""
    for _ in range(5):
        answer.agrees(
            network(rng, 3, 4, 3), *examples(rng, 6, 3, 3), rng.uniform(0.5, 2)
        )


@pytest.mark.part("3.3", points=1)
def test_gradients_through_two_hidden_layers(answer, rng):
    """Propagates the error back through two hidden layers."""
    for _ in range(3):
        answer.agrees(network(rng, 3, 5, 4, 3), *examples(rng, 6, 3, 3), 0.3)


@pytest.mark.part("3.3", points=3)
def test_gradients_of_a_large_network(answer, rng):
    """Is fast with 4,000 weights and a thousand examples, for which differences take too long."""
    weights = network(rng, 30, 60, 35, 5, scale=0.2)
    answer.agrees(weights, *examples(rng, 1000, 30, 5), 0.1)


def in_the_open(rng):
    """A pose with room around it, and what costs how much."""
    pose = np.array([*rng.uniform(40, 60, size=2), rng.uniform(-np.pi, np.pi)])
    costs = rng.uniform(1, 4), rng.uniform(0.2, 2)
    return pose, *costs, np.zeros((0, 2)), np.zeros(0), 100.0, 1.0


PLACES = np.s_[:, :3]  # which action leads where
POSES, COSTS = np.s_[:, :4], np.s_[:, 4]


@pytest.mark.part("3.4", points=1)
def test_successors_in_the_open(answer, rng):
    """Finds the poses after all five actions where nothing is near."""
    for _ in range(8):
        answer.agrees(*in_the_open(rng), at=POSES)


@pytest.mark.part("3.4", points=1)
def test_successors_and_their_costs(answer, rng):
    """Finds the costs of all five actions where nothing is near."""
    for _ in range(8):
        answer.agrees(*in_the_open(rng), at=COSTS)


@pytest.mark.part("3.4", points=2)
def test_successors_among_obstacles(answer, rng):
    """Leaves out steps that come too near to an obstacle between their ends."""
    for _ in range(15):
        pose = np.array([50.0, 50.0, rng.uniform(-np.pi, np.pi)])
        far, around = rng.uniform(0.8, 6, size=4), rng.uniform(-np.pi, np.pi, size=4)
        centres = pose[:2] + far[:, None] * np.column_stack(
            [np.cos(around), np.sin(around)]
        )
        radii = rng.uniform(0.1, 0.4, size=4)
        answer.agrees(pose, 4.0, 0.5, centres, radii, 100.0, 0.3, at=PLACES)


@pytest.mark.part("3.4", points=1)
def test_successors_by_the_border(answer, rng):
    """Keeps the margin to the borders of the map."""
    for _ in range(12):
        pose = np.array([*rng.uniform(1.2, 4, size=2), rng.uniform(-np.pi, np.pi)])
        pose[:2] = np.where(rng.random(2) < 0.5, pose[:2], 20 - pose[:2])
        nothing = np.zeros((0, 2)), np.zeros(0)
        answer.agrees(pose, 3.0, 1.0, *nothing, 20.0, 1.0, at=PLACES)


@pytest.mark.part("3.4", points=1)
def test_successors_where_there_are_none(answer, rng):
    """Returns no row where no action is possible, and allows a step that keeps exactly the margin."""
    for beside, margin in (([0.0, 1.0], 0.5), ([1.0, 2.0], 1.0)):
        place = rng.integers(6, 15, size=2).astype(float)
        obstacle = place[None] + beside, np.ones(1)
        pose, turn_cost = np.append(place, 0.0), rng.uniform(0.5, 2)
        answer.agrees(pose, 2.0, turn_cost, *obstacle, 20.0, margin, at=PLACES)


def demonstration(rng, length, few=3):
    """States that repeat and are often safe, and their actions."""
    kinds = rng.integers(8, size=(few, 11)) * (rng.random((few, 11)) < 0.3)
    kinds[0, :9] = 0
    kinds[1:, 0] += 1
    kinds[:, 9], kinds[:, 10] = rng.integers(1, 10, size=few), rng.integers(2, size=few)
    elsewhere = kinds[1].copy()  # the same dangers, and the target in another region
    elsewhere[9] = elsewhere[9] % 9 + 1
    beyond = kinds[1].copy()  # ... or in the same region and no longer seen
    beyond[10] = 1 - beyond[10]
    kinds, few = np.vstack([kinds, elsewhere, beyond]), few + 2
    return kinds[rng.integers(few, size=length)], rng.integers(2, size=length)


@pytest.mark.part("3.5", points=2)
def test_effective_pairs(answer, rng):
    """Keeps the pairs with something in range, without repetitions, in their order."""
    for _ in range(10):
        answer.agrees(*demonstration(rng, 40))


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
    states, labels = known(rng, 6)  # a full memory, and nothing new
    answer.agrees(states, labels, states[[4, 2, 5]], rng.integers(5, size=3), 6)


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


@pytest.mark.part("3.7", points=2)
def test_cheapest_where_turning_is_dear(answer, rng):
    """Finds the cheapest path where a turn costs more than a move, so that a node's first path need not be its best."""
    for _ in range(50):
        turn_cost = round(rng.uniform(2.5, 6.0), 2)
        start = (0, 0, int(rng.integers(8)))
        answer.agrees(maze(rng, 12, 12, 0.15), start, (11, 11), turn_cost)


@pytest.mark.part("3.7", points=3)
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
    blocked = np.zeros((5, 6), dtype=bool)
    wall = int(rng.integers(2, 5))
    blocked[:, wall] = True
    row, goal, heading = (int(rng.integers(n)) for n in (5, 5, 8))
    turn_cost = round(rng.uniform(0.2, 1.0), 3)
    for cell in ((goal, 5), (row, 0), (goal, wall)):  # beyond it, here, and inside
        answer.agrees(blocked, (row, 0, heading), cell, turn_cost)


@pytest.mark.part("3.7", points=1)
def test_cheapest_across_a_large_map(answer, rng):
    """Ends in time on a map of 25 by 25 cells."""
    answer.agrees(maze(rng, 25, 25, 0.15), (0, 0, 1), (24, 24), 0.3)


def expert_action(sensing):
    """Turn away from what is ahead, to the side with more room, and more sharply if it is near."""
    from robonav.robot import Action

    left, right = (
        sensing.ranges[:, side].min(axis=1) for side in (slice(1, 3), slice(7, 9))
    )
    near = sensing.ranges[:, 0] < 4
    turn_left = np.where(near, Action.L60, Action.L30)
    turn_right = np.where(near, Action.R60, Action.R30)
    turn = np.where(left > right, turn_left, turn_right)
    return np.where(sensing.ranges[:, 0] < 7, turn, Action.F)


def recorded(rng, worlds):
    """The expert's effective steps in some worlds: inputs and labels."""
    from robonav.robot import Encoder, navigate, random_worlds

    steps, encoder = [], Encoder()

    def expert(sensing, generator):
        actions = expert_action(sensing)
        effective = (sensing.ranges < 10).any(axis=1)
        steps.append((encoder(sensing)[effective], actions[effective]))
        return actions

    navigate(expert, random_worlds(worlds, 15, seed=rng))
    inputs, labels = zip(*steps, strict=True)
    return np.concatenate(inputs), np.concatenate(labels).astype(np.int64)


def wired(inputs, order):
    """The inputs of a robot whose range sensors are wired in this order. Weights for another robot are of no use."""
    return np.hstack([inputs[:, order], inputs[:, 9:]])


def outputs(weights, inputs):
    for layer in weights[:-1]:
        inputs = np.tanh(layer[:, 0] + inputs @ layer[:, 1:].T)
    return weights[-1][:, 0] + inputs @ weights[-1][:, 1:].T


def trained(answer, inputs, labels):
    """The weights that the student's function returns, as a network from 12 inputs to five outputs."""
    got = answer.ask(inputs, labels)
    weights, units = [], 12
    for layer in got if isinstance(got, list | tuple) else []:
        array = as_numbers(layer)
        fits = array is not None and array.ndim == 2 and array.shape[1] == units + 1
        answer.check(
            fits and bool(np.isfinite(array).all()),
            "each layer must hold finite numbers, in a column for the bias and one for each unit before",
        )
        weights.append(array)
        units = len(array)
    answer.check(
        bool(weights) and units == 5,
        "the answer must be a list of layers, the last of five rows",
    )
    return weights


def turned_wrong(agreed, ahead, other):
    """What a robot that turns to the expert's side too seldom suggests to look at."""
    if other > agreed and other > ahead:
        return (
            "The robot mostly turns to the other side. Look at whether the labels and the rows of the last layer "
            "are the same actions, and whether each step of the training lowers the cost."
        )
    if ahead > other:
        return (
            "Where the robot does not turn with the expert, it mostly goes ahead. If it never turns, look at whether "
            "the weights change in the training: equal units stay equal, and a strong decay keeps weights near zero. "
            "If it turns too seldom, train longer, or let the turns count for more, which are rare in the labels."
        )
    return (
        "The robot turns to the wrong side too often. Look at whether each step of the training lowers the cost, "
        "and whether the weights have been trained long enough."
    )


@pytest.mark.part("3.8", points=4)
def test_imitate_the_expert(answer, rng):
    """Turns to the expert's side in two of three new steps in which the expert turns."""
    order = rng.permutation(9)
    inputs, labels = recorded(rng, 20)
    weights = trained(answer, wired(inputs, order), labels)
    inputs, labels = recorded(rng, 30)
    turns = labels > 0
    chosen = outputs(weights, wired(inputs[turns], order)).argmax(axis=1)
    side = np.array([0, 1, 1, -1, -1])
    agreed = int(100 * (side[chosen] == side[labels[turns]]).mean())
    ahead = int(100 * (chosen == 0).mean())
    other = 100 - agreed - ahead
    answer.check(
        agreed >= 65,
        f"expected the same side in 65 of 100 turns, got {agreed}; the robot goes ahead in {ahead} "
        f"and turns to the other side in {other}",
        turned_wrong(agreed, ahead, other),
    )


@pytest.mark.part("3.8", points=6)
def test_imitate_and_drive(answer, rng):
    """Arrives in four of five new worlds with ten obstacles; a robot that goes straight arrives in two of five."""
    from robonav.grading.episode_outcomes import require_arrivals
    from robonav.robot import Encoder, navigate, random_worlds

    order, encoder = rng.permutation(9), Encoder()
    inputs, labels = recorded(rng, 20)
    weights = trained(answer, wired(inputs, order), labels)

    def policy(sensing, generator):
        return outputs(weights, wired(encoder(sensing), order)).argmax(axis=1)

    require_arrivals(
        answer,
        navigate(policy, random_worlds(100, 10, seed=rng)).outcome,
        80,
        collided="Look at whether the robot turns where something is near, and to which side: "
        "turns are rare in the demonstrations, so a network that goes ahead is right in most steps.",
        late="Look at whether the robot turns where nothing "
        "is near, or turns to and fro: a network with few errors on the steps it was trained on may have learnt them by heart.",
    )
