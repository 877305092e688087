"""Statistics over seeds, never over episodes.

Interquartile mean and probability of improvement are those of Agarwal et al. (2021), "Deep reinforcement learning at
the edge of the statistical precipice".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from robonav.validation import check_array

RESAMPLES = 10_000
LEVEL = 0.95


@dataclass(frozen=True)
class Summary:
    """Statistics of a number over seeds.

    Attributes
    ----------
    seeds : int
        The number of seeds.
    mean, deviation : float
        Mean and sample standard deviation.
    low, high : float
        The bounds of the 95 % interval of the mean, see :func:`bootstrap_interval`.
    best, worst : float
        The greatest and the least number.
    interquartile_mean : float
        The mean of the middle half.

    Examples
    --------
    >>> Summary(1, 3.0, 2.0, 4.0, 1.0, 4.0, 2.0, 3.0).mean
    3.0
    """

    seeds: int
    mean: float
    low: float
    high: float
    deviation: float
    best: float
    worst: float
    interquartile_mean: float


def summarise(values: ArrayLike) -> Summary:
    """Compute the statistics of a number over seeds.

    Parameters
    ----------
    values : (S,) array
        One number for each seed.

    Returns
    -------
    Summary
        The statistics. The bootstrap has a fixed seed, so equal numbers give equal intervals. With one seed, interval
        and deviation are NaN.

    Raises
    ------
    ValueError
        If there is no number, or one is not finite.

    Examples
    --------
    >>> summary = summarise([90, 92, 94, 96])
    >>> summary.mean, summary.worst, summary.interquartile_mean
    (93.0, 90.0, 93.0)
    """
    runs = _runs("values", values)
    low, high = bootstrap_interval(runs)
    return Summary(
        seeds=len(runs),
        mean=float(runs.mean()),
        low=low,
        high=high,
        deviation=float(runs.std(ddof=1)) if len(runs) > 1 else float("nan"),
        best=float(runs.max()),
        worst=float(runs.min()),
        interquartile_mean=float(stats.trim_mean(runs, 0.25)),
    )


def bootstrap_interval(values: ArrayLike) -> tuple[float, float]:
    """Return the bounds of the 95 % interval of the mean over seeds.

    Parameters
    ----------
    values : (S,) array
        One number for each seed.

    Returns
    -------
    tuple of two floats
        The 2.5 and 97.5 percentiles of the means of 10,000 resamples of the seeds, or NaN for one seed.

    Examples
    --------
    >>> low, high = bootstrap_interval([90, 92, 94, 96])
    >>> low, high
    (91.0, 95.0)
    """
    runs = _runs("values", values)
    if len(runs) == 1:
        return float("nan"), float("nan")
    # scipy.stats.bootstrap(method="percentile") draws its resamples in another order: published intervals would change.
    rng = np.random.default_rng(0)
    return _middle(
        runs[rng.integers(len(runs), size=(RESAMPLES, len(runs)))].mean(axis=1)
    )


@dataclass(frozen=True)
class Improvement:
    """The probability that a run of one method is better than a run of another.

    Attributes
    ----------
    probability : float
        The probability.
    low, high : float
        The bounds of its 95 % interval.

    Examples
    --------
    >>> print(Improvement(0.9, 0.8, 1.0))
    0.90 [0.80, 1.00]
    """

    probability: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.probability:.2f} [{self.low:.2f}, {self.high:.2f}]"


def probability_of_improvement(ours: ArrayLike, theirs: ArrayLike) -> Improvement:
    """Return the probability that a run of one method is better than a run of another. A tie counts half.

    Parameters
    ----------
    ours : (S,) array
        One number for each run of the first method.
    theirs : (R,) array
        One number for each run of the second method.

    Returns
    -------
    Improvement
        The probability and its interval, from a percentile bootstrap that resamples the runs of both methods. The
        interval is NaN if a method has only one run.

    Raises
    ------
    ValueError
        If there is no run, or a number is not finite.

    Examples
    --------
    >>> probability_of_improvement([3, 4], [1, 3]).probability
    0.875
    """
    a, b = _runs("ours", ours), _runs("theirs", theirs)
    difference = a[:, None] - b[None, :]
    wins = (difference > 0) + (difference == 0) / 2
    if min(wins.shape) == 1:
        return Improvement(float(wins.mean()), float("nan"), float("nan"))
    rng = np.random.default_rng(0)
    of_ours, of_theirs = (
        rng.multinomial(n, np.full(n, 1 / n), size=RESAMPLES) / n for n in wins.shape
    )
    return Improvement(
        float(wins.mean()), *_middle(((of_ours @ wins) * of_theirs).sum(axis=1))
    )


def _middle(resampled: NDArray[np.float64]) -> tuple[float, float]:
    """Return the bounds of the middle 95 % of resampled numbers."""
    low, high = np.quantile(resampled, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return float(low), float(high)


def _runs(name: str, values: ArrayLike) -> NDArray[np.float64]:
    runs: NDArray[np.float64] = check_array(name, values, shape=("seeds",))
    if len(runs) == 0:
        raise ValueError(f"{name} must hold at least one run, got none")
    return runs
