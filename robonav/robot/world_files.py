"""Worlds in files: a whole batch as npz, one world as text that a person can read and write."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

import numpy as np

from robonav import archive
from robonav.validation import check_array, check_instance

from . import _fast
from .worlds import SIZE, START, TARGET, Worlds

FORMAT = "robonav worlds 1"


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
    """Write one world as text, which :func:`parse_world` reads.

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
    size 100.0
    start 10.0 10.0
    target 90.0 90.0
    key 0 0
    circle 40.0 50.0 radius 3.0
    """
    if len(check_instance("worlds", worlds, Worlds)) != 1:
        raise ValueError(f"worlds must be a batch of one, got {len(worlds)}")
    start, target, key = worlds.starts[0], worlds.targets[0], worlds.keys[0]
    lines = [
        "# metres, degrees and seconds",
        f"size {worlds.size!r}",
        f"start {float(start[0])!r} {float(start[1])!r}",
        f"target {float(target[0])!r} {float(target[1])!r}",
        f"key {key[0]} {key[1]}",
    ]
    for m in np.flatnonzero(worlds.kinds[0]):
        x, y = (float(v) for v in worlds.centres[0, m])
        a, b, turned = (float(v) for v in worlds.shapes[0, m])
        if worlds.kinds[0, m] == _fast.CIRCLE:
            line = f"circle {x!r} {y!r} radius {a!r}"
        else:
            line = f"rectangle {x!r} {y!r} sides {2 * a!r} {2 * b!r} turned {float(np.degrees(turned))!r}"
        if worlds.speeds[0, m] > 0:
            heading = float(np.degrees(worlds.headings[0, m]))
            line += f" speed {float(worlds.speeds[0, m])!r} towards {heading!r}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def parse_world(text: str) -> Worlds:
    """Read one world from text.

    There is one line for each obstacle, and one each for size, start, target and key, which may be missing. After a #
    come comments::

        size 100
        start 10 10
        target 90 90
        circle 40 50 radius 3
        rectangle 60 30 sides 8 4 turned 45
        circle 70 70 radius 2 speed 0.5 towards 90    # moves

    Parameters
    ----------
    text : str
        Metres, degrees and seconds.

    Returns
    -------
    Worlds
        A batch of one.

    Raises
    ------
    ValueError
        If a line cannot be read (the message names it), or if the world is not valid.

    Examples
    --------
    >>> from robonav.robot import parse_world
    >>> parse_world("circle 40 50 radius 3").centres
    array([[[40., 50.]]])
    """
    header: dict[str, list[float]] = {
        "size": [SIZE],
        "start": [*START],
        "target": [*TARGET],
        "key": [0, 0],
    }
    rows, seen = [], set()
    for number, line in enumerate(
        check_instance("text", text, str).splitlines(), start=1
    ):
        words = line.partition("#")[0].split()
        if not words:
            continue
        try:
            if words[0] in header:
                values = [float(word) for word in words[1:]]
                if len(values) != len(header[words[0]]) or words[0] in seen:
                    raise ValueError
                seen.add(words[0])
                header[words[0]] = values
            else:
                rows.append(_parse_obstacle(words))
        except (ValueError, KeyError):
            raise ValueError(
                f"line {number} of the world must be like 'circle 40 50 radius 3' or 'rectangle 60 30 sides 8 4 "
                f"turned 45', perhaps with 'speed 0.5 towards 90', or 'size', 'start', 'target', 'key' and numbers; "
                f"got {line.strip()!r}"
            ) from None
    table = np.array(rows, dtype=float).reshape(len(rows), 8)
    key = header["key"]
    if any(not 0 <= word < 2**32 or word != int(word) for word in key):
        raise ValueError(f"key must be two whole numbers of 32 bits, got {key}")
    return Worlds(
        kinds=table[None, :, 0].astype(np.int8),
        centres=table[None, :, 1:3],
        shapes=table[None, :, 3:6],
        speeds=table[None, :, 6],
        headings=table[None, :, 7],
        starts=np.array([header["start"]]),
        targets=np.array([header["target"]]),
        keys=np.array([key]).astype(np.uint32),
        size=header["size"][0],
    )


def _parse_obstacle(words: list[str]) -> tuple[float, ...]:
    """Read kind, x, y, shape, speed and heading from an obstacle's words; raise ValueError or KeyError if it fails."""
    kind, rest = words[0], words[1:]
    lengths = {"circle": {"radius": 1}, "rectangle": {"sides": 2, "turned": 1}}[
        kind
    ] | {"speed": 1, "towards": 1}
    x, y = (float(word) for word in rest[:2])
    rest = rest[2:]
    values: dict[str, list[float]] = {}
    while rest:
        name = rest.pop(0)
        if name in values or len(rest) < lengths[name]:
            raise ValueError
        values[name] = [float(rest.pop(0)) for _ in range(lengths[name])]
    if "towards" in values and "speed" not in values:
        raise ValueError
    speed, towards = (
        values.get("speed", [0.0])[0],
        np.radians(values.get("towards", [0.0])[0]),
    )
    if kind == "circle":
        return _fast.CIRCLE, x, y, values["radius"][0], 0.0, 0.0, speed, towards
    length, width = values["sides"]
    return (
        _fast.RECTANGLE,
        x,
        y,
        length / 2,
        width / 2,
        np.radians(values.get("turned", [0.0])[0]),
        speed,
        towards,
    )
