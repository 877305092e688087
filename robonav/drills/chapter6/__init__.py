"""Drills of chapter 6. Importing a file registers its drills."""

from . import adversarial_imitation as adversarial_imitation
from . import body as body
from . import conclusions as conclusions
from . import deep_reinforcement_learning as deep_reinforcement_learning
from . import memory as memory
from . import methods_compared as methods_compared
from . import planners as planners
from . import sensing as sensing
from . import several_robots as several_robots
