"""Chapter 6, richer sensing: rings of any number of sectors, a picture, and the networks that read them."""

from .convolution import (
    circular_convolution,
    picture_convolution,
    weights_of_layers,
)
from .dagger import (
    Examples,
    dagger_with_sensor,
    labelled_examples,
    randomised_simulators,
)
from .networks import (
    SensorNetwork,
    fully_connected,
    picture_network,
    ring_network,
)
from .policies import SensorPolicy
from .sensors import Picture, Ring, picture_around, sector_ranges, shapes_of

__all__ = [
    "Examples",
    "Picture",
    "Ring",
    "SensorNetwork",
    "SensorPolicy",
    "circular_convolution",
    "dagger_with_sensor",
    "fully_connected",
    "labelled_examples",
    "picture_around",
    "picture_convolution",
    "picture_network",
    "randomised_simulators",
    "ring_network",
    "sector_ranges",
    "shapes_of",
    "weights_of_layers",
]
