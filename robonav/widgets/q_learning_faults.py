"""The ways in which a robot's learning goes wrong on the page *My robot circles*, each with its remedy.

Each fault is visible with the seed given here. With other seeds it is stronger or weaker: the page has
tables. The robots have the reflex of these tables, which knows the direction of the target exactly.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from robonav.experiments.chapter4.ablations import (
    GETTING_SAFE,
    STAYING_COZY,
    STAYING_DANGEROUS,
)

from .q_learning_lab import Preset
from .q_learning_settings import QLearningSettings

OF_THE_TABLES = QLearningSettings(direction="exact")
"""The settings that correct all faults."""
TABLE_4_1 = OF_THE_TABLES.rewards
ARRIVAL_AND_COLLISION = (1.0, -1.0, *[0.0] * (len(TABLE_4_1) - 2))


def _rewards(changes: Mapping[int, float]) -> tuple[float, ...]:
    """Table 4.1 with other rewards in some rows."""
    return tuple(changes.get(row, reward) for row, reward in enumerate(TABLE_4_1))


FAULTS = (
    Preset(
        "reward: 0.6 for getting safe, too",
        "The curve of the training is excellent. Look at the new maps where the robot failed, and at the row T = 0.4.",
        "Getting safe earns nothing, as in Table 4.1.",
        replace(OF_THE_TABLES, rewards=_rewards({GETTING_SAFE: 0.6}), seed=1),
    ),
    Preset(
        "reward: nothing for staying cozy",
        "Where does staying still earn something? Look there in the new maps where the robot failed.",
        "Staying cozy earns 0.6 again.",
        replace(OF_THE_TABLES, rewards=_rewards({STAYING_COZY: 0.0}), seed=4),
    ),
    Preset(
        "reward: arrival and collision alone",
        "Only arrival and collision are rewarded. Compare the robot with one that always goes straight on.",
        "The steps on the way are rewarded again.",
        replace(OF_THE_TABLES, rewards=ARRIVAL_AND_COLLISION, seed=0),
    ),
    Preset(
        "reward: evading is moving away",
        "Evading is rewarded only where the robot moves away, among thirty obstacles. Look at its paths in the new "
        "maps where it never ended.",
        "Evading is rewarded again whenever nothing comes a metre nearer.",
        replace(OF_THE_TABLES, must_move_away=True, obstacles=30, seed=0),
    ),
    Preset(
        "temperature: 0.9 throughout",
        "The curve of the training is poor to the end. Is the finished robot as poor?",
        "The temperature falls to 0.1.",
        replace(OF_THE_TABLES, temperature=(0.9, 0.9), seed=4),
        shows="training",
    ),
    Preset(
        "temperature: 0.03 throughout",
        "The robot keeps the first actions that were rewarded. Try the seeds 4 and 6: how much do the robots differ?",
        "The temperature starts at 0.9 and falls to 0.1.",
        replace(OF_THE_TABLES, temperature=(0.03, 0.03), seed=6),
    ),
    Preset(
        "learning rate: 0.8 throughout",
        "The last targets determine the values. Does T = 0.4 help? Try other seeds: do all robots fail?",
        "The learning rate falls to 0.1.",
        replace(OF_THE_TABLES, learning_rate=(0.8, 0.8), seed=0),
    ),
    Preset(
        "discount 0.9, Q shifted",
        "Look at the last curve: with this discount most targets are larger than the outputs can be, and are divided. "
        "Only a few new maps are lost, because the robot never ends in them. Does T = 0.4 help?",
        "The discount is 0.6.",
        replace(OF_THE_TABLES, discount=0.9, seed=9),
        shows="targets",
    ),
    Preset(
        "discount 0.9, Q clipped",
        "Look at the last curve: most targets are above 1 and become 1, so the network cannot tell which action is "
        "best. Only a few new maps are lost, because the robot never ends in them. Does T = 0.4 help?",
        "The discount is 0.6, and the values are shifted.",
        replace(OF_THE_TABLES, discount=0.9, rescale="clip", seed=9),
        shows="targets",
    ),
    Preset(
        "no fault: half as much for evading",
        "The rewards for evading are 0.3 and 0.2, half of those in Table 4.1. How much does the robot lose?",
        "The rewards for evading are 0.6 and 0.4 again.",
        replace(
            OF_THE_TABLES,
            rewards=_rewards({STAYING_COZY: 0.3, STAYING_DANGEROUS: 0.2}),
            seed=0,
        ),
        shows="nothing",
    ),
    Preset(
        "no fault: raw numbers as inputs",
        "The network reads degrees of danger up to 7 and the target's sector up to 9. How much does the robot lose?",
        "Every input lies between 0 and 1.",
        replace(OF_THE_TABLES, inputs="raw", seed=6),
        shows="nothing",
    ),
)
