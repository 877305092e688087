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
    kinds : (N, M) int array
        0 no obstacle, 1 circle, 2 rectangle.
    shapes : (N, M, 3) array
        Radius, 0, 0 of a circle; half length, half width and angle in radians of a rectangle; metres.
    centres : (N, M, 2) array
        Where obstacles stand at the start, in metres.
    speeds, headings : (N, M) array
        Of moving obstacles, in m/s and radians. An obstacle of speed 0 stands still.
    starts, targets : (N, 2) array
        Of the robot, in metres.
    keys : (N, 2) array of uint32
        All that is random during an episode (moving obstacles, noise, slips) depends on these alone.
    size : float
        Side of the map in metres.

    Raises
    ------
    ValueError
        If shapes do not fit, numbers are not finite, a radius or side is not positive, an obstacle covers a start or
        target, or any of these lies outside the map.

    Examples
    --------
    >>> from robonav.robot import random_worlds
    >>> worlds = random_worlds(5, obstacles=10, seed=1)
    >>> len(worlds), worlds.centres.shape, len(worlds[[0, 3]])
    (5, (5, 10, 2), 2)
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
        """Pick worlds by a slice, indices or a mask, as copies; one whole number gives a batch of one."""
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
        picked = Worlds.__new__(Worlds)  # rows of a checked batch are valid
        for field in fields(self):
            value = getattr(self, field.name)
            kept = value if field.name == "size" else np.array(value[index], order="C")
            object.__setattr__(picked, field.name, kept)
        return picked

    def __iter__(self) -> Iterator[Worlds]:
        return (self[i] for i in range(len(self)))

    @property
    def slots(self) -> int:
        """M, the number of obstacle slots."""
        return self.kinds.shape[1]

    def with_slots(self, slots: int) -> Worlds:
        """Return the same worlds with empty obstacle slots added.

        Parameters
        ----------
        slots : int
            How many slots there are then.

        Returns
        -------
        Worlds

        Examples
        --------
        >>> from robonav.robot import random_worlds
        >>> random_worlds(2, obstacles=3, seed=1).with_slots(5).kinds
        array([[1, 2, 1, 0, 0],
               [1, 2, 1, 0, 0]], dtype=int8)
        """
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

    def put(self, index: NDArray[np.int64], worlds: Worlds) -> None:
        """Replace some worlds of this batch, in place, by others with as many slots.

        Parameters
        ----------
        index : (K,) array of int
            Which worlds.
        worlds : Worlds
            K other worlds.

        Examples
        --------
        >>> from robonav.robot import random_worlds
        >>> worlds, others = random_worlds(3, seed=1), random_worlds(1, seed=2)
        >>> worlds.put([2], others)
        >>> worlds[2].digest() == others.digest()
        True
        """
        for field in fields(self):
            if field.name != "size":
                getattr(self, field.name)[index] = getattr(worlds, field.name)

    @property
    def start_poses(self) -> Floats:
        """Poses (N, 3) at the start: x, y and heading. The robot faces its target."""
        bearing = np.arctan2(
            self.targets[:, 1] - self.starts[:, 1],
            self.targets[:, 0] - self.starts[:, 0],
        )
        return np.column_stack([self.starts, bearing])

    def digest(self) -> str:
        """Return the SHA-256 of the worlds, rounded to a micrometre; equal worlds give equal digests on any machine.

        Returns
        -------
        str

        Examples
        --------
        >>> from robonav.robot import random_worlds
        >>> random_worlds(2, seed=1).digest()[:8]
        '48092f20'
        """
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
    """Return the distance from one point of each world to its nearest obstacle or border.

    Parameters
    ----------
    worlds : Worlds
        A batch of N.
    points : (N, 2) array
        In metres.

    Returns
    -------
    (N,) array
        Metres; 0 inside an obstacle.

    Examples
    --------
    >>> from robonav.robot import clearance, make_world
    >>> clearance(make_world(circles=[(50, 50, 3)]), [(60, 50)])
    array([7.])
    """
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
    """Return the keys of the worlds of a seed (splitmix64, Steele et al. 2014).

    Parameters
    ----------
    n : int
        Number of keys.
    seed : int
        Key i depends on (seed, i) alone.

    Returns
    -------
    (n, 2) array of uint32

    Examples
    --------
    >>> from robonav.robot import world_keys
    >>> bool((world_keys(3, seed=1) == world_keys(9, seed=1)[:3]).all())
    True
    """
    golden = 0x9E3779B97F4A7C15
    origin = np.random.SeedSequence(seed).generate_state(1, np.uint64)[0]
    with np.errstate(over="ignore"):
        z = origin + np.arange(1, n + 1, dtype=np.uint64) * np.uint64(golden)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z = z ^ (z >> np.uint64(31))
    return _keys_from(z)


def random_keys(generators: Sequence[np.random.Generator]) -> NDArray[np.uint32]:
    """Draw the key of one world from each of N random generators, (N, 2)."""
    raw = [rng.bit_generator.random_raw() for rng in generators]  # 64 random bits each
    return _keys_from(np.array(raw, dtype=np.uint64))


def _keys_from(numbers: NDArray[np.uint64]) -> NDArray[np.uint32]:
    """Cut each of N numbers of 64 bits into the two numbers of 32 bits of a key, the lower half first."""
    halves = [numbers & np.uint64(0xFFFFFFFF), numbers >> np.uint64(32)]
    return np.column_stack(halves).astype(np.uint32)


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
    """Draw n worlds with obstacles at random places, as in section 3.6, whose target can be reached with 2 m to spare.

    Half of the obstacles are circles of radius 1.5 to 4 m, half are rectangles of sides 3 to 8 m, turned at random.
    None is within 6 m of start or target. World i depends on (seed, i) alone. The generator is frozen: a test compares
    the digest of its worlds.

    Parameters
    ----------
    n : int
        Number of worlds, 0 or more.
    obstacles : int
        Obstacles that stand still, 0 or more.
    moving : int
        Obstacles that move, on top of them.
    seed : int or numpy.random.Generator
        A Generator gives a new seed in each call.
    starts, targets : sequence of (x, y)
        Points of which each world gets one at random.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    size : float
        Side of the map in metres.

    Returns
    -------
    Worlds

    Raises
    ------
    ValueError
        If an argument is out of bounds, or 1000 draws gave no map with a way to the target.

    Examples
    --------
    >>> from robonav.robot import random_worlds
    >>> random_worlds(100, obstacles=10, moving=2, seed=1).kinds.shape
    (100, 12)
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
    """Check the settings of :func:`random_worlds`."""
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
    """Draw the worlds that belong to given keys.

    Parameters
    ----------
    keys : (N, 2) array of uint32
        One a world, see :func:`world_keys`.
    obstacles : int
        Obstacles that stand still, 0 or more.
    moving : int
        Obstacles that move, on top of them.
    starts, targets : sequence of (x, y)
        Points of which each world gets one at random.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    size : float
        Side of the map in metres.

    Returns
    -------
    Worlds

    Examples
    --------
    >>> from robonav.robot import draw_worlds, world_keys
    >>> len(draw_worlds(world_keys(3, seed=1), obstacles=10, moving=0))
    3
    """
    n, m = len(keys), obstacles + moving
    kinds = np.zeros((n, m), dtype=np.int8)
    shapes, centres = np.zeros((n, m, 3)), np.zeros((n, m, 2))
    speeds, headings = np.zeros((n, m)), np.zeros((n, m))
    chosen, found = np.zeros((n, 4)), np.zeros(n, dtype=np.bool_)
    _fast.in_threads(
        _fast.draw_worlds, n, keys, obstacles, moving, float(moving_speeds[0]), float(moving_speeds[1]), float(size),
        np.array(starts, dtype=float), np.array(targets, dtype=float), ATTEMPTS, kinds, shapes, centres, speeds,
        headings, chosen, found, least=8,
    )  # fmt: skip
    if not found.all():
        raise ValueError(
            f"obstacles must leave a way to the target: {ATTEMPTS} draws with {obstacles} standing and "
            f"{moving} moving obstacles in {size:g} m gave no solvable map; take fewer"
        )
    # valid by construction; checks would take longer than drawing
    drawn = Worlds.__new__(Worlds)
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
    """Make one world with obstacles that stand still.

    Parameters
    ----------
    circles : sequence of (x, y, radius)
        In metres.
    rectangles : sequence of (x, y, length, width, angle)
        In metres and degrees.
    start, target : (float, float)
        Of the robot, in metres.
    size : float
        Side of the map in metres.
    key : (int, int)
        Of the random numbers during an episode (noise and slips), see :class:`Worlds`.

    Returns
    -------
    Worlds
        A batch of one.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> make_world(circles=[(50, 50, 3)], rectangles=[(30, 60, 8, 4, 45)]).kinds
    array([[1, 2]], dtype=int8)
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


def concatenate_worlds(batches: Sequence[Worlds]) -> Worlds:
    """Join several batches of worlds of the same map size into one.

    Parameters
    ----------
    batches : sequence of Worlds
        At least one. Missing obstacle slots stay empty.

    Returns
    -------
    Worlds

    Raises
    ------
    ValueError
        If there is no batch, or if map sizes differ.

    Examples
    --------
    >>> from robonav.robot import concatenate_worlds, random_worlds
    >>> easy, hard = random_worlds(2, 5, seed=1), random_worlds(3, 20, seed=1)
    >>> concatenate_worlds([easy, hard]).kinds.shape
    (5, 20)
    """
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
