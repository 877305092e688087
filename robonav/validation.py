"""Checks of arguments. A failed check raises an error with one clear sentence.

The sentence names the argument, the expectation and the value. A check that passes returns the value, ready to use.
The decorators that :func:`checks` makes keep the checks out of the bodies of the functions.
"""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Integral, Real
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

P = ParamSpec("P")
R = TypeVar("R")

ArrayArgument = Any
"""The type of an argument of which :func:`checks` makes an array: callers may pass a list, and the body has the array.
The types of NumPy say one or the other, not both."""

Rule = Callable[[str, Any], Any]
"""The check of one argument: takes its name and its value, and returns the value to use."""

Rules = Mapping[str, Rule]
"""Rules by the name of the argument, or by "function.argument" where one function needs another rule."""


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
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(
            f"{name} must be an array without a mask, got a masked array: fill it first"
        )
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


def check_callable(name: str, value: Any, call: str) -> Any:
    """Return ``value`` if it can be called. ``call`` says how, such as "policy(sensing, rng)"."""
    if not callable(value):
        raise TypeError(
            f"{name} must be callable as {call}, got {type(value).__name__}"
        )
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


def check_argument(rules: Rules, function: str, name: str, value: Any) -> Any:
    """Return the value of one argument of a function after the check that its rule makes, if it has a rule.

    Examples
    --------
    >>> check_argument({"episodes": check_integer}, "q_learning", "episodes", 1.5)
    Traceback (most recent call last):
    TypeError: episodes must be a whole number, got 1.5
    """
    rule = rules.get(f"{function}.{name}") or rules.get(name)
    return value if rule is None else rule(name, value)


def checks(
    rules: Rules, together: Callable[[str, dict[str, Any]], None] | None = None
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that checks the arguments of a function before the function runs.

    An argument without a rule is not checked, and neither is an optional argument that is left at None.

    Parameters
    ----------
    rules : mapping of str to callable
        The rule of each argument, by the argument's name, or by "function.argument".
    together : callable, optional
        A function of the name of the function and all its arguments, a dictionary. It checks those that depend on
        each other, and may replace their values. It runs after the rules.

    Returns
    -------
    callable
        The decorator.

    Examples
    --------
    >>> @checks({"discount": lambda name, value: check_real(name, value, at_most=1)})
    ... def effective_horizon(discount):
    ...     return 1 / (1 - discount)
    >>> effective_horizon(0.5)
    2.0
    >>> effective_horizon(1.5)
    Traceback (most recent call last):
    ValueError: discount must be at most 1, got 1.5
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        """Check the arguments of this function."""
        signature = inspect.signature(function)
        optional = {
            name
            for name, parameter in signature.parameters.items()
            if parameter.default is None
        }

        @functools.wraps(function)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            """Check the arguments, then call the function."""
            bound = signature.bind(*args, **kwargs)
            bound.apply_defaults()
            arguments = bound.arguments
            for name, value in arguments.items():
                if value is not None or name not in optional:
                    arguments[name] = check_argument(
                        rules, function.__name__, name, value
                    )
            if together is not None:
                together(function.__name__, arguments)
            return function(*bound.args, **bound.kwargs)

        return checked

    return decorate
