"""The simulator's compiled core: every loop over robots and obstacles.

Kernels are serial and release the GIL. :func:`in_threads` gives each thread its own range of worlds, so results never
depend on the threads. Every kernel treats each world alone: a batch of one gives the same bits as the same world in a
batch of a million.

Shapes: N worlds, K robots among them, M obstacle slots a world. Metres, radians counter-clockwise, seconds; one step
is one second.
"""

from .constants import (
    ARRIVAL_DISTANCE,
    ARRIVED,
    BACKWARD,
    CIRCLE,
    COLLIDED,
    COLLISION_DISTANCE,
    NO_REFLEX,
    NOTHING,
    OUT_OF_STEPS,
    RECTANGLE,
    RUNNING,
    SECTOR,
    SENSOR_RANGE,
    SENSORS,
    SPARE,
    TO_SECTOR,
    TO_TARGET,
    TURNS,
)
from .drawing import draw_worlds, reachable
from .geometry import micrometres, swept_clearance
from .motion import drift, second, step
from .random_numbers import DRIFTING, MAX_OBSTACLES, uniform
from .sensing import reflexes, sense
from .threads import in_threads

__all__ = [
    "ARRIVAL_DISTANCE",
    "ARRIVED",
    "BACKWARD",
    "CIRCLE",
    "COLLIDED",
    "COLLISION_DISTANCE",
    "DRIFTING",
    "MAX_OBSTACLES",
    "NOTHING",
    "NO_REFLEX",
    "OUT_OF_STEPS",
    "RECTANGLE",
    "RUNNING",
    "SECTOR",
    "SENSORS",
    "SENSOR_RANGE",
    "SPARE",
    "TO_SECTOR",
    "TO_TARGET",
    "TURNS",
    "draw_worlds",
    "drift",
    "in_threads",
    "micrometres",
    "reachable",
    "reflexes",
    "second",
    "sense",
    "step",
    "swept_clearance",
    "uniform",
]
