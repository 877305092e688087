"""``robonav/Navigation-v0``: the robot as a Gymnasium environment, and its vector twin (section 2.5)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_instance, check_integer, check_one_of

from ._fast import ARRIVED, COLLIDED, OUT_OF_STEPS, RUNNING, SENSOR_RANGE, SENSORS
from .rollout import REFLEX, ReflexRule
from .simulator import NEVER, OUTCOMES, Sensing, Simulator, check_actions
from .worlds import (
    MOVING_SPEEDS,
    SIZE,
    START,
    TARGET,
    Worlds,
    check_drawing,
    draw_worlds,
)

MAX_STEPS = 500
_OUTCOME_NAMES = OUTCOMES.astype(object)

Reward = Callable[[Sensing, Sensing, NDArray[np.int8]], ArrayLike]
"""``reward(before, after, outcome) -> (N,)``: from what N robots sensed before and after a step, and the outcomes."""


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
    return (outcome == ARRIVED).astype(float) - (outcome == COLLIDED)


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


class NavigationVectorEnv(gymnasium.vector.VectorEnv):
    """N robots in N worlds, stepped in one compiled call: the vector twin of :class:`NavigationEnv`.

    Actions, observations, rewards, the start and the end of an episode are those of :class:`NavigationEnv`, with a
    leading dimension N. ``gymnasium.make_vec("robonav/Navigation-v0", num_envs=N,
    vectorization_mode="vector_entry_point")`` makes one.

    A robot whose episode has ended starts a new one in the next step, in a new world. That step ignores its action and
    gives reward 0 (``AutoresetMode.NEXT_STEP``).

    Parameters
    ----------
    num_envs : int
        N.
    obstacles, moving, starts, targets, moving_speeds, worlds, speed, slip, noise, reward, reflex
        See :class:`NavigationEnv`.
    max_episode_steps : int
        An episode is truncated after this many seconds; its outcome is "out of steps".
    render_mode : {"rgb_array"}, optional
        What :meth:`render` returns.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot.environments import NavigationVectorEnv
    >>> env = NavigationVectorEnv(3, obstacles=10)
    >>> observation, info = env.reset(seed=0)
    >>> observation["ranges"].shape
    (3, 9)
    >>> _, reward, terminated, truncated, info = env.step(np.zeros(3, dtype=int))
    >>> info["outcome"].tolist()
    ['running', 'running', 'running']
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
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
        max_episode_steps: int = MAX_STEPS,
        render_mode: str | None = None,
    ) -> None:
        self.num_envs = check_integer("num_envs", num_envs, at_least=1)
        check_integer("max_episode_steps", max_episode_steps, at_least=1, at_most=NEVER)
        if worlds is not None and len(check_instance("worlds", worlds, Worlds)) == 0:
            raise ValueError("worlds must hold at least one world, got none")
        check_drawing(obstacles, moving, starts, targets, moving_speeds, SIZE)
        if reflex is not None and not callable(reflex):
            raise TypeError(
                f"reflex must be callable as reflex(sensing, speed), or None, got {reflex!r}"
            )
        if not callable(reward):
            raise TypeError(
                f"reward must be callable as reward(before, after, outcome), got {type(reward).__name__}"
            )
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self.worlds = worlds
        self.reward, self.reflex = reward, reflex
        self._drawn = (obstacles, moving, tuple(starts), tuple(targets), moving_speeds)
        self._generators = [np.random.default_rng()] * self.num_envs
        self.single_observation_space = observation_space()
        self.single_action_space = gymnasium.spaces.Discrete(6)
        self.observation_space = batch_space(
            self.single_observation_space, self.num_envs
        )
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._robot: dict[str, Any] = {
            "speed": speed,
            "slip": slip,
            "noise": noise,
            "max_steps": max_episode_steps,
        }
        self.simulator = Simulator(
            self._next_worlds(np.arange(0)), **self._robot
        )  # no robots before the first reset
        self.sensing = self.simulator.sense()

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin a new episode for every robot; robot i gets the seed ``seed + i``, as Gymnasium does.

        ``options={"worlds": worlds}`` puts the robots into N given worlds.
        """
        self.seed(seed)
        for option in check_instance("options", options or {}, dict):
            check_one_of("options", option, ["worlds"])
        given = (options or {}).get("worlds")
        if (
            given is not None
            and len(check_instance("options['worlds']", given, Worlds)) != self.num_envs
        ):
            raise ValueError(
                f"options['worlds'] must hold {self.num_envs} worlds, got {len(given)}"
            )
        start = self._next_worlds(np.arange(self.num_envs)) if given is None else given
        slots = max(start.slots, self.simulator.worlds.slots)
        self.simulator = Simulator(start.with_slots(slots), **self._robot)
        self.sensing = self.simulator.sense()
        self._ended = np.zeros(self.num_envs, dtype=np.bool_)
        return self._observation(), self._info(np.full(self.num_envs, -1))

    def seed(self, seed: int | Sequence[int | None] | None) -> None:
        """Give every robot its random generator: from seed + i, or from its own seed, or else from fresh entropy."""
        seeds: list[int | None]
        if isinstance(seed, Sequence):
            seeds = [
                None if own is None else check_integer("seed", own, at_least=0)
                for own in seed
            ]
        elif seed is None:
            seeds = [None] * self.num_envs
        else:
            first = check_integer("seed", seed, at_least=0)
            seeds = [first + i for i in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise ValueError(
                f"seed must be a number or one for each of {self.num_envs} robots, got {len(seeds)}"
            )
        for i, own in enumerate(seeds):
            if own is not None or self._np_random is None:
                self._generators[i], _ = seeding.np_random(own)
        self._np_random, self._np_random_seed = self._generators[0], seeds[0]

    def step(
        self, actions: ArrayLike
    ) -> tuple[
        dict[str, Any],
        NDArray[np.float64],
        NDArray[np.bool_],
        NDArray[np.bool_],
        dict[str, Any],
    ]:
        """Simulate one second; the class says what happens after the end of an episode."""
        reward, terminated, truncated, reflexes = self.advance(actions)
        return self._observation(), reward, terminated, truncated, self._info(reflexes)

    def advance(
        self, actions: ArrayLike
    ) -> tuple[
        NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.int64]
    ]:
        """Step, and return rewards, terminated, truncated and the actions of the reflexes, each (N,)."""
        if len(self.simulator) == 0:
            raise ValueError("step: call reset first")
        commands = check_actions(actions, (self.num_envs,))
        simulator, before, fresh = self.simulator, self.sensing, self._ended
        some_fresh = fresh.any()
        reflexes = (
            np.full(self.num_envs, -1)
            if self.reflex is None
            else self.reflex(before, simulator.speed)
        )
        if some_fresh:
            reflexes[fresh] = -1
        simulator.step(np.where(reflexes < 0, commands, reflexes))
        if some_fresh:
            index = np.flatnonzero(fresh)
            simulator.restart(index, self._next_worlds(index))
        self.sensing = simulator.sense()
        reward = np.array(
            self.reward(before, self.sensing, simulator.outcome), dtype=float
        )
        if reward.shape != (self.num_envs,):
            raise ValueError(
                f"reward must give an array of shape ({self.num_envs},), got {reward.shape}"
            )
        reward[fresh] = 0.0
        self._ended = simulator.outcome != RUNNING
        terminated = self._ended & (simulator.outcome != OUT_OF_STEPS)
        return reward, terminated, simulator.steps >= simulator.max_steps, reflexes

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Draw every world as an image (H, W, 3), if ``render_mode`` is "rgb_array"."""
        if self.render_mode is None:
            return None
        if len(self.simulator) == 0:
            raise ValueError("render: call reset first")
        from .drawing import picture

        return tuple(picture(self.simulator, i) for i in range(self.num_envs))

    def _next_worlds(self, robots: NDArray[np.int64]) -> Worlds:
        """Draw the next world of each of these robots from its own generator."""
        if self.worlds is not None:
            return self.worlds[
                [int(self._generators[i].integers(len(self.worlds))) for i in robots]
            ]
        raw = np.array(
            [self._generators[i].bit_generator.random_raw() for i in robots],
            dtype="<u8",
        )
        return draw_worlds(
            raw.view("<u4").reshape(-1, 2).astype(np.uint32), *self._drawn
        )

    def _observation(self) -> dict[str, Any]:
        read = self.sensing
        return {
            "ranges": read.ranges.copy(),  # a copy, which the caller may change
            "walls": read.walls.astype(np.int8),
            "target_region": read.target_region.copy(),
            "target_seen": read.target_seen.astype(np.int64),
        }

    def _info(self, reflexes: NDArray[np.int64]) -> dict[str, Any]:
        everyone = np.ones(self.num_envs, dtype=np.bool_)
        values = {
            "outcome": _OUTCOME_NAMES[self.simulator.outcome],
            "reflex": reflexes,
            "pose": self.simulator.poses.copy(),
        }
        return values | {f"_{name}": everyone for name in values}


class NavigationEnv(gymnasium.Env):
    """A mobile robot has to reach a target in an unknown map without hitting anything (section 2.5).

    ## Description

    The robot crosses a square map of 100 m with circular and rectangular obstacles. It senses distances in nine
    sectors of 40 degrees and the direction of its target, never the map. One step lasts one second. This is the batch
    of one of :class:`NavigationVectorEnv`, with the same numbers bit for bit.

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
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self.batch = NavigationVectorEnv(
            1,
            obstacles=obstacles,
            moving=moving,
            starts=starts,
            targets=targets,
            moving_speeds=moving_speeds,
            worlds=worlds,
            speed=speed,
            slip=slip,
            noise=noise,
            reward=reward,
            reflex=reflex,
            max_episode_steps=NEVER if max_episode_steps is None else max_episode_steps,
        )
        self.observation_space = self.batch.single_observation_space
        self.action_space = self.batch.single_action_space
        self._window: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode, in a new world unless ``options["worlds"]`` gives one."""
        super().reset(seed=seed)
        self.batch.seed(seed)
        self._np_random = self.batch.np_random
        self.batch.reset(options=options)
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info(-1)

    def step(
        self, action: int
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Simulate one second; raise ValueError or TypeError for an action that is not 0 to 5."""
        if len(self.batch.simulator) and self.batch.simulator.outcome[0] != RUNNING:
            raise ValueError("step: the episode has ended; call reset first")
        reward, terminated, truncated, reflexes = self.batch.advance(
            check_actions(action, ())[None]
        )
        if self.render_mode == "human":
            self.render()
        return (
            self._observation(),
            float(reward[0]),
            bool(terminated[0]),
            bool(truncated[0]),
            self._info(reflexes[0]),
        )

    def _observation(self) -> dict[str, Any]:
        read = self.batch.sensing
        return {
            "ranges": read.ranges[0].copy(),  # a copy, which the caller may change
            "walls": read.walls[0].astype(np.int8),
            "target_region": read.target_region[0],
            "target_seen": np.int64(read.target_seen[0]),
        }

    def _info(self, reflex: int) -> dict[str, Any]:
        simulator = self.batch.simulator
        return {
            "outcome": _OUTCOME_NAMES[simulator.outcome[0]],
            "reflex": int(reflex),
            "pose": simulator.poses[0].copy(),
        }

    def render(self) -> NDArray[np.uint8] | None:
        """Return an image (H, W, 3), or show it in a window."""
        if self.render_mode is None:
            return None
        from .drawing import Window, picture

        if self.render_mode == "rgb_array":
            return picture(self.batch.simulator, 0)
        self._window = self._window or Window()
        self._window.show(self.batch.simulator, 0)
        return None

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None
