"""Worlds with pockets: frozen, solvable, and traps for policies that remember nothing."""

from __future__ import annotations

import numpy as np
import pytest

from robonav.benchmark import method
from robonav.lfd import plan, plan_on_grid
from robonav.planners import (
    Bug,
    DynamicWindow,
    KnownMap,
    PotentialField,
    VectorFieldHistogram,
)
from robonav.robot import (
    Reflex,
    clearance,
    crossing_worlds,
    navigate,
    pocket_worlds,
    sense,
    turn_to_clearer_side,
)
from robonav.robot.pockets import (
    CROSSING,
    HALF_CORRIDOR,
    SECONDS,
    open_on_the_left,
)

FAMILIES = {"pocket": pocket_worlds, "crossing": crossing_worlds}
FROZEN_DIGESTS = {
    "pocket": "1ec0f425abc604d03912369dbbcd0432a2e04cdca058c8d2fcac456ce1f5c5ce",
    "crossing": "76ff5fd781eb4ed42a383ecb1e81692da21a4aac797e590b939f628ee67c9e0c",
}
MEMORYLESS = {
    "freer-side": turn_to_clearer_side,
    "potential-field": PotentialField(),
    "vfh": VectorFieldHistogram(),
    "dynamic-window": DynamicWindow(),
    **{name: method(name) for name in ("lfd", "dagger", "nnql", "online", "nfq")},
    **{name: method(name) for name in ("dqn", "nirl", "scirl")},
}


@pytest.fixture(params=FAMILIES)
def family(request):
    return request.param


def test_the_generators_are_frozen(family):
    assert FAMILIES[family](200, seed=2015).digest() == FROZEN_DIGESTS[family]


def test_world_i_depends_on_seed_and_i_alone(family):
    draw = FAMILIES[family]
    many, few = draw(60, seed=4), draw(7, seed=4)
    assert many[:7].digest() == few.digest()
    assert many[0].digest() != many[1].digest()
    assert draw(7, seed=5).digest() != few.digest()
    assert len(draw(0, seed=4)) == 0


def test_a_star_finds_a_way_in_each_world(family):
    worlds = FAMILIES[family](12, seed=6)
    assert all(plan(world, margin=1.5).found for world in worlds)
    assert all(plan_on_grid(world, margin=1.5).found for world in worlds)


def test_the_planner_that_knows_the_map_arrives(family):
    arrived = navigate(KnownMap(2.0, 0.0), FAMILIES[family](30, seed=7), reflex=None)
    assert arrived.success.all()


def test_the_straight_way_to_the_target_is_blocked(family):
    worlds = FAMILIES[family](30, seed=8)
    steps = np.linspace(worlds.starts, worlds.targets, 200)
    assert (np.min([clearance(worlds, s) for s in steps], axis=0) == 0.0).all()


@pytest.mark.parametrize("name", MEMORYLESS)
def test_policies_without_a_memory_stay_in_pockets(name):
    """Of 100 robots at most 25 come out in 300 s, and of most policies none or few do."""
    worlds = pocket_worlds(100, seed=1)
    ends = navigate(MEMORYLESS[name], worlds, max_steps=300, reflex=Reflex("exact"))
    assert ends.success.mean() <= (0.25 if name == "dqn" else 0.1)


def test_a_bug_comes_out_of_pockets():
    worlds = pocket_worlds(100, seed=1)
    ends = navigate(Bug(), worlds, max_steps=300, reflex=Reflex("exact"))
    assert ends.success.mean() >= 0.9


def test_the_arms_of_a_pocket_are_out_of_range_in_its_middle():
    worlds = pocket_worlds(50, seed=3)
    back = worlds.centres[:, 0]
    turned = worlds.shapes[:, 0, 2]
    ahead = np.column_stack([np.cos(turned), np.sin(turned)])
    poses = np.column_stack([back - 5.0 * ahead, turned])
    seen = sense(worlds, poses).ranges
    assert np.allclose(seen[:, 0], 4.0)  # the wall at the back, 2 m thick
    assert (seen[:, [3, 4, 5, 6]] == 10.0).all()  # nothing beside and behind


def test_crossings_look_the_same_whichever_branch_is_open():
    worlds = crossing_worlds(60, seed=3)
    left = open_on_the_left(worlds)
    assert 20 < left.sum() < 40
    middle = (60.0 + CROSSING / 2) / np.sqrt(2)
    seen = sense(worlds, np.tile([middle, middle, np.pi / 4], (60, 1)))
    ahead = [0, 1, 2, 3, 6, 7, 8]  # not the two that look back into the corridor
    assert np.ptp(seen.ranges[:, ahead], axis=0).max() < 1e-6
    assert np.allclose(seen.ranges[:, 0], CROSSING / 2)
    assert (seen.target_region == 1).all()


def test_the_niche_is_on_the_side_of_the_open_branch():
    worlds = crossing_worlds(60, seed=3)
    left = open_on_the_left(worlds)
    behind = worlds.centres[:, 8]  # the wall behind the niche
    on_the_way = np.repeat(behind.mean(axis=1)[:, None], 2, axis=1)
    poses = np.column_stack([on_the_way, np.full(60, np.pi / 4)])
    seen = sense(worlds, poses).ranges
    niche = np.where(left, seen[:, 2], seen[:, 7])
    plain = np.where(left, seen[:, 7], seen[:, 2])
    assert np.allclose(plain, HALF_CORRIDOR)
    assert np.allclose(niche, 8.0)  # to its side, 4 m ahead, at 60 degrees


def test_the_wrong_branch_takes_too_long():
    """A robot that looks into the closed branch first cannot arrive within the limit, even if it knows the map."""
    worlds = crossing_worlds(20, seed=5)
    direct = navigate(KnownMap(), worlds, reflex=Reflex("exact"))
    assert direct.steps.max() < SECONDS
    side = np.where(open_on_the_left(worlds), -1.0, 1.0)
    ahead = 60.0 + CROSSING / 2
    x, y = (ahead - side * 18.0) / np.sqrt(2), (ahead + side * 18.0) / np.sqrt(2)
    back = [
        plan(world, pose=(x[i], y[i], np.pi / 4 + side[i] * np.pi / 2)).length / 2.0
        for i, world in enumerate(worlds)
    ]
    there = (ahead - 14.1 + 18.0) / 2.0  # seconds at 2 m/s
    assert there + min(back) > SECONDS


@pytest.mark.parametrize("wrong", [{"n": -1, "seed": 0}, {"n": 2, "seed": -1}])
def test_wrong_arguments_are_named(family, wrong):
    with pytest.raises(ValueError, match=r"^(n|seed) must be at least 0"):
        FAMILIES[family](**wrong)
