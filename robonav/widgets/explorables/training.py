"""What the kernel trains for an explorable: the settings of the reader, the live curves, and what the page then shows.

:func:`trains` registers a function for an explorable. The page builds its panel from the description
(``explorables/kernel_part.js``), so that no explorable has code of its own for it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from robonav.validation import check_integer, check_one_of, check_real

from ..kernel_training import Report


@dataclass(frozen=True)
class Dial:
    """A number that the reader sets with a slider. It is whole if ``start`` and ``step`` are.

    Examples
    --------
    >>> from robonav.widgets.explorables.training import Dial
    >>> Dial("discount γ", 0.5, 0.95, 0.05, 0.9).checked("discount", 0.8)
    0.8
    """

    label: str
    start: float
    stop: float
    step: float
    value: float
    unit: str = ""

    def checked(self, name: str, value: Any) -> float:
        """Return what the page sent, or raise an error if it is out of bounds."""
        whole = isinstance(self.start, int) and isinstance(self.step, int)
        if whole:
            number: float = check_integer(name, value, at_least=int(self.start))
            if number > self.stop:
                raise ValueError(
                    f"{name} must be at most {self.stop:g}, got {number:g}"
                )
            return number
        return check_real(name, value, at_least=self.start, at_most=self.stop)


@dataclass(frozen=True)
class Menu:
    """One of several names, which the reader chooses from a list; the first at first.

    Examples
    --------
    >>> from robonav.widgets.explorables.training import Menu
    >>> Menu("method", ("SARSA", "Q-learning")).checked("method", "SARSA")
    'SARSA'
    """

    label: str
    options: tuple[str, ...]

    def checked(self, name: str, value: Any) -> str:
        """Return what the page sent, or raise an error if it is none of the options."""
        return str(check_one_of(name, value, self.options))


@dataclass(frozen=True)
class Curve:
    """A curve that grows while Python works; ``note`` says what it shows.

    ``low`` and ``high`` are the ends of its axis; without them the values give the ends.
    """

    label: str
    note: str = ""
    low: float | None = 0.0
    high: float | None = None
    digits: int = 2


@dataclass(frozen=True, eq=False)
class Trained:
    """What a training ends with.

    Attributes
    ----------
    results : sequence of objects
        What the notebook gets, in ``trainings``.
    sentence : str
        What the page says about it.
    given : dict
        The numbers of the explorable that change, in the form of its own.
    """

    results: Sequence[Any]
    sentence: str
    given: dict[str, Any]


Compute = Callable[[dict[str, Any], Report], Trained]
"""``compute(settings, report) -> Trained``; each report has the points of the curves by name."""


@dataclass(frozen=True)
class KernelPart:
    """The training of an explorable.

    Attributes
    ----------
    title : str
        What is trained or computed.
    unit : str
        What the curves go over, such as "iteration".
    length : str or int
        How long the curves are: a number, or the name of the setting that says it.
    settings : mapping of str to Dial or Menu
        What the reader sets.
    curves : mapping of str to Curve
        The live curves, by the names under which ``compute`` reports their points.
    compute : callable
        The training.
    action : str
        What its button says.
    """

    title: str
    unit: str
    length: str | int
    settings: Mapping[str, Dial | Menu]
    curves: Mapping[str, Curve]
    compute: Compute = field(repr=False)
    action: str = "Train in Python"

    def checked(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        """Return the settings that the page sent, or raise an error if one is missing or out of bounds."""
        return {
            name: own.checked(name, settings.get(name))
            for name, own in self.settings.items()
        }

    def for_page(self) -> dict[str, Any]:
        """The description from which the page makes its panel."""
        return {
            "title": self.title,
            "unit": self.unit,
            "length": self.length,
            "action": self.action,
            "settings": {name: asdict(own) for name, own in self.settings.items()},
            "curves": [
                {"name": name, **asdict(own)} for name, own in self.curves.items()
            ],
        }


TRAININGS: dict[str, KernelPart] = {}
"""The trainings of explorables, by the explorable's name."""


def trains(
    explorable: str,
    title: str,
    *,
    unit: str,
    length: str | int,
    settings: Mapping[str, Dial | Menu],
    curves: Mapping[str, Curve],
    action: str = "Train in Python",
) -> Callable[[Compute], Compute]:
    """Register the function below as the training of an explorable; see :class:`KernelPart`."""

    def register(compute: Compute) -> Compute:
        """Keep the function and how the page asks for it."""
        TRAININGS[explorable] = KernelPart(
            title, unit, length, settings, curves, compute, action
        )
        return compute

    return register
