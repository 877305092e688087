"""A gridworld whose reward is known, to test what inverse methods find."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.mdp.gridworld import Cell, GridWorld

from .reward_free_mdp import RewardFreeMDP

CELLS = {"m": Cell(), "r": Cell(), "T": Cell(reward=3.0, ends=True)}
"""Mud, road and target; a dot is grass."""
TERRAIN = """
    . . m m . . .
    . r r r r r .
    . r m m m r .
    S r . m . r T
    . r m . . r .
    . . . m m . .
"""
TERRAIN_KINDS = ("grass", "mud", "road", "target")
_SYMBOLS = ".mrT"
TRUE_WEIGHTS: NDArray[np.float64] = np.array([-0.3, -1.0, -0.05, 3.0])
"""The reward of a step onto each of the ``TERRAIN_KINDS``."""


def terrain(
    *, slip: float = 0.2, discount: float = 0.9
) -> tuple[GridWorld, RewardFreeMDP]:
    """A gridworld of four kinds of terrain; the features of a step are the probabilities of each kind it may end on.

    Parameters
    ----------
    slip : float
        Probability of moving to one side or the other, see :class:`~robonav.mdp.GridWorld`.
    discount : float
        gamma.

    Returns
    -------
    grid : GridWorld
    mdp : RewardFreeMDP

    Examples
    --------
    >>> from robonav.nirl import terrain
    >>> grid, mdp = terrain()
    >>> mdp.features.shape
    (42, 4, 4)
    """
    grid = GridWorld(TERRAIN, legend=CELLS, slip=slip)
    symbols = np.array([grid.rows[row][column] for row, column in grid.cells])
    symbols[symbols == "S"] = "."
    kinds = (symbols[:, None] == np.array(list(_SYMBOLS))).astype(float)
    return grid, RewardFreeMDP.of_grid(grid, kinds, discount)
