"""Reward lab: a learned reward with weights to change, and the behaviour of a robot that follows it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import anywidget
import numpy as np
import traitlets
from numpy.typing import ArrayLike

from robonav.lfd.demonstrations import LEARNED
from robonav.nirl import Decisions
from robonav.robot import Encoder, Worlds
from robonav.validation import check_array, check_positive, check_real

from .shared import front_end, packed, style_sheet
from .simulator import page_world

TARGET_FEATURES = {
    "number": ["target's sector, 1 to 9"],
    "signed": ["target's sector, right to left"],
    "one-hot": [f"target in sector {sector}" for sector in range(1, 10)],
    "sine-cosine": ["target to the left", "target ahead"],
}


class RewardLab(anywidget.AnyWidget):
    """Change a weight of the reward, and see where the reward is high and what a robot does that follows it."""

    _esm = front_end("simulator", "maps", "reward_lab")
    _css = style_sheet("maps", "reward_lab")
    data = traitlets.Dict().tag(sync=True)


def reward_lab(
    reward_weights: ArrayLike,
    encoder: Encoder,
    decisions: Decisions,
    worlds: Mapping[str, Worlds],
    others: Worlds,
    *,
    discount: float = 0.9,
    speed: float = 2.0,
) -> RewardLab:
    """Make the lab for one reward.

    Parameters
    ----------
    reward_weights : (5, k + 1) array
        The weights theta, one row for each action and the constant last, as :func:`robonav.nirl.learn` returns them.
    encoder : Encoder
        The encoder phi(s), with k features.
    decisions : Decisions
        The expert's decisions, with which the choices of the reward are compared.
    worlds : mapping of str to Worlds
        Batches of one by name, which the lab draws.
    others : sequence of Worlds
        More batches of one, in which the lab counts arrivals.
    discount : float
        The discount of a robot that looks more than one decision ahead.
    speed : float
        The speed of the robot in m/s.

    Returns
    -------
    RewardLab

    Raises
    ------
    ValueError
        If the weights do not fit the encoder, or there is no world or decision.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import ENCODER, expert_decisions
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.reward_lab import reward_lab
    >>> worlds = random_worlds(2, obstacles=20, seed=3)
    >>> weights, decisions = np.zeros((5, ENCODER.size + 1)), expert_decisions(demonstrate(worlds))
    >>> lab = reward_lab(weights, ENCODER, decisions, {"a map": worlds[0]}, worlds)
    >>> len(lab.data) > 0
    True
    """
    theta = check_array(
        "reward_weights", reward_weights, shape=(LEARNED, encoder.size + 1)
    )
    if not worlds or not len(others) or not len(decisions):
        raise ValueError("worlds, others and decisions must each hold at least one")
    return RewardLab(
        data={
            "theta": packed(theta),
            "encoder": {
                "sensors": list(encoder.sensors),
                "walls": encoder.walls,
                "target": encoder.target,
            },
            "features": _features(encoder),
            "inputs": packed(decisions.inputs),
            "actions": packed(decisions.actions, np.uint8),
            "worlds": [
                {"name": name, "world": page_world(world)}
                for name, world in worlds.items()
            ],
            "others": [page_world(world) for world in others],
            "discount": check_real("discount", discount, at_least=0, below=1),
            "speed": check_positive("speed", speed),
        }
    )


def _features(encoder: Encoder) -> list[dict[str, Any]]:
    """Return the name of each feature in the order of the encoder, with the sensor or the target that it describes."""
    named = [("danger", f"danger in sector {sensor}") for sensor in encoder.sensors]
    named += [
        ("target", name) for name in (*TARGET_FEATURES[encoder.target], "target seen")
    ]
    if encoder.walls:
        named += [("wall", f"wall in sector {sensor}") for sensor in encoder.sensors]
    return [
        {"kind": kind, "name": name}
        for kind, name in (*named, ("constant", "constant"))
    ]
