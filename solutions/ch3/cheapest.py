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
    ### BEGIN SOLUTION
    import heapq

    moves = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]
    rows, columns = blocked.shape

    def free(row, column):
        return 0 <= row < rows and 0 <= column < columns and not blocked[row, column]

    def ahead(row, column):
        far, near = (
            max(abs(row - goal[0]), abs(column - goal[1])),
            min(abs(row - goal[0]), abs(column - goal[1])),
        )
        return far - near + near * 2**0.5

    best = {tuple(start): 0.0}
    waiting = [(ahead(*start[:2]), 0.0, tuple(start))]
    while waiting:
        _, cost, (row, column, heading) = heapq.heappop(waiting)
        if (row, column) == tuple(goal):
            return cost
        if cost > best[row, column, heading]:
            continue
        down, right = moves[heading]
        options = [((row, column, (heading + turn) % 8), turn_cost) for turn in (1, -1)]
        if (
            free(row + down, column + right)
            and free(row + down, column)
            and free(row, column + right)
        ):
            options.append(
                ((row + down, column + right, heading), (down**2 + right**2) ** 0.5)
            )
        for node, step in options:
            if cost + step < best.get(node, np.inf):
                best[node] = cost + step
                heapq.heappush(
                    waiting, (cost + step + ahead(*node[:2]), cost + step, node)
                )
    return np.inf
    ### END SOLUTION
