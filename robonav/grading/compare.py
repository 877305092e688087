"""Describe how a student's answer differs from the expected one, and how feedback shows a call."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

RELATIVE = 1e-5  # large enough for an answer computed in single precision
MOST_SHOWN = 300  # characters of an argument
MINUS_ZERO = re.compile(r"(?<![\w.])-(?=0(\.0*)?(?![\w.]))")  # the sign
SCALED = 1e-6  # allows for cancellation, relative to the largest expected number


def difference(got: Any, expected: Any) -> str | None:
    """Describe what is wrong with ``got``, or return None if it is right.

    Numbers must agree within a relative error of 1e-5, or within 1e-6 of the largest expected number. Whole numbers and
    truth values must be equal. NaN equals NaN, so that known mistakes can be recognised; no right answer contains it.
    A list counts as an array, any dtype that can hold the values is accepted, and shapes must match.
    """
    match expected:
        case None | str():
            return (
                None
                if type(got) is type(expected) and got == expected
                else _unlike(expected, got)
            )
        case dict():
            if not isinstance(got, dict) or set(got) != set(expected):
                return _unlike(expected, got)
            parts = [(f"[{key!r}]", got[key], value) for key, value in expected.items()]
        case list() | tuple():
            parts_came = isinstance(got, list | tuple) or (
                isinstance(got, np.ndarray) and got.ndim > 0
            )
            if not parts_came or len(got) != len(expected):
                return _unlike(expected, got)
            parts = [(f"[{n}]", got[n], value) for n, value in enumerate(expected)]
        case _:
            return _numbers_differ(got, np.asarray(expected))
    for name, one, other in parts:
        if found := difference(one, other):
            return f"in answer{name}, {found}"
    return None


def only(value: Any, expected: Any, at: Any) -> Any:
    """Return the expected answer with the places ``at`` taken from ``value``, so that only these can differ.

    A value of another shape is returned as it is.
    """
    if isinstance(expected, list | tuple):
        came = isinstance(value, list | tuple) or (
            isinstance(value, np.ndarray) and value.ndim > 0
        )
        if not came or len(value) != len(expected):
            return value
        chosen = list(expected)
        chosen[at] = value[at]
        return tuple(chosen) if isinstance(expected, tuple) else chosen
    array = as_numbers(value)
    if array is None or array.shape != np.shape(expected):
        return value
    mixed = np.array(expected, dtype=np.result_type(expected, array))
    mixed[at] = array[at]
    return mixed


def is_near(got: Any, expected: Any) -> bool:
    """Whether all numbers are right to a hundredth of the largest, though they are not right."""
    if isinstance(expected, list | tuple):
        came = isinstance(got, list | tuple) and len(got) == len(expected)
        return came and all(
            difference(one, other) is None or is_near(one, other)
            for one, other in zip(got, expected, strict=True)
        )
    array = as_numbers(got)
    target = np.asarray(expected)
    if array is None or target.dtype.kind != "f" or array.shape != target.shape:
        return False
    if not np.isfinite(array).all() or not np.isfinite(target).all():
        return False
    return bool(np.abs(array - target).max(initial=0) <= 0.01 * np.abs(target).max())


def as_numbers(value: Any) -> np.ndarray | None:
    """Convert a student's answer to an array of numbers or truth values. Return None if that is impossible."""
    if not _holds_numbers(value):
        return None
    try:
        array = np.asarray(value)
    except (ValueError, TypeError):  # a ragged list
        return None
    return array if array.dtype.kind in "biuf" else None


def _holds_numbers(value: Any) -> bool:
    """Whether a value holds only numbers. Numpy could turn strings into an array of any size."""
    if isinstance(value, list | tuple):
        return all(map(_holds_numbers, value))
    return isinstance(value, bool | int | float | np.generic | np.ndarray)


def _numbers_differ(got: Any, expected: np.ndarray) -> str | None:
    array = as_numbers(got)
    # no rows: a list without rows does not tell their length
    if isinstance(got, list) and not got and expected.shape[:1] == (0,):
        return None
    if array is None or array.shape != expected.shape:
        return _unlike(expected, got)
    close = _close(array, expected)
    if close.all():
        return None
    place = np.argwhere(~close)[0].tolist() if close.ndim else []
    where = f"at {place} " if place else ""
    return f"{where}expected {_number(expected[tuple(place)])}, got {_number(array[tuple(place)])}"


def _close(array: np.ndarray, expected: np.ndarray) -> np.ndarray:
    """Say where numbers agree: real ones as ``numpy.isclose`` says, in half its time, and others exactly.

    Examples
    --------
    >>> _close(np.array([1.0, 2.1, np.nan]), np.array([1.000001, 2.0, np.nan]))
    array([ True, False,  True])
    """
    if expected.dtype.kind != "f":
        return array == expected
    with np.errstate(all="ignore"):
        size, finite = np.abs(expected), np.isfinite(expected)
        allowed = SCALED * size.max(initial=0.0, where=finite) + RELATIVE * size
        near = np.less_equal(np.abs(array - expected), allowed) & finite
    return near | (array == expected) | (np.isnan(array) & np.isnan(expected))


def _unlike(expected: Any, got: Any) -> str:
    return f"expected {kind(expected)}, got {kind(got)}"


def kind(value: Any) -> str:
    """Describe a value in a few words, without its numbers."""
    match value:
        case None:
            return "None"
        case str():
            return "a string"
        case dict():
            return f"a dict of {len(value)}"
        case tuple():
            return f"{len(value)} parts"
    array = as_numbers(value)
    if array is None:
        return (
            f"a list of {len(value)}"
            if isinstance(value, list)
            else f"a {type(value).__name__}"
        )
    if array.ndim == 0:
        return {"b": "a truth value", "f": "a number"}.get(
            array.dtype.kind, "a whole number"
        )
    return f"an array of shape {array.shape}"


def call(name: str, arguments: tuple[Any, ...]) -> str:
    """Format a call ``name(...)`` for feedback: small arguments in full, large ones by their shapes."""
    return f"{name}({', '.join(map(_argument, arguments))})"


def row(array: np.ndarray, place: int) -> str:
    """Format one row of an array, with its index."""
    return f"[{place}] = {_argument(array[place])}"


def _argument(value: Any) -> str:
    match value:
        case np.ndarray():
            text = np.array2string(
                value, precision=4, separator=", ", suppress_small=True
            ).replace("\n", "")
        case float() | np.floating():
            text = f"{value:.6g}"
        case _:
            text = str(value)
    text = MINUS_ZERO.sub("", text)
    return text if len(text) <= MOST_SHOWN else kind(value)


def _number(value: Any) -> str:
    return f"{value:z.6g}" if np.asarray(value).dtype.kind == "f" else str(value)
