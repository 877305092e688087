"""Random worlds in the page against Python's."""

import numpy as np
import pytest

from robonav.nnql.task import STARTS, TARGETS
from robonav.robot import draw_worlds, random_worlds, world_keys
from robonav.widgets.simulator import page_world

DRAW = "return data.keys.map((key) => page.drawWorld(key, data.settings));"
FILES = ("simulator", "learning/worlds")


@pytest.mark.parametrize(("obstacles", "moving"), [(0, 0), (10, 0), (30, 0), (10, 10)])
def test_the_page_draws_the_worlds_of_python(node, obstacles, moving):
    keys = world_keys(100, seed=5)
    settings = {
        "obstacles": obstacles,
        "moving": moving,
        "starts": STARTS,
        "targets": TARGETS,
    }
    drawn = node(FILES, DRAW, {"keys": keys.tolist(), "settings": settings})
    expected = [
        page_world(world)
        for world in draw_worlds(keys, obstacles, moving, STARTS, TARGETS)
    ]
    assert len(drawn) == 100
    for ours, theirs in zip(drawn, expected, strict=True):
        assert len(ours["obstacles"]) == obstacles + moving
        for mine, its in zip(
            ours.pop("obstacles"), theirs.pop("obstacles"), strict=True
        ):
            assert mine == pytest.approx(its, abs=1e-12)
        assert ours == theirs


def test_the_page_hashes_the_keys_of_python(node):
    origin = np.random.SeedSequence(9).generate_state(1, np.uint64)[0]
    body = "return page.worldKeys(50, BigInt(data));"
    assert node(FILES, body, str(origin)) == world_keys(50, seed=9).tolist()


@pytest.mark.slow
def test_too_many_obstacles_are_one_sentence(node):
    body = 'try { page.drawWorld([1, 2], data); } catch (error) { return error.message; } return "drawn";'
    message = node(FILES, body, {"obstacles": 900})
    assert message == "900 obstacles leave no way to the target; take fewer."


@pytest.mark.parametrize("seed", [0, 7, 2**40 + 3])
def test_a_seed_gives_the_worlds_of_python(node, seed):
    files = ("simulator", "learning/random", "learning/worlds")
    body = "return page.randomWorlds(20, data);"
    drawn = node(files, body, {"obstacles": 10, "seed": seed})
    for ours, world in zip(drawn, random_worlds(20, 10, seed=seed), strict=True):
        theirs = page_world(world)
        assert ours["key"] == theirs["key"]
        for mine, its in zip(ours["obstacles"], theirs["obstacles"], strict=True):
            assert mine == pytest.approx(its, abs=1e-12)
