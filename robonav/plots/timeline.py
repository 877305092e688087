"""A timeline: what came when, from the top down, with one colour a subject."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes

from robonav import style


@dataclass(frozen=True)
class Event:
    """A year, what happened in it, and the subject that it belongs to."""

    year: int
    text: str
    subject: str


SUBJECTS: dict[str, str] = {
    "decision processes": style.BLUE,
    "reinforcement learning": style.GREEN,
    "demonstrations and rewards": style.ORANGE,
    "networks": style.PURPLE,
    "robots and planning": style.VERMILION,
}

HISTORY: tuple[Event, ...] = (
    Event(1957, "dynamic programming (Bellman)", "decision processes"),
    Event(1960, "policy iteration (Howard)", "decision processes"),
    Event(1968, "A* (Hart, Nilsson, Raphael)", "robots and planning"),
    Event(1973, "planning with beliefs (Smallwood, Sondik)", "decision processes"),
    Event(1986, "backpropagation (Rumelhart, Hinton, Williams)", "networks"),
    Event(1988, "temporal differences (Sutton)", "reinforcement learning"),
    Event(1989, "Q-learning (Watkins)", "reinforcement learning"),
    Event(
        1989, "a network drives a car (Pomerleau)", "demonstrations and rewards"
    ),
    Event(1994, "SARSA (Rummery, Niranjan)", "reinforcement learning"),
    Event(2000, "inverse reinforcement learning (Ng, Russell)", "demonstrations and rewards"),
    Event(2004, "apprenticeship learning (Abbeel, Ng)", "demonstrations and rewards"),
    Event(2004, "DARPA: 15 vehicles start, none finishes", "robots and planning"),
    Event(2005, "DARPA: Stanley wins in the desert", "robots and planning"),
    Event(2005, "neural fitted Q iteration (Riedmiller)", "reinforcement learning"),
    Event(2007, "DARPA: Boss wins in the city", "robots and planning"),
    Event(2008, "maximum entropy IRL (Ziebart)", "demonstrations and rewards"),
    Event(2011, "relative entropy IRL (Boularias); DAgger (Ross)", "demonstrations and rewards"),
    Event(2012, "SCIRL (Klein)", "demonstrations and rewards"),
    Event(2015, "deep Q-network (Mnih)", "networks"),
    Event(2015, "this book's thesis (Xia)", "robots and planning"),
)  # fmt: skip


def draw_timeline(axes: Axes, events: Sequence[Event] = HISTORY) -> None:
    """Draw events in order of time from the top down: the year, a mark in the colour of the subject, and the text.

    Parameters
    ----------
    axes : Axes
        The axes to draw on. Their frame and ticks are removed.
    events : sequence of Event
        The events, the earliest first. Their subjects are keys of ``SUBJECTS``.

    Raises
    ------
    ValueError
        If the events are not in the order of their years.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> draw_timeline(axes)
    >>> len(axes.texts) > 10
    True
    """
    years = [event.year for event in events]
    if years != sorted(years):
        raise ValueError(f"events must be in the order of their years, got {years}")
    axes.plot([0, 0], [0, len(events) - 1], color=style.INK, linewidth=1, zorder=0)
    for row, event in enumerate(events):
        axes.plot(0, row, "o", color=SUBJECTS[event.subject], markersize=7)
        if row == 0 or years[row - 1] != event.year:
            axes.text(-0.25, row, f"{event.year}", ha="right", va="center")
        axes.text(0.25, row, event.text, va="center")
    for name in dict.fromkeys(event.subject for event in events):
        axes.plot([], [], "o", color=SUBJECTS[name], label=name)
    axes.set(xlim=(-1.2, 7), ylim=(len(events) - 0.5, -0.5))
    axes.axis("off")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2)
