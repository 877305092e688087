"""NNQL and one-step online Q-learning (sections 4.4.5, 4.5.3): one learner, which trains on many pairs or on one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, Unpack

from robonav.validation import check_integer, check_one_of, check_real

from .agents import Accumulating
from .networks import Networks
from .schedules import Span, check_span
from .targets import RESCALE
from .trainer import ACTIONS, Course
from .training import Common, Training, school


def nnql(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    alpha: Span = (0.8, 0.1),
    gamma: float = 0.6,
    rate: Span = (0.3, 0.05),
    temperature: Span = (0.9, 0.1),
    rescale: str = "shift",
    passes: int = 3,
    tolerance: float = 1e-3,
    **common: Unpack[Common],
) -> Training:
    """Neural-network Q-learning, Algorithm 8: after each step, train on all pairs gathered so far in the episode.

    Parameters
    ----------
    seeds : S, or the seeds themselves.
    episodes : E, each in a new world.
    alpha, gamma : learning rate and discount of Q-learning, Eq. (4.9).
    rate : sigma, the step of gradient descent, Eq. (4.12).
    temperature : T of the Boltzmann policy, Eq. (4.7).
    rescale : how Q comes into [0, 1]: "clip" or "shift".
    passes, tolerance : gradient descent goes through the pairs at most so many times, and until the mean cost settles.
    common : see :class:`Common`.

    ``alpha``, ``rate`` and ``temperature`` may be a number, or a pair: the quantity then falls from the first to the
    second, by the same factor each episode.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds.
    """
    settings = _settings(alpha, gamma, rate, rescale, passes, tolerance)
    make = partial(_accumulating, settings=settings, pairs=None)
    return school(
        "nnql",
        make,
        seeds,
        episodes,
        temperature=temperature,
        settings=settings,
        **common,
    )


def online(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    alpha: Span = 0.8,
    gamma: float = 0.7,
    rate: Span = 0.3,
    temperature: Span = (0.9, 0.1),
    rescale: str = "clip",
    passes: int = 1,
    tolerance: float = 1e-3,
    **common: Unpack[Common],
) -> Training:
    """One-step online neural Q-learning: after each step, train on the pair of this step and forget it.

    Parameters as in :func:`nnql`.
    """
    settings = _settings(alpha, gamma, rate, rescale, passes, tolerance)
    make = partial(_accumulating, settings=settings, pairs=1)
    return school(
        "online",
        make,
        seeds,
        episodes,
        temperature=temperature,
        settings=settings,
        **common,
    )


def _settings(
    alpha: Span, gamma: float, rate: Span, rescale: str, passes: int, tolerance: float
) -> dict[str, Any]:
    return {
        "alpha": check_span("alpha", alpha, at_most=1),
        "gamma": check_real("gamma", gamma, at_least=0, at_most=1),
        "rate": check_span("rate", rate),
        "rescale": check_one_of("rescale", rescale, RESCALE),
        "passes": check_integer("passes", passes, at_least=1),
        "tolerance": check_real("tolerance", tolerance, at_least=0),
    }


def _accumulating(
    networks: Networks,
    seeds: tuple[int, ...],
    course: Course,
    *,
    settings: dict[str, Any],
    pairs: int | None,
) -> Accumulating:
    shape = (len(seeds), course.max_steps, course.encoder.size, ACTIONS)
    return Accumulating(networks, shape, pairs=pairs or course.max_steps, **settings)
