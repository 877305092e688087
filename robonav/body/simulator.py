"""N robots with a body, one in each of N worlds, which sense and act as those of the simulator of section 2.5."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from robonav.robot import SENSOR_RANGE, Sensing, Simulator, Worlds, _fast
from robonav.robot._fast import (
    BACKWARD,
    NOTHING,
    RUNNING,
    SECTOR,
    SENSORS,
    TO_SECTOR,
    TO_TARGET,
    TURNS,
)
from robonav.robot._fast.motion import outcome_of, turned_to_target
from robonav.robot.simulator import NEVER, check_commands

from .control import (
    RATE,
    SPEED_RATIO,
    Floats,
    follow,
    limited_reference,
    odometry,
    reference,
    wheel_speeds,
)
from .model import IN_SIGHT, Body, build

RAYS = 41  # of a range finder: one a degree, from one edge of its sector to the other
FAN = np.ravel([k * SECTOR + np.linspace(-0.5, 0.5, RAYS) * SECTOR for k in range(SENSORS)])  # fmt: skip
SIGHT = np.arange(6, dtype=np.uint8) == IN_SIGHT
SIGHT_HEIGHT = 0.5  # m
STEPS = 5  # of MuJoCo in one step of the control, each of 0.01 s


class BodySimulator(Simulator):
    """N robots with a body, one in each of N worlds; a step is one second, and the control runs at 20 Hz.

    All that drives a :class:`robonav.robot.Simulator` drives this one: the policies, the reflex, the planners and the
    expert. What differs is what a second does, and what the range finders read.

    Parameters
    ----------
    worlds : Worlds
        A batch of N.
    speed : float
        Of the robots in m/s, positive.
    body : Body or sequence of Body
        Of all robots, or of each.
    max_steps : int
        An episode ends as "out of steps" after this many seconds.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import BodySimulator
    >>> from robonav.robot import Action, make_world
    >>> simulator = BodySimulator(make_world(start=(10, 10), target=(10, 90)))
    >>> for _ in range(5):
    ...     _ = simulator.step(np.array([Action.F]))
    >>> simulator.poses.round(1)  # the simulator of section 2.5 says 10, 20 and 1.6
    array([[10. , 20. ,  1.6]])
    """

    def __init__(
        self,
        worlds: Worlds,
        speed: float = 2.0,
        *,
        body: Body | Sequence[Body] | None = None,
        max_steps: int = NEVER,
    ) -> None:
        super().__init__(worlds, speed, max_steps=max_steps)
        self.bodies = _bodies_of(Body() if body is None else body, len(worlds))
        self.models: list[Any] = [None] * len(worlds)
        self.states: list[Any] = [None] * len(worlds)
        self.told: list[deque[Floats]] = [deque()] * len(worlds)
        self.estimates = self.poses.copy()  # where the robots believe to be
        self.references = self.poses.copy()  # what they follow
        for i in range(len(worlds)):
            self._put_at_its_start(i)

    def _put_at_its_start(self, i: int) -> None:
        """Build the model of robot i in its world; the robot stands still at the start."""
        body, (x, y, heading) = self.bodies[i], self.poses[i]
        model = build(self.worlds[i], body)
        state = mujoco.MjData(model)
        state.qpos[:2] = x, y
        state.qpos[3:7] = math.cos(heading / 2), 0, 0, math.sin(heading / 2)
        mujoco.mj_forward(model, state)
        self.models[i], self.states[i] = model, state
        self.told[i] = deque([np.zeros(3)] * (body.delay + 1), maxlen=body.delay + 1)
        self.estimates[i] = self.references[i] = self.poses[i]

    def restart(self, index: NDArray[np.int64], worlds: Worlds) -> None:
        """Put robots at the start of new worlds, as :meth:`robonav.robot.Simulator.restart`.

        Parameters
        ----------
        index : (K,) array of int
            The robots' indices.
        worlds : Worlds
            K worlds.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.body import BodySimulator
        >>> from robonav.robot import random_worlds
        >>> simulator = BodySimulator(random_worlds(2, seed=1))
        >>> simulator.restart(np.array([1]), random_worlds(1, seed=2))
        >>> simulator.steps
        array([0, 0])
        """
        super().restart(index, worlds)
        for i in index:
            self._put_at_its_start(int(i))

    def sense(self, robots: NDArray[np.int64] | None = None) -> Sensing:
        """What robots perceive now: the readings of the range finders, and the direction of the target.

        Parameters
        ----------
        robots : (K,) array of int, optional
            Their indices; by default all N.

        Returns
        -------
        Sensing

        Examples
        --------
        >>> from robonav.body import BodySimulator
        >>> from robonav.robot import make_world
        >>> world = make_world(circles=[(50, 58, 2)], start=(50, 50), target=(50, 90))
        >>> BodySimulator(world).sense().ranges[0, 0].round(3)  # ahead
        np.float64(6.0)
        """
        rows = self._rows(robots)
        read = super().sense(rows)
        for j, i in enumerate(rows):
            read.ranges[j], read.walls[j] = self._range_finders(i)
        return read

    def _range_finders(self, i: int) -> tuple[Floats, NDArray[np.bool_]]:
        """The shortest ray of each range finder of robot i, and whether it ends at a border."""
        (x, y, heading), first = self.poses[i], RAYS * np.arange(SENSORS)
        rays = np.column_stack([np.cos(FAN + heading), np.sin(FAN + heading), 0 * FAN])
        hit, length = np.empty(len(FAN), np.int32), np.empty(len(FAN))
        mujoco.mj_multiRay(
            self.models[i], self.states[i], np.array([x, y, SIGHT_HEIGHT]), rays.ravel(), SIGHT.astype(np.uint8),
            True, -1, hit, length, None, len(FAN), SENSOR_RANGE,
        )  # fmt: skip
        length[hit < 0] = SENSOR_RANGE
        shortest = first + length.reshape(SENSORS, RAYS).argmin(axis=1)
        ranges = np.minimum(length[shortest], SENSOR_RANGE)
        seen = ranges < SENSOR_RANGE
        walls = seen & (self.models[i].geom_bodyid[hit[shortest]] == 0)
        if self.bodies[i].noise > 0:
            rng = np.random.default_rng([*self.worlds.keys[i], self.steps[i]])
            error = self.bodies[i].noise * rng.standard_normal(SENSORS)
            ranges[seen] = np.clip(ranges + error, 0.0, SENSOR_RANGE)[seen]
        return ranges, walls

    def step(
        self, commands: NDArray[np.int64], robots: NDArray[np.int64] | None = None
    ) -> NDArray[np.int64]:
        """One second for ``robots`` (K,), by default all N, as :meth:`robonav.robot.Simulator.step`.

        Parameters
        ----------
        commands : (K,) array of int
            What each robot is to do, codes of :class:`robonav.robot.Action`.
        robots : (K,) array of int, optional
            Indices of different robots. For all others, time stands still.

        Returns
        -------
        (K,) array of int
            ``commands``: a body has no other action, but it does not always do what it is told.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.body import BodySimulator
        >>> from robonav.robot import Action, make_world
        >>> simulator = BodySimulator(make_world(start=(10, 10), target=(10, 90)))
        >>> simulator.step(np.array([Action.F]))
        array([0])
        >>> simulator.poses[0, 1].round(1)  # it stood still, and motors take time
        np.float64(11.6)
        """
        rows = self._rows(robots)
        commands = check_commands(commands, len(rows))
        running = self.outcome[rows] == RUNNING
        acting = rows[running]
        after, headings = self._obstacles_after(acting)
        for command, i, there in zip(commands[running], acting, after, strict=True):
            clearance = self._second(i, command, there)
            self.steps[i] += 1
            dx, dy = self.worlds.targets[i] - self.poses[i, :2]
            self.outcome[i] = outcome_of(
                clearance, dx, dy, self.steps[i], self.max_steps
            )
        self.centres[acting], self.headings[acting] = after, headings
        return commands

    def _obstacles_after(self, rows: NDArray[np.int64]) -> tuple[Floats, Floats]:
        """Where the obstacles of these worlds are after this second, and where they are going then."""
        w = self.worlds
        centres, headings = self.centres[rows], self.headings[rows]
        _fast.drift(
            0, len(rows), w.kinds[rows], w.shapes[rows], w.speeds[rows], w.keys[rows], self.steps[rows], w.size,
            centres, headings,
        )  # fmt: skip
        return centres, headings

    def _second(self, i: int, command: int, there: Floats) -> float:
        """Drive robot i for one second, while its obstacles move ``there``; return the least clearance."""
        length = -self.speed if command == BACKWARD else self.speed
        turn = self._turn(i, command)
        start = limited_reference(self.references[i], self.estimates[i])
        before, clearance = self.centres[i], math.inf
        for tick in range(RATE):
            pose, velocity = reference(start, turn, length, tick / RATE)
            wanted = follow(self.estimates[i], pose, velocity, SPEED_RATIO * self.speed)
            turned = self._drive_wheels(i, wheel_speeds(wanted))
            self.estimates[i] = odometry(self.estimates[i], turned)
            share = np.array([tick, tick + 1]) / RATE
            here, now = (before + (there - before) * part for part in share)
            clearance = min(clearance, self._move(i, here, now))
        self.references[i] = reference(start, turn, length, 1.0)[0]
        mujoco.mj_kinematics(self.models[i], self.states[i])
        return clearance

    def _turn(self, i: int, command: int) -> float:
        """By which angle a command turns robot i."""
        if command not in (TO_TARGET, TO_SECTOR):
            return float(TURNS[command])
        x, y, heading = self.poses[i]
        dx, dy = self.worlds.targets[i] - [x, y]
        turned = turned_to_target(command, heading, dx, dy)
        return math.remainder(turned - heading, 2 * math.pi)

    def _drive_wheels(self, i: int, speeds: Floats) -> Floats:
        """Tell the motors of robot i how fast to turn, for a twentieth of a second; return how far the wheels turned.

        The motors get what they were told some twentieths of a second ago.
        """
        state, waiting = self.states[i], self.told[i]
        waiting.append(speeds)
        state.ctrl[:] = waiting[0]
        before = state.qpos[7:].copy()
        mujoco.mj_step(self.models[i], state, STEPS)
        return np.asarray(state.qpos[7:] - before)

    def _move(self, i: int, here: Floats, now: Floats) -> float:
        """Note where robot i is, move its obstacles from ``here`` to ``now``, and return the least clearance."""
        state, w = self.states[i], self.worlds
        x, y, _ = self.poses[i]
        x1, y1 = state.qpos[:2]
        state.mocap_pos[:, :2] = now[w.kinds[i] != NOTHING]
        self.poses[i] = x1, y1, _heading(state.qpos[3:7])
        return float(
            _fast.swept_clearance(
                w.kinds[i], w.shapes[i], here, now, w.size, x, y, x1, y1, 2.0
            )
        )


def _heading(quaternion: Floats) -> float:
    """The angle by which a quaternion turns about the vertical."""
    w, x, y, z = quaternion
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def _bodies_of(body: Body | Sequence[Body], number: int) -> tuple[Body, ...]:
    """The body of each robot."""
    bodies = (body,) * number if isinstance(body, Body) else tuple(body)
    if len(bodies) != number:
        raise ValueError(
            f"body must be one Body or {number} of them, got {len(bodies)}"
        )
    return bodies
