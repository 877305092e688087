"""What all planners have in common: hand-made cases, mirrors, and whole episodes."""

from __future__ import annotations

import numpy as np
import pytest

from robonav.planners import (
    Bug,
    DynamicWindow,
    KnownMap,
    PotentialField,
    VectorFieldHistogram,
    action_towards,
    free_way,
    target_bearing,
)
from robonav.planners.sectors import CENTRES
from robonav.robot import (
    Action,
    Reflex,
    make_world,
    navigate,
    random_worlds,
    sense,
)

RNG = np.random.default_rng(0)
ALL = [PotentialField(), VectorFieldHistogram(), DynamicWindow(), Bug(), KnownMap()]


@pytest.mark.parametrize(
    ("region", "action"),
    [(1, Action.F), (2, Action.L30), (3, Action.L60), (9, Action.R30), (8, Action.R60)],
)
def test_with_nothing_in_the_way_the_target_decides(policy, readings, region, action):
    if isinstance(policy, PotentialField):
        policy = PotentialField(inertia=0.0)
    if isinstance(policy, VectorFieldHistogram):
        policy = VectorFieldHistogram(keep=0.0)
    assert policy(readings(region), RNG) == [action]


@pytest.mark.parametrize(("region", "side"), [(4, "L60"), (5, "L60"), (6, "R60"), (7, "R60")])  # fmt: skip
def test_target_behind_turns_the_robot_to_its_side(policy, readings, region, side):
    if isinstance(policy, PotentialField):
        policy = PotentialField(inertia=0.0)
    if isinstance(policy, VectorFieldHistogram):
        policy = VectorFieldHistogram(keep=0.0)
    assert policy(readings(region), RNG) == [Action[side]]


def test_wall_ahead_turns_the_robot(policy, readings):
    action = policy(readings(s1=3.0, s2=4.2, s9=4.2), RNG)
    assert action[0] not in (Action.F, Action.B)


def test_wall_ahead_and_on_the_left_turns_it_right(policy, readings):
    action = policy(readings(s1=3.0, s2=3.0, s3=3.0), RNG)
    assert action[0] in (Action.R30, Action.R60)


def test_corridor_is_gone_through(policy, readings):
    corridor = readings(s2=4.7, s3=3.1, s4=3.5, s7=3.5, s8=3.1, s9=4.7)
    assert policy(corridor, RNG) == [Action.F]


def test_mirrored_readings_give_mirrored_actions(
    policy, random_sensing, mirrored, mirrored_actions
):
    actions = policy(random_sensing, RNG)
    assert len(set(actions)) >= 5
    other = policy(mirrored(random_sensing), RNG)
    agree = other == mirrored_actions(actions)
    assert agree.mean() > 0.99  # the rest are ties, of which the left one is taken


def test_batch_of_one_is_equal(policy, random_sensing):
    rows = [policy(random_sensing[i : i + 1], RNG)[0] for i in range(50)]
    np.testing.assert_array_equal(policy(random_sensing[:50], RNG), rows)


@pytest.mark.parametrize("planner", ALL, ids=lambda planner: type(planner).__name__)
def test_most_robots_arrive(planner):
    worlds = random_worlds(60, 15, seed=5)
    result = navigate(planner, worlds)
    assert result.success.mean() >= 0.95
    assert result.collision.mean() <= 0.02
    again = navigate(planner, worlds)
    np.testing.assert_array_equal(again.steps, result.steps)


@pytest.mark.parametrize(
    "planner", [PotentialField(), VectorFieldHistogram(), Bug()], ids=lambda p: type(p).__name__,
)  # fmt: skip
def test_mirrored_world_gives_the_mirrored_path(planner):
    """The map is mirrored at its diagonal, which is the line from start to target.

    The other two have ties, in which they take the left way in both worlds. A reflex that knows only the sector of the
    target has such ties, too.
    """
    circles = [(45, 41, 3), (63, 70, 2.5)]
    there = make_world(circles)
    mirrored = make_world([(y, x, radius) for x, y, radius in circles])
    path, other = (
        navigate(planner, world, record_paths=True, reflex=Reflex("exact")).paths[0]
        for world in (there, mirrored)
    )
    np.testing.assert_allclose(other[:, :2], path[:, [1, 0]], atol=1e-6)


@pytest.mark.parametrize(
    ("planner", "word"),
    [
        (lambda: PotentialField(influence=0.0), "influence"),
        (lambda: PotentialField(repulsion=-1.0), "repulsion"),
        (lambda: VectorFieldHistogram(wide=1), "wide"),
        (lambda: VectorFieldHistogram(threshold=0.0), "threshold"),
        (lambda: DynamicWindow(speed=0.0), "speed"),
        (lambda: DynamicWindow(clearance=-1.0), "clearance"),
        (lambda: Bug(sight=0.0), "sight"),
        (lambda: KnownMap(margin=0.5), "margin"),
    ],
)
def test_wrong_parameters_are_named(planner, word):
    with pytest.raises(ValueError, match=f"^{word} "):
        planner()


def test_middles_of_sectors_are_where_the_simulator_has_them():
    for bearing, region in zip(CENTRES, range(1, 10), strict=True):
        target = (50 + 20 * np.cos(bearing), 50 + 20 * np.sin(bearing))
        sensing = sense(make_world(target=target), [(50, 50, 0)])
        assert sensing.target_region[0] == region
        assert target_bearing(sensing)[0] == pytest.approx(bearing)


def test_nearest_action_by_trying_all():
    ways = {0: 0, 1: 30, 2: 60, 3: -30, 4: -60, 5: 180}
    for degrees in range(-179, 180, 2):
        off = {a: abs((degrees - way + 180) % 360 - 180) for a, way in ways.items()}
        least = min(off.values())
        assert off[int(action_towards([np.radians(degrees)], back=True)[0])] == least


def test_free_way_against_small_steps():
    """Walk along each direction in steps of a millimetre until one of the points is nearer than the clearance."""
    rng = np.random.default_rng(1)
    ranges = rng.uniform(1.6, 14.0, size=(20, 9)).clip(max=10.0)
    bearings = rng.uniform(-np.pi, np.pi, size=(20, 4))
    way = free_way(ranges, bearings, clearance=1.5, half_width=0.3)
    along = np.arange(0.0, 10.0, 1e-3)
    for i in range(20):
        points = [
            (d * np.cos(c + a), d * np.sin(c + a))
            for d, c in zip(ranges[i], CENTRES, strict=True) if d < 10
            for a in 0.3 * np.linspace(-1, 1, 5)
        ]  # fmt: skip
        for b in range(4):
            x, y = along * np.cos(bearings[i, b]), along * np.sin(bearings[i, b])
            near = min(
                (float(along[hit.argmax()]) for px, py in points
                 if (hit := np.hypot(x - px, y - py) < 1.5).any()),
                default=10.0,
            )  # fmt: skip
            assert way[i, b] == pytest.approx(near, abs=2e-3)
