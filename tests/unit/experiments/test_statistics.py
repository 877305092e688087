"""Statistics against cases worked out by hand."""

import numpy as np
import pytest
from scipy import stats

from robonav.experiments import (
    Improvement,
    bootstrap_interval,
    probability_of_improvement,
    summarise,
)


def test_a_summary_by_hand():
    got = summarise([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 100.0])
    assert (got.seeds, got.mean, got.best, got.worst) == (8, 16.0, 100.0, 1.0)
    assert got.interquartile_mean == (3 + 4 + 5 + 6) / 4
    assert got.deviation == pytest.approx(np.std([1, 2, 3, 4, 5, 6, 7, 100], ddof=1))


def test_the_interval_is_the_percentile_bootstrap_of_the_mean():
    values = np.random.default_rng(1).normal(90, 3, 40)
    low, high = bootstrap_interval(values)
    theirs = stats.bootstrap(
        (values,),
        np.mean,
        method="percentile",
        n_resamples=20_000,
        rng=np.random.default_rng(2),
    )
    np.testing.assert_allclose([low, high], theirs.confidence_interval, atol=0.05)


def test_the_interval_covers_the_truth_about_as_often_as_it_says():
    rng = np.random.default_rng(3)
    inside = 0
    for _ in range(200):
        low, high = bootstrap_interval(rng.normal(size=40))
        inside += low <= 0 <= high
    assert 0.88 <= inside / 200 <= 0.99


def test_more_seeds_a_narrower_interval_more_episodes_none():
    """The unit is the seed: four numbers stay four, however many navigations stand behind each."""
    few, many = np.array([80.0, 90, 85, 95]), np.tile([80.0, 90, 85, 95], 25)
    width = [
        high - low for low, high in (bootstrap_interval(few), bootstrap_interval(many))
    ]
    assert width[1] < width[0] / 3


def test_one_seed_has_no_interval():
    got = summarise([7.0])
    assert np.isnan(got.low)
    assert np.isnan(got.deviation)
    assert got.mean == 7


def test_probability_of_improvement_by_hand_and_by_mann_whitney():
    assert probability_of_improvement([1, 2], [0, 3]).probability == 0.5
    assert probability_of_improvement([5, 6], [1, 2]) == Improvement(1, 1, 1)
    assert probability_of_improvement([1], [1]).probability == 0.5
    rng = np.random.default_rng(0)
    a, b = rng.integers(0, 10, 20), rng.integers(2, 12, 15)
    u = stats.mannwhitneyu(a, b).statistic / (20 * 15)
    assert probability_of_improvement(a, b).probability == pytest.approx(u)


def test_the_interval_of_an_improvement_draws_runs_of_both_methods_anew():
    rng = np.random.default_rng(4)
    a, b = rng.normal(0.5, 1, 30), rng.normal(0, 1, 20)

    def wins(ours, theirs, axis=-1):
        return (ours[..., :, None] > theirs[..., None, :]).mean(axis=(-2, -1))

    low, high = stats.bootstrap(
        (a, b),
        wins,
        method="percentile",
        n_resamples=4_000,
        rng=np.random.default_rng(5),
        batch=100,
    ).confidence_interval
    got = probability_of_improvement(a, b)
    np.testing.assert_allclose([got.low, got.high], [low, high], atol=0.01)
    assert str(got) == f"{got.probability:.2f} [{got.low:.2f}, {got.high:.2f}]"


def test_one_run_of_a_method_gives_no_interval_of_improvement():
    got = probability_of_improvement([1.0], [0.0, 2.0])
    assert got.probability == 0.5
    assert np.isnan([got.low, got.high]).all()


@pytest.mark.parametrize("values", [[], [1.0, float("nan")], [[1.0, 2.0]]])
def test_bad_values_are_refused(values):
    with pytest.raises(ValueError, match="values must"):
        summarise(values)
