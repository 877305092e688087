"""The run of A* that the page works by hand, and the rows of its figure that it speaks of."""

import re
from collections.abc import Callable

import pytest

from robonav.experiments import read_results
from robonav.experiments.chapter3 import tables

STEPS = {"SA": 2, "SB": 5, "AB": 2, "AC": 3, "BT": 5, "CT": 6}
REST = {"S": 7, "A": 5, "B": 3, "C": 3, "T": 0}


@pytest.fixture
def page(page_text: Callable[[str], str]) -> str:
    return page_text("a-star")


def neighbours(node):
    for step, length in STEPS.items():
        if node in step:
            yield step.replace(node, ""), length


def run():
    """The expanded nodes with their G and the open list afterwards. No two open nodes have the same F."""
    found, closed = {"S": 0}, set()
    while "T" not in closed:
        node = min(found.keys() - closed, key=lambda n: found[n] + REST[n])
        closed.add(node)
        for other, length in neighbours(node):
            if found[node] + length < found.get(other, 99):
                assert other not in closed
                found[other] = found[node] + length
        waiting = {n: found[n] + REST[n] for n in sorted(found.keys() - closed)}
        assert len(set(waiting.values())) == len(waiting)  # no tie
        yield node, found[node], waiting


def test_the_run_by_hand(page):
    for node, rest in REST.items():
        assert all(
            rest <= length + REST[other] for other, length in neighbours(node)
        )  # H is consistent
    for step, length in STEPS.items():
        assert f"{step} {length}" in page
    rows = re.findall(
        r"^\| \d \| (\w) \| (\d) \+ (\d) = (\d) \|.*\| ([^|]*) \|$", page, re.M
    )
    expected = [
        (node, G, REST[node], G + REST[node], waiting) for node, G, waiting in run()
    ]
    assert len(rows) == len(expected) == 5
    for (node, *numbers, waiting), (name, *others, opened) in zip(
        rows, expected, strict=True
    ):
        assert (node, *map(int, numbers)) == (name, *others)
        left = ", ".join(f"{n} {F}" for n, F in opened.items())
        assert waiting.strip() == (left or "empty")


def test_shorter_in_all_rows_and_more_nodes_in_seven():
    results = read_results(tables.FIGURE_3_5)
    shorter, more = [], []
    for place in range(len(results.experiment.cases)):
        lengths, nodes = (
            [
                results.summary(f"{what}, {name} A*", place).mean
                for name in ("modified", "grid")
            ]
            for what in ("length", "expanded")
        )
        shorter.append(lengths[0] < lengths[1])
        more.append(nodes[0] > nodes[1])
    assert shorter == [True] * 8
    assert more == [True] * 4 + [False] + [True] * 3
