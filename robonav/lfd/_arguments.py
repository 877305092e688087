"""The rules that the arguments of chapter 3's functions keep, and the decorator that checks them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from robonav.robot import Encoder, Worlds
from robonav.validation import (
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


checked = checks(
    {
        "demonstrations": partial(check_instance, kind=Demonstrations),
        "encoder": partial(check_instance, kind=Encoder),
        "expert": partial(check_callable, call="expert(simulator, robots)"),
        "hidden": partial(check_integer, at_least=1),
        "max_steps": partial(check_integer, at_least=1),
        "policy": partial(check_callable, call="policy(sensing, rng)"),
        "rounds": check_rounds,
        "temperature": partial(check_real, at_least=0),
    }
)
"""Decorate a function of these arguments so that they are checked before it runs."""
