"""The imitation lab: the expert's demonstrations, learning and driving in the page as in Python."""

import base64

import numpy as np
import pytest

from robonav.benchmark.policies import method
from robonav.experiments import bootstrap_interval
from robonav.lfd import demonstrate, labelled_states, learn_policy, save_demonstrations
from robonav.networks import NetworkPolicy, fit
from robonav.robot import navigate, random_worlds, straight
from robonav.widgets.imitation_lab import ImitationLab, imitation_lab
from robonav.widgets.simulator import page_policy

FILES = (
    "simulator", "maps", "episode", "files", "learning/random", "learning/worlds",
    "learning/network", "learning/lbfgs", "learning/trials", "learning/worker",
    "learning/training_panel", "learning/kernel_panel", "kept_demonstrations", "kept_robots",
    "imitation", "imitation_lab",
)  # fmt: skip
IMITATE = """
const { expert, trial, seeds, iterations, regularisation, count, book } = data;
const encoder = { sensors: [1, 2, 3, 4, 5, 6, 7, 8, 9], walls: false, target: "sine-cosine" };
const rivals = [{ ...book }, { rule: "straight" }];
return seeds.map((seed) => {
  const examples = page.examplesFrom(page.replayed(expert).slice(0, count));
  const learning = { examples, sizes: [12, 8, 5], seed, regularisation, iterations };
  const task = { ...learning, network: null, encoder, rivals, trial };
  const outcomes = [];
  for (const { live } of page.imitate(task)) if (live.outcomes) outcomes.push(live.outcomes);
  return outcomes;
});
"""


@pytest.fixture(scope="module")
def lab() -> ImitationLab:
    return imitation_lab(method("lfd"), demonstrations=25)


@pytest.fixture(scope="module")
def demonstrations():
    return demonstrate(random_worlds(25, 10, seed=9))


def test_the_expert_drives_in_the_page_as_in_python(node, lab, demonstrations):
    body = """return page.replayed(data).map(({ steps, outcome }) => ({
      outcome, poses: steps.map(({ pose }) => [pose.x, pose.y, pose.heading]),
    }));"""
    got = node(FILES, body, lab.data["expert"])
    assert [each["outcome"] for each in got] == demonstrations.outcome.tolist()
    poses = np.concatenate([each["poses"] for each in got])
    np.testing.assert_allclose(poses, demonstrations.poses, rtol=0, atol=1e-9)


def test_examples_are_pythons(node, lab, demonstrations):
    body = """const { m, x, y } = page.examplesFrom(page.replayed(data)); return { m, x: [...x], y: [...y] };"""
    got = node(FILES, body, lab.data["expert"])
    x, y = labelled_states(demonstrations)
    assert got["m"] == len(x)
    np.testing.assert_allclose(got["x"], x.ravel(), atol=1e-12)
    np.testing.assert_array_equal(got["y"], y.ravel())


def test_rivals_end_in_every_new_map_as_in_python(node, lab):
    given = {
        **lab.data, "trial": {"seed": 2024, "maps": 200, "obstacles": 20},
        "seeds": [0], "iterations": 1, "regularisation": 0.1, "count": 1,
    }  # fmt: skip
    (outcomes,) = node(FILES, IMITATE, given)
    unseen = random_worlds(200, 20, seed=2024)
    for rival, policy in ((1, method("lfd")), (2, straight)):
        expected = navigate(policy, unseen).outcome.tolist()
        assert [ends[rival] for ends in outcomes] == expected


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [10, pytest.param(20, marks=pytest.mark.exhaustive)])
def test_robots_of_many_seeds_arrive_as_often_as_pythons(
    node, lab, demonstrations, seeds
):
    """With the page's settings. Rounding makes two networks of one; they drive similarly, but not identically."""
    given = {
        **lab.data, "trial": {"seed": 2024, "maps": 100, "obstacles": 20},
        "seeds": list(range(seeds)), "iterations": 300, "regularisation": 0.1, "count": 25,
    }  # fmt: skip
    got = node(FILES, IMITATE, given)
    ours = np.array([np.mean([ends[0] == "arrived" for ends in run]) for run in got])
    unseen = random_worlds(100, 20, seed=2024)
    theirs = np.array(
        [
            navigate(
                learn_policy(demonstrations, regularisation=0.1, seed=s), unseen
            ).success.mean()
            for s in range(seeds)
        ]
    )
    (low, high), (least, most) = map(bootstrap_interval, (ours, theirs))
    assert low <= most
    assert least <= high
    assert abs(ours - theirs).mean() < 0.03


def test_wrong_arguments_get_one_sentence():
    policy = method("lfd")
    with pytest.raises(ValueError, match="expert_seed and test_seed must differ"):
        imitation_lab(policy, expert_seed=3, test_seed=3)
    with pytest.raises(ValueError, match="demonstrations must be at least 1"):
        imitation_lab(policy, demonstrations=0)
    with pytest.raises(TypeError, match="policy must be"):
        imitation_lab(straight)


def test_rates_have_wilsons_intervals(node):
    body = "return page.rateOf([...Array(47).fill('arrived'), 'collided', 'out of steps', 'collided']);"
    got = node(FILES, body, None)
    assert (got["maps"], got["arrived"], got["rate"]) == (50, 47, 0.94)
    assert got["low"] == pytest.approx(0.8378, abs=1e-4)
    assert got["high"] == pytest.approx(0.9794, abs=1e-4)


def test_robots_of_one_rate_that_end_otherwise_are_told_apart(node):
    body = """const robots = data.map((outcomes) => ({ outcomes }));
      return robots.map((robot) => page.sameOutcomes(robots[0], robot));"""
    outcomes = [
        ["arrived", "collided"],
        ["arrived", "collided"],
        ["collided", "arrived"],
        ["arrived"],
    ]
    assert node(FILES, body, outcomes) == [True, True, False, False]


def test_kept_robots_of_one_name_are_numbered(node):
    """Without a browser's storage they are kept in memory, through the same function."""
    body = """const network = { sizes: [2, 1], weights: [[0, 0]], biases: [[0]] };
      const encoder = { sensors: [], walls: false, target: "signed" };
      for (const name of data) page.keepRobot({ name, network, encoder });
      return page.keptRobots().map(({ name }) => name).sort();"""
    names = ["NIRL, seed 0", "NIRL, seed 0", "NIRL, seed 01", "NIRL, seed 0"]
    expected = ["NIRL, seed 0", "NIRL, seed 0 (2)", "NIRL, seed 0 (3)", "NIRL, seed 01"]
    assert node(FILES, body, names) == expected


def test_kept_robot_of_another_shape_is_left_out(node):
    """A robot whose network does not fit what it reads, or reads a target that there is no longer, cannot drive."""
    body = """const network = { sizes: [2, 1], weights: [[0, 0]], biases: [[0]] };
      for (const encoder of data) page.keepRobot({ name: "mine", network, encoder });
      return page.keptRobots().length;"""
    fits = {"sensors": [], "walls": False, "target": "signed"}
    encoders = [fits, {**fits, "sensors": [1]}, {**fits, "target": "of old"}]
    assert node(FILES, body, encoders) == 1


def test_a_number_is_not_given_again_after_a_robot_was_deleted(node):
    body = "return data.map((taken) => page.distinctName('mine', taken));"
    taken = [[], ["mine"], ["mine (2)"], ["mine", "mine (9)"], ["mine (x)", "min"]]
    assert node(FILES, body, taken) == [
        "mine",
        "mine (2)",
        "mine (3)",
        "mine (10)",
        "mine",
    ]


def test_the_book_policy_reaches_the_page(lab):
    assert lab.data["book"] == page_policy(method("lfd"))


@pytest.mark.slow
def test_the_answers_on_the_page_are_true(demonstrations):
    unseen = random_worlds(200, 10, seed=2024)

    def trained(count, regularisation):
        x, y = labelled_states(demonstrations.select_trajectories(range(count)))
        history = fit(x, y, regularisation=regularisation, seed=0)
        driven = navigate(NetworkPolicy(history.network), unseen)
        return history.accuracies[-1], driven

    one, three, all_of_them = (trained(count, 0.1) for count in (1, 3, 25))
    assert three[1].success.mean() > 0.9
    assert one[0] == pytest.approx(all_of_them[0], abs=0.05)
    assert 0.4 < one[1].success.mean() < 0.6
    assert all_of_them[1].success.mean() > 0.95
    always_ahead = navigate(straight, unseen)
    assert trained(3, 1.0)[1].outcome.tolist() == always_ahead.outcome.tolist()


def answers_of(lab, message):
    answers = []
    lab.send = answers.append
    lab._answer(lab, message, [])
    lab._thread.join(timeout=120)
    return answers


@pytest.fixture
def request_of_page(demonstrations, tmp_path):
    """What the page asks the kernel for: two robots, on the demonstrations as the page sends them."""
    path = tmp_path / "demonstrations.npz"
    save_demonstrations(path, demonstrations)
    return {
        "ask": "train",
        "run": 1,
        "robots": 2,
        "demonstrations": base64.b64encode(path.read_bytes()).decode(),
        "settings": {
            "hidden": 8, "regularisation": 1, "iterations": 30, "seed": 3, "obstacles": 10,
        },
    }  # fmt: skip


def test_the_kernel_trains_robots_as_learn_policy_does(
    lab, demonstrations, request_of_page
):
    *told, last = answers_of(lab, request_of_page)
    x, y = labelled_states(demonstrations)
    histories = [fit(x, y, iterations=30, seed=3 + k) for k in range(2)]
    live = [item for answer in told for item in answer.get("live", ())]
    assert [item["at"] for item in live] == list(range(31))
    np.testing.assert_allclose(
        [item["cost"] for item in live],
        np.mean([history.costs for history in histories], axis=0),
    )
    assert told[-1]["done"] == told[-1]["total"] == 32
    expected = [
        learn_policy(demonstrations, iterations=30, seed=3 + k) for k in range(2)
    ]
    for got, want in zip(lab.trainings, expected, strict=True):
        for mine, theirs in zip(got.network.weights, want.network.weights, strict=True):
            np.testing.assert_array_equal(mine, theirs)
    assert last["ended"]["sentence"].startswith("2 robots cross ")
    best = expected[int(np.argmin([history.costs[-1] for history in histories]))]
    assert last["ended"]["policy"] == page_policy(best)


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"robots": 0}, "ValueError: robots must be"),
        ({"demonstrations": ""}, "ValueError: demonstrations.npz is damaged"),
    ],
)
def test_what_the_kernel_cannot_train_gets_one_sentence(
    lab, request_of_page, change, error
):
    (answer,) = answers_of(lab, request_of_page | change)
    assert answer["error"].startswith(error)
