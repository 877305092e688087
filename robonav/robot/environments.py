"""``robonav/Navigation-v0``: the robot as a Gymnasium environment (section 2.5).

The file holds the whole environment. Read :class:`NavigationEnv` first: ``reset`` and ``step`` use what stands below.

1. The reward of a step and the settings, which draw the worlds (:class:`NavigationSettings`).
2. The environment itself, :class:`NavigationEnv`.
3. What happens in a second: the robot turns and goes (:func:`turn_and_go`), an uncertain action may become another
   (:func:`slip_to`), obstacles move (:func:`drift`), the way may end at one of them (:func:`least_clearance`).
4. What the robot senses then (:func:`sense`).

Angles are in radians, counter-clockwise, distances in metres. The map reaches from (0, 0) to (size, size).

numba compiles the functions marked ``@compiled``, which are plain Python for one robot. The vector environment steps
many robots in ``_fast``; tests hold the two equal, bit for bit. From ``_fast`` come

- distances: ``swept_distance`` from a segment to a shape at the origin, ``box_entry`` along a line to a box,
  ``reach_of``, the radius of the circle about a shape;
- ``wrap``, which keeps an angle in (-pi, pi], and ``micrometres``, which rounds a distance, so that the last bit of a
  sine decides nothing;
- random numbers, ``uniform`` in [0, 1) and ``normal``: a hash of the world's key, a purpose, the step and a count.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.compilation import compiler
from robonav.validation import (
    check_instance,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
)

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
    TURNS,
)
from ._fast.geometry import box_entry, micrometres, reach_of, swept_distance
from ._fast.motion import wrap
from ._fast.random_numbers import DRIFTING, SENSING, SLIPPING, normal, uniform
from .rollout import REFLEX, ReflexRule
from .simulator import NEVER, OUTCOMES, Action, Sensing, check_action, check_slip
from .worlds import (
    MOVING_SPEEDS,
    SIZE,
    START,
    TARGET,
    Worlds,
    check_drawing,
    draw_worlds,
    random_keys,
)

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Pose = tuple[float, float, float]  # x, y and heading
Obstacles = tuple[Array, Array, Array]
"""Of M obstacles: kinds (M,), shapes (M, 3) and centres (M, 2).

A shape is a circle's radius, or half a rectangle's length, half its width, and the angle its length is turned by.
"""
Observation = dict[str, Any]
Info = dict[str, Any]

TURN_OF_ACTION = TURNS.tolist()  # 0, 30, 60, -30, -60 and 0 degrees, in radians
NAME_OF_OUTCOME = OUTCOMES.tolist()

compiled = compiler(constants, geometry, motion, random_numbers)


# 1. The reward, and the settings, which draw the worlds


Reward = Callable[[Sensing, Sensing, NDArray[np.int8]], ArrayLike]
"""``reward(before, after, outcome) -> (N,)``: from what N robots sensed before and after a step, and the outcomes."""

REWARD_OF_OUTCOME = np.array([0.0, 1.0, -1.0, 0.0])
"""For an episode that goes on, and for one that ended by arrival, by collision, or for lack of steps."""

OUTCOME_OF_ONE = np.arange(len(OUTCOMES), dtype=np.int8)[:, None]
OUTCOME_OF_ONE.flags.writeable = False  # row k: outcome k of one robot, (1,)


def arrival_or_collision(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.float64]:
    """Return the reward 1 for an arrival, -1 for a collision, else 0.

    Parameters
    ----------
    before, after : Sensing
        What N robots sensed before and after the step; not used.
    outcome : (N,) int array
        How their episodes stand after the step: codes into ``OUTCOMES``.

    Returns
    -------
    (N,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Sensing
    >>> from robonav.robot.environments import arrival_or_collision
    >>> nothing = Sensing.empty(3)
    >>> arrival_or_collision(nothing, nothing, np.array([0, 1, 2]))
    array([ 0.,  1., -1.])
    """
    return REWARD_OF_OUTCOME[outcome]


@dataclass(frozen=True, eq=False)
class NavigationSettings:
    """What the arguments of :class:`NavigationEnv` say, checked. There they are explained.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or out of bounds.

    Examples
    --------
    >>> from robonav.robot.environments import NavigationSettings
    >>> NavigationSettings(speed=0)
    Traceback (most recent call last):
    ValueError: speed must be greater than 0, got 0
    """

    obstacles: int = 10
    moving: int = 0
    starts: Sequence[tuple[float, float]] = (START,)
    targets: Sequence[tuple[float, float]] = (TARGET,)
    moving_speeds: tuple[float, float] = MOVING_SPEEDS
    worlds: Worlds | None = None
    speed: float = 2.0
    slip: ArrayLike | None = None
    noise: float = 0.0
    reward: Reward = arrival_or_collision
    reflex: ReflexRule | None = REFLEX
    max_episode_steps: int = NEVER

    def __post_init__(self) -> None:
        check_drawing(
            self.obstacles, self.moving, self.starts, self.targets, self.moving_speeds, SIZE
        )  # fmt: skip
        if self.worlds is not None and len(check_instance("worlds", self.worlds, Worlds)) == 0:  # fmt: skip
            raise ValueError("worlds must hold at least one world, got none")
        if not callable(self.reward):
            raise TypeError(
                f"reward must be callable as reward(before, after, outcome), got {type(self.reward).__name__}"
            )
        if self.reflex is not None and not callable(self.reflex):
            raise TypeError(
                f"reflex must be callable as reflex(sensing, speed), or None, got {self.reflex!r}"
            )
        check_integer(
            "max_episode_steps", self.max_episode_steps, at_least=1, at_most=NEVER
        )
        object.__setattr__(self, "speed", check_positive("speed", self.speed))
        object.__setattr__(self, "noise", check_real("noise", self.noise, at_least=0))
        if self.slip is not None:
            object.__setattr__(self, "slip", check_slip(self.slip))

    def next_worlds(self, generators: Sequence[np.random.Generator]) -> Worlds:
        """Draw a world from each of N random generators, or choose one of ``worlds``.

        In a new world half of the obstacles are circles (radius 1.5 to 4 m) and half rectangles (sides of 3 to 8 m).
        They lie at random, at least 6 m from the start and the target. A world is drawn again if no way leads to the
        target 2 m clear of what stands still.
        """
        if self.worlds is not None:
            number = len(self.worlds)
            return self.worlds[[int(rng.integers(number)) for rng in generators]]
        return draw_worlds(
            random_keys(generators), self.obstacles, self.moving, self.starts, self.targets, self.moving_speeds
        )  # fmt: skip

    def reward_of_one(self, before: Sensing, after: Sensing, outcome: int) -> float:
        """Return the reward of one robot."""
        given = self.reward(before, after, OUTCOME_OF_ONE[outcome])
        reward = np.asarray(given, dtype=float)
        if reward.shape != (1,):
            raise ValueError(
                f"reward must give an array of shape (1,), got {reward.shape}"
            )
        return float(reward[0])


def worlds_in(options: dict[str, Any] | None, number: int) -> Worlds | None:
    """Return the worlds that the options of ``reset`` give, if they give any; check that they are ``number``."""
    for option in check_instance("options", options or {}, dict):
        check_one_of("options", option, ["worlds"])
    given = (options or {}).get("worlds")
    if given is None:
        return None
    if len(check_instance("options['worlds']", given, Worlds)) != number:
        raise ValueError(
            f"options['worlds'] must hold {number} worlds, got {len(given)}"
        )
    return given


# 2. The environment


Step = tuple[Observation, float, bool, bool, Info]


def while_running(
    step: Callable[[NavigationEnv, int], Step],
) -> Callable[[NavigationEnv, int], Step]:
    """Decorate ``step``: ValueError outside an episode, and for an action that does not exist."""

    @wraps(step)
    def checked(env: NavigationEnv, action: int) -> Step:
        if env.outcome is None:
            raise ValueError("step: call reset first")
        if env.outcome != RUNNING:
            raise ValueError("step: the episode has ended; call reset first")
        return step(env, check_action(action))

    return checked


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

    | key           | space                    | unit   | meaning                                               |
    |---------------|--------------------------|--------|-------------------------------------------------------|
    | ranges        | Box(0, 10, (9,), float64) | metres | least distance in each sector, 10 if nothing is in range |
    | walls         | MultiBinary(9)           | -      | whether that nearest thing is the map's border        |
    | target_region | Discrete(9, start=1)     | -      | sector that holds the target                          |
    | target_seen   | Discrete(2)              | -      | whether the target is within 10 m                     |

    Sector 1 (column 0) looks ahead; sectors are numbered counter-clockwise.

    ## Rewards

    1 for an arrival, -1 for a collision, else 0. ``reward`` replaces this; ``robonav.nnql.reward`` is Table 4.1.

    ## Starting state

    Each episode has a new random map, drawn as :func:`random_worlds` does from the seed of ``reset``. The robot stands
    at (10, 10), faces its target at (90, 90), and is at least 6 m from every obstacle.

    ## Episode end

    1. Termination: the robot arrives, within 3 m of the target (outcome "arrived").
    2. Termination: the robot comes nearer than 1 m to an obstacle or a border (outcome "collided").
    3. Truncation: ``gymnasium.make`` cuts episodes after 500 steps, or after its ``max_episode_steps``, by Gymnasium's
       ``TimeLimit``. The environment does not see this: its outcome stays "running". An environment made with a limit
       of its own, ``NavigationEnv(max_episode_steps=...)``, and the vector environment say "out of steps".

    ## Information

    | key     | type           | meaning                                                                |
    |---------|----------------|------------------------------------------------------------------------|
    | outcome | str            | "running", "arrived", "collided" or "out of steps"                     |
    | reflex  | int            | the action that the reflex put in place of the one given, else -1      |
    | pose    | (3,) float64   | x and y in metres, heading in radians; a robot does not know its pose  |

    ## Options

    ``reset(options={"worlds": world})`` puts the robot into a given world, a batch of one.

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
    worlds : Worlds, optional
        Choose the map of each episode among these at random, instead of drawing new ones.
    speed : float
        Of the robot, in m/s.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another, see :class:`Simulator`.
    noise : float
        Standard deviation in metres of the error of a range.
    reward : callable
        ``reward(before, after, outcome) -> (N,)`` rewards of N robots, see ``Reward``.
    reflex : callable, optional
        What the robot does before the action given counts, see :class:`Reflex`; None turns it off.
    max_episode_steps : int, optional
        Limit of the environment itself. By default it has none and leaves the limit to Gymnasium's wrapper.
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
    >>> info["outcome"], reward
    ('arrived', 1.0)
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
        worlds: Worlds | None = None,
        speed: float = 2.0,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        reward: Reward = arrival_or_collision,
        reflex: ReflexRule | None = REFLEX,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.settings = NavigationSettings(
            obstacles, moving, starts, targets, moving_speeds, worlds, speed, slip, noise, reward, reflex,
            NEVER if max_episode_steps is None else max_episode_steps,
        )  # fmt: skip
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self.observation_space = observation_space()
        self.action_space = gymnasium.spaces.Discrete(6)
        self.outcome: int | None = None  # no episode before the first reset
        self._window: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Begin an episode, in a new world unless ``options["worlds"]`` gives one."""
        super().reset(seed=seed)
        world = worlds_in(options, 1)
        if world is None:
            world = self.settings.next_worlds([self.np_random])

        # The map. A world is a batch of one; its row 0 is this one.
        self.world, self.size = world, world.size
        self.centres = world.centres[0].copy()  # obstacles move, the world stays
        self.obstacles = world.kinds[0], world.shapes[0], self.centres
        self.headings, self.speeds = world.headings[0].copy(), world.speeds[0]
        self.moving = bool(self.speeds.any())
        self.key = world.keys[0]  # random numbers of the episode are a hash of it

        # The robot stands at the start and faces its target.
        self.pose: Pose = tuple(world.start_poses[0].tolist())
        self.target = tuple(world.targets[0].tolist())
        self.steps, self.outcome = 0, RUNNING
        self.sensing = self._sense()
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info(NO_REFLEX)

    @while_running
    def step(self, action: int) -> Step:
        """Simulate one second."""
        # The reflex comes first. It may replace the action.
        settings = self.settings
        before, start, reflex = self.sensing, self.pose, NO_REFLEX
        if settings.reflex is not None:
            reflex = int(settings.reflex(before, settings.speed)[0])
        if reflex in (Action.TO_TARGET, Action.TO_SECTOR):  # nothing is in range
            start = self._facing_target(reflex)
            action = Action.F
        elif reflex != NO_REFLEX:  # it is blocked ahead
            action = reflex
        if settings.slip is not None:
            action = slip_to(action, settings.slip, self.key, self.steps)

        # The robot and the obstacles move for one second.
        distance = -settings.speed if action == Action.B else settings.speed
        self.pose = turn_and_go(start, TURN_OF_ACTION[action], distance)
        centres_before = self.centres.copy()
        if self.moving:
            drift(
                self.obstacles, self.headings, self.speeds, self.size, self.key, self.steps
            )  # fmt: skip
        self.steps += 1

        # What came of it: outcome, sensing, reward.
        self.outcome = self._outcome(start, centres_before)
        self.sensing = self._sense()
        terminated = self.outcome in (ARRIVED, COLLIDED)
        truncated = self.steps >= settings.max_episode_steps
        reward = settings.reward_of_one(before, self.sensing, self.outcome)
        if self.render_mode == "human":
            self.render()
        return self._observation(), reward, terminated, truncated, self._info(reflex)

    def _facing_target(self, reflex: int) -> Pose:
        """The robot's pose after it has turned to its target, or to the middle of the sector that holds it."""
        x, y, heading = self.pose
        if reflex == Action.TO_TARGET:
            return x, y, math.atan2(self.target[1] - y, self.target[0] - x)
        sectors = int(self.sensing.target_region[0]) - 1  # from the one ahead
        return x, y, wrap(heading + SECTOR * sectors)

    def _outcome(self, start: Pose, centres_before: Array) -> int:
        """How the episode stands; a collision anywhere along the way counts, not only where the robot stops."""
        clearance = least_clearance(
            self.obstacles, centres_before, self.size, start, self.pose
        )
        to_target = math.hypot(
            self.target[0] - self.pose[0], self.target[1] - self.pose[1]
        )
        if clearance < COLLISION_DISTANCE:  # 1 m
            return COLLIDED
        if micrometres(to_target) <= ARRIVAL_DISTANCE:  # 3 m
            return ARRIVED
        if self.steps >= self.settings.max_episode_steps:
            return OUT_OF_STEPS
        return RUNNING

    def _sense(self) -> Sensing:
        """What the robot senses now: one row, as reflexes, rewards and policies take rows of many robots."""
        ranges, walls = np.empty(SENSORS), np.empty(SENSORS, dtype=np.bool_)
        region, seen = sense(
            self.obstacles, self.size, self.pose, self.target, self.settings.noise,
            self.key, self.steps, ranges, walls,
        )  # fmt: skip
        return Sensing(ranges[None], walls[None], np.array([region]), np.array([seen]))

    def _observation(self) -> Observation:
        sensing = self.sensing
        return {
            "ranges": sensing.ranges[0].copy(),  # a copy, which the caller may change
            "walls": sensing.walls[0].astype(np.int8),
            "target_region": sensing.target_region[0],
            "target_seen": np.int64(sensing.target_seen[0]),
        }

    def _info(self, reflex: int) -> Info:
        return {
            "outcome": NAME_OF_OUTCOME[self.outcome],
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

        moment = (self.world, self.centres, self.pose, self.sensing.ranges[0])
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


def observation_space() -> gymnasium.spaces.Dict:
    """Return the space of one robot's observations: the fields of :class:`Sensing`."""
    return gymnasium.spaces.Dict(
        {
            "ranges": gymnasium.spaces.Box(0.0, SENSOR_RANGE, (SENSORS,), np.float64),
            "walls": gymnasium.spaces.MultiBinary(SENSORS),
            "target_region": gymnasium.spaces.Discrete(SENSORS, start=1),
            "target_seen": gymnasium.spaces.Discrete(2),
        }
    )


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
        np.atleast_1d(observation["target_region"]),
        np.atleast_1d(observation["target_seen"]).astype(bool),
    )


# 3. One second


def turn_and_go(pose: Pose, turn: float, distance: float) -> Pose:
    """Turn by an angle, then go straight on."""
    x, y, heading = pose
    heading = wrap(heading + turn)
    return x + distance * math.cos(heading), y + distance * math.sin(heading), heading


@compiled
def slip_to(action: int, slip: Array, key: Array, step: int) -> int:
    """Draw the action that comes of ``action``, whose row of ``slip`` says how likely each is."""
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
    """Let moving obstacles go on for one second. Some turn at random, and borders reflect them."""
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
    obstacles: Obstacles, centres_before: Array, size: float, start: Pose, end: Pose
) -> float:
    """Least distance to an obstacle or border while the robot goes from ``start`` to ``end``.

    Obstacles go straight and evenly from ``centres_before`` to their centres, and the robot does too. So, seen from an
    obstacle, the robot goes straight along a segment. Exact below :data:`COLLISION_DISTANCE`.
    """
    kinds, shapes, centres = obstacles
    (x0, y0, _), (x1, y1, _) = start, end
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


# 4. What the robot senses


@compiled
def sense(
    obstacles: Obstacles, size: float, pose: Pose, target: tuple[float, float],
    noise: float, key: Array, step: int, ranges: Array, walls: Flags,
) -> tuple[int, bool]:  # fmt: skip
    """Sense the least distance in each of nine sectors, and where the target is.

    Fills in ``ranges`` (9,) and ``walls`` (9,), whether the nearest thing is a border. Returns the target's sector, 1
    to 9, and whether it is in range. ``noise`` is the standard deviation of the error of a range.
    """
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
    return 1 + sector_at(bearing), seen


@compiled
def sector_at(bearing: float) -> int:
    """Index 0 to 8 of the sector of 40 degrees that holds a bearing; 0 looks ahead, counter-clockwise."""
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
    """See a circle whose centre is x ahead and y to the left."""
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
    """See a rectangle whose centre is x ahead and y to the left, its length turned to the left."""
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
    """See each border at its nearest point, and where the rays between two sectors leave the map."""
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
