"""The numbers that the pages of chapter 2 work by hand are those of the package, and stand on the pages."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from itertools import cycle

import gymnasium as gym
import numpy as np
import pytest

from robonav import mdp, robot
from robonav.benchmark.policies import method
from robonav.mdp.belief_planning import backup
from robonav.robot._fast import constants


@pytest.fixture
def written(page_text: Callable[[str], str]) -> Callable[[str, str, str], str]:
    """The text of a page from one heading to another."""

    def between(page: str, first: str, last: str) -> str:
        text = page_text(page)
        start = text.index(first)
        return text[start : text.index(last, start)]

    return between


def assert_written(text: str, numbers: object, digits: int) -> None:
    for number in np.ravel(np.asarray(numbers, dtype=float)):
        assert f"{number:.{digits}f}".replace("-0.000", "0.000") in text


def test_two_states(written):
    text = written("decision-processes", "### Two states, by hand", "## Action values")
    transitions = [[[0.5, 0.5], [0, 1]], [[0, 1], [0, 1]]]
    rewards = [[5, 10], [-1, -1]]
    two = mdp.FiniteMDP(transitions, rewards, 0.95)
    stay, leave = (mdp.policy_evaluation(two, policy) for policy in ([0, 0], [1, 0]))
    assert stay[1] == pytest.approx(-20)
    assert leave[0] == pytest.approx(-9)
    assert_written(text, stay[0], 2)
    equal = mdp.FiniteMDP(transitions, rewards, 10 / 11)
    assert mdp.policy_evaluation(equal, [0, 0]) == pytest.approx(
        mdp.policy_evaluation(equal, [1, 0])
    )


def test_one_cell_of_the_grid(written):
    text = written(
        "decision-processes", "We check one value by hand", "We test the value"
    )
    model = mdp.four_by_three().mdp(0.95)
    around = [1, 1, 1, 1, 0, 0, 0, 0, 3, 3, 3]
    values = mdp.policy_evaluation(model, around)
    assert model.rewards[2, 1] == pytest.approx(0.76)
    assert values[2] == pytest.approx(
        0.76 + 0.95 * (0.8 * 0 + 0.1 * values[2] + 0.1 * values[5])
    )
    assert_written(text, values[[2, 5]], 3)


def test_test_of_optimality_without_discount_in_the_grid():
    """It holds although a policy that pushes into a wall never ends: no such policy is any good."""
    model = mdp.four_by_three().mdp(1.0)
    best = mdp.policy_iteration(model)
    assert mdp.advantage(model, best.policy).max() == pytest.approx(0, abs=1e-9)
    with pytest.raises(ValueError, match="forever"):
        mdp.policy_evaluation(model, np.where(model.terminal, 0, 3))


def test_three_sweeps(written):
    text = written(
        "dynamic-programming", "Take three cells A, B and C", "```{code-cell}"
    )
    goal = {"G": mdp.Cell(reward=1, ends=True)}
    row = mdp.GridWorld(". . . G", legend=goal, slip=0.2).mdp(0.9)
    swept = mdp.value_iteration(row, record=True).history[1:4, :3]
    assert (swept > 0).tolist() == [
        [False, False, True],
        [False, True, True],
        [True, True, True],
    ]
    assert swept[0, 2] == pytest.approx(0.8)
    assert_written(text, swept[1:][swept[1:] > 0], 3)


def test_numbers_of_tiles(written):
    """Shifted grids have one more row and one more column of tiles, on the page as in the package."""
    text = written("linear-values", "## Tiles", "## In short")
    car = mdp.Tiles((0, 0), (1, 1), tiles=(8, 8), tilings=8, n_actions=3)
    assert f"8 \\cdot 9^2 = {np.prod(car.shape)}$ tiles" in text
    square = mdp.Tiles((0, 0), (4, 4), tiles=(4, 4), tilings=2, n_actions=1)
    assert f"2 \\cdot 5^2 = {np.prod(square.shape)}$" in text
    quiz = written("linear-values", "## Check yourself", "With ten features")
    asked = mdp.Tiles((0, 0), (1, 1), tiles=(10, 10), tilings=8, n_actions=3)
    weights = asked((0.5, 0.5)).shape[1]
    assert f"- [x] {weights:,} and 8" in quiz
    assert f"= {weights}$ weights" in quiz


def test_weights_of_two_states_grow(written):
    """The factor of an update is larger than 1 for a discount above 1/2."""
    text = written("linear-values", "Two states show why", "An on-policy method")
    assert r"\bigl( 1 + \alpha\, (2 \gamma - 1) \bigr)\, w" in text
    weight, alpha = 1.0, 0.1
    for discount, grows in ((0.4, False), (0.5, None), (0.9, True)):
        moved = weight + alpha * (discount * 2 * weight - weight)
        assert moved == pytest.approx(1 + alpha * (2 * discount - 1))
        assert grows is None or (moved > weight) == grows


def test_weights_shrink_with_the_second_update(written):
    """The answer has the factors of both updates, with the numbers of the cell above it."""
    text = written("linear-values", "**Try it.**", "An on-policy method")
    alpha, discount = 0.1, 0.9
    first = 1 + alpha * (discount * 2 * 1 - 1) * 1
    second = 1 + alpha * (0 - 2 * 1) * 2
    assert f"= {second:.1f}\\, w$" in text
    assert f"= {first:.2f}$" in text
    assert f"= {first * second:.3f}$" in text


def test_bias_of_every_visit(written):
    """The mean of the sum is 4, the mean of the number 2, and the mean of the quotient of one episode 1.5."""
    text = written("prediction", "## Bias and variance", "```{code-cell}")
    lengths = np.arange(1, 200)
    chances = 0.5**lengths
    total = (chances * lengths * (lengths + 1) / 2).sum()
    number = (chances * lengths).sum()
    assert f"{total:.0f} on average, and $n$ to the number, {number:.0f} on" in text
    assert (chances * (lengths + 1) / 2).sum() == pytest.approx(1.5)
    assert "1.5 on average" in text


def test_returns_of_an_episode(written):
    text = written("prediction", "## Monte Carlo prediction", "The code below")
    returns = mdp.discounted_return([0, 2, 0, 10], 0.9)
    assert [f"{value:g}" for value in returns.round(2)] == ["9.09", "10.1", "9", "10"]
    assert "9.09" in text
    assert "10.1" in text
    assert returns[[0, 2]].mean() == pytest.approx(9.045)
    assert "9.045" in text


def test_sarsa_that_never_arrives(written):
    """With ε = 0.4 and α = 0.5 it walks into the border in the sixth cell of the top row; with α = 0.1 it arrives."""
    text = written("model-free-learning", "## Watch both learn", "## Which one")
    cliff = mdp.GridWorld(
        ". . . . . . .\n. . . . . . .\n. . . . . . .\nS X X X X X G",
        legend={"X": mdp.Cell(reward=-99.0, ends=True), "G": mdp.Cell(ends=True)},
        step_reward=-1.0,
    )
    assert all(row in text for row in cliff.text.split("\n"))
    last = {}
    for rate in (0.1, 0.5):
        learned = mdp.sarsa(
            cliff.environment(),
            500,
            discount=1.0,
            learning_rate=rate,
            epsilon=0.4,
            seed=1,
        )
        (walk,) = mdp.rollouts(
            cliff.environment(), learned.policy, 1, max_steps=40, seed=0
        )
        last[rate] = int(walk.states[-1])
    assert last == {0.1: 27, 0.5: 5}
    assert "in the sixth cell of the top row" in text


class OneStep:
    """One step from state 0 to state 1 with a reward of -1; then a time limit."""

    def reset(self) -> tuple[int, dict]:
        return 0, {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict]:
        return 1, -1.0, False, True, {}


class ThirdAction:
    """Random numbers that explore and then draw the last action."""

    def __init__(self) -> None:
        self.numbers = cycle([0.0, 0.99])

    def random(self) -> float:
        return next(self.numbers)


@pytest.mark.parametrize(
    ("method", "target"),
    [(mdp.q_learning, 3.5), (mdp.sarsa, -0.1), (mdp.expected_sarsa, 2.96)],
)
def test_one_step_and_three_updates(written, method, target):
    text = written("model-free-learning", "### The same step", "```{code-cell}")
    q = [[2.0], [3.0, 5.0, 1.0]]
    inspect.unwrap(method)(
        OneStep(),
        q,
        [[0], [0, 0, 0]],
        1,
        discount=0.9,
        learning_rate=lambda n: 0.5,
        epsilon=lambda episode: 0.3,
        rng=ThirdAction(),
    )
    assert q[0][0] == pytest.approx(2 + 0.5 * (target - 2))
    assert f"= {target:g}$" in text
    assert f"{q[0][0]:.2f}" in text


@pytest.mark.parametrize(("slippery", "ends_in"), [(False, 0), (True, 12)])
def test_always_left_on_the_lake(written, slippery, ends_in):
    """Without slips the first action leaves the agent at the start, and with slips it ends in the lower left hole."""
    text = written("model-free-learning", "Always taking the first", "Testing with")
    assert "without slipping" in text
    assert "the hole in the corner" in text
    lake = gym.make("FrozenLake-v1", is_slippery=slippery)
    left = mdp.FiniteMDP.from_gymnasium(lake, 1.0).transitions[0].toarray()
    assert np.linalg.matrix_power(left, 1000)[0, ends_in] == pytest.approx(1)


def test_robot_in_numbers(written):
    """The box at the top of the page has the numbers of the simulator."""
    box = written("robot", "The robot in numbers", "## What it senses")
    worlds = robot.random_worlds(1, 10, seed=0)
    x, y, heading = worlds.start_poses[0]
    assert f"a square of {worlds.size:.0f} m" in box
    assert (
        f"at ({x:.0f}, {y:.0f}), facing the target (heading {np.degrees(heading):.0f}°)"
        in box
    )
    assert "at ({:.0f}, {:.0f})".format(*worlds.targets[0]) in box
    assert f"within {constants.ARRIVAL_DISTANCE:.0f} m of it" in box
    assert f"they reach {constants.SENSOR_RANGE:.0f} m" in box
    assert f"nearer than {constants.COLLISION_DISTANCE:.0f} m" in box
    defaults = inspect.signature(robot.navigate).parameters
    assert f"at most {defaults['max_steps'].default} steps" in box
    assert f"{defaults['speed'].default:g} m/s" in box


def test_rule_that_never_arrives(written):
    """In the fourth map of the figure; in the other three it arrives."""
    text = written("robot", "name: fig-freer-side", "A policy of your own")
    assert "random_worlds(4, 15, seed=5)" in text
    worlds = robot.random_worlds(4, 15, seed=5)
    drive = robot.navigate(robot.turn_to_clearer_side, worlds)
    assert drive.success.tolist() == [True, True, True, False]
    assert drive.outcome[3] == "out of steps"
    assert "In the fourth map it never arrives" in text


def test_reading_of_a_circle_beside_the_sector(written):
    text = written("robot", "The circle also reaches", "```{code-cell}")
    along = 8 * np.cos(np.radians(20)) + 2 * np.sin(np.radians(20))
    beside = np.sqrt(8**2 + 2**2 - along**2)
    half = np.sqrt(4**2 - beside**2)
    world = robot.make_world(circles=[(38, 30, 4)])
    reading = robot.sense(world, [[30, 28, np.radians(40)]]).ranges[0, 0]
    assert along - half == pytest.approx(reading, abs=1e-5)
    assert_written(text, [along, beside, half, reading], 2)


@pytest.mark.slow
def test_one_drive(written):
    """The readings at place 2 of the first drive, the turn, and the collision of going straight on."""
    text = written("introduction", "At place 1 nothing", "```{slide}")
    world = robot.random_worlds(1, 15, seed=3)
    path = robot.navigate(method("dagger"), world, record_paths=True).paths[0]
    first, second = (robot.sense(world, [path[step]]) for step in (4, 11))
    assert (first.ranges == 10).all()
    near = np.flatnonzero(second.ranges[0] < 10)
    assert near.tolist() == [0, 2, 3, 8]
    for reading in second.ranges[0, near]:
        assert f"{reading:.1f} m" in text
    assert second.target_region.tolist() == [1]
    assert np.degrees(path[12, 2] - path[11, 2]) == pytest.approx(60)
    assert "to the left by 60°" in text
    along = np.linspace(0, 10, 1001)[:, None]
    to_the_right, straight_on = (
        robot.clearance(
            world[np.zeros(len(along), int)],
            path[11, :2] + along * [np.cos(heading), np.sin(heading)],
        )
        for heading in path[11, 2] - np.radians([30, 0])
    )
    assert 2 < along[to_the_right < 1][0, 0] < 4  # in the second step of 2 m
    assert f"passed the rectangle at {straight_on.min():.1f} m" in text


def test_a_belief_update(written):
    text = written("partial-observation", "### An update by hand", "```{code-cell}")
    three = mdp.corridor("D..", accuracy=0.9, slip=0.1)
    predicted = three.predict(three.uniform(), 1)
    probability = three.observation_probabilities(three.uniform(), 1)[0]
    assert_written(text, predicted, 3)
    assert_written(text, predicted * three.likelihood(1, 0), 3)
    assert_written(text, probability, 3)
    assert_written(text, three.update(three.uniform(), 1, 0), 3)


def test_belief_after_three_observations(written):
    text = written("partial-observation", "### In the corridor", "How uncertain is")
    corridor = mdp.corridor("..D.....D.D....", accuracy=0.9, slip=0.1)
    belief = corridor.uniform()
    for seen in (1, 0, 1):
        belief = corridor.update(belief, 1, seen)
    assert belief.argmax() == 10
    assert "cell 10 holds" in text
    assert_written(text, np.sort(belief)[-2:], 2)


def test_three_plans_for_the_tiger(written):
    text = written("partial-observation", "A *plan* says", "The robot does not know")
    tiger = mdp.tiger(accuracy=0.85, discount=0.95)
    listen, _, right = tiger.mdp.rewards.T
    heard_left, heard_right = (tiger.likelihood(0, seen) for seen in (0, 1))
    again = np.full(2, listen.mean())
    waits = listen + 0.95 * (heard_left * right + heard_right * listen)
    vectors = [waits, listen + 0.95 * again, right + 0.95 * again]
    for vector in vectors:
        assert f"[{vector[0]:.2f}, {vector[1]:.2f}]" in text
    assert f"$[{waits[0]:.2f}, {waits[1]:.2f}]$" in text


def test_belief_of_two_poses_after_a_reading(written):
    text = written("partial-observation", "**By hand.**", "{dropdown} The model")
    errors = 4.5 - np.array([4.0, 6.0])
    exponents = -(errors**2) / (2 * 0.9**2)
    odds = np.exp(exponents[0] - exponents[1])
    assert_written(text, np.abs(exponents), 3)
    assert_written(text, [odds], 2)
    for readings in (1, 2):
        belief = np.array([odds**readings, 1]) / (odds**readings + 1)
        assert f"[{belief[0]:.2f}, {belief[1]:.2f}]" in text


def test_qmdp_at_the_fork(written):
    text = written("partial-observation", "QMDP waits forever", "## Localisation")
    fork = mdp.fork()
    belief = np.array([0.5, 0.5, 0.0])
    q = belief @ fork.mdp.action_values(mdp.value_iteration(fork.mdp).values)
    assert q[:2] == pytest.approx([9, 8])
    assert "= 9$ for waiting" in text
    assert "= 8$ for reading" in text


def test_qmdp_listens_to_the_tiger(written):
    """It opens a door where the best plan does, and promises far too much."""
    text = written(
        "partial-observation", "What does it do with the tiger", "A robot that"
    )
    tiger = mdp.tiger(accuracy=0.85, discount=0.95)
    by_qmdp = mdp.qmdp(tiger)
    assert [by_qmdp.action([left, 1 - left]) for left in (0.5, 0.85, 0.97)] == [0, 0, 2]
    assert by_qmdp.value([0.5, 0.5]) > 100
    points = mdp.spread_beliefs(tiger, [0.5, 0.5], 40)
    best = mdp.point_based_value_iteration(tiger, points).value([0.5, 0.5])
    assert f"worth {best:.1f} for the uniform belief" in text


def test_a_backup_of_an_alpha_vector(written):
    text = written("partial-observation", "With *one* step to go", "```{code-cell}")
    tiger = mdp.tiger(accuracy=0.85, discount=0.95)
    one_step = mdp.AlphaVectors(tiger.mdp.rewards.T, np.arange(3))
    belief = np.array([0.85, 0.15])
    for seen in (0, 1):
        carried = tiger.likelihood(0, seen) * one_step.vectors
        for value in carried @ belief:
            assert f"{value:.3f}".rstrip("0") in text
    two_steps = backup(tiger, belief[None], one_step)
    assert two_steps.actions.tolist() == [0]
    assert_written(text, two_steps.vectors, 2)
    assert_written(text, two_steps.value(belief), 2)
