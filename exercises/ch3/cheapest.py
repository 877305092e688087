# Exercise 3.7: The cheapest way for a robot that turns. 12 points, project, about 120 minutes.
# Check it with: robonav check 3.7
"""An evening's project: a search like the modified A*, to the end. A robot moves on a grid of cells with one of eight
headings, numbered counter-clockwise from east in steps of 45 degrees. It can go forward to the next cell in its
heading, one unit of length straight and $\\sqrt 2$ diagonally, or turn by 45 degrees to either side where it
stands, which costs something, too. A diagonal move must not cut a corner: the two cells beside it must be free as
well. Find the cost of the cheapest way to the goal, with any heading there. An admissible heuristic makes the
search quick; without one it must still come to an end.
"""

import numpy as np
from numpy.typing import NDArray


def cheapest(blocked: NDArray[np.bool_], start: tuple[int, int, int], goal: tuple[int, int], turn_cost: float) -> float:
    """Cost of the cheapest way.

    Parameters
    ----------
    blocked : (rows, columns), whether a cell is blocked; row 0 is the southernmost, column 0 the westernmost.
    start : row, column and heading 0 to 7 at the start; the cell is free.
    goal : row and column of the goal.
    turn_cost : cost of turning by 45 degrees, at least 0.

    Returns
    -------
    The cost, infinity if there is no way.
    """
    raise NotImplementedError("cheapest is yours to write")
