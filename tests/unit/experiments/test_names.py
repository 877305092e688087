"""One word for one thing in the cases and metrics of all experiments."""

import re

import pytest
from matplotlib import pyplot as plt

from robonav.benchmark import DISPLAY_NAMES, display_name, methods
from robonav.experiments import experiment, names, read_results
from robonav.nirl import METHODS
from robonav.plots.experiments import draw_board

OTHER_WORDS = {
    "method": {
        "rule",
        "robot",
        "learner",
        "policy",
        "algorithm",
        "planner",
        "strategy",
    },
    "reflex in training": {"training"},
    "reflex in test": {"driving"},
    "obstacles": {"standing"},
}
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
EXPERIMENTS = [experiment(name) for name in names()]
COMPARED = {
    str(case["method"])
    for known in EXPERIMENTS
    for case in known.cases
    if "method" in case
}


@pytest.mark.parametrize("known", EXPERIMENTS, ids=names())
def test_columns_have_the_same_names_in_all_results(known):
    for word, others in OTHER_WORDS.items():
        assert not others & set(known.cases[0]), f"the column is called {word}"


def test_methods_have_the_names_of_the_leaderboard():
    assert set(methods()) <= COMPARED
    assert set(METHODS) <= COMPARED
    assert [name for name in COMPARED if not NAME.fullmatch(name)] == []


def test_every_name_with_a_hyphen_has_a_display_name():
    for name in COMPARED:
        assert "-" not in display_name(name) or name == "q-learning"
    assert set(DISPLAY_NAMES) <= COMPARED
    assert len({display_name(name) for name in COMPARED}) == len(COMPARED)


def test_the_board_names_methods_as_pages_do():
    figure = draw_board(read_results("leaderboard"), "success")
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert labels == [display_name(name) for name in methods()]
    plt.close(figure)
