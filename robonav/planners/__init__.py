"""Chapter 6: planners that learn nothing."""

from .bug import Bug, BugMemory, bug
from .dynamic_window import DynamicWindow, dynamic_window
from .known_map import KnownMap
from .potential_field import PotentialField, potential_field
from .sectors import action_towards, free_way, target_bearing
from .vector_field_histogram import (
    VectorFieldHistogram,
    polar_histogram,
    vector_field_histogram,
)

__all__ = [
    "Bug",
    "BugMemory",
    "DynamicWindow",
    "KnownMap",
    "PotentialField",
    "VectorFieldHistogram",
    "action_towards",
    "bug",
    "dynamic_window",
    "free_way",
    "polar_histogram",
    "potential_field",
    "target_bearing",
    "vector_field_histogram",
]
