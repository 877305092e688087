"""The artificial potential field (Khatib 1986)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.robot import Sensing
from robonav.validation import check_positive, check_real

from .sectors import CENTRES, Floats, action_towards, target_bearing

NEAREST = 0.1  # metres: a nearer obstacle repels like one at this distance


def potential_field(
    sensing: Sensing, *, repulsion: float, influence: float
) -> tuple[Floats, Floats]:
    """Forces of an artificial potential field (Khatib 1986).

    The target attracts the robot with a force of 1, whatever its distance, since the robot senses only its sector. A
    reading rho below the distance of influence rho_0 repels it with the force that belongs to the potential
    repulsion / 2 (1 / rho - 1 / rho_0)^2. The obstacle is taken to lie at the middle of its sector.

    Parameters
    ----------
    sensing : Sensing
        What N robots sense.
    repulsion : float
        Strength eta of the repulsion.
    influence : float
        Distance rho_0 in metres beyond which an obstacle repels no more, at most 10.

    Returns
    -------
    attraction : (N, 2) array
        Force of the target: components ahead and to the left.
    repulsions : (N, 9, 2) array
        Force of what each sector reads.

    Examples
    --------
    >>> from robonav.planners import potential_field
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(54, 50, 2)], target=(90, 50)), [(50, 50, 0)])
    >>> attraction, repulsions = potential_field(sensing, repulsion=8.0, influence=4.0)
    >>> attraction[0].tolist(), repulsions[0, 0].tolist()
    ([1.0, 0.0], [-0.5, -0.0])
    """
    target = target_bearing(sensing)
    attraction = np.column_stack([np.cos(target), np.sin(target)])
    rho = np.clip(sensing.ranges, NEAREST, influence)
    strength = repulsion * (1 / rho - 1 / influence) / rho**2
    away = -np.column_stack([np.cos(CENTRES), np.sin(CENTRES)])
    return attraction, strength[:, :, None] * away


@dataclass(frozen=True)
class PotentialField:
    """A policy that follows the forces of an artificial potential field.

    The forces accelerate the robot: they are added to its velocity, which points ahead. Of the five turns the policy
    takes the one that is nearest to the sum. It knows the nine ranges and the sector of the target, and remembers
    nothing.

    Parameters
    ----------
    repulsion, influence : float
        As in :func:`potential_field`.
    inertia : float
        Length of the velocity to which the forces are added, relative to the attraction. With 0 only the forces count.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> from robonav.planners import PotentialField
    >>> from robonav.robot import navigate, random_worlds
    >>> float(navigate(PotentialField(), random_worlds(100, obstacles=10, seed=1)).success.mean())
    0.99
    """

    repulsion: float = 80.0
    influence: float = 10.0
    inertia: float = 1.0

    def __post_init__(self) -> None:
        check_real("repulsion", self.repulsion, at_least=0)
        check_positive("influence", self.influence)
        check_real("inertia", self.inertia, at_least=0)

    def __call__(self, sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        """Return the actions (N,) of N robots."""
        attraction, repulsions = potential_field(
            sensing, repulsion=self.repulsion, influence=self.influence
        )
        force = attraction + repulsions.sum(axis=1)
        bearing = np.arctan2(force[:, 1], force[:, 0] + self.inertia)
        return action_towards(bearing, back=False)
