"""Robot playground: the simulator in the page, with worlds to edit and a choice of policies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import anywidget
import traitlets

from robonav.networks.policy import NetworkPolicy
from robonav.robot import Worlds
from robonav.validation import check_positive

from .shared import front_end, style_sheet
from .simulator import page_policy, page_world

RULES = ("straight", "freer-side")


class RobotPlayground(anywidget.AnyWidget):
    """Edit a map in which a policy or the reader steers the robot, and download the episode."""

    _esm = front_end(
        "simulator", "team", "maps", "episode", "steering", "files", "learning/random", "learning/worlds",
        "kept_demonstrations", "kept_robots", "robot_playground",
    )  # fmt: skip
    _css = style_sheet(
        "maps", "steering", "kept_demonstrations", "kept_robots", "robot_playground"
    )
    data = traitlets.Dict().tag(sync=True)


def robot_playground(
    worlds: Mapping[str, Worlds],
    policies: Mapping[str, NetworkPolicy] | None = None,
    *,
    speeds: Sequence[float] = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0),
    training: str = "policy-learning.html#train-a-robot-on-your-own-demonstrations",
) -> RobotPlayground:
    """Make a playground with some worlds and networks. The two baselines and the reader can always steer.

    Parameters
    ----------
    worlds : mapping of str to Worlds
        Batches of one to choose from, by name.
    policies : mapping of str to NetworkPolicy, optional
        Networks with their encoders, by name.
    speeds : sequence of float
        Speeds to choose from, in m/s; 2 must be among them.
    training : str
        Address of the page on which a robot learns from the reader's demonstrations.

    Returns
    -------
    RobotPlayground

    Raises
    ------
    ValueError
        If there is no world, or 2 m/s is not among the speeds.

    Examples
    --------
    >>> from robonav.benchmark.policies import method
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.robot_playground import robot_playground
    >>> worlds = {"10 obstacles": random_worlds(1, obstacles=10, seed=1)}
    >>> len(robot_playground(worlds, {"NNQL": method("nnql")}).data) > 0
    True
    """
    if not worlds:
        raise ValueError("worlds must hold at least one, got none")
    chosen = [check_positive("speeds", speed) for speed in speeds]
    if 2.0 not in chosen:
        raise ValueError(f"speeds must hold 2 m/s, got {chosen}")
    networks = [
        {"name": name, **page_policy(policy)}
        for name, policy in (policies or {}).items()
    ]
    rules = [{"name": f"rule: {rule}", "rule": rule} for rule in RULES]
    return RobotPlayground(
        data={
            "worlds": [
                {"name": name, "world": page_world(world)}
                for name, world in worlds.items()
            ],
            "policies": [*networks, *rules],
            "speeds": chosen,
            "training": training,
        }
    )
