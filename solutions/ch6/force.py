r"""The potential field of the page pulls the robot to its target with the same force
everywhere, since the robot does not sense how far the target is. A robot that knows its
place can do better. Let the potential of the target be $\frac{\zeta}{2} d^2$ up to a
distance $d^*$, and $\zeta (d^* d - \frac12 {d^*}^2)$ beyond: then the target pulls with
the strength $\zeta \min(d, d^*)$, which fades on arrival, so that the robot does not
overshoot. At the target itself there is no force.

Obstacles are circles. At the distance $\rho$ from the *edge* of a circle, the potential
of the page, $\frac{\eta}{2} (1/\rho - 1/\rho_0)^2$, pushes the robot away from the
middle of the circle; at $\rho_0$ and beyond it does not. If the robot is nearer to an
edge than 0.1 m, or inside a circle, let $\rho$ be 0.1 m. All circles in reach push, and
their forces add up.
"""

import numpy as np
from numpy.typing import NDArray


def force(
    place: NDArray[np.float64],
    target: NDArray[np.float64],
    circles: NDArray[np.float64],
    attraction: float,
    fading: float,
    repulsion: float,
    influence: float,
) -> NDArray[np.float64]:
    """The forces on a robot in a potential field.

    Parameters
    ----------
    place, target : (2,), x and y of the robot and of its target, in metres.
    circles : (N, 3), x, y and radius of each obstacle; no middle is the robot's place.
    attraction : zeta, positive.
    fading : the distance d* in metres, positive.
    repulsion : eta, positive.
    influence : the distance rho_0 in metres, more than 0.1.

    Returns
    -------
    (2, 2), x and y of the attraction, and below it those of the repulsion.
    """
    ### BEGIN SOLUTION
    to_target = target - place
    d = np.hypot(*to_target)
    pull = attraction * to_target * (min(d, fading) / d if d > 0 else 0.0)
    away = place - circles[:, :2]
    middle = np.hypot(away[:, 0], away[:, 1])
    rho = np.clip(middle - circles[:, 2], 0.1, influence)
    strength = repulsion * (1 - rho / influence) / rho**3
    push = (strength / middle) @ away
    return np.array([pull, push])
    ### END SOLUTION
