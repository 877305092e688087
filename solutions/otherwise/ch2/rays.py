"""2.11 ray by ray, with the quadratic equation of each circle."""

import math


def rays(pose, centres, radii, size, reach):
    x, y, heading = (float(number) for number in pose)
    readings = []
    for k in range(9):
        dx, dy = (
            math.cos(heading + k * 2 * math.pi / 9),
            math.sin(heading + k * 2 * math.pi / 9),
        )
        lengths = []
        for (cx, cy), r in zip(centres, radii):
            b = (x - cx) * dx + (y - cy) * dy
            c = (x - cx) ** 2 + (y - cy) ** 2 - r * r
            if b < 0 and b * b > c:
                lengths.append(-b - math.sqrt(b * b - c))
        for place, step in ((x, dx), (y, dy)):
            if step > 0:
                lengths.append((size - place) / step)
            elif step < 0:
                lengths.append(-place / step)
        nearest = min(lengths)
        if nearest > reach:
            nearest = reach
        readings.append(nearest)
    return readings
