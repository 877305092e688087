"""Chapter 5: neural inverse reinforcement learning, the three methods beside it, and what came beside them."""

from .apprenticeship import (
    Apprenticeship,
    max_margin_method,
    nearest_mixture,
    project,
    projection_method,
)
from .benchmark_mdps import TERRAIN_KINDS, TRUE_WEIGHTS, terrain
from .boltzmann import boltzmann
from .feature_expectations import (
    discounted_feature_sums,
    empirical_expectations,
    feature_expectations,
    initial_expectations,
    mean_by_pair,
)
from .features import all_action_features, state_action_features
from .max_margin import Margin, maximum_margin, maximum_margin_subgradient
from .maximum_entropy import (
    MaximumEntropy,
    SoftSolution,
    maximum_entropy,
    soft_maximum,
    soft_value_iteration,
)
from .methods import (
    METHODS,
    Learned,
    from_all_states,
    from_initial_state,
    heuristic_estimate,
    learn,
    learn_under_reward,
    lstd_estimate,
)
from .model_selection import accuracy, balanced_accuracy
from .nirl import Found, History, nirl, train_under_reward
from .policy_improvement import (
    NEUTRAL_TERMINAL_VALUES,
    SURVIVAL_BONUS,
    ZERO_TERMINAL_VALUES,
    ReplaySGD,
    SingleGradientStep,
    sarsa_targets,
    scale_to_unit_interval,
    transition_rewards,
)
from .refinement import Refined, map_uniform_prior, most_frequent
from .relative_entropy import (
    RelativeEntropy,
    dual_gradient,
    hoeffding_slack,
    importance,
    relative_entropy,
)
from .reward_free_mdp import RewardFreeMDP, Walks
from .reward_update import LeastSquaresReward, SubgradientMaxMargin, balance, contrast
from .scirl import Classification, heuristic_mu, lstd_mu, structured_classification
from .tasks import Course, RobotTask, TabularTask
from .transitions import ENCODER, Steps, expert_transitions

__all__ = [
    "ENCODER",
    "METHODS",
    "NEUTRAL_TERMINAL_VALUES",
    "SURVIVAL_BONUS",
    "TERRAIN_KINDS",
    "TRUE_WEIGHTS",
    "ZERO_TERMINAL_VALUES",
    "Apprenticeship",
    "Classification",
    "Course",
    "Found",
    "History",
    "Learned",
    "LeastSquaresReward",
    "Margin",
    "MaximumEntropy",
    "Refined",
    "RelativeEntropy",
    "ReplaySGD",
    "RewardFreeMDP",
    "RobotTask",
    "SingleGradientStep",
    "SoftSolution",
    "Steps",
    "SubgradientMaxMargin",
    "TabularTask",
    "Walks",
    "accuracy",
    "all_action_features",
    "balance",
    "balanced_accuracy",
    "boltzmann",
    "contrast",
    "discounted_feature_sums",
    "dual_gradient",
    "empirical_expectations",
    "expert_transitions",
    "feature_expectations",
    "from_all_states",
    "from_initial_state",
    "heuristic_estimate",
    "heuristic_mu",
    "hoeffding_slack",
    "importance",
    "initial_expectations",
    "learn",
    "learn_under_reward",
    "lstd_estimate",
    "lstd_mu",
    "map_uniform_prior",
    "max_margin_method",
    "maximum_entropy",
    "maximum_margin",
    "maximum_margin_subgradient",
    "mean_by_pair",
    "most_frequent",
    "nearest_mixture",
    "nirl",
    "project",
    "projection_method",
    "relative_entropy",
    "sarsa_targets",
    "scale_to_unit_interval",
    "soft_maximum",
    "soft_value_iteration",
    "state_action_features",
    "structured_classification",
    "terrain",
    "train_under_reward",
    "transition_rewards",
]
