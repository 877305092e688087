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
    ### BEGIN SOLUTION
    import heapq

    moves = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]
    rows, columns = blocked.shape

    def free(row, column):
        return 0 <= row < rows and 0 <= column < columns and not blocked[row, column]

    def ahead(row, column):
        far, near = max(abs(row - goal[0]), abs(column - goal[1])), min(abs(row - goal[0]), abs(column - goal[1]))
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
        if free(row + down, column + right) and free(row + down, column) and free(row, column + right):
            options.append(((row + down, column + right, heading), (down**2 + right**2) ** 0.5))
        for node, step in options:
            if cost + step < best.get(node, np.inf):
                best[node] = cost + step
                heapq.heappush(waiting, (cost + step + ahead(*node[:2]), cost + step, node))
    return np.inf
    ### END SOLUTION
