"""Chapter 2: the parts of each exercise. A docstring's first line is what the student reads."""

import numpy as np
import pytest

from robonav.grading.compare import as_numbers


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


def two_tables(rng):
    """Values before and after a sweep, mostly with changes of both signs."""
    previous = rng.normal(size=6)
    return previous, previous + rng.normal(rng.normal(), 1, size=6)


@pytest.mark.part("2.3", points=1)
def test_bounds_from_below(answer, rng):
    """Finds the greatest lower bound that follows from two successive value tables."""
    for _ in range(10):
        answer.agrees(*two_tables(rng), rng.uniform(0.3, 0.95), at=0)


@pytest.mark.part("2.3", points=1)
def test_bounds_from_above(answer, rng):
    """Finds the least upper bound that follows from two successive value tables."""
    for _ in range(10):
        answer.agrees(*two_tables(rng), rng.uniform(0.3, 0.95), at=1)


@pytest.mark.part("2.3", points=2)
def test_bounds_after_every_sweep(answer, rng):
    """Is right after every sweep of value iteration, also where all values rise or all fall."""
    for shift in (0.0, 5.0, -5.0):
        (transitions, rewards), discount = process(rng), 0.8
        previous = np.zeros(5)
        for _ in range(4):
            backed_up = rewards + shift + discount * (transitions @ previous).T
            values = backed_up.max(axis=1)
            answer.agrees(previous, values, discount)
            previous = values


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


def going_on(rng, q):
    """Steps after which the episode goes on."""
    rewards, next_states, next_actions, _ = batch(rng, q)
    return rewards, next_states, next_actions, np.zeros(len(rewards), dtype=bool)


@pytest.mark.part("2.5", points=1)
def test_targets_of_q_learning(answer, rng):
    """Finds Q-learning's targets of steps after which the episode goes on."""
    for _ in range(5):
        q = rng.normal(size=(6, 4))
        answer.agrees(q, *going_on(rng, q), rng.uniform(0.3, 0.95), 0.3, at=0)


@pytest.mark.part("2.5", points=1)
def test_targets_of_sarsa(answer, rng):
    """Finds SARSA's targets of steps after which the episode goes on."""
    for _ in range(5):
        q = rng.normal(size=(6, 4))
        answer.agrees(q, *going_on(rng, q), rng.uniform(0.3, 0.95), 0.3, at=1)


@pytest.mark.part("2.5", points=1)
def test_targets_of_expected_sarsa(answer, rng):
    """Finds expected SARSA's targets with any exploration, from none to nothing else."""
    for epsilon in (*rng.uniform(0.1, 0.9, size=5), 0.0, 1.0):
        q = rng.normal(size=(6, 4))
        answer.agrees(q, *going_on(rng, q), 0.9, float(epsilon), at=2)


@pytest.mark.part("2.5", points=1)
def test_targets_where_actions_tie(answer, rng):
    """Gives several best actions together no more probability than a single one."""
    for _ in range(10):
        q = rng.integers(2, size=(5, 4)).astype(float)
        answer.agrees(q, *going_on(rng, q), 0.9, 0.3, at=2)


@pytest.mark.part("2.5", points=1)
def test_targets_at_the_end(answer, rng):
    """Finds all three targets of the last step of an episode."""
    for _ in range(5):
        q = rng.normal(size=(6, 4))
        *steps, terminated = batch(rng, q)
        terminated[0] = True
        answer.agrees(
            q,
            *steps,
            terminated,
            rng.uniform(0.3, 0.95),
            0.3,
            at=(slice(None), terminated),
        )


def wander(rng, states, episodes, longest):
    """Episodes as lists of states and of rewards."""
    lengths = rng.integers(1, longest + 1, size=episodes)
    return [rng.integers(states, size=n).tolist() for n in lengths], [
        rng.integers(-3, 4, size=n).tolist() for n in lengths
    ]


@pytest.mark.part("2.6", points=1)
def test_first_visits_of_one_episode(answer, rng):
    """Finds the values from a single episode."""
    for _ in range(6):
        answer.agrees(*wander(rng, 6, 1, 10), 0.5, 6, at=0)


@pytest.mark.part("2.6", points=2)
def test_first_visits_of_many_episodes(answer, rng):
    """Averages over the episodes that visited a state, once each."""
    for _ in range(6):
        answer.agrees(*wander(rng, 5, 6, 8), 0.9, 5, at=0)


@pytest.mark.part("2.6", points=1)
def test_first_visits_are_counted(answer, rng):
    """Counts the episodes that visited a state."""
    for _ in range(6):
        answer.agrees(*wander(rng, 5, 6, 8), 0.9, 5, at=1)


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
        transitions, rewards = process(rng)
        answer.agrees(transitions, np.abs(rewards), np.ones(3, dtype=int), 6)


@pytest.mark.part("2.7", points=2)
def test_battery_of_random_costs(answer, rng):
    """Plans with actions of different costs, and with charges with which no action is possible."""
    for _ in range(10):
        transitions, rewards = process(rng, states=4)
        answer.agrees(transitions, np.abs(rewards), rng.integers(2, 5, size=3), 9)


@pytest.mark.part("2.7", points=1)
def test_battery_of_losses(answer, rng):
    """Goes on where every reward is negative: the robot cannot stop of its own accord."""
    for _ in range(5):
        transitions, rewards = process(rng, states=4)
        answer.agrees(transitions, -np.abs(rewards), rng.integers(2, 5, size=3), 9)


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


@pytest.mark.part("2.8", points=3)
def test_explorer_after_many_steps(answer, rng):
    """Plans in the estimated model, optimistic where it is not known."""
    for _ in range(5):
        steps, rewards, terminated, size = seen(rng, 4, 2, 30)
        answer.agrees(steps, rewards, np.zeros_like(terminated), size, 3, 2.0, 0.8)


@pytest.mark.part("2.8", points=2)
def test_explorer_after_ends(answer, rng):
    """Plans in a model in which some steps end the episode."""
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
    size = tuple(rng.integers(2, 6, size=2).tolist())
    answer.agrees(*nothing, size, 1, rng.uniform(1, 3), rng.uniform(0.5, 0.9))


def steered(answer, simulator):
    """How the episodes end of robots that the student's function steers, without reflexes."""
    from robonav.robot import navigate_in

    def policy(sensing, rng):
        got = answer.ask(sensing.ranges, sensing.target_region, sensing.target_seen)
        actions = as_numbers(got)
        fits = (
            actions is not None
            and actions.dtype.kind in "iu"
            and actions.shape == sensing.target_region.shape
            and bool(np.isin(actions, range(5)).all())
        )
        answer.check(
            fits, "the answer must hold a whole number from 0 to 4 for each robot"
        )
        return actions

    return navigate_in(policy, simulator, reflex=None)


def steers(answer, rng, obstacles, least):
    """Require that many of 200 robots arrive. Among fewer, a robot that goes straight could pass by luck."""
    from robonav.grading.episode_outcomes import require_arrivals
    from robonav.robot import Simulator, random_worlds

    worlds = random_worlds(200, obstacles, seed=rng)
    outcomes = steered(answer, Simulator(worlds, max_steps=250)).outcome
    require_arrivals(
        answer,
        outcomes,
        least,
        collided="Look at how near something may come before the robot turns away, and "
        "whether it turns to the side that is free: which sectors and which actions are on the left?",
        late="Look at whether the robot turns to its target "
        "again where the way there is free, and whether two turns undo each other.",
    )


@pytest.mark.part("2.9", points=2)
def test_steer_to_the_target(answer, rng):
    """Goes to its target nearly straight where nothing is in the way, whatever place and heading it starts with."""
    from dataclasses import replace

    from robonav.robot import Simulator, random_worlds

    n = 200
    bearing, distance = rng.uniform(0, 2 * np.pi, n), rng.uniform(30, 40, n)
    targets = np.full((n, 2), 50.0)
    away = np.column_stack([np.cos(bearing), np.sin(bearing)])
    starts = targets + distance[:, None] * away
    worlds = replace(random_worlds(n, 0, seed=rng), starts=starts, targets=targets)
    simulator = Simulator(worlds, max_steps=250)
    simulator.poses = np.column_stack([starts, rng.uniform(0, 2 * np.pi, n)])
    result = steered(answer, simulator)
    arrived = result.outcome == "arrived"
    soon = arrived & (result.steps <= 1.1 * distance / 2 + 4)
    answer.check(
        soon.sum() >= 170,
        f"expected 170 of {n} robots to arrive with at most a tenth more than the straight way and 4 steps, "
        f"got {soon.sum()}; arrived later: {(arrived & ~soon).sum()}, not at all: {(~arrived).sum()}",
        "Robots that arrive late turn to a wrong sector, or the long way round. Go through the regions from 1 to 9: "
        "on which side of the robot is each, and how far must it turn?"
        if arrived.sum() >= 100
        else "Nothing is near here, so the robot must turn to its target by itself. On which side of the robot is "
        "each of the regions from 1 to 9?",
    )


@pytest.mark.part("2.9", points=1)
def test_steer_among_some_obstacles(answer, rng):
    """Arrives in three of four worlds with five obstacles; a robot that goes straight arrives in three of five."""
    steers(answer, rng, 5, 150)


@pytest.mark.part("2.9", points=1)
def test_steer_among_more_obstacles(answer, rng):
    """Arrives in three of four worlds with ten obstacles; a robot that goes straight arrives in two of five."""
    steers(answer, rng, 10, 150)


@pytest.mark.part("2.9", points=4)
def test_steer_among_many_obstacles(answer, rng):
    """Arrives in seven of ten worlds with fifteen obstacles; a robot that goes straight arrives in one of five."""
    steers(answer, rng, 15, 140)


MOVES = ((0, 1), (1, 0), (0, -1), (-1, 0))


def best_values(transitions, gains, ends, discount):
    """The optimal values of a world whose rewards belong to the cells that the robot comes to."""
    values = np.zeros(len(gains))
    for _ in range(200):
        backed_up = (transitions @ (gains + discount * values)).max(axis=0)
        values = np.where(ends, 0.0, backed_up)
    return values


def hidden_world(rng, side, slip, small, discount):
    """Transitions, gains, ends and the first cell of a grid with walls, a goal, a pit, and perhaps a small reward.

    Cells and actions are numbered in another order in each world, so that nothing is known by heart.
    """
    while True:
        free = np.argwhere(rng.random((side, side)) >= 0.15)
        number = np.full((side + 2, side + 2), -1)
        number[tuple(free.T + 1)] = rng.permutation(len(free))
        order, n = rng.permutation(4), len(free)
        transitions = np.zeros((4, n, n))
        for row, column in free + 1:
            here = number[row, column]
            for other in range(4):
                down, right = MOVES[order[other]]
                to = number[row + down, column + right]
                share = np.where(np.arange(4) == other, 1 - slip, slip / 3)
                transitions[:, here, to if to >= 0 else here] += share
        start, goal, pit, near = rng.choice(n, size=4, replace=False)
        gains = np.zeros(n)
        gains[[goal, pit]] = 1.0, -1.0
        gains[near] = 0.2 if small else 0.0
        ends = gains != 0
        best = best_values(transitions, gains, ends, discount)[start]
        without = np.where(np.arange(n) == goal, 0.0, gains)
        lure = best_values(transitions, without, ends, discount)[start]
        if 0.55 < best < 0.75 and (not small or lure > 0.15):
            return transitions, gains, ends, start


def episodes(rng, world, policy, count=10, longest=40):
    """The steps of some episodes with a policy."""
    transitions, _, ends, start = world
    reached, chosen = transitions.cumsum(axis=2), policy.cumsum(axis=1)
    steps = []
    for _ in range(count):
        cell = start
        for draw in rng.random((longest, 2)):
            action = min(int((chosen[cell] < draw[0]).sum()), 3)
            after = int((reached[action, cell] < draw[1]).sum())
            after = min(after, len(ends) - 1)
            steps.append((cell, action, after))
            cell = after
            if ends[cell]:
                break
    return steps


def returned(world, policy, discount):
    """The exact return of a policy."""
    transitions, gains, ends, start = world
    flow = np.einsum("sa,ast->st", policy, transitions)
    flow[ends] = 0.0
    return np.linalg.solve(np.eye(len(gains)) - discount * flow, flow @ gains)[start]


def what_to_look_at(poor, found, sure):
    """The hint for a learner that gains too little, from what it did."""
    if sure < 0.7:
        return "The last policy still takes many actions at random. With no rounds left, use what was learned."
    if any(bad and not came for bad, came in zip(poor, found, strict=True)):
        return (
            "In a world with almost nothing gained, the robot has never come to the goal. It must also try what it has "
            "seldom done."
        )
    if any(poor):
        return (
            "In worlds with almost nothing gained, the robot came to the goal, but its last policy is no better than "
            "random steps. Look at whether what is learned about the goal gets back to the first cell."
        )
    return "Something is gained in each world. Look at whether all steps are used, and often enough."


def learned(answer, rng, side, slip, small, least):
    """Require a share of the way from the return of a robot that goes anywhere to the best return.

    The shares leave room for bad luck with the worlds and while exploring: in 40 draws of each part, Q-learning on
    recorded steps that begins with high values reached 100, 82 and 85 % at worst, and 98 % or more on average. An
    estimated model reached as much. Q-learning that begins with zeros and takes every second action at random passes
    each part mostly, and not always.
    """
    discount, gained = (
        0.95,
        [],
    )  # by world: what the robot gained, and what can be gained
    found, sure = (
        [],
        [],
    )  # by world: whether it came to the goal; how sure the last policy is of its actions
    for _ in range(4):
        world = hidden_world(rng, side, slip, small, discount)
        transitions, gains, ends, start = world
        size, steps = (len(gains), 4), np.zeros((0, 3), dtype=np.int64)
        for rounds_left in range(10, -1, -1):
            rewards, terminated = gains[steps[:, 2]], ends[steps[:, 2]]
            got = answer.ask(steps, rewards, terminated, size, discount, rounds_left)
            policy = as_numbers(got)
            fits = (
                policy is not None
                and policy.shape == size
                and bool(np.isfinite(policy).all())
                and bool((policy >= 0).all())
                and bool((abs(policy.sum(axis=1) - 1) < 1e-3).all())
            )
            answer.check(
                fits, "the answer must hold the probabilities of 4 actions in each cell"
            )
            policy = policy / policy.sum(axis=1, keepdims=True)
            if rounds_left:
                steps = np.concatenate([steps, episodes(rng, world, policy)])
        anywhere = returned(world, np.full(size, 0.25), discount)
        best = best_values(transitions, gains, ends, discount)[start]
        gained.append([returned(world, policy, discount) - anywhere, best - anywhere])
        found.append(bool((gains[steps[:, 2]] == 1).any()))
        sure.append(policy[~ends].max(axis=1).mean())
    own, most = np.sum(gained, axis=0)
    reached = int(100 * own / most)
    shares = ", ".join(f"{100 * mine / best:.0f}" for mine, best in gained)
    poor = [mine < 0.1 * best for mine, best in gained]
    answer.check(
        reached >= least,
        f"expected {least} % of what can be gained by learning, got {reached} %; in the four worlds {shares} %",
        what_to_look_at(poor, found, np.mean(sure)),
    )


@pytest.mark.part("2.10", points=3)
def test_learner_on_firm_ground(answer, rng):
    """Reaches 80 % in worlds in which every action leads where it should."""
    learned(answer, rng, 5, 0.0, False, 80)


@pytest.mark.part("2.10", points=4)
def test_learner_that_slips(answer, rng):
    """Reaches 60 % in worlds in which every fifth action slips."""
    learned(answer, rng, 5, 0.2, False, 60)


@pytest.mark.part("2.10", points=3)
def test_learner_that_is_lured(answer, rng):
    """Reaches 60 % in worlds with a small reward near the start and a large one far away."""
    learned(answer, rng, 6, 0.1, True, 60)


def facing(rng, size):
    """A pose on the map, away from its border."""
    place = rng.uniform(0.3 * size, 0.7 * size, size=2)
    return np.array([*place, rng.uniform(-np.pi, np.pi)])


def towards(pose, degrees, metres):
    """Places in some directions from the heading and at some distances."""
    angles = pose[2] + np.radians(degrees)
    steps = np.column_stack([np.cos(angles), np.sin(angles)])
    return pose[:2] + np.reshape(metres, (-1, 1)) * steps


@pytest.mark.part("2.11", points=1)
def test_rays_to_the_middle_of_a_circle(answer, rng):
    """Reads a circle whose centre lies on a ray."""
    for ray in range(9):
        pose, away = facing(rng, 100.0), rng.uniform(4, 8, size=1)
        centres = towards(pose, np.array([40.0 * ray]), away)
        answer.agrees(pose, centres, rng.uniform(1, 2, size=1), 100.0, 10.0)


@pytest.mark.part("2.11", points=1)
def test_rays_beside_the_middle_of_a_circle(answer, rng):
    """Reads circles that rays meet beside their centres, and none that lie between two rays."""
    for _ in range(6):
        pose, away = facing(rng, 100.0), rng.uniform(5, 8, size=9)
        aside = 40.0 * np.arange(9) + rng.uniform(-9, 9, size=9)
        centres = towards(pose, aside, away)
        answer.agrees(pose, centres, rng.uniform(0.3, 1.6, size=9), 100.0, 10.0)


@pytest.mark.part("2.11", points=1)
def test_rays_away_from_a_circle(answer, rng):
    """Reads nothing of circles that lie behind, and gives ``reach`` where nothing is near."""
    for _ in range(4):
        pose = facing(rng, 100.0)
        ray = rng.integers(9, size=1)
        centres = towards(pose, 40.0 * ray + 180, np.array([5.0]))
        answer.agrees(pose, centres, np.array([0.8]), 100.0, 10.0)


@pytest.mark.part("2.11", points=1)
def test_rays_to_the_border(answer, rng):
    """Reads the border of the map, where no circle is."""
    nothing = np.zeros((0, 2)), np.zeros(0)
    for _ in range(6):
        answer.agrees(facing(rng, 20.0), *nothing, 20.0, 30.0)


@pytest.mark.part("2.11", points=1)
def test_rays_among_many_things(answer, rng):
    """Reads the nearest of many circles and borders."""
    for _ in range(4):
        pose = facing(rng, 30.0)
        centres = rng.uniform(0, 30, size=(14, 2))
        away = np.hypot(*(centres - pose[:2]).T)
        radii = np.minimum(rng.uniform(1, 3, size=14), 0.6 * away)
        answer.agrees(pose, centres, radii, 30.0, 12.0)
