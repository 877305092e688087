"""Chapter 4: neural-network Q-learning."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from robonav import expect

from .deep import dqn
from .exploration import boltzmann, choose, falling
from .fitted import nfq
from .neural import nnql, online
from .practice import STARTS, TARGETS, Course
from .rewards import COZY_DISTANCE, Property, reward, state_property
from .targets import clip, cross_entropy, q_targets, shift
from .training import Training, weight_changes

METHODS: dict[str, Callable[..., Training]] = {"nnql": nnql, "online": online, "nfq": nfq, "dqn": dqn}


def train(method: str = "nnql", seeds: int | Sequence[int] = 16, episodes: int = 300, **settings: Any) -> Training:
    """Train S networks by a method of this chapter: ``METHODS[method](seeds, episodes, **settings)``.

    Parameters
    ----------
    method : "nnql", "online", "nfq" or "dqn": see :func:`nnql`, :func:`online`, :func:`nfq`, :func:`dqn`.
    seeds : S, for the seeds 0 to S - 1; or the seeds themselves.
    episodes : E, each in a new world.
    settings : of the method.

    Raises
    ------
    ValueError, TypeError : for another method, or an argument out of bounds.
    """
    return METHODS[expect.one_of("method", method, METHODS)](seeds, episodes, **settings)


__all__ = [
    "COZY_DISTANCE",
    "METHODS",
    "STARTS",
    "TARGETS",
    "Course",
    "Property",
    "Training",
    "boltzmann",
    "choose",
    "clip",
    "cross_entropy",
    "dqn",
    "falling",
    "nfq",
    "nnql",
    "online",
    "q_targets",
    "reward",
    "shift",
    "state_property",
    "train",
    "weight_changes",
]
