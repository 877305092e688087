"""Features of a state and an action, for values that are linear in them (Eq. (4.3)).

A feature map is any callable ``features(state) -> (A, n)``: the n numbers f_1(s, a) ... f_n(s, a) of each of the A
actions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array, check_integer

R = TypeVar("R")

Features = Callable[[Any], NDArray[np.float64]]


def for_each_action(
    state_features: NDArray[np.float64], actions: int
) -> NDArray[np.float64]:
    """Give each action a block for the state features (d,): (A, A * d), zero except in the action's own block."""
    blocks = np.zeros((actions, actions, len(state_features)))
    blocks[np.arange(actions), np.arange(actions)] = state_features
    return blocks.reshape(actions, -1)


@dataclass(frozen=True)
class OneHot:
    """One feature for each state and action: a table, written as a linear function.

    Parameters
    ----------
    n_states, n_actions : int
        S and A; states are numbers from 0.

    Examples
    --------
    >>> from robonav.mdp import OneHot
    >>> OneHot(n_states=2, n_actions=1)(0)
    array([[1., 0.]])
    """

    n_states: int
    n_actions: int

    def __post_init__(self) -> None:
        check_integer("n_states", self.n_states, at_least=1)
        check_integer("n_actions", self.n_actions, at_least=1)

    def __call__(self, state: int) -> NDArray[np.float64]:
        place = check_integer("state", state, at_least=0, at_most=self.n_states - 1)
        return for_each_action(np.eye(1, self.n_states, place)[0], self.n_actions)


def takes_state(method: Callable[[Any, Any], R]) -> Callable[[Any, ArrayLike], R]:
    """Let a method of a tile coding take ``state`` as any array-like of shape (d,), and check it."""

    @wraps(method)
    def checked(self: Tiles, state: ArrayLike) -> R:
        """Check the state, then call the method."""
        return method(self, check_array("state", state, shape=(len(self.low),)))

    return checked


@dataclass(frozen=True)
class Tiles:
    """Tile coding: several grids over the state, each shifted a little; one feature for each tile and action.

    A state lies in one tile of each tiling. Neighbours share most of their tiles, so what is learned in one place is
    half known next to it. With k tilings divide the learning rate by k.

    Parameters
    ----------
    low, high : (d,) tuple of floats
        Bounds of the state's coordinates; a state outside counts as on the edge.
    tiles : (d,) tuple of ints
        Number of tiles along each coordinate.
    tilings : int
        Number of grids. Grid i is shifted by i / tilings of a tile along the first coordinate, three times that along
        the second, five times along the third, and so on: odd numbers keep the tilings apart in every direction
        (Sutton and Barto 2018, section 9.5.4).
    n_actions : int
        A.

    Examples
    --------
    >>> from robonav.mdp import Tiles
    >>> tiles = Tiles(low=(0.0,), high=(1.0,), tiles=(2,), tilings=2, n_actions=1)
    >>> tiles([0.3])
    array([[1., 0., 0., 0., 1., 0.]])
    """

    low: tuple[float, ...]
    high: tuple[float, ...]
    tiles: tuple[int, ...]
    tilings: int
    n_actions: int

    def __post_init__(self) -> None:
        low = check_array("low", self.low, shape=("d",))
        high = check_array("high", self.high, shape=low.shape)
        if not (low < high).all():
            raise ValueError(
                f"low must be below high in every coordinate, got {self.low} and {self.high}"
            )
        for tiles in check_array("tiles", self.tiles, shape=low.shape, dtype=int):
            check_integer("tiles", tiles, at_least=1)
        check_integer("tilings", self.tilings, at_least=1)
        check_integer("n_actions", self.n_actions, at_least=1)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """(tilings, tiles along each coordinate + 1); the shift needs one tile more."""
        return (self.tilings, *(tiles + 1 for tiles in self.tiles))

    @cached_property
    def shifts(self) -> NDArray[np.float64]:
        """Shift of each tiling, in tiles: (tilings, d)."""
        odd = 2 * np.arange(len(self.tiles)) + 1
        return np.outer(np.arange(self.tilings), odd) % self.tilings / self.tilings

    @takes_state
    def active(self, state: NDArray[np.float64]) -> NDArray[np.int64]:
        """Number of the tile that holds the state, in each tiling.

        Parameters
        ----------
        state : (d,) array
            A state of d numbers; outside ``low`` and ``high`` it is moved to the nearest edge.

        Returns
        -------
        (tilings,) array of int

        Examples
        --------
        >>> from robonav.mdp import Tiles
        >>> Tiles(low=[0.0], high=[1.0], tiles=[4], tilings=2, n_actions=1).active([0.3])
        array([1, 6])
        """
        inside = np.clip(state, self.low, self.high)
        size = np.subtract(self.high, self.low)
        place = (inside - self.low) / size * self.tiles  # in tiles
        cells = np.minimum((place + self.shifts).astype(int), self.tiles)
        return np.ravel_multi_index((np.arange(self.tilings), *cells.T), self.shape)

    def __call__(self, state: ArrayLike) -> NDArray[np.float64]:
        found = np.zeros(int(np.prod(self.shape)))
        found[self.active(state)] = 1.0
        return for_each_action(found, self.n_actions)


def with_bias(features: Features) -> Features:
    """Put f_0 = 1 before the features, so that the constant is a weight like the others.

    Parameters
    ----------
    features : Features
        Features without a constant.

    Returns
    -------
    Features
        The same with one more feature, which is 1 for every state and action.

    Examples
    --------
    >>> from robonav.mdp import OneHot, with_bias
    >>> with_bias(OneHot(2, 1))(1)
    array([[1., 0., 1.]])
    """

    def extended(state: Any) -> NDArray[np.float64]:
        """The features with a constant in front."""
        found = features(state)
        return np.hstack([np.ones((len(found), 1)), found])

    return extended
