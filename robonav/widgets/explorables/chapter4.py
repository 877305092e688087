"""The numbers of chapter 4's explorables."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.stats import norm

from robonav.networks import random_network
from robonav.nnql.reward import TABLE

from ..shared import packed_network
from .registry import asks

LEARNING = (
    "simulator",
    "learning/random",
    "learning/worlds",
    "learning/network",
    "learning/nnql",
)


@asks(
    "A target above 1",
    "The Q-values are 0.2, 0.9, 0.5, 0.4 and 0.6. The second action is updated, and its target is 1.3. "
    "It is rescaled by shifting and dividing. What happens to the targets of the other four actions?",
    guesses=["they stay", "they fall", "they rise"],
    files=LEARNING,
)
def one_q_update() -> dict[str, Any]:
    """Q-values of five actions."""
    return {"q": [0.2, 0.9, 0.5, 0.4, 0.6], "taken": 1}


@asks(
    "One pair changes all values",
    "A network learns the value 1 for action 1 in state A. It is not trained on state B. "
    "Do the values in state B change?",
    guesses=["no", "yes, those of action 1", "yes, those of all actions"],
    files=LEARNING,
)
def moving_together() -> dict[str, Any]:
    """A small network with its first weights."""
    network = random_network((2, 4, 3), seed=8)
    return {"network": packed_network(network), "states": [[1.0, 0.3], [0.6, 0.8]]}


@asks(
    "Which row holds?",
    "The nearest thing was 4 m away and is now 6 m away. Which reward does Table 4.1 give?",
    guesses=["0", "0.4", "0.5", "0.6"],
    files=LEARNING,
)
def row_of_the_reward() -> dict[str, Any]:
    """The rows of Table 4.1."""
    rows = [
        {
            "from": row.before,
            "to": row.after,
            "condition": row.condition,
            "reward": row.reward,
        }
        for row in TABLE
    ]
    return {"rows": rows}


@asks(
    "Cooling down",
    "The best action is better by 0.1 than each of the other four. "
    "The temperature falls from 0.9 to 0.1 over 300 episodes. "
    "How often is the best action taken in the last episode?",
    guesses=["20 %", "40 %", "70 %", "99 %"],
    files=LEARNING,
)
def cooling_down() -> dict[str, Any]:
    """The schedule of the page."""
    return {"start": 0.9, "end": 0.1, "lead": 0.1, "episodes": 300}


@asks(
    "How much work is an episode?",
    "An episode has 40 decisions. After each one the network goes three times through all pairs of the episode so far. "
    "How many steps of gradient descent does it make?",
    guesses=["40", "120", "820", "2,460"],
)
def work_of_an_episode() -> dict[str, Any]:
    """Nothing but the defaults of the page."""
    return {"decisions": 10, "passes": 3}


@asks(
    "The maximum of guesses",
    "Ten actions all have the value 0. Their values are estimated with errors of standard deviation 0.2. "
    "What is the largest estimate, on average?",
    guesses=["0", "0.1", "0.3", "0.6"],
)
def overestimation() -> dict[str, Any]:
    """The mean of the largest of n standard normal numbers, for n from 1 to 20."""
    x = np.linspace(-8, 8, 4001)
    means = [
        float(np.trapezoid(x * n * norm.pdf(x) * norm.cdf(x) ** (n - 1), x))
        for n in range(1, 21)
    ]
    return {"means": means}


@asks(
    "How many trainings distinguish two methods?",
    "One method is better by one percentage point. Single trainings have a standard deviation of two points. "
    "With four trainings of each, how often does the better method have the higher mean?",
    guesses=["51 %", "76 %", "90 %", "99 %"],
)
def seeds_to_tell_apart() -> dict[str, Any]:
    """The distribution function of a standard normal number, as a table."""
    x = np.linspace(-6, 6, 241)
    return {"x": x.tolist(), "cdf": norm.cdf(x).tolist()}


@asks(
    "Circle, or go to the target?",
    "Keeping a distance from an obstacle pays 0.1 a second, for as long as the robot likes. "
    "The target is 20 seconds away and pays 1. The discount is 0.9. Which has the larger return?",
    guesses=["the target", "the circle"],
)
def circle_or_target() -> dict[str, Any]:
    """Nothing but the discount with which the page starts."""
    return {"discount": 0.6}


@asks(
    "How many targets does a value remember?",
    "A Q-value is updated twenty times with a learning rate of 0.8. "
    "It is as reliable as the mean of how many targets?",
    guesses=["20", "8", "1 or 2"],
)
def weight_of_targets() -> dict[str, Any]:
    """Nothing: the page computes the weights."""
    return {}


@asks(
    "Values that do not fit",
    "The rewards of five actions are 0.6, 0.5, 0.4, 0.2 and 0, and afterwards the best action is always taken. "
    "The discount is 0.9, and targets above 1 are clipped. How many of the actions can the network distinguish?",
    guesses=["all", "three", "none"],
    files=LEARNING,
)
def values_out_of_range() -> dict[str, Any]:
    """The rewards of five actions."""
    return {"rewards": [0.6, 0.5, 0.4, 0.2, 0.0], "discount": 0.5}
