"""The results that the pages show: made by the code as it is, and made again at the quick scale."""

import dataclasses
import json
import math

import numpy as np
import pytest
from scipy import stats

from robonav.experiments import RESULTS, experiment, names, read_results, reproduce
from robonav.experiments.runner.results import FORMAT
from robonav.experiments.runner.run import run_unit
from robonav.robot import REFLEX, Reflex

pytestmark = pytest.mark.slow

CHANCE = (
    1e-5  # that a number of another machine falls outside: two thousand are looked at
)
RATES = {
    "success",
    "success, low temperature",
    "collision",
    "out of steps",
    "SPL",
}  # per cent of episodes
EPISODES = {"leaderboard": 20, "figure-5.10": 20}  # of a quick run; of all others 100


@pytest.fixture(autouse=True)
def named_reflex(monkeypatch):
    """An experiment that takes the package's default reflex fails, since its numbers would change with the default."""
    act = Reflex.__call__

    def only_if_named(reflex, sensing, speed):
        assert reflex is not REFLEX, "the experiment must name its reflex"
        return act(reflex, sensing, speed)

    monkeypatch.setattr(Reflex, "__call__", only_if_named)


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
    committed = read_results(known)
    expected = {
        (case, seed)
        for case in range(len(known.cases))
        for seed in range(known.seeds["thesis"])
    }
    assert (
        set(committed.frame[["case", "seed"]].itertuples(index=False, name=None))
        == expected
    )
    assert {metric for metric, numbers in known.thesis.items() if any(numbers)} <= set(
        committed.frame.metric
    )


def foretold(values, runs, episodes):
    """The interval in which the mean of other runs lies almost surely, if runs are about normal.

    ``episodes`` is the number behind a rate: with few of them a rate varies more than in the committed runs. What never
    varied may vary by a hundredth.
    """
    mean = np.mean(values)
    deviation = max(np.std(values, ddof=1), 0.01 * abs(mean))
    variance = deviation**2
    if episodes:
        probability = (episodes * mean / 100 + 2) / (episodes + 4)
        variance += 1e4 * probability * (1 - probability) / episodes
    reach = stats.t.ppf(1 - CHANCE / 2, len(values) - 1) * math.sqrt(
        variance / runs + deviation**2 / len(values)
    )
    return mean - reach, mean + reach


def check_again(known, chosen, seeds, folder):
    """Run the chosen cases on this machine, with this code, and compare with the committed results."""
    part = dataclasses.replace(
        known,
        cases=[known.cases[case] for case in chosen],
        seeds=dict(known.seeds) | {"quick": seeds},
        thesis={},
    )
    quick, committed = reproduce(part, folder, jobs=1), read_results(known)
    episodes = EPISODES.get(known.name, 100)
    for position, case in enumerate(chosen):
        settings = known.cases[case]
        for metric in quick.metrics(position):
            again = quick.values(metric, position)
            values = committed.values(metric, case)
            assert again.shape[1:] == values.shape[1:], (settings, metric)
            if values.ndim > 1:  # a curve, by its mean
                again, values = again.mean(axis=1), values.mean(axis=1)
            if len(values) == 1:  # nothing is random
                assert again == pytest.approx(values, rel=1e-3), (settings, metric)
                continue
            low, high = foretold(values, len(again), episodes if metric in RATES else 0)
            assert low <= again.mean() <= high, (settings, metric, values.mean())


WHOLE = [name for name in names() if not experiment(name).shortened]
ONE_CASE = {
    "figure-4.6": -1,
    "figure-5.10": -1,
    "lab-nirl": -1,
    "nfq-late": -1,
    "nirl-choice": -1,
    "nirl-controls": -1,
    "nirl-refinement": -1,
    "nirl-sensors": -1,
    "nirl-steps": -1,
    "nirl-updates": 0,
    "nnql-20-obstacles": -1,
    "nnql-maps": -1,
    "nnql-steps": -1,
    "table-5.1": -1,
}
"""The case that is run of an experiment whose other one is a long training: others here train by the same method."""


@pytest.mark.parametrize("name", WHOLE)
def test_a_quick_run_of_the_first_and_last_case_falls_where_the_committed_results_foretell(
    name, tmp_path
):
    known = experiment(name)
    every = range(len(known.cases))
    some = (ONE_CASE[name],) if name in ONE_CASE else (0, -1)
    check_again(known, sorted({every[case] for case in some}), 1, tmp_path)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", WHOLE)
def test_the_quick_scale_falls_where_the_committed_results_foretell(name, tmp_path):
    """All cases of an experiment with all seeds of the quick scale."""
    known = experiment(name)
    check_again(known, range(len(known.cases)), known.seeds["quick"], tmp_path)


@pytest.mark.parametrize(
    "name", [name for name in names() if experiment(name).shortened]
)
def test_what_is_shortened_gives_the_same_kinds_of_numbers(name):
    known, committed = experiment(name), read_results(name)
    assert "shorten" not in known.shortened  # it says how
    _, rows, _ = run_unit(known, (0, 0), "quick")
    assert {metric for _, _, metric, _, _ in rows} == set(committed.metrics(0))
    assert all(math.isfinite(value) for *_, value in rows)


def test_a_prediction_by_hand():
    """Of four runs one more: Student's t with three degrees of freedom, sqrt(1 + 1/4) deviations wide."""
    low, high = foretold([90.0, 92, 94, 96], 1, 0)
    reach = (
        stats.t.ppf(1 - CHANCE / 2, 3)
        * np.std([90, 92, 94, 96], ddof=1)
        * math.sqrt(5 / 4)
    )
    assert (low, high) == pytest.approx((93 - reach, 93 + reach))
    wider = foretold([90.0, 92, 94, 96], 1, 50)
    assert wider[0] < low < high < wider[1]
