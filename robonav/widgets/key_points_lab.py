"""Key points lab: the reader marks key points on a map, and the robot follows a smooth path through them."""

from __future__ import annotations

import anywidget
import traitlets

from robonav.validation import check_integer

from .shared import front_end, style_sheet

FIRST_MAP = 500_000
"""Map n of the reader is the world of seed ``FIRST_MAP + n``, as in ``drives.js``."""


class KeyPointsLab(anywidget.AnyWidget):
    """Mark key points, let the robot follow the path through them, and keep the demonstration."""

    _esm = front_end(
        "simulator", "maps", "episode", "files", "learning/random", "learning/worlds",
        "drives", "key_points_lab",
    )  # fmt: skip
    _css = style_sheet("maps", "drives", "key_points_lab")
    data = traitlets.Dict().tag(sync=True)


def key_points_lab(
    *,
    obstacles: int = 10,
    training: str = "policy-learning.html#train-a-robot-on-your-own-drives",
) -> KeyPointsLab:
    """Make a lab in which the reader is the human expert of :mod:`robonav.lfd.human_expert`.

    Parameters
    ----------
    obstacles : int
        The number of obstacles in each map.
    training : str
        The address of the page on which a robot learns from the reader's demonstrations.

    Returns
    -------
    KeyPointsLab

    Raises
    ------
    TypeError, ValueError
        If the number of obstacles is not a whole number, or is below 0.

    Examples
    --------
    >>> from robonav.widgets.key_points_lab import key_points_lab
    >>> key_points_lab(obstacles=20).data["obstacles"]
    20
    """
    count = check_integer("obstacles", obstacles, at_least=0)
    return KeyPointsLab(
        data={"obstacles": count, "seed": FIRST_MAP, "training": training}
    )
