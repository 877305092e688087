"""``robonav/Navigation-v0``: the robot as a Gymnasium environment (section 2.5).

What loops over obstacles or sensors is compiled and stands in ``_fast``: ``sense_robot`` reads the sensors,
``drift_world`` moves the obstacles, ``swept_clearance`` measures how near a step came to them. ``wrap`` keeps an angle
in (-pi, pi], and ``micrometres`` rounds a distance. The arguments of the environment are checked in
:class:`NavigationSettings`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_one_of

from ._fast import (
    ARRIVAL_DISTANCE,
    ARRIVED,
    COLLIDED,
    COLLISION_DISTANCE,
    NO_REFLEX,
    OUT_OF_STEPS,
    RUNNING,
    SENSOR_RANGE,
    SENSORS,
    TURNS,
    drift_world,
    micrometres,
    sense_robot,
    slipped,
    swept_clearance,
    wrap,
)
from .environment_settings import (
    NavigationSettings,
    Reward,
    arrival_or_collision,
    worlds_in,
)
from .rollout import REFLEX, ReflexRule
from .simulator import NEVER, OUTCOMES, Action, Sensing, check_action
from .worlds import MOVING_SPEEDS, START, TARGET, Worlds

Array = NDArray[np.float64]
Observation = dict[str, Any]
Info = dict[str, Any]

TURN_OF_ACTION = TURNS.tolist()  # radians, to the left
NAME_OF_OUTCOME = OUTCOMES.tolist()


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

    The reflex comes first. If nothing is in sensor range, the robot turns to its target and goes forward (6). If all
    five sectors ahead are blocked, it steps back (5). In both cases it ignores the action given, and
    ``info["reflex"]`` names what it did instead.

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
        What the robot does before the action given counts; None turns it off.
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

        # The map: its size and obstacles, of which some may move.
        self.world, self.size = world, world.size
        self.kinds, self.shapes = world.kinds[0], world.shapes[0]
        self.centres, self.headings = world.centres[0].copy(), world.headings[0].copy()
        self.speeds = world.speeds[0]
        self.key = world.keys[0]  # random numbers of the episode are a hash of it

        # The robot stands at the start and faces its target.
        self.pose = tuple(world.start_poses[0].tolist())  # x, y and heading
        self.target = tuple(world.targets[0].tolist())
        self.steps, self.outcome = 0, RUNNING
        self.sensing = self._sense()
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info(NO_REFLEX)

    def step(self, action: int) -> tuple[Observation, float, bool, bool, Info]:
        """Simulate one second."""
        command, reflex = self._command(action)  # the reflex may replace the action
        before, centres_before = self.sensing, self.centres.copy()

        # The robot turns, and then goes straight on for one second.
        x, y, heading = self.pose
        if reflex == Action.TO_TARGET:
            heading = math.atan2(self.target[1] - y, self.target[0] - x)
        heading = wrap(heading + TURN_OF_ACTION[command])
        speed = self.settings.speed
        distance = -speed if command == Action.B else speed
        new_x = x + distance * math.cos(heading)
        new_y = y + distance * math.sin(heading)
        self.pose = (new_x, new_y, heading)
        self._move_obstacles()
        self.steps += 1

        # A collision anywhere along the way counts, not only where the robot stops.
        clearance = self._clearance(centres_before, x, y, new_x, new_y)
        to_target = math.hypot(self.target[0] - new_x, self.target[1] - new_y)
        if clearance < COLLISION_DISTANCE:  # 1 m
            self.outcome = COLLIDED
        elif micrometres(to_target) <= ARRIVAL_DISTANCE:  # 3 m
            self.outcome = ARRIVED
        elif self.steps >= self.settings.max_episode_steps:
            self.outcome = OUT_OF_STEPS

        self.sensing = self._sense()
        reward = self._reward(before, self.sensing)
        terminated = self.outcome in (ARRIVED, COLLIDED)
        truncated = self.steps >= self.settings.max_episode_steps
        if self.render_mode == "human":
            self.render()
        return self._observation(), reward, terminated, truncated, self._info(reflex)

    def _command(self, action: int) -> tuple[int, int]:
        """Return what the robot does, 0 to 5, and the action of its reflex or NO_REFLEX."""
        if self.outcome is None:
            raise ValueError("step: call reset first")
        if self.outcome != RUNNING:
            raise ValueError("step: the episode has ended; call reset first")
        command, reflex = check_action(action), NO_REFLEX
        settings = self.settings
        if settings.reflex is not None:
            reflex = int(settings.reflex(self.sensing, settings.speed)[0])
        if reflex == Action.TO_TARGET:
            command = Action.F  # once it faces the target
        elif reflex != NO_REFLEX:
            command = reflex
        if settings.slip is not None:  # an uncertain action turns into another
            command = slipped(command, settings.slip, self.key, self.steps)
        return command, reflex

    def _move_obstacles(self) -> None:
        """Moving obstacles go on for one second; now and then one takes a new heading."""
        drift_world(
            self.kinds, self.shapes, self.speeds, self.key, self.steps,
            self.size, self.centres, self.headings,
        )  # fmt: skip

    def _clearance(
        self, centres_before: Array, x: float, y: float, new_x: float, new_y: float
    ) -> float:
        """Least distance to an obstacle or border in this second, exact where it is below 1 m."""
        clearance = swept_clearance(
            self.kinds, self.shapes, centres_before, self.centres, self.size,
            x, y, new_x, new_y, COLLISION_DISTANCE + 1e-3,
        )  # fmt: skip
        return micrometres(clearance)  # rounded: the last bit should decide nothing

    def _sense(self) -> Sensing:
        """What the robot senses now, as a batch of one."""
        sensing = Sensing.empty(1)
        sensing.target_region[0], sensing.target_seen[0] = sense_robot(
            self.kinds, self.shapes, self.centres, self.size, *self.pose, *self.target,
            self.key, self.steps, self.settings.noise, sensing.ranges[0], sensing.walls[0],
        )  # fmt: skip
        return sensing

    def _reward(self, before: Sensing, after: Sensing) -> float:
        outcome = np.array([self.outcome], dtype=np.int8)
        reward = np.asarray(self.settings.reward(before, after, outcome), dtype=float)
        if reward.shape != (1,):
            raise ValueError(
                f"reward must give an array of shape (1,), got {reward.shape}"
            )
        return float(reward[0])

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
