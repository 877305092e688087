"""``robonav/Navigation-v0``: the robot as a Gymnasium environment (section 2.5).

Angles are in radians, counter-clockwise, distances in metres. The map reaches from (0, 0) to (size, size).
``sensors.py`` has what the robot senses, ``physics.py`` how obstacles move and how far the robot stays clear of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_one_of

from ._fast.constants import (
    ARRIVAL_DISTANCE,
    ARRIVED,
    COLLIDED,
    COLLISION_DISTANCE,
    NO_REFLEX,
    OUT_OF_STEPS,
    RUNNING,
    SECTOR,
    SENSOR_RANGE,
    SENSORS,
    TURNS,
)
from ._fast.geometry import micrometres
from ._fast.motion import wrap
from .environment_settings import (
    NO_LIMIT,
    Reward,
    arrival_or_collision,
    check_settings,
    worlds_in,
)
from .physics import drift, least_clearance, slip_to
from .rollout import REFLEX, ReflexRule
from .sensors import Array, Pose, sense
from .simulator import Action, Sensing, check_action
from .worlds import MOVING_SPEEDS, START, TARGET, Worlds

Observation = dict[str, Any]
Info = dict[str, Any]
Step = tuple[Observation, float, bool, bool, Info]

TURNS_FIRST = (Action.TO_TARGET, Action.TO_SECTOR)  # then the robot goes forward


def while_running(
    step: Callable[[NavigationEnv, int], Step],
) -> Callable[[NavigationEnv, int], Step]:
    """Decorate ``step``: ValueError outside an episode, and for an action that does not exist."""

    @wraps(step)
    def checked(env: NavigationEnv, action: int) -> Step:
        """Check the state of the episode and the action, then make the step."""
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
        self.arrival_distance = ARRIVAL_DISTANCE  # 3 m: it arrives
        self.collision_distance = COLLISION_DISTANCE  # 1 m: nearer, it collides
        self.turns = TURNS.tolist()  # of actions 0 to 5: 0, 30, 60, -30, -60, 0 degrees
        self.sector = SECTOR  # 40 degrees

        self.settings = settings = check_settings(
            obstacles=obstacles, moving=moving, starts=starts, targets=targets, moving_speeds=moving_speeds,
            worlds=worlds, speed=speed, slip=slip, noise=noise, reward=reward, reflex=reflex,
            max_episode_steps=max_episode_steps,
        )  # fmt: skip
        self.speed, self.slip = settings.speed, settings.slip
        self.noise = settings.noise
        self.reflex, self.reward = settings.reflex, settings.reward_of_one
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
        (x0, y0, _), before = self.pose, self.sensing
        # The reflex may put another action in its place, and the robot may slip.
        action, heading, reflex = self._executed(action)

        # The robot turns, then goes straight on. Meanwhile obstacles move.
        distance = -self.speed if action == Action.B else self.speed
        heading = wrap(heading + self.turns[action])
        x = x0 + distance * math.cos(heading)
        y = y0 + distance * math.sin(heading)
        self.pose = x, y, heading
        centres_before = self._move_obstacles()
        self.steps += 1

        # A collision anywhere along the way counts, not only where the robot stops.
        clearance = least_clearance(
            self.obstacles, centres_before, self.size, (x0, y0), (x, y)
        )
        to_target = micrometres(math.hypot(self.target[0] - x, self.target[1] - y))
        truncated = self.steps >= self.max_episode_steps
        if clearance < self.collision_distance:
            self.outcome = COLLIDED
        elif to_target <= self.arrival_distance:
            self.outcome = ARRIVED
        else:
            self.outcome = OUT_OF_STEPS if truncated else RUNNING
        terminated = self.outcome in (COLLIDED, ARRIVED)

        self.sensing = self._sense()
        reward = self.reward(before, self.sensing, self.outcome)
        if self.render_mode == "human":
            self.render()
        return self._observation(), reward, terminated, truncated, self._info(reflex)

    def _executed(self, action: int) -> tuple[int, float, int]:
        """The action that the robot executes, the heading from which it turns, and the reflex's action or -1."""
        reflex, heading = self._reflex()
        if reflex != NO_REFLEX:
            action = Action.F if reflex in TURNS_FIRST else reflex
        if self.slip is not None:
            action = slip_to(action, self.slip, self.key, self.steps)
        return action, heading, reflex

    def _reflex(self) -> tuple[int, float]:
        """The reflex's action, -1 where the action given counts, and the heading to which it turns first."""
        x, y, heading = self.pose
        if self.reflex is None:
            return NO_REFLEX, heading
        reflex = int(self.reflex(self.sensing, self.speed)[0])
        if reflex == Action.TO_TARGET:
            heading = math.atan2(self.target[1] - y, self.target[0] - x)
        elif reflex == Action.TO_SECTOR:  # the middle of the target's sector
            sectors = int(self.sensing.target_region[0]) - 1  # from the one ahead
            heading = wrap(heading + self.sector * sectors)
        return reflex, heading

    def _move_obstacles(self) -> Array:
        """Let the moving obstacles go on for one second; return the centres of all obstacles before."""
        if not self.moving:
            return self.centres
        before = self.centres.copy()
        drift(
            self.obstacles, self.headings, self.speeds, self.size, self.key, self.steps
        )  # fmt: skip
        return before

    def _sense(self) -> Sensing:
        """What the robot senses now: one row, as reflexes, rewards and policies take rows of many robots."""
        ranges, walls = np.empty(SENSORS), np.empty(SENSORS, dtype=np.bool_)
        region, seen = sense(
            self.obstacles, self.size, self.pose, self.target, self.noise,
            self.key, self.steps, ranges, walls,
        )  # fmt: skip
        return Sensing(ranges[None], walls[None], np.array([region]), np.array([seen]))

    def _observation(self) -> Observation:
        sensing = self.sensing
        return {
            "ranges": sensing.ranges[0].copy(),  # a copy, which the caller may change
            "walls": sensing.walls[0].astype(np.int8),
            "target_region": sensing.target_region[0] - 1,
            "target_seen": np.int64(sensing.target_seen[0]),
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
