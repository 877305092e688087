"""The rules that the arguments of chapter 2's functions keep, and the decorator that checks them."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from functools import partial, wraps
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import (
    Rule,
    check_array,
    check_generator,
    check_instance,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
    checks,
)

from .policies import as_distributions, as_policy

P = ParamSpec("P")
R = TypeVar("R")

count = partial(check_integer, at_least=1)
not_negative = partial(check_integer, at_least=0)
unit_interval = partial(check_real, at_least=0, at_most=1)


def check_sweeps(name: str, value: Any) -> float:
    """A number of sweeps from 1 to infinity."""
    return value if value == math.inf else count(name, value)


def check_belief(name: str, value: Any) -> NDArray[Any]:
    """A distribution (S,)."""
    return as_distributions(name, value, len(check_array(name, value, shape=("S",))))


RULES: dict[str, Rule] = {
    "tolerance": check_positive,
    "episodes": count,
    "max_steps": count,
    "max_iterations": count,
    "max_backups": count,
    "max_rounds": count,
    "count": count,
    "sweeps": not_negative,
    "horizon": not_negative,
    "steps": not_negative,
    "discount": unit_interval,
    "initial": check_real,
    "seed": check_generator,
    "rewards": partial(check_array, shape=("T",)),
    "visit": partial(check_one_of, choices=("first", "every")),
    "entropy.belief": check_belief,
    "epsilon_greedy.q": check_array,
    "epsilon_greedy.epsilon": unit_interval,
    "generalized_policy_iteration.sweeps": check_sweeps,
    "is_optimal.tolerance": partial(check_real, at_least=0),
    "log_likelihood.predicted": check_array,
    "log_likelihood.measured": check_array,
}
"""The rule of each argument: by the name of the argument, or by "function.argument"."""

MODEL_ARRAYS = {
    "values": ("n_states",),
    "action_values": ("n_states", "n_actions"),
}
"""Arrays of numbers whose shape follows from the argument ``mdp``."""

STARTING_VALUES = {
    "policy_evaluation": "guess",
    "iterative_policy_evaluation": "start",
    "backward_induction": "final_values",
    "finite_horizon_evaluation": "final_values",
}
"""Optional arguments with one value a state, by function. The function gets a copy, as its result may be that array."""

CHECKING_METHODS = {
    "action": "as_action",
    "belief": "as_belief",
    "ranges": "as_ranges",
    "successor": "as_belief",
}
"""Arguments of methods, and the method of the same object that checks them and returns them ready to use."""


def require_type(name: str, kind: type) -> None:
    """Add the rule that every argument of this name has this type."""
    RULES[name] = partial(check_instance, kind=kind)


def check_by_model(function: str, arguments: dict[str, Any]) -> None:
    """Check what the model decides: shapes of arrays, beliefs over its states, and which actions there are."""
    if "self" in arguments:
        model = getattr(arguments["self"], "pomdp", arguments["self"])
        for name in CHECKING_METHODS.keys() & arguments.keys():
            arguments[name] = getattr(model, CHECKING_METHODS[name])(arguments[name])
    if function in STARTING_VALUES:
        name, mdp = STARTING_VALUES[function], arguments["mdp"]
        if arguments[name] is not None:
            arguments[name] = check_state_values(name, arguments[name], mdp.n_states)
    if function == "expected_return":
        states = arguments["mdp"].n_states
        arguments["start"] = as_distributions("start", arguments["start"], states)
    if function == "point_based_value_iteration":
        model, beliefs = arguments["pomdp"].mdp, arguments["beliefs"]
        arguments["beliefs"] = beliefs_to_back_up(model, beliefs)
    if "mdp" in arguments:
        for name in MODEL_ARRAYS.keys() & arguments.keys():
            shape = [getattr(arguments["mdp"], size) for size in MODEL_ARRAYS[name]]
            if arguments[name] is not None:
                arguments[name] = check_array(name, arguments[name], shape=shape)


def check_state_values(name: str, given: Any, states: int) -> NDArray[Any]:
    """Check that there is one value for each state, and return a copy of the values."""
    return check_array(name, given, shape=(states,)).copy()


def beliefs_to_back_up(mdp: Any, beliefs: Any) -> NDArray[Any]:
    """Check the beliefs (N, S), and refuse a model without discount: there are no values to start from."""
    if mdp.discount == 1:
        raise ValueError("point_based_value_iteration needs a discount below 1, got 1")
    check_array("beliefs", beliefs, shape=("N", mdp.n_states))
    points = as_distributions("beliefs", beliefs, mdp.n_states)
    if len(points) == 0:
        raise ValueError("beliefs must hold at least one belief, got none")
    return points


checked = checks(RULES, check_by_model)
"""Decorate a function so that its arguments are checked by these rules before it runs."""


def takes_values(method: Callable[..., Any]) -> Callable[..., Any]:
    """Let a method of a model take ``values`` as any array-like of shape (S,), and check them."""

    @wraps(method)
    def checked(self: Any, values: ArrayLike) -> Any:
        """Check the values, then call the method."""
        return method(self, check_array("values", values, shape=(self.n_states,)))

    return checked


def takes_policy(method: Callable[..., R]) -> Callable[[Any, ArrayLike], R]:
    """Let a method of a model take ``policy`` as any array-like of shape (S,) or (S, A), and check it."""

    @wraps(method)
    def checked(self: Any, policy: ArrayLike) -> R:
        """Check the policy, then call the method."""
        return method(self, as_policy(policy, self.n_states, self.n_actions))

    return checked


def refuses_impossible(
    message: str,
) -> Callable[[Callable[P, NDArray[Any]]], Callable[P, NDArray[Any]]]:
    """Decorate an update of a belief, so that it refuses impossible evidence, for which Bayes' rule divides 0 by 0.

    Parameters
    ----------
    message : str
        What the error says; names of arguments in braces stand for their values.

    Returns
    -------
    callable
        The decorator.
    """

    def decorate(update: Callable[P, NDArray[Any]]) -> Callable[P, NDArray[Any]]:
        """Let this update refuse an observation that cannot be."""
        signature = inspect.signature(update)

        @wraps(update)
        def updated(*args: P.args, **kwargs: P.kwargs) -> NDArray[Any]:
            """Update the belief, if the observation is possible."""
            with np.errstate(invalid="ignore"):
                posterior = update(*args, **kwargs)
            if np.isnan(posterior).any():
                arguments = signature.bind(*args, **kwargs).arguments
                raise ValueError(message.format_map(arguments))
            return posterior

        return updated

    return decorate
