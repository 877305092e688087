"""Every table and figure of the thesis as a named experiment."""

from .catalogue import experiment, names
from .experiment import Case, Experiment, Results, Row
from .running import reproduce
from .statistics import Improvement, Summary, bootstrap_interval, probability_of_improvement, summarise
from .store import RESULTS, load_results, save_results

__all__ = [
    "RESULTS",
    "Case",
    "Experiment",
    "Improvement",
    "Results",
    "Row",
    "Summary",
    "bootstrap_interval",
    "experiment",
    "load_results",
    "names",
    "probability_of_improvement",
    "reproduce",
    "save_results",
    "summarise",
]
