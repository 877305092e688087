"""Chapter 4: the parts of each exercise. A docstring's first line is what the student reads."""

import numpy as np
import pytest

from robonav.grading.compare import as_numbers


def some(rng, *shape):
    """Truth values, one true in each row at least."""
    allowed = rng.random(shape) < 0.6
    allowed[np.arange(shape[0]), rng.integers(shape[1], size=shape[0])] = True
    return allowed


def robots(rng, n=6, actions=4, *, few=False):
    """Values, shares that can be reached, and allowed actions; ``few`` makes values that tie."""
    allowed = some(rng, n, actions)
    allowed[:, :2] = True
    values = rng.normal(size=(n, actions))
    if few:
        values = rng.integers(-2, 1, size=(n, actions)).astype(float)
        values[:, 0] = 1.0
        values[: n // 2, 1] = 1.0
    masked = np.where(allowed, values, -np.inf)
    best = (masked == masked.max(axis=1, keepdims=True)).sum(axis=1)
    least = best / allowed.sum(axis=1)
    return values, least + (1 - least) * rng.uniform(0.2, 0.9, size=n), allowed


@pytest.mark.part("4.1", points=2)
def test_explore_with_a_share(answer, rng):
    """Finds the policy where a single action is best."""
    for _ in range(6):
        answer.agrees(*robots(rng))


@pytest.mark.part("4.1", points=1)
def test_explore_where_actions_tie(answer, rng):
    """Finds the policy where several actions are best."""
    for _ in range(6):
        answer.agrees(*robots(rng, few=True))


@pytest.mark.part("4.1", points=1)
def test_explore_at_the_extremes(answer, rng):
    """Is greedy for a share of 1, and takes all allowed actions equally often where the share is too small to reach."""
    for _ in range(4):
        values, share, allowed = robots(rng, 8, few=True)
        share[:4], share[6:] = 1.0, 0.05
        answer.agrees(values, share, allowed)


@pytest.mark.part("4.1", points=1)
def test_explore_without_overflow(answer, rng):
    """Stays finite with values in the thousands."""
    for _ in range(6):
        values, share, allowed = robots(rng)
        allowed[0, 3] = False
        values[0, 3] = 500.0  # a forbidden action with by far the largest value
        answer.agrees(4000 + 10 * values, share, allowed)


@pytest.mark.part("4.2", points=2)
def test_shaped_episodes(answer, rng):
    """Agrees with the definition on episodes that ended."""
    for steps in (1, 2, 5, 9):
        answer.agrees(
            rng.normal(size=steps),
            rng.normal(size=steps + 1),
            True,
            rng.uniform(0.3, 0.95),
        )


@pytest.mark.part("4.2", points=1)
def test_shaped_episodes_cut_off(answer, rng):
    """Keeps the last state's potential where the episode was only cut off."""
    for steps in (1, 6, 0):
        answer.agrees(
            rng.normal(size=steps),
            rng.normal(size=steps + 1),
            False,
            rng.uniform(0.3, 0.95),
        )


@pytest.mark.part("4.2", points=1)
def test_shaped_rewards_cancel(answer, rng):
    """Changes the return of an episode only by the potential of its first state."""
    for discount in (0.0, 0.7, 1.0):
        rewards, potentials = rng.normal(size=6), rng.normal(size=7)
        new = np.asarray(
            answer.agrees(rewards, potentials, True, discount), dtype=float
        )
        gained = ((new - rewards) * discount ** np.arange(6)).sum()
        answer.check(
            abs(gained + potentials[0]) < 1e-4,
            "the additions do not cancel over the episode",
        )


def steps(rng, n=6, actions=4, *, bold=False):
    """The network's answers and what happened; ``bold`` rewards leave their bounds."""
    rewards = rng.uniform(-6, 6, size=n) if bold else rng.uniform(-1, 0.5, size=n)
    chosen = rng.integers(actions, size=n)
    return (
        rng.random((n, actions)),
        chosen,
        rewards,
        rng.random((n, actions)),
        rng.random(n) < 0.4,
        (-1.0, 0.5),
    )


@pytest.mark.part("4.3", points=3)
def test_rescaled_targets(answer, rng):
    """Agrees with the definition where all rewards keep their bounds."""
    for _ in range(8):
        answer.agrees(*steps(rng), rng.uniform(0.3, 0.9), rng.uniform(0.2, 0.9))


@pytest.mark.part("4.3", points=1)
def test_rescaled_targets_at_the_ends(answer, rng):
    """Uses the Q-value 0 after the last step of an episode, not the smallest possible Q-value."""
    for _ in range(5):
        outputs, actions, rewards, following, _, bounds = steps(rng)
        answer.agrees(
            outputs,
            actions,
            rewards,
            following,
            np.ones(6, dtype=bool),
            bounds,
            0.8,
            0.5,
        )


@pytest.mark.part("4.3", points=1)
def test_rescaled_targets_beyond_the_bounds(answer, rng):
    """Keeps the targets between 0 and 1 where rewards leave their bounds."""
    for _ in range(5):
        answer.agrees(*steps(rng, bold=True), 0.5, 0.9)


def episode(rng, length, features=3, actions=2):
    return (
        rng.normal(size=(length + 1, features)),
        rng.integers(actions, size=length),
        rng.normal(size=length),
    )


@pytest.mark.part("4.4", points=2)
def test_accumulated_over_two_steps(answer, rng):
    """Agrees with the definition on episodes of one step and of two."""
    for _ in range(4):
        for length in (1, 2):
            answer.agrees(*episode(rng, length), False, 2, 0.7, 0.2)


@pytest.mark.part("4.4", points=4)
def test_accumulated_over_an_episode(answer, rng):
    """Trains after each step on all pairs so far, oldest first, with the targets as they were."""
    for _ in range(6):
        answer.agrees(*episode(rng, 8, actions=3), bool(rng.integers(2)), 3, 0.8, 0.1)


@pytest.mark.part("4.4", points=2)
def test_accumulated_to_the_end(answer, rng):
    """Uses only the reward for the last step of an episode that ended, although its last state has a large value."""
    for _ in range(4):
        features, actions, _ = episode(rng, 6)
        answer.agrees(np.abs(features), actions, np.ones(6), True, 2, 1.0, 0.1)


def records(rng, n=30, k=3, actions=3):
    """Recorded steps; with n > 10 every action is taken."""
    chosen = np.concatenate([np.arange(actions), rng.integers(actions, size=n)])[:n]
    outcomes = rng.choice([0, 0, 0, 1, -1], size=n)
    return (
        rng.normal(size=(n, k)),
        chosen,
        rng.uniform(0, 0.3, size=n),
        rng.normal(size=(n, k)),
        outcomes,
        actions,
    )


@pytest.mark.part("4.5", points=3)
def test_fitted_once(answer, rng):
    """Fits the costs in the first iteration, and the target 1 where the robot failed."""
    for _ in range(4):
        answer.agrees(*records(rng), 0.9, rng.uniform(0.5, 2), 1)


@pytest.mark.part("4.5", points=5)
def test_fitted_again_and_again(answer, rng):
    """Computes new targets in each iteration, from the best action of the next state."""
    for iterations in (2, 3, 10):
        for _ in range(2):
            answer.agrees(*records(rng), 0.9, 0.8, iterations)


@pytest.mark.part("4.5", points=2)
def test_fitted_to_little(answer, rng):
    """Leaves the weights of an action that was never taken at zero, and all of them before the first iteration."""
    features, actions, costs, following, outcomes, _ = records(rng, n=8)
    answer.agrees(features, actions, costs, following, outcomes, 5, 0.9, 0.5, 4)
    answer.agrees(features, actions, costs, following, outcomes, 3, 0.9, 0.5, 0)


@pytest.mark.part("4.6", points=1)
def test_changes_that_are_added(answer, rng):
    """Finds the signed and the absolute sum for random weights."""
    for _ in range(6):
        answer.agrees(rng.normal(size=(7, 9)).cumsum(axis=0), at=np.s_[:, :2])


@pytest.mark.part("4.6", points=1)
def test_changes_and_the_largest(answer, rng):
    """Finds the largest absolute change for random weights."""
    for _ in range(6):
        answer.agrees(rng.normal(size=(7, 9)).cumsum(axis=0), at=np.s_[:, 2])


@pytest.mark.part("4.6", points=1)
def test_changes_that_cancel(answer, rng):
    """Distinguishes changes that cancel from no change."""
    change = rng.normal(size=(3, 4))
    answer.agrees(
        np.vstack(
            [
                np.zeros(8),
                np.hstack([change, -change]),
                np.hstack([change, -change])[-1:],
            ]
        )
    )


def careers(rng, seeds, episodes):
    """Seeds that learn, some sooner than others."""
    probability = np.clip(
        np.linspace(0, 1, episodes) + rng.normal(0, 0.3, size=(seeds, 1)), 0, 1
    )
    return rng.random((seeds, episodes)) < probability


@pytest.mark.part("4.7", points=1)
def test_band_and_its_curve(answer, rng):
    """Finds the mean curve where the blocks fill all episodes."""
    for _ in range(4):
        answer.agrees(careers(rng, 6, 40), 10, rng.integers(6, size=(50, 6)), at=0)


@pytest.mark.part("4.7", points=2)
def test_band_of_full_blocks(answer, rng):
    """Finds the interval where the blocks fill all episodes."""
    for _ in range(4):
        answer.agrees(careers(rng, 6, 40), 10, rng.integers(6, size=(50, 6)), at=1)


@pytest.mark.part("4.7", points=2)
def test_band_of_an_open_end(answer, rng):
    """Leaves out the episodes that do not fill a block."""
    for block in (7, 12):
        answer.agrees(careers(rng, 5, 40), block, rng.integers(5, size=(40, 5)))


SAFE, COZY, DANGEROUS, WON, FAILED = range(5)
TABLE = np.array(
    [
        [0.0, -0.06, -0.1, 1.0, -1.0],
        [0.03, 0.0, -0.06, 1.0, -1.0],
        [0.05, 0.03, -0.02, 1.0, -1.0],
    ]
)


def rooms(rng, side=9, obstacles=4):
    """What kind of place each cell of a grid is, and where each of four moves leads."""
    cells = rng.permutation(side**2)
    rows, columns = np.divmod(np.arange(side**2), side)
    blocked = cells[:obstacles]
    away = np.min(
        [np.maximum(abs(rows - rows[b]), abs(columns - columns[b])) for b in blocked],
        axis=0,
    )
    kinds = np.select(
        [away == 0, away == 1, away == 2], [FAILED, DANGEROUS, COZY], SAFE
    )
    kinds[cells[-1]] = WON
    moves = [
        np.clip(rows + down, 0, side - 1) * side + np.clip(columns + right, 0, side - 1)
        for down, right in ((0, 1), (1, 0), (0, -1), (-1, 0))
    ]
    return kinds, np.array(moves)


def arrived(kinds, moves, table, discount=0.95):
    """The shares of cells from which a robot that acts optimally for the table arrives, and collides."""
    going = kinds < WON
    rewards = np.where(going, table[np.minimum(kinds, DANGEROUS), kinds[moves]], 0.0)
    values = np.zeros(len(kinds))
    for _ in range(400):
        values = np.where(going, (rewards + discount * values[moves]).max(axis=0), 0.0)
    best = (rewards + discount * values[moves]).argmax(axis=0)
    cells = np.arange(len(kinds))
    for _ in range(len(kinds)):
        cells = np.where(kinds[cells] < WON, moves[best[cells], cells], cells)
    ends = kinds[cells][going]
    return np.array([(ends == WON).mean(), (ends == FAILED).mean()])


def a_round_pays(kinds, moves, table):
    """Whether a robot that never ends its episode can earn more and more."""
    going = kinds < WON
    rewards = np.where(going, table[np.minimum(kinds, DANGEROUS), kinds[moves]], 0.0)
    rewards[kinds[moves] >= WON] = -np.inf
    values, most = np.where(going, 0.0, -np.inf), []
    for _ in range(400):
        values = np.where(going, (rewards + values[moves]).max(axis=0), -np.inf)
        most.append(values.max())
    return bool(most[-1] > most[199] + 1e-6)


def healthy(rng):
    """A table for which the robot arrives. Each is another one, so that no table is known by heart."""
    table = TABLE.copy()
    table[:, :WON] *= rng.uniform(0.6, 1.6)
    table[:, :WON] -= rng.uniform(0.0, 0.02, size=(3, 3))
    return table


def why_not(fails, grids, table):
    """What the episodes without an arrival suggest."""
    if fails:
        return "Some episodes end in an obstacle: a reward on the way is now so low that failing costs less."
    if any(a_round_pays(*room, table) for room in grids):
        return (
            "Some episodes never end: going to and fro, or staying, still pays. Add the rewards of a way that leads "
            "back to where it began."
        )
    return "Some episodes never end, though no round pays: a reward on the way is now so low that it costs less to go on."


def cured(answer, rng, raised):
    """Require that the robot arrives with the cured table as with the original. Yield how many rewards it changed."""
    for _ in range(8):
        original = healthy(rng)
        table = original.copy()
        for entry in rng.choice(9, size=raised, replace=False):
            table[divmod(int(entry), 3)] += rng.uniform(0.2, 0.4)
        got = as_numbers(answer.ask(table))
        fits = got is not None and got.shape == (3, 5) and np.isfinite(got).all()
        answer.check(bool(fits), "expected a table of 3 rows and 5 columns")
        kept = np.allclose(got[:, WON:], table[:, WON:])
        answer.check(kept, "expected the rewards for arrivals and collisions unchanged")
        grids = [rooms(rng) for _ in range(3)]
        shares = [
            [arrived(*room, one) for one in (original, got.astype(float))]
            for room in grids
        ]
        (right, _), (own, failed) = (100 * np.mean(shares, axis=0)).astype(int)
        answer.check(
            own >= right - 2,
            f"expected {right} of 100 episodes to arrive, got {own}; "
            f"collisions: {failed}, for ever on the way: {100 - own - failed}",
            why_not(failed > 100 - own - failed, grids, got.astype(float)),
        )
        changed = int((~np.isclose(got, table)).sum())
        answer.check(changed <= 5, "expected at least 4 of 9 rewards unchanged")
        yield changed


@pytest.mark.part("4.8", points=3)
def test_cure_one_raised_reward(answer, rng):
    """The robot arrives where one reward had been raised."""
    for _ in cured(answer, rng, 1):
        pass  # each table is checked where it is cured


@pytest.mark.part("4.8", points=3)
def test_cure_two_raised_rewards(answer, rng):
    """The robot arrives where two rewards had been raised."""
    for _ in cured(answer, rng, 2):
        pass  # each table is checked where it is cured


@pytest.mark.part("4.8", points=2)
def test_cure_changes_little(answer, rng):
    """The robot arrives, and no more rewards change than had been raised."""
    for changed in cured(answer, rng, 2):
        answer.check(changed <= 2, f"expected at most 2 changed rewards, got {changed}")


def values_of(weights, inputs):
    """The outputs of the network for some inputs."""
    hidden = np.tanh(weights[0][:, 0] + inputs @ weights[0][:, 1:].T)
    return weights[1][:, 0] + hidden @ weights[1][:, 1:].T


class Learner:
    """A robot whose sensors and motors are wired at random, in signs, too, and the network that chooses its actions."""

    def __init__(self, rng):
        from robonav.robot import Encoder

        self.rng, self.encoder = rng, Encoder()
        self.sensors, self.motors = rng.permutation(9), rng.permutation(5)
        self.signs = rng.choice([-1.0, 1.0], size=12)
        layers = rng.normal(size=(16, 13)), rng.normal(size=(5, 17))
        self.weights = [0.3 * layer for layer in layers]

    def inputs(self, sensing):
        found = self.encoder(sensing)
        return self.signs * np.hstack([found[:, self.sensors], found[:, 9:]])

    def drive(self, sensing, rng):
        """The policy after the last round."""
        best = values_of(self.weights, self.inputs(sensing)).argmax(axis=1)
        return self.motors[best]

    def practised(self, worlds, chance):
        """States, actions, next states and ends of the steps in which the network was asked."""
        from robonav.robot import Outcome, Simulator, run_episodes

        simulator, n = Simulator(worlds, max_steps=150), len(worlds)
        states, actions = np.zeros((n, 12)), np.zeros(n, dtype=np.int64)
        asked, steps = np.zeros(n, dtype=bool), []

        def select_actions(simulator, sensing, robots):
            now = self.inputs(sensing)
            best = values_of(self.weights, now).argmax(axis=1)
            at_random = self.rng.random(len(now)) < chance
            chosen = np.where(at_random, self.rng.integers(5, size=len(now)), best)
            again = asked[robots]
            before = robots[again]
            going_on = np.zeros(len(before), dtype=np.int64)
            steps.append((states[before], actions[before], now[again], going_on))
            states[robots], actions[robots], asked[robots] = now, chosen, True
            return self.motors[chosen]

        for _ in run_episodes(simulator, select_actions):
            pass
        arrived = simulator.outcome == Outcome.ARRIVED
        ends = np.where(arrived, 1, -1)[asked]
        steps.append((states[asked], actions[asked], np.zeros((len(ends), 12)), ends))
        return [np.concatenate(column) for column in zip(*steps, strict=True)]


def learned(answer, rng, obstacles):
    """Let a robot practise in five rounds, and see how its episodes end in 100 new worlds."""
    from robonav.robot import navigate, random_worlds

    robot, steps = Learner(rng), None
    for number in range(5):
        chance = max(0.1, 1 - number / 3)
        new = robot.practised(random_worlds(60, obstacles, seed=rng), chance)
        old = steps or [column[:0] for column in new]
        steps = [np.concatenate(pair) for pair in zip(old, new, strict=True)]
        states, actions, next_states, ends = steps
        given = robot.weights
        got = answer.ask(given, states, actions, next_states, ends, 4 - number)
        layers = got if isinstance(got, list | tuple) else []
        weights = [as_numbers(layer) for layer in layers]
        fits = [w is not None and w.shape for w in weights] == [(16, 13), (5, 17)]
        answer.check(
            fits and all(np.isfinite(w.astype(float)).all() for w in weights),
            "the answer must be the layers (16, 13) and (5, 17), finite numbers",
        )
        answer.check(
            not all(map(np.allclose, weights, given)),
            "expected other weights than those of the last round, got the same",
            "The function returns the weights that it got: does it train a copy, and return that?",
        )
        robot.weights = [w.astype(float) for w in weights]
    worlds = random_worlds(100, obstacles, seed=rng)
    return navigate(robot.drive, worlds, max_steps=150).outcome


@pytest.mark.part("4.9", points=10)
def test_practise_and_drive(answer, rng):
    """Arrives in two of three worlds with two robots that are wired otherwise; going straight, in two of five."""
    from robonav.grading.episode_outcomes import require_arrivals

    require_arrivals(
        answer,
        np.concatenate([learned(answer, rng, 10), learned(answer, rng, 10)]),
        132,
        collided="Look at whether the end of an episode reaches the steps before it: "
        "the target of a step that ends with -1 is this -1, and only of the other steps the next state's value. Does "
        "only the output of the action taken move? Do the biases stay in column 0? Then look at how long and how fast "
        "the network is trained.",
        late="Perhaps they go in circles. Look at what a step costs: "
        "if going on is worth as much as arriving, the robot goes on. And at whether values grow from round to round.",
    )
