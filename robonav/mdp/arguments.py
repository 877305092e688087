"""Checks of arguments by their names, so that the functions themselves hold nothing but their algorithm.

The decorator :func:`validated` checks every argument that stands in :data:`RULES` before the function runs.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial, wraps
from typing import Any, ParamSpec, TypeVar

from robonav.validation import (
    check_array,
    check_generator,
    check_instance,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
)

Rule = Callable[[str, Any], Any]
P = ParamSpec("P")
R = TypeVar("R")

COUNT = partial(check_integer, at_least=1)

RULES: dict[str, Rule] = {
    "tolerance": check_positive,
    "episodes": COUNT,
    "max_steps": COUNT,
    "max_iterations": COUNT,
    "max_backups": COUNT,
    "max_rounds": COUNT,
    "count": COUNT,
    "sweeps": partial(check_integer, at_least=0),
    "horizon": partial(check_integer, at_least=0),
    "steps": partial(check_integer, at_least=0),
    "discount": partial(check_real, at_least=0, at_most=1),
    "initial": check_real,
    "seed": check_generator,
    "rewards": partial(check_array, shape=("T",)),
    "visit": partial(check_one_of, choices=("first", "every")),
}
"""What each argument of this name must be; the rule gets the name and the value, and returns the value to use."""


MODEL_ARRAYS = {
    "values": ("n_states",),
    "action_values": ("n_states", "n_actions"),
}
"""Arrays of numbers whose shape follows from the argument ``mdp``."""


def require_type(name: str, kind: type) -> None:
    """Add the rule that every argument of this name has this type."""
    RULES[name] = partial(check_instance, kind=kind)


def validated_with(
    **rules: Rule,
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Check the arguments of a function by :data:`RULES`, or by these rules where given, before it runs."""

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(function)

        @wraps(function)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            bound = signature.bind(*args, **kwargs)
            for name, value in bound.arguments.items():
                rule = rules.get(name) or RULES.get(name)
                if rule is not None:
                    bound.arguments[name] = rule(name, value)
                if name in MODEL_ARRAYS and "mdp" in bound.arguments:
                    mdp = bound.arguments["mdp"]
                    shape = [getattr(mdp, size) for size in MODEL_ARRAYS[name]]
                    bound.arguments[name] = check_array(name, value, shape=shape)
            return function(*bound.args, **bound.kwargs)

        return checked

    return decorate


def validated(function: Callable[P, R]) -> Callable[P, R]:
    """Check the arguments of a function by :data:`RULES` and :data:`MODEL_ARRAYS` before it runs."""
    return validated_with()(function)
