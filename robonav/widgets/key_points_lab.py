"""Key points lab: the reader marks key points on a map, and the robot follows a smooth path through them."""

from __future__ import annotations

from typing import Any

from robonav.lfd import demonstrate
from robonav.robot import neighbour_slip, random_worlds
from robonav.validation import check_integer, check_real

from .imitation_training import train_imitators
from .kernel_training import TRIED, KernelTraining, Report
from .shared import front_end, style_sheet
from .simulator import page_demonstrations

FIRST_MAP = 500_000
"""Map n of the reader is the world of seed ``FIRST_MAP + n``, as in ``demonstrations.js``."""
EXPERT_SEED, TEST_SEED = 7, 2024
"""Of the maps in which the computer demonstrates, and of those in which robots are tried."""


class KeyPointsLab(KernelTraining):
    """Mark key points, let the robot follow the path through them, and keep the demonstration.

    With a kernel, Python trains robots on the demonstrations of an expert: the reader, or the computer, which keeps a
    margin, is cautious, and slips as the page says.
    """

    _esm = front_end(
        "simulator", "maps", "episode", "files", "learning/random", "learning/worlds",
        "learning/worker", "learning/training_panel", "learning/kernel_panel",
        "kept_demonstrations", "key_points_lab",
    )  # fmt: skip
    _css = style_sheet(
        "maps", "kept_demonstrations", "learning/training_panel", "key_points_lab"
    )

    def train(self, request: dict[str, Any], report: Report) -> dict[str, Any]:
        """Let an expert demonstrate, train robots side by side on what it shows, and try them in new maps."""
        settings = request["settings"]
        robots = check_integer("robots", request["robots"], at_least=1)
        obstacles = self.data["obstacles"]
        if request["demonstrations"] is not None:
            demonstrations, shown = page_demonstrations(request["demonstrations"]), 0
        else:
            shown = check_integer(
                "demonstrations", settings["demonstrations"], at_least=1
            )
            total = shown + settings["iterations"] + robots
            slip = check_real("slips", settings["slips"], at_least=0, at_most=1)
            demonstrations = demonstrate(
                random_worlds(shown, obstacles, seed=EXPERT_SEED),
                margin=settings["margin"],
                caution=settings["caution"],
                slip=neighbour_slip(slip),
                progress=report.part(0, total),
            )
        self.trainings, ended = train_imitators(
            demonstrations,
            settings,
            random_worlds(TRIED, obstacles, seed=TEST_SEED),
            report,
            robots=robots,
            done=shown,
        )
        steps, maps = len(demonstrations.effective), len(demonstrations.worlds)
        learned = f"{maps} {'demonstration' if maps == 1 else 'demonstrations'} with {steps} steps to learn from."
        return {"sentence": f"{learned} {ended['sentence']}"}


def key_points_lab(
    *,
    obstacles: int = 10,
    training: str = "policy-learning.html#train-a-robot-on-your-own-demonstrations",
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
    return KeyPointsLab({"obstacles": count, "seed": FIRST_MAP, "training": training})
