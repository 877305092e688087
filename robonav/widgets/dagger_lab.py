"""DAgger by hand: the robot drives, the reader takes over where it errs, and the robot learns from the corrections."""

from __future__ import annotations

import anywidget
import traitlets

from robonav.networks.policy import NetworkPolicy

from .imitation_lab import imitation_lab
from .shared import front_end, style_sheet


class DaggerLab(anywidget.AnyWidget):
    """Train a weak robot, watch it fail, take over, and train it again."""

    _esm = front_end(
        "simulator", "maps", "episode", "steering", "files",
        "learning/random", "learning/worlds", "learning/network", "learning/lbfgs",
        "learning/astar", "learning/trials", "learning/worker", "learning/training_panel",
        "drives", "kept_robots", "imitation", "dagger_lab",
    )  # fmt: skip
    _css = style_sheet(
        "maps",
        "steering",
        "drives",
        "learning/training_panel",
        "imitation",
        "dagger_lab",
    )
    data = traitlets.Dict().tag(sync=True)


def dagger_lab(
    policy: NetworkPolicy,
    *,
    expert_seed: int = 7,
    maps: int = 200,
    test_seed: int = 2024,
) -> DaggerLab:
    """Make a lab in which the reader corrects a robot that has learned from one demonstration.

    Parameters
    ----------
    policy : NetworkPolicy
        The book's own, to compare with.
    expert_seed, test_seed : int
        Of the expert's world and of the worlds to test in. They must differ.
    maps : int
        Number of worlds to test in.

    Returns
    -------
    DaggerLab

    Raises
    ------
    ValueError
        If there is no map to test in, or the two seeds are equal.

    Examples
    --------
    >>> from robonav.benchmark.policies import method
    >>> sorted(dagger_lab(method("dagger"), maps=10).data)
    ['book', 'expert', 'playground', 'trial']
    """
    lab = imitation_lab(
        policy,
        demonstrations=1,
        expert_seed=expert_seed,
        maps=maps,
        test_seed=test_seed,
    )
    return DaggerLab(data=lab.data)
