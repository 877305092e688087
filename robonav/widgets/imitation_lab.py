"""Imitation lab: a robot learns from the reader's drives in the page, and drives maps that nobody has driven."""

from __future__ import annotations

import anywidget
import traitlets

from robonav.lfd import demonstrate
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import random_worlds
from robonav.validation import check_instance, check_integer

from .shared import front_end, style_sheet
from .simulator import page_policy

OBSTACLES = 10


class ImitationLab(anywidget.AnyWidget):
    """Choose drives; train; watch the robot drive new maps; compare; take the weights along."""

    _esm = front_end(
        "simulator", "maps", "episode", "files",
        "learning/random", "learning/worlds", "learning/network", "learning/lbfgs",
        "learning/nnql", "learning/worker", "learning/training_panel",
        "drives", "imitation", "imitation_lab",
    )  # fmt: skip
    _css = style_sheet("maps", "drives", "learning/training_panel", "imitation")
    data = traitlets.Dict().tag(sync=True)


def imitation_lab(
    policy: NetworkPolicy,
    *,
    demonstrations: int = 100,
    expert_seed: int = 7,
    maps: int = 200,
    test_seed: int = 2024,
    playground: str = "playground.html",
    progress: Progress | None = None,
) -> ImitationLab:
    """Make a lab in which a robot learns from the reader's drives, or from the computer expert's.

    The page gets the expert's actions, a digit a step, and drives them again in the same worlds.

    Parameters
    ----------
    policy : NetworkPolicy
        The book's own, to compare with.
    demonstrations : int
        Drives of the computer expert to choose from.
    expert_seed, test_seed : int
        Of the expert's worlds and of the worlds to test in. They must differ.
    maps : int
        Number of worlds to test in.
    playground : str
        Address of the page on which to drive.
    progress : callable, optional
        Called as ``progress(worlds done, demonstrations)`` while the expert drives.

    Returns
    -------
    ImitationLab

    Raises
    ------
    ValueError
        If there is no demonstration or no map, or the two seeds are equal.

    Examples
    --------
    >>> from robonav.benchmark.policies import method
    >>> lab = imitation_lab(method("lfd"), demonstrations=2, maps=10)
    >>> len(lab.data["expert"]["actions"])
    2
    """
    check_instance("policy", policy, NetworkPolicy)
    count = check_integer("demonstrations", demonstrations, at_least=1)
    tested = check_integer("maps", maps, at_least=1)
    if expert_seed == test_seed:
        raise ValueError(
            f"expert_seed and test_seed must differ, got {test_seed} twice"
        )
    worlds = random_worlds(count, OBSTACLES, seed=expert_seed)
    driven = demonstrate(worlds, progress=progress)
    actions = [
        "".join(map(str, driven.actions[driven.trajectory == i])) for i in range(count)
    ]
    return ImitationLab(
        data={
            "expert": {"seed": expert_seed, "obstacles": OBSTACLES, "actions": actions},
            "book": page_policy(policy),
            "trial": {"seed": test_seed, "maps": tested},
            "playground": playground,
        }
    )
