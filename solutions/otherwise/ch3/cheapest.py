"""3.7 without a queue: costs relaxed over all nodes until none falls any more."""

import numpy as np

MOVES = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]


def cheapest(blocked, start, goal, turn_cost):
    rows, columns = blocked.shape
    padded = np.ones((rows + 2, columns + 2), dtype=bool)
    padded[1:-1, 1:-1] = blocked
    cost = np.full((rows, columns, 8), np.inf)
    cost[tuple(start)] = 0.0
    while True:
        new = cost.copy()
        for heading, (down, right) in enumerate(MOVES):
            for turn in (1, -1):
                np.minimum(
                    new[:, :, heading],
                    cost[:, :, (heading + turn) % 8] + turn_cost,
                    out=new[:, :, heading],
                )
            step = (down**2 + right**2) ** 0.5
            for row, column in np.argwhere(~blocked):
                there = row + down, column + right
                ways = [
                    (there[0] + 1, there[1] + 1),
                    (row + down + 1, column + 1),
                    (row + 1, column + right + 1),
                ]
                if not any(padded[way] for way in ways):
                    place = (*there, heading)
                    new[place] = min(new[place], cost[row, column, heading] + step)
        if np.array_equal(new, cost):
            return float(cost[tuple(goal)].min())
        cost = new
