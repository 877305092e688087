"""The rules that the arguments of chapter 5's functions keep, and the decorator that checks them."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.mdp import policies
from robonav.validation import (
    Rule,
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
    checks,
)

from .decisions import Decisions


def unit_interval(name: str, value: Any) -> float:
    """A number from 0 to 1."""
    return check_real(name, value, at_least=0, at_most=1)


def not_negative(name: str, value: Any) -> float:
    """A number of at least 0."""
    return check_real(name, value, at_least=0)


def count(name: str, value: Any) -> int:
    """A whole number of at least 1."""
    return check_integer(name, value, at_least=1)


def learning_task(name: str, value: Any) -> Any:
    """A task on which a policy makes episodes, see :class:`robonav.nirl.Task`."""
    needed = ("n_inputs", "n_actions", "rollout", "greedy")
    if isinstance(value, type) or not all(hasattr(value, part) for part in needed):
        raise TypeError(
            f"{name} must be a task such as RobotTask() or TabularTask(mdp), got {type(value).__name__}"
        )
    return value


def improver(name: str, value: Any) -> Any:
    """What improves a network, see ``Improver``."""
    if isinstance(value, type) or not hasattr(value, "improve"):
        raise TypeError(
            f"{name} must have a method improve, as ReplaySGD() has, got {value!r}"
        )
    return value


def function(name: str, value: Any) -> Any:
    """A callable."""
    if not callable(value):
        raise TypeError(f"{name} must be callable, got {type(value).__name__}")
    return value


def slack_of_features(name: str, value: Any) -> Any:
    """Numbers of at least 0."""
    slack = check_array(name, value)
    if (slack < 0).any():
        raise ValueError(f"{name} must be at least 0, got {slack.min():g}")
    return slack


RULES: dict[str, Rule] = {
    "bound": check_positive,
    "demonstrations": lambda name, value: check_instance(name, value, Decisions),
    "discount": unit_interval,
    "estimate": function,
    "apprenticeship.expectations": function,
    "gradient_step": check_positive,
    "guess": function,
    "hidden": count,
    "horizon": count,
    "improver": improver,
    "inverse_temperature": not_negative,
    "iterations": count,
    "max_iterations": count,
    "n_actions": count,
    "n_demonstrations": count,
    "n_pairs": count,
    "n_rewards": count,
    "n_samples": count,
    "power": not_negative,
    "regularisation": not_negative,
    "reward_update": function,
    "sarsa_targets.learning_rate": unit_interval,
    "score": function,
    "slack": slack_of_features,
    "task": learning_task,
    "temperature": check_positive,
    "lstd_mu.regularisation": check_positive,
    "maximum_causal_entropy.tolerance": check_positive,
    "apprenticeship_learning.tolerance": not_negative,
    "soft_value_iteration.tolerance": check_positive,
}
"""The rule of each argument: by the name of the argument, or by "function.argument"."""

SHAPES: dict[str, dict[str, str]] = {
    "action_block": {"state_features": "M k", "actions": "M:int"},
    "state_action_features": {"state_features": "M k", "actions": "M:int"},
    "all_action_features": {"state_features": "M k"},
    "boltzmann_policy": {"action_values": ""},
    "discounted_feature_sums": {"features": "M K", "trajectory": "M:int"},
    "empirical_expectations": {"features": "M K", "trajectory": "M:int"},
    "mean_by_pair": {"feature_sums": "M K", "pair": "M:int"},
    "maximum_margin": {"expert": "K", "others": "n K"},
    "maximum_margin_subgradient": {"expert": "K", "others": "n K"},
    "nearest_mixture": {"expert": "K", "found": "n K"},
    "apprenticeship_learning": {"expert": "K"},
    "importance_weights": {"weights": "K", "samples": "N K", "log_ratios": "N"},
    "dual": {"weights": "K", "expert": "K", "samples": "N K", "log_ratios": "N"},
    "dual_gradient": {
        "weights": "K",
        "expert": "K",
        "samples": "N K",
        "log_ratios": "N",
    },
    "hoeffding_slack": {"samples": "N K"},
    "relative_entropy_weights": {"expert": "K", "samples": "N K", "log_ratios": "N"},
    "sarsa_targets": {"q": "", "rewards": "", "next_q": ""},
    "lstd_mu": {"basis": "M n", "next_basis": "M n", "features": "M K"},
    "heuristic_mu": {"expectations": "M K", "actions": "M:int"},
    "structured_classification": {
        "expectations": "M A K",
        "actions": "M:int",
        "step_weights": "M",
    },
    "accuracy": {"predicted": "M:int", "actions": "M:int"},
    "balanced_accuracy": {"predicted": "M:int", "actions": "M:int"},
    "most_frequent": {"actions": "M:int"},
    "map_uniform_prior": {"actions": "M:int"},
    "maximum_causal_entropy": {"expert": "K"},
    "causal_entropy_ascent": {"expert": "K"},
    "soft_maximum": {"q": ""},
    "with_reward": {"weights": "K"},
}
"""Dimensions of arrays, by function and argument: equal letters are equal lengths, ``:int`` means whole numbers."""

NOT_EMPTY = {
    "balanced_accuracy": ("actions", "at least one decision"),
    "accuracy": ("actions", "at least one decision"),
    "empirical_expectations": ("features", "at least one trajectory"),
    "importance_weights": ("samples", "at least one trajectory"),
    "dual": ("samples", "at least one trajectory"),
    "dual_gradient": ("samples", "at least one trajectory"),
    "relative_entropy_weights": ("samples", "at least one trajectory"),
    "lstd_mu": ("basis", "at least one step"),
    "structured_classification": ("expectations", "at least one step"),
    "most_frequent": ("actions", "at least one step"),
    "map_uniform_prior": ("actions", "at least one step"),
    "maximum_margin": (
        "others",
        "the feature expectations of at least one policy",
    ),
    "maximum_margin_subgradient": (
        "others",
        "the feature expectations of at least one policy",
    ),
}
"""Arrays that must hold something, and what."""


TAKES_PROBABILITIES = {
    "feature_expectations",
    "initial_expectations",
    "occupancy_measure",
}
"""Functions whose ``policy`` may be actions (S,) or probabilities (S, A), and whose bodies have probabilities."""


def check_together(function: str, arguments: dict[str, Any]) -> None:
    """Check the shapes of the arrays, and the actions against their number."""
    sizes: dict[str, int] = {}
    for name, spec in SHAPES.get(function, {}).items():
        if arguments[name] is None:
            continue
        letters, _, kind = spec.partition(":")
        shape = [sizes.get(letter, letter) for letter in letters.split()]
        array = check_array(
            name,
            arguments[name],
            shape=shape or None,
            dtype=np.int64 if kind else float,
        )
        sizes.update(zip(letters.split(), array.shape, strict=bool(shape)))
        arguments[name] = array
    if function == "apprenticeship_learning":
        policy, mu = arguments["first"]
        shape = arguments["expert"].shape
        arguments["first"] = policy, check_array("first[1]", mu, shape=shape)
    if function in TAKES_PROBABILITIES:
        mdp = arguments["mdp"]
        arguments["policy"] = policies.probabilities(
            arguments["policy"], mdp.n_states, mdp.n_actions
        )
    if function in NOT_EMPTY:
        name, what = NOT_EMPTY[function]
        if len(arguments[name]) == 0:
            raise ValueError(f"{name} must hold {what}, got none")
    if function == "sarsa_targets":
        check_same_shape(
            "q", arguments["q"], **{k: arguments[k] for k in ("rewards", "next_q")}
        )
    actions = arguments.get("actions")
    limit = arguments.get("n_actions", sizes.get("A"))
    if limit is not None and isinstance(actions, np.ndarray):
        check_actions(actions, limit)
    if function in ("most_frequent", "map_uniform_prior"):
        check_states(arguments["states"], len(arguments["actions"]))
    if "trajectory" in arguments:
        check_trajectory(arguments["trajectory"])
    if "task" in arguments and "demonstrations" in arguments:
        check_demonstrations(arguments["demonstrations"], arguments["task"].n_actions)


def check_same_shape(name: str, array: np.ndarray, **others: np.ndarray) -> None:
    """Arrays of one shape, such as one number for each decision."""
    for other, given in others.items():
        if given.shape != array.shape:
            raise ValueError(
                f"{other} must have the shape {array.shape} of {name}, got {given.shape}"
            )


def check_actions(actions: np.ndarray, n_actions: int) -> None:
    """Actions of which each exists."""
    if len(actions) and not 0 <= actions.min() <= actions.max() < n_actions:
        raise ValueError(
            f"actions must lie between 0 and {n_actions - 1}, got {actions.min()} to {actions.max()}"
        )


def check_states(states: Any, n_actions: int) -> None:
    """One state for each action taken."""
    if len(np.asarray(states)) != n_actions:
        raise ValueError(
            f"states must have one row for each of the {n_actions} actions, got {len(np.asarray(states))}"
        )


def check_trajectory(trajectory: np.ndarray) -> None:
    """Steps of which those of one trajectory stand together."""
    changes = np.count_nonzero(np.diff(trajectory))
    if len(trajectory) and changes + 1 != len(np.unique(trajectory)):
        raise ValueError("trajectory must keep the steps of one trajectory together")


def check_demonstrations(demonstrations: Any, n_actions: int) -> None:
    """Demonstrations with at least one decision, and with actions that the task knows."""
    if len(demonstrations) == 0:
        raise ValueError(
            "demonstrations must hold at least one decision of the expert, got none"
        )
    check_actions(demonstrations.actions, n_actions)


checked = checks(RULES, check_together)
"""Decorate a function so that its arguments are checked by these rules before it runs."""
