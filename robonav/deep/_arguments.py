"""The rules that the arguments of PPO keep, and the decorator that checks them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ParamSpec, TypeVar

import gymnasium
import numpy as np
from gymnasium.spaces import flatdim

from robonav.documentation import documents
from robonav.networks.multilayer_perceptron import Network
from robonav.nnql.network_environment import network_environment
from robonav.validation import (
    Rule,
    check_array,
    check_callable,
    check_instance,
    check_integer,
    check_positive,
    check_real,
    checks,
)

from .networks import ActorCritic

P = ParamSpec("P")
R = TypeVar("R")


def _count(name: str, value: Any) -> int:
    return check_integer(name, value, at_least=1)


def _fraction(name: str, value: Any) -> float:
    return check_real(name, value, at_least=0, at_most=1)


def _weight(name: str, value: Any) -> float:
    return check_real(name, value, at_least=0)


def check_environments(name: str, value: Any) -> list[gymnasium.Env[Any, int]]:
    """At least one environment, each as a network reads it."""
    if isinstance(value, gymnasium.Env) or not isinstance(value, Sequence) or not value:
        raise TypeError(
            f"{name} must be a sequence of at least one environment, one for each actor, got {value!r}"
        )
    return [network_environment(env) for env in value]


def check_hidden(name: str, value: Any) -> tuple[int, ...]:
    """The numbers of units of the hidden layers."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        raise TypeError(f"{name} must be a sequence of whole numbers, got {value!r}")
    return tuple(_count(name, units) for units in value)


def check_batches(batches: int, steps: int) -> None:
    """No more minibatches than steps."""
    check_integer("batches", batches, at_most=steps)


def check_together(function: str, arguments: dict[str, Any]) -> None:
    """The networks fit the environments and the pairs, and there are enough steps for the minibatches."""
    if function not in ("ppo", "gail"):
        return
    envs, networks = arguments["envs"], arguments["networks"]
    for env in envs:
        states, actions = flatdim(env.observation_space), flatdim(env.action_space)
        policy, value = networks.policy.sizes, networks.value.sizes
        if (policy[0], policy[-1], value[0], value[-1]) != (states, actions, states, 1):
            raise ValueError(
                f"networks must take the {states} numbers of a state and give {actions} actions and one value, "
                f"got sizes {policy} and {value}"
            )
    check_batches(arguments["batches"], len(envs) * arguments["steps"])
    if function == "gail":
        check_pairs(arguments, networks.policy.sizes[0], networks.policy.sizes[-1])


def check_pairs(arguments: dict[str, Any], states: int, actions: int) -> None:
    """The expert's pairs, and the discriminator that reads them, fit the environments."""
    seen, taken = arguments["states"], arguments["actions"]
    if seen.shape != (len(taken), states) or not len(taken):
        raise ValueError(
            f"states must have a row of {states} numbers for each of the {len(taken)} actions, got shape {seen.shape}"
        )
    if taken.min() < 0 or taken.max() >= actions:
        raise ValueError(
            f"actions must be from 0 to {actions - 1}, got {taken.min()} to {taken.max()}"
        )
    sizes = arguments["discriminator"].sizes
    if (sizes[0], sizes[-1]) != (states + actions, 1):
        raise ValueError(
            f"discriminator must take the {states} numbers of a state and one for each of {actions} actions, "
            f"and give one number, got sizes {sizes}"
        )


RULES: dict[str, Rule] = {
    "env": lambda _, value: network_environment(value),
    "envs": check_environments,
    "networks": lambda name, value: check_instance(name, value, ActorCritic),
    "discriminator": lambda name, value: check_instance(name, value, Network),
    "states": lambda name, value: check_array(name, value, shape=("m", "n")),
    "actions": lambda name, value: check_array(
        name, value, shape=("m",), dtype=np.int64
    ),
    "reward": lambda name, value: check_callable(name, value, "reward(logits)"),
    "hidden": check_hidden,
    "actors": _count,
    "updates": _count,
    "steps": _count,
    "epochs": _count,
    "batches": _count,
    "clip": lambda name, value: check_real(name, value, above=0, below=1),
    "discount": _fraction,
    "trace_decay": _fraction,
    "gradient_step": check_positive,
    "value_weight": _weight,
    "entropy_weight": _weight,
    "seed": lambda name, value: check_integer(name, value, at_least=0),
}
"""The rule of each argument, by its name."""

DOCUMENTATION = {
    "envs": """sequence of gymnasium.Env
    N environments with discrete actions, one for each actor. Their observations, as
    :func:`robonav.nnql.network_environment` makes them, are the networks' inputs.""",
    "networks": """ActorCritic
    The networks to start from, see :func:`actor_critic`.""",
    "discriminator": """Network
    The discriminator to start from, see :func:`random_discriminator`.""",
    "states": """(m, n) array
    What the expert saw, in the numbers that the networks read.""",
    "actions": """(m,) array of int
    What the expert did there.""",
    "reward": """callable
    Turns the discriminator's logits into the rewards of PPO.""",
    "updates": """int
    How often the actors act, and the networks learn from it.""",
    "steps": """int
    T, steps of each actor before an update.""",
    "epochs": """int
    K, how often an update goes through the N T steps.""",
    "batches": """int
    Parts into which an epoch divides the steps. Each is a minibatch, for one step of Adam.""",
    "clip": """float
    epsilon of Eq. (7).""",
    "discount": """float
    gamma of Eqs. (11) and (12).""",
    "trace_decay": """float
    lambda of Eq. (11).""",
    "gradient_step": """float
    Step of Adam.""",
    "value_weight": """float
    c_1 of Eq. (9), the weight of the error of the value function.""",
    "entropy_weight": """float
    c_2 of Eq. (9), the weight of the entropy.""",
    "seed": """int
    Seed of the environments, of the actions and of the minibatches.""",
}

checked_arguments = checks(RULES, check_together)
"""Decorate a function so that its arguments are checked by these rules before it runs."""

documented = documents(
    DOCUMENTATION,
    returns="""ActorCritic
    The trained networks.""",
    raises="""ValueError, TypeError
    If an argument is out of bounds.""",
)


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Decorate a function: its arguments are checked, and its docstring gets what it leaves out."""
    return documented(checked_arguments(function))
