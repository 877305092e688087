"""Gymnasium environments as a network reads them: a vector of numbers a state, actions numbered from 0."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.wrappers import FlattenObservation, TransformObservation

from robonav.mdp.discrete_spaces import discretise_actions


def network_environment(env: gymnasium.Env[Any, Any]) -> gymnasium.Env[Any, int]:
    """Return the environment with observations that a network can read, and with actions numbered 0 to A - 1.

    Observations in a ``Box`` of one dimension stay as they are. Others are flattened as Gymnasium flattens them: a
    ``Discrete`` observation becomes a vector with a single 1, and the parts of a ``Dict`` stand one after the other.
    Numbers with two finite bounds are then scaled into [0, 1]. The functions of this chapter treat their environments
    in this way themselves.

    Parameters
    ----------
    env : gymnasium.Env
        An environment with discrete actions.

    Returns
    -------
    gymnasium.Env

    Raises
    ------
    TypeError
        If ``env`` is not a Gymnasium environment, its actions are not discrete, or its observations have no fixed size.

    Examples
    --------
    >>> import gymnasium
    >>> from robonav.nnql import network_environment
    >>> network_environment(gymnasium.make("FrozenLake-v1")).reset(seed=0)[0]
    array([1., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0.])
    >>> network_environment(gymnasium.make("robonav/Navigation-v0")).observation_space.shape
    (29,)
    """
    env = discretise_actions(env)
    space = env.observation_space
    if isinstance(space, Box) and len(space.shape) == 1:
        return env
    if not space.is_np_flattenable:
        raise TypeError(f"env must have observations of a fixed size, got {space}")
    return scaled(FlattenObservation(env))


def scaled(env: gymnasium.Env[Any, int]) -> gymnasium.Env[Any, int]:
    """Return the environment with the bounded numbers of its flat observations scaled into [0, 1]."""
    space = env.observation_space
    assert isinstance(space, Box)
    low, high = space.low.astype(float), space.high.astype(float)
    bounded = np.isfinite(low) & np.isfinite(high) & (low < high)
    offset = np.where(bounded, low, 0.0)
    span = np.where(bounded, high, 1.0) - offset
    unit = Box(np.where(bounded, 0.0, low), np.where(bounded, 1.0, high), dtype=float)  # type: ignore[arg-type]
    return TransformObservation(env, lambda seen: (seen - offset) / span, unit)
