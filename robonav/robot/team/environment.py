"""``robonav/Team-v0``: several robots as a PettingZoo environment. It needs the extra ``team``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from numpy.typing import ArrayLike, NDArray
from pettingzoo import ParallelEnv

from robonav.validation import check_instance, check_integer

from .._fast import ARRIVED, COLLIDED, NO_REFLEX, RUNNING
from ..environment_settings import (
    Reward,
    arrival_or_collision,
    check_render_mode,
    check_settings,
)
from ..environments import NavigationEnv
from ..rollout import REFLEX, ReflexRule
from ..simulator import check_action
from ..vector_environment import MAX_STEPS
from ..worlds import MOVING_SPEEDS, random_keys
from .simulator import TeamSimulator
from .teams import Points, Teams, crossing, draw_teams, points_of

Observation = dict[str, Any]
Info = dict[str, Any]


class TeamEnv(ParallelEnv):
    """Several mobile robots cross one unknown map without hitting anything, or each other.

    The agents are ``"robot_0"``, ``"robot_1"`` and so on. Each has the actions, observations and rewards of
    :class:`robonav.robot.environments.NavigationEnv`; the other robots are obstacles to it, circles of 1 m that move. A
    robot that has arrived or collided leaves the map, and ``agents``. With one robot this is
    :class:`~robonav.robot.environments.NavigationEnv`: the same seed gives the same maps and the same episodes.

    ## Information

    | key     | type         | meaning                                                                        |
    |---------|--------------|--------------------------------------------------------------------------------|
    | outcome | int          | a :class:`robonav.robot.Outcome`: 0 running, 1 arrived, 2 collided, 3 no steps |
    | reflex  | int          | the action that the reflex put in place of the one given, else -1              |
    | pose    | (3,) float64 | x and y in metres, heading in radians; a robot does not know its pose          |
    | met     | bool         | whether the robot has collided with another robot                              |

    Parameters
    ----------
    robots : int
        How many cross the map.
    obstacles, moving : int
        Obstacles of each new map that stand still, and that move.
    starts, targets : sequence of (x, y), optional
        Of the robots, in metres; by default those of :func:`robonav.robot.team.crossing`.
    moving_speeds : (float, float)
        Least and greatest speed of moving obstacles, in m/s.
    speed : float
        Of the robots, in m/s.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another.
    noise : float
        Standard deviation in metres of the error of a range.
    reward : callable or str
        ``reward(before, after, outcome) -> (K,)`` for the K robots that were running, or its name,
        "module:function". The reward of a robot is its own.
    reflex : callable or {"exact", "sector"}, optional
        A :class:`robonav.robot.Reflex`, its direction, or a function of the same arguments. None turns it off.
    max_episode_steps : int
        A robot's episode is truncated after this many seconds; never, if it is -1.
    render_mode : {"rgb_array"}, optional
        Whether :meth:`render` returns an image.

    Examples
    --------
    >>> from robonav.robot.team import TeamEnv
    >>> env = TeamEnv(robots=4, obstacles=10)
    >>> observations, infos = env.reset(seed=0)
    >>> while env.agents:
    ...     actions = {agent: 0 for agent in env.agents}
    ...     observations, rewards, terminations, truncations, infos = env.step(actions)
    >>> sorted(observations)  # of the last step: robot_1 had hit an obstacle before
    ['robot_0', 'robot_2', 'robot_3']
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "robonav/Team-v0",
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "is_parallelizable": True,
    }

    def __init__(
        self,
        *,
        robots: int = 4,
        obstacles: int = 10,
        moving: int = 0,
        starts: Points | None = None,
        targets: Points | None = None,
        moving_speeds: tuple[float, float] = MOVING_SPEEDS,
        speed: float = 2.0,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        reward: Reward | str = arrival_or_collision,
        reflex: ReflexRule | str | None = REFLEX,
        max_episode_steps: int = MAX_STEPS,
        render_mode: str | None = None,
    ) -> None:
        check_integer("robots", robots, at_least=1)
        begin, end = map(points_of, crossing(robots))
        self.settings = check_settings(
            obstacles=obstacles, moving=moving, starts=starts or begin, targets=targets or end,
            moving_speeds=moving_speeds, speed=speed, slip=slip, noise=noise, reward=reward, reflex=reflex,
            max_episode_steps=max_episode_steps,
        )  # fmt: skip
        self.render_mode = check_render_mode(render_mode, self.metadata)
        self.possible_agents = [f"robot_{number}" for number in range(robots)]
        self.agents: list[str] = []
        alone = NavigationEnv()
        self.observation_spaces = dict.fromkeys(
            self.possible_agents, alone.observation_space
        )
        self.action_spaces = {
            agent: spaces.Discrete(6) for agent in self.possible_agents
        }
        self._rng, self._seeded = np.random.default_rng(), False

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of an agent's observations, that of ``robonav/Navigation-v0``.

        Parameters
        ----------
        agent : str
            One of ``possible_agents``.

        Returns
        -------
        gymnasium.spaces.Dict

        Examples
        --------
        >>> from robonav.robot.team import TeamEnv
        >>> list(TeamEnv().observation_space("robot_0"))
        ['ranges', 'target_region', 'target_seen', 'walls']
        """
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of an agent's actions.

        Parameters
        ----------
        agent : str
            One of ``possible_agents``.

        Returns
        -------
        gymnasium.spaces.Discrete

        Examples
        --------
        >>> from robonav.robot.team import TeamEnv
        >>> TeamEnv().action_space("robot_0")
        Discrete(6)
        """
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[dict[str, Observation], dict[str, Info]]:
        """Begin an episode, in a new map unless ``options["teams"]`` gives one; other options are not read.

        Parameters
        ----------
        seed : int, optional
            Seed of the maps from now on.
        options : dict, optional
            ``{"teams": team}`` with a batch of one map and as many robots.

        Returns
        -------
        observations : dict
            By agent.
        infos : dict
            By agent, see the table of information.

        Examples
        --------
        >>> from robonav.robot.team import TeamEnv
        >>> observations, infos = TeamEnv(robots=2).reset(seed=0)
        >>> infos["robot_1"]["pose"][:2]
        array([90., 90.])
        """
        if seed is not None or not self._seeded:
            (self._rng, _), self._seeded = seeding.np_random(seed), True
        settings, given = self.settings, (options or {}).get("teams")
        self.teams = self._next_team() if given is None else self._checked(given)
        self.simulator = TeamSimulator(
            self.teams, settings.speed, slip=settings.slip, noise=settings.noise,
            max_steps=settings.max_episode_steps,
        )  # fmt: skip
        self.agents = list(self.possible_agents)
        robots = np.arange(len(self.agents))
        self.sensing = self.simulator.sense(robots)
        return self._report(robots, np.full(len(robots), NO_REFLEX))

    def step(
        self, actions: Mapping[str, int]
    ) -> tuple[
        dict[str, Observation],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, Info],
    ]:
        """Simulate one second of all robots in ``agents``.

        Parameters
        ----------
        actions : dict
            The action, 0 to 5, of each agent in ``agents``.

        Returns
        -------
        observations : dict
            By agent, for all that were in ``agents`` before.
        rewards : dict
            By agent, by default 1 for an arrival, -1 for a collision, else 0.
        terminations : dict
            Which agents have arrived or collided.
        truncations : dict
            Which agents have no steps left.
        infos : dict
            By agent, see the table of information.

        Raises
        ------
        ValueError
            If an agent has no action, or one that does not exist.

        Examples
        --------
        >>> from robonav.robot.team import TeamEnv
        >>> env = TeamEnv(robots=2)
        >>> _ = env.reset(seed=0)
        >>> _, rewards, *_ = env.step({"robot_0": 0, "robot_1": 0})
        >>> rewards
        {'robot_0': 0.0, 'robot_1': 0.0}
        """
        simulator, settings, before = self.simulator, self.settings, self.sensing
        agents, robots = self.agents, np.flatnonzero(self.simulator.outcome == RUNNING)
        if missing := [agent for agent in agents if agent not in actions]:
            raise ValueError(
                f"actions must have one for each agent that is running, {', '.join(missing)} missing"
            )
        commands = np.array([check_action(actions[agent]) for agent in agents], dtype=np.int64)  # fmt: skip
        reflexes = settings.reflexes(before)
        simulator.step(np.where(reflexes == NO_REFLEX, commands, reflexes), robots)
        self.sensing = simulator.sense(robots)
        outcome = simulator.outcome[robots]
        rewards = settings.rewards(before, self.sensing, outcome)
        observations, infos = self._report(robots, reflexes)
        terminated = (outcome == ARRIVED) | (outcome == COLLIDED)
        truncated = simulator.steps[robots] >= simulator.max_steps
        ended = outcome != RUNNING
        self.agents = [
            agent for agent, over in zip(agents, ended, strict=True) if not over
        ]
        self.sensing = self.sensing[~ended]
        return (
            observations,
            dict(zip(agents, rewards.tolist(), strict=True)),
            dict(zip(agents, terminated.tolist(), strict=True)),
            dict(zip(agents, truncated.tolist(), strict=True)),
            infos,
        )

    def _next_team(self) -> Teams:
        settings = self.settings
        return draw_teams(
            random_keys([self._rng]), settings.obstacles, settings.moving, settings.starts, settings.targets,
            settings.moving_speeds,
        )  # fmt: skip

    def _checked(self, given: Any) -> Teams:
        """Return the map that the options of ``reset`` give, if it is one for these robots."""
        teams: Teams = check_instance("options['teams']", given, Teams)
        if (len(teams), teams.robots) != (1, len(self.possible_agents)):
            raise ValueError(
                f"options['teams'] must hold one map with {len(self.possible_agents)} robots, "
                f"got {len(teams)} with {teams.robots}"
            )
        return teams

    def _report(
        self, robots: NDArray[np.int64], reflexes: NDArray[np.int64]
    ) -> tuple[dict[str, Observation], dict[str, Info]]:
        """Return the observations and the infos of robots, whose rows ``sensing`` has."""
        observations, infos = {}, {}
        sensing, simulator = self.sensing, self.simulator
        for k, robot in enumerate(robots):
            agent = self.possible_agents[robot]
            observations[agent] = {
                "ranges": sensing.ranges[k].copy(),
                "walls": sensing.walls[k].astype(np.int8),
                "target_region": sensing.target_region[k] - 1,
                "target_seen": np.int64(sensing.target_seen[k]),
            }
            infos[agent] = {
                "outcome": int(simulator.outcome[robot]),
                "reflex": int(reflexes[k]),
                "pose": simulator.poses[robot].copy(),
                "met": bool(simulator.met[robot]),
            }
        return observations, infos

    def render(self) -> NDArray[np.uint8] | None:
        """Return an image of the map and the robots on it, if ``render_mode`` is "rgb_array".

        Returns
        -------
        (H, W, 3) array or None

        Examples
        --------
        >>> from robonav.robot.team import TeamEnv
        >>> env = TeamEnv(robots=2, render_mode="rgb_array")
        >>> _ = env.reset(seed=0)
        >>> env.render().shape
        (480, 480, 3)
        """
        if self.render_mode is None:
            return None
        from ..drawing import image
        from .drawing import draw_team

        simulator = self.simulator
        running = simulator.outcome == RUNNING
        return image(
            lambda axes: draw_team(
                axes, self.teams, simulator.centres[0], simulator.poses, running
            )
        )

    def close(self) -> None:
        """Do nothing: there is nothing to close.

        Examples
        --------
        >>> from robonav.robot.team import TeamEnv
        >>> TeamEnv().close()
        """


def parallel_env(**settings: Any) -> TeamEnv:
    """Return a :class:`TeamEnv`, under the name that PettingZoo's own modules give their environments.

    Parameters
    ----------
    **settings
        The arguments of :class:`TeamEnv`.

    Returns
    -------
    TeamEnv

    Examples
    --------
    >>> from robonav.robot.team import parallel_env
    >>> parallel_env(robots=2).possible_agents
    ['robot_0', 'robot_1']
    """
    return TeamEnv(**settings)
