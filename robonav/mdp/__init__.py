"""Chapter 2: finite MDPs, planning, tabular learning, partial observation, gridworlds."""

from .belief_planning import (
    AlphaVectors,
    point_based_value_iteration,
    qmdp,
    spread_beliefs,
)
from .dynamic_programming import (
    Solution,
    modified_policy_iteration,
    policy_iteration,
    value_iteration,
)
from .environments import GridEnvironment
from .evaluation import Evaluation, iterative_policy_evaluation, policy_evaluation
from .exploration import (
    Schedule,
    epsilon_greedy,
    exponential_decay,
    harmonic_decay,
    linear_decay,
    polynomial_decay,
)
from .features import Features, OneHot, Tiles
from .gridworld import Cell, GridWorld, four_by_three
from .horizon import FiniteHorizon, backward_induction, horizon_evaluation
from .improvement import Trace, generalized_policy_iteration
from .interaction import Episode, discounted_return, rollouts
from .linear import LinearLearned, linear_q_learning, linear_sarsa, with_constant
from .localisation import Localiser, PoseGrid, RangeSensor, pose_transitions
from .models import FiniteMDP, expected_rewards
from .monte_carlo import monte_carlo_control, monte_carlo_prediction
from .policies import greedy_actions, greedy_mixture
from .pomdp import (
    POMDP,
    BeliefMDP,
    BeliefWalk,
    bayes,
    belief_walk,
    entropy,
    without_sensing,
)
from .small_pomdps import corridor, fork, tiger
from .sweeps import in_place_value_iteration, prioritized_sweeping
from .temporal_difference import (
    Learned,
    Predicted,
    expected_sarsa,
    q_learning,
    sarsa,
    td_prediction,
)
from .values import (
    action_values,
    advantage,
    bellman_action_value_operator,
    bellman_optimality_operator,
    bellman_policy_operator,
    is_optimal,
)

__all__ = [
    "POMDP",
    "AlphaVectors",
    "BeliefMDP",
    "BeliefWalk",
    "Cell",
    "Episode",
    "Evaluation",
    "Features",
    "FiniteHorizon",
    "FiniteMDP",
    "GridEnvironment",
    "GridWorld",
    "Learned",
    "LinearLearned",
    "Localiser",
    "OneHot",
    "PoseGrid",
    "Predicted",
    "RangeSensor",
    "Schedule",
    "Solution",
    "Tiles",
    "Trace",
    "action_values",
    "advantage",
    "backward_induction",
    "bayes",
    "belief_walk",
    "bellman_action_value_operator",
    "bellman_optimality_operator",
    "bellman_policy_operator",
    "corridor",
    "discounted_return",
    "entropy",
    "epsilon_greedy",
    "expected_rewards",
    "expected_sarsa",
    "exponential_decay",
    "fork",
    "four_by_three",
    "generalized_policy_iteration",
    "greedy_actions",
    "greedy_mixture",
    "harmonic_decay",
    "horizon_evaluation",
    "in_place_value_iteration",
    "is_optimal",
    "iterative_policy_evaluation",
    "linear_decay",
    "linear_q_learning",
    "linear_sarsa",
    "modified_policy_iteration",
    "monte_carlo_control",
    "monte_carlo_prediction",
    "point_based_value_iteration",
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
    "with_constant",
    "without_sensing",
]
