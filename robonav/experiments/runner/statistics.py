"""What a table says about runs: over seeds, never over episodes.

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
    """One number a seed, summed up; ``low`` and ``high`` bound the mean with 95 % confidence."""

    seeds: int
    mean: float
    low: float
    high: float
    deviation: float
    best: float
    worst: float
    interquartile_mean: float


def summarise(values: ArrayLike) -> Summary:
    """Sum up one value a seed (S,).

    The interval is a percentile bootstrap over seeds with a fixed seed of its own: the same values, the same interval.
    With one seed there is none: it is NaN.

    Raises
    ------
    ValueError : if there is no value, or one is not finite.
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
    """Bounds of the mean over seeds (S,), 95 %: percentiles of the means of 10,000 resamples of the seeds."""
    runs = _runs("values", values)
    if len(runs) == 1:
        return float("nan"), float("nan")
    rng = np.random.default_rng(0)
    return _middle(
        runs[rng.integers(len(runs), size=(RESAMPLES, len(runs)))].mean(axis=1)
    )


@dataclass(frozen=True)
class Improvement:
    """How likely one method's run beats another's; ``low`` and ``high`` bound it with 95 % confidence."""

    probability: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.probability:.2f} [{self.low:.2f}, {self.high:.2f}]"


def probability_of_improvement(ours: ArrayLike, theirs: ArrayLike) -> Improvement:
    """How likely a run of ours (S,) beats a run of theirs (R,); a tie counts half.

    The interval is a percentile bootstrap that draws runs of each method anew; with one run of a method it is NaN.

    Raises
    ------
    ValueError : if there is no run, or one is not finite.
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
    """Between which 95 % of resampled numbers lie."""
    low, high = np.quantile(resampled, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return float(low), float(high)


def _runs(name: str, values: ArrayLike) -> NDArray[np.float64]:
    runs: NDArray[np.float64] = check_array(name, values, shape=("seeds",))
    if len(runs) == 0:
        raise ValueError(f"{name} must hold at least one run, got none")
    return runs
