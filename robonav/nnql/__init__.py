"""Chapter 4: neural-network Q-learning, its rivals, and the navigation task on which they are compared."""

from .dqn import double_dqn_loss, dqn
from .nfq import fit_q_values, nfq
from .nnql import navigate_greedily, nnql, online
from .replay_buffer import ReplayBuffer
from .reward import (
    COZY_DISTANCE,
    Property,
    property_at,
    reward,
    reward_row,
    state_property,
)
from .schedules import geometric_schedule, greedy_policy, softmax_policy
from .task import STARTS, TARGETS, NavigationTask, q_network
from .training import METHODS, TrainingResult, train, weight_changes
from .updates import (
    clip,
    cross_entropy,
    descend,
    network_error,
    q_targets,
    shift,
    stochastic_gradient_descent,
)

__all__ = [
    "COZY_DISTANCE",
    "METHODS",
    "STARTS",
    "TARGETS",
    "NavigationTask",
    "Property",
    "ReplayBuffer",
    "TrainingResult",
    "clip",
    "cross_entropy",
    "descend",
    "double_dqn_loss",
    "dqn",
    "fit_q_values",
    "geometric_schedule",
    "greedy_policy",
    "navigate_greedily",
    "network_error",
    "nfq",
    "nnql",
    "online",
    "property_at",
    "q_network",
    "q_targets",
    "reward",
    "reward_row",
    "shift",
    "softmax_policy",
    "state_property",
    "stochastic_gradient_descent",
    "train",
    "weight_changes",
]
