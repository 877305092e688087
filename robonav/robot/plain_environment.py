"""A robot on its way to a target among obstacles: the environment to read (section 2.5).

One class in plain NumPy: what the robot can do and sense, how it moves, what it earns, when an episode ends. Below the
class stands the geometry that it uses. Only the random maps and the check of an action come from other files. The class
is a pattern for an environment of your own. An episode with a rule of one line, which turns to the freer side:

>>> env, steps, done = PlainNavigationEnv(obstacles=10), 0, False
>>> observation, _ = env.reset(seed=0)
>>> while not done and steps < 200:
...     ahead, left, right = observation["ranges"][[0, 1, 8]]
...     action = 0 if ahead > 4 else 1 if left > right else 3  # F, L30 or R30
...     observation, reward, done, _, _ = env.step(action)
...     steps += 1
>>> reward, steps  # it arrived
(1.0, 56)

Distances are rounded to a micrometre before anything is decided on them. So this code and its compiled twin decide the
same, although their numbers differ in the last digits. ``gymnasium.make("robonav/Navigation-v0")`` makes this twin,
which has options: see ``environments.py``. Tests hold the two equal.
"""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from ._fast.constants import CIRCLE, DIRECTION, RECTANGLE
from .environment_settings import takes_action
from .worlds import Worlds, draw_worlds, random_keys

SENSOR_RANGE = 10.0  # metres, as all distances
COLLISION_DISTANCE = 1.0
ARRIVAL_DISTANCE = 3.0
SECTOR = math.radians(40)  # angles are in radians
TURNS = np.radians([0.0, 30.0, 60.0, -30.0, -60.0, 0.0])  # F, L30, L60, R30, R60, B
BACK = 5  # the number of the action B
AHEAD = [0, 1, 2, 7, 8]  # the five sectors that look ahead
RAYS = (np.arange(9) + 0.5) * SECTOR  # ray k lies between the sectors k and k + 1

Array = NDArray[np.float64]
Observation = dict[str, Any]
Info = dict[str, Any]


class PlainNavigationEnv(gymnasium.Env):
    """A mobile robot has to reach a target in an unknown map without hitting anything.

    ## Description

    The robot crosses a square map of 100 m with circular and rectangular obstacles. It senses distances in nine
    sectors of 40 degrees and the direction of its target, never the map. One step lasts one second.

    ## Action space

    ``Discrete(6)``, Eq. (4.4). The robot turns, then goes straight on for one second.

    | number | action | turn             | distance |
    |--------|--------|------------------|----------|
    | 0      | F      | none             | speed    |
    | 1      | L30    | 30 degrees left  | speed    |
    | 2      | L60    | 60 degrees left  | speed    |
    | 3      | R30    | 30 degrees right | speed    |
    | 4      | R60    | 60 degrees right | speed    |
    | 5      | B      | none             | -speed   |

    A reflex comes first: if nothing is in sensor range, the robot turns to its target and goes forward. If all five
    sectors ahead are blocked, it steps back. In both cases it ignores the action given. Of the direction of the target
    the reflex knows the "exact" one, or only the "sector", to whose middle the robot then turns (see ``Reflex``).

    ## Observation space

    ``Dict``. Sector 0 looks ahead; sectors are numbered counter-clockwise.

    | key           | space                     | meaning                                                            |
    |---------------|---------------------------|--------------------------------------------------------------------|
    | ranges        | Box(0, 10, (9,), float64) | least distance in each sector in metres, 10 if nothing is in range |
    | walls         | MultiBinary(9)            | whether that nearest thing is the map's border                     |
    | target_region | Discrete(9)               | sector that holds the target                                       |
    | target_seen   | Discrete(2)               | whether the target is within 10 m                                  |

    ## Rewards

    1 for an arrival, -1 for a collision, else 0.

    ## Starting state

    A new random map. Half of its obstacles are circles with a radius of 1.5 to 4 m, half rectangles with sides of 3 to
    8 m; there is a way to the target. The robot stands at (10, 10), at least 6 m from every obstacle, and faces its
    target at (90, 90).

    ## Episode end

    1. Termination: the robot comes nearer than 1 m to an obstacle or a border, anywhere on its way.
    2. Termination: the robot arrives, within 3 m of the target.

    There is no limit of steps here; ``gymnasium.make`` adds one with its wrapper ``TimeLimit``, 500 steps by default.

    Examples
    --------
    A map by hand. A circle with a radius of 1 m stands 4 m ahead of the robot, so that it begins after 3 m:

    >>> from robonav.robot.plain_environment import PlainNavigationEnv
    >>> env = PlainNavigationEnv()
    >>> observation = env.place((50, 50, 0), target=(60, 50), circles=[(54, 50, 1)])
    >>> observation["ranges"]
    array([ 3., 10., 10., 10., 10., 10., 10., 10., 10.])
    >>> observation, reward, terminated, _, _ = env.step(0)  # 2 m forward
    >>> observation["ranges"][0], reward, terminated
    (np.float64(1.0), 0.0, False)
    >>> env.step(0)[1:3]  # 2 m more
    (-1.0, True)
    """

    def __init__(
        self, obstacles: int = 10, speed: float = 2.0, direction: str = DIRECTION
    ) -> None:
        self.obstacles, self.speed, self.direction = obstacles, speed, direction
        self.action_space = spaces.Discrete(6)
        self.observation_space = spaces.Dict(
            {
                "ranges": spaces.Box(0.0, SENSOR_RANGE, (9,), np.float64),
                "walls": spaces.MultiBinary(9),
                "target_region": spaces.Discrete(9),
                "target_seen": spaces.Discrete(2),
            }
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Put the robot into a new random map."""
        super().reset(seed=seed)
        world = draw_worlds(random_keys([self.np_random]), self.obstacles, 0)
        return self.enter(world), {}

    def enter(self, world: Worlds) -> Observation:
        """Put the robot at the start of a map that was drawn, and return what it senses."""
        obstacles = np.column_stack([world.centres[0], world.shapes[0]])
        circles = obstacles[world.kinds[0] == CIRCLE, :3]
        rectangles = obstacles[world.kinds[0] == RECTANGLE]
        pose, target = world.start_poses[0], world.targets[0]
        return self.place(pose, target, circles, rectangles, world.size)

    def place(
        self,
        pose: ArrayLike,
        target: ArrayLike,
        circles: ArrayLike = (),
        rectangles: ArrayLike = (),
        size: float = 100.0,
    ) -> Observation:
        """Put the robot into a map, and return what it senses.

        The state of the environment consists of these five attributes and ``self.ranges``, which :meth:`sense` sets.
        What the robot sensed last decides whether its reflex acts in the next step.

        Parameters
        ----------
        pose : (3,) array
            x, y and heading of the robot.
        target : (2,) array
            x and y.
        circles : (C, 3) array
            x, y and radius of each.
        rectangles : (R, 5) array
            x, y, half length, half width and angle of each.
        size : float
            Side of the map.
        """
        x, y, self.heading = np.array(pose, dtype=float)
        self.position = np.array([x, y])
        self.target = np.array(target, dtype=float)
        self.circles = np.array(circles, dtype=float).reshape(-1, 3)
        boxes = np.array(rectangles, dtype=float).reshape(-1, 5)
        self.rectangles = np.concatenate([border(size), boxes])
        return self.sense()

    @takes_action
    def step(self, action: int) -> tuple[Observation, float, bool, bool, Info]:
        """Simulate one second: the robot moves, its episode may end, it senses again.

        This method does not check whether the episode has already ended.
        """
        start = self.position
        self.heading, distance = self.heading_and_distance(action)
        direction = np.array([math.cos(self.heading), math.sin(self.heading)])
        self.position = start + distance * direction

        collided = self.clearance(start, self.position) < COLLISION_DISTANCE
        arrived = not collided and self.target_distance() <= ARRIVAL_DISTANCE
        reward = 0.0
        if collided:
            reward = -1.0
        if arrived:
            reward = 1.0
        return self.sense(), reward, collided or arrived, False, {}

    def heading_and_distance(self, action: int) -> tuple[float, float]:
        """Return where the robot turns and how far it goes, by its reflex or the action."""
        if self.ranges.min() == SENSOR_RANGE:  # it has sensed nothing
            return self.heading_to_target(), self.speed
        if (self.ranges[AHEAD] < self.speed + COLLISION_DISTANCE).all():  # blocked
            action = BACK
        turned = self.heading + TURNS[action]
        heading = math.remainder(turned, math.tau)  # within a half turn of 0
        return heading, -self.speed if action == BACK else self.speed

    def heading_to_target(self) -> float:
        """Return where the reflex turns the robot: to the target, or to the middle of the target's sector."""
        if self.direction == "exact":
            return self.target_direction()
        middle = self.heading + SECTOR * self.target_sector()
        return math.remainder(middle, math.tau)

    def target_distance(self) -> float:
        """Return how far the target is, to the micrometre."""
        return round(math.dist(self.target, self.position), 6)

    def target_direction(self) -> float:
        """Return the direction in which the target lies."""
        dx, dy = self.target - self.position
        return math.atan2(dy, dx)

    def target_sector(self) -> int:
        """Return the number, 0 to 8, of the sector that holds the target."""
        return sector(round(self.target_direction() - self.heading, 6))

    def sense(self) -> Observation:
        """Return the least distance in each sector, whether it is to a border, and where the target is.

        Seen from outside, the distance to a convex shape falls and then rises with the bearing. So its least distance
        in a sector is at its nearest point, if the sector holds it, or else on one of the sector's two rays.
        """
        rays = self.heading + RAYS
        rectangles = see_rectangles(self.rectangles, self.position, rays)
        circles = see_circles(self.circles, self.position, rays)
        both = zip(rectangles, circles, strict=True)
        nearest, bearing, on_rays = map(np.concatenate, both)

        holds_it = sector(bearing - self.heading)[:, None] == np.arange(9)
        at_nearest = np.where(holds_it, nearest[:, None], np.inf)
        # sector k lies between ray k - 1, on its right, and ray k, on its left
        at_rays = np.minimum(np.roll(on_rays, 1, axis=1), on_rays)
        distances = np.minimum(at_nearest, at_rays)  # a row for each shape
        self.ranges = np.minimum(distances.min(axis=0), SENSOR_RANGE).round(6)
        is_border = distances.argmin(axis=0) < 4  # the first four rectangles
        return {
            "ranges": self.ranges.copy(),
            "walls": (is_border & (self.ranges < SENSOR_RANGE)).astype(np.int8),
            "target_region": self.target_sector(),
            "target_seen": np.int64(self.target_distance() <= SENSOR_RANGE),
        }

    def clearance(self, start: Array, end: Array) -> float:
        """Return the least distance to anything on the straight way from ``start`` to ``end``.

        A rectangle that the way does not meet is nearest to it at an end of the way, or at a corner.
        """
        dx, dy = end - start
        way = np.array([math.atan2(dy, dx)])
        at_start, _, along = see_rectangles(self.rectangles, start, way)
        at_end, _, _ = see_rectangles(self.rectangles, end, way)
        if (along <= math.hypot(dx, dy)).any():  # the way meets a rectangle
            return 0.0
        at_corners = distances_to_way(corners(self.rectangles), start, end)
        to_centres = distances_to_way(self.circles[:, :2], start, end)
        to_circles = to_centres - self.circles[:, 2]
        least = np.concatenate([at_start, at_end, at_corners, to_circles]).min()
        return round(max(float(least), 0.0), 6)


def sector(bearing: Any) -> Any:
    """Return the number, 0 to 8, of the sector that holds a bearing from the heading."""
    return np.floor(bearing / SECTOR + 0.5).astype(np.int64) % 9


def see_circles(
    circles: Array, position: Array, rays: Array
) -> tuple[Array, Array, Array]:
    """Look at C circles: distance and bearing of the nearest point (C,), and distance on each of K rays (C, K)."""
    radius, (x, y) = circles[:, 2:3], (circles[:, :2] - position).T
    nearest = np.maximum(np.hypot(x, y) - radius[:, 0], 0.0)  # 0 inside
    ahead, aside = rotated(x[:, None], y[:, None], -rays)  # the centre, from each ray
    half_chord = np.sqrt(np.maximum(radius**2 - aside**2, 0.0))
    meets = (abs(aside) <= radius) & (ahead + half_chord >= 0.0)
    on_rays = np.where(meets, np.maximum(ahead - half_chord, 0.0), np.inf)
    return nearest, np.arctan2(y, x), on_rays


def see_rectangles(
    rectangles: Array, position: Array, rays: Array
) -> tuple[Array, Array, Array]:
    """Look at R rectangles, as at circles.

    In a rectangle's own frame, each coordinate of its nearest point is the robot's, kept between two sides. For the
    rays this is the *slab method* (Kay and Kajiya 1986). The rectangle is where two strips, or slabs, cross. A ray is
    in both from the later one of its two entrances to the earlier one of its two exits, if this is later::

               :  slab  :
               :  of x  :
        .......+--------+.......        o-----+-----+=========+-----+----->  a ray
        slab   |        |   slab              |     |         |     |
        of y   |        |   of y             in x  in y      out    out
        .......+--------+.......                   enter     leave
               :        :
    """
    half, turned = rectangles[:, 2:4], rectangles[:, 4]
    dx, dy = (position - rectangles[:, :2]).T
    robot = rotated(dx, dy, -turned).T  # in the frame of each rectangle, (R, 2)
    x, y = (np.clip(robot, -half, half) - robot).T
    angles = rays - turned[:, None]
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=2)  # (R, K, 2)
    with np.errstate(divide="ignore"):  # a ray may be parallel to two sides
        one_side = (-half - robot)[:, None] / directions  # how far along each ray
        other_side = (half - robot)[:, None] / directions
    enter = np.minimum(one_side, other_side).max(axis=2)
    leave = np.maximum(one_side, other_side).min(axis=2)
    meets = (enter <= leave) & (leave >= 0.0)
    on_rays = np.where(meets, np.maximum(enter, 0.0), np.inf)
    return np.hypot(x, y), np.arctan2(y, x) + turned, on_rays


def rotated(x: Array, y: Array, angle: Array) -> Array:
    """Turn points about the origin, to the left, and return their x and y."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * x - s * y, s * x + c * y])


def corners(rectangles: Array) -> Array:
    """Return the corners (4 R, 2) of R rectangles."""
    centres, (a, b, turned) = rectangles[:, :2], rectangles[:, 2:].T
    around = [(a, b), (-a, b), (-a, -b), (a, -b)]
    return np.concatenate([centres + rotated(x, y, turned).T for x, y in around])


def distances_to_way(points: Array, start: Array, end: Array) -> Array:
    """Return how far N points (N, 2) are from the straight way from ``start`` to ``end``."""
    way = end - start
    part = np.clip((points - start) @ way / (way @ way), 0.0, 1.0)  # of the way
    x, y = (points - start - np.outer(part, way)).T
    return np.hypot(x, y)


def border(size: float) -> Array:
    """Return the border of a square map as four rectangles outside it."""
    half, far = size / 2, 1.5 * size
    return np.array(
        [
            [-half, half, half, far, 0.0],  # left
            [size + half, half, half, far, 0.0],  # right
            [half, -half, far, half, 0.0],  # below
            [half, size + half, far, half, 0.0],  # above
        ]
    )
