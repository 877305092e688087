"""The rules that the arguments of chapter 4's functions keep, and the decorator that checks them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, ParamSpec, TypeVar

import gymnasium
import numpy as np
from gymnasium.spaces import flatdim

from robonav.documentation import documents
from robonav.networks.multilayer_perceptron import Network
from robonav.validation import (
    Rule,
    check_array,
    check_callable,
    check_instance,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
    checks,
)

from .network_environment import network_environment

P = ParamSpec("P")
R = TypeVar("R")

Schedule = float | tuple[float, float]
"""A number, or a pair: its value in the first episode and in the last."""


def check_schedule(name: str, value: Any, *, at_most: float = np.inf) -> Schedule:
    """A positive number, or a pair of them: start and end."""
    if isinstance(value, tuple | list):
        if len(value) != 2:
            raise ValueError(
                f"{name} must be a number, or its start and end, got {len(value)} numbers"
            )
        start, end = (
            check_real(name, part, above=0, at_most=at_most) for part in value
        )
        return start, end
    return check_real(name, value, above=0, at_most=at_most)


def _temperatures(name: str, value: Any) -> Any:
    temperatures = check_array(name, value)
    if temperatures.size and temperatures.min() <= 0:
        raise ValueError(
            f"{name} must be greater than 0, got {temperatures.min():g}; greedy_policy is its limit at 0"
        )
    return temperatures


def _q_values(name: str, value: Any) -> Any:
    q = check_array(name, value)
    if q.ndim == 0 or q.shape[-1] == 0:
        raise ValueError(
            f"{name} must have one value for each action along its last axis, got shape {q.shape}"
        )
    return q


def _fractions(name: str, value: Any) -> Any:
    fractions = check_array(name, value)
    if fractions.size and not 0 <= fractions.min() <= fractions.max() <= 1:
        raise ValueError(
            f"{name} must lie between 0 and 1, got {fractions.min():g} to {fractions.max():g}"
        )
    return fractions


def _actions(name: str, value: Any) -> Any:
    return check_array(name, value, dtype=np.int64)


def _count(name: str, value: Any) -> int:
    return check_integer(name, value, at_least=1)


def _fraction(name: str, value: Any) -> float:
    return check_real(name, value, at_least=0, at_most=1)


RULES: dict[str, Rule] = {
    "env": lambda _, value: network_environment(value),
    "network": lambda name, value: check_instance(name, value, Network),
    "q": _q_values,
    "episodes": _count,
    "hidden": _count,
    "seed": lambda name, value: check_integer(name, value, at_least=0),
    "learning_rate": lambda name, value: check_schedule(name, value, at_most=1),
    "discount": _fraction,
    "gradient_step": check_schedule,
    "temperature": check_schedule,
    "rescale": lambda name, value: check_one_of(name, value, ("clip", "shift")),
    "passes": _count,
    "tolerance": lambda name, value: check_real(name, value, at_least=0),
    "episodes_per_fit": _count,
    "sweeps": _count,
    "epochs": _count,
    "batch_size": _count,
    "target_update_interval": _count,
    "targets": partial(
        check_callable, call="targets(q_net, target_net, batch, discount)"
    ),
    "dqn.gradient_step": check_positive,
    "softmax_policy.temperature": _temperatures,
    "geometric_schedule.schedule": check_schedule,
    "geometric_schedule.fraction": _fractions,
    "q_targets.action": _actions,
    "q_targets.reward": check_array,
    "q_targets.next_value": check_array,
    "q_targets.learning_rate": _fractions,
}
"""The rule of each argument: by the name of the argument, or by "function.argument"."""


DOCUMENTATION = {
    "env": """gymnasium.Env
    An environment with discrete actions. Its observations, as :func:`network_environment` makes them, are the network's
    inputs.""",
    "network": """Network
    The network to start from, with one output for each action, see :func:`q_network`.""",
    "episodes": """int
    Episodes of training.""",
    "learning_rate": """Schedule
    The thesis's alpha, Eq. (4.9).""",
    "discount": """float
    The thesis's gamma.""",
    "gradient_step": """Schedule
    The thesis's sigma, Eq. (4.12).""",
    "temperature": """Schedule
    T of the softmax policy, Eq. (4.7).""",
    "rescale": """{"shift", "clip"}
    How Q-values are brought into [0, 1].""",
    "seed": """int
    Seed of the environment and of the exploration.""",
}


def check_update(function: str, arguments: dict[str, Any]) -> None:
    """Check that an update has one action, reward and next value for each state, and that the actions exist."""
    if function != "q_targets":
        return
    *states, n_actions = arguments["q"].shape
    for name in ("action", "reward", "next_value", "learning_rate"):
        given = arguments[name].shape
        if given not in ((), tuple(states)):
            raise ValueError(
                f"{name} must be one number, or have shape {tuple(states)} as q without its last axis, got {given}"
            )
    action = arguments["action"]
    if action.size and not 0 <= action.min() <= action.max() < n_actions:
        raise ValueError(
            f"action must lie between 0 and {n_actions - 1}, got {action.min()} to {action.max()}"
        )


def check_together(function: str, arguments: dict[str, Any]) -> None:
    """Check the arguments that depend on each other: an update's arrays, or a learner's network and environment."""
    check_update(function, arguments)
    if function in LEARNERS:
        check_sizes(arguments["network"].sizes, arguments["env"])


def check_sizes(sizes: tuple[int, ...], env: gymnasium.Env[Any, Any]) -> None:
    """Check that a network has one input for each number of a state, and one output for each action."""
    states, actions = flatdim(env.observation_space), flatdim(env.action_space)
    if (sizes[0], sizes[-1]) != (states, actions):
        raise ValueError(
            f"network must take the {states} numbers of a state and give {actions} actions, got sizes {sizes}"
        )


LEARNERS = ("nnql", "online", "nfq", "dqn")
"""Functions whose network is trained in an environment."""

checked_arguments = checks(RULES, check_together)
"""Decorate a function so that its arguments are checked by these rules before it runs."""

documented = documents(
    DOCUMENTATION,
    returns="""Network
    The trained network.""",
    raises="""ValueError, TypeError
    If an argument is out of bounds.""",
)


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Decorate a function of this chapter: it checks its arguments, and its docstring gets the missing sections."""
    return documented(checked_arguments(function))
