"""3.7 without a queue: costs relaxed over all nodes until none falls any more."""

import numpy as np

MOVES = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)]


def cheapest(blocked, start, goal, turn_cost):
    rows, columns = blocked.shape
    padded = np.ones((rows + 2, columns + 2), dtype=bool)
    padded[1:-1, 1:-1] = blocked
    steps = []  # for each heading, from where to where a step is free
    for down, right in MOVES:
        before = [
            (row, column)
            for row, column in np.argwhere(~blocked)
            if not padded[row + down + 1, column + right + 1]
            and not padded[row + down + 1, column + 1]
            and not padded[row + 1, column + right + 1]
        ]
        there = np.reshape(before, (-1, 2)).astype(int)
        steps.append((tuple(there.T), tuple((there + (down, right)).T)))
    cost = np.full((rows, columns, 8), np.inf)
    cost[tuple(start)] = 0.0
    while True:
        new = cost.copy()
        for heading, (before, after) in enumerate(steps):
            turned = [cost[:, :, (heading + turn) % 8] + turn_cost for turn in (1, -1)]
            best = np.minimum.reduce([cost[:, :, heading], *turned])
            length = np.hypot(*MOVES[heading])
            best[after] = np.minimum(best[after], cost[(*before, heading)] + length)
            new[:, :, heading] = best
        if np.array_equal(new, cost):
            return float(cost[tuple(goal)].min())
        cost = new
