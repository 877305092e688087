"""Chapter 2: finite MDPs, planning, tabular learning, partial observation, gridworlds."""

from .exploration import Schedule, epsilon_greedy, exponential_decay, harmonic_decay, linear_decay, polynomial_decay
from .features import Features, OneHot, Tiles
from .interaction import Episode, discounted_return, rollouts
from .linear import LinearLearned, linear_q_learning, linear_sarsa, with_constant
from .models import FiniteMDP, expected_rewards
from .monte_carlo import monte_carlo_control, monte_carlo_prediction
from .policies import greedy_actions, greedy_mixture
from .temporal_difference import Learned, Predicted, expected_sarsa, q_learning, sarsa, td_prediction

__all__ = [
    "Episode",
    "Features",
    "FiniteMDP",
    "Learned",
    "LinearLearned",
    "OneHot",
    "Predicted",
    "Schedule",
    "Tiles",
    "discounted_return",
    "epsilon_greedy",
    "expected_rewards",
    "expected_sarsa",
    "exponential_decay",
    "greedy_actions",
    "greedy_mixture",
    "harmonic_decay",
    "linear_decay",
    "linear_q_learning",
    "linear_sarsa",
    "monte_carlo_control",
    "monte_carlo_prediction",
    "polynomial_decay",
    "q_learning",
    "rollouts",
    "sarsa",
    "td_prediction",
    "with_constant",
]
