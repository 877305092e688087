"""Chapter 3: learning from demonstration."""

from .backpropagation import (
    CROSS_ENTROPY,
    SQUARED_ERROR,
    Objective,
    backpropagate,
    cross_entropy_cost,
    cross_entropy_gradient,
    squared_error_cost,
    squared_error_gradient,
)
from .dagger import Aggregation, advised, dagger
from .demonstrations import Demonstrations, Expert, join, record
from .experts import ComputerExpert, demonstrate
from .history import Training, accuracy
from .human import PathFollower, demonstrate_by_hand, path_clearance, sketch, smooth_path
from .imitation import labelled_states, learn_policy
from .neighbours import NeighbourPolicy, learn_neighbours
from .network import Network, propagate, random_network, sigmoid, sigmoid_slope, stacked
from .overview import Overview, overview
from .planning import GridPlan, Plan, plan, plan_on_grid
from .policy import NetworkPolicy
from .storage import load_demonstrations, save_demonstrations
from .training import fit, gradient_descent, lbfgs, one_hot
from .weights import Weights, load_weights, save_weights

__all__ = [
    "CROSS_ENTROPY",
    "SQUARED_ERROR",
    "Aggregation",
    "ComputerExpert",
    "Demonstrations",
    "Expert",
    "GridPlan",
    "NeighbourPolicy",
    "Network",
    "NetworkPolicy",
    "Objective",
    "Overview",
    "PathFollower",
    "Plan",
    "Training",
    "Weights",
    "accuracy",
    "advised",
    "backpropagate",
    "cross_entropy_cost",
    "cross_entropy_gradient",
    "dagger",
    "demonstrate",
    "demonstrate_by_hand",
    "fit",
    "gradient_descent",
    "join",
    "labelled_states",
    "lbfgs",
    "learn_neighbours",
    "learn_policy",
    "load_demonstrations",
    "load_weights",
    "one_hot",
    "overview",
    "path_clearance",
    "plan",
    "plan_on_grid",
    "propagate",
    "random_network",
    "record",
    "save_demonstrations",
    "save_weights",
    "sigmoid",
    "sigmoid_slope",
    "sketch",
    "smooth_path",
    "squared_error_cost",
    "squared_error_gradient",
    "stacked",
]
