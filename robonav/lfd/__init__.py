"""Chapter 3: learning from demonstration."""

from .astar import GridPlan, Plan, plan, plan_on_grid
from .behaviour_cloning import labelled_states, learn_policy
from .computer_expert import ComputerExpert, demonstrate
from .dagger import Aggregation, advised, dagger
from .dataset_summary import Overview, overview
from .demonstration_files import load_demonstrations, save_demonstrations
from .demonstrations import Demonstrations, Expert, join, record
from .human_expert import (
    PathFollower,
    demonstrate_by_hand,
    path_clearance,
    sketch,
    smooth_path,
)
from .nearest_neighbours import NeighbourPolicy, learn_neighbours

__all__ = [
    "Aggregation",
    "ComputerExpert",
    "Demonstrations",
    "Expert",
    "GridPlan",
    "NeighbourPolicy",
    "Overview",
    "PathFollower",
    "Plan",
    "advised",
    "dagger",
    "demonstrate",
    "demonstrate_by_hand",
    "join",
    "labelled_states",
    "learn_neighbours",
    "learn_policy",
    "load_demonstrations",
    "overview",
    "path_clearance",
    "plan",
    "plan_on_grid",
    "record",
    "save_demonstrations",
    "sketch",
    "smooth_path",
]
