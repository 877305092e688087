"""Worlds: square maps of circles and rectangles, standing or moving, with a start and a target (section 2.5)."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import (
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
)

from . import _fast

SIZE = 100.0
START, TARGET = (10.0, 10.0), (90.0, 90.0)
MOVING_SPEEDS = (0.4, 0.9)  # slower than the slowest robot, which goes 1 m/s
FASTEST = 4.0  # m/s that an obstacle may have: the robot's own greatest speed
LARGEST_MAP = 1000.0
MOST_WORLDS = 10_000_000
ATTEMPTS = 1000

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Worlds:
    """A batch of N worlds with up to M obstacles each; ``worlds[i]`` is a batch of one.

    Attributes
    ----------
    kinds : (N, M) 0 no obstacle, 1 circle, 2 rectangle.
    shapes : (N, M, 3) radius, 0, 0 of a circle; half length, half width and angle in radians of a rectangle; metres.
    centres : (N, M, 2) where obstacles stand at the start.
    speeds, headings : (N, M) of moving obstacles, in m/s and radians; speed 0 stands still.
    starts, targets : (N, 2) of the robot.
    keys : (N, 2) of 32 bits: what is random while driving (moving obstacles, noise, slips) hangs on them alone.
    size : side of the map in metres.

    Raises
    ------
    ValueError : for shapes that do not fit, numbers that are not finite, a radius or side that is not positive, an
        obstacle over a start or target, or any of these outside the map.
    """

    kinds: NDArray[np.int8]
    shapes: Floats
    centres: Floats
    speeds: Floats
    headings: Floats
    starts: Floats
    targets: Floats
    keys: NDArray[np.uint32]
    size: float = SIZE

    def __post_init__(self) -> None:
        n, m = np.shape(self.kinds) if np.ndim(self.kinds) == 2 else (0, 0)
        wanted: dict[str, tuple[tuple[int | str, ...], Any]] = {
            "kinds": (("N", "M"), np.int8),
            "shapes": ((n, m, 3), np.float64),
            "centres": ((n, m, 2), np.float64),
            "speeds": ((n, m), np.float64),
            "headings": ((n, m), np.float64),
            "starts": ((n, 2), np.float64),
            "targets": ((n, 2), np.float64),
            "keys": ((n, 2), np.uint32),
        }
        for name, (shape, dtype) in wanted.items():
            checked = check_array(
                f"worlds: {name}", getattr(self, name), shape=shape, dtype=dtype
            )
            object.__setattr__(self, name, np.array(checked, order="C"))
        object.__setattr__(self, "size", check_positive("worlds: size", self.size))
        check_integer("worlds: obstacle slots", m, at_most=_fast.MAX_OBSTACLES)
        self._check_obstacles()
        self._check_endpoints()

    def _check_obstacles(self) -> None:
        there = self.kinds != _fast.NOTHING
        circles, rectangles = self.kinds == _fast.CIRCLE, self.kinds == _fast.RECTANGLE
        if (there & ~circles & ~rectangles).any():
            raise ValueError(
                "worlds: kinds must be 0 (nothing), 1 (circle) or 2 (rectangle)"
            )
        if (self.shapes[circles][:, 0] <= 0).any():
            raise ValueError(
                f"worlds: radius must be positive, got {self.shapes[circles][:, 0].min():g}"
            )
        if (self.shapes[rectangles][:, :2] <= 0).any():
            raise ValueError(
                f"worlds: sides must be positive, got {2 * self.shapes[rectangles][:, :2].min():g}"
            )
        if self.shapes[circles][:, 1:].any():
            raise ValueError("worlds: shapes of circles must be a radius, 0 and 0")
        if (self.speeds[there] < 0).any():
            raise ValueError(
                f"worlds: obstacle speed must be at least 0, got {self.speeds[there].min():g}"
            )
        outside = (self.centres[there] < 0) | (self.centres[there] > self.size)
        if outside.any():
            where = self.centres[there][outside.any(axis=1)][0]
            raise ValueError(
                f"worlds: obstacles must have their centre in the map, 0 to {self.size:g} m, got {_point(where)}"
            )

        reach = np.where(
            circles,
            self.shapes[..., 0],
            np.hypot(self.shapes[..., 0], self.shapes[..., 1]),
        )
        moving = there & (self.speeds > 0)
        near = np.minimum(self.centres, self.size - self.centres).min(axis=-1)
        if (moving & (near < reach)).any():
            where = self.centres[moving & (near < reach)][0]
            raise ValueError(
                f"worlds: moving obstacles must lie wholly in the map, got one at {_point(where)}"
            )
        if (moving & (self.speeds > FASTEST)).any():
            raise ValueError(
                f"worlds: obstacle speed must be at most {FASTEST:g} m/s, got {self.speeds[moving].max():g}"
            )

    def _check_endpoints(self) -> None:
        for name, points in (("start", self.starts), ("target", self.targets)):
            if ((points < 0) | (points > self.size)).any():
                bad = points[((points < 0) | (points > self.size)).any(axis=1)][0]
                raise ValueError(
                    f"worlds: {name} must lie in the map, 0 to {self.size:g} m, got {_point(bad)}"
                )
            for i, gap in enumerate(clearance(self, points)):
                if gap < _fast.COLLISION_DISTANCE:
                    raise ValueError(
                        f"worlds: {name} {_point(points[i])} of world {i} must be at least "
                        f"{_fast.COLLISION_DISTANCE:g} m clear of obstacles and borders, got {gap:.3g} m"
                    )

    def __len__(self) -> int:
        return len(self.kinds)

    def __getitem__(self, index: int | slice | ArrayLike) -> Worlds:
        """Worlds picked by a slice, indices or a mask, copied; one whole number gives a batch of one."""
        if not isinstance(index, slice) and (
            isinstance(index, bool | tuple) or np.ndim(index) > 1
        ):
            raise TypeError(
                f"worlds are picked by a whole number, a slice, a list or a mask, got {index!r}"
            )
        if not isinstance(index, slice) and np.ndim(index) == 0:
            number = check_integer("world", index)
            if not -len(self) <= number < len(self):
                raise IndexError(f"world {number} of a batch of {len(self)}")
            index = [number]
        picked = Worlds.__new__(Worlds)  # rows of a checked batch need no second check
        for field in fields(self):
            value = getattr(self, field.name)
            kept = value if field.name == "size" else np.array(value[index], order="C")
            object.__setattr__(picked, field.name, kept)
        return picked

    def __iter__(self) -> Iterator[Worlds]:
        return (self[i] for i in range(len(self)))

    @property
    def slots(self) -> int:
        """M, the number of places for obstacles."""
        return self.kinds.shape[1]

    def with_slots(self, slots: int) -> Worlds:
        """The same worlds with empty places for obstacles added up to ``slots``."""
        more = slots - self.slots
        if more == 0:
            return self
        padded = self[:]
        for name in ("kinds", "shapes", "centres", "speeds", "headings"):
            value = getattr(self, name)
            object.__setattr__(
                padded,
                name,
                np.pad(value, [(0, 0), (0, more)] + [(0, 0)] * (value.ndim - 2)),
            )
        return padded

    @property
    def start_poses(self) -> Floats:
        """Poses (N, 3) at the start: x, y and heading; the robot faces its target."""
        bearing = np.arctan2(
            self.targets[:, 1] - self.starts[:, 1],
            self.targets[:, 0] - self.starts[:, 0],
        )
        return np.column_stack([self.starts, bearing])

    def digest(self) -> str:
        """SHA-256 of the worlds to the micrometre: equal for equal worlds on any machine."""
        lengths = (
            self.shapes,
            self.centres,
            self.speeds,
            self.headings,
            self.starts,
            self.targets,
            self.size,
        )
        parts = [np.round(np.asarray(part) * 1e6).astype("<i8") for part in lengths]
        parts += [self.kinds.astype("<i1"), self.keys.astype("<u4")]
        return hashlib.sha256(
            b"".join(np.ascontiguousarray(part).tobytes() for part in parts)
        ).hexdigest()


def _point(place: Floats) -> str:
    return f"({place[0]:g}, {place[1]:g})"


def clearance(worlds: Worlds, points: ArrayLike) -> Floats:
    """Distance (N,) in metres from one point of each world (N, 2) to its nearest obstacle or border."""
    check_instance("worlds", worlds, Worlds)
    places = check_array("points", points, shape=(len(worlds), 2))
    return np.array(
        [
            _fast.swept_clearance(
                w.kinds[0],
                w.shapes[0],
                w.centres[0],
                w.centres[0],
                w.size,
                x,
                y,
                x,
                y,
                np.inf,
            )
            for w, (x, y) in zip(worlds, places, strict=True)
        ]
    )


def world_keys(n: int, seed: int) -> NDArray[np.uint32]:
    """Keys (n, 2) of the worlds of a seed; key i depends on (seed, i) alone (splitmix64, Steele et al. 2014)."""
    golden = 0x9E3779B97F4A7C15
    origin = np.random.SeedSequence(seed).generate_state(1, np.uint64)[0]
    with np.errstate(over="ignore"):
        z = origin + np.arange(1, n + 1, dtype=np.uint64) * np.uint64(golden)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z = z ^ (z >> np.uint64(31))
    return np.column_stack([z & np.uint64(0xFFFFFFFF), z >> np.uint64(32)]).astype(
        np.uint32
    )


def random_worlds(
    n: int,
    obstacles: int = 10,
    moving: int = 0,
    *,
    seed: int | np.random.Generator,
    starts: Sequence[tuple[float, float]] = (START,),
    targets: Sequence[tuple[float, float]] = (TARGET,),
    moving_speeds: tuple[float, float] = MOVING_SPEEDS,
    size: float = SIZE,
) -> Worlds:
    """Draw n worlds in which the target can be reached with 2 m to spare (section 3.6; frozen, see ``digest``).

    Half of the obstacles are circles of radius 1.5 to 4 m, half rectangles of sides 3 to 8 m turned at random, none
    within 6 m of start or target. World i depends on (seed, i) alone.

    Parameters
    ----------
    n : number of worlds; 0 is legal.
    obstacles, moving : how many stand still and how many move on top of them; 0 of either is legal.
    seed : whole number or Generator.
    starts, targets : points of which each world gets one at random.
    moving_speeds : least and greatest speed of moving obstacles, in m/s.
    size : side of the map in metres.

    Raises
    ------
    ValueError : if an argument is out of bounds, or no solvable map was found in 1000 draws.
    """
    check_integer("n", n, at_least=0, at_most=MOST_WORLDS)
    check_drawing(obstacles, moving, starts, targets, moving_speeds, size)
    if isinstance(seed, np.random.Generator):
        seed = int(seed.integers(2**63))
    keys = world_keys(n, check_integer("seed", seed, at_least=0))
    return draw_worlds(keys, obstacles, moving, starts, targets, moving_speeds, size)


def check_drawing(
    obstacles: int,
    moving: int,
    starts: Sequence[tuple[float, float]],
    targets: Sequence[tuple[float, float]],
    moving_speeds: tuple[float, float],
    size: float,
) -> None:
    """Refuse settings from which no worlds can be drawn, see :func:`random_worlds`."""
    check_integer("obstacles", obstacles, at_least=0)
    check_integer("moving", moving, at_least=0)
    check_integer("obstacles + moving", obstacles + moving, at_most=_fast.MAX_OBSTACLES)
    check_real("size", size, at_least=30, at_most=LARGEST_MAP)
    for name, points in (("starts", starts), ("targets", targets)):
        ends = check_array(name, points, shape=("number", 2))
        if (
            len(ends) == 0
            or (ends < _fast.SPARE).any()
            or (ends > size - _fast.SPARE).any()
        ):
            raise ValueError(
                f"{name} must be points in the map, {_fast.SPARE:g} m or more from its borders"
            )
    slowest, fastest = check_array("moving_speeds", moving_speeds, shape=(2,))
    if not 0 <= slowest <= fastest <= FASTEST:
        raise ValueError(
            f"moving_speeds must be the least and the greatest, from 0 to {FASTEST:g} m/s, got {slowest:g}, {fastest:g}"
        )


def draw_worlds(
    keys: NDArray[np.uint32],
    obstacles: int,
    moving: int,
    starts: Sequence[tuple[float, float]] = (START,),
    targets: Sequence[tuple[float, float]] = (TARGET,),
    moving_speeds: tuple[float, float] = MOVING_SPEEDS,
    size: float = SIZE,
) -> Worlds:
    """The worlds (N) that belong to ``keys`` (N, 2); see :func:`random_worlds`."""
    n, m = len(keys), obstacles + moving
    kinds = np.zeros((n, m), dtype=np.int8)
    shapes, centres = np.zeros((n, m, 3)), np.zeros((n, m, 2))
    speeds, headings = np.zeros((n, m)), np.zeros((n, m))
    chosen, found = np.zeros((n, 4)), np.zeros(n, dtype=np.bool_)
    _fast.in_threads(
        _fast.draw_worlds, n, keys, obstacles, moving, float(moving_speeds[0]), float(moving_speeds[1]), float(size),
        np.array(starts, dtype=float), np.array(targets, dtype=float), ATTEMPTS, kinds, shapes, centres, speeds,
        headings, chosen, found, worth=8,
    )  # fmt: skip
    if not found.all():
        raise ValueError(
            f"obstacles must leave a way to the target: {ATTEMPTS} draws with {obstacles} standing and "
            f"{moving} moving obstacles in {size:g} m gave no solvable map; take fewer"
        )
    drawn = Worlds.__new__(
        Worlds
    )  # right by construction: the checks would cost more than the drawing
    values = (
        kinds,
        shapes,
        centres,
        speeds,
        headings,
        chosen[:, :2].copy(),
        chosen[:, 2:].copy(),
        keys,
        float(size),
    )
    for field, value in zip(fields(Worlds), values, strict=True):
        object.__setattr__(drawn, field.name, value)
    return drawn


def make_world(
    circles: Sequence[tuple[float, float, float]] = (),
    rectangles: Sequence[tuple[float, float, float, float, float]] = (),
    *,
    start: tuple[float, float] = START,
    target: tuple[float, float] = TARGET,
    size: float = SIZE,
    key: tuple[int, int] = (0, 0),
) -> Worlds:
    """One world with standing obstacles, by hand.

    Parameters
    ----------
    circles : (x, y, radius) each, in metres.
    rectangles : (x, y, length, width, angle) each, in metres and degrees.
    """
    round_ones: Any = (
        check_array("circles", circles, shape=("number", 3)) if len(circles) else []
    )
    square_ones: Any = (
        check_array("rectangles", rectangles, shape=("number", 5))
        if len(rectangles)
        else []
    )
    rows = [(_fast.CIRCLE, x, y, radius, 0.0, 0.0) for x, y, radius in round_ones]
    rows += [
        (_fast.RECTANGLE, x, y, a / 2, b / 2, np.radians(turned))
        for x, y, a, b, turned in square_ones
    ]
    table = np.array(rows, dtype=float).reshape(len(rows), 6)
    return Worlds(
        kinds=table[None, :, 0].astype(np.int8),
        centres=table[None, :, 1:3],
        shapes=table[None, :, 3:],
        speeds=np.zeros((1, len(rows))),
        headings=np.zeros((1, len(rows))),
        starts=np.array([start], dtype=float),
        targets=np.array([target], dtype=float),
        keys=check_array("key", [key], shape=(1, 2), dtype=np.uint32),
        size=size,
    )


def concatenate(batches: Sequence[Worlds]) -> Worlds:
    """One batch of several of the same map size; missing obstacle slots stay empty."""
    if len(batches) == 0:
        raise ValueError("batches must hold at least one batch of worlds")
    for batch in batches:
        check_instance("batches", batch, Worlds)
    if len({batch.size for batch in batches}) > 1:
        raise ValueError(
            f"batches must have one map size, got {sorted({batch.size for batch in batches})}"
        )
    slots = max(batch.slots for batch in batches)
    padded = [batch.with_slots(slots) for batch in batches]
    joined = {
        field.name: np.concatenate([getattr(batch, field.name) for batch in padded])
        for field in fields(Worlds)
        if field.name != "size"
    }
    return Worlds(**joined, size=batches[0].size)
