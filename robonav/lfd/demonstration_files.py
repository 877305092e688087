"""Demonstrations in files: to keep them, to send them, and to use recordings made by other programs.

A file is a NumPy npz archive, that is, a zip file of arrays. Many programs other than Python can write one. It contains
no Python objects, so reading a file never runs code from it. K is the number of steps, D the number of trajectories.

=================  ===========  =====================================================================================
array              shape        content
=================  ===========  =====================================================================================
format             ()           the text ``robonav demonstrations 1``, as Unicode or as bytes
speed              ()           m/s
trajectory         (K,)         whole number: the trajectory that each step belongs to, from 0, ascending
actions            (K,)         whole number: 0 F, 1 L30, 2 L60, 3 R30, 4 R60, 5 B, 6 turn to the target and go,
                                7 turn to the middle of the target's sector and go
poses              (K, 3)       x, y in metres and heading in radians, before each action
ranges             (K, 9)       metres, 10 if nothing is in range; column 0 is ahead, then counter-clockwise
walls              (K, 9)       true or false: whether the range is that of the map's border
target_region      (K,)         whole number 1..9
target_seen        (K,)         true or false
outcome            (D,)         whole number: 1 arrived, 2 collided, 3 out of steps
worlds.kinds, ...               the fields of ``robonav.robot.Worlds``, D of them
=================  ===========  =====================================================================================
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav import archive
from robonav.robot import OUTCOMES, Sensing, Worlds
from robonav.validation import check_array, check_instance

from .demonstrations import Demonstrations

FORMAT = "robonav demonstrations 1"
_STEPS = ("trajectory", "actions", "poses", "speed")
_SENSED = {
    "ranges": float,
    "walls": bool,
    "target_region": np.int64,
    "target_seen": bool,
}
_WORLDS = tuple(field.name for field in fields(Worlds))


def save_demonstrations(path: str | Path, demonstrations: Demonstrations) -> None:
    """Write demonstrations to an npz file in the format described above.

    The file is written completely or not at all: an error leaves a file that was there before unchanged.

    Parameters
    ----------
    path : str or Path
        Of the file, usually with the ending ``.npz``.
    demonstrations : Demonstrations
        By any expert.

    Raises
    ------
    TypeError
        If ``demonstrations`` is not Demonstrations.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from robonav.lfd import demonstrate, load_demonstrations, save_demonstrations
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=10, seed=1))
    >>> with TemporaryDirectory() as folder:
    ...     save_demonstrations(Path(folder) / "mine.npz", demonstrations)
    ...     len(load_demonstrations(Path(folder) / "mine.npz")) == len(demonstrations)
    True
    """
    check_instance("demonstrations", demonstrations, Demonstrations)
    arrays: dict[str, Any] = {name: getattr(demonstrations, name) for name in _STEPS}
    arrays |= {name: getattr(demonstrations.sensing, name) for name in _SENSED}
    arrays |= {
        f"worlds.{name}": getattr(demonstrations.worlds, name) for name in _WORLDS
    }
    order = np.argsort(OUTCOMES)
    arrays["outcome"] = order[
        np.searchsorted(OUTCOMES, demonstrations.outcome, sorter=order)
    ].astype(np.int8)
    archive.write_archive(path, {"format": np.array(FORMAT)} | arrays)


def load_demonstrations(path: str | Path) -> Demonstrations:
    """Read demonstrations from an npz file in the format described above.

    Parameters
    ----------
    path : str or Path
        Of the file.

    Returns
    -------
    Demonstrations

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is damaged, has another format, contains a pickled object, lacks an array or has one too many, or
        if an array holds values that demonstrations cannot have.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from robonav.lfd import demonstrate, load_demonstrations, save_demonstrations
    >>> from robonav.robot import random_worlds
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "mine.npz"
    ...     save_demonstrations(path, demonstrate(random_worlds(2, obstacles=10, seed=1)))
    ...     load_demonstrations(path).outcome.tolist()
    ['arrived', 'arrived']
    """
    name = Path(path).name
    try:
        arrays = archive.read_archive(path)
    except archive.Pickled:
        raise ValueError(
            f"{name} holds a pickled object, which could run code and is never loaded"
        ) from None
    except archive.Damaged:
        raise ValueError(f"{name} is damaged, or is not an npz archive") from None
    written = _text(arrays.pop("format", np.array("")))
    if written != FORMAT:
        raise ValueError(f"{name} has the format {written!r}, expected {FORMAT!r}")
    wanted = {*_STEPS, *_SENSED, "outcome", *(f"worlds.{field}" for field in _WORLDS)}
    if wanted != set(arrays):
        raise ValueError(
            f"{name} differs from {FORMAT!r} in {', '.join(sorted(wanted ^ set(arrays)))}"
        )
    try:
        return _demonstrations(arrays)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} does not hold demonstrations: {error}") from None


def _text(array: NDArray[Any]) -> str:
    """Return the text that an array holds. Languages without Unicode arrays write it as bytes."""
    if array.dtype.kind == "S":
        array = np.char.decode(array, "utf-8", errors="replace")
    return str(array)


def _demonstrations(arrays: Mapping[str, NDArray[Any]]) -> Demonstrations:
    """Return demonstrations from the arrays of a file, after checks of each array."""
    steps = check_array("actions", arrays["actions"], shape=("K",)).shape[0]
    shapes = {
        "ranges": (steps, 9),
        "walls": (steps, 9),
        "target_region": (steps,),
        "target_seen": (steps,),
    }
    sensed = {
        key: check_array(key, arrays[key], shape=shapes[key], dtype=dtype)
        for key, dtype in _SENSED.items()
    }
    within = {"ranges": (0, 10), "target_region": (1, 9)}
    for key, (least, most) in within.items():
        if ((sensed[key] < least) | (sensed[key] > most)).any():
            raise ValueError(f"{key} must lie in {least}..{most}")
    outcome = check_array("outcome", arrays["outcome"], shape=("D",), dtype=np.int64)
    if len(outcome) and not 1 <= outcome.min() <= outcome.max() <= 3:
        raise ValueError(
            f"outcome must lie in 1..3, got {outcome.min()}..{outcome.max()}"
        )
    worlds = {field: arrays[f"worlds.{field}"] for field in _WORLDS}
    return Demonstrations(
        worlds=Worlds(**(worlds | {"size": worlds["size"].item()})),
        trajectory=arrays["trajectory"],
        sensing=Sensing(**sensed),
        actions=arrays["actions"],
        poses=arrays["poses"],
        speed=arrays["speed"].item(),
        outcome=OUTCOMES[outcome],
    )
