"""Numbers in the texts of drills."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def sign(number: float, digits: int = 4) -> str:
    """Return a number with its sign in front, as a term of a sum.

    Examples
    --------
    >>> sign(0.5), sign(-2)
    ('+ 0.5', '- 2')
    """
    return f"{'-' if number < 0 else '+'} {abs(number):.{digits}g}"


def terms(numbers: ArrayLike, factors: ArrayLike) -> str:
    r"""Return a sum of products as a formula.

    Examples
    --------
    >>> terms([2, -1], [1, 0.5])
    '2 - 0.5 \\cdot 1'
    """
    parts = []
    for number, factor in zip(np.asarray(numbers), np.asarray(factors), strict=True):
        product = (
            f"{abs(number):g}"
            if factor == 1
            else f"{factor:.4g} \\cdot {abs(number):g}"
        )
        parts.append(f"{'-' if number < 0 else '+'} {product}")
    return " ".join(parts).removeprefix("+ ")
