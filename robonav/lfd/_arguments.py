"""The rules that the arguments of chapter 3's functions keep, and the decorator that checks them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from robonav.robot import Encoder, Worlds
from robonav.validation import (
    check_array,
    check_callable,
    check_instance,
    check_integer,
    check_real,
    checks,
)

from .demonstrations import Demonstrations


def check_rounds(name: str, rounds: Sequence[Worlds]) -> Sequence[Worlds]:
    """Check that each round of DAgger has a batch of worlds, and return the batches."""
    for number, worlds in enumerate(check_instance(name, rounds, Sequence)):
        check_instance(f"{name}[{number}]", worlds, Worlds)
    return rounds


def check_seeds(name: str, seed: Any, rounds: int) -> Any:
    """Return a seed as a whole number, or the seeds of round 0 and all later rounds as an array (rounds + 1, 2)."""
    if np.ndim(seed) == 0:
        return check_integer(name, seed, at_least=0)
    seeds = check_array(name, seed, shape=(rounds + 1, 2), dtype=np.int64)
    if seeds.min() < 0:
        raise ValueError(f"{name} must hold numbers from 0 on, got {seeds.min()}")
    return seeds


def check_together(function: str, arguments: dict[str, Any]) -> None:
    """Check the seeds of DAgger's rounds, whose shape follows from the number of rounds."""
    if function in ("dagger", "round_seeds"):
        rounds = arguments["rounds"]
        number = rounds if function == "round_seeds" else len(rounds)
        arguments["seed"] = check_seeds("seed", arguments["seed"], number)


checked = checks(
    {
        "beta_decay": partial(check_real, at_least=0, at_most=1),
        "demonstrations": partial(check_instance, kind=Demonstrations),
        "encoder": partial(check_instance, kind=Encoder),
        "expert": partial(check_callable, call="expert(simulator, robots)"),
        "hidden": partial(check_integer, at_least=1),
        "max_steps": partial(check_integer, at_least=1),
        "policy": partial(check_callable, call="policy(sensing, rng)"),
        "dagger.rounds": check_rounds,
        "temperature": partial(check_real, at_least=0),
    },
    check_together,
)
"""Decorate a function of these arguments so that they are checked before it runs."""
