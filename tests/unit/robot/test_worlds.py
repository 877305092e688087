"""Worlds: drawn, checked, saved, loaded, written as text."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from robonav.robot import (
    Worlds,
    clearance,
    concatenate_worlds,
    format_world,
    load_worlds,
    make_world,
    navigate,
    parse_world,
    random_worlds,
    save_worlds,
    straight,
)
from robonav.robot._fast import CIRCLE, RECTANGLE
from robonav.robot._fast.drawing import empty_grid, reachable

FROZEN_DIGESTS = [
    "e7423afab328a43eb6f57bbb310c7f93bd050907c3767dd95178730c6e80b9bc",
    "43cba8b67a9cf7d721b34197fb151ce2b693269a05f0ef5505e372ff2529eab7",
]


def test_the_generator_is_frozen():
    """Difficulty is fixed, not chosen per result: these worlds never change."""
    digests = [
        random_worlds(200, obstacles, moving, seed=2015).digest()
        for obstacles, moving in ((10, 0), (20, 10))
    ]
    assert digests == FROZEN_DIGESTS


def test_world_i_depends_on_seed_and_i_alone():
    many, few = random_worlds(600, seed=4), random_worlds(7, seed=4)
    assert many[:7].digest() == few.digest()
    assert many[0].digest() != many[1].digest()
    assert random_worlds(7, seed=5).digest() != few.digest()


def test_generators_are_taken_as_seeds():
    first = random_worlds(3, seed=np.random.default_rng(1))
    assert first.digest() == random_worlds(3, seed=np.random.default_rng(1)).digest()


def test_sizes_shapes_and_keep_out_zones():
    worlds = random_worlds(300, obstacles=9, moving=5, seed=6)
    circles, rectangles = worlds.kinds == CIRCLE, worlds.kinds == RECTANGLE
    assert (circles[:, :9].sum(axis=1) == 5).all()
    assert (circles[:, 9:].sum(axis=1) == 3).all()
    radius, sides = worlds.shapes[circles][:, 0], 2 * worlds.shapes[rectangles][:, :2]
    assert 1.5 <= radius.min() < 1.6
    assert 3.9 < radius.max() <= 4
    assert 3 <= sides.min() < 3.2
    assert 7.8 < sides.max() <= 8
    assert clearance(worlds, worlds.starts).min() >= 6
    assert clearance(worlds, worlds.targets).min() >= 6
    assert (worlds.speeds[:, :9] == 0).all()
    assert ((worlds.speeds[:, 9:] >= 0.4) & (worlds.speeds[:, 9:] <= 0.9)).all()


def test_every_world_has_a_way_through_by_another_flood_fill():
    worlds = random_worlds(60, obstacles=30, seed=8)
    x, y = np.meshgrid(np.arange(101.0), np.arange(101.0), indexing="ij")
    for world in worlds:
        free = np.minimum(np.minimum(x, 100 - x), np.minimum(y, 100 - y)) >= 2
        for kind, centre, (a, b, turned) in zip(
            world.kinds[0], world.centres[0], world.shapes[0], strict=True
        ):
            dx, dy = x - centre[0], y - centre[1]
            if kind == CIRCLE:
                free &= np.hypot(dx, dy) - a >= 2
            else:
                u = np.abs(np.cos(turned) * dx + np.sin(turned) * dy) - a
                v = np.abs(np.cos(turned) * dy - np.sin(turned) * dx) - b
                free &= np.hypot(np.maximum(u, 0), np.maximum(v, 0)) >= 2
        rooms, _ = ndimage.label(free)
        assert rooms[10, 10] == rooms[90, 90] != 0


def test_flood_fill_agrees_with_scipy_where_there_may_be_no_way():
    walls = {
        True: [(50, 45, 1, 88, 0)],
        False: [(50, 50, 1, 99, 0)],
    }
    for expected, rectangles in walls.items():
        w = make_world(rectangles=rectangles)
        empty = empty_grid(100.0, 2.0)
        got = reachable(
            0, 1, w.kinds, w.shapes, w.centres, 10.0, 10.0, 90.0, 90.0, 2.0, empty,
            np.empty_like(empty), np.empty(empty.size, dtype=np.int64),
        )  # fmt: skip
        assert got is expected


def test_starts_and_targets_are_chosen_among_those_given():
    starts, targets = [(10, 10), (90, 10)], [(90, 90), (10, 90)]
    worlds = random_worlds(200, seed=3, starts=starts, targets=targets)
    pairs = {
        (tuple(s), tuple(t)) for s, t in zip(worlds.starts, worlds.targets, strict=True)
    }
    assert pairs == {(s, t) for s in starts for t in targets}


def test_going_straight_is_the_yardstick():
    """How hard the maps are: about a third, an eighth, a twentieth of them can be crossed without looking."""
    rates = [
        navigate(straight, random_worlds(1000, n, seed=11)).success.mean()
        for n in (10, 20, 30)
    ]
    np.testing.assert_allclose(rates, [0.37, 0.13, 0.05], atol=0.05)


def test_picking_and_joining():
    a, b = random_worlds(4, 6, seed=1), random_worlds(3, 9, seed=2)
    both = concatenate_worlds([a, b])
    assert len(both) == 7
    assert both[:4].kinds.shape == (4, 9)
    assert both[4:].digest() == b.digest()
    assert [len(w) for w in a] == [1] * 4
    assert a[-1].digest() == a[3].digest()
    assert a[np.array([True, False, True, False])].digest() == a[[0, 2]].digest()
    with pytest.raises(IndexError):
        a[4]


def test_files_round_trip(tmp_path):
    worlds = random_worlds(20, 8, 3, seed=5)
    save_worlds(tmp_path / "worlds.npz", worlds)
    back = load_worlds(tmp_path / "worlds.npz")
    assert back.digest() == worlds.digest()
    assert back.size == worlds.size
    assert [p.name for p in tmp_path.iterdir()] == ["worlds.npz"]


def test_text_round_trips():
    for world in random_worlds(20, 8, 3, seed=5):
        assert parse_world(format_world(world)).digest() == world.digest()


def test_text_is_easy_to_write():
    world = parse_world(
        """
        # moving obstacles, too
        start = [20, 20]
        obstacles = [
            {circle = [40, 50], radius = 3},
            {rectangle = [60, 30], sides = [8, 4], turned = 45},  # leaning
            {circle = [70, 70], radius = 2, speed = 0.5, towards = 90},
        ]
        """
    )
    assert world.kinds.tolist() == [[1, 2, 1]]
    assert world.starts.tolist() == [[20, 20]]
    assert world.targets.tolist() == [[90, 90]]
    assert world.shapes[0, 1].tolist() == [4, 2, np.radians(45)]
    assert world.speeds.tolist() == [[0, 0, 0.5]]
    assert world.headings[0, 2] == np.radians(90)


def test_empty_text_is_an_empty_world():
    assert parse_world("").digest() == make_world().digest()


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("size = 100\ncircle 40 50", ValueError, "must be a world in TOML: .* line 2"),
        ("start = [1, 2]\nstart = [3, 4]", ValueError, "must be a world in TOML"),
        ("start = [10]", ValueError, r"start must have shape \(1, 2\)"),
        ("start = 'here'", TypeError, "start must be an array of numbers"),
        ("target = ['a', 'b']", TypeError, "target must be an array of numbers"),
        ("size = '100'", TypeError, "size must be a number"),
        ("key = [-1, 0]", ValueError, "key must hold whole numbers"),
        ("obstacle = []", ValueError, "entries of a world must be one of size, start"),
        ("obstacles = 5", TypeError, "obstacles must be list"),
    ],
)
def test_text_that_is_no_world_gets_a_sentence(text, error, message):
    with pytest.raises(error, match=message):
        parse_world(text)


@pytest.mark.parametrize(
    ("obstacle", "error", "message"),
    [
        ("5", ValueError, "must be like"),
        ("{circle = [40, 50]}", ValueError, "must be like"),
        ("{circle = [40, 50], radius = 3, turned = 4}", ValueError, "must be like"),
        ("{square = [1, 2], side = 3}", ValueError, "must be like"),
        ("{rectangle = [4, 5], radius = 3}", ValueError, "must be like"),
        ("{circle = [4, 5], radius = 3, towards = 9}", ValueError, "must have a speed"),
        ("{circle = 4, radius = 3}", ValueError, r"circle must have shape \(2,\)"),
        ("{circle = [4, 5], radius = '3'}", TypeError, "radius must be a number"),
        ("{rectangle = [4, 5], sides = [3]}", ValueError, "sides must have shape"),
    ],
)
def test_an_obstacle_that_cannot_be_read_is_named(obstacle, error, message):
    first = "{circle = [50, 50], radius = 1}"
    with pytest.raises(error, match=f"obstacle 2.*{message}"):
        parse_world(f"obstacles = [{first}, {obstacle}]")


@pytest.mark.parametrize(
    ("circles", "ends", "message"),
    [
        ([(50, 50, -1)], {}, "radius must be positive"),
        ([(10, 10, 2)], {}, "start .* must be at least 1 m clear"),
        ([(90, 92, 2)], {}, "target .* must be at least 1 m clear"),
        ([(np.nan, 10, 2)], {}, "circles must hold finite numbers"),
        ([(150, 50, 2)], {}, "obstacles must have their centre in the map"),
        ([], {"start": (-5, 5)}, "start must lie in the map"),
    ],
)
def test_worlds_that_make_no_sense_are_refused(circles, ends, message):
    with pytest.raises(ValueError, match=message):
        make_world(circles, **ends)


def test_a_map_that_cannot_be_solved_is_refused():
    with pytest.raises(ValueError, match="obstacles must leave a way to the target"):
        random_worlds(1, obstacles=400, seed=0)


@pytest.mark.parametrize(
    ("settings", "error", "message"),
    [
        ({"n": -1}, ValueError, "n must be at least 0"),
        ({"n": 2.5}, TypeError, "n must be a whole number"),
        ({"obstacles": -3}, ValueError, "obstacles must be at least 0"),
        ({"seed": "x"}, TypeError, "seed must be a whole number"),
        ({"starts": [(0, 0)]}, ValueError, "starts must be points in the map"),
        ({"targets": []}, ValueError, "targets must"),
        ({"size": 5}, ValueError, "size must be at least 30"),
    ],
)
def test_bad_settings_are_refused(settings, error, message):
    with pytest.raises(error, match=message):
        random_worlds(**{"n": 1, "seed": 0} | settings)


def test_nothing_and_none_are_legal():
    assert len(random_worlds(0, seed=0)) == 0
    assert random_worlds(2, obstacles=0, moving=3, seed=0).slots == 3
    assert navigate(straight, random_worlds(0, seed=0)).outcome.shape == (0,)


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 cut short"])
def test_damaged_files_are_refused_with_a_sentence(tmp_path, content):
    path = tmp_path / "worlds.npz"
    path.write_bytes(content)
    with pytest.raises(ValueError, match="damaged or of another kind"):
        load_worlds(path)


def test_other_files_are_refused_with_a_sentence(tmp_path):
    path = tmp_path / "worlds.npz"
    np.savez(path, format=np.array("robonav worlds 0"))
    with pytest.raises(ValueError, match="in the format 'robonav worlds 1'"):
        load_worlds(path)
    np.savez(path, format=np.array("robonav worlds 1"), kinds=np.zeros((1, 1)))
    with pytest.raises(ValueError, match="differs in"):
        load_worlds(path)
    np.savez(
        path, format=np.array("robonav worlds 1"), kinds=np.array([{}], dtype=object)
    )
    with pytest.raises(ValueError, match="damaged or of another kind"):
        load_worlds(path)


def test_shapes_that_do_not_fit_are_refused():
    good = random_worlds(2, 3, seed=0)
    with pytest.raises(ValueError, match="speeds must have shape"):
        Worlds(
            good.kinds,
            good.shapes,
            good.centres,
            good.speeds[:1],
            good.headings,
            good.starts,
            good.targets,
            good.keys,
        )


def test_a_file_with_any_byte_changed_is_read_or_refused_with_a_sentence(tmp_path):
    path = tmp_path / "worlds.npz"
    save_worlds(path, random_worlds(2, 3, 1, seed=5))
    content = path.read_bytes()
    rng = np.random.default_rng(0)
    refused = 0
    for at in rng.choice(len(content), 400, replace=False):
        path.write_bytes(
            content[:at]
            + bytes([content[at] ^ int(rng.integers(1, 256))])
            + content[at + 1 :]
        )
        try:
            load_worlds(path)
        except ValueError:
            refused += 1
    assert refused > 200


def test_the_digest_sees_everything():
    worlds = random_worlds(1, 2, 2, seed=5)
    for name in ("headings", "speeds", "centres", "starts"):
        changed = replace(
            worlds,
            **{name: getattr(worlds, name) + 0.001 * (getattr(worlds, name) != 0)},
        )
        assert changed.digest() != worlds.digest(), name


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kinds": [[1.7]]}, "kinds must hold whole numbers"),
        ({"kinds": [[257]]}, "kinds must hold whole numbers"),
        ({"keys": [[-1, 0]]}, "keys must hold whole numbers"),
        ({"shapes": [[[3, -50, 0]]]}, "shapes of circles must be a radius, 0 and 0"),
        ({"speeds": [[500.0]]}, "obstacle speed must be at most 4"),
        (
            {"speeds": [[0.5]], "centres": [[[50.0, 2.0]]]},
            "moving obstacles must lie wholly in the map",
        ),
    ],
)
def test_values_are_not_bent_into_shape(change, message):
    world = make_world(circles=[(50, 50, 3)])
    with pytest.raises(ValueError, match=message):
        replace(world, **change)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda: make_world(circles=[(1, 2)]),
            ValueError,
            r"circles must have shape \(number, 3\)",
        ),
        (
            lambda: make_world(circles=[("a", 2, 3)]),
            TypeError,
            "circles must be an array of numbers",
        ),
        (lambda: make_world(key=(-1, 0)), ValueError, "key must hold whole numbers"),
        (lambda: make_world(size=10**400), ValueError, "size must be finite"),
        (lambda: parse_world(5), TypeError, "text must be str"),
        (lambda: navigate(straight, "x"), TypeError, "worlds must be Worlds"),
        (lambda: concatenate_worlds(["x"]), TypeError, "batches must be Worlds"),
        (lambda: save_worlds("nowhere", None), TypeError, "worlds must be Worlds"),
        (lambda: random_worlds(1, seed=0)[(0, 1)], TypeError, "worlds are picked by"),
        (lambda: random_worlds(10**30, seed=0), ValueError, "n must be at most"),
    ],
)
def test_wrong_things_at_every_door_get_a_sentence(call, error, message):
    with pytest.raises(error, match=message):
        call()
