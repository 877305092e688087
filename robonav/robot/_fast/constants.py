"""Constants of worlds, sensing and motion. Metres, radians counter-clockwise, seconds."""

from __future__ import annotations

import math

import numpy as np

NOTHING, CIRCLE, RECTANGLE = 0, 1, 2
RUNNING, ARRIVED, COLLIDED, OUT_OF_STEPS = 0, 1, 2, 3
SENSORS = 9
SECTOR = math.radians(40)
SENSOR_RANGE = 10.0  # d_bou
COLLISION_DISTANCE = 1.0  # d_col: degree of danger 7
ARRIVAL_DISTANCE = 3.0  # d_win
BACKWARD, TO_TARGET, TO_SECTOR = 5, 6, 7
NO_REFLEX = -1  # what the reflex answers where the policy decides
DIRECTION = "sector"  # how well a reflex knows the direction of the target by default; the other choice is "exact"
TURNS = np.radians([0.0, 30.0, 60.0, -30.0, -60.0, 0.0])  # F, L30, L60, R30, R60, B

TURN_PROBABILITY = (
    0.1  # a moving obstacle draws a new heading in about every tenth step
)
SPARE = 2.0  # clearance a drawn map keeps along some way to the target
KEEP_OUT = 6.0  # no obstacle this close to start or target
REDRAWS = 100  # places tried for one obstacle before the map is given up
SMALLEST, LARGEST = 1.5, 4.0  # circle radius
SHORTEST, LONGEST = 3.0, 8.0  # rectangle side
