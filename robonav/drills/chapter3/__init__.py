"""Drills of chapter 3, a file for each page. Importing a file registers its drills."""

from . import a_star as a_star
from . import demonstrations as demonstrations
from . import lfd_results as lfd_results
from . import neural_network as neural_network
from . import policy_learning as policy_learning
