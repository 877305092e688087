"""Names of robots that say how they were trained, and the robots that a browser keeps."""

from __future__ import annotations

import base64
from dataclasses import replace

import pytest

from robonav.networks import load_weights
from robonav.nnql.reward import TABLE
from robonav.widgets.q_learning_faults import FAULTS
from robonav.widgets.q_learning_lab import QLearningLab
from robonav.widgets.q_learning_settings import QLearningSettings
from robonav.widgets.reward_learning import FILES as NIRL_FILES

FILES = ("simulator", "files", "kept_robots")
LAB_FILES = (
    "simulator", "maps", "files", "learning/random", "learning/network", "learning/worlds", "learning/nnql",
    "learning/trials", "learning/dqn", "learning/worker", "learning/training_panel", "learning/kernel_panel",
    "kept_robots", "q_learning_lab",
)  # fmt: skip
NAMES = """return data.settings.map(([settings, begun]) => page.nameOf(settings, data.usual, data.table, begun));"""
ROBOT = """
const network = { sizes: [2, 5], weights: [Array(10).fill(0.5)], biases: [Array(5).fill(0)] };
const encoder = { sensors: [], walls: false, target: "signed" };
const keep = (name, more = {}) => page.keepRobot({ name, network, encoder, method: "nirl", ...more });
const names = () => page.keptRobots().map(({ name }) => name).sort();
"""


def names_of(node, *settings, begun=""):
    data = {
        "settings": [[each.for_page(), begun] for each in settings],
        "usual": QLearningSettings().for_page(),
        "table": [{"before": row.before, "after": row.after} for row in TABLE],
    }
    return node(LAB_FILES, NAMES, data)


def test_files_of_the_lab_are_those_of_its_front_end():
    assert QLearningLab._esm.count("export function nameOf") == 1


def test_name_of_a_q_learner_says_what_differs_from_the_book(node):
    rewards = list(QLearningSettings().rewards)
    rewards[1] = 0.0
    cases = {
        "nnql, the book's settings, seed 3": QLearningSettings(seed=3),
        "nnql, 60 episodes, seed 0": QLearningSettings(episodes=60),
        "nnql, any to failure −1 → 0, temperature 0.2, seed 0": QLearningSettings(
            rewards=tuple(rewards), temperature=(0.2, 0.2)
        ),
        "nnql, any to safe 0 → 0.6, seed 1": FAULTS[0].settings,
        "nnql, 7 rewards changed, seed 0": FAULTS[2].settings,
        "online, 20 obstacles, inputs raw, discount 0.9, 2 more changes, seed 0": QLearningSettings(
            method="online", obstacles=20, inputs="raw", discount=0.9, rescale="clip", passes=1
        ),
        "dqn, the book's settings, seed 0": QLearningSettings(
            method="dqn", gradient_step=(0.003, 0.003), learning_rate=(0.1, 0.1)
        ),
        "dqn, step 0.01, seed 0": QLearningSettings(
            method="dqn", gradient_step=(0.01, 0.01)
        ),
    }  # fmt: skip
    assert names_of(node, *cases.values()) == list(cases)


def test_settings_that_differ_give_names_that_differ(node):
    settings = [QLearningSettings(), *(fault.settings for fault in FAULTS)]
    same_seed = [replace(each, seed=0) for each in settings]
    names = names_of(node, *same_seed)
    assert len(set(names)) == len(set(same_seed))


def test_name_of_a_robot_that_was_trained_on_says_what_it_began_with(node):
    (name,) = names_of(
        node, QLearningSettings(hidden=3), begun="robot 2: 5 of my demonstrations"
    )
    assert name == "nnql, on from robot 2, the book's settings, seed 0"


def test_name_of_an_inverse_learner_says_what_differs(node):
    body = """return data.map((changes) => page.changesOf({ ...page.NIRL_SETTINGS, ...changes }));"""
    changes = [{}, {"iterations": 30}, {"obstacles": 10, "inverseTemperature": 5}]
    assert node(NIRL_FILES, body, changes) == [
        "",
        "30 iterations, ",
        "10 obstacles, η 5, ",
    ]


def test_numbers_go_on_from_those_that_are_kept(node):
    body = "return data.map(([kind, names]) => page.nextNumber(kind, names));"
    names = [
        "robot 3: two demonstrations",
        "robot 11: more",
        "DAgger, robot 20: one",
        "robots",
    ]
    cases = [["robot", []], ["robot", names], ["DAgger, robot", names]]
    assert node(FILES, body, cases) == [1, 12, 21]


def test_a_robot_is_renamed_deleted_and_brought_back(node):
    body = f"""{ROBOT}
      keep("one", {{ about: "about one", made: {{ seed: 3 }} }});
      keep("two");
      const seen = [];
      const [one, two] = page.keptRobots().sort((a, b) => (a.name < b.name ? -1 : 1));
      page.renameRobot(two, "one");
      seen.push(names());
      page.renameRobot(one, "one");
      seen.push(names());
      page.deleteRobots([one.id]);
      seen.push(names());
      page.bringBackRobot(one);
      seen.push(names());
      const back = page.keptRobots().find(({{ name }}) => name === "one");
      return [seen, JSON.stringify(back) === JSON.stringify(one)];"""
    seen, same = node(FILES, body, None)
    assert seen == [["one", "one (2)"]] * 2 + [["one (2)"], ["one", "one (2)"]]
    assert same


def test_the_file_of_a_kept_robot_says_how_it_was_made(node, tmp_path):
    body = f"""{ROBOT}
      keep("one", {{ about: "Learned.", made: {{ seed: 3, reward: [[1, 2]] }}, temperature: 0.4 }});
      const bytes = page.robotFile(page.keptRobots()[0]);
      return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));"""
    path = tmp_path / "one.safetensors"
    path.write_bytes(base64.b64decode(node(FILES, body, None)))
    weights = load_weights(path)
    assert (weights.method, weights.temperature) == ("nirl", 0.4)
    assert weights.made == {
        "page": True,
        "name": "one",
        "about": "Learned.",
        "seed": 3,
        "reward": [[1, 2]],
    }


@pytest.mark.parametrize("allowed", [True, False])
def test_a_full_or_blocked_storage_is_one_sentence_and_robots_stay_in_memory(
    node, allowed
):
    body = f"""
      const kept = new Map();
      let room = Infinity;
      globalThis.addEventListener ??= () => {{}};
      const storage = {{
        get length() {{ return kept.size; }}, key: (k) => [...kept.keys()][k], getItem: (key) => kept.get(key),
        setItem: (key, text) => {{
          if (text.length > room) throw new DOMException("full", "QuotaExceededError");
          kept.set(key, text);
        }},
        removeItem: (key) => kept.delete(key),
      }};
      const get = () => {{
        if (!data) throw Error("blocked");
        return storage;
      }};
      Object.defineProperty(globalThis, "localStorage", {{ get }});
      {ROBOT}
      keep("one");
      room = 10;
      const said = [page.renameRobot(page.keptRobots()[0], "other"), keep("new")];
      return [said, names()];"""
    said, names = node(FILES, body, allowed)
    assert names == ["new", "other"]
    assert (
        said
        == [
            "The browser's storage is full: your robots made from now on last until you close the page. "
            "Delete some robots, or download them."
            if allowed
            else "This browser keeps nothing for this page: your robots last until you close it."
        ]
        * 2
    )
