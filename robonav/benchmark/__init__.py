"""The registry of policies, and the leaderboard, which tests all methods in the same worlds."""

from .evaluation import EXACT_REFLEX, outcome_rates, pareto_front
from .leaderboard import (
    DIGESTS,
    SETTINGS,
    VERSION,
    Setting,
    board_worlds,
    digest,
    evaluate_on_board,
    evaluate_policy,
    shortest_paths,
    spl,
)
from .policies import (
    BASELINES,
    DISPLAY_NAMES,
    display_name,
    evaluate,
    fingerprint,
    method,
    methods,
    success_interval,
)

__all__ = [
    "BASELINES",
    "DIGESTS",
    "DISPLAY_NAMES",
    "EXACT_REFLEX",
    "SETTINGS",
    "VERSION",
    "Setting",
    "board_worlds",
    "digest",
    "display_name",
    "evaluate",
    "evaluate_on_board",
    "evaluate_policy",
    "fingerprint",
    "method",
    "methods",
    "outcome_rates",
    "pareto_front",
    "shortest_paths",
    "spl",
    "success_interval",
]
