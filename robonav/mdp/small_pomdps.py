"""Small worlds that cannot be seen directly: the tiger behind a door, a corridor with doors, a way that forks."""

from __future__ import annotations

import numpy as np

from robonav.validation import check_real

from .models import FiniteMDP
from .pomdp import POMDP

TIGER_LISTEN, TIGER_OPEN_LEFT, TIGER_OPEN_RIGHT = range(3)
CORRIDOR_LEFT, CORRIDOR_RIGHT, CORRIDOR_STAY = range(3)


def tiger(*, accuracy: float = 0.85, discount: float = 0.95) -> POMDP:
    """Two doors, a tiger behind one of them (Kaelbling, Littman and Cassandra 1998).

    States: the tiger is left (0) or right (1). Actions: listen (0) costs 1; opening the left (1) or the right (2) door
    costs 100 where the tiger is and brings 10 where it is not, and puts the tiger anew behind either door.
    Observations: it is heard left (0) or right (1), correctly with probability ``accuracy`` after listening, by chance
    after opening.
    """
    check_real("accuracy", accuracy, at_least=0, at_most=1)
    stay, anew = np.eye(2), np.full((2, 2), 0.5)
    rewards = [[-1.0, -100.0, 10.0], [-1.0, 10.0, -100.0]]
    heard = np.array([[accuracy, 1 - accuracy], [1 - accuracy, accuracy]])
    return POMDP(
        FiniteMDP(np.stack([stay, anew, anew]), rewards, discount),
        np.stack([heard, anew, anew]),
    )


def corridor(
    cells: str = "..D.....D.D....",
    *,
    accuracy: float = 0.9,
    slip: float = 0.1,
    ring: bool = False,
    discount: float = 0.95,
) -> POMDP:
    """A corridor of cells, some with a door; the robot knows the plan, not its place.

    Parameters
    ----------
    cells : one letter a cell, ``D`` with a door, ``.`` without.
    accuracy : how often the sensor tells a door from a wall.
    slip : how often a move does not happen.
    ring : whether the corridor closes to a ring; else a move against its end leaves the robot where it is.
    discount : for those who add a purpose; rewards are zero.

    Returns
    -------
    POMDP with the actions left (0), right (1), stay (2), and the observations wall (0), door (1).
    """
    if not cells or set(cells) - set("D."):
        raise ValueError(f"cells must be letters D (door) and . (wall), got {cells!r}")
    check_real("accuracy", accuracy, at_least=0, at_most=1)
    check_real("slip", slip, at_least=0, at_most=1)
    place = np.arange(len(cells))
    transitions = np.zeros((3, len(cells), len(cells)))
    for action, by in ((CORRIDOR_LEFT, -1), (CORRIDOR_RIGHT, 1), (CORRIDOR_STAY, 0)):
        reached = (
            (place + by) % len(cells)
            if ring
            else np.clip(place + by, 0, len(cells) - 1)
        )
        transitions[action, place, reached] += 1 - slip
        transitions[action, place, place] += slip
    door = np.array([cell == "D" for cell in cells])
    seen = np.where(door, accuracy, 1 - accuracy)
    observations = np.stack([1 - seen, seen], axis=1)
    return POMDP(
        FiniteMDP(transitions, np.zeros((len(cells), 3)), discount),
        np.stack([observations] * 3),
    )


def fork(*, sign_cost: float = 1.0, discount: float = 0.9) -> POMDP:
    """A way that forks, with a target at one end and a trap at the other; a sign tells which, at a price.

    States: the target is left (0) or right (1), or all is over (2). Actions: wait (0) costs nothing and tells nothing;
    read the sign (1) costs ``sign_cost``; going left (2) or right (3) brings 10 where the target is and -10 where it is
    not, and ends it. Observations: target left (0), right (1), nothing (2).
    """
    check_real("sign_cost", sign_cost, at_least=0)
    stay, end = np.eye(3), np.tile([0.0, 0.0, 1.0], (3, 1))
    rewards = [
        [0.0, -sign_cost, 10.0, -10.0],
        [0.0, -sign_cost, -10.0, 10.0],
        [0.0, 0.0, 0.0, 0.0],
    ]
    nothing, clear = np.tile([0.0, 0.0, 1.0], (3, 1)), np.eye(3)
    return POMDP(
        FiniteMDP(np.stack([stay, stay, end, end]), rewards, discount),
        np.stack([nothing, clear, nothing, nothing]),
    )
