"""How many decimals of an answer count, and answers that are rounded too far."""

from __future__ import annotations

import math

MOST = 8  # a tolerance that asks for more decimals is that of an exact number
NAMES = ("one", "two", "three", "four")


def decimals(tolerance: float) -> int:
    """Return how many decimals an answer needs: rounding to so many stays within the tolerance.

    Parameters
    ----------
    tolerance : float

    Returns
    -------
    int
        0 if whole numbers are enough, or if the tolerance asks for an exact number.

    Examples
    --------
    >>> decimals(0.0051), decimals(0.06), decimals(0.5)
    (2, 1, 0)
    """
    if tolerance <= 0:
        return 0
    count = math.ceil(-math.log10(2 * tolerance))
    return count if 0 < count <= MOST else 0


def words(count: int) -> str:
    """Return a number of decimals in words.

    Examples
    --------
    >>> words(1), words(3), words(0)
    ('one decimal', 'three decimals', '')
    """
    if count == 0:
        return ""
    name = NAMES[count - 1] if count <= len(NAMES) else str(count)
    return f"{name} decimal{'s' * (count > 1)}"


def too_far(tolerance: float) -> str:
    """Return the hint for an answer that is rounded too far.

    Examples
    --------
    >>> too_far(0.0051)
    'This is rounded too far: give two decimals.'
    """
    return f"This is rounded too far: give {words(decimals(tolerance))}."


def rounded_too_far(given: float, answer: float, tolerance: float) -> bool:
    """Return whether a number is the right one, rounded to fewer decimals than it needs.

    Parameters
    ----------
    given, answer : float
        A number that is not right, and the right one.
    tolerance : float
        How much an answer may differ.

    Returns
    -------
    bool

    Examples
    --------
    >>> rounded_too_far(0.7, 0.72, 0.0051), rounded_too_far(0.6, 0.72, 0.0051)
    (True, False)
    """
    first = 0 if abs(answer) >= 1 else 1  # a probability is never rounded to 1
    return given != 0 and any(
        _has_decimals(given, k) and abs(given - answer) <= 0.5 * 10**-k + 1e-9
        for k in range(first, decimals(tolerance))
    )


def _has_decimals(number: float, count: int) -> bool:
    """Whether a number has no more decimals than these."""
    scaled = number * 10**count
    return abs(scaled - round(scaled)) < 1e-6


def roundings(answer: float, tolerance: float) -> list[float]:
    """Return the right number rounded to fewer decimals than it needs, where that is not right any more.

    Parameters
    ----------
    answer, tolerance : float

    Returns
    -------
    list of float
        From whole numbers on.

    Examples
    --------
    >>> roundings(3.14159, 0.0011), roundings(0.25, 0.0051)
    ([3.0, 3.1, 3.14], [0.2])
    """
    tried = dict.fromkeys(round(float(answer), k) for k in range(decimals(tolerance)))
    return [
        number
        for number in tried
        if abs(number - answer) > tolerance
        and rounded_too_far(number, answer, tolerance)
    ]
