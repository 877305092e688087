"""The reader's demonstrations: kept as text, written to and read from files that Python shares."""

import base64

import numpy as np
import pytest

from robonav import archive
from robonav.lfd import demonstrate, load_demonstrations, save_demonstrations
from robonav.networks import Weights, load_weights, random_network, save_weights
from robonav.robot import Encoder, concatenate_worlds, random_worlds
from robonav.widgets.simulator import page_world

FILES = (
    "simulator", "maps", "episode", "files", "learning/random", "learning/worlds", "kept_demonstrations",
)  # fmt: skip
BUFFER = "const buffer = Uint8Array.from(atob(data), (c) => c.charCodeAt(0)).buffer;"
BYTES = "return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));"
STORAGE = """
const kept = new Map();
let room = Infinity;
globalThis.addEventListener ??= () => {};
const localStorage = {
  get length() { return kept.size; }, key: (k) => [...kept.keys()][k], getItem: (key) => kept.get(key),
  setItem: (key, text) => {
    if (text.length > room) throw new DOMException("full", "QuotaExceededError");
    kept.set(key, text);
  },
  removeItem: (key) => kept.delete(key),
};
const get = () => {
  if (!data.allowed) throw Error("blocked");
  return localStorage;
};
Object.defineProperty(globalThis, "localStorage", { get });
const demonstration = page.makeEpisode(page.ownMap(3), 2);
while (demonstration.outcome === "running") demonstration.go(0);
const { base: world, steps, outcome } = demonstration;
const record = { world, speed: 2, steps, outcome, map: 3 };
"""


def encoded(path):
    return base64.b64encode(path.read_bytes()).decode()


@pytest.fixture(scope="module")
def demonstrations():
    """Drives in worlds with different numbers of obstacles, one of which moves."""
    parts = [random_worlds(2, 5, 1, seed=3), random_worlds(2, 10, seed=4)]
    return demonstrate(concatenate_worlds([part.with_slots(10) for part in parts]))


def test_demonstrations_of_python_come_back_to_python(node, demonstrations, tmp_path):
    save_demonstrations(tmp_path / "there.npz", demonstrations)
    body = f"""{BUFFER} return page.demonstrationsFromFile(buffer).then((demonstrations) => {{
      const bytes = page.demonstrationsFile(demonstrations); {BYTES}
    }});"""
    back = node(FILES, body, encoded(tmp_path / "there.npz"))
    (tmp_path / "back.npz").write_bytes(base64.b64decode(back))
    got = load_demonstrations(tmp_path / "back.npz")
    assert got.worlds.digest() == demonstrations.worlds.digest()
    assert got.speed == demonstrations.speed
    for name in ("trajectory", "actions", "poses", "outcome"):
        np.testing.assert_array_equal(getattr(got, name), getattr(demonstrations, name))
    for name in ("ranges", "walls", "target_region", "target_seen"):
        ours, theirs = (getattr(each.sensing, name) for each in (got, demonstrations))
        np.testing.assert_array_equal(ours, theirs)


def test_arrays_stored_by_columns_are_read(node, demonstrations, tmp_path):
    save_demonstrations(tmp_path / "demonstrations.npz", demonstrations)
    arrays = archive.read_archive(tmp_path / "demonstrations.npz")
    turned = {
        name: np.asfortranarray(array) if array.ndim > 1 else array
        for name, array in arrays.items()
    }
    archive.write_archive(tmp_path / "turned.npz", turned, compressed=False)
    body = f"""{BUFFER}
      const ranges = (steps) => steps.map(({{ sensing }}) => sensing.ranges);
      return page.demonstrationsFromFile(buffer)
        .then((demonstrations) => demonstrations.map(({{ world, steps }}) => [world, ranges(steps)]));
    """
    got = node(FILES, body, encoded(tmp_path / "turned.npz"))
    for i, (world, ranges) in enumerate(got):
        mine = demonstrations.trajectory == i
        np.testing.assert_array_equal(ranges, demonstrations.sensing.ranges[mine])
        assert world == page_world(demonstrations.worlds[i])


def broken(tmp_path, demonstrations, **changes):
    save_demonstrations(tmp_path / "demonstrations.npz", demonstrations)
    arrays = archive.read_archive(tmp_path / "demonstrations.npz")
    for name, change in changes.items():
        arrays[name] = change(arrays[name])
    archive.write_archive(tmp_path / "broken.npz", arrays)
    return (tmp_path / "broken.npz").read_bytes()


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (lambda path, demonstrations: b"", "it is damaged or of another kind"),
        (
            lambda path, demonstrations: b"PK" + bytes(300),
            "it is damaged or of another kind",
        ),
        (
            lambda path, demonstrations: broken(
                path, demonstrations, format=lambda _: np.array("x")
            ),
            "it does not say so",
        ),
        (
            lambda path, demonstrations: broken(
                path, demonstrations, poses=lambda a: a[:, :2]
            ),
            "its array poses is missing or of another shape",
        ),
        (
            lambda path, demonstrations: broken(
                path, demonstrations, ranges=lambda a: a * np.nan
            ),
            "its array ranges holds values that are not numbers",
        ),
        (
            lambda path, demonstrations: broken(
                path, demonstrations, actions=lambda a: a + 5
            ),
            "a step of it is none of the robot's",
        ),
        (
            lambda path, demonstrations: broken(
                path, demonstrations, outcome=lambda a: a + 7
            ),
            "a demonstration ends in a way that there is not",
        ),
    ],
)
def test_a_file_that_is_no_demonstration_gets_one_sentence(
    node, demonstrations, tmp_path, content, why
):
    body = f"{BUFFER} return page.demonstrationsFromFile(buffer).catch((error) => error.message);"
    said = node(
        FILES, body, base64.b64encode(content(tmp_path, demonstrations)).decode()
    )
    assert said == f"The file must hold demonstrations saved by robonav: {why}."


def test_weights_of_the_page_are_weights_of_python(node, tmp_path):
    encoder = Encoder(target="signed")
    network = random_network((encoder.size, 6, 5), seed=3)
    about = Weights(network, "lfd", encoder, {"demonstrations": 4}, temperature=0.5)
    save_weights(tmp_path / "there.safetensors", about)
    body = f"""{BUFFER}
      const policy = page.weightsFromFile(buffer);
      const whole = {{ ...policy, network: page.networks(policy.network)() }};
      const bytes = page.weightsFile({{ ...whole, method: "lfd" }}, {{ demonstrations: 4 }}); {BYTES}"""
    back = node(FILES, body, encoded(tmp_path / "there.safetensors"))
    (tmp_path / "back.safetensors").write_bytes(base64.b64decode(back))
    got = load_weights(tmp_path / "back.safetensors")
    for ours, theirs in zip(got.network.weights, network.weights, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    for ours, theirs in zip(got.network.biases, network.biases, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert (got.method, got.encoder, got.temperature) == ("lfd", encoder, 0.5)
    assert got.made == {"demonstrations": 4, "page": True}


def test_demonstrations_are_kept_listed_and_deleted(node):
    body = (
        STORAGE
        + """
      const faster = { ...record, speed: record.speed + 1 };
      const said = page.keepDemonstrations([record, faster, record]);
      const again = page.keepDemonstrations([faster]);
      const demonstrations = page.keptDemonstrations();
      const same = JSON.stringify(demonstrations[0].steps) === JSON.stringify(record.steps);
      let heard = 0;
      const end = page.watchDemonstrations(() => { heard += 1; });
      page.deleteDemonstrations([demonstrations[0].id]);
      const [map, left] = [page.nextMap(demonstrations), page.keptDemonstrations().length];
      return { said, again, same, first: demonstrations.length, map, left, heard, inMemory: kept.size === 0 };
    """
    )
    got = node(FILES, body, {"allowed": True})
    assert got == {
        "said": {"added": 2, "warning": ""}, "again": {"added": 0, "warning": ""},
        "same": True, "first": 2, "map": 4, "left": 1, "heard": 1, "inMemory": False,
    }  # fmt: skip


def test_blocked_storage_keeps_demonstrations_in_memory(node):
    body = (
        STORAGE
        + "return [page.keepDemonstrations([record]).warning, page.keptDemonstrations().length, kept.size];"
    )
    said, count, stored = node(FILES, body, {"allowed": False})
    assert (
        said
        == "This browser keeps nothing for this page: your demonstrations last until you close it."
    )
    assert (count, stored) == (1, 0)


def test_full_storage_keeps_demonstrations_in_memory(node):
    body = (
        STORAGE
        + """
      page.keepDemonstrations([record]);
      room = 100;
      const said = page.keepDemonstrations([{ ...record, speed: 3 }]).warning;
      const both = page.keptDemonstrations();
      page.deleteDemonstrations(both.map(({ id }) => id));
      return [said, both.length, page.keptDemonstrations().length];
    """
    )
    said, count, left = node(FILES, body, {"allowed": True})
    assert said.startswith(
        "The browser's storage is full: your demonstrations made from now on last until"
    )
    assert (count, left) == (2, 0)


def test_what_is_no_demonstration_in_the_storage_is_left_out(node):
    body = (
        STORAGE
        + """
      for (const text of ["", "{}", "[1]", "null", '{"actions": []}']) kept.set(`robonav.drive.${text.length}`, text);
      page.keepDemonstrations([record]);
      return page.keptDemonstrations().length;
    """
    )
    assert node(FILES, body, {"allowed": True}) == 1


@pytest.mark.parametrize("number", [1, 12])
def test_the_readers_maps_are_random_worlds(node, number):
    expected = page_world(random_worlds(1, 10, seed=500_000 + number))
    got = node(FILES, "return page.ownMap(data);", number)
    assert got["key"] == expected["key"]
    assert [o["x"] for o in got["obstacles"]] == pytest.approx(
        [o["x"] for o in expected["obstacles"]]
    )


ADVICE = """
const { start, target } = data.world;
const steps = (actions) => actions.map((action) => ({ action, sensing: { ranges: action < 0 ? [10] : [4] } }));
const made = data.demonstrations.map(([outcome, actions, count, safe = 0]) => Array.from({ length: count }, () => ({
  outcome, speed: 2, world: { start, target }, steps: [...steps(actions), ...steps(Array(safe).fill(-1))],
}))).flat();
const arrived = made.filter(({ outcome }) => outcome === "arrived");
return page.adviceOn(arrived.slice(0, data.learned ?? arrived.length), made);
"""
WORLD = {"start": [10, 10], "target": [90, 10]}  # forty steps at 2 m/s
GOOD = [0, 3, 3, 0, 0, 1, 1, 0, 0, 2, 0, 4]


@pytest.mark.parametrize(
    ("demonstrations", "learned", "sentence"),
    [
        ([("arrived", GOOD, 1, 30), ("collided", GOOD, 2)], None, "Only 1 of your 3 demonstrations arrived, and"),
        ([("arrived", GOOD, 2, 30)], None, "Three demonstrations are enough for a first robot: bring the robot"),
        ([("arrived", GOOD, 5, 30)], 2, "It learned from two of your 5 demonstrations that arrived: choose more"),
        ([("arrived", GOOD, 3, 80)], None, "Your demonstrations are 2.3 times as long as the straight line"),
        ([("arrived", [0, 3, 1], 3, 40)], None, "Your demonstrations have only 3 steps each with something in range"),
        ([("arrived", [0] * 9 + [3], 3, 30)], None, "You turned in only 10 % of the steps with something in range"),
        ([("arrived", GOOD, 3, 30), ("collided", GOOD, 4)], None, "More of your demonstrations collided than arrived"),
        ([("arrived", GOOD, 3, 30)], None, "Drive more maps, turn earlier and at a larger distance"),
    ],
)  # fmt: skip
def test_advice_says_what_is_poor_in_the_demonstrations(
    node, demonstrations, learned, sentence
):
    data = {"world": WORLD, "demonstrations": demonstrations, "learned": learned}
    assert node(FILES, ADVICE, data).startswith(sentence)


def test_careful_demonstrations_are_not_called_poor(node, tmp_path):
    """The computer expert's demonstrations, which teach a good robot, are within all bounds of the advice."""
    demonstrations = demonstrate(random_worlds(10, 10, seed=7))
    save_demonstrations(tmp_path / "good.npz", demonstrations)
    body = f"{BUFFER} return page.demonstrationsFromFile(buffer).then((shown) => page.adviceOn(shown, shown));"
    said = node(FILES, body, encoded(tmp_path / "good.npz"))
    assert said.startswith("Drive more maps, turn earlier and at a larger distance")
