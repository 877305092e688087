"""Chapter 3: learning from demonstration."""

from .astar import grid_astar, modified_astar
from .behaviour_cloning import behaviour_cloning, labelled_states, learn_policy
from .computer_expert import ComputerExpert, demonstrate
from .dagger import DaggerResult, collect_with_expert_labels, dagger
from .dataset_summary import DatasetSummary, summarise_dataset
from .demonstration_files import load_demonstrations, save_demonstrations
from .demonstrations import Demonstrations, Expert, concatenate, record_demonstrations
from .human_expert import (
    PathFollower,
    demonstrate_by_hand,
    path_clearance,
    sketch,
    smooth_path,
)
from .minari_datasets import from_minari, to_minari
from .nearest_neighbours import NeighbourPolicy, learn_neighbours
from .planning import GridPlan, Plan, plan, plan_on_grid

__all__ = [
    "ComputerExpert",
    "DaggerResult",
    "DatasetSummary",
    "Demonstrations",
    "Expert",
    "GridPlan",
    "NeighbourPolicy",
    "PathFollower",
    "Plan",
    "behaviour_cloning",
    "collect_with_expert_labels",
    "concatenate",
    "dagger",
    "demonstrate",
    "demonstrate_by_hand",
    "from_minari",
    "grid_astar",
    "labelled_states",
    "learn_neighbours",
    "learn_policy",
    "load_demonstrations",
    "modified_astar",
    "path_clearance",
    "plan",
    "plan_on_grid",
    "record_demonstrations",
    "save_demonstrations",
    "sketch",
    "smooth_path",
    "summarise_dataset",
    "to_minari",
]
