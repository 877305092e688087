"""k nearest neighbours: a policy that takes the action that the expert took in the most similar states."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from robonav.robot import Encoder, Sensing
from robonav.validation import check_integer

from .behaviour_cloning import labelled_states
from .demonstrations import LEARNED, Demonstrations


@dataclass(frozen=True, eq=False)
class NeighbourPolicy:
    """A policy by vote of the k recorded states nearest to the robot's state.

    It takes the action that most of these states have. Of actions with equally many votes it takes the one of the
    nearest state.

    Attributes
    ----------
    states : (m, n) array
        Recorded states, encoded. Distances between them are Euclidean.
    actions : (m,) array of int
        The action that the expert took in each.
    encoder : Encoder
        Turns what the robot senses into a state.
    k : int
        Number of neighbours that vote.

    Raises
    ------
    ValueError
        If there are fewer than k states.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import NeighbourPolicy
    >>> from robonav.robot import Encoder
    >>> encoder = Encoder()
    >>> NeighbourPolicy(np.zeros((3, encoder.size)), np.array([0, 1, 1]), encoder, k=3).k
    3
    """

    states: NDArray[np.float64]
    actions: NDArray[np.int64]
    encoder: Encoder
    k: int = 5
    _tree: cKDTree = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check_integer("k", self.k, at_least=1, at_most=len(self.states))
        object.__setattr__(self, "_tree", cKDTree(self.states))

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return actions (N,). No random numbers are drawn."""
        states = self.encoder(sensing)
        _, nearest = self._tree.query(states, k=range(1, self.k + 1))
        votes = np.zeros((len(states), LEARNED))
        for rank in range(self.k):  # the nearest neighbour has rank 0
            actions = self.actions[nearest[:, rank]]
            # A nearer neighbour's vote counts a little more, which only decides ties.
            weight = 1 + (self.k - rank) / (LEARNED * self.k) ** 2
            votes[np.arange(len(states)), actions] += weight
        return votes.argmax(axis=1)


def learn_neighbours(
    demonstrations: Demonstrations, k: int = 5, *, encoder: Encoder | None = None
) -> NeighbourPolicy:
    """Learn a policy by k nearest neighbours, which keeps the effective pairs in demonstrations as they are.

    Parameters
    ----------
    demonstrations : Demonstrations
        By any expert.
    k : int
        Number of neighbours that vote.
    encoder : Encoder, optional
        Turns what the robot senses into a state.

    Returns
    -------
    NeighbourPolicy

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If there are fewer than k effective pairs.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, learn_neighbours
    >>> from robonav.robot import random_worlds
    >>> learn_neighbours(demonstrate(random_worlds(2, obstacles=10, seed=1)), k=3).k
    3
    """
    encoder = encoder or Encoder()
    states, labels = labelled_states(demonstrations, encoder)
    return NeighbourPolicy(states, labels.argmax(axis=1), encoder, k)
