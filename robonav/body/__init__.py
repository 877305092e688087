"""Chapter 6, a body: the robot of section 2.5 in MuJoCo, with motors, wheels that slip, and range finders.

It needs the extra ``body``.
"""

from .control import follow, limited_reference, odometry, reference, wheel_speeds
from .model import Body, build, model_file
from .simulator import BodySimulator
from .training import ideal, randomised, train_in

__all__ = [
    "Body",
    "BodySimulator",
    "build",
    "follow",
    "ideal",
    "limited_reference",
    "model_file",
    "odometry",
    "randomised",
    "reference",
    "train_in",
    "wheel_speeds",
]
