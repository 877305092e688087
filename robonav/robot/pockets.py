"""Worlds with pockets, made of walls, in which a robot gets lost that remembers nothing (chapter 6)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.validation import check_integer

from ._fast import RECTANGLE
from ._fast.random_numbers import DRAWING, uniform
from .worlds import MOST_WORLDS, SIZE, START, TARGET, Worlds, world_keys

THICKNESS = 2.0  # of all walls, in metres
WIDTHS = (34.0, 44.0)  # between the arms: more than twice the range of the sensors
DEPTHS = (22.0, 32.0)  # of each arm
BACKS = (76.0, 88.0)  # from the corner of the map to the wall at the back
TURN = 15.0  # degrees by which a pocket is turned at most, to either side

CORRIDOR = (8.0, 60.0)  # metres from the corner of the map at which it begins and ends
NICHES = (20.0, 24.0)  # at which the niche begins
NICHE, NICHE_DEPTH = (
    8.0,
    5.0,
)  # its length and depth, and so how thick the corridor's walls are
HALF_CORRIDOR = 3.75  # half its width
BAFFLE, BAFFLES = 2.75, (50.0, 54.0)  # how far it juts into the corridor, and where
CROSSING = 12.0  # width of the crossing at the end of the corridor
BRANCHES = (28.0, 32.0)  # length of both branches, from the middle of the corridor
SECONDS = 90  # in which a robot at 2 m/s arrives, unless it goes into the closed branch

Floats = NDArray[np.float64]


def pocket_worlds(n: int, *, seed: int) -> Worlds:
    """Draw n worlds with one pocket each, which opens to the start and has the target behind it.

    The wall at the back of a pocket crosses the straight way to the target. Two arms of different lengths lead from its
    ends towards the start. A robot in the middle of the pocket senses neither of the arms. World i depends on (seed, i)
    alone. The generator is frozen: a test compares the digest of its worlds.

    Parameters
    ----------
    n : int
        Number of worlds, 0 or more.
    seed : int
        World i has key i of :func:`world_keys`.

    Returns
    -------
    Worlds
        Three rectangles in each: the wall at the back, the left arm and the right arm.

    Raises
    ------
    ValueError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.robot import navigate, pocket_worlds, turn_to_clearer_side
    >>> float(navigate(turn_to_clearer_side, pocket_worlds(100, seed=1)).success.mean())
    0.0
    """
    keys = _keys(n, seed)
    width, left, right, back, turn = _draws(
        keys, WIDTHS, DEPTHS, DEPTHS, BACKS, (-TURN, TURN)
    )
    zero, beside = np.zeros(n), (width + THICKNESS) / 2
    walls = [  # ahead of the middle of the back, to its left, length ahead, width
        (zero, zero, zero + THICKNESS, width + 2 * THICKNESS),
        (-left / 2, beside, left, zero + THICKNESS),
        (-right / 2, -beside, right, zero + THICKNESS),
    ]
    return _with_walls(keys, walls, back, np.pi / 4 + np.radians(turn))


def crossing_worlds(n: int, *, seed: int) -> Worlds:
    """Draw n worlds with a corridor that ends at a crossing, of which one branch is a dead end.

    A niche in the left or the right wall of the corridor tells which branch is open: that on the side of the niche. At
    the crossing the niche is out of range, and what the robot senses there is the same whichever branch is open. World
    i depends on (seed, i) alone. The generator is frozen: a test compares the digest of its worlds.

    Parameters
    ----------
    n : int
        Number of worlds, 0 or more.
    seed : int
        World i has key i of :func:`world_keys`.

    Returns
    -------
    Worlds
        Ten rectangles in each. The first is the wall that closes a branch.

    Raises
    ------
    ValueError
        If an argument is out of bounds.

    Examples
    --------
    >>> from robonav.robot import crossing_worlds
    >>> from robonav.robot.pockets import open_on_the_left
    >>> open_on_the_left(crossing_worlds(4, seed=1))
    array([ True, False, False,  True])
    """
    keys = _keys(n, seed)
    niche, branch, at, coin, other = _draws(
        keys, NICHES, BRANCHES, BAFFLES, (0.0, 1.0), (0.0, 1.0)
    )
    side = np.where(coin < 0.5, 1.0, -1.0)  # of the niche, and of the open branch
    jut = np.where(other < 0.5, 1.0, -1.0)  # from which wall the baffle juts
    zero, (begin, end) = np.zeros(n), CORRIDOR
    front, back = end - THICKNESS / 2, end + CROSSING + THICKNESS / 2
    after, arm = niche + NICHE, branch - HALF_CORRIDOR
    beside = side * (HALF_CORRIDOR + NICHE_DEPTH / 2)
    behind = side * (HALF_CORRIDOR + NICHE_DEPTH + THICKNESS / 2)
    thin, thick = zero + THICKNESS, zero + NICHE_DEPTH
    length = CROSSING + 2 * THICKNESS
    walls = [  # metres ahead of the corner of the map, to the left of the diagonal, length ahead, width
        ((front + back) / 2 + zero, -side * (branch + 1), length + zero, thin),
        (back + zero, zero, thin, 2 * branch),
        (front + zero, HALF_CORRIDOR + arm / 2, thin, arm),
        (front + zero, -HALF_CORRIDOR - arm / 2, thin, arm),
        (begin + zero, zero, thin, 2 * HALF_CORRIDOR + thin),
        ((begin + end) / 2 + zero, -beside, end - begin + zero, thick),
        ((begin + niche) / 2, beside, niche - begin, thick),
        ((after + end) / 2, beside, end - after, thick),
        (niche + NICHE / 2, behind, NICHE + 2 * thin, thin),
        (at, jut * (HALF_CORRIDOR - BAFFLE / 2), thin, BAFFLE + zero),
    ]
    return _with_walls(keys, walls, zero, zero + np.pi / 4)


def open_on_the_left(worlds: Worlds) -> NDArray[np.bool_]:
    """Return in which worlds (N,) of :func:`crossing_worlds` the branch on the left is open.

    Examples
    --------
    >>> from robonav.robot import crossing_worlds
    >>> from robonav.robot.pockets import open_on_the_left
    >>> open_on_the_left(crossing_worlds(4, seed=1))
    array([ True, False, False,  True])
    """
    closing = worlds.centres[:, 0]
    return closing[:, 0] > closing[:, 1]  # the wall that closes lies right of the way


def _keys(n: int, seed: int) -> NDArray[np.uint32]:
    return world_keys(
        check_integer("n", n, at_least=0, at_most=MOST_WORLDS),
        check_integer("seed", seed, at_least=0),
    )


def _draws(keys: NDArray[np.uint32], *bounds: tuple[float, float]) -> list[Floats]:
    """Draw one number between each pair of bounds for each of N keys."""
    return [
        np.array([low + (high - low) * uniform(key, DRAWING, 0, item, 0) for key in keys])
        for item, (low, high) in enumerate(bounds)
    ]  # fmt: skip


def _with_walls(
    keys: NDArray[np.uint32],
    walls: list[tuple[Floats, Floats, Floats, Floats]],
    origin: Floats,
    heading: Floats,
) -> Worlds:
    """Return worlds with the usual start and target, and walls that are described by N numbers each.

    Parameters
    ----------
    keys : (N, 2) array
        Of the worlds.
    walls : list of M tuples
        Of each wall: metres ahead of the origin and to its left, length ahead and width.
    origin : (N,) array
        Where the origin lies on the diagonal, in metres from the corner of the map.
    heading : (N,) array
        What direction is ahead, in radians.
    """
    ahead, left, length, width = np.array(walls).transpose(1, 2, 0)  # each (N, M)
    cosine, sine = np.cos(heading)[:, None], np.sin(heading)[:, None]
    corner = origin[:, None] / np.sqrt(2)
    x, y = corner + cosine * ahead - sine * left, corner + sine * ahead + cosine * left
    turned = np.broadcast_to(heading[:, None], x.shape)
    n, still = len(keys), np.zeros(x.shape)
    return Worlds(
        kinds=np.full(x.shape, RECTANGLE, dtype=np.int8),
        shapes=np.stack([length / 2, width / 2, turned], axis=-1),
        centres=np.stack([x, y], axis=-1),
        speeds=still,
        headings=still,
        starts=np.tile(START, (n, 1)),
        targets=np.tile(TARGET, (n, 1)),
        keys=keys,
        size=SIZE,
    )
