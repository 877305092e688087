"""``robonav/Navigation-v0``: the robot as a Gymnasium environment (section 2.5).

``physics.py`` has its map, with the geometry of motion and sensing. ``environment_settings.py`` checks its arguments.
``vector_environment.py`` is the same environment for many robots at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from ._fast.constants import (
    ARRIVAL_DISTANCE,  # 3 m
    ARRIVED,
    COLLIDED,
    COLLISION_DISTANCE,  # 1 m
    NO_REFLEX,  # -1
    OUT_OF_STEPS,
    RUNNING,
    SECTOR,  # 40 degrees
    SENSOR_RANGE,  # 10 m
)
from .environment_settings import (
    NO_LIMIT,
    Reward,
    WorldsOrFile,
    arrival_or_collision,
    as_sensing,
    batch_of_one,
    check_render_mode,
    check_settings,
    while_running,
    worlds_in,
)
from .physics import TURNS, Map, slip_to, wrap
from .rollout import REFLEX, ReflexRule
from .simulator import Action
from .worlds import MOVING_SPEEDS, START, TARGET

__all__ = ["NavigationEnv", "as_sensing"]

Observation = dict[str, Any]
Info = dict[str, Any]


class NavigationEnv(gymnasium.Env):
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

    A reflex comes first. If nothing is in sensor range, the robot turns to its target (6), or to the middle of the
    target's sector (7), and goes forward. If all five sectors ahead are blocked, it steps back (5). It then ignores
    the action given, and ``info["reflex"]`` has what it did instead.

    ## Observation space

    ``Dict``, the fields of :class:`Sensing` for one robot. Sector 0 looks ahead; they are numbered counter-clockwise.

    | key           | space                     | meaning                                                            |
    |---------------|---------------------------|--------------------------------------------------------------------|
    | ranges        | Box(0, 10, (9,), float64) | least distance in each sector in metres, 10 if nothing is in range |
    | walls         | MultiBinary(9)            | whether that nearest thing is the map's border                     |
    | target_region | Discrete(9)               | sector that holds the target; :class:`Sensing` has 1 more          |
    | target_seen   | Discrete(2)               | whether the target is within 10 m                                  |

    ## Rewards

    1 for an arrival, -1 for a collision, else 0. ``reward`` replaces this; ``robonav.nnql.reward`` is Table 4.1.

    ## Starting state

    A new random map. The robot stands at (10, 10), at least 6 m from every obstacle, and faces its target at (90, 90).
    ``reset(options={"worlds": world})`` puts it into a given world, a batch of one.

    ## Episode end

    1. Termination: the robot arrives, within 3 m of the target.
    2. Termination: the robot comes nearer than 1 m to an obstacle or a border, anywhere on its way.
    3. Truncation: after ``max_episode_steps``. The limit of ``gymnasium.make``, 500 by default, is outside the
       environment, whose outcome then stays ``RUNNING``.

    ## Information

    | key     | type         | meaning                                                               |
    |---------|--------------|-----------------------------------------------------------------------|
    | outcome | int          | an :class:`Outcome`: 0 running, 1 arrived, 2 collided, 3 out of steps |
    | reflex  | int          | the action that the reflex put in place of the one given, else -1     |
    | pose    | (3,) float64 | x and y in metres, heading in radians; a robot does not know its pose |

    Parameters
    ----------
    obstacles, moving : int
        Obstacles of each new map that stand still, and that move.
    starts, targets : sequence of (x, y)
        Points in metres, of which each map gets one at random.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    worlds : Worlds or path, optional
        Choose each map among these, or among those of a file that :func:`save_worlds` wrote, instead of a new one.
    speed : float
        Of the robot, in m/s.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another, see :class:`Simulator`.
    noise : float
        Standard deviation in metres of the error of a range.
    reward : callable or str
        ``reward(before, after, outcome) -> (N,)`` for N robots, or its name, such as "robonav.nnql:reward".
    reflex : callable or {"exact", "sector"}, optional
        A :class:`Reflex`, its direction, or a function of the same arguments. None turns it off.
    max_episode_steps : int
        Limit of the environment itself; -1 is none.
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
    >>> reward
    1.0
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
        worlds: WorldsOrFile | None = None,
        speed: float = 2.0,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        reward: Reward | str = arrival_or_collision,
        reflex: ReflexRule | str | None = REFLEX,
        max_episode_steps: int = NO_LIMIT,
        render_mode: str | None = None,
    ) -> None:
        self.settings = check_settings(
            obstacles=obstacles, moving=moving, starts=starts, targets=targets, moving_speeds=moving_speeds,
            worlds=worlds, speed=speed, slip=slip, noise=noise, reward=reward, reflex=reflex,
            max_episode_steps=max_episode_steps,
        )  # fmt: skip
        self.render_mode = check_render_mode(render_mode, self.metadata)
        self.action_space = spaces.Discrete(6)
        self.observation_space = spaces.Dict(
            {
                "ranges": spaces.Box(0.0, SENSOR_RANGE, (9,), np.float64),
                "walls": spaces.MultiBinary(9),
                "target_region": spaces.Discrete(9),
                "target_seen": spaces.Discrete(2),
            }
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
        self.map = Map.of(self.world)  # whose obstacles may move
        self.pose = self.map.start  # x, y and heading; the robot faces its target
        self.steps, self.outcome = 0, RUNNING
        observation = self._sense()
        if self.render_mode == "human":
            self.render()
        return observation, self._info(NO_REFLEX)

    @while_running
    def step(self, action: int) -> tuple[Observation, float, bool, bool, Info]:
        """Simulate one second."""
        settings, before = self.settings, self.sensing
        x, y, heading = self.pose

        # 1. Where nothing is near, or all is blocked ahead, a reflex replaces the action.
        reflex = settings.reflex_action(before)
        if reflex == Action.TO_TARGET:
            action, heading = Action.F, self.map.heading_to_target(x, y)
        elif reflex == Action.TO_SECTOR:
            action, heading = Action.F, wrap(heading + SECTOR * self.target_region)
        elif reflex != NO_REFLEX:
            action = reflex
        if settings.slip is not None:  # it may turn into another action
            action = slip_to(action, settings.slip, self.map.key, self.steps)

        # 2. The robot turns, and goes straight on, or back. Meanwhile obstacles move.
        heading = wrap(heading + TURNS[action])
        distance = -settings.speed if action == Action.B else settings.speed
        x1, y1 = x + distance * math.cos(heading), y + distance * math.sin(heading)
        centres_before = self.map.move_obstacles(self.steps)
        self.pose, self.steps = (x1, y1, heading), self.steps + 1

        # 3. A collision anywhere on this way ends the episode, and so does an arrival.
        clearance = self.map.least_clearance(centres_before, (x, y), (x1, y1))
        truncated = self.steps >= settings.max_episode_steps
        if clearance < COLLISION_DISTANCE:
            self.outcome = COLLIDED
        elif self.map.distance_to_target(x1, y1) <= ARRIVAL_DISTANCE:
            self.outcome = ARRIVED
        elif truncated:
            self.outcome = OUT_OF_STEPS
        terminated = self.outcome in (COLLIDED, ARRIVED)

        # 4. The robot senses again. The reward may depend on what it sensed before, too.
        observation = self._sense()
        reward = settings.reward_of_step(before, self.sensing, self.outcome)
        if self.render_mode == "human":
            self.render()
        return observation, reward, terminated, truncated, self._info(reflex)

    def _sense(self) -> Observation:
        """Return what the robot senses from its pose, and keep it for the next step."""
        ranges, walls, self.target_region, target_seen = self.map.sense(
            self.pose, self.settings.noise, self.steps
        )
        # Reflexes, rewards and policies take the same as a batch, of one robot here.
        self.sensing = batch_of_one(ranges, walls, self.target_region, target_seen)
        return {
            "ranges": ranges.copy(),  # a copy, which the caller may change
            "walls": walls.astype(np.int8),
            "target_region": np.int64(self.target_region),
            "target_seen": np.int64(target_seen),
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

        moment = (self.world, self.map.centres, self.pose, self.sensing.ranges[0])
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
