"""The numbers of the explorables' JavaScript against Python's."""

import inspect
import re

import gymnasium as gym
import numpy as np
import pytest
from explorables.hashed_numbers import HashedNumbers
from gymnasium.spaces import Discrete
from gymnasium.wrappers import TimeLimit
from scipy.optimize import minimize_scalar
from scipy.special import logsumexp
from scipy.stats import binomtest, norm

from robonav import mdp, networks, nirl, nnql, planners
from robonav.lfd import demonstrate, plan, plan_on_grid
from robonav.nnql.reward import ROW_NUMBERS
from robonav.nnql.updates import RESCALE
from robonav.robot import (
    TARGET_ENCODINGS,
    Action,
    Reflex,
    Simulator,
    concatenate_worlds,
    degree_of_danger,
    make_world,
    navigate,
    random_worlds,
    sense,
    straight,
    turn_to_clearer_side,
)
from robonav.sensing import Picture, Ring
from robonav.widgets.explorables import EXPLORABLES, chapter2, chapter3, explorable
from robonav.widgets.simulator import page_world


@pytest.fixture
def compute(node):
    """Run JavaScript with the exports of an explorable; ``data.given`` is what its page gets."""

    def run(name, body, **data):
        given = explorable(name).data["given"]
        return node(
            EXPLORABLES[name].front_end,
            f"const {{ given }} = data; {body}",
            {"given": given, **data},
        )

    return run


def test_an_unknown_name_is_refused():
    with pytest.raises(ValueError, match=r"name must be one of .*discounted_return"):
        explorable("discount")


@pytest.mark.parametrize("name", EXPLORABLES)
def test_one_guess_is_right_for_a_reason_of_one_sentence(name):
    asked = EXPLORABLES[name]
    assert len(set(asked.guesses)) == len(asked.guesses) >= 2
    assert asked.right in asked.guesses
    assert asked.question.endswith(("?", ")"))
    assert asked.because.endswith(".")
    assert len(re.findall(r"[.?!](?=\s|$)", asked.because)) == 1
    data = explorable(name).data
    assert (data["right"], data["because"]) == (asked.right, asked.because)


def test_neither_place_nor_length_gives_the_right_guess_away():
    asked = [question for question in EXPLORABLES.values() if len(question.guesses) > 2]
    places = [
        question.guesses.index(question.right) / (len(question.guesses) - 1)
        for question in asked
    ]
    assert 0.3 < np.mean(places) < 0.7
    longest = [
        len(question.right) == max(map(len, question.guesses))
        and len(set(map(len, question.guesses))) > 1
        for question in asked
    ]
    assert np.mean(longest) < 0.5


@pytest.mark.parametrize("discount", [0.0, 0.5, 0.93, 1.0])
def test_returns(compute, discount):
    rewards = [1.0, -2.0, 0.5, 0.0, 4.0]
    seen = compute(
        "discounted_return",
        "return page.returnOf(data.rewards, data.discount);",
        rewards=rewards,
        discount=discount,
    )
    assert seen == pytest.approx(mdp.discounted_return(rewards, discount)[0], abs=1e-12)


def test_both_chargers_have_equal_returns_where_the_page_says():
    given = explorable("discounted_return").data["given"]
    assert round(given["equal"], 3) == 0.858  # as the answer on the page says
    far = mdp.discounted_return(given["far"], given["equal"])[0]
    assert far == pytest.approx(given["value"], abs=1e-12)


GRIDS = ["turn_arrows", "bellman_backup", "evaluate_improve"]


def model_of(name):
    return mdp.four_by_three().mdp(explorable(name).data["given"]["discount"])


@pytest.mark.parametrize("name", GRIDS)
def test_sums_over_the_model(compute, name):
    model = model_of(name)
    values = np.random.default_rng(0).normal(size=11) * ~mdp.four_by_three().terminal
    policy = np.random.default_rng(1).integers(4, size=11)
    body = """
    const model = page.modelOf(given.model);
    const states = data.values.map((_, s) => s);
    return {
      q: states.map((s) => page.actionValues(model, given.discount, data.values, s)),
      evaluated: page.evaluationSweep(model, given.discount, data.values, data.policy),
      improved: page.optimalitySweep(model, given.discount, data.values),
      greedy: page.greedy(model, given.discount, data.values, data.policy),
      exact: page.valuesOf(model, given.discount, data.policy),
    };"""
    seen = compute(
        name,
        body,
        values=values.tolist(),
        policy=policy.tolist(),
    )
    q = model.action_values(values)
    np.testing.assert_allclose(seen["q"], q, atol=1e-12)
    np.testing.assert_allclose(seen["improved"], q.max(axis=1), atol=1e-12)
    np.testing.assert_allclose(
        seen["evaluated"],
        mdp.bellman_policy_operator(model, policy, values),
        atol=1e-12,
    )
    np.testing.assert_allclose(
        seen["exact"], mdp.policy_evaluation(model, policy), atol=1e-9
    )
    ties = q >= q.max(axis=1, keepdims=True) - 1e-9
    assert ties[np.arange(11), seen["greedy"]].all()


def test_turning_the_wrong_arrow_raises_two_values():
    given = explorable("turn_arrows").data["given"]
    model, policy = model_of("turn_arrows"), np.array(given["policy"])
    before = mdp.policy_evaluation(model, policy)
    better = [
        (cell, action)
        for cell in range(11)
        for action in range(4)
        if mdp.is_optimal(model, [*policy[:cell], action, *policy[cell + 1 :]])
    ]
    assert len({cell for cell, _ in better}) == 1
    cell, action = better[0]
    policy[cell] = action
    assert (mdp.policy_evaluation(model, policy) > before + 5e-4).sum() == 2


def test_five_backups_bring_a_value_to_the_start(compute):
    body = """
    const model = page.modelOf(given.model);
    const values = given.layout.cells.map(() => 0);
    data.order.forEach((s) => (values[s] = page.backedUp(model, given.discount, values, s)));
    return values;"""
    order = [2, 1, 0, 4, 7]  # from beside the good exit to the start
    seen = compute("bellman_backup", body, order=order)
    values = np.zeros(11)
    for state in order:
        values[state] = model_of("bellman_backup").action_values(values)[state].max()
    np.testing.assert_allclose(seen, values, atol=1e-12)
    assert values[7] > 0


def test_four_improvements_after_single_sweeps_two_after_full_evaluations():
    given = explorable("evaluate_improve").data["given"]
    model = model_of("evaluate_improve")

    def needed(evaluate):
        policy, values = np.array(given["policy"]), np.zeros(11)
        for count in range(1, 20):
            values = evaluate(policy, values)
            policy = model.greedy(values)
            if mdp.is_optimal(model, policy):
                return count
        return None

    assert needed(lambda policy, v: mdp.bellman_policy_operator(model, policy, v)) == 4
    assert needed(lambda policy, v: mdp.policy_evaluation(model, policy)) == 2


@pytest.mark.parametrize("start", [[20.0, 20.0], [20.0, -20.0], [3.0, 0.0]])
@pytest.mark.parametrize("discount", [0.5, 0.9])
def test_two_starts_approach_each_other(compute, discount, start):
    body = "return page.sweepsFrom(page.modelOf(given.model), data.discount, data.start, 50);"
    seen = np.array(compute("contraction", body, discount=discount, start=start))
    model = chapter2.two_states(discount)
    values = np.array(start)
    for shown in seen:
        np.testing.assert_allclose(shown, values, atol=1e-12)
        values = mdp.bellman_optimality_operator(model, values)
    from_zero = np.array(
        compute("contraction", body, discount=discount, start=[0.0, 0.0])
    )
    gaps = abs(seen - from_zero).max(axis=1)
    assert (gaps[1:] <= discount * gaps[:-1] + 1e-12).all()
    if start == [20.0, 20.0] and discount == 0.9:
        assert np.flatnonzero(gaps <= 0.2)[0] == 44


class Replay(gym.Env):
    """An environment that goes as it was told, whatever the action."""

    def __init__(self, episodes):
        self.observation_space, self.action_space = Discrete(7), Discrete(1)
        self.episodes, self.rooms = iter(episodes), []

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.rooms = [int(room) for room in next(self.episodes)]
        return self.rooms.pop(0), {}

    def step(self, action):
        room = self.rooms.pop(0)
        return room, float(room == 6), not self.rooms, False, {}


def test_values_from_episodes(compute):
    episodes = explorable("td_step_size").data["given"]["episodes"][3]
    body = """
    const episodes = given.episodes[3].split(" ").map((episode) => [...episode].map(Number));
    const histories = [page.tdHistory(episodes, 0.13, 6, 7), page.monteCarloHistory(episodes, 6, 7)];
    return histories.map((history) => history.map((values) => [...values]));"""
    td, means = compute("td_step_size", body)
    one = np.ones((7, 1))
    options = {"discount": 1.0, "record": True, "seed": 0}
    by_td = mdp.td_prediction(
        Replay(episodes.split()), one, 100, learning_rate=0.13, initial=0.5, **options
    )
    by_returns = mdp.monte_carlo_prediction(
        Replay(episodes.split()), one, 100, visit="every", **options
    )
    inside = slice(1, 6)
    np.testing.assert_allclose(
        np.array(td)[:, inside], by_td.history[:, inside], atol=1e-12
    )
    np.testing.assert_allclose(
        np.array(means)[:, inside],
        np.nan_to_num(by_returns.history, nan=0.5)[:, inside],
        atol=1e-12,
    )


def test_a_larger_step_is_best_early_and_a_smaller_one_late(compute):
    body = """
    const runs = given.episodes.map((episodes) => episodes.split(" ").map((episode) => [...episode].map(Number)));
    const of = (episodes, alpha, k) => page.errorOf(page.tdHistory(episodes, alpha, 6, 7)[k], given.truth);
    const error = (alpha, k) => runs.reduce((sum, episodes) => sum + of(episodes, alpha, k), 0);
    return [10, 100].map((k) => data.rates.map((alpha) => error(alpha, k)));"""
    rates = [0.02, 0.04, 0.1, 0.24, 0.4]
    early, late = compute("td_step_size", body, rates=rates)
    assert (rates[np.argmin(early)], rates[np.argmin(late)]) == (0.24, 0.04)


@pytest.mark.parametrize("epsilon", [0.0, 0.3])
@pytest.mark.parametrize(
    ("method", "learn"), [("Q-learning", mdp.q_learning), ("SARSA", mdp.sarsa)]
)
def test_robots_beside_the_cliff_learn_as_in_python(compute, method, learn, epsilon):
    body = """
    const settings = { epsilon: data.epsilon, episodes: 60, seed: 5 };
    return page.learnOnCliff(given, data.method, settings);"""
    seen = compute("cliff_exploration", body, method=method, epsilon=epsilon)
    env = TimeLimit(chapter2.cliff().environment(), 200)
    env.reset(seed=0)
    q = [[0.0] * 4 for _ in range(env.observation_space.n)]
    visits = [[0] * 4 for _ in range(env.observation_space.n)]
    inspect.unwrap(learn)(
        env, q, visits, 60, discount=1.0, learning_rate=lambda visits: 0.1,
        epsilon=lambda episode: epsilon, rng=HashedNumbers(5),
    )  # fmt: skip
    np.testing.assert_allclose(seen, q, atol=1e-9)


@pytest.mark.slow
def test_the_paths_beside_the_cliff_are_those_of_the_answer_for_every_seed(compute):
    """With the page's 1000 episodes, at every exploration offered: Q-learning stays, SARSA keeps away."""
    body = """
    const rows = (method, epsilon, seed) => {
      const q = page.learnTogether(given, method, { epsilon, episodes: 1000, seed });
      const trajectory = page.greedyTrajectory(given, q);
      if (!given.ends[trajectory.at(-1)]) return -1;
      return 2 - Math.min(...trajectory.map((s) => given.layout.cells[s][0]));
    };
    const seeds = Array.from({ length: 25 }, (_, k) => k + 1);
    return ["Q-learning", "SARSA"].map((method) =>
      given.best.map((_, k) => seeds.map((seed) => rows(method, k * 0.05, seed))));"""
    q_learning, sarsa = np.array(compute("cliff_exploration", body))
    assert (q_learning == 0).all()
    assert (sarsa[0] == 0).all()
    assert (sarsa[1:] >= 1).all()
    assert (sarsa[2] == 1).all()  # with 0.1 one row is enough, as the page says
    assert (sarsa[8:] == 2).all()  # from 0.4 on along the far wall


@pytest.mark.parametrize(("accuracy", "slip"), [(0.9, 0.1), (0.6, 0.5), (0.99, 0.0)])
def test_beliefs_in_a_corridor_of_ones_own(compute, accuracy, slip):
    cells = ".DD...D.."
    body = """
    let belief = new Array(9).fill(1 / 9);
    return data.moves.map(([by, door]) => {
      if (by) belief = [...page.predict(belief, page.moved(data.cells, by, data.slip))];
      belief = page.weighed(belief, page.seen(data.cells, door, data.accuracy));
      return [belief, page.entropy(belief)];
    });"""
    moves = [(1, True), (1, False), (-1, True), (0, True), (1, False)]
    seen = compute(
        "own_corridor", body, cells=cells, moves=moves, accuracy=accuracy, slip=slip
    )
    pomdp = mdp.corridor(cells, accuracy=accuracy, slip=slip)
    belief = pomdp.uniform()
    for (by, door), (shown, bits) in zip(moves, seen, strict=True):
        belief = pomdp.update(belief, {-1: 0, 1: 1, 0: 2}[by], int(door))
        np.testing.assert_allclose(shown, belief, atol=1e-12)
        assert bits == pytest.approx(mdp.entropy(belief), abs=1e-9)


def test_a_door_tells_more_than_a_wall():
    pomdp = mdp.corridor(explorable("own_corridor").data["given"]["cells"])
    wall, door = (
        mdp.entropy(pomdp.update(pomdp.uniform(), 2, seen)) for seen in (0, 1)
    )
    assert (round(door, 2), round(wall, 2)) == (2.36, 2.95)  # as the page says


def test_plans_for_the_tiger(compute):
    given = explorable("tiger_vectors").data["given"]
    body = """
    const { plans, accuracies } = given;
    return plans.map((steps, k) => steps.map(({ vectors, actions }) => [-3, -2, 0, 1, 2].map((more) => {
      const belief = page.beliefAfter(more, accuracies[k]);
      const { at, value } = page.bestPlan(vectors, belief);
      return [belief, value, actions[at]];
    })));"""
    seen = compute("tiger_vectors", body)
    for accuracy, shown in zip(given["accuracies"], seen, strict=True):
        tiger = mdp.tiger(accuracy=accuracy)
        heard = tiger.update(tiger.update([0.5, 0.5], 0, 0), 0, 0)[0]
        assert shown[0][4][0] == pytest.approx(heard, abs=1e-12)
        for steps in (1, 2, 3):  # every plan of so many steps, one by one
            for belief, value, _ in shown[steps - 1]:
                exact = best_of_all_plans(tiger, np.array([belief, 1 - belief]), steps)
                assert value == pytest.approx(exact, abs=1e-3)
    listening, opening = seen[1][-1][3], seen[1][-1][4]
    assert (listening[2], opening[2]) == (0, 2)  # once is not enough, twice is


def best_of_all_plans(pomdp, belief, steps):
    """Value of a belief with some steps to go, through every action and observation."""
    if steps == 0:
        return 0.0
    values = []
    for action, reward in enumerate(pomdp.expected_rewards(belief)):
        probabilities = pomdp.observation_probabilities(belief, action)
        futures = [
            best_of_all_plans(pomdp, pomdp.update(belief, action, seen), steps - 1)
            for seen in range(2)
        ]
        values.append(reward + pomdp.mdp.discount * probabilities @ futures)
    return max(values)


def test_sensors_read_what_python_reads(compute):
    poses = [(17.0, 18.0, 40), (20.5, 21.0, 80), (2.0, 3.0, 350), (35.0, 20.0, 0)]
    body = """
    const pose = ([x, y, degrees]) => ({ x, y, heading: (degrees * Math.PI) / 180 });
    return data.poses.map((at) => page.readings(given.world, pose(at)));"""
    world = sensor_world()
    for (x, y, degrees), read in zip(
        poses, compute("sensor_sectors", body, poses=poses), strict=True
    ):
        sensed = sense(world, [(x, y, np.radians(degrees))])
        np.testing.assert_allclose(read["ranges"], sensed.ranges[0], atol=1e-6)
        assert read["degrees"] == degree_of_danger(sensed.ranges[0]).tolist()
        assert read["walls"] == sensed.walls[0].tolist()
        assert read["region"] == sensed.target_region[0]


def sensor_world():
    """The world of the explorable, put together again from what its page gets."""
    world = explorable("sensor_sectors").data["given"]["world"]
    circles = [(o["x"], o["y"], o["a"]) for o in world["obstacles"] if o["circle"]]
    rectangles = [
        (o["x"], o["y"], 2 * o["a"], 2 * o["b"], np.degrees(o["turned"]))
        for o in world["obstacles"]
        if not o["circle"]
    ]
    return make_world(
        circles=circles,
        rectangles=rectangles,
        start=world["start"],
        target=world["target"],
        size=world["size"],
    )


def test_a_turn_by_a_sector_moves_every_reading_on_by_one_sensor():
    poses = [(17.0, 18.0, np.radians(degrees)) for degrees in (40, 80)]
    world = sensor_world()
    before, after = sense(world[[0, 0]], poses).ranges
    np.testing.assert_allclose(after, np.roll(before, -1), atol=1e-6)


@pytest.mark.parametrize("speed", [2.0, 8.0])
def test_the_policy_decides_where_python_says(compute, speed):
    body = "return given.worlds.map((world) => page.decisions(world, { sight: 10, speed: data.speed }));"
    seen = compute("reflex_map", body, speed=speed)
    middles = np.arange(1.0, 100, 2)
    places = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    for obstacles, shown in zip((5, 10, 20, 30), seen, strict=True):
        world = random_worlds(1, obstacles, seed=41)
        towards = world.targets[0] - places
        poses = np.column_stack([places, np.arctan2(towards[:, 1], towards[:, 0])])
        sensing = sense(world[np.zeros(len(poses), int)], poses)
        commands = Reflex()(sensing, speed)
        kinds = np.select([sensing.safe, commands == Action.B], [0, 2], 1)
        kinds[sensing.ranges.min(axis=1) < 1] = 3
        assert (np.array(shown) == kinds).all()
        if (obstacles, speed) == (10, 2.0):
            assert round(100 * (kinds == 1).sum() / (kinds < 3).sum()) == 67


def test_page_of_the_robot_says_in_how_many_places_the_policy_decides(page_text):
    """The answer has the shares of the free places: among 10 obstacles, among 30, and with a range of 4 m."""
    middles = np.arange(1.0, 100, 2)
    places = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    shares = []
    for obstacles, sight in ((10, 10.0), (30, 10.0), (10, 4.0)):
        world = random_worlds(1, obstacles, seed=41)
        towards = world.targets[0] - places
        poses = np.column_stack([places, np.arctan2(towards[:, 1], towards[:, 0])])
        sensing = sense(world[np.zeros(len(poses), int)], poses)
        nearest = sensing.ranges.min(axis=1)
        blocked = Reflex()(sensing, 2.0) == Action.B
        free = nearest >= 1
        shares.append((free & (nearest < sight) & ~blocked).sum() / free.sum())
    said = re.search(
        r"In (\d+) %, on this map.*?30 obstacles it is (\d+) %.*?it would be (\d+) %",
        page_text("robot"),
        re.S,
    )
    assert [int(number) for number in said.groups()] == [
        round(100 * share) for share in shares
    ]


@pytest.mark.parametrize(("speed", "near"), [(2, 10), (7, 10), (4, 6), (4.5, 6)])
def test_episodes_past_an_obstacle_end_as_in_python(compute, speed, near):
    body = "return page.episodes(given.world, { speed: data.speed, turnAt: data.near }).map(({ outcome }) => outcome);"
    seen = compute("speed_and_sight", body, speed=speed, near=near)
    worlds = concatenate_worlds(
        [
            make_world(
                circles=[(50, 50, 4)], start=(10 + k * speed / 40, 50), target=(90, 50)
            )
            for k in range(40)
        ]
    )

    def policy(sensing, rng):
        return np.where(sensing.ranges[:, 0] < near, 2, 0)

    result = navigate(policy, worlds, speed=speed, max_steps=400)
    assert [outcome == "collided" for outcome in seen] == result.collision.tolist()
    assert [outcome == "arrived" for outcome in seen] == result.success.tolist()
    if near == 6:
        assert result.collision.any() == (speed > 4)  # as the page says


@pytest.mark.parametrize("width", [12, 20])
@pytest.mark.parametrize("depth", [0, 2, 7, 8, 12])
def test_pockets_hold_the_robot_as_in_python(compute, width, depth):
    body = "return page.episodeInPocket(page.withPocket(given.world, data));"
    seen = compute("pocket", body, width=width, depth=depth)
    side = width / 2 + 1
    arms = [(60 - depth / 2, 50 + s, depth, 2, 0) for s in (side, -side) if depth]
    world = make_world(
        rectangles=[(60, 50, 2, width + 4, 0), *arms], start=(20, 50), target=(90, 50)
    )
    result = navigate(
        turn_to_clearer_side, world, max_steps=300, record_paths=True, reflex=Reflex("exact")
    )  # fmt: skip
    assert (seen["outcome"] == "arrived") == result.success[0]
    assert (seen["outcome"] == "collided") == result.collision[0]
    np.testing.assert_allclose(seen["path"], result.paths[0][:, :2], atol=1e-9)
    if width == 12:
        assert result.success[0] == (depth < 8)  # as the page says


def test_a_neuron_answers_as_in_python(compute):
    neuron = {"first": 2.5, "second": -1.5, "bias": 0.5}
    one = networks.Network((np.array([[2.5, -1.5]]),), (np.array([0.5]),))
    body = """
    return given.sets.map(({ points, labels }) =>
      [points.map((point) => page.answer(data.neuron, point)), page.right(data.neuron, points, labels)]);"""
    seen = compute("neuron_line", body, neuron=neuron)
    sets = explorable("neuron_line").data["given"]["sets"]
    for (answers, count), chosen in zip(seen, sets, strict=True):
        said = one.forward(np.array(chosen["points"]))[:, 0]
        np.testing.assert_allclose(answers, said, atol=1e-12)
        assert count == ((said > 0.5) == np.array(chosen["labels"])).sum()


def test_one_line_divides_two_clouds_and_not_opposite_corners():
    clouds, corners = explorable("neuron_line").data["given"]["sets"]
    directions = np.linspace(0, 2 * np.pi, 90)
    for chosen, can in ((clouds, True), (corners, False)):
        points, labels = np.array(chosen["points"]), np.array(chosen["labels"])
        along = points @ [np.cos(directions), np.sin(directions)]
        best = max(
            ((along[:, k] + offset > 0) == labels).mean()
            for k in range(90)
            for offset in np.linspace(-3, 3, 61)
        )
        assert bool(best == 1) is can


@pytest.mark.parametrize("first", [1.0, 8.0, -3.5])
def test_errors_travel_back_as_in_python(compute, first):
    numbers = {"x": 0.8, "y": 0.2, "first": first, "second": 2.0}
    seen = compute("backpropagation_by_hand", "return page.passes(data);", **numbers)
    network = networks.Network(
        (np.array([[first]]), np.array([[2.0]])), (np.zeros(1), np.zeros(1))
    )
    x, y = np.array([[0.8]]), np.array([[0.2]])
    activations = network.activations(x)
    assert seen["a2"] == pytest.approx(activations[1].item(), abs=1e-12)
    assert seen["a3"] == pytest.approx(activations[2].item(), abs=1e-12)
    cost = networks.squared_error_cost(network, x, y, regularisation=0.0)
    assert seen["cost"] == pytest.approx(cost, abs=1e-12)
    gradient = networks.squared_error_gradient(network, x, y, regularisation=0.0)
    assert seen["gradient1"] == pytest.approx(gradient.weights[0].item(), abs=1e-12)
    assert seen["gradient2"] == pytest.approx(gradient.weights[1].item(), abs=1e-12)
    assert seen["delta3"] == pytest.approx(gradient.biases[1].item(), abs=1e-12)
    assert seen["delta2"] == pytest.approx(gradient.biases[0].item(), abs=1e-12)


SEARCH = """
const { target, points } = given;
const search = page.newSearch(given);
while (search.closed.at(-1) !== target) page.expand(search, given, page.nextOf(search, given, data.rule));
return { order: search.closed.map((k) => points[k]), length: search.G[target] };
"""


def test_nodes_are_expanded_in_pythons_order(compute):
    seen = compute("astar_by_hand", SEARCH, rule="F")
    made = plan_on_grid(chapter3.small_map(), margin=2.0, cell=5.0, record=True)
    assert seen["length"] == pytest.approx(made.length, abs=1e-9)
    assert len(seen["order"]) == made.expanded
    np.testing.assert_allclose(seen["order"], made.visited, atol=1e-9)


def test_without_the_estimate_the_search_expands_more_nodes(compute):
    by_f, by_g, by_h = (compute("astar_by_hand", SEARCH, rule=rule) for rule in "FGH")
    assert by_g["length"] == pytest.approx(by_f["length"])
    assert (len(by_f["order"]), len(by_g["order"])) == (22, 39)  # as the page says
    assert len(by_h["order"]) < len(by_f["order"])
    assert by_h["length"] > by_f["length"]


@pytest.mark.slow
@pytest.mark.parametrize(("margin", "caution"), [(1.0, 0), (3.0, 0), (4.5, 2)])
def test_paths_with_a_margin_are_the_planners(compute, margin, caution):
    body = "return given.paths[page.placeOf(given, data)];"
    seen = compute("margin_and_caution", body, margin=margin, caution=caution)
    world = random_worlds(1, obstacles=15, seed=21)
    made = plan(world, margin=margin, caution=caution, cell=2)
    assert seen["length"] == pytest.approx(made.length, abs=1e-9)
    np.testing.assert_allclose(seen["points"], made.points, atol=0.0051)
    if caution == 0 and margin <= 3:
        assert round(seen["length"]) == 114  # as the question and the answer say


# ---- Chapter 5 ------------------------------------------------------------------------------------------------------


def test_copied_actions_where_the_target_stays_are_the_best_ones():
    first, *moved = explorable("reward_transfer").data["given"]["terrains"]
    assert first["still"] == first["cells"]
    assert first["copied"]["values"] == pytest.approx(
        first["reward"]["values"], abs=1e-9
    )
    for terrain in moved:
        start = terrain["start"]
        assert (
            terrain["copied"]["values"][start] < terrain["reward"]["values"][start] - 1
        )
    assert {g["name"]: g["still"] for g in moved}["top left"] == 13  # as the page says


@pytest.mark.parametrize("counts", [(10, 1, 1000, 0), (0, 0, 3, 4), (5, 5, 0, 20)])
def test_evidence_of_actions(compute, counts):
    here, elsewhere = counts[:2], counts[2:]
    seen = compute(
        "inconsistent_expert",
        "return page.evidence(data.here, data.elsewhere);",
        here=here,
        elsewhere=elsewhere,
    )
    states = [0] * sum(here) + [1] * sum(elsewhere)
    actions = [
        a for part in (here, elsewhere) for a in range(2) for _ in range(part[a])
    ]
    if sum(here):
        by_frequency = nirl.most_frequent(states, actions, 2).actions[0]
        by_likelihood = nirl.map_uniform_prior(states, actions, 2).actions[0]
        assert int(np.argmax(seen["joint"])) == by_frequency
        assert int(np.argmax(seen["likelihood"])) == by_likelihood


@pytest.mark.parametrize("discount", [0.5, 0.9, 1.0])
def test_trajectories_collect_discounted_features(compute, discount):
    given = explorable("trajectory_features").data["given"]
    for trajectory in given["trajectories"]:
        body = """
        const mu = page.collected(data.kinds, 4, data.discount);
        return { mu, value: page.returnOf(given.weights, mu) };"""
        seen = compute(
            "trajectory_features", body, kinds=trajectory["kinds"], discount=discount
        )
        features = np.eye(4)[trajectory["kinds"]]
        sums = nirl.discounted_feature_sums(features, [0] * len(features), discount)
        assert seen["mu"] == pytest.approx(sums[0], abs=1e-12)
        value = nirl.value_of_expectations(nirl.TRUE_WEIGHTS, sums[0])
        assert seen["value"] == pytest.approx(value, abs=1e-12)


def test_soft_maximum(compute):
    values = [1.0, 1.0, 0.0]
    seen = compute(
        "soft_maximum_of_three",
        "return [1e-9, 0.5, 2].map((t) => page.softMaximum(data.values, t));",
        values=values,
    )
    expected = [t * logsumexp(np.array(values) / t) for t in (1e-9, 0.5, 2.0)]
    assert seen == pytest.approx(expected, abs=1e-12)


def test_widest_lead(compute):
    given = explorable("widest_margin").data["given"]
    body = "return page.widestLead(data.expert, given.others);"
    for expert in (given["expert"], [0.0, 2.5], [-1.0, -2.0]):
        seen = compute("widest_margin", body, expert=expert)
        exact = nirl.maximum_margin(expert, given["others"])
        assert seen["lead"] == pytest.approx(exact.margin, abs=1e-9)
    inside = np.mean(given["others"], axis=0).tolist()
    assert compute("widest_margin", body, expert=inside)["lead"] <= 0


def test_projection_steps(compute):
    given = explorable("projection_steps").data["given"]
    points, expert = np.array(given["points"]), np.array(given["expert"])
    body = "return page.mixtures(given.points, given.expert, given.first, 6).all;"
    seen = compute("projection_steps", body)
    mixture = points[given["first"]]
    for found in seen[1:]:
        policy = points[(points @ (expert - mixture)).argmax()]
        line = minimize_scalar(
            lambda share, m=mixture, p=policy: np.linalg.norm(
                m + share * (p - m) - expert
            ),
            bounds=(0, 1),
            method="bounded",
            options={"xatol": 1e-12},
        )
        mixture = mixture + line.x * (policy - mixture)
        assert found == pytest.approx(mixture, abs=1e-5)


def test_boltzmann(compute):
    given = explorable("boltzmann_temperature").data["given"]
    assert given["sure"] == 22.0  # as the page says
    body = "return page.boltzmannPolicy(given.values, data.eta);"
    for eta in (0.0, 7.5, 60.0):
        seen = compute("boltzmann_temperature", body, eta=eta)
        assert seen == pytest.approx(nirl.boltzmann_policy(given["values"], eta))


def test_accuracy_and_balanced_accuracy(compute):
    actions = np.repeat(np.arange(5), [60, 10, 10, 10, 10])
    predicted = np.zeros_like(actions)
    seen = compute(
        "accuracy_or_balance",
        "return page.scores([60, 10, 10, 10, 10], [1, 0, 0, 0, 0]);",
    )
    assert seen["accuracy"] == pytest.approx(nirl.accuracy(predicted, actions))
    assert seen["balanced"] == pytest.approx(nirl.balanced_accuracy(predicted, actions))


def test_weights_of_samples(compute):
    given = explorable("weights_of_samples").data["given"]
    body = """
    const weights = page.sampleWeights(given.features, data.theta);
    return { weights, effective: page.effectiveSamples(weights) };"""
    features = np.array(given["features"])
    for theta in (0.0, 20.0, 60.0):
        seen = compute("weights_of_samples", body, theta=theta)
        weights = nirl.importance_weights(
            [theta], features[:, None], np.zeros(len(features))
        )
        assert seen["weights"] == pytest.approx(weights, abs=1e-12)
        assert seen["effective"] == pytest.approx(1 / (weights**2).sum())


def test_value_of_an_end(compute):
    body = "return page.valueOfEnding(7, 0.3, 0.8, 0.65);"
    rewards = [0.3] * 7
    value = mdp.discounted_return(rewards, 0.65)[0] + 0.65**7 * 0.8 / (1 - 0.65)
    assert compute("value_of_an_end", body) == pytest.approx((1 - 0.65) * value)


@pytest.mark.slow
def test_accuracy_counts_as_in_python(compute):
    body = """
    const [first, second] = given.policies;
    return [
      [first, second].map((policy) => page.accuracy(policy, given, "pairs", 0)),
      page.accuracy(first, given, "pairs", 1), page.accuracy(first, given, "balanced", 0),
    ];"""
    near, every, balanced = compute("accuracy_and_success", body)
    worlds = random_worlds(25, obstacles=10, seed=7)
    demonstrations = demonstrate(worlds)
    pairs = demonstrations.effective
    same = [
        policy(pairs.sensing, np.random.default_rng(0)) == pairs.actions
        for policy in (straight, turn_to_clearer_side)
    ]
    np.testing.assert_allclose(near, [one.mean() for one in same], atol=1e-12)
    safe = len(demonstrations) - len(pairs)
    assert every == pytest.approx((same[0].sum() + safe) / len(demonstrations))
    assert balanced == pytest.approx(0.2)  # it is right for one action of five
    assert [round(100 * share, 1) for share in near] == [44.1, 44.1]  # as asked
    first, second, _ = explorable("accuracy_and_success").data["given"]["policies"]
    assert second["success"] - first["success"] > 0.5


@pytest.mark.parametrize(("reached", "maps"), [(8, 8), (0, 20), (93, 100), (460, 500)])
def test_intervals_are_wilsons(compute, reached, maps):
    seen = compute(
        "wilson_interval",
        "return page.wilsonInterval(data.reached, data.maps);",
        reached=reached,
        maps=maps,
    )
    interval = binomtest(reached, maps).proportion_ci(method="wilson")
    assert seen == pytest.approx([interval.low, interval.high], abs=1e-9)
    if maps == 8:
        assert round(100 * interval.low) == 68  # as the page says


@pytest.mark.parametrize(
    ("error", "off", "back"), [(0.01, 0.9, 0.2), (0.05, 0.3, 1.0), (0.02, 1.0, 0.5)]
)
def test_errors_add_up_as_values_of_a_chain(compute, error, off, back):
    body = "return page.expectedErrors(data, 100);"
    seen = compute("compounding_errors", body, error=error, off=off, back=back)
    returning = (1 - off) * back
    chain = mdp.FiniteMDP(
        [[[1 - error, error], [returning, 1 - returning]]], [[error], [off]], 0.999999
    )
    values = [
        mdp.finite_horizon_evaluation(chain, [0, 0], steps)[0] for steps in (1, 20, 100)
    ]
    assert [seen[0], seen[19], seen[99]] == pytest.approx(values, rel=1e-4)
    if off == 0.9:
        assert round(seen[99]) == 21  # as the page says


def test_targets_are_encoded_as_in_python(compute):
    body = """
    const sectors = [1, 2, 3, 4, 5, 6, 7, 8, 9];
    return data.names.map((name) => [
      sectors.map((sector) => page.encodedTarget(name, sector)),
      sectors.map((sector) => page.jump(name, sector, (sector % 9) + 1)),
    ]);"""
    names = list(TARGET_ENCODINGS)
    largest = {}
    for name, (inputs, jumps) in zip(
        names, compute("target_encoding", body, names=names), strict=True
    ):
        encoded = TARGET_ENCODINGS[name](np.arange(1, 10)).reshape(9, -1)
        np.testing.assert_allclose(inputs, encoded, atol=1e-12)
        apart = np.linalg.norm(np.roll(encoded, -1, axis=0) - encoded, axis=1)
        np.testing.assert_allclose(jumps, apart, atol=1e-12)
        largest[name] = round(apart.max(), 2)
    assert largest == {
        "number": 0.89,
        "signed": 2.0,
        "one-hot": 1.41,
        "sine-cosine": 0.68,
    }


# ---- Chapter 4 ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("how", ["clip", "shift"])
def test_rescaled_targets(compute, how):
    body = """
    const updated = page.qTargets(Float64Array.from(given.q), given.taken, 1.3, 0, 0.8, 0);
    return [...page.RESCALE[data.how](updated)];"""
    q = np.array(explorable("one_q_update").data["given"]["q"])
    updated = nnql.q_targets(q, 1, 1.3, 0.0, 0.8, 0.0)
    seen = compute("one_q_update", body, how=how)
    assert seen == pytest.approx(RESCALE[how](updated), abs=1e-12)


def test_one_pair_moves_other_values(compute):
    body = "return page.trainedOn(given.network, given.states, data.state);"
    state = {"action": 1, "target": 0.9, "steps": 20}
    seen = compute("moving_together", body, state=state)
    network, states = (
        networks.random_network((2, 4, 3), seed=8),
        [[1.0, 0.3], [0.6, 0.8]],
    )
    for _ in range(20):
        wanted = network.forward(np.array(states[0]))
        wanted[1] = 0.9
        network = nnql.train_on_pairs(
            network, [np.array(states[0])], [wanted], 1.0, 1, 0.0
        )
    assert seen["after"] == pytest.approx(network.forward(np.array(states)), abs=1e-12)


def test_rows_of_the_reward(compute):
    distances = np.arange(1, 10.5, 0.5).tolist()
    body = """
    const row = (a, b) => page.rewardRow({ ranges: [a] }, { ranges: [b] }, "running");
    return data.distances.map((a) => data.distances.map((b) => row(a, b)));"""
    seen = compute("row_of_the_reward", body, distances=distances)
    for before, line in zip(distances, seen, strict=True):
        for after, row in zip(distances, line, strict=True):
            properties = (nnql.property_at(before), nnql.property_at(after))
            nearer = int(np.clip(np.floor(before - after), 0, 3))
            assert row == ROW_NUMBERS[(*properties, nearer)]


def test_cooling_down(compute):
    seen = compute(
        "cooling_down", "return [0.9, 0.1].map((t) => page.bestTaken(0.1, t));"
    )
    expected = [
        nnql.softmax_policy(np.array([0.1, 0, 0, 0, 0]), t)[0] for t in (0.9, 0.1)
    ]
    assert seen == pytest.approx(expected, abs=1e-12)


def test_work_of_an_episode(compute):
    pairs = sum(3 * k for k in range(1, 41))
    assert compute("work_of_an_episode", "return page.stepsOf(40, 3);") == pairs == 2460


@pytest.mark.parametrize(("width", "tilings"), [(1.0, 4), (0.5, 3), (1.5, 8), (2.0, 1)])
def test_shared_tiles_are_those_of_the_package(compute, width, tilings):
    body = "return data.places.map((x) => page.sharedTiles(2.53, x, data.width, data.tilings));"
    places = (np.arange(60) / 10 + 0.03).tolist()
    seen = compute("shared_tiles", body, places=places, width=width, tilings=tilings)
    line = mdp.Tiles((0.0,), (6.0,), (int(6 / width),), tilings, n_actions=1)
    expected = [(line.active([2.53]) == line.active([x])).mean() for x in places]
    assert seen == pytest.approx(expected)
    assert max(seen) == 1
    assert min(seen) == 0


def test_largest_of_normal_numbers():
    means = explorable("overestimation").data["given"]["means"]
    drawn = np.random.default_rng(0).normal(size=(200_000, 10)).max(axis=1)
    assert means[0] == pytest.approx(0, abs=1e-6)
    assert means[1] == pytest.approx(1 / np.sqrt(np.pi), abs=1e-6)
    assert means[9] == pytest.approx(drawn.mean(), abs=0.01)


def test_seeds_to_tell_apart(compute):
    body = "return data.at.map((at) => page.normalCdf(given.x, given.cdf, at));"
    at = [-7.0, 0.0, 0.7071, 3.3, 8.0]
    seen = compute("seeds_to_tell_apart", body, at=at)
    assert seen == pytest.approx(norm.cdf(at), abs=1e-3)


def test_circle_or_target(compute):
    state = {"circling": 0.1, "seconds": 20, "discount": 0.9}
    seen = compute(
        "circle_or_target", "return page.bothReturns(data.state);", state=state
    )
    rewards = np.zeros(20)
    rewards[-1] = 1.0
    assert seen["target"] == pytest.approx(mdp.discounted_return(rewards, 0.9)[0])
    forever = mdp.discounted_return([0.1] * 2000, 0.9)[0]
    assert seen["circle"] == pytest.approx(forever)


@pytest.mark.parametrize(("first", "last"), [(0.8, 0.8), (0.8, 0.1), (0.3, 0.6)])
def test_each_target_counts_as_in_the_update(compute, first, last):
    body = """
    const rates = page.ratesOf(data);
    return [rates, page.weightsOf(rates)];"""
    rates, seen = compute("weight_of_targets", body, first=first, last=last)
    fractions = np.linspace(0, 1, 20)
    np.testing.assert_allclose(
        rates, nnql.geometric_schedule((first, last), fractions), atol=1e-12
    )
    q = np.zeros(20)  # one value for each target that is 1 while the others are 0
    for number, rate in enumerate(rates):
        q = q + rate * (np.eye(20)[number] - q)
        one = nnql.q_targets(np.array([0.4]), 0, 1.0, 0.0, rate, 0.9)[0]
        assert one == pytest.approx(0.4 + rate * 0.6)
    np.testing.assert_allclose(seen["weights"], q, atol=1e-12)
    assert seen["start"] == pytest.approx(1 - q.sum(), abs=1e-12)
    if first == last == 0.8:
        assert 1 / (q**2).sum() == pytest.approx(1.5)  # as the page says


@pytest.mark.parametrize("discount", [0.0, 0.5, 0.9])
def test_values_out_of_range(compute, discount):
    body = """
    const values = page.trueValues(given.rewards, data.discount);
    return [values, page.RESCALE.clip(values), page.RESCALE.shift(values)];"""
    values, clipped, shifted = compute("values_out_of_range", body, discount=discount)
    rewards = explorable("values_out_of_range").data["given"]["rewards"]
    again = mdp.FiniteMDP(np.ones((5, 1, 1)), [rewards], discount)
    best = mdp.value_iteration(again, 1e-9).values
    np.testing.assert_allclose(values, again.action_values(best)[0], atol=1e-6)
    np.testing.assert_allclose(clipped, nnql.clip(np.array(values)), atol=1e-12)
    np.testing.assert_allclose(shifted, nnql.shift(np.array(values)), atol=1e-12)
    if discount == 0.9:
        assert set(clipped) == {1}  # none can be told apart, as the page says


def places_among(world, n, seed):
    """Places with headings in the first world, none of which collides."""
    rng = np.random.default_rng(seed)
    poses = np.column_stack(
        [rng.uniform(2, world.size - 2, (n, 2)), rng.uniform(-np.pi, np.pi, n)]
    )
    ranges = sense(concatenate_worlds([world] * n), poses).ranges
    return poses[ranges.min(axis=1) >= 1]


def two_circles(gap, size=50.0):
    """The world of the explorable with its circles so far apart."""
    away = 3.5 + gap / 2
    circles = [(24, 25 + away, 3.5), (24, 25 - away, 3.5)]
    return make_world(circles, start=(4, 25), target=(46, 25), size=size)


def test_forces_are_those_of_the_package(compute):
    world = two_circles(4.0)
    poses = places_among(world, 150, seed=0)
    body = """
    return data.poses.map(([x, y, heading]) => {
      const seen = page.sense(data.world, { x, y, heading });
      const action = page.potentialFieldAction(seen, { ...data.settings, inertia: 1 });
      return [...page.totalForce(seen, data.settings), action];
    });"""
    settings = {"repulsion": 60.0, "influence": 10.0}
    seen = np.array(
        compute(
            "potential_field_forces", body,
            world=page_world(world), poses=poses.tolist(), settings=settings,
        )
    )  # fmt: skip
    sensing = sense(concatenate_worlds([world] * len(poses)), poses)
    attraction, repulsions = planners.potential_field(sensing, **settings)
    np.testing.assert_allclose(
        seen[:, :2], attraction + repulsions.sum(axis=1), atol=1e-9
    )
    actions = planners.PotentialField(**settings, inertia=1.0)(sensing, None)
    np.testing.assert_array_equal(seen[:, 2], actions)


@pytest.mark.parametrize("gap", [0.5, 2.0, 6.0, 10.0])
@pytest.mark.parametrize("inertia", [0.0, 1.0])
def test_a_robot_follows_forces_as_in_python(compute, gap, inertia):
    world = two_circles(gap)
    settings = {"repulsion": 80.0, "influence": 10.0, "inertia": inertia}
    body = "return page.followForces(data.world, data.settings);"
    seen = compute("potential_field_forces", body, world=page_world(world), settings=settings)  # fmt: skip
    policy = planners.PotentialField(**settings)
    result = navigate(policy, world, max_steps=120, record_paths=True)
    assert (seen["outcome"] == "arrived") == result.success[0]
    np.testing.assert_allclose(seen["path"], result.paths[0][:, :2], atol=1e-9)
    if gap <= 2 and inertia == 0:
        assert not result.success[0]  # as the answer on the page says


def test_histograms_and_directions_are_those_of_the_package(compute):
    given = explorable("polar_histogram_openings").data["given"]
    world = make_world(
        circles=[(24, 26, 2), (25, 15, 2.5)], rectangles=[(34, 21, 3, 6, 20)],
        start=(5, 5), target=(38, 20), size=40.0,
    )  # fmt: skip
    assert page_world(world) == given["world"]
    poses = places_among(world, 200, seed=1)
    body = """
    const settings = { clearance: 1.4, threshold: 0.4, halfWidth: 0.1, wide: 12, keep: 0.3 };
    return data.poses.map(([x, y, heading]) => page.lookAround(given.world, { x, y, heading }, settings));"""
    seen = compute("polar_histogram_openings", body, poses=poses.tolist())
    sensing = sense(concatenate_worlds([world] * len(poses)), poses)
    histogram = planners.polar_histogram(sensing.ranges, clearance=1.4, half_width=0.1)
    np.testing.assert_allclose([one["histogram"] for one in seen], histogram, atol=1e-9)
    bearings = planners.vector_field_histogram(
        histogram, planners.target_bearing(sensing), threshold=0.4, wide=12, keep=0.3
    )
    chosen = [np.pi if one["bearing"] is None else one["bearing"] for one in seen]
    np.testing.assert_allclose(chosen, bearings, atol=1e-9)


def test_a_larger_clearance_narrows_the_openings(compute):
    body = """
    const [x, y] = given.pose;
    return [1, 3].map((clearance) => {
      const settings = { clearance, threshold: 0.3, halfWidth: 0, wide: 16, keep: 0.2 };
      const { free } = page.lookAround(given.world, { x, y, heading: 0 }, settings);
      return [page.openings(free), free.filter(Boolean).length];
    });"""
    (openings, bins), (fewer, left) = compute("polar_histogram_openings", body)
    assert openings >= 2
    assert fewer <= openings
    assert left < bins


def around_the_gap():
    """The world of the explorable, and places in it, some of them in an obstacle."""
    world = make_world(
        circles=[(20, 23.4, 2), (20, 16.6, 2)], rectangles=[(9, 33, 6, 3, 30)],
        start=(5, 5), target=(35, 20), size=40.0,
    )  # fmt: skip
    return world, places_among(world, 60, seed=2)


@pytest.mark.parametrize("sectors", [9, 18, 36, 72])
def test_rings_and_pictures_are_those_of_the_package(compute, sectors):
    world, poses = around_the_gap()
    assert page_world(world) == explorable("ring_and_picture").data["given"]["world"]
    body = """
    return data.poses.map(([x, y, heading]) => {
      const pose = { x, y, heading };
      return [page.ringRanges(given.world, pose, data.sectors), page.coveredCells(given.world, pose, 32)];
    });"""
    found = compute("ring_and_picture", body, poses=poses.tolist(), sectors=sectors)
    simulator = Simulator(concatenate_worlds([world] * len(poses)))
    simulator.poses[:] = poses
    everyone = np.arange(len(poses))
    ranges = Ring(sectors).ranges(simulator, everyone)
    np.testing.assert_allclose([ring for ring, _ in found], ranges, atol=1.1e-6)
    pictures = Picture(32)(simulator, everyone)
    assert [cells for _, cells in found] == [np.argwhere(p).tolist() for p in pictures]


def test_the_gap_is_seen_by_the_rings_that_the_answer_names(compute):
    body = """
    const [x, y] = given.pose;
    return [9, 18, 36, 72].map((n) => page.ringRanges(given.world, { x, y, heading: 0 }, n)[0]);"""
    ahead = compute("ring_and_picture", body)
    assert [metres == 10 for metres in ahead] == [False, False, True, True]
    half = np.arctan2(3.4, 8) - np.arcsin(2 / np.hypot(3.4, 8))
    asked = EXPLORABLES["ring_and_picture"]
    assert f"{np.degrees(half):.1f}°" in asked.question
