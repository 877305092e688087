"""Chapter 5: neural inverse reinforcement learning."""

from .apprenticeship import Apprenticeship, by_max_margin, by_projection, nearest_mixture, project
from .boltzmann import boltzmann
from .expectations import average_by, discounted_to_go, empirical_expectations, feature_expectations, start_expectations
from .featured import FeaturedMDP, Walks
from .features import action_blocks, chosen_block
from .margin import Margin, widest_margin, widest_margin_subgradient
from .max_entropy import MaximumEntropy, SoftSolution, maximum_entropy, soft_maximum, soft_value_iteration
from .refinement import Refined, most_frequent, most_telling
from .relative_entropy import RelativeEntropy, hoeffding_slack, relative_entropy
from .scirl import Classification, lstd_mu, shown_only, structured_classification

__all__ = [
    "Apprenticeship",
    "Classification",
    "FeaturedMDP",
    "Margin",
    "MaximumEntropy",
    "Refined",
    "RelativeEntropy",
    "SoftSolution",
    "Walks",
    "action_blocks",
    "average_by",
    "boltzmann",
    "by_max_margin",
    "by_projection",
    "chosen_block",
    "discounted_to_go",
    "empirical_expectations",
    "feature_expectations",
    "hoeffding_slack",
    "lstd_mu",
    "maximum_entropy",
    "most_frequent",
    "most_telling",
    "nearest_mixture",
    "project",
    "relative_entropy",
    "shown_only",
    "soft_maximum",
    "soft_value_iteration",
    "start_expectations",
    "structured_classification",
    "widest_margin",
    "widest_margin_subgradient",
]
