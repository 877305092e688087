"""Every table and figure of the thesis as a named experiment."""

from .registry import experiment, names
from .runner.experiment import Case, Experiment, Plot, Results
from .runner.results import RESULTS, load_results, read_results, save_results
from .runner.run import reproduce
from .runner.statistics import (
    Improvement,
    Summary,
    bootstrap_interval,
    probability_of_improvement,
    summarise,
)

__all__ = [
    "RESULTS",
    "Case",
    "Experiment",
    "Improvement",
    "Plot",
    "Results",
    "Summary",
    "bootstrap_interval",
    "experiment",
    "load_results",
    "names",
    "probability_of_improvement",
    "read_results",
    "reproduce",
    "save_results",
    "summarise",
]
