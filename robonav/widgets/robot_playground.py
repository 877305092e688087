"""Robot playground: the simulator in the page, the reader's worlds, and whoever is to drive."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import anywidget
import traitlets

from robonav.networks.policy import NetworkPolicy
from robonav.robot import Worlds
from robonav.validation import check_positive

from .shared import front_end, style_sheet
from .simulator import page_policy, page_world

RULES = ("straight", "freer side")


class RobotPlayground(anywidget.AnyWidget):
    """Drag obstacles, let a policy drive or drive yourself, take the drive away as a demonstration."""

    _esm = front_end("simulator", "maps", "files", "robot_playground")
    _css = style_sheet("maps", "robot_playground")
    data = traitlets.Dict().tag(sync=True)


def robot_playground(
    worlds: Mapping[str, Worlds],
    policies: Mapping[str, NetworkPolicy] | None = None,
    *,
    speeds: Sequence[float] = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0),
) -> RobotPlayground:
    """The playground with some worlds to begin with and some networks to drive; two rules and the reader come on top.

    Parameters
    ----------
    worlds : named batches of one.
    policies : named networks with their encoders.
    speeds : to choose from, in m/s; 2 among them.

    Raises
    ------
    ValueError : if there is no world, or 2 m/s is not among the speeds.
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
        }
    )
