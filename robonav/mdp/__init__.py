"""Chapter 2: finite MDPs, planning, tabular learning, partial observation, gridworlds."""

from .models import FiniteMDP, expected_rewards
from .policies import greedy_actions, greedy_mixture

__all__ = ["FiniteMDP", "expected_rewards", "greedy_actions", "greedy_mixture"]
