"""A small world whose reward is known: where a method's answer can be held against the truth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.mdp.gridworld import Cell, GridWorld

from .reward_free_mdp import RewardFreeMDP

GROUND = {
    "m": Cell(),
    "r": Cell(),
    "T": Cell(reward=3.0, ends=True),
}  # mud, road, target; a dot is grass
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
"""What a step onto each of the ``TERRAIN_KINDS`` is worth."""


def terrain(
    *, slip: float = 0.2, discount: float = 0.9
) -> tuple[GridWorld, RewardFreeMDP]:
    """Four kinds of ground, a start and a target; the features of a step are the shares of ground it may end on.

    Parameters
    ----------
    slip : how likely a step goes to one side or the other, see :class:`~robonav.mdp.GridWorld`.
    discount : gamma.
    """
    grid = GridWorld(TERRAIN, legend=GROUND, slip=slip)
    symbols = np.array([grid.rows[row][column] for row, column in grid.cells])
    symbols[symbols == "S"] = "."
    return grid, RewardFreeMDP.of_grid(
        grid, (symbols[:, None] == np.array(list(_SYMBOLS))).astype(float), discount
    )
