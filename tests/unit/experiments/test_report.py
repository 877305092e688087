"""Tables of results for people."""

from dataclasses import replace

from robonav.experiments import Experiment, Results
from robonav.experiments.runner.report import (
    as_json,
    as_markdown,
    as_table,
    as_text,
    number_of_runs,
    short,
)
from robonav.experiments.runner.statistics import summarise

CASES = [
    {"method": m, "obstacles": n, "speed": 2.0} for m in ("a", "b") for n in (10, 20)
]
EXPERIMENT = Experiment(
    name="table-0.0",
    title="A made-up table",
    cases=CASES,
    run=lambda case, seed, scale: {},
    seeds={"quick": 2, "thesis": 2},
    thesis={"success": [98, None, 56.5, None]},
)


def rows_of(table: str) -> list[str]:
    """The lines of a Markdown table without the spaces that fill its columns."""
    return [
        "|".join(f" {cell.strip()} " for cell in line.split("|")).strip()
        for line in table.splitlines()
    ]


def results() -> Results:
    """Two seeds; the last case has a metric of its own and lacks another."""
    rows = [
        (case, seed, "success", 0, 90.0 - 10 * case + 2 * seed)
        for case in range(4)
        for seed in range(2)
    ]
    rows += [(case, seed, "length", 0, 100.0) for case in range(3) for seed in range(2)]
    rows += [
        (0, seed, "curve", step, float(step)) for seed in range(2) for step in range(3)
    ]
    return Results.from_rows(EXPERIMENT, "quick", rows)


def test_markdown_shows_what_varies_ours_and_the_thesis():
    lines = rows_of(as_markdown(results(), ["success", "length"]))
    assert lines[0] == "| method | obstacles | success | length | success, thesis |"
    assert lines[2] == "| a | 10 | 91.0 [90.0, 92.0] | 100.0 [100.0, 100.0] | 98 |"
    assert lines[4] == "| b | 10 | 71.0 [70.0, 72.0] | 100.0 [100.0, 100.0] | 56.5 |"
    assert lines[5] == "| b | 20 | 61.0 [60.0, 62.0] |  |  |"


def test_a_note_stands_below_the_table_and_the_text():
    noted = replace(EXPERIMENT, note="Method b reads more.")
    with_note = replace(results(), experiment=noted)
    assert number_of_runs(with_note).endswith("over runs. Method b reads more.")
    assert as_text(with_note).splitlines()[-1] == "  Method b reads more."
    assert as_text(with_note).splitlines()[:-1] == as_text(results()).splitlines()


def test_a_table_of_two_dimensions():
    lines = rows_of(as_table(results(), "length", rows="method", columns="obstacles"))
    assert lines[0] == "| method | 10 | 20 |"
    assert lines[3] == "| b | 100.0 [100.0, 100.0] |  |"
    of = {"rows": "method", "columns": "obstacles", "among": ["20"]}
    assert rows_of(as_table(results(), "length", **of))[0] == "| method | 20 |"


def test_a_case_without_a_metric_is_no_error():
    shown = as_json([results()])[0]["cases"]
    assert set(shown[0]["metrics"]) == {
        "success",
        "length",
    }  # a curve is no single number
    assert set(shown[3]["metrics"]) == {"success"}
    assert "b, obstacles 20" in as_text(results())


def test_one_seed_has_no_interval():
    assert short(summarise([97.25])) == "97.2"
