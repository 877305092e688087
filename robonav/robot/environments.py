"""``robonav/Navigation-v0``: the compiled twin of ``plain_environment.py``, with options and rendering.

Read ``plain_environment.py`` first. ``vector_environment.py`` has the same for many robots at once.
"""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.documentation import sections_of

from ._fast.constants import ARRIVED, COLLIDED, NO_REFLEX, RUNNING
from .environment_settings import (
    NO_LIMIT,
    Reward,
    WorldsOrFile,
    arrival_or_collision,
    as_sensing,
    check_render_mode,
    check_settings,
    while_running,
    worlds_in,
)
from .plain_environment import Info, Observation, PlainNavigationEnv
from .rollout import REFLEX, ReflexRule
from .simulator import Simulator
from .worlds import MOVING_SPEEDS, START, TARGET

__all__ = ["NavigationEnv", "as_sensing"]


class NavigationEnv(gymnasium.Env):
    """## Options

    The parameters below change maps, robot and reward. ``reset(options={"worlds": world})`` puts the robot into a given
    world, a batch of one. A new world is drawn again if no path to the target stays 2 m
    away from the obstacles that stand still.

    This is the compiled twin of :class:`PlainNavigationEnv`: a :class:`Simulator` of one robot. The time limit of
    ``gymnasium.make`` is outside of it, so that the outcome is then still ``RUNNING``. ``target_region`` is counted
    from 0 here, and from 1 in a :class:`Sensing`, which policies take: see :func:`as_sensing`.

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
        plain = PlainNavigationEnv()
        self.action_space = plain.action_space
        self.observation_space = plain.observation_space
        self.outcome: Any = None  # no episode before the first reset
        self._command = np.zeros(1, dtype=np.int64)
        self._window: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Begin an episode, in a new world unless ``options["worlds"]`` gives one.

        Parameters
        ----------
        seed : int, optional
            Seed of the worlds from now on.
        options : dict, optional
            ``{"worlds": world}`` with a batch of one.

        Returns
        -------
        observation : dict
            See the table of observations.
        info : dict
            See the table of information.
        """
        super().reset(seed=seed)
        given, settings = worlds_in(options, 1), self.settings
        self.world = given or settings.next_worlds([self.np_random])
        self.simulator = Simulator(
            self.world, settings.speed, slip=settings.slip, noise=settings.noise,
            max_steps=settings.max_episode_steps,
        )  # fmt: skip
        self.sensing, self.outcome = self.simulator.sense(), RUNNING
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info(NO_REFLEX)

    @while_running
    def step(self, action: int) -> tuple[Observation, float, bool, bool, Info]:
        """Simulate one second.

        Parameters
        ----------
        action : int
            0 to 5, see the table of actions.

        Returns
        -------
        observation : dict
            See the table of observations.
        reward : float
            By default 1 for an arrival, -1 for a collision, else 0.
        terminated : bool
            Whether the robot has arrived or collided.
        truncated : bool
            Whether ``max_episode_steps`` is over.
        info : dict
            See the table of information.
        """
        simulator, settings, before = self.simulator, self.settings, self.sensing
        reflex = int(settings.reflexes(before)[0])
        self._command[0] = action if reflex == NO_REFLEX else reflex
        self.sensing = simulator.second(self._command)
        self.outcome = int(simulator.outcome[0])

        reward = settings.rewards(before, self.sensing, simulator.outcome)
        terminated = self.outcome in (ARRIVED, COLLIDED)
        truncated = bool(simulator.steps[0] >= simulator.max_steps)
        if self.render_mode == "human":
            self.render()
        info = self._info(reflex)
        return self._observation(), float(reward[0]), terminated, truncated, info

    def _observation(self) -> Observation:
        sensing = self.sensing  # a row, which reflexes, rewards and policies take
        return {
            "ranges": sensing.ranges[0].copy(),  # a copy, which the caller may change
            "walls": sensing.walls[0].astype(np.int8),
            "target_region": sensing.target_region[0] - 1,
            "target_seen": np.int64(sensing.target_seen[0]),
        }

    def _info(self, reflex: int) -> Info:
        pose = self.simulator.poses[0].copy()
        return {"outcome": self.outcome, "reflex": reflex, "pose": pose}

    def render(self) -> NDArray[np.uint8] | None:
        """Return an image (H, W, 3), or show it in a window."""
        if self.render_mode is None:
            return None
        if self.outcome is None:
            raise ValueError("render: call reset first")
        from .drawing import Window, picture

        simulator, ranges = self.simulator, self.sensing.ranges[0]
        moment = (self.world, simulator.centres[0], simulator.poses[0], ranges)
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


# help() begins with what the twins have in common: the tables of actions, observations, rewards
NavigationEnv.__doc__ = "\n\n".join(
    [
        sections_of(inspect.getdoc(PlainNavigationEnv) or "")[0],
        inspect.getdoc(NavigationEnv) or "",
    ]
)
