"""The multilayer perceptron: its passes, its training and its use as a policy (sections 3.3 and 3.4)."""

from .backpropagation import (
    CROSS_ENTROPY,
    SQUARED_ERROR,
    Objective,
    backpropagate,
    backpropagate_by_units,
    cross_entropy_cost,
    cross_entropy_gradient,
    squared_error,
    squared_error_cost,
    squared_error_gradient,
)
from .multilayer_perceptron import (
    Network,
    action_probabilities,
    forward_by_units,
    propagate,
    random_network,
    sigmoid,
    sigmoid_slope,
    stacked,
)
from .optimisers import descend, fit, gradient_descent, lbfgs, one_hot
from .policy import NetworkPolicy
from .training_history import TrainingHistory, accuracy
from .weights import Weights, load_weights, save_weights

__all__ = [
    "CROSS_ENTROPY",
    "SQUARED_ERROR",
    "Network",
    "NetworkPolicy",
    "Objective",
    "TrainingHistory",
    "Weights",
    "accuracy",
    "action_probabilities",
    "backpropagate",
    "backpropagate_by_units",
    "cross_entropy_cost",
    "cross_entropy_gradient",
    "descend",
    "fit",
    "forward_by_units",
    "gradient_descent",
    "lbfgs",
    "load_weights",
    "one_hot",
    "propagate",
    "random_network",
    "save_weights",
    "sigmoid",
    "sigmoid_slope",
    "squared_error",
    "squared_error_cost",
    "squared_error_gradient",
    "stacked",
]
