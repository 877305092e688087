"""The results that the pages show: made by the code as it is, and made again by a run of our own."""

import json
import math

import numpy as np
import pytest
from scipy import stats

from robonav.experiments import RESULTS, experiment, load_results, names
from robonav.experiments.running import run_unit
from robonav.experiments.store import FORMAT

NEW_SEED = 5_000  # that no committed run has
FEWEST = 4  # runs that make a prediction worth holding against
SLOW = {"nirl-transfer", "nnql-20-obstacles"}  # half a minute a run


def settled(settings):
    """As JSON has them."""
    return json.loads(json.dumps(dict(settings)))


@pytest.mark.parametrize("name", names())
def test_committed_results_are_of_the_code_as_it_is(name):
    """Other settings or cases would have made other numbers: then `robonav reproduce NAME --scale thesis`."""
    known = experiment(name)
    about = json.loads((RESULTS / f"{name}.json").read_text())
    assert (about["format"], about["scale"]) == (FORMAT, "thesis")
    assert about["settings"] == settled(known.settings)
    rows = load_results(RESULTS, known).rows
    expected = {(case, seed) for case in range(len(known.cases)) for seed in range(known.seeds["thesis"])}
    assert {(row.case, row.seed) for row in rows} == expected


def prediction(values):
    """Where one more run falls with a chance of 99.9 %, if runs are about normal; what never varied may by a little."""
    deviation = max(np.std(values, ddof=1), 0.01 * abs(np.mean(values)))
    reach = stats.t.ppf(0.9995, len(values) - 1) * deviation * math.sqrt(1 + 1 / len(values))
    return np.mean(values) - reach, np.mean(values) + reach


def foretold():
    return [name for name in names() if experiment(name).seeds["thesis"] >= FEWEST and name not in SLOW]


@pytest.mark.parametrize("name", foretold())
def test_a_new_run_falls_where_the_committed_ones_foretell(name):
    """A seed that none of them had, on this machine, with this code."""
    known, committed = experiment(name), load_results(RESULTS, experiment(name))
    _, rows, _ = run_unit(known, (0, NEW_SEED), "thesis")
    metrics = {row.metric for row in rows}
    compared = 0
    for row in rows:
        if "success" in metrics and row.metric != "success":
            continue  # rarer things, such as drives out of steps, are far from normal
        values = committed.values(row.metric, 0)
        if values.ndim == 1:
            low, high = prediction(values)
            assert low <= row.value <= high, f"{row.metric}: {row.value:g} is not within {low:g} to {high:g}"
            compared += 1
        elif row.step == 0:
            assert values.shape[1] == sum(other.metric == row.metric for other in rows)
            compared += 1
    assert compared
