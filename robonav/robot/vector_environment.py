"""The vector twin of ``robonav/Navigation-v0``: N robots in N worlds, stepped in one compiled call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_integer, check_one_of

from ._fast import NO_REFLEX, OUT_OF_STEPS, RUNNING
from .environment_settings import (
    NavigationSettings,
    Reward,
    arrival_or_collision,
    worlds_in,
)
from .environments import NavigationEnv
from .rollout import REFLEX, ReflexRule, undecided
from .simulator import OUTCOMES, Sensing, Simulator, check_actions
from .worlds import MOVING_SPEEDS, START, TARGET, Worlds

MAX_STEPS = 500
_OUTCOME_NAMES = OUTCOMES.astype(object)


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
    >>> from robonav.robot.vector_environment import NavigationVectorEnv
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
        self.settings = NavigationSettings(
            obstacles, moving, starts, targets, moving_speeds, worlds, speed, slip, noise, reward, reflex,
            max_episode_steps,
        )  # fmt: skip
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self._generators = [np.random.default_rng()] * self.num_envs
        self.single_observation_space = NavigationEnv().observation_space
        self.single_action_space = gymnasium.spaces.Discrete(6)
        self.observation_space = batch_space(
            self.single_observation_space, self.num_envs
        )
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._ended = np.zeros(self.num_envs, dtype=np.bool_)
        self.simulator = self._simulator(self.settings.next_worlds([]))  # no robots yet
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
        start = worlds_in(options, self.num_envs)
        if start is None:
            start = self.settings.next_worlds(self._generators)
        slots = max(start.slots, self.simulator.worlds.slots)
        self.simulator = self._simulator(start.with_slots(slots))
        self.sensing = self.simulator.sense()
        self._ended = np.zeros(self.num_envs, dtype=np.bool_)
        return self._observation(), self._info(np.full(self.num_envs, NO_REFLEX))

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
        if len(self.simulator) == 0:
            raise ValueError("step: call reset first")
        commands = check_actions(actions, (self.num_envs,))
        simulator, before, fresh = self.simulator, self.sensing, self._ended
        reflex = self.settings.reflex or undecided
        reflexes = np.where(fresh, NO_REFLEX, reflex(before, simulator.speed))
        simulator.step(np.where(reflexes == NO_REFLEX, commands, reflexes))
        if fresh.any():  # robots whose episode has ended stood still; a new one begins
            index = np.flatnonzero(fresh)
            generators = [self._generators[i] for i in index]
            simulator.restart(index, self.settings.next_worlds(generators))
        self.sensing = simulator.sense()
        reward = self._reward(before, self.sensing)
        reward[fresh] = 0.0
        self._ended = simulator.outcome != RUNNING
        terminated = self._ended & (simulator.outcome != OUT_OF_STEPS)
        truncated = simulator.steps >= simulator.max_steps
        return (
            self._observation(), reward, terminated, truncated, self._info(reflexes)
        )  # fmt: skip

    def _simulator(self, worlds: Worlds) -> Simulator:
        settings = self.settings
        return Simulator(
            worlds, settings.speed, slip=settings.slip, noise=settings.noise,
            max_steps=settings.max_episode_steps,
        )  # fmt: skip

    def _reward(self, before: Sensing, after: Sensing) -> NDArray[np.float64]:
        outcome = self.simulator.outcome
        reward = np.array(self.settings.reward(before, after, outcome), dtype=float)
        if reward.shape != (self.num_envs,):
            raise ValueError(
                f"reward must give an array of shape ({self.num_envs},), got {reward.shape}"
            )
        return reward

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Draw every world as an image (H, W, 3), if ``render_mode`` is "rgb_array"."""
        if self.render_mode is None:
            return None
        if len(self.simulator) == 0:
            raise ValueError("render: call reset first")
        from .drawing import picture

        return tuple(
            picture(
                self.simulator.worlds[i], self.simulator.centres[i], self.simulator.poses[i], self.sensing.ranges[i]
            )
            for i in range(self.num_envs)
        )  # fmt: skip

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
