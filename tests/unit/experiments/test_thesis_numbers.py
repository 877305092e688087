"""The thesis's numbers, typed here from its tables and lists, are those that the package and the pages give."""

import re
from pathlib import Path

import numpy as np
import pytest

from robonav.experiments.chapter3 import setup as chapter3
from robonav.experiments.chapter3 import tables as chapter3_tables
from robonav.experiments.chapter4 import setup as chapter4
from robonav.experiments.chapter4 import tables as chapter4_tables
from robonav.experiments.chapter5 import setup as chapter5
from robonav.experiments.chapter5 import tables as chapter5_tables
from robonav.robot import SENSOR_RANGE
from robonav.robot.encoding import DANGER_BORDERS

BOOK = Path(__file__).parents[3] / "book"

TABLE_3_1 = [
    3,
    7,
    11,
    15,
    20,
    25,
    30,
]  # centimetres below which the degree is 7, 6, ...
TABLE_3_2 = {20: 89, 25: 92, 30: 92, 35: 93, 40: 94}
TABLE_3_3 = {  # iterations: accuracy, seconds
    100: (81.12, 3.42),
    200: (82.68, 6.82),
    250: (82.83, 8.75),
    300: (83.62, 10.64),
    350: (83.31, 12.77),
    400: (83.15, 13.64),
    500: (83.46, 17.08),
}
TABLE_4_1 = [
    "1",
    "0",
    "0",
    "0.5",
    "0",
    "−1",
    "−0.2",
    "−0.2",
    "−0.5",
    "−1",
    "0.6",
    "0.4",
]
TABLE_4_3 = {"nnql": (98, 100, 94), "online": (56, 74, 29), "nfq": (87, 97, 83)}
TABLE_5_1 = {
    "computer": {25: 90, 30: 91, 40: 89, 50: 87},
    "human": {25: 82, 30: 85, 40: 84, 50: 84},
}
TABLE_5_2 = {  # average, best, worst
    "nirl": (83, 94, 69),
    "apprenticeship": (66, 82, 43),
    "relative-entropy": (78, 87, 61),
    "scirl": (79, 88, 60),
}


def page(name):
    """The text of a page with single spaces."""
    return " ".join((BOOK / f"{name}.md").read_text("utf-8").split())


def in_row(name, start):
    """The numbers in the row of a table of a page."""
    lines = (BOOK / f"{name}.md").read_text("utf-8").splitlines()
    (row,) = [line for line in lines if line.startswith(f"| {start}")]
    return [
        float(number)
        for number in re.findall(r"\d+(?:\.\d+)?", row.partition(start)[2])
    ]


def thesis_by(experiment, *keys):
    """The thesis's success rates of an experiment by some settings of its cases."""
    rates = experiment.thesis["success"]
    return {
        tuple(case[key] for key in keys): rate
        for case, rate in zip(experiment.cases, rates, strict=True)
        if rate is not None
    }


def test_table_3_1_and_its_borders_in_metres():
    shown = in_row("demonstrations", "thesis, sensor of 30 cm: nearer than")
    assert shown == TABLE_3_1
    borders = np.array(TABLE_3_1) * SENSOR_RANGE / TABLE_3_1[-1]
    np.testing.assert_allclose(sorted(DANGER_BORDERS), borders)
    ours = in_row("demonstrations", "here, sensor of 10 m: nearer than")
    np.testing.assert_allclose(ours, borders, atol=0.005)


def test_table_3_2():
    found = thesis_by(chapter3_tables.TABLE_3_2, "demonstrations")
    assert found == {(number,): rate for number, rate in TABLE_3_2.items()}
    row = ", ".join(map(str, TABLE_3_2.values()))
    assert f'table_row("thesis (%)", {row})' in page("lfd-results")


def test_table_3_3():
    experiment = chapter3_tables.TABLE_3_3
    iterations = [case["iterations"] for case in experiment.cases]
    accuracies = experiment.thesis["accuracy"]
    assert {*zip(iterations, accuracies, strict=True)} == {
        (number, accuracy) for number, (accuracy, _) in TABLE_3_3.items()
    }
    row = ", ".join(str(seconds) for _, seconds in TABLE_3_3.values())
    assert f'table_row("thesis: time (s)", {row})' in page("lfd-results")


def test_table_4_1_as_the_thesis_prints_it():
    text = (BOOK / "reward-and-exploration.md").read_text("utf-8")
    printed = text.partition("{dropdown} Table 4.1")[2].partition("```")[0]
    rows = [line.split("|") for line in printed.splitlines() if line.startswith("|")]
    assert [row[-2].strip() for row in rows[2:]] == TABLE_4_1


def test_table_4_3_with_its_best_and_worst():
    found = thesis_by(chapter4_tables.TABLE_4_3, "method")
    assert found == {(name,): mean for name, (mean, *_) in TABLE_4_3.items()}
    text = page("nnql-comparison")
    for name, (mean, _, worst) in TABLE_4_3.items():
        assert f'"{name}": ({mean}, {worst})' in text
    best = [str(each) for _, each, _ in TABLE_4_3.values()]
    assert f"in the thesis in {', '.join(best[:-1])} and {best[-1]} %" in text


def test_table_5_1():
    found = thesis_by(chapter5_tables.TABLE_5_1, "method", "expert", "demonstrations")
    assert found == {
        ("nirl", expert, number): rate
        for expert, rates in TABLE_5_1.items()
        for number, rate in rates.items()
    }


def test_table_5_2_with_its_best_and_worst():
    found = thesis_by(chapter5_tables.TABLE_5_2, "method", "discount")
    assert found == {(name, 0.65): mean for name, (mean, *_) in TABLE_5_2.items()}
    text = page("nirl-comparison")
    for name, (mean, best, worst) in TABLE_5_2.items():
        assert f'"{name}": ({mean}, {worst}, {best})' in text


def test_conditions_of_the_experiments():
    """Sections 3.6, 4.5 and 5.6."""
    assert chapter3.CONDITIONS["demonstrations"] == 25
    assert chapter3.CONDITIONS["iterations"] == 300
    assert chapter3.CONDITIONS["test"]["max_steps"] == 500
    assert (
        chapter3.CONDITIONS["test"]["speed"]
        == chapter5.CONDITIONS["test"]["speed"]
        == 2
    )
    assert (chapter4.EPISODES, chapter4.BLOCK) == (300, 30)
    assert chapter4.CONDITIONS["test"]["max_steps"] == 400
    assert chapter4.CONDITIONS["test"]["speed"] == 2.5
    assert chapter4_tables.SPEEDS == (1.5, 2, 2.5, 3, 3.5, 4)
    assert (chapter5.DEMONSTRATIONS, chapter5.ITERATIONS) == (30, 140)
    assert (chapter5.EPISODES_PER_ITERATION, chapter5.DISCOUNT) == (10, 0.65)
    assert chapter5.CONDITIONS["test"]["obstacles"] == 20
    assert chapter5_tables.NUMBERS == (20, 25, 30, 35, 40, 50)


def test_learning_rates_of_chapter_4():
    given = chapter4.THESIS["nnql"]
    assert given["learning_rate"] == 0.8
    assert given["discount"] == 0.7
    assert given["gradient_step"] == 0.3
    assert given["temperature"][0] == 0.9


@pytest.mark.parametrize(
    ("start", "numbers"),
    [
        ("learning rate of the values $\\alpha$", [0.8, 0.8]),
        ("discount $\\gamma$", [0.65, 0.65]),
        ("hidden units", [10, 8, 10]),
        ("episodes an iteration, iterations", [10, 140, 10, 140]),
        ("sensor range, warning distance ($d_{bou}$, $d_{warn}$)", [10, 5, 10, 5]),
    ],
)
def test_settings_of_nirl_on_its_page(start, numbers):
    assert in_row("nirl", start) == numbers
