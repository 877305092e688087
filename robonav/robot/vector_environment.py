"""The vector twin of ``robonav/Navigation-v0``: N robots in N worlds, stepped in one compiled call."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_integer, check_one_of

from ._fast import NO_REFLEX, OUT_OF_STEPS, RUNNING
from .environment_settings import (
    Reward,
    arrival_or_collision,
    check_settings,
    worlds_in,
)
from .environments import NavigationEnv
from .rollout import REFLEX, ReflexRule
from .simulator import Simulator, check_actions
from .worlds import MOVING_SPEEDS, START, TARGET, Worlds

MAX_STEPS = 500


class NavigationVectorEnv(gymnasium.vector.VectorEnv):
    """N robots in N worlds, stepped in one compiled call: the vector twin of :class:`NavigationEnv`.

    Actions, observations, rewards, the start and the end of an episode are those of :class:`NavigationEnv`, with a
    leading dimension N. ``gymnasium.make_vec("robonav/Navigation-v0", num_envs=N,
    vectorization_mode="vector_entry_point")`` makes one.

    ## Autoreset

    ``autoreset_mode`` chooses among Gymnasium's three ways.

    | mode      | what happens                                                                                   |
    |-----------|------------------------------------------------------------------------------------------------|
    | NEXT_STEP | The next step puts the robot into a new world. It ignores the robot's action; the reward is 0. |
    | SAME_STEP | The same step does so; ``info["final_obs"]`` and ``info["final_info"]`` have the end before.   |
    | DISABLED  | Nothing. ``reset(options={"reset_mask": mask})`` begins new episodes for some of the robots.   |

    ``reset_mask`` is an (N,) bool array, and works in all modes.

    Parameters
    ----------
    num_envs : int
        N.
    obstacles, moving, starts, targets, moving_speeds, worlds, speed, slip, noise, reward, reflex
        See :class:`NavigationEnv`.
    max_episode_steps : int
        An episode is truncated after this many seconds, as ``Outcome.OUT_OF_STEPS``; never, if it is -1.
    autoreset_mode : AutoresetMode or str
        What follows the end of an episode: "NextStep", "SameStep" or "Disabled".
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
    >>> info["outcome"]  # 0 is running, see Outcome
    array([0, 0, 0])
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - as Gymnasium declares it
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
        worlds: Worlds | str | Path | None = None,
        speed: float = 2.0,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        reward: Reward | str = arrival_or_collision,
        reflex: ReflexRule | str | None = REFLEX,
        max_episode_steps: int = MAX_STEPS,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: str | None = None,
    ) -> None:
        self.num_envs = check_integer("num_envs", num_envs, at_least=1)
        self.settings = check_settings(
            obstacles=obstacles, moving=moving, starts=starts, targets=targets, moving_speeds=moving_speeds,
            worlds=worlds, speed=speed, slip=slip, noise=noise, reward=reward, reflex=reflex,
            max_episode_steps=max_episode_steps,
        )  # fmt: skip
        self.render_mode = check_one_of(
            "render_mode", render_mode, [None, *self.metadata["render_modes"]]
        )
        self.autoreset_mode = as_autoreset_mode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode}
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
        seed: int | Sequence[int | None] | NDArray[Any] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin a new episode for every robot; robot i gets the seed ``seed + i``, as Gymnasium does, or ``seed[i]``.

        ``options={"worlds": worlds}`` puts the robots into N given worlds. ``options={"reset_mask": mask}`` begins an
        episode for the robots that the (N,) bool array ``mask`` chooses; the others stay where they are.
        """
        worlds = worlds_in(options, self.num_envs, also=("reset_mask",))
        chosen = self._chosen((options or {}).get("reset_mask"))
        self.seed(seed, chosen)
        index = np.flatnonzero(chosen)
        worlds = self._next_worlds(index) if worlds is None else worlds[index]
        if chosen.all():
            slots = max(worlds.slots, self.simulator.worlds.slots)
            self.simulator = self._simulator(worlds.with_slots(slots))
        else:
            self.simulator.restart(index, worlds)
        self.sensing = self.simulator.sense()
        self._ended = self._ended & ~chosen
        info = self._info(np.full(self.num_envs, NO_REFLEX), chosen)
        return self._observation(), info

    def seed(
        self,
        seed: int | Sequence[int | None] | NDArray[Any] | None,
        chosen: NDArray[np.bool_],
    ) -> None:
        """Give the chosen robots their random generators: from seed + i, or seed[i], or else from fresh entropy."""
        n = self.num_envs
        seeds: list[int | None]
        if isinstance(seed, Sequence | np.ndarray):
            seeds = [
                None if own is None else check_integer("seed", own, at_least=0)
                for own in seed
            ]
        elif seed is None:
            seeds = [None] * n
        else:
            first = check_integer("seed", seed, at_least=0)
            seeds = [first + i for i in range(n)]
        if len(seeds) != n:
            raise ValueError(
                f"seed must be a number or one for each of {n} robots, got {len(seeds)}"
            )
        for i in np.flatnonzero(chosen):
            if seeds[i] is not None or self._np_random is None:
                self._generators[i], _ = seeding.np_random(seeds[i])
        if chosen[0]:
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
        if fresh.any() and self.autoreset_mode is AutoresetMode.DISABLED:
            raise ValueError(
                f"step: the episodes of robots {np.flatnonzero(fresh).tolist()} have ended; "
                "call reset with options={'reset_mask': ...} first"
            )
        reflexes = np.where(fresh, NO_REFLEX, self.settings.reflexes(before))
        self.sensing = simulator.second(
            np.where(reflexes == NO_REFLEX, commands, reflexes)
        )
        if fresh.any():  # robots whose episode has ended stood still; a new one begins
            self._restart(fresh)
        rewards = self.settings.rewards(before, self.sensing, simulator.outcome)
        reward = np.where(fresh, 0.0, rewards)
        ended = simulator.outcome != RUNNING
        terminated = ended & (simulator.outcome != OUT_OF_STEPS)
        truncated = simulator.steps >= simulator.max_steps
        info = self._info(reflexes, np.ones(self.num_envs, dtype=np.bool_))
        if self.autoreset_mode is AutoresetMode.SAME_STEP and ended.any():
            info = self._begin_again(reflexes, ended)
            ended = np.zeros_like(ended)
        self._ended = ended
        return self._observation(), reward, terminated, truncated, info

    def _begin_again(
        self, reflexes: NDArray[np.int64], ended: NDArray[np.bool_]
    ) -> dict[str, Any]:
        """Begin new episodes in the step that ended the old ones; return the info, which has the ends of the old."""
        last, final_info = self._observation(), self._info(reflexes, ended)
        final_obs = np.full(self.num_envs, None, dtype=object)
        for i in np.flatnonzero(ended):
            final_obs[i] = {name: value[i] for name, value in last.items()}
        self._restart(ended)
        everyone = np.ones(self.num_envs, dtype=np.bool_)
        info = self._info(np.where(ended, NO_REFLEX, reflexes), everyone)
        return info | {
            "final_obs": final_obs, "_final_obs": ended.copy(),
            "final_info": final_info, "_final_info": ended.copy(),
        }  # fmt: skip

    def _restart(self, chosen: NDArray[np.bool_]) -> None:
        """Put the chosen robots into new worlds, where they sense again."""
        index = np.flatnonzero(chosen)
        self.simulator.restart(index, self._next_worlds(index))
        for name, rows in vars(self.simulator.sense(index)).items():
            getattr(self.sensing, name)[index] = rows

    def _next_worlds(self, index: NDArray[np.intp]) -> Worlds:
        return self.settings.next_worlds([self._generators[i] for i in index.tolist()])

    def _chosen(self, mask: Any) -> NDArray[np.bool_]:
        """Return the robots (N,) for which ``reset`` begins an episode: those of the mask, by default all."""
        n = self.num_envs
        if mask is None:
            return np.ones(n, dtype=np.bool_)
        chosen = np.asarray(mask)
        if chosen.dtype != np.bool_ or chosen.shape != (n,) or not chosen.any():
            raise ValueError(
                f"options['reset_mask'] must be a bool array of shape ({n},) with at least one True, got {mask!r}"
            )
        if len(self.simulator) == 0 and not chosen.all():
            raise ValueError("reset: reset all robots first, without a reset_mask")
        return chosen

    def _simulator(self, worlds: Worlds) -> Simulator:
        settings = self.settings
        return Simulator(
            worlds, settings.speed, slip=settings.slip, noise=settings.noise,
            max_steps=settings.max_episode_steps,
        )  # fmt: skip

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
            "target_region": read.target_region - 1,
            "target_seen": read.target_seen.astype(np.int64),
        }

    def _info(
        self, reflexes: NDArray[np.int64], chosen: NDArray[np.bool_]
    ) -> dict[str, Any]:
        """Return Gymnasium's form of N infos: arrays, 0 for robots not chosen, and masks of the chosen robots."""
        values = {
            "outcome": self.simulator.outcome.astype(np.int64),
            "reflex": reflexes.copy(),
            "pose": self.simulator.poses.copy(),
        }
        if not chosen.all():
            for value in values.values():
                value[~chosen] = 0
        return values | {f"_{name}": chosen.copy() for name in values}


def as_autoreset_mode(given: AutoresetMode | str) -> AutoresetMode:
    """Return the mode of this name or value."""
    if isinstance(given, AutoresetMode):
        return given
    return AutoresetMode(check_one_of("autoreset_mode", given, [mode.value for mode in AutoresetMode]))  # fmt: skip
