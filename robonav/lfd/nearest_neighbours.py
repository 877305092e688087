"""k nearest neighbours: take the action that the expert took in the most similar states."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from robonav.robot import Encoder, Sensing
from robonav.validation import check_integer

from .behaviour_cloning import labelled_states
from .demonstrations import LEARNED, Demonstrations


@dataclass(frozen=True, eq=False)
class NeighbourPolicy:
    """The policy that takes the action of most of the k nearest recorded states; of equals, that of the nearer state.

    Attributes
    ----------
    states : (m, n) array
        Recorded states, encoded. Distances between encodings are Euclidean.
    actions : (m,) array of int
        The action taken in each.
    encoder : Encoder
        How sensing is encoded.
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

    def __post_init__(self) -> None:
        check_integer("k", self.k, at_least=1, at_most=len(self.states))
        object.__setattr__(self, "_tree", cKDTree(self.states))

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return actions (N,); the generator is not used."""
        _, nearest = self._tree.query(  # type: ignore[attr-defined]
            self.encoder(sensing), k=range(1, self.k + 1)
        )
        near = self.actions[nearest]
        votes = np.zeros((len(near), LEARNED))
        for rank in range(self.k):  # a nearer state weighs more, yet never outvotes two
            weight = 1 + (self.k - rank) / (LEARNED * self.k) ** 2
            votes[np.arange(len(near)), near[:, rank]] += weight
        return votes.argmax(axis=1)


def learn_neighbours(
    demonstrations: Demonstrations, k: int = 5, *, encoder: Encoder | None = None
) -> NeighbourPolicy:
    """Learn a policy by k nearest neighbours: keep the effective pairs of demonstrations.

    Parameters
    ----------
    demonstrations : Demonstrations
        Of any expert.
    k : int
        Number of neighbours that vote.
    encoder : Encoder, optional
        How sensing is encoded.

    Returns
    -------
    NeighbourPolicy

    Raises
    ------
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
