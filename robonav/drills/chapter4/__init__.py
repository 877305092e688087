"""Drills of chapter 4, a file for each page. Importing a file registers its drills."""

from . import my_robot_circles as my_robot_circles
from . import networks_for_q as networks_for_q
from . import nnql as nnql
from . import nnql_comparison as nnql_comparison
from . import reward_and_exploration as reward_and_exploration
