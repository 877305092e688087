"""Checks of arguments. A failed check raises an error with one clear sentence.

The sentence names the argument, the expectation and the value. A check that passes returns the value, ready to use.
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
    """Return ``value`` as a float if it is a finite number within the bounds.

    Examples
    --------
    >>> check_real("discount", 0.9, at_least=0, at_most=1)
    0.9
    >>> check_real("discount", 1.5, at_least=0, at_most=1)
    Traceback (most recent call last):
    ValueError: discount must be at least 0 and at most 1, got 1.5
    """
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
    """Return ``value`` as a float if it is finite and greater than 0."""
    return check_real(name, value, above=0)


def check_integer(
    name: str, value: Any, *, at_least: int | None = None, at_most: int | None = None
) -> int:
    """Return ``value`` as an int if it is a whole number within the bounds.

    Examples
    --------
    >>> check_integer("episodes", 300, at_least=1)
    300
    """
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
    """Return ``value`` as an array of finite numbers with this shape. A letter in ``shape`` stands for any length.

    A conversion to ``dtype`` that would change a value is an error: 1.7 is not a whole number, and 300 is not an
    8-bit one.

    Examples
    --------
    >>> check_array("values", [1, 2, 3], shape=("S",))
    array([1., 2., 3.])
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
    """Return ``value`` if it is an instance of ``kind``."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be {kind.__name__}, got {type(value).__name__}")
    return value


def check_one_of(name: str, value: Any, choices: Iterable[Any]) -> Any:
    """Return ``value`` if it is one of the choices."""
    known = list(choices)
    if value not in known:
        raise ValueError(
            f"{name} must be one of {', '.join(map(str, known))}, got {value!r}"
        )
    return value


def check_generator(name: str, value: Any) -> np.random.Generator:
    """Return ``value`` if it is a numpy Generator, or a new Generator with ``value`` as its seed."""
    if isinstance(value, np.random.Generator):
        return value
    return np.random.default_rng(check_integer(name, value, at_least=0))
