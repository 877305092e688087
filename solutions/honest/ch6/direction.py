"""Eight ways to write exercise 6.2, as students who do not know each other would."""

import numpy as np


def direction_1(histogram, blocked, low, high, target, last, weights):
    B = len(histogram)
    now = np.zeros(B, dtype=bool)
    cost = np.zeros(B)
    for b in range(B):
        if histogram[b] >= high:
            now[b] = True
        elif histogram[b] <= low:
            now[b] = False
        else:
            now[b] = blocked[b]
        for goal, weight in zip((target, 0, last), weights):
            d = abs(b - goal)
            cost[b] += weight * min(d, B - d)
    chosen = -1
    for b in range(B):
        if not now[b] and (chosen == -1 or cost[b] < cost[chosen]):
            chosen = b
    return now, cost, chosen


def direction_2(histogram, blocked, low, high, target, last, weights):
    n = histogram.size
    state = np.where(
        histogram >= high, True, np.where(histogram <= low, False, blocked)
    )

    def angle(to):
        turn = np.mod(np.arange(n) - to, n)
        return np.minimum(turn, n - turn)

    cost = weights[0] * angle(target) + weights[1] * angle(0) + weights[2] * angle(last)
    free = np.flatnonzero(~state)
    return state, cost, int(free[cost[free].argmin()]) if len(free) else -1


def direction_3(histogram, blocked, low, high, target, last, weights):
    def is_blocked(h, before):
        return True if h >= high else False if h <= low else bool(before)

    def apart(i, j):
        return min((i - j) % len(histogram), (j - i) % len(histogram))

    now = [is_blocked(h, b) for h, b in zip(histogram, blocked)]
    cost = [
        sum(w * apart(i, j) for w, j in zip(weights, (target, 0, last)))
        for i in range(len(histogram))
    ]
    candidates = [(c, i) for i, c in enumerate(cost) if not now[i]]
    best = min(candidates)[1] if candidates else -1
    return np.array(now), np.array(cost), best


def direction_4(histogram, blocked, low, high, target, last, weights):
    result = np.array(blocked)
    result[histogram >= high] = True
    result[histogram <= low] = False
    bins = len(histogram)
    distances = np.abs(np.subtract.outer(np.arange(bins), [target, 0, last]))
    distances = np.where(distances > bins / 2, bins - distances, distances)
    cost = distances.dot(weights)
    order = np.argsort(cost, kind="stable")
    order = order[~result[order]]
    return result, cost, int(order[0]) if order.size > 0 else -1


def direction_5(histogram, blocked, low, high, target, last, weights):
    # a ring of distances, rolled to each of the three directions
    n = len(histogram)
    ring = np.concatenate([np.arange(n // 2 + 1), np.arange((n - 1) // 2, 0, -1)])
    cost = np.zeros(n)
    for weight, place in zip(weights, (target, 0, last)):
        cost = cost + weight * np.roll(ring, place)
    above, below = histogram >= high, histogram <= low
    stays = ~above & ~below
    new = above | (stays & blocked)
    masked = np.ma.array(cost, mask=new)
    return new, cost, -1 if new.all() else int(masked.argmin())


def direction_6(histogram, blocked, low, high, target, last, weights):
    N = len(histogram)
    theta = 2 * np.pi * np.arange(N) / N
    cost = np.zeros(N)
    for w, k in zip(weights, [target, 0, last]):
        difference = np.angle(np.exp(1j * (theta - theta[k])))
        cost += w * np.rint(np.abs(difference) * N / (2 * np.pi))
    b = blocked.copy()
    for i, h in enumerate(histogram):
        if h >= high:
            b[i] = True
        if h <= low:
            b[i] = False
    best, chosen = np.inf, -1
    for i in np.where(np.logical_not(b))[0]:
        if cost[i] < best:
            best, chosen = cost[i], int(i)
    return b, cost, chosen


def direction_7(histogram, blocked, low, high, target, last, weights):
    size = histogram.shape[0]
    blocked_now = np.select(
        [histogram >= high, histogram <= low], [True, False], default=blocked
    )
    i = np.arange(size)
    total = 0
    for goal, weight in ((target, weights[0]), (0, weights[1]), (last, weights[2])):
        one_way = np.abs(i - goal)
        total = total + weight * np.stack([one_way, size - one_way]).min(axis=0)
    if np.all(blocked_now):
        return blocked_now, total, -1
    expensive = total + blocked_now * (np.max(total) + 1)
    return blocked_now, total, int(np.argmin(expensive))


def direction_8(histogram, blocked, low, high, target, last, weights):
    class Histogram:
        def __init__(self):
            self.n = len(histogram)
            self.blocked = [self.update(k) for k in range(self.n)]

        def update(self, k):
            if low < histogram[k] < high:
                return blocked[k]
            return histogram[k] >= high

        def cost(self, k):
            steps = []
            for other in (target, 0, last):
                d = (k - other) % self.n
                steps.append(d if d <= self.n - d else self.n - d)
            return float(np.dot(weights, steps))

    h = Histogram()
    costs = np.array([h.cost(k) for k in range(h.n)])
    free = [k for k in range(h.n) if not h.blocked[k]]
    return (
        np.array(h.blocked, dtype=bool),
        costs,
        min(free, key=lambda k: costs[k], default=-1),
    )
