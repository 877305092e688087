"""Timing against something else in the same run, for machines that others use too."""

from __future__ import annotations

import statistics
from collections.abc import Callable


def in_turn(
    ours: Callable[[], float], other: Callable[[], float], rounds: int
) -> tuple[float, float, float]:
    """Medians of both, and of their ratio, round by round."""
    measured = [(ours(), other()) for _ in range(rounds)]
    return (
        statistics.median(a for a, _ in measured),
        statistics.median(b for _, b in measured),
        statistics.median(a / b for a, b in measured),
    )
