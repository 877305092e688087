"""Worlds in files: a whole batch as npz, one world as TOML that a person can read and write."""

from __future__ import annotations

import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from robonav import archive
from robonav.validation import check_array, check_instance, check_one_of, check_real

from . import _fast
from .worlds import SIZE, START, TARGET, Worlds

FORMAT = "robonav worlds 1"
ENTRIES = ("size", "start", "target", "key", "obstacles")


def save_worlds(path: str | Path, worlds: Worlds) -> None:
    """Write a batch of worlds as an npz file.

    Parameters
    ----------
    path : path
        Of the file, which appears whole or not at all.
    worlds : Worlds
        The file holds its fields by name, and ``format``, "robonav worlds 1".

    Examples
    --------
    >>> import os, tempfile
    >>> from robonav.robot import load_worlds, random_worlds, save_worlds
    >>> worlds = random_worlds(3, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "worlds.npz")
    ...     save_worlds(path, worlds)
    ...     load_worlds(path).digest() == worlds.digest()
    True
    """
    check_instance("worlds", worlds, Worlds)
    arrays = {field.name: getattr(worlds, field.name) for field in fields(Worlds)}
    archive.write_archive(path, {"format": np.array(FORMAT)} | arrays)


def load_worlds(path: str | Path) -> Worlds:
    """Read what :func:`save_worlds` wrote.

    Parameters
    ----------
    path : path
        Of the file.

    Returns
    -------
    Worlds

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is damaged or of another format, or its worlds are not valid.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from robonav.robot import load_worlds, random_worlds, save_worlds
    >>> with TemporaryDirectory() as folder:
    ...     save_worlds(Path(folder) / "worlds.npz", random_worlds(3, seed=0))
    ...     len(load_worlds(Path(folder) / "worlds.npz"))
    3
    """
    try:
        arrays = archive.read_archive(path)
    except (archive.Damaged, archive.Pickled):
        raise ValueError(
            f"path must be a file of worlds, but {path} is damaged or of another kind"
        ) from None
    if str(arrays.pop("format", "")) != FORMAT:
        raise ValueError(
            f"path must be a file in the format {FORMAT!r}, but {path} is not"
        )
    missing = {field.name for field in fields(Worlds)} ^ set(arrays)
    if missing:
        raise ValueError(
            f"path must hold the fields of Worlds, but {path} differs in {', '.join(sorted(missing))}"
        )
    size = check_array("size", arrays.pop("size"), shape=()).item()
    return Worlds(**arrays, size=size)


def format_world(worlds: Worlds) -> str:
    """Write one world as TOML, which :func:`parse_world` reads.

    Parameters
    ----------
    worlds : Worlds
        A batch of one.

    Returns
    -------
    str
        Only angles lose their last bits, since the text has them in degrees.

    Examples
    --------
    >>> from robonav.robot import format_world, make_world
    >>> print(format_world(make_world(circles=[(40, 50, 3)])), end="")
    # metres, degrees and seconds
    size = 100.0
    start = [10.0, 10.0]
    target = [90.0, 90.0]
    key = [0, 0]
    obstacles = [
        {circle = [40.0, 50.0], radius = 3.0},
    ]
    """
    if len(check_instance("worlds", worlds, Worlds)) != 1:
        raise ValueError(f"worlds must be a batch of one, got {len(worlds)}")
    lines = [
        "# metres, degrees and seconds",
        f"size = {worlds.size!r}",
        f"start = {worlds.starts[0].tolist()}",
        f"target = {worlds.targets[0].tolist()}",
        f"key = {worlds.keys[0].tolist()}",
        "obstacles = [",
    ]
    for m in np.flatnonzero(worlds.kinds[0]):
        centre = worlds.centres[0, m].tolist()
        a, b, turned = worlds.shapes[0, m].tolist()
        if worlds.kinds[0, m] == _fast.CIRCLE:
            obstacle = f"circle = {centre}, radius = {a!r}"
        else:
            degrees = float(np.degrees(turned))
            obstacle = (
                f"rectangle = {centre}, sides = {[2 * a, 2 * b]}, turned = {degrees!r}"
            )
        if worlds.speeds[0, m] > 0:
            towards = float(np.degrees(worlds.headings[0, m]))
            obstacle += (
                f", speed = {float(worlds.speeds[0, m])!r}, towards = {towards!r}"
            )
        lines.append(f"    {{{obstacle}}},")
    return "\n".join([*lines, "]", ""])


def parse_world(text: str) -> Worlds:
    """Read one world from TOML.

    All of it may be missing. Rectangles may be turned and obstacles may move::

        size = 100
        start = [10, 10]
        target = [90, 90]
        obstacles = [
            {circle = [40, 50], radius = 3},
            {rectangle = [60, 30], sides = [8, 4], turned = 45},
            {circle = [70, 70], radius = 2, speed = 0.5, towards = 90},
        ]

    Parameters
    ----------
    text : str
        Metres, degrees and seconds. ``key``, two whole numbers, is the key of :class:`Worlds`.

    Returns
    -------
    Worlds
        A batch of one.

    Raises
    ------
    ValueError
        If the text is not TOML, an entry cannot be read, or the world is not valid. The message says where.

    Examples
    --------
    >>> from robonav.robot import parse_world
    >>> parse_world("obstacles = [{circle = [40, 50], radius = 3}]").centres
    array([[[40., 50.]]])
    """
    try:
        world = tomllib.loads(check_instance("text", text, str))
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"text must be a world in TOML: {error}") from None
    for name in world:
        check_one_of("entries of a world", name, ENTRIES)
    obstacles = check_instance("obstacles", world.get("obstacles", []), list)
    rows = [_parse_obstacle(number, each) for number, each in enumerate(obstacles, 1)]
    table = np.array(rows, dtype=float).reshape(len(rows), 8)
    return Worlds(
        kinds=table[None, :, 0].astype(np.int8),
        centres=table[None, :, 1:3],
        shapes=table[None, :, 3:6],
        speeds=table[None, :, 6],
        headings=table[None, :, 7],
        starts=check_array("start", [world.get("start", START)], shape=(1, 2)),
        targets=check_array("target", [world.get("target", TARGET)], shape=(1, 2)),
        keys=check_array(
            "key", [world.get("key", (0, 0))], shape=(1, 2), dtype=np.uint32
        ),
        size=world.get("size", SIZE),
    )


def _parse_obstacle(number: int, entry: Any) -> tuple[float, ...]:
    """Read kind, x, y, shape, speed and heading of an obstacle."""
    given = set(entry) if isinstance(entry, dict) else set()
    kind, extent = ("circle", "radius") if "circle" in given else ("rectangle", "sides")
    optional = {"speed", "towards"} | ({"turned"} if kind == "rectangle" else set())
    if not {kind, extent} <= given <= {kind, extent} | optional:
        raise ValueError(
            f"obstacle {number} of the world must be like {{circle = [40, 50], radius = 3}} or "
            "{rectangle = [60, 30], sides = [8, 4], turned = 45}, perhaps with speed = 0.5, towards = 90; "
            f"got {entry}"
        )
    if "towards" in given and "speed" not in given:
        raise ValueError(
            f"obstacle {number} of the world must have a speed to go towards {entry['towards']}"
        )
    x, y = check_array(f"obstacle {number}: {kind}", entry[kind], shape=(2,))
    numbers = {
        name: check_real(f"obstacle {number}: {name}", entry.get(name, 0.0))
        for name in optional
    }
    moves = numbers["speed"], np.radians(numbers["towards"])
    if kind == "circle":
        radius = check_real(f"obstacle {number}: radius", entry["radius"])
        return _fast.CIRCLE, x, y, radius, 0.0, 0.0, *moves
    sides = check_array(f"obstacle {number}: sides", entry["sides"], shape=(2,))
    return _fast.RECTANGLE, x, y, *(sides / 2), np.radians(numbers["turned"]), *moves
