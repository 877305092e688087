"""A row of the leaderboard for the reader's own robot, tried in the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import anywidget
import traitlets

from robonav.benchmark import EXACT_REFLEX, SETTINGS
from robonav.benchmark.leaderboard import SEED, SETS, WORLDS
from robonav.robot import neighbour_slip

from .shared import front_end, style_sheet


class LeaderboardRow(anywidget.AnyWidget):
    """Try a robot in the frozen worlds of the leaderboard and compare its row with those of the book's methods."""

    _esm = front_end(
        "simulator", "files", "learning/random", "learning/worlds", "learning/trials",
        "learning/worker", "learning/training_panel", "kept_robots", "leaderboard_row",
    )  # fmt: skip
    _css = style_sheet(
        "learning/training_panel", "robot_playground", "kept_robots", "leaderboard_row"
    )
    data = traitlets.Dict().tag(sync=True)


def leaderboard_row(
    rates: Mapping[str, Sequence[float]],
    *,
    playground: str = "policy-learning.html#train-a-robot-on-your-own-demonstrations",
    worlds: int = WORLDS,
) -> LeaderboardRow:
    """Make the widget that tries the reader's robot.

    Parameters
    ----------
    rates : mapping of str to sequence of float
        The success of each method in per cent, one number for each setting of the leaderboard.
    playground : str
        The address of the page where a reader trains a robot.
    worlds : int
        The number of worlds in a set.

    Returns
    -------
    LeaderboardRow

    Raises
    ------
    ValueError
        If the number of rates of a method differs from the number of settings.

    Examples
    --------
    >>> from robonav.benchmark import SETTINGS
    >>> from robonav.widgets.leaderboard_row import leaderboard_row
    >>> row = leaderboard_row({"straight": [36.0] * len(SETTINGS)})
    >>> row.data["settings"][0]["name"]
    '10 obstacles'
    """
    for name, values in rates.items():
        if len(values) != len(SETTINGS):
            raise ValueError(
                f"rates must hold {len(SETTINGS)} numbers for {name}, got {len(values)}"
            )
    settings = [
        {
            "name": name,
            "conditions": {
                "obstacles": setting.obstacles,
                "moving": setting.moving,
                "speed": setting.speed,
                "direction": EXACT_REFLEX.direction,
                "noise": setting.noise,
                "slip": neighbour_slip(setting.slip).tolist() if setting.slip else None,
            },
        }
        for name, setting in SETTINGS.items()
    ]
    return LeaderboardRow(
        data={
            "settings": settings,
            "methods": [
                {"name": name, "rates": list(values)} for name, values in rates.items()
            ],
            "seeds": [SEED + number for number in range(SETS)],
            "worlds": worlds,
            "playground": playground,
        }
    )
