"""The simulator of teams: R robots on each of N maps, which sense each other as moving obstacles."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_instance

from .._fast import RUNNING, in_threads
from ..simulator import NEVER, Sensing, Simulator, check_commands
from ..worlds import Worlds
from . import _fast
from .teams import Teams


class TeamSimulator(Simulator):
    """R robots on each of N maps, stepped together; a step is one second.

    Robot r of map i is number i * R + r. To :func:`robonav.robot.run_episodes`, to policies and to rewards this is a
    simulator of N * R robots. Each senses the others of its map that are running as circles of 1 m: that is how near an
    obstacle may come to a robot. So two robots collide when their centres come nearer than 2 m, anywhere on their way.
    A robot whose episode has ended, by arrival, collision or lack of steps, leaves the map.

    Parameters
    ----------
    teams : Teams
        N maps of R robots.
    speed : float
        Of the robots in m/s, positive.
    slip : (6, 6) array, optional
        Probabilities that action a (row) turns into another.
    noise : float
        Standard deviation in metres of an error on every range that sees something.
    max_steps : int
        An episode ends as "out of steps" after this many seconds.

    Attributes
    ----------
    poses : (N * R, 3) array
        x and y in metres and heading in radians, now.
    centres : (N, M, 2) array
        Where the obstacles are now.
    headings : (N, M) array
        Where moving obstacles are going now.
    steps : (N * R,) int array
        Steps taken.
    outcome : (N * R,) int array
        How the episodes stand: codes into ``OUTCOMES``.
    met : (N * R,) bool array
        Which robots have collided with another robot; in the same second they may have hit an obstacle too.

    Examples
    --------
    Two robots go towards each other, and do not see to it:

    >>> import numpy as np
    >>> from robonav.robot import make_world
    >>> from robonav.robot.team import Teams, TeamSimulator
    >>> teams = Teams(make_world(), starts=[[(47, 50), (53, 50)]], targets=[[(80, 50), (20, 50)]])
    >>> simulator = TeamSimulator(teams, speed=2.0)
    >>> simulator.sense().ranges[:, 0]  # 6 m apart, less the other's radius
    array([5., 5.])
    >>> _ = simulator.step(np.array([0, 0]))
    >>> simulator.outcome, simulator.met  # they came as near as 2 m
    (array([0, 0], dtype=int8), array([False, False]))
    >>> _ = simulator.step(np.array([0, 0]))
    >>> simulator.outcome, simulator.met
    (array([2, 2], dtype=int8), array([ True,  True]))
    """

    def __init__(
        self,
        teams: Teams,
        speed: float = 2.0,
        *,
        slip: ArrayLike | None = None,
        noise: float = 0.0,
        max_steps: int = NEVER,
    ) -> None:
        self.teams = check_instance("teams", teams, Teams)
        super().__init__(
            teams.worlds, speed, slip=slip, noise=noise, max_steps=max_steps
        )
        number = len(teams) * teams.robots
        self._everyone = np.arange(number)
        self._keys, self._targets = teams.keys, teams.targets.reshape(-1, 2)
        self._clock = np.zeros(len(teams), dtype=np.int64)
        self.poses = teams.start_poses
        self.steps = np.zeros(number, dtype=np.int64)
        self.outcome = np.zeros(number, dtype=np.int8)
        self.met = np.zeros(number, dtype=np.bool_)

    def __len__(self) -> int:
        return len(self._everyone)

    def sense(self, robots: NDArray[np.int64] | None = None) -> Sensing:
        """What robots perceive now.

        Parameters
        ----------
        robots : (K,) array of int, optional
            Their numbers; by default all N * R.

        Returns
        -------
        Sensing

        Examples
        --------
        >>> from robonav.robot.team import TeamSimulator, random_teams
        >>> len(TeamSimulator(random_teams(3, robots=4, seed=1)).sense())
        12
        """
        rows = self._rows(robots)
        w, read = self.worlds, Sensing.empty(len(rows))
        in_threads(
            _fast.sense, len(rows), rows, self.teams.robots, w.kinds, w.shapes, self.centres, w.speeds, w.size,
            self.poses, self.outcome, self._targets, self._keys, self.steps, self.noise, read.ranges, read.walls,
            read.target_region, read.target_seen,
        )  # fmt: skip
        return read

    def step(
        self, commands: NDArray[np.int64], robots: NDArray[np.int64] | None = None
    ) -> NDArray[np.int64]:
        """One second for all robots that are running.

        Parameters
        ----------
        commands : (K,) array of int
            What each robot is to do, codes of :class:`robonav.robot.Action`.
        robots : (K,) array of int, optional
            Numbers of all robots that are running, ascending; by default all N * R, where commands of those whose
            episode has ended do not count. Robots of a map share its time, so that none can be left out.

        Returns
        -------
        (K,) array of int
            What each robot did: ``commands``, or another action where it slipped.

        Raises
        ------
        ValueError
            If the commands are not K whole numbers 0 to 7, or if the robots are not all that are running.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot.team import TeamSimulator, random_teams
        >>> TeamSimulator(random_teams(1, robots=4, seed=1)).step(np.zeros(4, dtype=int))
        array([0, 0, 0, 0])
        """
        rows = self._rows(robots)
        if robots is not None:
            running = np.flatnonzero(self.outcome == RUNNING)
            if not np.array_equal(rows, running):
                raise ValueError(
                    f"robots must be all {len(running)} that are running, since robots of a map share its time"
                )
        commands = check_commands(commands, len(rows))
        executed = np.zeros(len(self), dtype=np.int64)
        executed[rows] = commands
        self._move(executed)
        return executed[rows]

    def second(self, commands: NDArray[np.int64]) -> Sensing:
        """One second for all robots that are running, as :meth:`step`, and what all N * R perceive then.

        Parameters
        ----------
        commands : (N * R,) array of int
            64-bit numbers 0 to 7, which are not checked; those of robots that slip change.

        Returns
        -------
        Sensing

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.robot.team import TeamSimulator, random_teams
        >>> simulator = TeamSimulator(random_teams(3, robots=4, seed=1))
        >>> len(simulator.second(np.zeros(12, dtype=int)))
        12
        """
        self._move(commands)
        return self.sense()

    def _move(self, commands: NDArray[np.int64]) -> None:
        w = self.worlds
        in_threads(
            _fast.step, len(w), self.teams.robots, w.kinds, w.shapes, w.speeds, w.keys, self._clock, w.size,
            self._targets, self._keys, self.slip, self.speed, self.max_steps, commands, self.poses, self.centres,
            self.headings, self.steps, self.outcome, self.met, least=max(256 // self.teams.robots, 1),
        )  # fmt: skip

    def restart(self, index: NDArray[np.int64], worlds: Worlds) -> None:
        """Robots of a team begin together: make a new simulator instead.

        Parameters
        ----------
        index : (K,) array of int
            Not used.
        worlds : Worlds
            Not used.

        Raises
        ------
        TypeError
            Always.

        Examples
        --------
        >>> from robonav.robot.team import TeamSimulator, random_teams
        >>> simulator = TeamSimulator(random_teams(3, robots=4, seed=1))
        >>> try:
        ...     simulator.restart([0], simulator.worlds[0])
        ... except TypeError as error:
        ...     print(error)
        restart: robots of a team begin together; make a new TeamSimulator
        """
        raise TypeError(
            "restart: robots of a team begin together; make a new TeamSimulator"
        )
