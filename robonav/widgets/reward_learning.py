"""Learn a reward in the page from demonstrations, see it as a map, and train robots with it."""

from __future__ import annotations

from collections.abc import Mapping

import anywidget
import numpy as np
import traitlets

from robonav.lfd.demonstrations import Demonstrations
from robonav.networks.policy import NetworkPolicy
from robonav.nirl import expert_transitions
from robonav.robot import Worlds
from robonav.validation import check_integer

from .shared import front_end, packed, style_sheet
from .simulator import page_policy, page_world

FILES = (
    "simulator",
    "maps",
    "files",
    "learning/random",
    "learning/worlds",
    "learning/network",
    "learning/nirl",
    "learning/trials",
    "drives",
    "kept_robots",
    "learning/worker",
    "learning/training_panel",
    "reward_learning",
)


class RewardLearning(anywidget.AnyWidget):
    """Learn a reward from demonstrations by NIRL, see it as a map, and train a robot with it in other worlds."""

    _esm = front_end(*FILES)
    _css = style_sheet("maps", "drives", "robot_playground", "learning/training_panel")
    data = traitlets.Dict().tag(sync=True)


def reward_learning(
    demonstrations: Mapping[str, Demonstrations],
    world: Worlds,
    policies: Mapping[str, NetworkPolicy],
    *,
    maps: int = 200,
    seed: int,
) -> RewardLearning:
    """Make the widget that learns a reward.

    Parameters
    ----------
    demonstrations : mapping of str to Demonstrations
        Sets of demonstrations to choose from, by name.
    world : Worlds
        A batch of one: the map on which the reward is drawn.
    policies : mapping of str to NetworkPolicy
        Policies to compare the learned one with. The rule that goes straight on is always among them.
    maps : int
        The number of maps in which the robots are tried.
    seed : int
        The seed of these maps.

    Returns
    -------
    RewardLearning

    Raises
    ------
    ValueError
        If there is no decision in the demonstrations, or ``maps`` is below 1.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.reward_learning import reward_learning
    >>> demonstrations = demonstrate(random_worlds(2, 20, seed=3))
    >>> widget = reward_learning({"two": demonstrations}, random_worlds(1, 20, seed=4), {}, seed=5)
    >>> [policy["name"] for policy in widget.data["policies"]]
    ['straight on']
    """
    sets = []
    for name, drives in demonstrations.items():
        decisions = expert_transitions(drives)
        sets.append(
            {
                "name": name,
                "inputs": packed(decisions.inputs),
                "actions": packed(decisions.actions, np.uint8),
            }
        )
    networks = [
        {"name": name, **page_policy(policy)} for name, policy in policies.items()
    ]
    return RewardLearning(
        data={
            "sets": sets,
            "world": page_world(world),
            "policies": [{"name": "straight on", "rule": "straight"}, *networks],
            "maps": check_integer("maps", maps, at_least=1),
            "seed": check_integer("seed", seed, at_least=0),
        }
    )
