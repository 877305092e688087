"""Chapter 5: neural inverse reinforcement learning, the three methods beside it, and what came beside them."""

from .apprenticeship import (
    Apprenticeship,
    by_max_margin,
    by_projection,
    nearest_mixture,
    project,
)
from .benchmark_mdps import KINDS, TRUTH, terrain
from .boltzmann import boltzmann
from .feature_expectations import (
    average_by,
    discounted_to_go,
    empirical_expectations,
    feature_expectations,
    start_expectations,
)
from .features import action_blocks, chosen_block
from .max_margin import Margin, widest_margin, widest_margin_subgradient
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
    by_heuristic,
    by_lstd,
    from_everywhere,
    from_start,
    learn,
    learn_under,
)
from .model_selection import accuracy, balanced_accuracy
from .nirl import Found, History, nirl, practise
from .policy_improvement import (
    BONUS,
    NEUTRAL,
    NOTHING,
    OneStep,
    SampledDescent,
    into_unit,
    rewards_of,
    sarsa_targets,
)
from .refinement import Refined, most_frequent, most_telling
from .relative_entropy import (
    RelativeEntropy,
    dual_gradient,
    hoeffding_slack,
    importance,
    relative_entropy,
)
from .reward_free_mdp import FeaturedMDP, Walks
from .reward_update import ByContrast, ByEquation514, balance, contrast
from .scirl import Classification, lstd_mu, shown_only, structured_classification
from .tasks import Course, ModelCourse, RobotCourse
from .transitions import ENCODER, Steps, shown_steps

__all__ = [
    "BONUS",
    "ENCODER",
    "KINDS",
    "METHODS",
    "NEUTRAL",
    "NOTHING",
    "TRUTH",
    "Apprenticeship",
    "ByContrast",
    "ByEquation514",
    "Classification",
    "Course",
    "FeaturedMDP",
    "Found",
    "History",
    "Learned",
    "Margin",
    "MaximumEntropy",
    "ModelCourse",
    "OneStep",
    "Refined",
    "RelativeEntropy",
    "RobotCourse",
    "SampledDescent",
    "SoftSolution",
    "Steps",
    "Walks",
    "accuracy",
    "action_blocks",
    "average_by",
    "balance",
    "balanced_accuracy",
    "boltzmann",
    "by_heuristic",
    "by_lstd",
    "by_max_margin",
    "by_projection",
    "chosen_block",
    "contrast",
    "discounted_to_go",
    "dual_gradient",
    "empirical_expectations",
    "feature_expectations",
    "from_everywhere",
    "from_start",
    "hoeffding_slack",
    "importance",
    "into_unit",
    "learn",
    "learn_under",
    "lstd_mu",
    "maximum_entropy",
    "most_frequent",
    "most_telling",
    "nearest_mixture",
    "nirl",
    "practise",
    "project",
    "relative_entropy",
    "rewards_of",
    "sarsa_targets",
    "shown_only",
    "shown_steps",
    "soft_maximum",
    "soft_value_iteration",
    "start_expectations",
    "structured_classification",
    "terrain",
    "widest_margin",
    "widest_margin_subgradient",
]
