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
    "The Q-values of five actions are 0.2, 0.9, 0.5, 0.4 and 0.6. "
    "The second action is updated, and its new target is 1.3. "
    "The network's outputs end at 1, so the targets are rescaled by shifting and dividing. "
    "What happens to the targets of the other four actions?",
    guesses=["they stay", "they fall", "they rise"],
    right="they fall",
    because="Shifting and dividing divides all five targets by 1.3, not only the one that is too "
    "large.",
    files=LEARNING,
)
def one_q_update() -> dict[str, Any]:
    """Q-values of five actions."""
    return {"q": [0.2, 0.9, 0.5, 0.4, 0.6], "taken": 1}


@asks(
    "One pair changes all values",
    "A network is trained to give action 1 a higher value in state A. "
    "It is not trained on state B. "
    "Do the values in state B change?",
    guesses=["no, none of them", "yes, that of action 1", "yes, those of all actions"],
    right="yes, those of all actions",
    because="The same hidden units compute the values of all actions in both states.",
    files=LEARNING,
)
def moving_together() -> dict[str, Any]:
    """A small network with its first weights."""
    network = random_network((2, 4, 3), seed=8)
    return {
        "network": packed_network(network),
        "states": [[1.0, 0.3], [0.6, 0.8]],
        "names": ["A, which is trained", "B, which is not trained"],
        "actions": ["action 1", "action 2", "action 3"],
    }


@asks(
    "Which row of the table holds?",
    "The nearest thing was 4 m away and is now 6 m away. "
    "Which reward does Table 4.1 give?",
    guesses=["0", "0.4", "0.5", "0.6"],
    right="0.5",
    because="The step leads from a dangerous state, nearer than 5 m, to a cozy one, and this row "
    "gives 0.5.",
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
    "The value of the best action is larger by 0.1 than the values of the other four: this is "
    "its lead. "
    "The temperature falls from 0.9 to 0.1 over 300 episodes. "
    "How often is the best action taken in the last episode?",
    guesses=["20 %", "40 %", "70 %", "99 %"],
    right="40 %",
    because="A lead of 0.1 at a temperature of 0.1 makes it e = 2.7 times as likely as each of the "
    "other four, and 2.7 / 6.7 is 0.40.",
    files=LEARNING,
)
def cooling_down() -> dict[str, Any]:
    """The schedule of the page."""
    return {"start": 0.9, "end": 0.1, "lead": 0.1, "episodes": 300}


@asks(
    "How much work is an episode?",
    "An episode has 40 decisions, and each of them gives a pair of a state and its targets. "
    "After each decision the network is trained three times on every pair so far, one "
    "gradient step for each. "
    "How many gradient steps are made in the episode?",
    guesses=["40", "120", "820", "2,460"],
    right="2,460",
    because="After decision k there are k pairs, and 3 · (1 + 2 + … + 40) = 3 · 820 = 2,460.",
)
def work_of_an_episode() -> dict[str, Any]:
    """Nothing but the defaults of the page."""
    return {"decisions": 10, "passes": 3}


@asks(
    "The largest of several estimates",
    "Ten actions all have the value 0. "
    "Their values are estimated with errors of standard deviation 0.2. "
    "How large is the largest estimate on average?",
    guesses=["0", "0.1", "0.3", "0.6"],
    right="0.3",
    because="The maximum picks the action whose error is largest, and of ten normal errors the "
    "largest is 1.54 standard deviations on average.",
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
    "One method is better by one percentage point. "
    "Single trainings have a standard deviation of two points. "
    "With four trainings of each method, how often does the better one have the higher mean?",
    guesses=["51 %", "76 %", "90 %", "99 %"],
    right="76 %",
    because="The difference of the two means scatters with a standard deviation of 1.4 points, which "
    "is more than the one point that is to be seen.",
)
def seeds_to_tell_apart() -> dict[str, Any]:
    """The distribution function of a standard normal number, as a table, and what the sliders say at first."""
    x = np.linspace(-6, 6, 241)
    return {
        "x": x.tolist(),
        "cdf": norm.cdf(x).tolist(),
        "seeds": 1,
        "difference": 1,
        "scatter": 2,
    }


@asks(
    "Circle, or go to the target?",
    "Keeping a distance from an obstacle gives a reward of 0.1 a second, for as long as the "
    "robot likes. "
    "The target is 20 seconds away and gives 1. "
    "The discount is 0.9. "
    "Which has the larger return?",
    guesses=["the target", "the circle"],
    right="the circle",
    because="Circling has the return 0.1 / (1 − 0.9) = 1, while only 0.9¹⁹ = 0.14 is left of the "
    "target's reward.",
)
def circle_or_target() -> dict[str, Any]:
    """Nothing but the discount with which the page starts."""
    return {"discount": 0.6}


@asks(
    "How many targets does a value remember?",
    "A Q-value is updated twenty times with a learning rate of 0.8. "
    "It varies as much as the mean of how many targets?",
    guesses=["about 20", "about 8", "about 1.5"],
    right="about 1.5",
    because="Four fifths of the value come from the latest target, so the earlier ones hardly count.",
)
def weight_of_targets() -> dict[str, Any]:
    """Nothing: the page computes the weights."""
    return {}


@asks(
    "Values that do not fit",
    "The rewards of five actions are 0.6, 0.5, 0.4, 0.2 and 0, and afterwards the best action "
    "is always taken. "
    "The discount is 0.9, and targets above 1 are clipped. "
    "How many of the actions can the network distinguish?",
    guesses=["all", "three", "none"],
    right="none",
    because="All five values are above 5, so clipping turns all five targets into 1.",
    files=LEARNING,
)
def values_out_of_range() -> dict[str, Any]:
    """The rewards of five actions."""
    return {"rewards": [0.6, 0.5, 0.4, 0.2, 0.0], "discount": 0.5}
