"""Chapter 4: neural-network Q-learning."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from robonav.validation import check_one_of

from .dqn import dqn
from .nfq import nfq
from .nnql import nnql, online
from .reward import COZY_DISTANCE, Property, reward, state_property
from .schedules import geometric_schedule, softmax_policy
from .targets import clip, cross_entropy, q_targets, shift
from .trainer import STARTS, TARGETS, NavigationTask
from .training import TrainingResult, weight_changes

METHODS: dict[str, Callable[..., TrainingResult]] = {
    "nnql": nnql,
    "online": online,
    "nfq": nfq,
    "dqn": dqn,
}


def train(
    method: str = "nnql",
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    **settings: Any,
) -> TrainingResult:
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
    return METHODS[check_one_of("method", method, METHODS)](seeds, episodes, **settings)


__all__ = [
    "COZY_DISTANCE",
    "METHODS",
    "STARTS",
    "TARGETS",
    "NavigationTask",
    "Property",
    "Training",
    "clip",
    "cross_entropy",
    "dqn",
    "geometric_schedule",
    "nfq",
    "nnql",
    "online",
    "q_targets",
    "reward",
    "shift",
    "softmax_policy",
    "state_property",
    "train",
    "weight_changes",
]
