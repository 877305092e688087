"""Section 2.5: worlds, sensing, motion, and the Gymnasium environments."""

from ._fast import ARRIVAL_DISTANCE, COLLISION_DISTANCE, SENSOR_RANGE
from .encoding import (
    LFD_SENSORS,
    NNQL_SENSORS,
    TARGET_ENCODINGS,
    Encoder,
    degree_of_danger,
    lfd_state,
    nnql_state,
)
from .rollout import REFLEX, Navigation, Policy, freer_side, navigate, straight
from .simulator import (
    OUTCOMES,
    Action,
    Reflex,
    Sensing,
    Simulator,
    neighbour_slip,
    obstacle_tracks,
    sense,
)
from .world_files import format_world, load_worlds, parse_world, save_worlds
from .worlds import (
    Worlds,
    clearance,
    concatenate,
    draw_worlds,
    make_world,
    random_worlds,
    world_keys,
)

__all__ = [
    "ARRIVAL_DISTANCE",
    "COLLISION_DISTANCE",
    "LFD_SENSORS",
    "NNQL_SENSORS",
    "OUTCOMES",
    "REFLEX",
    "SENSOR_RANGE",
    "TARGET_ENCODINGS",
    "Action",
    "Encoder",
    "Navigation",
    "Policy",
    "Reflex",
    "Sensing",
    "Simulator",
    "Worlds",
    "clearance",
    "concatenate",
    "degree_of_danger",
    "draw_worlds",
    "format_world",
    "freer_side",
    "lfd_state",
    "load_worlds",
    "make_world",
    "navigate",
    "neighbour_slip",
    "nnql_state",
    "obstacle_tracks",
    "parse_world",
    "random_worlds",
    "save_worlds",
    "sense",
    "straight",
    "world_keys",
]
