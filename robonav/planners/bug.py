"""A bug algorithm with range sensors and a memory (Lumelsky and Stepanov 1987, Kamon, Rimon and Rivlin 1998)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.robot import SENSOR_RANGE, Action, ActionSelector, Sensing, Simulator
from robonav.validation import check_positive, check_real

from .sectors import CENTRES, WAYS, Floats, free_way, turned

FROM_THE_LEFT = [Action.L60, Action.L30, Action.F, Action.R30, Action.R60]
ON_THE_LEFT = [
    0,
    1,
    2,
    3,
    4,
]  # columns of the sectors in which a wall on the left may lie
MIRRORED_SECTORS = [0, 8, 7, 6, 5, 4, 3, 2, 1]
MIRRORED_ACTIONS = np.array([0, 3, 4, 1, 2, 5])
FAN: Floats = np.radians(np.arange(-180.0, 180.0, 10.0))


@dataclass(eq=False)
class BugMemory:
    """What N robots remember of their episodes.

    Attributes
    ----------
    side : (N,) int array
        1 while a robot follows an obstacle on its left, -1 on its right, 0 while it goes to the target.
    least : (N,) array
        Least distance to the target in metres since the robot met the obstacle that it follows.

    Examples
    --------
    >>> from robonav.planners import BugMemory
    >>> BugMemory.empty(3).side
    array([0, 0, 0])
    """

    side: NDArray[np.int64]
    least: Floats

    @staticmethod
    def empty(n: int) -> BugMemory:
        """Return the memory of N robots at the start of an episode.

        Parameters
        ----------
        n : int
            N.

        Returns
        -------
        BugMemory

        Examples
        --------
        >>> from robonav.planners import BugMemory
        >>> BugMemory.empty(2).least
        array([inf, inf])
        """
        return BugMemory(np.zeros(n, dtype=np.int64), np.full(n, np.inf))


def bug(
    memory: BugMemory,
    sensing: Sensing,
    target: Floats,
    distance: Floats,
    *,
    speed: float,
    clearance: float,
    half_width: float,
    sight: float,
) -> tuple[NDArray[np.int64], BugMemory]:
    """One step of a bug algorithm with range sensors (Kamon, Rimon and Rivlin 1998).

    1. A robot that follows an obstacle leaves it where it sees a free point nearer to the target than all places at
       which it has been since it met the obstacle, or where nothing is left beside it.
    2. A robot on its way to the target meets an obstacle where the way is not free as far as ``sight``. It passes on
       the side whose first free direction is nearer to the target, and keeps the obstacle on the other side.
    3. Without an obstacle to follow it turns to the target, as far as the way is free for two steps, and goes.
    4. No step is taken on which the robot would come too near; where all are such, it steps back.

    Parameters
    ----------
    memory : BugMemory
        What N robots remember.
    sensing : Sensing
        What they sense.
    target, distance : (N,) arrays
        Bearing in radians and distance in metres of their targets, by odometry.
    speed : float
        Length of a step in metres.
    clearance, half_width : float
        As in :func:`free_way`.
    sight : float
        Metres, at most 10.

    Returns
    -------
    actions : (N,) int array
    memory : BugMemory
        What they remember afterwards.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.planners import BugMemory, bug
    >>> from robonav.robot import make_world, sense
    >>> sensing = sense(make_world(circles=[(54, 51, 2)], target=(90, 50)), [(50, 50, 0)])
    >>> lengths = {"speed": 2.0, "clearance": 1.0, "half_width": 0.3, "sight": 4.0}
    >>> now = np.zeros(1), np.full(1, 40.0)
    >>> actions, memory = bug(BugMemory.empty(1), sensing, *now, **lengths)
    >>> actions, memory.side, memory.least
    (array([4]), array([1]), array([40.]))
    """
    room = {"clearance": clearance, "half_width": half_width}
    ranges, n = sensing.ranges, np.arange(len(sensing))
    way = free_way(ranges, target[:, None], **room)[:, 0]
    free = way >= np.minimum(sight, distance)
    least = np.minimum(memory.least, distance)
    leaves = free & (distance - way < memory.least - speed)  # 1
    leaves |= ~beside(ranges, memory.side)
    side = np.where(leaves, 0, memory.side)
    meets = (side == 0) & ~free  # 2
    side[meets] = passing_side(ranges[meets], target[meets], sight, **room)
    least[meets] = distance[meets]
    way = free_way(ranges, WAYS[:5], **room)
    off = np.abs(turned(target[:, None] - WAYS[:5])).round(9)
    actions = np.where(way >= 2 * speed, off, np.pi + off).argmin(axis=1)  # 3
    for hand, follow in ((1, follow_on_the_left), (-1, follow_on_the_right)):
        actions[side == hand] = follow(ranges[side == hand], speed, **room)
    farthest = np.where(way.max(axis=1) >= speed, way.argmax(axis=1), Action.B)  # 4
    actions = np.where(way[n, actions] >= speed, actions, farthest)
    return actions, BugMemory(side, np.where(side == 0, np.inf, least))


def beside(ranges: Floats, side: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return whether robots (N,) sense anything ahead or on the side on which they follow an obstacle.

    Examples
    --------
    >>> import numpy as np
    >>> ranges = np.full((2, 9), 10.0)
    >>> ranges[:, 2] = 3.0  # on the left
    >>> beside(ranges, np.array([1, -1]))
    array([ True, False])
    """
    on_right = ranges[:, MIRRORED_SECTORS][:, ON_THE_LEFT].min(axis=1)
    near = np.where(side == 1, ranges[:, ON_THE_LEFT].min(axis=1), on_right)
    return near < SENSOR_RANGE


def passing_side(
    ranges: Floats, target: Floats, sight: float, *, clearance: float, half_width: float
) -> NDArray[np.int64]:
    """Return on which side robots keep an obstacle that they meet: 1 on the left, -1 on the right.

    The robot passes to the right of the obstacle, and so has it on the left, if the first free direction to the right
    of the target is not farther from the target than the first one to its left.

    Examples
    --------
    >>> import numpy as np
    >>> ranges = np.full((1, 9), 10.0)
    >>> ranges[0, [0, 1]] = 3.0
    >>> passing_side(ranges, np.zeros(1), 5.0, clearance=1.0, half_width=0.3)
    array([1])
    """
    way = free_way(
        ranges, target[:, None] + FAN, clearance=clearance, half_width=half_width
    )
    off = np.where(way >= sight, np.abs(FAN), np.inf)
    first_left = off[:, FAN > 0].min(axis=1)
    first_right = off[:, FAN < 0].min(axis=1)
    return np.where(first_right <= first_left + 1e-9, 1, -1)


def follow_on_the_left(
    ranges: Floats, speed: float, *, clearance: float, half_width: float
) -> NDArray[np.int64]:
    """Return the actions that keep an obstacle on the left: the leftmost step that passes to the right of it.

    Examples
    --------
    >>> import numpy as np
    >>> ranges = np.full((2, 9), 10.0)
    >>> ranges[0, 2] = 2.5  # a wall on the left
    >>> ranges[1, [0, 1, 8]] = 2.5  # a wall ahead
    >>> follow_on_the_left(ranges, 2.0, clearance=1.5, half_width=0.3)
    array([0, 4])
    """
    ways = WAYS[FROM_THE_LEFT]
    near = ranges[:, ON_THE_LEFT]
    wall = CENTRES[ON_THE_LEFT][near.argmin(axis=1)]
    way = free_way(ranges, ways, clearance=clearance, half_width=half_width)
    passes = (way >= 2 * speed) & (ways <= wall[:, None] + 1e-9)
    passes[:, -1] = True  # where no step is free, turn away as far as possible
    best = passes.argmax(axis=1)
    return np.array(FROM_THE_LEFT)[best]


def follow_on_the_right(
    ranges: Floats, speed: float, *, clearance: float, half_width: float
) -> NDArray[np.int64]:
    """Return the actions that keep an obstacle on the right, in the mirror.

    Examples
    --------
    >>> import numpy as np
    >>> ranges = np.full((1, 9), 10.0)
    >>> ranges[0, [0, 1, 8]] = 2.5  # a wall ahead
    >>> follow_on_the_right(ranges, 2.0, clearance=1.5, half_width=0.3)
    array([2])
    """
    mirrored = follow_on_the_left(
        ranges[:, MIRRORED_SECTORS], speed, clearance=clearance, half_width=half_width
    )
    return MIRRORED_ACTIONS[mirrored]


@dataclass(frozen=True)
class Bug:
    """A policy that remembers which obstacle it follows, on which side, and how near to the target it has been.

    It knows the nine ranges, and by an odometer without error its own place, and so the direction and the distance of
    the target. :func:`robonav.robot.navigate` calls ``begin``, so every episode starts without memories.

    Parameters
    ----------
    clearance, half_width : float
        As in :func:`free_way`.
    sight : float
        As in :func:`bug`.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> from robonav.planners import Bug
    >>> from robonav.robot import navigate, random_worlds
    >>> float(navigate(Bug(), random_worlds(100, obstacles=10, seed=1)).success.mean())
    0.99
    """

    clearance: float = 1.5
    half_width: float = 0.17
    sight: float = 5.0

    def __post_init__(self) -> None:
        check_real("clearance", self.clearance, at_least=0)
        check_real("half_width", self.half_width, at_least=0)
        check_positive("sight", self.sight)

    def begin(self, simulator: Simulator, rng: np.random.Generator) -> ActionSelector:
        """Return the selector of actions for the robots of a simulator, which remembers their episodes.

        Parameters
        ----------
        simulator : Simulator
            Its N robots are driven.
        rng : numpy.random.Generator
            Of random numbers. Not used.

        Returns
        -------
        callable
            ``select_actions(simulator, sensing, robots)`` returns actions.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.planners import Bug
        >>> from robonav.robot import Simulator, random_worlds
        >>> simulator, rng = Simulator(random_worlds(2, seed=1)), np.random.default_rng(0)
        >>> Bug().begin(simulator, rng)(simulator, simulator.sense(), np.arange(2))
        array([0, 0])
        """
        n = len(simulator)
        kept, asked = BugMemory.empty(n), np.full(n, -1)

        def select_actions(
            simulator: Simulator, sensing: Sensing, robots: NDArray[np.int64]
        ) -> NDArray[np.int64]:
            """Return the actions (K,) of K robots; a new episode has no memories."""
            new = robots[simulator.steps[robots] <= asked[robots]]
            kept.side[new], kept.least[new] = 0, np.inf
            asked[robots] = simulator.steps[robots]
            x, y, heading = simulator.poses[robots].T
            dx, dy = simulator.worlds.targets[robots].T - (x, y)
            actions, after = bug(
                BugMemory(kept.side[robots], kept.least[robots]),
                sensing,
                turned(np.arctan2(dy, dx) - heading),
                np.hypot(dx, dy),
                speed=simulator.speed,
                clearance=self.clearance,
                half_width=self.half_width,
                sight=self.sight,
            )
            kept.side[robots], kept.least[robots] = after.side, after.least
            return actions

        return select_actions
