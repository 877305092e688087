"""What a function expects of its arguments, said in one clear sentence when it does not come.

Every check names the argument, what was expected and what came, and returns the value ready to use.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray


def check_real(
    name: str,
    value: Any,
    *,
    above: float = -math.inf,
    at_least: float = -math.inf,
    at_most: float = math.inf,
    below: float = math.inf,
) -> float:
    """A finite real number within the bounds; TypeError or ValueError otherwise."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        raise TypeError(f"{name} must be a number, got {value!r}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite, got {value!r}")
    bounds = []
    if above > -math.inf:
        bounds.append(f"greater than {above:g}")
    if at_least > -math.inf:
        bounds.append(f"at least {at_least:g}")
    if at_most < math.inf:
        bounds.append(f"at most {at_most:g}")
    if below < math.inf:
        bounds.append(f"less than {below:g}")
    if not (above < number < below and at_least <= number <= at_most):
        raise ValueError(f"{name} must be {' and '.join(bounds)}, got {value!r}")
    return number


def check_positive(name: str, value: Any) -> float:
    """A finite real number above zero."""
    return check_real(name, value, above=0)


def check_integer(
    name: str, value: Any, *, at_least: int | None = None, at_most: int | None = None
) -> int:
    """A whole number within the bounds; TypeError or ValueError otherwise."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be a whole number, got {value!r}")
    number = int(value)
    if at_least is not None and number < at_least:
        raise ValueError(f"{name} must be at least {at_least}, got {number}")
    if at_most is not None and number > at_most:
        raise ValueError(f"{name} must be at most {at_most}, got {number}")
    return number


def check_array(
    name: str,
    value: ArrayLike,
    *,
    shape: Sequence[int | str] | None = None,
    dtype: DTypeLike = float,
) -> NDArray[Any]:
    """An array of finite numbers of the given shape; a letter in ``shape`` stands for any length.

    No value is changed on the way to ``dtype``: 1.7 is no whole number, 300 no 8-bit one.
    """
    try:
        given = np.asarray(value)
        if (
            np.dtype(dtype).kind in "biuf"
            and given.size
            and given.dtype.kind not in "biuf"
        ):
            raise TypeError
        with np.errstate(invalid="ignore"):
            result: NDArray[Any] = given.astype(dtype, copy=False)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(
            f"{name} must be an array of numbers, got {type(value).__name__}"
        ) from None
    if shape is not None:
        fits = result.ndim == len(shape) and all(
            isinstance(want, str) or want == got
            for want, got in zip(shape, result.shape, strict=True)
        )
        if not fits:
            wanted = ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "")
            raise ValueError(f"{name} must have shape ({wanted}), got {result.shape}")
    if given.dtype.kind == "f" and not np.isfinite(given).all():
        raise ValueError(f"{name} must hold finite numbers only, got NaN or infinity")
    if result.dtype.kind in "iu" and not (result == given).all():
        limits = np.iinfo(result.dtype)
        raise ValueError(
            f"{name} must hold whole numbers from {limits.min} to {limits.max}"
        )
    return result


def check_instance(name: str, value: Any, kind: type) -> Any:
    """A value of this kind; TypeError otherwise."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be {kind.__name__}, got {type(value).__name__}")
    return value


def check_one_of(name: str, value: Any, choices: Iterable[Any]) -> Any:
    """One of a few choices."""
    known = list(choices)
    if value not in known:
        raise ValueError(
            f"{name} must be one of {', '.join(map(str, known))}, got {value!r}"
        )
    return value


def check_generator(name: str, value: Any) -> np.random.Generator:
    """A numpy Generator, or one made from a whole number of at least 0."""
    if isinstance(value, np.random.Generator):
        return value
    return np.random.default_rng(check_integer(name, value, at_least=0))
