"""The conditions of section 5.6, which all experiments of chapter 5 share. They are in ``settings.toml``.

A run is one seed: demonstrations of its own, a network trained from them, and new worlds in which it is tested. The
worlds of demonstrations, for tuning and for tests are all different. The worlds of a training are drawn from its seed.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.benchmark import BASELINES
from robonav.lfd import (
    Demonstrations,
    demonstrate,
    demonstrate_by_hand,
    learn_policy,
    sketch,
)
from robonav.lfd.demonstrations import LEARNED
from robonav.networks import NetworkPolicy
from robonav.nirl import (
    NEUTRAL_TERMINAL_VALUES,
    SURVIVAL_BONUS,
    IRLResult,
    ReplaySGD,
    RobotTask,
    SubgradientMaxMargin,
    from_all_states,
    from_initial_state,
    heuristic_estimate,
    learn,
    learn_under_reward,
    lstd_estimate,
)
from robonav.robot import (
    NNQL_SENSORS,
    Encoder,
    Policy,
    Reflex,
    random_worlds,
)

from ..runner.settings import Settings, read_settings
from ..runner.setup import Setup

FOLDER = Path(__file__).parent
CONDITIONS = read_settings(FOLDER / "settings.toml")
SETUP = Setup(**CONDITIONS["test"])
DEMONSTRATIONS: int = CONDITIONS["demonstrations"]
ITERATIONS: int = CONDITIONS["iterations"]
EPISODES_PER_ITERATION: int = CONDITIONS["episodes_per_iteration"]
SHORTENED: Mapping[str, float] = CONDITIONS["shortened"]
DEMONSTRATION_SEED: int = CONDITIONS["demonstration_seed"]
DISCOUNT, OTHER_DISCOUNT = CONDITIONS["discounts"]
DEFAULTS = Settings.of(CONDITIONS["defaults"])
"""The default settings of :func:`robonav.nirl.nirl`, with which the book's page on NIRL trains."""
THESIS = {name: Settings.of(values) for name, values in CONDITIONS["thesis"].items()}
METHODS = tuple(THESIS)
LEARNERS = METHODS[:4]
CONTROLS = ("zero-reward", "random-reward")

HYPERPARAMETERS = FOLDER / "hyperparameters.toml"
"""The hyperparameters of Table 5.2, as :mod:`robonav.experiments.chapter5.tuning` wrote them."""

TERMINAL_VALUES = {"bonus": SURVIVAL_BONUS, "neutral": NEUTRAL_TERMINAL_VALUES}
EXPECTATIONS = {"all states": from_all_states, "initial state": from_initial_state}
ESTIMATES = {"lstd": lstd_estimate, "heuristic": heuristic_estimate}


@lru_cache(maxsize=1)
def _hyperparameters() -> dict[str, Any]:
    return read_settings(HYPERPARAMETERS)


def tuned(method: str, discount: float = DISCOUNT, **changes: Any) -> Settings:
    """Return the tuned hyperparameters of a method for one of two discounts. A control has those of NIRL.

    Cloning has no discount: its entry is the better of two sets of trials.

    Parameters
    ----------
    method : str
        The method, or a control.
    discount : float
        0.65 or 0.9.
    **changes
        Hyperparameters that replace the tuned ones.

    Returns
    -------
    Settings

    Examples
    --------
    >>> from robonav.experiments.chapter5.setup import tuned
    >>> tuned("nirl", hidden=3)["hidden"]
    3
    """
    found = _hyperparameters()[method if method in METHODS else "nirl"]
    return Settings.of(found if method == "lfd" else found[str(discount)]) | changes


@lru_cache(maxsize=256)
def demonstrations(
    seed: int,
    number: int = DEMONSTRATIONS,
    expert: str = "computer",
    *,
    reflex: Reflex = SETUP.reflex,
) -> Demonstrations:
    """Return the demonstrations of a run by an expert, "computer" or "human", each in a map of its own."""
    worlds = random_worlds(number, SETUP.obstacles, seed=DEMONSTRATION_SEED + seed)
    if expert == "human":
        drawn = sketch(worlds, seed=seed)
        return demonstrate_by_hand(worlds, drawn, speed=SETUP.speed, reflex=reflex)
    return demonstrate(worlds, speed=SETUP.speed, reflex=reflex)


def encoder(target: str, sensors: tuple[int, ...] = NNQL_SENSORS) -> Encoder:
    """Return phi(s) of section 5.4.1, with one of the encodings of the target's sector."""
    return Encoder(sensors, walls=True, target=target)


def task(target: str = "sine-cosine", **changes: Any) -> RobotTask:
    """Return the training task: 20 obstacles, 2 m/s, ten episodes in each iteration."""
    usual: dict[str, Any] = {"encoder": encoder(target), "reflex": SETUP.reflex}
    return RobotTask(EPISODES_PER_ITERATION, **(usual | changes))


def policy_improvement(settings: Settings) -> ReplaySGD:
    """Return the policy improvement that all methods share."""
    return ReplaySGD(
        discount=settings["discount"],
        gradient_step=settings["gradient_step"],
        n_samples=settings["n_samples"],
        replay=settings["replay"],
        terminal_values=TERMINAL_VALUES[settings.get("terminal_values", "bonus")],
    )


def own_options(method: str, settings: Settings, iterations: int) -> dict[str, Any]:
    """Return the arguments that only this method has."""
    if method == "nirl":
        return {"reward_update": SubgradientMaxMargin(power=settings["power"])}
    if method == "apprenticeship":
        return {
            "expectations": EXPECTATIONS[settings["expectations"]],
            "n_rewards": min(settings["n_rewards"], iterations),
        }
    if method == "relative-entropy":
        return {"horizon": settings["horizon"], "slack": settings["slack"]}
    return {
        "estimate": ESTIMATES[settings["estimate"]],
        "power": settings["power"],
        "regularisation": settings["regularisation"],
    }


def train_irl(
    method: str,
    trajectories: Demonstrations,
    seed: int,
    settings: Settings,
    *,
    length: float = 1.0,
    **changes: Any,
) -> IRLResult:
    """Train a method of inverse reinforcement learning, or a control under a reward that is not learned.

    Parameters
    ----------
    method : str
        A method of :func:`robonav.nirl.learn`, or one of :data:`CONTROLS`.
    trajectories : Demonstrations
        The demonstrations of the expert.
    seed : int
        The seed of weights and training.
    settings : Settings
        Hyperparameters.
    length : float
        The number of iterations relative to the usual number.
    **changes
        Other arguments of the method; they replace the usual ones.
    """
    iterations = round(ITERATIONS * length)
    common: dict[str, Any] = {
        "task": task(settings["target"]),
        "improver": policy_improvement(settings),
        "iterations": iterations,
        "inverse_temperature": settings["inverse_temperature"],
        "hidden": settings["hidden"],
    }
    if method in CONTROLS:
        weights = control_reward(method, seed, common["task"].n_inputs)
        return learn_under_reward(trajectories, weights, seed=seed, **common)
    own = own_options(method, settings, iterations)
    return learn(trajectories, method, seed, **(own | common | changes))


def control_reward(name: str, seed: int, inputs: int) -> NDArray[np.float64]:
    """Return the reward weights (5, k + 1) of a control: zero, or random."""
    shape = (LEARNED, inputs + 1)
    if name == "zero-reward":
        return np.zeros(shape)
    return np.random.default_rng([seed, 5]).normal(size=shape)


def trained(
    method: str,
    seed: int,
    settings: Settings,
    number: int = DEMONSTRATIONS,
    expert: str = "computer",
    *,
    length: float = 1.0,
) -> IRLResult:
    """Return one run of a method or control. Runs are kept in memory, because several tables test the same policies."""
    return _trained(method, seed, settings, number, expert, length)


@lru_cache(maxsize=300)
def _trained(
    method: str, seed: int, settings: Settings, number: int, expert: str, length: float
) -> IRLResult:
    trajectories = demonstrations(seed, number, expert)
    return train_irl(method, trajectories, seed, settings, length=length)


@lru_cache(maxsize=300)
def cloned_policy(
    seed: int,
    settings: Settings,
    number: int = DEMONSTRATIONS,
    expert: str = "computer",
    *,
    inputs: Encoder | None = None,
) -> NetworkPolicy:
    """Return the policy of behaviour cloning from the same demonstrations, as in chapter 3."""
    return learn_policy(
        demonstrations(seed, number, expert),
        settings["hidden"],
        settings["regularisation"],
        settings["iterations"],
        seed,
        encoder=inputs or encoder(settings["target"]),
    )


def trained_policy(
    method: str,
    seed: int,
    settings: Settings | None = None,
    number: int = DEMONSTRATIONS,
    expert: str = "computer",
    *,
    length: float = 1.0,
) -> Policy:
    """Return a baseline, or the policy of one run of a method, a control or cloning."""
    if method in BASELINES:
        return BASELINES[method]
    settings = tuned(method) if settings is None else settings
    if method == "lfd":
        return cloned_policy(seed, settings, number, expert)
    return trained(method, seed, settings, number, expert, length=length).policy
