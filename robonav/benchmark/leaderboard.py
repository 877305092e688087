"""One leaderboard for the methods of all chapters: the same worlds, kept from everything that was trained or tuned.

The worlds are those of :func:`board_worlds`, version 1 of them frozen by :data:`DIGESTS`. A table names the version.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.experiments.outcome_rates import rates
from robonav.experiments.runner.experiment import Case, Experiment
from robonav.lfd import plan_on_grid
from robonav.robot import Worlds, navigate, neighbour_slip, random_worlds

from .policies import fingerprint, method, methods

VERSION = 1
SETS = 10  # of worlds, each a "seed" of the experiment
WORLDS = {"quick": 20, "thesis": 200}
SEED = (
    77_000_000  # of the first set of the first setting; no other experiment comes near
)
ARRIVAL = 3.0  # metres: a drive ends this far from the target at most, a plan on it
MARGIN = 2.0  # that a plan keeps: every world has a way as wide as that


@dataclass(frozen=True)
class Setting:
    """One column of the board."""

    obstacles: int
    moving: int = 0
    speed: float = 2.0
    noise: float = 0.0
    slip: float = 0.0


SETTINGS: Mapping[str, Setting] = {
    "10 obstacles": Setting(10),
    "20 obstacles": Setting(20),
    "30 obstacles": Setting(30),
    "10 and 10 moving": Setting(10, moving=10),
    "20, ranges off by 0.5 m": Setting(20, noise=0.5),
    "20, a fifth of actions slips": Setting(20, slip=0.2),
    "20, 1 m/s": Setting(20, speed=1.0),
    "20, 3 m/s": Setting(20, speed=3.0),
    "20, 4 m/s": Setting(20, speed=4.0),
}


def board_worlds(setting: str, number: int, worlds: int) -> Worlds:
    """The first so many worlds of one set of a setting; settings with as many obstacles share them."""
    chosen = SETTINGS[setting]
    return random_worlds(worlds, chosen.obstacles, chosen.moving, seed=SEED + number)


def digest(setting: str) -> str:
    """SHA-256 of all worlds of a setting: of the digests of its ten sets of 200, one after the other."""
    sets = [
        board_worlds(setting, number, WORLDS["thesis"]).digest()
        for number in range(SETS)
    ]
    return hashlib.sha256("".join(sets).encode()).hexdigest()


@lru_cache(maxsize=64)
def shortest_ways(obstacles: int, number: int, worlds: int) -> NDArray[np.float64]:
    """Length of grid A*'s way through each world (N,), up to where the robot counts as arrived."""
    drawn = random_worlds(worlds, obstacles, seed=SEED + number)
    lengths = [plan_on_grid(drawn[i], margin=MARGIN).length for i in range(worlds)]
    return np.array(lengths) - ARRIVAL


def spl(
    success: NDArray[np.bool_], driven: ArrayLike, shortest: NDArray[np.float64]
) -> float:
    """Success weighted by path length (Anderson et al. 2018): the mean of shortest over driven length."""
    return float(np.where(success, shortest / np.maximum(driven, shortest), 0.0).mean())


def entry(case: Case, seed: int, scale: str) -> dict[str, float]:
    """How a method does on one set of worlds of a setting."""
    setting, worlds = SETTINGS[str(case["setting"])], WORLDS[scale]
    drives = navigate(
        method(str(case["method"])),
        board_worlds(str(case["setting"]), seed, worlds),
        setting.speed,
        slip=neighbour_slip(setting.slip) if setting.slip else None,
        noise=setting.noise,
        seed=seed,
    )
    numbers = rates(drives)
    if setting.moving == 0:  # what moves may stand in the way of a plan, or leave it
        shortest = shortest_ways(setting.obstacles, seed, worlds)
        numbers["SPL"] = 100 * spl(
            drives.success, drives.steps * setting.speed, shortest
        )
    return numbers


def board(names: Sequence[str]) -> Experiment:
    """The leaderboard of some methods: those that ship, or files of a reader's own."""
    return Experiment(
        name="leaderboard",
        title="Methods on the same worlds, which none that ships was trained or tuned on",
        cases=[
            {"method": name, "setting": setting}
            for name in names
            for setting in SETTINGS
        ],
        run=entry,
        seeds={"quick": 1, "thesis": SETS},
        settings={
            "version of the worlds": VERSION,
            "worlds a set": WORLDS,
            "a run": "a set of worlds; each method is one policy, as it ships",
            "settings": {name: vars(setting) for name, setting in SETTINGS.items()},
            "methods": {name: fingerprint(name) for name in names},
        },
    )


EXPERIMENTS = (board(methods()),)

DIGESTS: Mapping[str, str] = {
    "10 obstacles": "d576bd5adc0256653058399eb92c3dccbe21766f4aca64afa12cda63adaea794",
    "20 obstacles": "eb6ee24e263ea4e4a308afc9e2f75744d3d552bfca25f316822a274a3340384f",
    "30 obstacles": "bb94f98dce02971b249161cf377d27c20265bc40c5a30b9edc67f2109e94cb54",
    "10 and 10 moving": "607c5e47633b9e0f976d4e7aeb285b7c2bc6e2e5dcdc58cf2d831f972fab11c3",
}
"""The :func:`digest` of each setting that has worlds of its own: a paper can cite them."""
