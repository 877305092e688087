"""The simplest learner from demonstration: do as was done in the most similar states (k nearest neighbours)."""

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
    """Takes the action that most of the k nearest recorded states have; among equals, that of the nearer state.

    Attributes
    ----------
    states : (m, n) encoded; ``actions`` (m,) what was done in each.
    encoder : how what is sensed is encoded; distances are Euclidean between encodings.
    k : how many neighbours have a say.

    Raises
    ------
    ValueError : if there are fewer than k states.
    """

    states: NDArray[np.float64]
    actions: NDArray[np.int64]
    encoder: Encoder
    k: int = 5

    def __post_init__(self) -> None:
        check_integer("k", self.k, at_least=1, at_most=len(self.states))
        object.__setattr__(self, "_tree", cKDTree(self.states))

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Actions (N,); the generator is not used."""
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
    """Keep the effective pairs of demonstrations, and look there for what to do.

    Parameters
    ----------
    demonstrations : of any expert.
    k : how many neighbours have a say.
    encoder : how sensing is encoded.

    Raises
    ------
    ValueError : if there are fewer than k effective pairs.
    """
    encoder = encoder or Encoder()
    states, labels = labelled_states(demonstrations, encoder)
    return NeighbourPolicy(states, labels.argmax(axis=1), encoder, k)
