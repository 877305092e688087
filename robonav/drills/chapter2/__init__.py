"""Drills of chapter 2, a file for each page. Importing a file registers its drills."""

from . import decision_processes as decision_processes
from . import dynamic_programming as dynamic_programming
from . import model_free_learning as model_free_learning
from . import partial_observation as partial_observation
from . import playground as playground
from . import robot as robot
