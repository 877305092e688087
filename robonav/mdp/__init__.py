"""Chapter 2: finite MDPs, planning, tabular learning, partial observation, gridworlds."""

from .asynchronous import in_place_value_iteration, prioritized_sweeping
from .belief_planning import (
    AlphaVectors,
    point_based_value_iteration,
    qmdp,
    spread_beliefs,
)
from .belief_rollout import BeliefTrajectory, belief_rollout
from .dynamic_programming import (
    modified_policy_iteration,
    policy_iteration,
    value_iteration,
)
from .episodes import Trajectory, discounted_return, mean_return, rollouts
from .evaluation import (
    EvaluationResult,
    expected_return,
    iterative_policy_evaluation,
    policy_evaluation,
)
from .exploration import (
    Schedule,
    epsilon_greedy,
    exponential_decay,
    harmonic_decay,
    linear_decay,
    polynomial_decay,
)
from .features import Features, OneHot, Tiles, with_bias
from .finite_horizon import (
    FiniteHorizonSolution,
    backward_induction,
    finite_horizon_evaluation,
)
from .generalized_policy_iteration import GPIHistory, generalized_policy_iteration
from .gridworld import Cell, GridEnvironment, GridWorld, four_by_three
from .learning_results import ControlResult, LinearControlResult, PredictionResult
from .linear import linear_q_learning, linear_sarsa
from .localisation import Localiser, PoseGrid, RangeSensor, pose_transitions
from .models import FiniteMDP, expected_rewards
from .monte_carlo import monte_carlo_control, monte_carlo_prediction
from .policies import greedy_action_mask, greedy_mixture
from .pomdp import (
    POMDP,
    BeliefMDP,
    bayes,
    entropy,
)
from .small_pomdps import corridor, fork, tiger, without_sensing
from .solutions import Solution
from .temporal_difference import (
    expected_sarsa,
    q_learning,
    sarsa,
    td_prediction,
)
from .value_functions import (
    advantage,
    bellman_action_value_operator,
    bellman_optimality_operator,
    bellman_policy_operator,
    best_values_of_any_policy,
    is_optimal,
    policy_action_values,
)

__all__ = [
    "POMDP",
    "AlphaVectors",
    "BeliefMDP",
    "BeliefTrajectory",
    "Cell",
    "ControlResult",
    "EvaluationResult",
    "Features",
    "FiniteHorizonSolution",
    "FiniteMDP",
    "GPIHistory",
    "GridEnvironment",
    "GridWorld",
    "LinearControlResult",
    "Localiser",
    "OneHot",
    "PoseGrid",
    "PredictionResult",
    "RangeSensor",
    "Schedule",
    "Solution",
    "Tiles",
    "Trajectory",
    "advantage",
    "backward_induction",
    "bayes",
    "belief_rollout",
    "bellman_action_value_operator",
    "bellman_optimality_operator",
    "bellman_policy_operator",
    "best_values_of_any_policy",
    "corridor",
    "discounted_return",
    "entropy",
    "epsilon_greedy",
    "expected_return",
    "expected_rewards",
    "expected_sarsa",
    "exponential_decay",
    "finite_horizon_evaluation",
    "fork",
    "four_by_three",
    "generalized_policy_iteration",
    "greedy_action_mask",
    "greedy_mixture",
    "harmonic_decay",
    "in_place_value_iteration",
    "is_optimal",
    "iterative_policy_evaluation",
    "linear_decay",
    "linear_q_learning",
    "linear_sarsa",
    "mean_return",
    "modified_policy_iteration",
    "monte_carlo_control",
    "monte_carlo_prediction",
    "point_based_value_iteration",
    "policy_action_values",
    "policy_evaluation",
    "policy_iteration",
    "polynomial_decay",
    "pose_transitions",
    "prioritized_sweeping",
    "q_learning",
    "qmdp",
    "rollouts",
    "sarsa",
    "spread_beliefs",
    "td_prediction",
    "tiger",
    "value_iteration",
    "with_bias",
    "without_sensing",
]
