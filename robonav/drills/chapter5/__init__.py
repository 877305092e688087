"""Drills of chapter 5, a file for each page. Importing a file registers its drills."""

from . import feature_expectations as feature_expectations
from . import max_margin as max_margin
from . import maximum_entropy as maximum_entropy
from . import nirl as nirl
from . import nirl_comparison as nirl_comparison
from . import nirl_in_practice as nirl_in_practice
from . import why_learn_the_reward as why_learn_the_reward
