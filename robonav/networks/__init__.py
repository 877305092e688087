"""The multilayer perceptron: its passes, its training and its use as a policy (sections 3.3 and 3.4)."""

from ._interface import (
    batch_gradient_descent,
    cross_entropy_cost,
    cross_entropy_gradient,
    random_network,
    squared_error_cost,
    squared_error_gradient,
    stochastic_gradient_descent,
)
from .costs import CROSS_ENTROPY, SQUARED_ERROR, Objective
from .multilayer_perceptron import (
    Gradient,
    Network,
    backpropagate,
    gradient_descent_step,
    propagate,
    sigmoid,
    sigmoid_slope,
    squared_error,
)
from .network_stack import NetworkStack, stacked
from .onnx_files import save_onnx
from .optimisers import fit, gradient_descent, lbfgs, one_hot
from .policy import NetworkPolicy
from .training_history import TrainingHistory, network_accuracy
from .unit_by_unit import (
    action_probabilities,
    backpropagate_by_units,
    forward_by_units,
)
from .weights import Weights, load_weights, save_weights

__all__ = [
    "CROSS_ENTROPY",
    "SQUARED_ERROR",
    "Gradient",
    "Network",
    "NetworkPolicy",
    "NetworkStack",
    "Objective",
    "TrainingHistory",
    "Weights",
    "action_probabilities",
    "backpropagate",
    "backpropagate_by_units",
    "batch_gradient_descent",
    "cross_entropy_cost",
    "cross_entropy_gradient",
    "fit",
    "forward_by_units",
    "gradient_descent",
    "gradient_descent_step",
    "lbfgs",
    "load_weights",
    "network_accuracy",
    "one_hot",
    "propagate",
    "random_network",
    "save_onnx",
    "save_weights",
    "sigmoid",
    "sigmoid_slope",
    "squared_error",
    "squared_error_cost",
    "squared_error_gradient",
    "stacked",
    "stochastic_gradient_descent",
]
