"""Eight ways to write exercise 6.3, as students who do not know each other would."""

import numpy as np


def leave_1(path, free, start, target):
    def side(p):
        return (target[0] - start[0]) * (p[1] - start[1]) - (target[1] - start[1]) * (
            p[0] - start[0]
        )

    def distance(p):
        return (p[0] - target[0]) ** 2 + (p[1] - target[1]) ** 2

    for t in range(1, len(path)):
        before, after = side(path[t - 1]), side(path[t])
        if after == 0 or (before < 0 < after) or (before > 0 > after):
            if distance(path[t]) < distance(path[0]) and free[t]:
                return t
    return -1


def leave_2(path, free, start, target):
    d = target - start
    cross = np.cross(
        np.append(d, 0), np.column_stack([path - start, np.zeros(len(path), int)])
    )[:, 2]
    dist = np.linalg.norm(path - target, axis=1)
    crossed = (cross[1:] == 0) | (np.sign(cross[1:]) == -np.sign(cross[:-1])) & (
        cross[:-1] != 0
    )
    good = np.flatnonzero(crossed & (dist[1:] < dist[0]) & free[1:])
    return int(good[0]) + 1 if good.size else -1


def leave_3(path, free, start, target):
    # the line as a x + b y = c
    a, b = target[1] - start[1], start[0] - target[0]
    c = a * start[0] + b * start[1]
    values = [a * x + b * y - c for x, y in path]
    met = sum((path[0] - target) ** 2)
    k = 1
    while k < len(path):
        on_line = values[k] == 0
        through = values[k] * values[k - 1] < 0
        if (on_line or through) and free[k] and sum((path[k] - target) ** 2) < met:
            return k
        k += 1
    return -1


def leave_4(path, free, start, target):
    normal = np.array([start[1] - target[1], target[0] - start[0]])
    height = (path - start) @ normal
    squared = np.einsum("ti,ti->t", path - target, path - target)
    steps = [
        t
        for t in range(1, len(path))
        if free[t]
        and squared[t] < squared[0]
        and (height[t] == 0 or np.sign(height[t]) + np.sign(height[t - 1]) == 0)
    ]
    return min(steps, default=-1)


def leave_5(path, free, start, target):
    matrix = np.array([target - start, [0, 0]])
    signs = []
    for p in path:
        matrix[1] = p - start
        determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
        signs.append(int(determinant > 0) - int(determinant < 0))
    limit = np.hypot(*(path[0] - target).astype(float))
    for step, (old, new) in enumerate(zip(signs, signs[1:]), start=1):
        if new != 0 and old * new != -1:
            continue
        if not free[step]:
            continue
        if np.hypot(*(path[step] - target).astype(float)) >= limit:
            continue
        return step
    return -1


def leave_6(path, free, start, target):
    x, y = (path - start).T
    dx, dy = target - start
    s = dx * y - dy * x
    to_target = np.square(path - target).sum(1)
    candidates = free.copy()
    candidates[0] = False
    candidates &= to_target < to_target[0]
    for t in np.where(candidates)[0]:
        if s[t] == 0 or (s[t] > 0) != (s[t - 1] > 0) and s[t - 1] != 0:
            return int(t)
    return -1


def leave_7(path, free, start, target):
    direction = complex(*(target - start).tolist())
    goal = complex(*target.tolist())
    points = [complex(*p) for p in path.tolist()]
    sides = [
        ((p - complex(*start.tolist())) * direction.conjugate()).imag for p in points
    ]

    def ok(t):
        meets = sides[t] == 0 or sides[t] * sides[t - 1] < 0
        nearer = abs(points[t] - goal) < abs(points[0] - goal)
        return meets and nearer and bool(free[t])

    return next((t for t in range(1, len(points)) if ok(t)), -1)


def leave_8(path, free, start, target):
    result = -1
    line = target - start
    for t in range(len(path) - 1, 0, -1):
        now, then = path[t] - start, path[t - 1] - start
        left_now = line[0] * now[1] - line[1] * now[0]
        left_then = line[0] * then[1] - line[1] * then[0]
        rest, rest_at_hit = target - path[t], target - path[0]
        nearer = rest @ rest < rest_at_hit @ rest_at_hit
        meets = left_now == 0 or min(left_now, left_then) < 0 < max(left_now, left_then)
        if meets and nearer and free[t]:
            result = t
    return result
