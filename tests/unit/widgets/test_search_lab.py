"""The search lab: its data, what it answers, and its JavaScript under Node."""

import numpy as np
import pytest

from robonav.lfd import plan, plan_on_grid
from robonav.robot import random_worlds
from robonav.widgets.search_lab import search_lab


@pytest.fixture(scope="module")
def lab():
    worlds = {"few": random_worlds(1, 8, seed=3), "many": random_worlds(1, 20, seed=4)}
    return search_lab(worlds, margins=(2.0, 4.0), cells=(2.0,), speed=2.5)


def search_in(node, packed):
    files = ("simulator", "maps", "search_lab")
    return node(
        files,
        "const s = page.searchOf(data); return { ...s, visited: [...s.visited] };",
        packed,
    )


def test_searches_reach_the_page_as_they_went(node, lab):
    world = random_worlds(1, 20, seed=4)
    by_actions = plan(world, margin=4.0, cell=2.0, speed=2.5, record=True)
    on_grid = plan_on_grid(world, margin=4.0, cell=2.0, record=True)
    run = lab.data["runs"][3]
    for packed, expected in zip(run, (by_actions, on_grid), strict=True):
        seen = search_in(node, packed)
        assert seen["expanded"] == expected.expanded
        assert seen["length"] == expected.length
        np.testing.assert_allclose(seen["points"], expected.points, atol=1e-12)
        visited = np.reshape(seen["visited"], (-1, 2))
        np.testing.assert_allclose(visited, expected.visited[:, :2], atol=0.0051)
    assert [search["steps"] for search in run] == [len(by_actions.actions), None]


def test_frames_go_from_nothing_to_all_nodes(node):
    body = "return Array.from({ length: 101 }, (_, f) => page.nodesAt(f, data));"
    nodes = node(("simulator", "maps", "search_lab"), body, 1387)
    assert nodes[0] == 0
    assert nodes[-1] == 1387
    assert (np.diff(nodes) >= 0).all()


def test_a_search_says_what_it_has_come_to(node):
    body = "return [3, 9, 99].map((n) => page.progressOf({ expanded: 9, found: data, length: 7.25 }, n));"
    files = ("simulator", "maps", "search_lab")
    assert node(files, body, True) == [
        "3 nodes, still searching",
        *["done after 9 nodes: 7.3 m"] * 2,
    ]
    assert node(files, body, False)[1] == "9 nodes, and no way found"


def test_another_target_is_searched_for_or_its_fault_named(lab):
    answers = []
    lab.send = answers.append
    lab._answer(lab, {"ask": "kernel"}, [])
    lab._answer(lab, {"ask": "search", "chosen": [0, 1, 0], "target": [20, 80]}, [])
    lab._answer(lab, {"ask": "search", "chosen": [0, 1, 0], "target": [20, 800]}, [])
    lab._answer(lab, {"ask": "search", "chosen": [0, 1, 0], "target": [None, 1]}, [])
    assert answers[0] == {"kernel": True}
    assert answers[1]["target"] == [20, 80]
    first, second = answers[1]["run"]
    assert first["found"]
    assert second["found"]
    assert first["length"] != lab.data["runs"][1][0]["length"]
    assert "target" in answers[2]["error"]
    assert "target" in answers[3]["error"]


def test_there_must_be_something_to_choose():
    with pytest.raises(ValueError, match="worlds must hold at least one"):
        search_lab({})
    with pytest.raises(ValueError, match="margins must hold at least one"):
        search_lab({"a": random_worlds(1, seed=0)}, margins=())
