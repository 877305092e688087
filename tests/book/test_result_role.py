"""Numbers in the text that the build reads from results."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from browser import ROOT
from notebooks import FENCE, plain
from result_role import ROLE, benchmark, result, with_results

from robonav.experiments import load_results

PAGES = sorted(ROOT.glob("book/**/*.md"))


def successes(method: str) -> np.ndarray:
    table = load_results("table-4.3")
    chosen = (table.method == method) & (table.metric == "success")
    return table[chosen].value.to_numpy()


def test_a_number_is_that_of_the_committed_results() -> None:
    runs = successes("nfq")
    assert result("table-4.3; method=nfq") == f"{runs.mean():.1f}"
    assert result("table-4.3; method=nfq; success; worst; .2f") == f"{runs.min():.2f}"
    assert result("table-4.3; best; .0f; method=nfq") == f"{runs.max():.0f}"
    assert result("table-4.3; method=nfq; seeds") == str(len(runs))
    assert result("table-4.3; method=nfq; thesis") == "87"


def test_an_interval_stands_around_the_mean() -> None:
    low, high = map(float, result("table-4.3; method=dqn; interval").split(" to "))
    assert low <= successes("dqn").mean().round(1) <= high
    written = result("table-4.3; method=dqn; with interval")
    assert written == f"{successes('dqn').mean():.1f} [{low}, {high}]"


def test_a_curve_has_one_number_a_step() -> None:
    table = load_results("figure-5.8")
    table = table[(table.metric == "cost") & (table.discount == 0.65)]
    last = table[table.step == table.step.max()].value
    text = "figure-5.8; discount=0.65; cost"
    assert result(f"{text}; step=last; .3f") == f"{last.mean():.3f}"
    with pytest.raises(ValueError, match="is a curve: choose a step"):
        result(text)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("table-4.3", "must have one case with {}, got 6"),
        ("table-4.3; method=nql", "got 0 of: method=nnql"),
        ("table-4.3; method=nnql; sucess", "metric must be one of"),
        ("table-9.9", "table-9.9"),
        ("table-4.3; method=straight; thesis", "the thesis has no number"),
    ],
)
def test_a_wrong_name_is_one_sentence(text: str, complaint: str) -> None:
    with pytest.raises(ValueError, match=re.escape(complaint)):
        result(text)


def test_a_benchmark_is_read_from_its_line() -> None:
    milliseconds = benchmark("300 iterations: * ms (at most 500 ms)")
    assert benchmark("300 iterations: * ms; .0f") == f"{float(milliseconds):.0f}"
    page = (ROOT / "book/benchmarks.md").read_text("utf-8")
    assert f"300 iterations: {milliseconds} ms" in page
    for text in ("300 iterations: 195 ms", "no such line: * ms"):
        with pytest.raises(ValueError, match="one line of the benchmarks"):
            benchmark(text)


def test_numbers_stand_in_the_text_and_in_notebooks() -> None:
    text = "NNQL succeeds in {result}`table-4.3; method=nnql; .0f` % of the maps."
    expected = f"NNQL succeeds in {successes('nnql').mean():.0f} % of the maps."
    assert with_results(text) == plain(text) == expected


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_page_names_results_that_exist(page: Path) -> None:
    text = with_results(page.read_text("utf-8"))
    assert "{result}" not in text
    assert "{benchmark}" not in text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_no_number_stands_in_a_code_cell(page: Path) -> None:
    """The cell would be executed twice: before its numbers are put in, and after."""
    fences = FENCE.finditer(page.read_text("utf-8"))
    cells = [fence["body"] for fence in fences if fence["name"] == "code-cell"]
    assert [cell for cell in cells if ROLE.search(cell)] == []
