"""Eight ways to write exercise 6.1, as students who do not know each other would."""

import math

import numpy as np


def force_1(place, target, circles, attraction, fading, repulsion, influence):
    pull = np.zeros(2)
    d = np.linalg.norm(target - place)
    if d > 0:
        pull = attraction * min(d, fading) * (target - place) / d
    push = np.zeros(2)
    for x, y, r in circles:
        away = place - np.array([x, y])
        distance = np.linalg.norm(away)
        rho = max(distance - r, 0.1)
        if rho < influence:
            size = repulsion * (1 / rho - 1 / influence) / rho**2
            push += size * away / distance
    return np.array([pull, push])


def force_2(place, target, circles, attraction, fading, repulsion, influence):
    def unit(v):
        length = np.sqrt(np.sum(v**2, axis=-1, keepdims=True))
        return np.divide(
            v, length, out=np.zeros_like(v, dtype=float), where=length > 0
        ), length[..., 0]

    direction, d = unit(np.asarray(target - place, dtype=float))
    away, middle = unit(np.asarray(place - circles[:, :2], dtype=float))
    rho = np.maximum(middle - circles[:, 2], 0.1)
    strength = np.where(
        rho < influence, repulsion * (1 / rho - 1 / influence) / rho**2, 0.0
    )
    return np.stack(
        [
            attraction * np.minimum(d, fading) * direction,
            (strength[:, None] * away).sum(axis=0),
        ]
    )


def force_3(place, target, circles, attraction, fading, repulsion, influence):
    px, py = place
    dx, dy = target[0] - px, target[1] - py
    d = math.sqrt(dx * dx + dy * dy)
    if d == 0:
        ax = ay = 0.0
    elif d <= fading:
        ax, ay = attraction * dx, attraction * dy
    else:
        ax, ay = attraction * fading * dx / d, attraction * fading * dy / d
    rx = ry = 0.0
    for cx, cy, radius in circles:
        ox, oy = px - cx, py - cy
        m = math.sqrt(ox * ox + oy * oy)
        rho = m - radius
        if rho < 0.1:
            rho = 0.1
        if rho >= influence:
            continue
        f = repulsion * (1 / rho - 1 / influence) * (1 / rho) ** 2
        rx += f * ox / m
        ry += f * oy / m
    return [[ax, ay], [rx, ry]]


def force_4(place, target, circles, attraction, fading, repulsion, influence):
    # complex numbers are vectors
    here = complex(*place)
    way = complex(*target) - here
    pull = (
        attraction * way if abs(way) <= fading else attraction * fading * way / abs(way)
    )
    middles = circles[:, 0] + 1j * circles[:, 1]
    rho = np.maximum(np.abs(here - middles) - circles[:, 2], 0.1)
    near = rho < influence
    out = (here - middles) / np.abs(here - middles)
    push = np.sum(near * repulsion * (1 / rho - 1 / influence) / rho**2 * out)
    return np.array([[pull.real, pull.imag], [push.real, push.imag]])


def force_5(place, target, circles, attraction, fading, repulsion, influence):
    difference = target - place
    distance = math.dist(place, target)
    scale = attraction if distance <= fading else attraction * fading / distance
    result = np.zeros((2, 2))
    result[0] = scale * difference
    k = 0
    while k < len(circles):
        centre, radius = circles[k, :2], circles[k, 2]
        to_centre = math.dist(place, centre)
        edge = max(0.1, to_centre - radius)
        if edge < influence:
            gradient = (1 / edge - 1 / influence) / edge / edge
            result[1] += repulsion * gradient * (place - centre) / to_centre
        k += 1
    return result


def force_6(place, target, circles, attraction, fading, repulsion, influence):
    def attract():
        angle = np.arctan2(target[1] - place[1], target[0] - place[0])
        strength = attraction * min(np.hypot(*(target - place)), fading)
        return strength * np.array([np.cos(angle), np.sin(angle)])

    def repel(circle):
        angle = np.arctan2(place[1] - circle[1], place[0] - circle[0])
        rho = np.hypot(place[0] - circle[0], place[1] - circle[1]) - circle[2]
        rho = min(max(rho, 0.1), influence)
        strength = repulsion * (1 / rho - 1 / influence) / rho**2
        return strength * np.array([np.cos(angle), np.sin(angle)])

    return np.array([attract(), sum((repel(c) for c in circles), np.zeros(2))])


def force_7(place, target, circles, attraction, fading, repulsion, influence):
    to_target = target - place
    d = np.sqrt(to_target @ to_target)
    pull = attraction * to_target / max(d / fading, 1.0)
    offset = place[None, :] - circles[:, 0:2]
    m = np.linalg.norm(offset, axis=1)
    gap = m - circles[:, 2]
    gap[gap < 0.1] = 0.1
    selected = gap < influence
    offset, m, gap = offset[selected], m[selected], gap[selected]
    size = repulsion * (np.reciprocal(gap) - 1 / influence) * gap**-2.0
    return np.vstack([pull, np.sum(offset * (size / m)[:, np.newaxis], axis=0)])


def force_8(place, target, circles, attraction, fading, repulsion, influence):
    class Circle:
        def __init__(self, row):
            self.middle, self.radius = row[:2], row[2]

        def push(self):
            away = place - self.middle
            length = np.linalg.norm(away)
            rho = np.clip(length - self.radius, 0.1, None)
            if rho >= influence:
                return np.zeros(2)
            return repulsion * (influence - rho) / (influence * rho**3) * away / length

    pushes = [Circle(row).push() for row in circles]
    gap = target - place
    far = np.linalg.norm(gap) > fading
    pull = attraction * gap * (fading / np.linalg.norm(gap) if far else 1.0)
    return np.array([pull, np.sum(pushes, axis=0) if pushes else np.zeros(2)])
