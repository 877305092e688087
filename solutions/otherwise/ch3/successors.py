"""3.4 by solving for the moment at which a step comes nearest."""

import cmath
import math


def successors(pose, speed, turn_cost, centres, radii, size, margin):
    x, y, heading = pose.tolist()
    here, found = complex(x, y), []
    for action, turn in enumerate(
        [0, math.pi / 6, math.pi / 3, -math.pi / 6, -math.pi / 3]
    ):
        step = cmath.rect(speed, heading + turn)
        there = here + step
        free = all(
            margin <= v <= size - margin
            for p in (here, there)
            for v in (p.real, p.imag)
        )
        for (cx, cy), radius in zip(centres.tolist(), radii.tolist()):
            to = complex(cx, cy) - here
            moment = (to * step.conjugate()).real / speed**2
            near = here if moment < 0 else there if moment > 1 else here + moment * step
            free = free and abs(complex(cx, cy) - near) - radius >= margin
        if free:
            found.append(
                [
                    action,
                    there.real,
                    there.imag,
                    cmath.phase(step),
                    speed + turn_cost * abs(turn),
                ]
            )
    import numpy as np

    return np.array(found).reshape(-1, 5)
