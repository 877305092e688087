"""Drills of chapter 2, a file for each page. Importing a file registers its drills."""

from . import decision_processes as decision_processes
from . import dynamic_programming as dynamic_programming
from . import linear_values as linear_values
from . import model_free_learning as model_free_learning
from . import partial_observation as partial_observation
from . import playground as playground
from . import prediction as prediction
from . import robot as robot
