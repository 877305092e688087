"""Known mistakes in 3.7; a function's docstring is its hint."""

import heapq


def _search(
    blocked,
    start,
    goal,
    turn_cost,
    *,
    corners=False,
    either=False,
    diagonal=2**0.5,
    clockwise=False,
    greedy=0.0,
    manhattan=False,
    cells=False,
    sides=(1, -1),
    at_once=False,
    improves=True,
    through=False,
    ring=True,
):
    moves = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]
    if clockwise:
        moves = [(-row, column) for row, column in moves]
    rows, columns = blocked.shape

    def free(row, column):
        if not (0 <= row < rows and 0 <= column < columns):
            return False
        return through or not blocked[row, column]

    def ahead(row, column):
        if manhattan:
            return abs(row - goal[0]) + abs(column - goal[1])
        return greedy * ((row - goal[0]) ** 2 + (column - goal[1]) ** 2)

    closed, opened = set(), {tuple(start)}
    waiting = [(ahead(*start[:2]), 0.0, tuple(start))]
    while waiting:
        _, cost, (row, column, heading) = heapq.heappop(waiting)
        if (row, column) == tuple(goal):
            return cost
        place = (row, column) if cells else (row, column, heading)
        if place in closed:
            continue
        closed.add(place)
        down, right = moves[heading]
        options = [
            ((row, column, (heading + turn) % 8), turn_cost)
            for turn in sides
            if ring or 0 <= heading + turn < 8
        ]
        both = free(row + down, column), free(row, column + right)
        beside = corners or all(both) or (either and any(both))
        if free(row + down, column + right) and beside:
            options.append(
                (
                    (row + down, column + right, heading),
                    diagonal if down and right else 1.0,
                )
            )
        for node, step in options:
            if at_once and node[:2] == tuple(goal):
                return cost + step
            if not improves and node in opened:
                continue
            opened.add(node)
            heapq.heappush(waiting, (cost + step + ahead(*node[:2]), cost + step, node))
    return float("inf")


def cuts_corners(blocked, start, goal, turn_cost):
    """A diagonal move needs the two cells beside it to be free as well."""
    return _search(blocked, start, goal, turn_cost, corners=True)


def needs_one_side(blocked, start, goal, turn_cost):
    """A diagonal move needs both cells beside it to be free: one of them is not enough."""
    return _search(blocked, start, goal, turn_cost, either=True)


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


def steps_to_either_side(blocked, start, goal, turn_cost):
    """This heuristic counts a diagonal move as 2, and so can exceed the cost that remains."""
    return _search(blocked, start, goal, turn_cost, manhattan=True)


def one_heading_for_a_cell(blocked, start, goal, turn_cost):
    """A node of the search is a cell with a heading: the same cell with another heading must not count as expanded."""
    return _search(blocked, start, goal, turn_cost, cells=True)


def turns_left_only(blocked, start, goal, turn_cost):
    """The robot can turn to either side."""
    return _search(blocked, start, goal, turn_cost, sides=(1,))


def headings_end(blocked, start, goal, turn_cost):
    """The headings form a circle: a turn to the left leads from 7 to 0, and one to the right from 0 to 7."""
    return _search(blocked, start, goal, turn_cost, ring=False)


def pays_by_the_radian(blocked, start, goal, turn_cost):
    """The turn cost is for 45 degrees, not for a radian."""
    return _search(blocked, start, goal, turn_cost * 0.7853981633974483)


def stops_when_it_sees_the_goal(blocked, start, goal, turn_cost):
    """Stop when the goal is taken from the queue, not when it is put there: a cheaper path to it may follow."""
    return _search(blocked, start, goal, turn_cost, at_once=True)


def never_improves(blocked, start, goal, turn_cost):
    """A node that waits in the queue may be reached more cheaply later: then the cheaper path counts."""
    return _search(blocked, start, goal, turn_cost, improves=False)


def through_walls(blocked, start, goal, turn_cost):
    """A blocked cell cannot be entered."""
    return _search(blocked, start, goal, turn_cost, through=True)


def nothing_for_no_path(blocked, start, goal, turn_cost):
    """Return infinity where there is no path."""
    cost = _search(blocked, start, goal, turn_cost)
    return cost if cost < float("inf") else -1.0
