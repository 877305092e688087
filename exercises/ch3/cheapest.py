# Exercise 3.7: The cheapest path for a robot that turns.
# 12 points, project, about 120 minutes.
# Check it with: robonav check 3.7
r"""This project is a complete search like modified A*. A robot moves on a grid of
cells. It has one of eight headings, numbered counter-clockwise from east in steps of 45
degrees. It has two kinds of moves. It can go to the next cell in the direction of its
heading, which costs 1 along a row or column and $\sqrt 2$ diagonally. Or it can turn by
45 degrees to either side where it stands, which costs ``turn_cost``. It must not cut
corners: a diagonal move needs the two cells beside it to be free as well. Find the cost
of the cheapest path to the goal, with any heading there. The goal may be blocked; there
is no path to it then. An admissible heuristic makes the search fast. Without one the
search must still end.
"""

import numpy as np
from numpy.typing import NDArray


def cheapest(
    blocked: NDArray[np.bool_],
    start: tuple[int, int, int],
    goal: tuple[int, int],
    turn_cost: float,
) -> float:
    """Return the cost of the cheapest path.

    Parameters
    ----------
    blocked : (rows, columns), whether a cell is blocked; row 0 is the southernmost,
        column 0 the westernmost.
    start : row, column and heading (0 to 7) at the start; this cell is free.
    goal : row and column of the goal.
    turn_cost : cost of turning by 45 degrees, at least 0.

    Returns
    -------
    The cost; infinity if there is no path.
    """
    raise NotImplementedError("cheapest is yours to write")
