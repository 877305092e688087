"""Chapter 4: neural-network Q-learning, its rivals, and the navigation task on which they are compared."""

from .dqn import (
    ReplayBuffer,
    double_dqn_targets,
    dqn,
    dqn_targets,
    select_action,
    values_taken,
)
from .network_environment import network_environment
from .nfq import collect_episode, nfq, nfq_targets, rprop_fit
from .nnql import navigate_greedily, nnql, online
from .reward import (
    COZY_DISTANCE,
    Property,
    property_at,
    reward,
    reward_row,
    state_property,
)
from .schedules import geometric_schedule, greedy_policy, softmax_policy
from .task import STARTS, TARGETS, NavigationTask, q_network, reflex_acted
from .training import METHODS, TrainingResult, train, weight_changes
from .updates import (
    clip,
    cross_entropy,
    network_error,
    q_targets,
    shift,
    train_on_pairs,
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
    "collect_episode",
    "cross_entropy",
    "double_dqn_targets",
    "dqn",
    "dqn_targets",
    "geometric_schedule",
    "greedy_policy",
    "navigate_greedily",
    "network_environment",
    "network_error",
    "nfq",
    "nfq_targets",
    "nnql",
    "online",
    "property_at",
    "q_network",
    "q_targets",
    "reflex_acted",
    "reward",
    "reward_row",
    "rprop_fit",
    "select_action",
    "shift",
    "softmax_policy",
    "state_property",
    "train",
    "train_on_pairs",
    "values_taken",
    "weight_changes",
]
