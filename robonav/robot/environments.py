"""``robonav/Navigation-v0``: the robot as a Gymnasium environment, and its vector twin (section 2.5)."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_instance, check_integer, check_one_of

from ._fast import ARRIVED, COLLIDED, OUT_OF_STEPS, RUNNING, SENSOR_RANGE, SENSORS
from .rollout import REFLEX
from .simulator import NEVER, OUTCOMES, Reflex, Sensing, Simulator, check_actions
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
"""``reward(before, after, outcome) -> (N,)``: what N robots sensed before and after a step, and outcome codes."""


def arrival_or_collision(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.float64]:
    """1 for arriving, -1 for colliding, else 0: (N,)."""
    return (outcome == ARRIVED).astype(float) - (outcome == COLLIDED)


def observation_space() -> gymnasium.spaces.Dict:
    """What one robot senses, as :class:`Sensing` has it."""
    return gymnasium.spaces.Dict(
        {
            "ranges": gymnasium.spaces.Box(0.0, SENSOR_RANGE, (SENSORS,), np.float64),
            "walls": gymnasium.spaces.MultiBinary(SENSORS),
            "target_region": gymnasium.spaces.Discrete(SENSORS, start=1),
            "target_seen": gymnasium.spaces.Discrete(2),
        }
    )


def as_sensing(observation: dict[str, Any]) -> Sensing:
    """An environment's observation, single or batched, as the batch that encoders and policies take."""
    return Sensing(
        np.atleast_2d(observation["ranges"]),
        np.atleast_2d(observation["walls"]).astype(bool),
        np.atleast_1d(observation["target_region"]),
        np.atleast_1d(observation["target_seen"]).astype(bool),
    )


class NavigationVectorEnv(gymnasium.vector.VectorEnv):
    """N robots in N worlds, a new world each episode; the vector twin of :class:`NavigationEnv`.

    A robot that has arrived, collided or run out of steps starts anew with the next step, whose action it ignores
    (``AutoresetMode.NEXT_STEP``).

    Parameters
    ----------
    num_envs : N.
    obstacles, moving, starts, targets, moving_speeds : of the worlds drawn, see :func:`random_worlds`.
    worlds : take these, in turn and by chance, instead of drawing new ones.
    speed, slip, noise : of the robot, see :class:`Simulator`.
    reward : see ``Reward``.
    reflex : what the robot does before the action given counts; None turns it off.
    max_episode_steps : seconds after which an episode is out of steps.
    render_mode : "rgb_array" or None.

    Notes
    -----
    ``info`` has, for every robot: ``outcome`` ("running", "arrived", "collided", "out of steps"), ``reflex`` (the
    action that the reflex put in place of the one given, else -1), ``pose`` (x, y, heading).
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
        reflex: Reflex | None = REFLEX,
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
        )  # empty until reset
        self.sensing = self.simulator.sense()

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Start every robot anew; robot i is seeded with seed + i, as Gymnasium does.

        ``options={"worlds": ...}`` puts the robots into N given worlds.
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
        """Give every robot its generator: from seed + i, from its own seed, or, the first time, by chance."""
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
        """One second for all; see the class for what happens after the end of an episode."""
        reward, terminated, truncated, reflexes = self.advance(actions)
        return self._observation(), reward, terminated, truncated, self._info(reflexes)

    def advance(
        self, actions: ArrayLike
    ) -> tuple[
        NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], NDArray[np.int64]
    ]:
        """A step without its observation and info: rewards, terminated, truncated, reflexes, each (N,)."""
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
        """A picture (H, W, 3) of every world, if ``render_mode`` is "rgb_array"."""
        if self.render_mode is None:
            return None
        if len(self.simulator) == 0:
            raise ValueError("render: call reset first")
        from .drawing import picture

        return tuple(picture(self.simulator, i) for i in range(self.num_envs))

    def _next_worlds(self, robots: NDArray[np.int64]) -> Worlds:
        """The next world of each of these robots, drawn from its own generator."""
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
            "ranges": read.ranges.copy(),  # the reader's to change
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
    """One robot on its way to a target: the batch of one of :class:`NavigationVectorEnv`, which has the parameters.

    ``render_mode`` may be "rgb_array" or "human". ``reset(options={"worlds": world})`` puts the robot into a given
    world.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["human", "rgb_array"],
        "render_fps": 10,
    }

    def __init__(
        self,
        *,
        render_mode: str | None = None,
        max_episode_steps: int = MAX_STEPS,
        **settings: Any,
    ) -> None:
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self.batch = NavigationVectorEnv(
            1, max_episode_steps=max_episode_steps, **settings
        )
        self._max_episode_steps = max_episode_steps
        self.observation_space = self.batch.single_observation_space
        self.action_space = self.batch.single_action_space
        self._window: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Start anew, in a new world unless ``options["worlds"]`` gives one."""
        super().reset(seed=seed)
        self.batch.seed(seed)
        self._np_random = self.batch.np_random
        self.batch.reset(options=options)
        self.batch.simulator.max_steps = _limit_of_callers(
            default=self._max_episode_steps
        )
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info(-1)

    def step(
        self, action: int
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """One second; ValueError or TypeError for an action that is not 0 to 5."""
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
            "ranges": read.ranges[0].copy(),  # the reader's to change
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
        """A picture (H, W, 3), or a window that shows it."""
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


def _limit_of_callers(default: int) -> int:
    """The steps allowed by a ``TimeLimit`` wrapper that is calling ``reset``, else the default.

    ``gymnasium.make(..., max_episode_steps=5)`` tells the wrapper and not the environment, whose ``info`` is to say
    "out of steps" when the wrapper truncates. So the one who calls is asked.
    """
    frame: FrameType | None = sys._getframe(2)
    for _ in range(10):  # wrappers, each a frame or two, stand between the two
        if frame is None:
            break
        caller = frame.f_locals.get("self")
        if isinstance(caller, gymnasium.wrappers.TimeLimit):
            limit: int = caller._max_episode_steps
            return limit
        frame = frame.f_back
    return default
