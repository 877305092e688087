"""How the episodes of an open task ended, and what that suggests to look at."""

from __future__ import annotations

from numpy.typing import NDArray

from .session import Answer


def require_arrivals(
    answer: Answer, outcomes: NDArray, least: int, *, collided: str, late: str
) -> None:
    """Require that many robots arrive. Otherwise the feedback says how the others ended, and gives the hint for that.

    Parameters
    ----------
    answer : Answer
        The student's function, which was asked in these episodes.
    outcomes : (N,) array
        How each episode ended, in the words of :func:`robonav.robot.navigate`.
    least : int
        How many must arrive.
    collided, late : str
        What to look at where most of the others collide, and where most of them are out of time. Where both are
        frequent, both are said.
    """
    arrived, collisions, others = (
        int((outcomes == outcome).sum())
        for outcome in ("arrived", "collided", "out of steps")
    )
    answer.check(
        arrived >= least,
        f"expected {least} arrivals in {len(outcomes)} worlds, got {arrived}; "
        f"collisions: {collisions}, out of time: {others}",
        suggestion(collisions, others, collided, late),
    )


def suggestion(collisions: int, others: int, collided: str, late: str) -> str:
    """Return the hint for the more frequent end, or both where neither is twice as frequent as the other.

    A hint that is the same for both ends is said once.

    Examples
    --------
    >>> suggestion(90, 10, "Look ahead.", "Turn to the target.")
    'Most robots that fail collide. Look ahead.'
    >>> suggestion(50, 40, "Look ahead.", "Turn to the target.")
    'Some robots collide. Look ahead. Others drive on until the time is over. Turn to the target.'
    >>> suggestion(50, 40, "Use the memory.", "Use the memory.")
    'Use the memory.'
    """
    if collided == late:
        return collided
    if collisions >= 2 * others:
        return f"Most robots that fail collide. {collided}"
    if others >= 2 * collisions:
        return f"Most robots that fail drive on until the time is over. {late}"
    return f"Some robots collide. {collided} Others drive on until the time is over. {late}"
