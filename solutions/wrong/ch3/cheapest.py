"""Known mistakes in 3.7; a function's docstring is its hint."""

import heapq


def _search(
    blocked,
    start,
    goal,
    turn_cost,
    *,
    corners=False,
    diagonal=2**0.5,
    clockwise=False,
    greedy=0.0,
    wide=1,
):
    moves = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]
    if clockwise:
        moves = [(-row, column) for row, column in moves]
    rows, columns = blocked.shape

    def free(row, column):
        return 0 <= row < rows and 0 <= column < columns and not blocked[row, column]

    def ahead(row, column):
        return greedy * ((row - goal[0]) ** 2 + (column - goal[1]) ** 2)

    closed, waiting = set(), [(ahead(*start[:2]), 0.0, tuple(start))]
    while waiting:
        _, cost, (row, column, heading) = heapq.heappop(waiting)
        if (row, column) == tuple(goal):
            return cost
        if (row, column, heading) in closed:
            continue
        closed.add((row, column, heading))
        down, right = moves[heading]
        options = [((row, column, (heading + turn) % 8), turn_cost) for turn in (1, -1)]
        beside = corners or (free(row + down, column) and free(row, column + right))
        if free(row + down, column + right) and beside:
            options.append(
                (
                    (row + down, column + right, heading),
                    diagonal if down and right else 1.0,
                )
            )
        for node, step in options:
            heapq.heappush(waiting, (cost + step + ahead(*node[:2]), cost + step, node))
    return float("inf")


def cuts_corners(blocked, start, goal, turn_cost):
    """A diagonal move needs the two cells beside it to be free as well."""
    return _search(blocked, start, goal, turn_cost, corners=True)


def counts_cells(blocked, start, goal, turn_cost):
    """A diagonal move is longer: it costs the square root of two."""
    return _search(blocked, start, goal, turn_cost, diagonal=1.0)


def turns_for_nothing(blocked, start, goal, turn_cost):
    """Turning costs something, too."""
    return _search(blocked, start, goal, 0.0)


def upside_down(blocked, start, goal, turn_cost):
    """Headings are numbered counter-clockwise from east, and row 0 is the southernmost: heading 2 leads one row up."""
    return _search(blocked, start, goal, turn_cost, clockwise=True)


def overestimates(blocked, start, goal, turn_cost):
    """The heuristic must never exceed the cost that remains, or the first path found need not be the cheapest."""
    return _search(blocked, start, goal, turn_cost, greedy=1.0)
