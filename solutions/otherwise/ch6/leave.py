"""6.3 step by step, with angles in place of products."""

import math


def leave(path, free, start, target):
    (a, b), (c, d) = map(float, start), map(float, target)
    course = math.atan2(d - b, c - a)

    def beside(x, y):  # how far to the left of the line
        left = math.cos(course) * (y - b) - math.sin(course) * (x - a)
        return 0.0 if abs(left) < 1e-9 else left

    before = 0.0
    at_first = math.dist(path[0], target)
    for n, (x, y) in enumerate(path):
        now = beside(float(x), float(y))
        meets = now == 0 or (now < 0 < before) or (before < 0 < now)
        near = math.dist((x, y), target) < at_first - 1e-9
        if n and meets and near and free[n]:
            return n
        before = now
    return -1
