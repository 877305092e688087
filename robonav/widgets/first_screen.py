"""The first screen of the book: a moving robot, which the reader can stop, obstruct and steer."""

from __future__ import annotations

from collections.abc import Mapping

import anywidget
import traitlets

from robonav.networks.policy import NetworkPolicy
from robonav.robot import world_keys
from robonav.validation import check_integer, check_positive

from .shared import front_end, style_sheet
from .simulator import page_policy

MAPS = 200


class FirstScreen(anywidget.AnyWidget):
    """Watch a robot cross one random map after another, and stop, obstruct or steer it."""

    _esm = front_end(
        "simulator", "maps", "episode", "steering", "learning/worlds", "first_screen"
    )
    _css = style_sheet("maps", "steering", "robot_playground", "first_screen")
    data = traitlets.Dict().tag(sync=True)


def first_screen(
    policy: NetworkPolicy,
    about: str,
    links: Mapping[str, str],
    *,
    obstacles: int = 15,
    speed: float = 2.0,
    seed: int,
) -> FirstScreen:
    """Make the first screen.

    Parameters
    ----------
    policy : NetworkPolicy
        The policy that steers the robot.
    about : str
        One sentence, shown beside the map while the policy steers.
    links : mapping of str to str
        Links to other pages: the text and the address of each.
    obstacles : int
        The number of obstacles in each random map.
    speed : float
        The speed of the robot in m/s.
    seed : int
        The seed of the maps. After 200 maps they start again.

    Returns
    -------
    FirstScreen

    Raises
    ------
    ValueError
        If ``obstacles`` is negative or ``speed`` is not positive.

    Examples
    --------
    >>> from robonav.benchmark.policies import method
    >>> from robonav.widgets.first_screen import first_screen
    >>> screen = first_screen(method("dagger"), "A network steers.", {}, seed=1)
    >>> len(screen.data["keys"])
    200
    """
    return FirstScreen(
        data={
            "policy": page_policy(policy),
            "about": about,
            "links": [{"text": text, "page": page} for text, page in links.items()],
            "keys": world_keys(MAPS, seed).tolist(),
            "obstacles": check_integer("obstacles", obstacles, at_least=0),
            "speed": check_positive("speed", speed),
        }
    )
