"""Chapter 6: the parts of each exercise. A docstring's first line is what the student reads."""

import numpy as np
import pytest

from robonav.grading.compare import as_numbers


def field(rng, n, *, rho=(0.3, 2.5), d=(0.5, 20.0)):
    """A robot with its target and n circles, whose edges lie at distances rho from it; inside a circle rho < 0."""
    place, fading = rng.uniform(-10, 10, size=2), rng.uniform(3.0, 6.0)
    radii = rng.uniform(0.8, 2.0, size=n)
    around = rng.uniform(0, 2 * np.pi, size=n + 1)
    ways = np.column_stack([np.cos(around), np.sin(around)])
    far = rng.uniform(*rho, size=n) + radii
    middles = place + far[:, None] * ways[1:]
    target = place + rng.uniform(*d) * ways[0]
    circles = np.column_stack([middles, radii])
    strengths = rng.uniform(0.5, 2.0), fading, rng.uniform(1.0, 5.0)
    return place, target, circles, *strengths, rng.uniform(2.6, 3.5)


@pytest.mark.part("6.1", points=1)
def test_force_of_a_far_target(answer, rng):
    """Finds the attraction of a target that is farther away than d*."""
    for n in (1, 2, 3):
        answer.agrees(*field(rng, n, d=(7.0, 20.0)), at=0)


@pytest.mark.part("6.1", points=1)
def test_force_of_a_near_target(answer, rng):
    """Finds the attraction of a target that is nearer than d*, and none at the target."""
    for n in (1, 2, 3):
        answer.agrees(*field(rng, n, d=(0.3, 2.5)), at=0)
    place, _, *others = field(rng, 2)
    answer.agrees(place, place.copy(), *others, at=0)


@pytest.mark.part("6.1", points=1)
def test_force_of_one_circle(answer, rng):
    """Finds the repulsion of one circle, in reach and beyond it."""
    for _ in range(3):
        answer.agrees(*field(rng, 1), at=1)
        answer.agrees(*field(rng, 1, rho=(4.0, 9.0)), at=1)


@pytest.mark.part("6.1", points=1)
def test_force_of_several_circles(answer, rng):
    """Adds up the forces of several circles."""
    for n in (2, 3, 5):
        answer.agrees(*field(rng, n), at=1)
        answer.agrees(*field(rng, n, rho=(0.3, 6.0)), at=1)


@pytest.mark.part("6.1", points=1)
def test_force_at_an_edge(answer, rng):
    """Counts a distance of 0.1 m where the robot is nearer to an edge, or inside a circle."""
    for rho in ((0.01, 0.09), (-0.5, -0.1), (0.01, 0.09)):
        answer.agrees(*field(rng, 1, rho=rho), at=1)


def binned(rng, bins=24, *, opening=0.5):
    """A histogram and what was before, with whole numbers of which some are the thresholds themselves."""
    histogram = rng.integers(1, 10, size=bins) / 2
    histogram[rng.random(bins) < opening] = 0.5
    blocked = rng.random(bins) < 0.5
    target, last = rng.choice(np.arange(1, bins // 2), size=2, replace=False)
    weights = rng.uniform(1.0, 5.0, size=3).round(3)
    return histogram, blocked, 1.75, 3.25, int(target), int(last), weights


@pytest.mark.part("6.2", points=1)
def test_direction_and_two_thresholds(answer, rng):
    """Finds which bins are blocked where some lie between the thresholds."""
    for _ in range(3):
        answer.agrees(*binned(rng), at=0)


@pytest.mark.part("6.2", points=1)
def test_direction_at_the_thresholds(answer, rng):
    """Finds which bins are blocked where some have exactly the magnitude of a threshold."""
    for _ in range(3):
        histogram, blocked, _, _, *others = binned(rng, 40, opening=0.1)
        answer.agrees(histogram, blocked, 2.0, 3.5, *others, at=0)


@pytest.mark.part("6.2", points=2)
def test_direction_and_its_cost(answer, rng):
    """Finds the cost of every bin, on both sides of the heading."""
    for _ in range(3):
        *others, target, last, weights = binned(rng)
        answer.agrees(*others, target, last, weights, at=1)
        answer.agrees(*others, 24 - target, 24 - last, weights, at=1)


@pytest.mark.part("6.2", points=1)
def test_direction_where_costs_are_equal(answer, rng):
    """Chooses the free bin of the least cost, and of several the one with the lowest number."""
    for _ in range(4):
        answer.agrees(*binned(rng, opening=0.2), at=2)
    for _ in range(12):
        histogram, blocked, low, high, *_ = binned(rng, opening=0.2)
        histogram[1:] = np.minimum(histogram[1:], histogram[:0:-1])
        blocked[1:] = blocked[:0:-1]
        histogram[0], weights = 9.0, rng.integers(1, 5, size=3).astype(float)
        target, last = map(int, rng.choice([0, 12], size=2))
        answer.agrees(histogram, blocked, low, high, target, last, weights, at=2)


@pytest.mark.part("6.2", points=1)
def test_direction_where_none_is_free(answer, rng):
    """Chooses the only bin that is free, and says so where there is none."""
    for _ in range(4):
        histogram, *others = binned(rng, opening=0.0)
        alone = np.where(np.arange(24) == rng.integers(1, 24), 0.0, histogram + 4.0)
        answer.agrees(alone, *others, at=2)
        answer.agrees(histogram + 4.0, *others, at=2)


def followed(rng, steps=12, *, nearest=0, on_the_line=True, blocked=0.0):
    """Places beside the line from a start to a target: how far along, and how far aside, all in whole numbers."""
    along = np.array([0, 0])
    while not along.any():
        along = rng.integers(-3, 4, size=2)
    aside = np.array([-along[1], along[0]])
    p = rng.integers(nearest, 9, size=steps + 1)
    q = rng.choice([-3, -2, -1, 1, 2, 3] + [0, 0] * on_the_line, size=steps + 1)
    p[0], q[0] = 3, 0
    if nearest > p[0]:
        p[1] = 1  # else the first step ends nearer
    start = rng.integers(3, 9, size=2)
    path = start + p[:, None] * along + q[:, None] * aside
    free = rng.random(steps + 1) >= blocked
    return path, free, start, start + 9 * along


@pytest.mark.part("6.3", points=1)
def test_leave_across_the_line(answer, rng):
    """Finds the first step across the line that ends nearer to the target, where all places are free."""
    for _ in range(12):
        answer.agrees(*followed(rng, nearest=5, on_the_line=False))


@pytest.mark.part("6.3", points=1)
def test_leave_on_the_line(answer, rng):
    """Finds the first step that meets the line where some end on it."""
    for _ in range(16):
        answer.agrees(*followed(rng, nearest=5))


@pytest.mark.part("6.3", points=1)
def test_leave_nearer(answer, rng):
    """Does not leave where the robot is not nearer to the target than where it met the obstacle."""
    for _ in range(24):
        answer.agrees(*followed(rng))


@pytest.mark.part("6.3", points=1)
def test_leave_where_the_way_is_free(answer, rng):
    """Does not leave where the way is not free. Returns -1 where the robot goes on to the end."""
    for _ in range(24):
        answer.agrees(*followed(rng, 30, blocked=0.5))
        answer.agrees(*followed(rng, 30, blocked=0.85))
        answer.agrees(*followed(rng, 4, blocked=0.8))


def recorded(rng, steps, robots, *, lasting=False, terminates=0.0, late=0.0):
    """What some robots recorded, with the shares of the steps that end an episode in one of the two ways."""
    shape = steps, robots
    rewards, values, next_values = rng.normal(size=(3, *shape))
    chance = rng.random(shape)
    terminated = chance < terminates
    truncated = ~terminated & (chance < terminates + late)
    going_on = ~(terminated | truncated)[:-1]
    next_values[:-1][going_on] = values[1:][going_on]
    seconds = rng.uniform(0.3, 3.0, size=shape) if lasting else np.ones(shape)
    table = [rewards, values, next_values, seconds, terminated, truncated]
    return *(one[:] for one in table), rng.uniform(0.6, 0.9), rng.uniform(0.4, 0.9)


@pytest.mark.part("6.4", points=1)
def test_advantages_without_an_end(answer, rng):
    """Finds the advantages where each step lasts a second and no episode ends."""
    for robots in (1, 3):
        answer.agrees(*recorded(rng, 6, robots))


@pytest.mark.part("6.4", points=2)
def test_advantages_of_long_steps(answer, rng):
    """Finds the advantages where steps last differently long."""
    for _ in range(3):
        answer.agrees(*recorded(rng, 7, 2, lasting=True))


@pytest.mark.part("6.4", points=1)
def test_advantages_of_episodes_that_terminate(answer, rng):
    """Finds the advantages where some episodes terminate."""
    for _ in range(3):
        answer.agrees(*recorded(rng, 12, 3, lasting=True, terminates=0.3))


@pytest.mark.part("6.4", points=1)
def test_advantages_of_episodes_that_the_limit_ends(answer, rng):
    """Finds the advantages where the time limit ends some episodes, and others terminate."""
    for _ in range(3):
        answer.agrees(*recorded(rng, 14, 3, lasting=True, terminates=0.15, late=0.2))


def taken(rng, *, outside=False, entropy=0.0, large=0.0, m=8, k=4):
    """Outputs of a network in recorded steps, whose ratios lie within 15 % of 1, or outside of the interval, too.

    Large outputs are all far from 0, and in half of the steps the last action has the probability 0.
    """
    outputs = rng.normal(size=(m, k)) + large * rng.choice([-1, 1], size=(m, 1))
    outputs[: m // 2, -1] -= large
    shifted = outputs - outputs.max(axis=1, keepdims=True)
    log_policy = shifted - np.log(np.exp(shifted).sum(axis=1, keepdims=True))
    actions = rng.integers(k - 1, size=m) if large else rng.integers(k, size=m)
    change = rng.uniform(-0.15, 0.15, size=m)
    if outside:
        change[: m // 2] = rng.uniform(0.3, 0.8, size=m // 2) * [1, -1, 1, -1]
    log_before = log_policy[np.arange(m), actions] - change
    advantages = rng.normal(size=m)
    advantages[:4] = np.abs(advantages[:4]) * [1, 1, -1, -1]
    return outputs, actions, log_before, advantages, 0.2, entropy


@pytest.mark.part("6.5", points=2)
def test_clipped_value_within_the_interval(answer, rng):
    """Finds the objective where all ratios lie within the interval, without the entropy."""
    for _ in range(3):
        answer.agrees(*taken(rng), at=0)


@pytest.mark.part("6.5", points=2)
def test_clipped_value_outside_the_interval(answer, rng):
    """Finds the objective where some ratios lie outside, and the advantage is positive or negative."""
    for _ in range(3):
        answer.agrees(*taken(rng, outside=True), at=0)


@pytest.mark.part("6.5", points=2)
def test_clipped_gradient_within_the_interval(answer, rng):
    """Finds the gradient where all ratios lie within the interval, without the entropy."""
    for _ in range(3):
        answer.agrees(*taken(rng), at=1)


@pytest.mark.part("6.5", points=2)
def test_clipped_gradient_outside_the_interval(answer, rng):
    """Finds the gradient where some ratios lie outside, and the advantage is positive or negative."""
    for _ in range(3):
        answer.agrees(*taken(rng, outside=True), at=1)


@pytest.mark.part("6.5", points=1)
def test_clipped_with_the_entropy(answer, rng):
    """Adds the entropy with its weight, and its gradient."""
    for _ in range(3):
        answer.agrees(*taken(rng, entropy=rng.uniform(0.5, 2.0)))


@pytest.mark.part("6.5", points=1)
def test_clipped_with_large_outputs(answer, rng):
    """Stays finite where outputs are in the thousands, and some actions have the probability zero."""
    for _ in range(3):
        answer.agrees(*taken(rng, entropy=rng.uniform(0.5, 2.0), large=3000.0))


def pockets(rng, n, depths):
    """Worlds with a pocket across the way, three walls that open towards the robot, in any direction."""
    from robonav.robot import concatenate_worlds, make_world

    worlds = []
    for _ in range(n):
        depth, half = rng.uniform(*depths), rng.uniform(7.0, 11.0)
        turn, middle = rng.uniform(0, 2 * np.pi), np.array([50.0, 50.0])
        along = np.array([np.cos(turn), np.sin(turn)])
        aside = np.array([-along[1], along[0]])
        back = middle + rng.uniform(0, 6) * along + rng.uniform(-3, 3) * aside
        walls = [(*back, 2.0, 2 * half + 2, np.degrees(turn))]
        for side in (-1, 1):
            arm = back - depth / 2 * along + side * half * aside
            walls.append((*arm, depth, 2.0, np.degrees(turn)))
        ends = {"start": middle - 34 * along, "target": middle + 34 * along}
        worlds.append(make_world(rectangles=walls, **ends))
    return concatenate_worlds(worlds)


class Remembering:
    """A policy that asks the student's function, and keeps what each robot remembers.

    ``remembers`` says whether any robot ever got something else back than it had.
    """

    def __init__(self, answer):
        self.answer, self.remembers = answer, False

    def begin(self, simulator, rng):
        memory = np.zeros((len(simulator), 4))

        def select_actions(simulator, sensing, robots):
            x, y, heading = simulator.poses[robots].T
            dx, dy = simulator.worlds.targets[robots].T - (x, y)
            bearing = (np.arctan2(dy, dx) - heading + np.pi) % (2 * np.pi) - np.pi
            got = self.answer.ask(
                sensing.ranges, bearing, np.hypot(dx, dy), memory[robots]
            )
            actions, kept = self.parts(got, len(robots))
            had = memory[robots].copy()
            memory[robots] = kept
            self.remembers = self.remembers or bool((memory[robots] != had).any())
            return actions

        return select_actions

    def parts(self, got, n):
        """The actions and the memories of an answer."""
        two = isinstance(got, list | tuple) and len(got) == 2
        self.answer.check(two, "the answer must be the actions and what is remembered")
        actions, kept = map(as_numbers, got)
        fits = (
            actions is not None
            and actions.dtype.kind in "iu"
            and actions.shape == (n,)
            and bool(np.isin(actions, range(5)).all())
        )
        self.answer.check(
            fits, "the actions must be a whole number from 0 to 4 for each robot"
        )
        fits = (
            kept is not None
            and kept.shape == (n, 4)
            and bool(np.isfinite(kept.astype(float)).all())
        )
        self.answer.check(
            fits, "what is remembered must be four finite numbers for each robot"
        )
        return actions, kept


KEEPS_TOO_NEAR = (
    "Look at how far the robot keeps from walls and obstacles, and above all from one that it follows: a step "
    "is 2 m, no reflex helps, and a corner may lie between the middles of two sectors."
)
LEAVES_TOO_SOON_OR_NEVER = (
    "Look at what the memory says when a robot begins "
    "to follow a wall and when it leaves it: one that forgets too soon stays in the pocket, and one that never "
    "leaves goes round and round."
)
REMEMBERS_NOTHING = (
    "No robot remembers anything: the memory that your function returns is in every step the one that it got, so "
    "it stays 0. Then a robot does the same wherever it senses the same, and comes back into the pocket again and "
    "again. Return, for example, whether it follows a wall and on which side, and read this in the next step."
)


def escapes(answer, worlds, least, *, pocket=True):
    """Require that many of the robots arrive. In a pocket they need a memory."""
    from robonav.grading.episode_outcomes import require_arrivals
    from robonav.robot import navigate

    policy = Remembering(answer)
    outcome = navigate(policy, worlds, max_steps=250, reflex=None).outcome
    collided, late = KEEPS_TOO_NEAR, LEAVES_TOO_SOON_OR_NEVER
    if pocket and not policy.remembers:
        collided, late = REMEMBERS_NOTHING, REMEMBERS_NOTHING
    require_arrivals(answer, outcome, least, collided=collided, late=late)


@pytest.mark.part("6.6", points=3)
def test_escape_from_shallow_pockets(answer, rng):
    """Arrives in 85 of 100 worlds with a pocket of 5 to 9 m; VFH+ arrives in about 20."""
    escapes(answer, pockets(rng, 100, (5.0, 9.0)), 85)


@pytest.mark.part("6.6", points=4)
def test_escape_from_deep_pockets(answer, rng):
    """Arrives in 75 of 100 worlds with a pocket of 10 to 16 m; VFH+ arrives in none."""
    escapes(answer, pockets(rng, 100, (10.0, 16.0)), 75)


@pytest.mark.part("6.6", points=3)
def test_escape_among_obstacles(answer, rng):
    """Arrives in 85 of 100 worlds of ten obstacles; a robot that goes straight arrives in 40."""
    from robonav.robot import random_worlds

    escapes(answer, random_worlds(100, 10, seed=rng), 85, pocket=False)


def outputs_of(layers, inputs):
    """The outputs of a network for some inputs."""
    hidden = np.tanh(layers[0][:, 0] + inputs @ layers[0][:, 1:].T)
    return layers[1][:, 0] + hidden @ layers[1][:, 1:].T


SHAPES = [(16, 13), (5, 17), (16, 13), (1, 17)]


class Actor:
    """A robot whose sensors and motors are wired at random, in signs, too, with a policy and a critic."""

    def __init__(self, rng):
        from robonav.robot import Encoder

        self.rng, self.encoder = rng, Encoder()
        self.sensors, self.motors = rng.permutation(9), rng.permutation(5)
        self.signs = rng.choice([-1.0, 1.0], size=12)
        self.layers = [
            size * rng.normal(size=shape)
            for size, shape in zip((0.3, 0.1) * 2, SHAPES, strict=True)
        ]

    def inputs(self, sensing):
        found = self.encoder(sensing)
        return self.signs * np.hstack([found[:, self.sensors], found[:, 9:]])

    def drive(self, sensing, rng):
        """The policy after the last round."""
        best = outputs_of(self.layers[:2], self.inputs(sensing)).argmax(axis=1)
        return self.motors[best]

    def practised(self, worlds):
        """States, actions, their logarithms, episodes and ends of the steps in which the policy was asked."""
        from robonav.robot import Outcome, Simulator, run_episodes

        simulator, steps = Simulator(worlds, max_steps=150), []

        def select_actions(simulator, sensing, robots):
            now = self.inputs(sensing)
            z = outputs_of(self.layers[:2], now)
            z = z - z.max(axis=1, keepdims=True)
            log_policy = z - np.log(np.exp(z).sum(axis=1, keepdims=True))
            drawn = (log_policy + self.rng.gumbel(size=z.shape)).argmax(axis=1)
            steps.append((robots, now, drawn, log_policy[np.arange(len(z)), drawn]))
            return self.motors[drawn]

        for _ in run_episodes(simulator, select_actions):
            pass
        robots, *columns = (
            np.concatenate(column) for column in zip(*steps, strict=True)
        )
        order = np.argsort(robots, kind="stable")
        episodes = robots[order]
        last = np.append(episodes[1:] != episodes[:-1], True)
        arrived = simulator.outcome[episodes] == Outcome.ARRIVED
        ends = np.where(last, np.where(arrived, 1, -1), 0)
        return *(column[order] for column in columns), episodes, ends


def reinforced(answer, rng, obstacles):
    """Let a robot practise in twelve rounds; how its episodes end in 100 new worlds, and whether its policy changed."""
    from robonav.robot import navigate, random_worlds

    robot = Actor(rng)
    begun = robot.layers
    for number in range(12):
        worlds = random_worlds(60, obstacles, seed=rng)
        states, actions, log_before, episodes, ends = robot.practised(worlds)
        given = robot.layers
        got = answer.ask(
            given, states, actions, log_before, episodes, ends, 11 - number
        )
        layers = got if isinstance(got, list | tuple) else []
        weights = [as_numbers(layer) for layer in layers]
        fits = [w is not None and w.shape for w in weights] == SHAPES
        answer.check(
            fits and all(np.isfinite(w.astype(float)).all() for w in weights),
            "the answer must be the layers (16, 13), (5, 17), (16, 13) and (1, 17), finite numbers",
        )
        weights = [w.astype(float) for w in weights]
        robot.layers = [np.clip(w, -1e6, 1e6) for w in weights]
    worlds = random_worlds(100, obstacles, seed=rng)
    changed = not all(map(np.array_equal, robot.layers[:2], begun[:2]))
    return navigate(robot.drive, worlds, max_steps=150).outcome, changed


COLLIDES_STILL = (
    "Look at the sign of the gradient, which the objective rises along, and at whether a collision reaches "
    "the steps before it: they share in what comes later in their episode, discounted."
)
CIRCLES = (
    "Perhaps they go in circles. Look at what a step costs: a small cost makes circles worse than arriving. "
    "And at the size of the steps: a policy that is certain too soon tries nothing else, so limit how far a round "
    "may change it, and let the entropy count."
)
LEARNS_NOTHING = (
    "The policy has not learned: after all rounds its two layers are those that it began with. Return layers that "
    "have moved along the gradient, and not the ones that were given."
)


def navigates_well(answer, rng, obstacles, least):
    """Require that many of 100 episodes arrive after practice among so many obstacles."""
    from robonav.grading.episode_outcomes import require_arrivals

    outcome, changed = reinforced(answer, rng, obstacles)
    collided, late = COLLIDES_STILL, CIRCLES
    if not changed:
        collided, late = LEARNS_NOTHING, LEARNS_NOTHING
    require_arrivals(answer, outcome, least, collided=collided, late=late)


@pytest.mark.part("6.7", points=6)
def test_reinforce_among_ten_obstacles(answer, rng):
    """Arrives in 80 of 100 new worlds with ten obstacles; a robot that goes straight arrives in 40."""
    navigates_well(answer, rng, 10, 80)


@pytest.mark.part("6.7", points=4)
def test_reinforce_among_twenty_obstacles(answer, rng):
    """Arrives in 70 of 100 new worlds with twenty obstacles; a robot that goes straight arrives in 15."""
    navigates_well(answer, rng, 20, 70)
