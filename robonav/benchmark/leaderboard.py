"""The leaderboard: the methods of all chapters in the same worlds. No method was trained or tuned in these worlds.

The worlds are those of :func:`board_worlds`. :data:`DIGESTS` freezes version 1 of them, and every table names the
version.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.lfd import plan_on_grid
from robonav.robot import (
    Policy,
    PolicyWithMemory,
    Worlds,
    navigate,
    neighbour_slip,
    random_worlds,
)

from .evaluation import EXACT_REFLEX, outcome_rates
from .policies import method

VERSION = 1
SETS = 10  # number of sets of worlds; each set is one "seed" of the experiment
WORLDS = 200  # in a set
SEED = 77_000_000  # seed of the first set; no other experiment has seeds near it
ARRIVAL = 3.0  # metres from the target at which an episode may end, while a plan ends on the target
MARGIN = 2.0  # metres that a plan keeps from obstacles; every world has such a path


@dataclass(frozen=True)
class Setting:
    """One column of the leaderboard.

    Attributes
    ----------
    obstacles, moving : int
        The numbers of standing and of moving obstacles.
    speed : float
        Metres a second.
    noise : float
        Standard deviation of the noise on ranges, in metres.
    slip : float
        Probability that an action becomes one of its neighbours.

    Examples
    --------
    >>> Setting(20, slip=0.2)
    Setting(obstacles=20, moving=0, speed=2.0, noise=0.0, slip=0.2)
    """

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


def board_worlds(setting: str, number: int, worlds: int = WORLDS) -> Worlds:
    """Worlds of the leaderboard. Settings with the same obstacles share them.

    Parameters
    ----------
    setting : str
        A key of :data:`SETTINGS`.
    number : int
        The number of the set, from 0 to 9.
    worlds : int
        The number of worlds, starting with the first one of the set.

    Returns
    -------
    Worlds
        The batch.

    Examples
    --------
    >>> len(board_worlds("20 obstacles", 0, 5))
    5
    """
    chosen = SETTINGS[setting]
    return random_worlds(worlds, chosen.obstacles, chosen.moving, seed=SEED + number)


def digest(setting: str) -> str:
    """Return the SHA-256 of all worlds of a setting: the digest of the digests of its ten sets.

    Parameters
    ----------
    setting : str
        A key of :data:`SETTINGS`.

    Returns
    -------
    str
        64 hexadecimal digits.

    Examples
    --------
    >>> digest("10 obstacles") == DIGESTS["10 obstacles"]
    True
    """
    sets = [board_worlds(setting, number).digest() for number in range(SETS)]
    return hashlib.sha256("".join(sets).encode()).hexdigest()


@lru_cache(maxsize=64)
def shortest_paths(obstacles: int, number: int, worlds: int) -> NDArray[np.float64]:
    """Return the length of grid A*'s path in each world of a set, up to the distance of arrival.

    Parameters
    ----------
    obstacles : int
        The number of standing obstacles.
    number : int
        The number of the set, from 0 to 9.
    worlds : int
        The number of worlds, starting with the first one of the set.

    Returns
    -------
    (N,) array
        Metres.

    Examples
    --------
    >>> shortest_paths(10, 0, 3).round()
    array([107., 108., 113.])
    """
    drawn = random_worlds(worlds, obstacles, seed=SEED + number)
    lengths = [plan_on_grid(drawn[i], margin=MARGIN).length for i in range(worlds)]
    return np.array(lengths) - ARRIVAL


def spl(
    success: NDArray[np.bool_], lengths: ArrayLike, shortest: NDArray[np.float64]
) -> float:
    """Success weighted by path length (Anderson et al. 2018): the mean of the shortest length over the actual one.

    Parameters
    ----------
    success : (N,) array of bool
        Whether each episode arrived. The others count as 0.
    lengths : (N,) array
        The length of the robot's path in metres.
    shortest : (N,) array
        The length of the shortest path in metres.

    Returns
    -------
    float
        A number in [0, 1].

    Examples
    --------
    >>> spl(np.array([True, True, False]), [100.0, 200.0, 50.0], np.full(3, 100.0))
    0.5
    """
    ratio = shortest / np.maximum(lengths, shortest)
    return float(np.where(success, ratio, 0.0).mean())


def evaluate_on_board(
    name: str, setting: str, number: int, worlds: int = WORLDS
) -> dict[str, float]:
    """Outcome rates and SPL of a method in one set of worlds.

    Parameters
    ----------
    name : str
        A method, see :func:`robonav.benchmark.method`.
    setting : str
        A key of :data:`SETTINGS`.
    number : int
        The number of the set, from 0 to 9.
    worlds : int
        The number of worlds, starting with the first one of the set.

    Returns
    -------
    dict
        ``success``, ``collision``, ``out of steps`` and ``SPL``, in per cent. There is no SPL for moving obstacles,
        because they can block a planned path, or leave it free.

    Examples
    --------
    >>> evaluate_on_board("straight", "10 obstacles", 0, worlds=20)["success"] > 10
    True
    """
    return evaluate_policy(method(name), setting, number, worlds)


def evaluate_policy(
    policy: Policy | PolicyWithMemory,
    setting: str,
    number: int,
    worlds: int = WORLDS,
) -> dict[str, float]:
    """Outcome rates and SPL of any policy in one set of worlds.

    The reflex knows the exact direction of the target, as in all rows of the leaderboard.

    Parameters
    ----------
    policy : callable or PolicyWithMemory
        As :func:`robonav.robot.navigate` takes it.
    setting : str
        A key of :data:`SETTINGS`.
    number : int
        The number of the set, from 0 to 9.
    worlds : int
        The number of worlds, starting with the first one of the set.

    Returns
    -------
    dict
        As :func:`evaluate_on_board` returns it.

    Examples
    --------
    >>> from robonav.robot import turn_to_clearer_side
    >>> evaluate_policy(turn_to_clearer_side, "10 obstacles", 0, worlds=20)["success"] > 90
    True
    """
    chosen = SETTINGS[setting]
    navigation = navigate(
        policy,
        board_worlds(setting, number, worlds),
        chosen.speed,
        reflex=EXACT_REFLEX,
        slip=neighbour_slip(chosen.slip) if chosen.slip else None,
        noise=chosen.noise,
        seed=number,
    )
    rates = outcome_rates(navigation)
    if chosen.moving == 0:
        shortest = shortest_paths(chosen.obstacles, number, worlds)
        lengths = navigation.steps * chosen.speed
        rates["SPL"] = 100 * spl(navigation.success, lengths, shortest)
    return rates


DIGESTS: Mapping[str, str] = {
    "10 obstacles": "d576bd5adc0256653058399eb92c3dccbe21766f4aca64afa12cda63adaea794",
    "20 obstacles": "eb6ee24e263ea4e4a308afc9e2f75744d3d552bfca25f316822a274a3340384f",
    "30 obstacles": "bb94f98dce02971b249161cf377d27c20265bc40c5a30b9edc67f2109e94cb54",
    "10 and 10 moving": "607c5e47633b9e0f976d4e7aeb285b7c2bc6e2e5dcdc58cf2d831f972fab11c3",
}
"""The :func:`digest` of each setting that has worlds of its own. A paper can cite it."""
