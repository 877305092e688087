"""Small POMDPs: the tiger behind a door, a corridor with doors, a fork with a sign."""

from __future__ import annotations

import numpy as np

from robonav.validation import check_real

from ._arguments import checked
from .models import FiniteMDP
from .pomdp import POMDP

TIGER_LISTEN, TIGER_OPEN_LEFT, TIGER_OPEN_RIGHT = range(3)
CORRIDOR_LEFT, CORRIDOR_RIGHT, CORRIDOR_STAY = range(3)


def tiger(*, accuracy: float = 0.85, discount: float = 0.95) -> POMDP:
    """Two doors, with a tiger behind one of them (Kaelbling, Littman and Cassandra 1998).

    States: the tiger is left (0) or right (1). Actions: listening (0) costs 1; opening the left (1) or the right door
    (2) costs 100 if the tiger is there and brings 10 otherwise, and the tiger is then put behind a random door.
    Observations: the tiger is heard left (0) or right (1), correctly with probability ``accuracy`` after listening, at
    random after opening.

    Parameters
    ----------
    accuracy : float
        Probability of hearing correctly.
    discount : float
        gamma, in [0, 1].

    Returns
    -------
    POMDP

    Examples
    --------
    >>> from robonav.mdp import tiger
    >>> tiger().update([0.5, 0.5], action=0, observation=1)
    array([0.15, 0.85])
    """
    check_real("accuracy", accuracy, at_least=0, at_most=1)
    stay, reset = np.eye(2), np.full((2, 2), 0.5)
    rewards = [[-1.0, -100.0, 10.0], [-1.0, 10.0, -100.0]]
    heard = np.array([[accuracy, 1 - accuracy], [1 - accuracy, accuracy]])
    return POMDP(
        FiniteMDP(np.stack([stay, reset, reset]), rewards, discount),
        np.stack([heard, reset, reset]),
    )


def corridor(
    cells: str = "..D.....D.D....",
    *,
    accuracy: float = 0.9,
    slip: float = 0.1,
    ring: bool = False,
    discount: float = 0.95,
) -> POMDP:
    """A corridor of cells, some with a door; the robot knows the plan but not its place.

    Parameters
    ----------
    cells : str
        One letter a cell: ``D`` has a door, ``.`` has none.
    accuracy : float
        Probability that the sensor tells a door from a wall.
    slip : float
        Probability that a move does not happen.
    ring : bool
        Whether the corridor closes to a ring. Otherwise a move against its end leaves the robot where it is.
    discount : float
        gamma; all rewards are zero.

    Returns
    -------
    POMDP
        Actions are left (0), right (1) and stay (2); observations are wall (0) and door (1).

    Examples
    --------
    >>> from robonav.mdp import corridor
    >>> corridor("D..", accuracy=1.0, slip=0.0).update([1, 0, 0], action=1, observation=0)
    array([0., 1., 0.])
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
    """A fork with a target at one end and a trap at the other; reading a sign tells which, at a price.

    States: the target is left (0) or right (1), or the episode is over (2). Actions: waiting (0) costs nothing and
    tells nothing; reading the sign (1) costs ``sign_cost``; going left (2) or right (3) brings 10 if the target is
    there and -10 otherwise, and ends the episode. Observations: target left (0), target right (1), nothing (2).

    Parameters
    ----------
    sign_cost : float
    discount : float
        gamma, in [0, 1].

    Returns
    -------
    POMDP

    Examples
    --------
    >>> from robonav.mdp import fork
    >>> fork().update([0.5, 0.5, 0.0], action=1, observation=0)
    array([1., 0., 0.])
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


@checked
def without_sensing(mdp: FiniteMDP) -> POMDP:
    """A robot without sensing (section 2.5.1): it observes the same in every state.

    Parameters
    ----------
    mdp : FiniteMDP

    Returns
    -------
    POMDP

    Examples
    --------
    >>> from robonav.mdp import four_by_three, without_sensing
    >>> without_sensing(four_by_three().mdp(discount=0.95))
    POMDP(FiniteMDP(11 states, 4 actions, discount 0.95, sparse), 1 observations)
    """
    return POMDP(mdp, np.ones((mdp.n_actions, mdp.n_states, 1)))
