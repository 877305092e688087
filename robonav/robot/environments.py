"""``robonav/Navigation-v0``: the robot as a Gymnasium environment (section 2.5).

The class comes first. Below it stand the functions that its ``step`` calls: how an action slips, how obstacles move,
how near the robot comes to them on its way, and what it senses. numba compiles these functions; they are plain Python
for one robot. ``_fast`` has the same for many robots, and tests hold the two equal, bit for bit.

Angles are in radians, counter-clockwise, distances in metres. The map reaches from (0, 0) to (size, size). Of its M
obstacles there are the kinds (M,), the shapes (M, 3) and the centres (M, 2). A shape is a circle's radius, or half a
rectangle's length, half its width, and the angle of its length.

From ``_fast`` come ``swept_distance`` from a segment to a shape at the origin; ``box_entry``, the way along a line to a
box; ``reach_of``, the radius of the circle about a shape; ``wrap``, which keeps an angle in (-pi, pi]; ``micrometres``,
which rounds a distance, so that the last bit of a sine decides nothing; and ``uniform`` and ``normal``, random numbers
that are a hash of the world's key, a purpose, the step and a count.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from robonav.compilation import compiler
from robonav.validation import check_one_of

from ._fast import constants, geometry, motion, random_numbers
from ._fast.constants import (
    ARRIVAL_DISTANCE,  # 3 m
    ARRIVED,
    CIRCLE,
    COLLIDED,
    COLLISION_DISTANCE,  # 1 m
    NO_REFLEX,
    NOTHING,
    OUT_OF_STEPS,
    RUNNING,
    SECTOR,  # 40 degrees
    SENSOR_RANGE,  # 10 m
    SENSORS,  # 9
    TURN_PROBABILITY,  # of a moving obstacle in a second: 0.1
)
from ._fast.constants import TURNS as TURNS_OF_ACTIONS
from ._fast.geometry import box_entry, micrometres, reach_of, swept_distance
from ._fast.motion import wrap
from ._fast.random_numbers import DRIFTING, SENSING, SLIPPING, normal, uniform
from .environment_settings import (
    NO_LIMIT,
    Array,
    Flags,
    Map,
    Obstacles,
    Reward,
    arrival_or_collision,
    check_settings,
    sensing_of_one,
    while_running,
    worlds_in,
)
from .rollout import REFLEX, ReflexRule
from .simulator import Action, Sensing
from .worlds import MOVING_SPEEDS, START, TARGET, Worlds

Point = tuple[float, float]
Pose = tuple[float, float, float]  # x, y and heading
Observation = dict[str, Any]
Info = dict[str, Any]
Step = tuple[Observation, float, bool, bool, Info]

TURNS = TURNS_OF_ACTIONS.tolist()  # 0, 30, 60, -30, -60, 0 degrees, in radians

compiled = compiler(constants, geometry, motion, random_numbers)


class NavigationEnv(gymnasium.Env):
    """A mobile robot has to reach a target in an unknown map without hitting anything (section 2.5).

    ## Description

    The robot crosses a square map of 100 m with circular and rectangular obstacles. It senses distances in nine
    sectors of 40 degrees and the direction of its target, never the map. One step lasts one second.
    :class:`NavigationVectorEnv` steps many such robots at once and gives the same numbers, bit for bit.

    ## Action space

    ``Discrete(6)``, Eq. (4.4). The robot turns, then goes straight on for one second.

    | number | action | turn                | distance |
    |--------|--------|---------------------|----------|
    | 0      | F      | none                | speed    |
    | 1      | L30    | 30 degrees left     | speed    |
    | 2      | L60    | 60 degrees left     | speed    |
    | 3      | R30    | 30 degrees right    | speed    |
    | 4      | R60    | 60 degrees right    | speed    |
    | 5      | B      | none                | -speed   |

    The reflex comes first. If nothing is in sensor range, the robot turns to its target and goes forward (6), or, with
    ``reflex=Reflex("sector")``, it turns to the middle of the target's sector (7). If all five sectors ahead are
    blocked, it steps back (5). In all these cases it ignores the action given, and ``info["reflex"]`` names what it did
    instead.

    ## Observation space

    ``Dict``, the fields of :class:`Sensing` for one robot.

    | key           | space                     | unit   | meaning                                                |
    |---------------|---------------------------|--------|--------------------------------------------------------|
    | ranges        | Box(0, 10, (9,), float64) | metres | least distance in each sector, 10 if nothing is in range |
    | walls         | MultiBinary(9)            | -      | whether that nearest thing is the map's border         |
    | target_region | Discrete(9)               | -      | column 0 to 8 of the sector that holds the target      |
    | target_seen   | Discrete(2)               | -      | whether the target is within 10 m                      |

    Column 0 of ranges and walls looks ahead; sectors are numbered counter-clockwise. The thesis and :class:`Sensing`
    number them from 1 to 9: theirs is ``target_region + 1``, and :func:`as_sensing` adds this 1. The number of a sector
    has no size: sectors 9 and 1 are neighbours. So it is a ``Discrete``, which libraries turn into nine inputs of 0 and
    1, and not a ``Box``. It starts at 0 because several libraries, stable-baselines3 among them, take no other start.

    ## Rewards

    1 for an arrival, -1 for a collision, else 0. ``reward`` replaces this; ``robonav.nnql.reward`` is Table 4.1.

    ## Starting state

    Each episode has a new random map, drawn as :func:`random_worlds` does from the seed of ``reset``. The robot stands
    at (10, 10), faces its target at (90, 90), and is at least 6 m from every obstacle.

    ## Episode end

    1. Termination: the robot arrives, within 3 m of the target (``Outcome.ARRIVED``).
    2. Termination: the robot comes nearer than 1 m to an obstacle or a border (``Outcome.COLLIDED``).
    3. Truncation: ``gymnasium.make`` cuts episodes after 500 steps, or after its ``max_episode_steps``, by Gymnasium's
       ``TimeLimit``. The environment does not see this: its outcome stays ``RUNNING``. An environment made with a limit
       of its own, ``NavigationEnv(max_episode_steps=...)``, and the vector environment say ``OUT_OF_STEPS``. A limit of
       -1 is none.

    ## Information

    | key     | type           | meaning                                                                |
    |---------|----------------|------------------------------------------------------------------------|
    | outcome | int            | an :class:`Outcome`: 0 running, 1 arrived, 2 collided, 3 out of steps  |
    | reflex  | int            | the action that the reflex put in place of the one given, else -1      |
    | pose    | (3,) float64   | x and y in metres, heading in radians; a robot does not know its pose  |

    ``Outcome(info["outcome"]).name`` is the outcome in words. ``info`` has numbers alone, because wrappers such as
    ``NumpyToTorch`` take no text.

    ## Options

    ``reset(options={"worlds": world})`` puts the robot into a given world, a batch of one.

    ## In other processes

    ``gymnasium.make("robonav:robonav/Navigation-v0")`` imports robonav itself. Processes that do not begin as copies of
    this one (the "spawn" and "forkserver" of ``AsyncVectorEnv``) need this form of the name.

    ``env.spec.to_json()`` works with arguments that JSON has: numbers, lists, None, the names of a ``reflex`` and of a
    ``reward`` function, and the name of a file of ``worlds``.

    ## Version history

    v0: first version.

    Parameters
    ----------
    obstacles : int
        Obstacles that stand still, in each new map.
    moving : int
        Obstacles that move, on top of them.
    starts, targets : sequence of (x, y)
        Points in metres, of which each map gets one at random.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    worlds : Worlds or path, optional
        Choose the map of each episode among these at random, instead of drawing new ones; or among those of a file
        that :func:`save_worlds` wrote.
    speed : float
        Of the robot, in m/s.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another, see :class:`Simulator`.
    noise : float
        Standard deviation in metres of the error of a range.
    reward : callable or str
        ``reward(before, after, outcome) -> (N,)`` rewards of N robots, see ``Reward``; or its name, such as
        "robonav.nnql:reward".
    reflex : callable or {"exact", "sector"}, optional
        What the robot does before the action given counts: a :class:`Reflex`, its direction, or a function of the same
        arguments. None turns it off.
    max_episode_steps : int
        Limit of the environment itself. By default it has none (-1) and leaves the limit to Gymnasium's wrapper.
    render_mode : {"human", "rgb_array"}, optional
        Whether :meth:`render` shows a window or returns an image.

    Examples
    --------
    >>> import gymnasium
    >>> import robonav
    >>> env = gymnasium.make("robonav/Navigation-v0", obstacles=0)
    >>> observation, info = env.reset(seed=0)
    >>> terminated = truncated = False
    >>> while not (terminated or truncated):
    ...     observation, reward, terminated, truncated, info = env.step(0)
    >>> from robonav.robot import Outcome
    >>> Outcome(info["outcome"]).name, reward
    ('ARRIVED', 1.0)
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["human", "rgb_array"],
        "render_fps": 10,
    }

    def __init__(
        self,
        *,
        obstacles: int = 10,
        moving: int = 0,
        starts: Sequence[tuple[float, float]] = (START,),
        targets: Sequence[tuple[float, float]] = (TARGET,),
        moving_speeds: tuple[float, float] = MOVING_SPEEDS,
        worlds: Worlds | str | Path | None = None,
        speed: float = 2.0,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        reward: Reward | str = arrival_or_collision,
        reflex: ReflexRule | str | None = REFLEX,
        max_episode_steps: int = NO_LIMIT,
        render_mode: str | None = None,
    ) -> None:
        settings = check_settings(
            obstacles=obstacles, moving=moving, starts=starts, targets=targets, moving_speeds=moving_speeds,
            worlds=worlds, speed=speed, slip=slip, noise=noise, reward=reward, reflex=reflex,
            max_episode_steps=max_episode_steps,
        )  # fmt: skip
        self.settings = settings
        self.speed, self.noise, self.slip = settings.speed, settings.noise, settings.slip  # fmt: skip
        self.reflex, self.reward = settings.reflex_of_one, settings.reward_of_one
        self.max_episode_steps = settings.max_episode_steps

        self.action_space = spaces.Discrete(6)
        self.observation_space = spaces.Dict(
            {
                "ranges": spaces.Box(0.0, SENSOR_RANGE, (SENSORS,), np.float64),
                "walls": spaces.MultiBinary(SENSORS),
                "target_region": spaces.Discrete(SENSORS),
                "target_seen": spaces.Discrete(2),
            }
        )
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self.outcome: Any = None  # no episode before the first reset
        self._window: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Begin an episode, in a new world unless ``options["worlds"]`` gives one."""
        super().reset(seed=seed)
        given = worlds_in(options, 1)
        self.world = given or self.settings.next_worlds([self.np_random])
        self.map = Map.of(self.world)
        self.pose: Pose = self.map.start  # it faces the target
        self.steps, self.outcome = 0, RUNNING
        self._sense()
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info(NO_REFLEX)

    @while_running
    def step(self, action: int) -> Step:
        """Simulate one second."""
        (x, y, heading), before = self.pose, self.sensing
        obstacles, size, target = self.map.obstacles, self.map.size, self.map.target

        # 1. Action. The reflex replaces it where nothing is near, or all is blocked ahead.
        reflex = self.reflex(before, self.speed)
        if reflex in (Action.TO_TARGET, Action.TO_SECTOR):
            action, heading = Action.F, self._heading_to_target(reflex)
        elif reflex != NO_REFLEX:
            action = reflex
        if self.slip is not None:  # it may turn into another
            action = slip_to(action, self.slip, self.map.key, self.steps)

        # 2. Turn. 3. Move: straight on for one second, backwards if the action is B.
        heading = wrap(heading + TURNS[action])
        distance = -self.speed if action == Action.B else self.speed
        x1, y1 = x + distance * math.cos(heading), y + distance * math.sin(heading)
        centres = self._move_obstacles()  # which were there, and move meanwhile
        self.pose, self.steps = (x1, y1, heading), self.steps + 1

        # 4. Collide, anywhere along the way? 5. Arrive?
        clearance = least_clearance(obstacles, centres, size, (x, y), (x1, y1))
        to_target = micrometres(math.hypot(target[0] - x1, target[1] - y1))
        truncated = self.steps >= self.max_episode_steps
        if clearance < COLLISION_DISTANCE:
            self.outcome = COLLIDED
        elif to_target <= ARRIVAL_DISTANCE:
            self.outcome = ARRIVED
        elif truncated:
            self.outcome = OUT_OF_STEPS
        terminated = self.outcome in (COLLIDED, ARRIVED)

        # 6. Sense. 7. Reward.
        self._sense()
        reward = self.reward(before, self.sensing, self.outcome)
        if self.render_mode == "human":
            self.render()
        return self._observation(), reward, terminated, truncated, self._info(reflex)

    def _heading_to_target(self, reflex: int) -> float:
        """Return the heading to the target itself, or to the middle of its sector."""
        x, y, heading = self.pose
        if reflex == Action.TO_SECTOR:
            return wrap(heading + SECTOR * self.target_region)
        return math.atan2(self.map.target[1] - y, self.map.target[0] - x)

    def _move_obstacles(self) -> Array:
        """Let the moving obstacles go on for one second; return the centres of all obstacles before."""
        world = self.map
        if not world.moving:
            return world.centres
        before = world.centres.copy()
        drift(world.obstacles, world.headings, world.speeds, world.size, world.key, self.steps)  # fmt: skip
        return before

    def _sense(self) -> None:
        """Sense the distances in nine sectors, and the target, from where the robot is now."""
        self.ranges, self.walls, self.target_region, self.target_seen = sensed = sense(
            self.map.obstacles, self.map.size, self.pose, self.map.target, self.noise, self.map.key, self.steps
        )  # fmt: skip
        # the same as reflexes, rewards and policies take it: arrays of one robot
        self.sensing = sensing_of_one(*sensed)

    def _observation(self) -> Observation:
        return {
            "ranges": self.ranges.copy(),  # a copy, which the caller may change
            "walls": self.walls.astype(np.int8),
            "target_region": np.int64(self.target_region),
            "target_seen": np.int64(self.target_seen),
        }

    def _info(self, reflex: int) -> Info:
        return {
            "outcome": self.outcome,
            "reflex": reflex,
            "pose": np.array(self.pose),
        }

    def render(self) -> NDArray[np.uint8] | None:
        """Return an image (H, W, 3), or show it in a window."""
        if self.render_mode is None:
            return None
        if self.outcome is None:
            raise ValueError("render: call reset first")
        from .drawing import Window, picture

        moment = (self.world, self.map.centres, self.pose, self.ranges)
        if self.render_mode == "rgb_array":
            return picture(*moment)
        self._window = self._window or Window()
        self._window.show(*moment)
        return None

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None


def as_sensing(observation: dict[str, Any]) -> Sensing:
    """Turn an environment's observation into the batch that encoders and policies take.

    Parameters
    ----------
    observation : dict
        Of one robot, or of N from the vector environment.

    Returns
    -------
    Sensing
        One row, or N.

    Examples
    --------
    >>> from robonav.robot.environments import NavigationEnv, as_sensing
    >>> observation, _ = NavigationEnv().reset(seed=0)
    >>> as_sensing(observation).ranges.shape
    (1, 9)
    """
    return Sensing(
        np.atleast_2d(observation["ranges"]),
        np.atleast_2d(observation["walls"]).astype(bool),
        np.atleast_1d(observation["target_region"]) + 1,
        np.atleast_1d(observation["target_seen"]).astype(bool),
    )


@compiled
def slip_to(action: int, slip: Array, key: Array, step: int) -> int:
    """Draw the action that comes of ``action``, whose row of ``slip`` says how likely each is.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import random_worlds
    >>> always_straight = np.eye(6)[[0, 0, 0, 0, 0, 5]]
    >>> slip_to(1, always_straight, random_worlds(1, seed=0).keys[0], 0)
    0
    """
    draw, total = uniform(key, SLIPPING, step, 0, 0), 0.0
    for other in range(slip.shape[1]):
        total += slip[action, other]
        if draw < total:
            return other
    return action


@compiled
def drift(
    obstacles: Obstacles, headings: Array, speeds: Array,
    size: float, key: Array, step: int,
) -> None:  # fmt: skip
    """Let moving obstacles go on for one second. Some turn at random, and borders reflect them.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0].copy()
    >>> drift(obstacles, np.array([0.0]), np.array([1.5]), 100.0, world.keys[0], 0)
    >>> obstacles[2].tolist()
    [[51.5, 50.0]]
    """
    kinds, shapes, centres = obstacles
    for m in range(len(kinds)):
        if kinds[m] == NOTHING or speeds[m] == 0.0:
            continue
        heading = headings[m]
        if uniform(key, DRIFTING, step, m, 0) < TURN_PROBABILITY:
            heading = math.pi * (2.0 * uniform(key, DRIFTING, step, m, 1) - 1.0)
        x = centres[m, 0] + speeds[m] * math.cos(heading)
        y = centres[m, 1] + speeds[m] * math.sin(heading)
        reach = reach_of(kinds[m], shapes[m, 0], shapes[m, 1])
        most = size - reach  # for its centre
        if x < reach or x > most:
            x = 2.0 * (reach if x < reach else most) - x
            heading = wrap(math.pi - heading)
        if y < reach or y > most:
            y = 2.0 * (reach if y < reach else most) - y
            heading = -heading
        centres[m, 0], centres[m, 1], headings[m] = x, y, heading


@compiled
def least_clearance(
    obstacles: Obstacles, centres_before: Array, size: float, start: Point, end: Point
) -> float:
    """Least distance to an obstacle or border while the robot goes from ``start`` to ``end``.

    Obstacles go straight and evenly from ``centres_before`` to their centres, and the robot does too. So, seen from an
    obstacle, the robot goes straight along a segment. Exact below :data:`COLLISION_DISTANCE`.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(53, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> least_clearance(obstacles, world.centres[0], 100.0, (50.0, 47.5), (56.0, 47.5))
    0.5
    """
    kinds, shapes, centres = obstacles
    (x0, y0), (x1, y1) = start, end
    least = min(x0, x1, size - x0, size - x1, y0, y1, size - y0, size - y1)
    least = min(least, 2.0 * COLLISION_DISTANCE)  # more does not matter
    for m in range(len(kinds)):
        ax, ay = x0 - centres_before[m, 0], y0 - centres_before[m, 1]
        bx, by = x1 - centres[m, 0], y1 - centres[m, 1]
        near = shapes[m, 0] + shapes[m, 1] + least
        far_in_x = min(ax, bx) > near or max(ax, bx) < -near
        far_in_y = min(ay, by) > near or max(ay, by) < -near
        if kinds[m] == NOTHING or far_in_x or far_in_y:
            continue
        least = min(least, swept_distance(kinds[m], shapes[m], ax, ay, bx, by))
    return micrometres(max(least, 0.0))


@compiled
def sense(
    obstacles: Obstacles, size: float, pose: Pose, target: Point,
    noise: float, key: Array, step: int,
) -> tuple[Array, Flags, int, bool]:  # fmt: skip
    """Sense the least distance in each of nine sectors, and where the target is.

    Returns the ranges (9,), whether the nearest thing in each sector is a border (9,), the sector of the target, 0 to
    8, and whether the target is in range. ``noise`` is the standard deviation of the error of a range.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(58, 50, 2)])
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> ranges, walls, region, seen = sense(
    ...     obstacles, 100.0, (50.0, 50.0, 0.0), (90.0, 50.0), 0.0, world.keys[0], 0
    ... )
    >>> ranges, region, seen
    (array([ 6., 10., 10., 10., 10., 10., 10., 10., 10.]), 0, False)
    """
    ranges, walls = np.empty(SENSORS), np.empty(SENSORS, dtype=np.bool_)
    ranges[:], walls[:] = SENSOR_RANGE, False
    sense_obstacles(obstacles, pose, ranges, walls)
    sense_borders(size, pose, ranges, walls)
    for k in range(SENSORS):
        distance = micrometres(ranges[k])
        if noise > 0.0 and distance < SENSOR_RANGE:
            error = noise * normal(key, SENSING, step, k)
            distance = micrometres(min(max(distance + error, 0.0), SENSOR_RANGE))
        ranges[k], walls[k] = distance, walls[k] and distance < SENSOR_RANGE

    dx, dy = target[0] - pose[0], target[1] - pose[1]
    bearing = micrometres(math.atan2(dy, dx) - pose[2])
    seen = micrometres(math.hypot(dx, dy)) <= SENSOR_RANGE
    return ranges, walls, sector_at(bearing), seen


@compiled
def sector_at(bearing: float) -> int:
    """Index 0 to 8 of the sector of 40 degrees that holds a bearing; 0 looks ahead, counter-clockwise.

    Examples
    --------
    >>> sector_at(0.0), sector_at(math.radians(30)), sector_at(math.radians(-30))
    (0, 1, 8)
    """
    return math.floor(bearing / SECTOR + 0.5) % SENSORS


@compiled
def see(distance: float, k: int, wall: bool, ranges: Array, walls: Flags) -> None:
    """Keep the distance in sector ``k`` if nothing there is nearer."""
    if distance < ranges[k]:
        ranges[k], walls[k] = distance, wall


@compiled
def see_on_ray(
    distance: float, k: int, wall: bool, ranges: Array, walls: Flags
) -> None:
    """See something on the ray between sectors ``k`` and ``k + 1``: both have it."""
    see(distance, k, wall, ranges, walls)
    see(distance, (k + 1) % SENSORS, wall, ranges, walls)


@compiled
def sense_obstacles(
    obstacles: Obstacles, pose: Pose, ranges: Array, walls: Flags
) -> None:
    """See each obstacle at its nearest point, and where the rays between two sectors meet it.

    This is enough: seen from outside, the distance to a convex shape falls and then rises with the bearing. So its
    least distance in a sector is at its nearest point, if the sector holds it, or else on one of the sector's two rays.

    Examples
    --------
    >>> from robonav.robot import make_world
    >>> world = make_world(circles=[(50, 57, 2)])
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> obstacles = world.kinds[0], world.shapes[0], world.centres[0]
    >>> sense_obstacles(obstacles, (50.0, 50.0, 0.0), ranges, walls)
    >>> ranges[2]  # 80 degrees to the left
    np.float64(5.0)
    """
    kinds, shapes, centres = obstacles
    x, y, heading = pose
    c, s = math.cos(heading), math.sin(heading)
    rays = directions_of_rays()
    for m in range(len(kinds)):
        dx, dy = centres[m, 0] - x, centres[m, 1] - y
        near = SENSOR_RANGE + shapes[m, 0] + shapes[m, 1]
        if kinds[m] == NOTHING or dx * dx + dy * dy >= near * near:
            continue
        forward, left = c * dx + s * dy, c * dy - s * dx  # in the robot's frame
        if kinds[m] == CIRCLE:
            see_circle(forward, left, shapes[m, 0], rays, ranges, walls)
        else:
            turned = shapes[m, 2] - heading
            see_rectangle(forward, left, shapes[m], turned, rays, ranges, walls)


@compiled
def directions_of_rays() -> Array:
    """Directions (9, 2) in the robot's frame of the rays between sectors k and k + 1."""
    rays = np.empty((SENSORS, 2))
    for k in range(SENSORS):
        rays[k, 0] = math.cos((k + 0.5) * SECTOR)
        rays[k, 1] = math.sin((k + 0.5) * SECTOR)
    return rays


@compiled
def see_circle(
    x: float, y: float, radius: float,
    rays: Array, ranges: Array, walls: Flags,
) -> None:  # fmt: skip
    """See a circle whose centre is x ahead and y to the left.

    Examples
    --------
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> see_circle(8.0, 0.0, 2.0, directions_of_rays(), ranges, walls)
    >>> ranges[0]
    np.float64(6.0)
    """
    distance = math.hypot(x, y) - radius
    if distance <= 0.0:  # the robot is in it
        ranges[:] = 0.0
        return
    see(distance, sector_at(math.atan2(y, x)), False, ranges, walls)
    for k in range(SENSORS):
        along = x * rays[k, 0] + y * rays[k, 1]
        across = x * rays[k, 1] - y * rays[k, 0]
        half_chord2 = radius * radius - across * across
        if along > 0.0 and half_chord2 >= 0.0:  # the ray meets it
            distance = along - math.sqrt(half_chord2)
            see_on_ray(distance, k, False, ranges, walls)


@compiled
def see_rectangle(
    x: float, y: float, shape: Array, turned: float,
    rays: Array, ranges: Array, walls: Flags,
) -> None:  # fmt: skip
    """See a rectangle whose centre is x ahead and y to the left, its length turned to the left.

    Examples
    --------
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> shape = np.array([3.0, 1.0, 0.0])  # half its length and its width
    >>> see_rectangle(8.0, 0.0, shape, 0.0, directions_of_rays(), ranges, walls)
    >>> ranges[0]
    np.float64(5.0)
    """
    half_length, half_width = shape[0], shape[1]
    c, s = math.cos(turned), math.sin(turned)
    px, py = -(c * x + s * y), -(c * y - s * x)  # the robot in the rectangle's frame
    nx = min(max(px, -half_length), half_length) - px  # from it to the nearest point
    ny = min(max(py, -half_width), half_width) - py
    if nx == 0.0 and ny == 0.0:  # the robot is in it
        ranges[:] = 0.0
        return
    nearest = sector_at(math.atan2(s * nx + c * ny, c * nx - s * ny))
    see(math.hypot(nx, ny), nearest, False, ranges, walls)
    for k in range(SENSORS):
        dx, dy = c * rays[k, 0] + s * rays[k, 1], c * rays[k, 1] - s * rays[k, 0]
        enter, leave = box_entry(px, py, dx, dy, half_length, half_width)
        if 0.0 <= enter <= leave:  # the ray meets it
            see_on_ray(enter, k, False, ranges, walls)


@compiled
def sense_borders(size: float, pose: Pose, ranges: Array, walls: Flags) -> None:
    """See each border at its nearest point, and where the rays between two sectors leave the map.

    Examples
    --------
    >>> ranges, walls = np.full(9, 10.0), np.zeros(9, dtype=bool)
    >>> sense_borders(100.0, (96.0, 50.0, 0.0), ranges, walls)
    >>> ranges[0], walls[0]
    (np.float64(4.0), np.True_)
    """
    x, y, heading = pose
    margin = min(x, size - x, y, size - y)
    if margin >= SENSOR_RANGE:
        return
    if margin <= 0.0:  # the robot went through a border
        ranges[:], walls[:] = 0.0, True
        return
    c, s = math.cos(heading), math.sin(heading)
    for distance, nx, ny in (
        (x, -1.0, 0.0),
        (size - x, 1.0, 0.0),
        (y, 0.0, -1.0),
        (size - y, 0.0, 1.0),
    ):
        k = sector_at(math.atan2(c * ny - s * nx, c * nx + s * ny))
        see(distance, k, True, ranges, walls)
    rays, half = directions_of_rays(), size / 2
    for k in range(SENSORS):
        dx, dy = c * rays[k, 0] - s * rays[k, 1], s * rays[k, 0] + c * rays[k, 1]
        _, distance = box_entry(x - half, y - half, dx, dy, half, half)
        see_on_ray(distance, k, True, ranges, walls)
