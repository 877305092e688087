"""The registry of policies: two baselines, the networks of the package, and files of the reader."""

from __future__ import annotations

import hashlib
import importlib.util
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

from robonav.networks import NetworkPolicy, load_weights
from robonav.robot import (
    OUTCOMES,
    Policy,
    Reflex,
    navigate,
    random_worlds,
    straight,
    turn_to_clearer_side,
)

BASELINES: dict[str, Policy] = {
    "straight": straight,
    "freer-side": turn_to_clearer_side,
}
"""Policies that have learned nothing. Every table compares the learned policies with them."""

DISPLAY_NAMES: dict[str, str] = {
    "freer-side": "freer side",
    "1-neighbour": "1 neighbour",
    "5-neighbours": "5 neighbours",
    "15-neighbours": "15 neighbours",
    "lfd": "cloning",
    "dagger": "DAgger",
    "q-learning": "Q-learning",
    "sarsa": "SARSA",
    "nnql": "NNQL",
    "nnql-same-speed": "NNQL, trained at this speed",
    "nnql-thesis": "NNQL, the thesis's rates",
    "nnql-decaying": "NNQL, decaying rates",
    "nfq": "NFQ",
    "dqn": "DQN",
    "nirl": "NIRL",
    "relative-entropy": "relative entropy",
    "scirl": "SCIRL",
    "zero-reward": "zero reward",
    "random-reward": "random reward",
    "ppo": "PPO",
    "ppo-curriculum": "PPO, in stages",
    "gail": "GAIL",
    "lfd-less-regularised": "cloning, less regularised",
    "potential-field": "potential field",
    "vfh": "VFH",
    "dynamic-window": "dynamic window",
    "known-map": "known map",
    "sectors-9": "9 sectors",
    "sectors-36": "36 sectors",
    "window-1": "the last step",
    "window-8": "the last 8 steps",
    "gru": "GRU",
    "modified-a-star": "modified A*",
    "grid-a-star": "grid A*",
    "kept-policy": "the policy itself",
    "kept-clone": "a cloned policy",
    "learned-reward-there": "trained there under the learned reward",
    "table-reward-there": "trained there under Table 4.1",
    "zero-reward-there": "trained there under no reward",
    "random-reward-there": "trained there under a random reward",
}
"""The names of methods on pages and in figures, where they differ from those in result files and commands."""

CHAPTERS = ("lfd", "nnql", "nirl", "deep")


def methods() -> list[str]:
    """Return the names of all methods: first the baselines, then the networks of the package by chapter.

    Returns
    -------
    list of str
        The names that :func:`method` takes.

    Examples
    --------
    >>> methods()[:4]
    ['straight', 'freer-side', 'dagger', 'lfd']
    """
    return [*BASELINES, *_shipped()]


def method(name: str) -> Policy:
    """The policy of a method.

    Parameters
    ----------
    name : str
        One of :func:`methods`, or a file with weights (.safetensors) or Python code (.py) that defines ``policy``. The
        code runs, so load only your own.

    Returns
    -------
    callable
        ``policy(sensing, rng)`` returns the actions (N,).

    Raises
    ------
    ValueError
        If there is no such method or file, or the file has no policy.

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds
    >>> navigate(method("nnql"), random_worlds(3, 5, seed=0)).outcome
    array(['arrived', 'arrived', 'arrived'], dtype='<U12')
    """
    if name in BASELINES:
        return BASELINES[name]
    path = _shipped().get(name, Path(name))
    is_file_name = path.suffix in (".safetensors", ".py")
    if is_file_name and not path.is_file():
        raise ValueError(f"method must name a file that exists, got {name!r}")
    if not is_file_name:
        known = ", ".join(methods())
        raise ValueError(
            f"method must be one of {known}, or a file that ends in .safetensors or .py, got {name!r}"
        )
    return _from_code(path) if path.suffix == ".py" else _from_weights(path)


def display_name(name: str) -> str:
    """Return the name of a method as pages and figures show it.

    Parameters
    ----------
    name : str
        The name of a method in the results of an experiment.

    Returns
    -------
    str
        The entry of :data:`DISPLAY_NAMES`, or the name itself if it has none.

    Examples
    --------
    >>> display_name("dagger"), display_name("straight")
    ('DAgger', 'straight')
    """
    return DISPLAY_NAMES.get(name, name)


def fingerprint(name: str) -> str:
    """Return the SHA-256 of the file of a method. Results contain it, so that they name one network.

    Parameters
    ----------
    name : str
        As in :func:`method`.

    Returns
    -------
    str
        64 hexadecimal digits; the empty string for a baseline.

    Examples
    --------
    >>> fingerprint("straight"), len(fingerprint("nirl"))
    ('', 64)
    """
    method(name)
    if name in BASELINES:
        return ""
    return hashlib.sha256(_shipped().get(name, Path(name)).read_bytes()).hexdigest()


def evaluate(
    name: str,
    *,
    obstacles: int,
    moving: int,
    speed: float,
    worlds: int,
    seed: int,
    reflex: str = Reflex().direction,
) -> dict[str, Any]:
    """Evaluate a method in new worlds. The command ``robonav navigate`` prints the result.

    Parameters
    ----------
    name : str
        As in :func:`method`.
    obstacles, moving : int
        The numbers of standing and of moving obstacles.
    speed : float
        Metres a second.
    worlds : int
        The number of worlds.
    seed : int
        The seed of the worlds.
    reflex : {"sector", "exact"}
        What the robot's reflex knows of the direction of its target, see :class:`robonav.robot.Reflex`.

    Returns
    -------
    dict
        The arguments; ``success`` and ``collision`` (rates in [0, 1]); ``interval`` (Wilson's 95 % interval of the
        success rate); ``outcomes`` (the number of episodes by outcome); ``mean_steps_of_arrivals`` (None if no episode
        arrived).

    Examples
    --------
    >>> result = evaluate("straight", obstacles=10, moving=0, speed=2.0, worlds=20, seed=7)
    >>> result["outcomes"]
    {'arrived': 7, 'collided': 13, 'out of steps': 0}
    """
    policy = method(name)
    navigation = navigate(
        policy,
        random_worlds(worlds, obstacles, moving, seed=seed),
        speed,
        reflex=Reflex(reflex),
    )
    arrived = navigation.success
    low, high = success_interval(int(arrived.sum()), worlds)
    return {
        "method": name,
        "obstacles": obstacles,
        "moving": moving,
        "speed": speed,
        "worlds": worlds,
        "seed": seed,
        "reflex": reflex,
        "success": float(arrived.mean()),
        "collision": float(navigation.collision.mean()),
        "interval": [low, high],
        "outcomes": {
            outcome: int((navigation.outcome == outcome).sum())
            for outcome in OUTCOMES[1:].tolist()
        },
        "mean_steps_of_arrivals": float(navigation.steps[arrived].mean())
        if arrived.any()
        else None,
    }


def success_interval(arrived: int, worlds: int) -> tuple[float, float]:
    """Return Wilson's 95 % interval of a success rate.

    Parameters
    ----------
    arrived : int
        The number of episodes that arrived.
    worlds : int
        The number of all episodes.

    Returns
    -------
    tuple of two floats
        The bounds, in [0, 1].

    Examples
    --------
    >>> low, high = success_interval(8, 8)
    >>> round(low, 2), high
    (0.68, 1.0)
    """
    from scipy.stats import binomtest

    interval = binomtest(arrived, worlds).proportion_ci(method="wilson")
    return float(interval.low), float(interval.high)


def _shipped() -> dict[str, Path]:
    """Return the files of the package's networks, by method."""
    found: dict[str, Path] = {}
    for chapter in CHAPTERS:
        folder = Path(str(files(f"robonav.{chapter}"))) / "shipped"
        found |= {path.stem: path for path in sorted(folder.glob("*.safetensors"))}
    return found


def _from_weights(path: Path) -> NetworkPolicy:
    weights = load_weights(path)
    return NetworkPolicy(weights.network, weights.encoder, weights.temperature)


def _from_code(path: Path) -> Policy:
    """Run a Python file of the reader and return its object ``policy``."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise ValueError(f"method must be a Python file, got {path}")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ValueError(
            f"{path.name} does not run: {type(error).__name__}: {error}"
        ) from None
    policy: Callable | None = getattr(module, "policy", None)
    if not callable(policy):
        raise ValueError(f"{path.name} must define policy(sensing, rng), but does not")
    return policy
