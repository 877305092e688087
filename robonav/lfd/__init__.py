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
from .demonstrations import Demonstrations, Expert, record
from .experts import ComputerExpert, demonstrate
from .history import Training, accuracy
from .imitation import labelled_states, learn_policy
from .network import Network, propagate, random_network, sigmoid, sigmoid_slope, stacked
from .planning import GridPlan, Plan, plan, plan_on_grid
from .policy import NetworkPolicy
from .storage import load_demonstrations, save_demonstrations
from .training import fit, gradient_descent, lbfgs, one_hot
from .weights import Weights, load_weights, save_weights

__all__ = [
    "CROSS_ENTROPY",
    "SQUARED_ERROR",
    "ComputerExpert",
    "Demonstrations",
    "Expert",
    "GridPlan",
    "Network",
    "NetworkPolicy",
    "Objective",
    "Plan",
    "Training",
    "Weights",
    "accuracy",
    "backpropagate",
    "cross_entropy_cost",
    "cross_entropy_gradient",
    "demonstrate",
    "fit",
    "gradient_descent",
    "labelled_states",
    "lbfgs",
    "learn_policy",
    "load_demonstrations",
    "load_weights",
    "one_hot",
    "plan",
    "plan_on_grid",
    "propagate",
    "random_network",
    "record",
    "save_demonstrations",
    "save_weights",
    "sigmoid",
    "sigmoid_slope",
    "squared_error_cost",
    "squared_error_gradient",
    "stacked",
]
