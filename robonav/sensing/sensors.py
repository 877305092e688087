"""Sensors: a ring of sectors of any number, and a picture of what is around the robot.

The robot of section 2.5 has nine sectors. A ring of more of them reads the same obstacles with narrower sectors. The
picture shows from above what is around the robot. Both see 10 m far.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robonav.robot import SENSOR_RANGE, Simulator
from robonav.robot._fast import CIRCLE, RECTANGLE
from robonav.robot.plain_environment import border, see_circles, see_rectangles
from robonav.validation import check_integer

from . import _fast

Floats = NDArray[np.float64]
Robots = NDArray[np.int64]


class Sensor(Protocol):
    """What a sensor is: a shape, and a function of a simulator and some of its robots.

    Examples
    --------
    >>> from robonav.sensing import Ring, Picture
    >>> Ring(36).shape, Picture().shape
    ((36,), (32, 32))
    """

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of one reading."""

    def __call__(self, simulator: Simulator, robots: Robots) -> Floats:
        """Return what robots (K,) read now, (K, \\*shape), 0 where nothing is and at most 1."""


def sector_ranges(
    circles: Floats, rectangles: Floats, pose: Floats, sectors: int
) -> Floats:
    """Return the least distance in each of n equal sectors around one robot.

    Parameters
    ----------
    circles : (C, 3) array
        x, y and radius of each.
    rectangles : (R, 5) array
        x, y, half length, half width and angle of each.
    pose : (3,) array
        x, y and heading of the robot.
    sectors : int
        n. Sector 0 looks ahead; sectors are numbered counter-clockwise.

    Returns
    -------
    (n,) array
        Metres, at most 10.

    Examples
    --------
    A circle with a radius of 2 m, 8 m ahead, fills a narrow part of the nine sectors' first one:

    >>> import numpy as np
    >>> from robonav.sensing import sector_ranges
    >>> circle, nothing = np.array([[58.0, 50.0, 2.0]]), np.empty((0, 5))
    >>> sector_ranges(circle, nothing, np.array([50.0, 50.0, 0.0]), 9)
    array([ 6., 10., 10., 10., 10., 10., 10., 10., 10.])
    >>> sector_ranges(circle, nothing, np.array([50.0, 50.0, 0.0]), 36)[[0, 1, 2, 35]].round(1)
    array([ 6. ,  6.1, 10. ,  6.1])
    """
    position, heading, width = pose[:2], pose[2], 2 * np.pi / sectors
    rays = heading + (np.arange(sectors) + 0.5) * width  # ray k is left of sector k
    round_ones = see_circles(circles, position, rays)
    both = zip(round_ones, see_rectangles(rectangles, position, rays), strict=True)
    nearest, bearing, on_rays = map(np.concatenate, both)

    sector = np.floor((bearing - heading) / width + 0.5).astype(np.int64) % sectors
    holds_it = sector[:, None] == np.arange(sectors)
    at_nearest = np.where(holds_it, nearest[:, None], np.inf)
    at_rays = np.minimum(np.roll(on_rays, 1, axis=1), on_rays)
    distances = np.minimum(at_nearest, at_rays)  # a row for each shape
    return np.minimum(distances.min(axis=0, initial=SENSOR_RANGE), SENSOR_RANGE)


def picture_around(
    circles: Floats, rectangles: Floats, pose: Floats, cells: int
) -> Floats:
    """Return a picture, from above, of what is within 10 m of one robot.

    A cell is 1 if its middle is in an obstacle, and 0 elsewhere and beyond 10 m.

    Parameters
    ----------
    circles : (C, 3) array
        x, y and radius of each.
    rectangles : (R, 5) array
        x, y, half length, half width and angle of each.
    pose : (3,) array
        x, y and heading of the robot.
    cells : int
        How many cells a side of the picture has.

    Returns
    -------
    (cells, cells) array
        The first row is farthest ahead, the first column farthest to the left.

    Examples
    --------
    A circle 6 m ahead and 4 m to the left:

    >>> import numpy as np
    >>> from robonav.sensing import picture_around
    >>> circle, nothing = np.array([[56.0, 54.0, 3.0]]), np.empty((0, 5))
    >>> picture_around(circle, nothing, np.array([50.0, 50.0, 0.0]), 8).astype(int)[:4]
    array([[0, 0, 1, 0, 0, 0, 0, 0],
           [0, 1, 1, 1, 0, 0, 0, 0],
           [0, 0, 1, 0, 0, 0, 0, 0],
           [0, 0, 0, 0, 0, 0, 0, 0]])
    """
    middles = SENSOR_RANGE - (np.arange(cells) + 0.5) * 2 * SENSOR_RANGE / cells
    forward, left = middles[:, None], middles[None, :]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    x, y = pose[0] + c * forward - s * left, pose[1] + s * forward + c * left
    covered = np.zeros((cells, cells), dtype=bool)
    for cx, cy, radius in circles:
        covered |= (x - cx) ** 2 + (y - cy) ** 2 <= radius**2
    for cx, cy, half_length, half_width, angle in rectangles:
        along = np.cos(angle) * (x - cx) + np.sin(angle) * (y - cy)
        across = np.cos(angle) * (y - cy) - np.sin(angle) * (x - cx)
        covered |= (abs(along) <= half_length) & (abs(across) <= half_width)
    return np.where(forward**2 + left**2 <= SENSOR_RANGE**2, covered, 0.0)


def shapes_of(simulator: Simulator, robot: int) -> tuple[Floats, Floats]:
    """Return the circles (C, 3) and the rectangles (R, 5) around a robot now; the borders are rectangles, too.

    Parameters
    ----------
    simulator : Simulator
        Its worlds are read.
    robot : int
        The robot's index.

    Returns
    -------
    circles : (C, 3) array
    rectangles : (R, 5) array

    Examples
    --------
    >>> from robonav.robot import Simulator, make_world
    >>> from robonav.sensing import shapes_of
    >>> circles, rectangles = shapes_of(Simulator(make_world(circles=[(58, 50, 2)])), 0)
    >>> circles, rectangles.shape
    (array([[58., 50.,  2.]]), (4, 5))
    """
    worlds = simulator.worlds
    kinds = worlds.kinds[robot]
    table = np.column_stack([simulator.centres[robot], worlds.shapes[robot]])
    circles, boxes = table[kinds == CIRCLE, :3], table[kinds == RECTANGLE]
    return circles, np.concatenate([border(worlds.size), boxes])


@dataclass(frozen=True)
class Ring:
    """A ring of n equal sectors, each of which reads the least distance in it.

    Parameters
    ----------
    sectors : int
        n, from 3 to 360.

    Raises
    ------
    ValueError
        If the number is out of bounds.

    Examples
    --------
    The nearness of a thing is 0 at 10 m or more, and 1 where the robot touches it:

    >>> import numpy as np
    >>> from robonav.robot import Simulator, make_world
    >>> from robonav.sensing import Ring
    >>> world = make_world(circles=[(50, 58, 2)], start=(50, 50), target=(50, 90))
    >>> Ring(18)(Simulator(world), np.array([0]))[0, [0, 1, 2]].round(2)
    array([0.4 , 0.36, 0.  ])
    """

    sectors: int = 36

    def __post_init__(self) -> None:
        check_integer("sectors", self.sectors, at_least=3, at_most=360)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of one reading."""
        return (self.sectors,)

    def __call__(self, simulator: Simulator, robots: Robots) -> Floats:
        """Return the nearness (K, n) that K robots read: 1 - range / 10."""
        return 1 - self.ranges(simulator, robots) / SENSOR_RANGE

    def ranges(self, simulator: Simulator, robots: Robots) -> Floats:
        """Return the ranges (K, n) that robots read, in metres, with the simulator's error of sensing.

        Parameters
        ----------
        simulator : Simulator
            Its worlds and poses are read.
        robots : (K,) array of int
            Indices of robots.

        Returns
        -------
        (K, n) array
            Metres.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot import Simulator, random_worlds
        >>> from robonav.sensing import Ring
        >>> simulator = Simulator(random_worlds(5, seed=1), noise=0.3)
        >>> found = Ring(9).ranges(simulator, np.arange(5))
        >>> bool((found == simulator.sense().ranges).all())
        True
        """
        w, ranges = simulator.worlds, np.empty((len(robots), self.sectors))
        _fast.in_threads(
            _fast.read_sectors, len(robots), robots, w.kinds, w.shapes, simulator.centres, w.size, simulator.poses,
            w.keys, simulator.steps, simulator.noise, ranges,
        )  # fmt: skip
        return ranges


@dataclass(frozen=True)
class Picture:
    """A picture from above of what is within 10 m, with the robot in the middle and its heading upwards.

    Unlike a range, a cell also shows what is behind an obstacle. The error of sensing of a simulator is one of ranges,
    so a picture has none.

    Parameters
    ----------
    cells : int
        How many cells a side has, from 4 to 128.

    Raises
    ------
    ValueError
        If the number is out of bounds.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Simulator, make_world
    >>> from robonav.sensing import Picture
    >>> world = make_world(circles=[(50, 58, 2.5)], start=(50, 50), target=(50, 90))
    >>> Picture(8)(Simulator(world), np.array([0]))[0, :3].astype(int)
    array([[0, 0, 0, 1, 1, 0, 0, 0],
           [0, 0, 0, 1, 1, 0, 0, 0],
           [0, 0, 0, 0, 0, 0, 0, 0]])
    """

    cells: int = 32

    def __post_init__(self) -> None:
        check_integer("cells", self.cells, at_least=4, at_most=128)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of one reading."""
        return (self.cells, self.cells)

    def __call__(self, simulator: Simulator, robots: Robots) -> Floats:
        """Return the pictures (K, cells, cells) of K robots: 1 in obstacles and beyond the borders, else 0."""
        w, pictures = simulator.worlds, np.empty((len(robots), *self.shape))
        _fast.in_threads(
            _fast.take_pictures, len(robots), robots, w.kinds, w.shapes, simulator.centres, w.size, simulator.poses,
            pictures,
        )  # fmt: skip
        return pictures
