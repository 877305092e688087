"""The table of expectations: one function for each explorable, of the explorable's name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .shown import Shown

if TYPE_CHECKING:
    from .reader import Move

Check = Callable[[Shown], None]


@dataclass(frozen=True)
class Expected:
    """What an explorable has to show, and how a reader uses it beyond touching each control once.

    Attributes
    ----------
    check : callable
        Fails unless what is shown is what Python computes for the settings shown.
    by_keyboard, by_touch : sequences of Move
        What the reader does in a row, after everything was reset.
    """

    check: Check
    by_keyboard: Sequence[Move]
    by_touch: Sequence[Move]


EXPECTED: dict[str, Expected] = {}
"""By the name of the explorable."""


def expects(
    *moves: Move, by_keyboard: Sequence[Move] = (), by_touch: Sequence[Move] = ()
) -> Callable[[Check], Check]:
    """Put the function below into the table. ``moves`` are made with both hands, before those of either alone."""

    def register(check: Check) -> Check:
        EXPECTED[check.__name__] = Expected(
            check, (*moves, *by_keyboard), (*moves, *by_touch)
        )
        return check

    return register
