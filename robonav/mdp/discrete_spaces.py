"""Discrete spaces of Gymnasium environments, numbered from 0."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.wrappers import TransformAction, TransformObservation


def space_size(name: str, space: gym.Space[Any]) -> int:
    """Number of elements of a discrete space: Discrete, MultiDiscrete or a tuple of them; TypeError otherwise.

    Examples
    --------
    >>> space_size("space", spaces.MultiDiscrete([3, 4]))
    12
    """
    if isinstance(space, spaces.Discrete):
        return int(space.n)
    if isinstance(space, spaces.MultiDiscrete):
        return int(np.prod(space.nvec))
    if isinstance(space, spaces.Tuple):
        return int(np.prod([space_size(name, part) for part in space]))
    raise TypeError(
        f"{name} must be discrete (Discrete, MultiDiscrete or a tuple of Discrete), got {space}"
    )


def number(space: gym.Space[Any], element: Any) -> int:
    """Number of an element of a discrete space, 0 for the first; several parts count like the digits of a number.

    Examples
    --------
    >>> number(spaces.MultiDiscrete([3, 4]), np.array([1, 2]))
    6
    """
    if isinstance(space, spaces.Discrete):
        return int(element) - int(space.start)
    if isinstance(space, spaces.MultiDiscrete):
        return int(
            np.ravel_multi_index(
                tuple(np.ravel(element - space.start)), tuple(np.ravel(space.nvec))
            )
        )
    place = 0
    for part, piece in zip(space, element, strict=True):  # type: ignore[call-overload]
        place = place * space_size("part", part) + number(part, piece)
    return place


def element(space: gym.Space[Any], place: int) -> Any:
    """Element of a discrete space with this number: the inverse of :func:`number`.

    Examples
    --------
    >>> element(spaces.MultiDiscrete([3, 4]), 6)
    array([1, 2])
    """
    if isinstance(space, spaces.Discrete):
        return place + int(space.start)
    if isinstance(space, spaces.MultiDiscrete):
        return (
            np.reshape(
                np.unravel_index(place, tuple(np.ravel(space.nvec))), space.nvec.shape
            )
            + space.start
        )
    pieces = []
    for part in reversed(space.spaces):  # type: ignore[attr-defined]
        place, digit = divmod(place, space_size("part", part))
        pieces.append(element(part, digit))
    return tuple(reversed(pieces))


def discretise_spaces(env: gym.Env[Any, Any]) -> gym.Env[int, int]:
    """Return the environment with states numbered 0 to S - 1 and actions numbered 0 to A - 1.

    FrozenLake, Taxi and CliffWalking are returned unchanged; Blackjack, whose state is a tuple, is wrapped.

    Raises
    ------
    TypeError
        If ``env`` is not a Gymnasium environment, or its spaces are not discrete.

    Examples
    --------
    >>> env = discretise_spaces(gym.make("Blackjack-v1"))
    >>> space_sizes(env), env.reset(seed=0)[0]
    ((704, 2), 262)
    """
    env = discretise_actions(env)
    observations = env.observation_space
    states = space_size("env.observation_space", observations)
    if not (isinstance(observations, spaces.Discrete) and observations.start == 0):
        env = TransformObservation(
            env, lambda seen: number(observations, seen), spaces.Discrete(states)
        )
    return env


def discretise_actions(env: gym.Env[Any, Any]) -> gym.Env[Any, int]:
    """Return the environment with actions numbered 0 to A - 1; its observations stay as they are.

    Examples
    --------
    >>> discretise_actions(gym.make("CliffWalking-v1")).action_space
    Discrete(4)
    """
    if not isinstance(env, gym.Env):
        raise TypeError(
            f"env must be a Gymnasium environment, got {type(env).__name__}"
        )
    actions = env.action_space
    size = space_size("env.action_space", actions)
    if not (isinstance(actions, spaces.Discrete) and actions.start == 0):
        env = TransformAction(
            env, lambda action: element(actions, action), spaces.Discrete(size)
        )
    return env


def space_sizes(env: gym.Env[int, int]) -> tuple[int, int]:
    """Numbers of states S and actions A of an environment with discrete spaces.

    Examples
    --------
    >>> space_sizes(gym.make("FrozenLake-v1"))
    (16, 4)
    """
    return space_size("env.observation_space", env.observation_space), space_size(
        "env.action_space", env.action_space
    )
