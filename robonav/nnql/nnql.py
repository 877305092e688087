"""NNQL and one-step online Q-learning (sections 4.4.5, 4.5.3): one agent, which trains on many pairs or on one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, Unpack

from robonav.validation import check_integer, check_one_of, check_real

from .agents import NNQLAgent
from .networks import Networks
from .schedules import Schedule, check_schedule
from .targets import RESCALE
from .trainer import ACTIONS, NavigationTask
from .training import Common, TrainingResult, run_training


def nnql(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    learning_rate: Schedule = (0.8, 0.1),
    discount: float = 0.6,
    gradient_step: Schedule = (0.3, 0.05),
    temperature: Schedule = (0.9, 0.1),
    rescale: str = "shift",
    passes: int = 3,
    tolerance: float = 1e-3,
    **common: Unpack[Common],
) -> TrainingResult:
    """Neural-network Q-learning, Algorithm 8: after each step, train on all pairs gathered so far in the episode.

    Parameters
    ----------
    seeds : S, or the seeds themselves.
    episodes : E, each in a new world.
    learning_rate, discount : learning rate and discount of Q-learning, Eq. (4.9).
    gradient_step : sigma, the step of gradient descent, Eq. (4.12).
    temperature : T of the Boltzmann policy, Eq. (4.7).
    rescale : how Q comes into [0, 1]: "clip" or "shift".
    passes, tolerance : gradient descent goes through the pairs at most so many times, and until the mean cost settles.
    common : see :class:`Common`.

    ``learning_rate``, ``gradient_step`` and ``temperature`` may be a number, or a pair: the quantity then falls from
    the first to the second, by the same factor each episode.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds.
    """
    settings = _settings(
        learning_rate, discount, gradient_step, rescale, passes, tolerance
    )
    make = partial(_accumulating, settings=settings, pairs=None)
    return run_training(
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
    learning_rate: Schedule = 0.8,
    discount: float = 0.7,
    gradient_step: Schedule = 0.3,
    temperature: Schedule = (0.9, 0.1),
    rescale: str = "clip",
    passes: int = 1,
    tolerance: float = 1e-3,
    **common: Unpack[Common],
) -> TrainingResult:
    """One-step online neural Q-learning: after each step, train on the pair of this step and forget it.

    Parameters as in :func:`nnql`.
    """
    settings = _settings(
        learning_rate, discount, gradient_step, rescale, passes, tolerance
    )
    make = partial(_accumulating, settings=settings, pairs=1)
    return run_training(
        "online",
        make,
        seeds,
        episodes,
        temperature=temperature,
        settings=settings,
        **common,
    )


def _settings(
    learning_rate: Schedule,
    discount: float,
    gradient_step: Schedule,
    rescale: str,
    passes: int,
    tolerance: float,
) -> dict[str, Any]:
    return {
        "learning_rate": check_schedule("learning_rate", learning_rate, at_most=1),
        "discount": check_real("discount", discount, at_least=0, at_most=1),
        "gradient_step": check_schedule("gradient_step", gradient_step),
        "rescale": check_one_of("rescale", rescale, RESCALE),
        "passes": check_integer("passes", passes, at_least=1),
        "tolerance": check_real("tolerance", tolerance, at_least=0),
    }


def _accumulating(
    networks: Networks,
    seeds: tuple[int, ...],
    task: NavigationTask,
    *,
    settings: dict[str, Any],
    pairs: int | None,
) -> NNQLAgent:
    shape = (len(seeds), task.max_steps, task.encoder.size, ACTIONS)
    return NNQLAgent(networks, shape, pairs=pairs or task.max_steps, **settings)
