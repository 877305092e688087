"""Eight ways to write exercise 5.3, as students who do not know each other would."""

import numpy as np


def projected_1(weights, found, expert, scale):
    current = np.zeros(found.shape[1])
    for w, mu in zip(weights, found):
        current = current + w * mu
    a = (found[-1] - current) / scale
    b = (expert - current) / scale
    if np.dot(a, a) == 0:
        t = 0.0
    else:
        t = np.dot(a, b) / np.dot(a, a)
        t = min(max(t, 0.0), 1.0)
    new = [w * (1 - t) for w in weights] + [t]
    point = current + t * (found[-1] - current)
    return np.array(new), np.sqrt(np.sum(((expert - point) / scale) ** 2))


def projected_2(weights, found, expert, scale):
    points, goal = found / scale, expert / scale
    old, new = np.average(points[:-1], axis=0, weights=weights), points[-1]
    length = np.sum((new - old) ** 2)
    with np.errstate(all="ignore"):
        step = np.nan_to_num(
            np.sum((new - old) * (goal - old)) / length, nan=0.0, posinf=0.0, neginf=0.0
        )
    step = np.clip(step, 0, 1)
    mixture = np.concatenate([weights * (1 - step), [step]])
    return mixture, float(np.linalg.norm(goal - mixture @ points))


def projected_3(weights, found, expert, scale):
    k = len(expert)
    mix = [sum(weights[i] * found[i][j] for i in range(len(weights))) for j in range(k)]
    top = sum(
        (found[-1][j] - mix[j]) * (expert[j] - mix[j]) / scale[j] ** 2 for j in range(k)
    )
    bottom = sum(((found[-1][j] - mix[j]) / scale[j]) ** 2 for j in range(k))
    share = 0.0
    if bottom > 0 and top > 0:
        share = 1.0 if top > bottom else top / bottom
    p = np.zeros(len(weights) + 1)
    p[:-1] = (1 - share) * weights
    p[-1] = share
    rest = sum(((expert[j] - p @ found[:, j]) / scale[j]) ** 2 for j in range(k))
    return p, rest**0.5


def projected_4(weights, found, expert, scale):
    def distance(p):
        return np.linalg.norm((p @ found - expert) / scale)

    before = np.append(weights, 0.0)
    after = np.append(np.zeros(len(weights)), 1.0)
    direction = ((after - before) @ found) / scale
    miss = (expert - before @ found) / scale
    squared = direction.dot(direction)
    s = 0.0 if squared == 0 else np.median([0.0, 1.0, direction.dot(miss) / squared])
    mixed = (1 - s) * before + s * after
    return mixed, distance(mixed)


def projected_5(weights, found, expert, scale):
    # relative to the expert, so that the nearest point to the origin is wanted
    z = (found - expert) / scale
    m, n = weights @ z[:-1], z[-1]
    difference = m - n
    denominator = np.inner(difference, difference)
    lam = 0 if not denominator else np.inner(m, difference) / denominator
    lam = sorted((0.0, lam, 1.0))[1]
    q = np.empty(len(found))
    q[:-1], q[-1] = weights * (1 - lam), lam
    return q, np.hypot.reduce(m - lam * difference)


def projected_6(weights, found, expert, scale):
    inverse = np.diag(1 / scale**2)
    mixture = np.einsum("n,nk->k", weights, found[: len(weights)])
    u, v = found[len(weights)] - mixture, expert - mixture
    norm = u @ inverse @ u
    alpha = float(u @ inverse @ v / norm) if norm > 0 else 0.0
    if alpha < 0:
        alpha = 0.0
    if alpha > 1:
        alpha = 1.0
    left = v - alpha * u
    return np.r_[weights - alpha * weights, alpha], float(
        np.sqrt(left @ inverse @ left)
    )


def projected_7(weights, found, expert, scale):
    *old, new = found / scale
    aim = expert / scale
    start = np.sum([w * mu for w, mu in zip(weights, old)], axis=0)
    ray = new - start
    if not ray.any():
        return np.append(weights, 0.0), np.linalg.norm(aim - start)
    (t,), *_ = np.linalg.lstsq(ray[:, None], aim - start, rcond=None)
    t = np.minimum(1.0, np.maximum(0.0, t))
    return np.append(weights * (1 - t), t), np.linalg.norm(aim - start - t * ray)


def projected_8(weights, found, expert, scale):
    class Point:
        def __init__(self, p):
            self.p = p
            self.x = p @ found / scale

        def to(self, other):
            return other - self.x

    n = len(weights)
    mixture, newest = Point(np.concatenate((weights, [0]))), Point(np.eye(n + 1)[n])
    segment, wanted = mixture.to(newest.x), mixture.to(expert / scale)
    length = (segment**2).sum()
    share = (segment * wanted).sum() / length if length != 0 else 0
    share = np.clip(share, 0.0, 1.0)
    best = Point((1 - share) * mixture.p + share * newest.p)
    return best.p, float(np.sqrt((best.to(expert / scale) ** 2).sum()))
