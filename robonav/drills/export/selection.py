"""Which drills are exported, and the questions that they draw."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from robonav.validation import check_integer

from ..question import Choice, Order, Place, Question, Table
from ..registry import DRILLS, Drill

TRIES = (
    20  # how often another question is drawn in the place of one that was drawn before
)
VARIED = 8  # a drill of an exam of many papers has as many different questions


@dataclass(frozen=True)
class Drawn:
    """A question that a drill has drawn.

    Attributes
    ----------
    drill : Drill
        The drill.
    number : int
        The question's number among those of its drill, from 1 on.
    question : Question
        The question.

    Examples
    --------
    >>> from robonav.drills import DRILLS
    >>> from robonav.drills.export import Drawn
    >>> td_error = DRILLS["td-error"]
    >>> Drawn(td_error, 1, td_error.question(seed=1)).name
    'td-error-1'
    """

    drill: Drill
    number: int
    question: Question

    @property
    def name(self) -> str:
        """A name of letters, digits and hyphens, such as "td-error-1"."""
        return f"{self.drill.name}-{self.number}"


def chapter_of(drill: Drill) -> int:
    """Return the number of the chapter that a drill belongs to.

    Parameters
    ----------
    drill : Drill

    Returns
    -------
    int

    Examples
    --------
    >>> chapter_of(DRILLS["td-error"])
    2
    """
    package = drill.draw.__module__.split(".")[2]
    return int(package.removeprefix("chapter"))


def _unknown(kind: str, names: Sequence[object], known: Sequence[object]) -> None:
    for name in names:
        if name not in known:
            near = get_close_matches(str(name), map(str, known), n=3) or known[:9]
            more = ", ..." if len(near) < len(known) else ""
            raise ValueError(
                f"there is no {kind} {name}; there are {', '.join(map(str, near))}{more}"
            )


def selected(
    chapters: Sequence[int] = (), pages: Sequence[str] = (), drills: Sequence[str] = ()
) -> list[Drill]:
    """Return the drills of chapters and pages, and those named, in the order of the book.

    Parameters
    ----------
    chapters : sequence of int, optional
        Numbers of chapters.
    pages : sequence of str, optional
        Names of pages, such as "dynamic-programming".
    drills : sequence of str, optional
        Names of drills, such as "td-error".

    Returns
    -------
    list of Drill
        All drills if nothing is named.

    Raises
    ------
    ValueError
        If a chapter, page or drill does not exist.

    Examples
    --------
    >>> [drill.name for drill in selected(drills=["td-error", "softmax"])]
    ['td-error', 'softmax']
    >>> len(selected()) == len(DRILLS)
    True
    """
    every = list(DRILLS.values())
    _unknown("chapter", chapters, sorted({chapter_of(one) for one in every}))
    _unknown("page", pages, list(dict.fromkeys(one.page for one in every)))
    _unknown("drill", drills, list(DRILLS))
    if not (chapters or pages or drills):
        return every
    return [
        one
        for one in every
        if chapter_of(one) in chapters or one.page in pages or one.name in drills
    ]


def spread(drills: Sequence[Drill], count: int) -> list[Drill]:
    """Return at most so many drills, spread evenly over those given.

    Parameters
    ----------
    drills : sequence of Drill
    count : int

    Returns
    -------
    list of Drill

    Examples
    --------
    >>> [drill.name for drill in spread(selected(drills=["td-error", "softmax", "boltzmann"]), 2)]
    ['td-error', 'boltzmann']
    """
    check_integer("the number of drills", count, at_least=1)
    places = np.linspace(0, len(drills) - 1, min(count, len(drills)))
    return [drills[place] for place in places.round().astype(int)]


def seen(question: Question) -> tuple[object, ...]:
    """Return what a student sees of a question. Two questions are equal if this is.

    The order in which options or steps stand makes no other question, and neither does what is said afterwards.

    Parameters
    ----------
    question : Question

    Returns
    -------
    tuple
        Text, picture, and what there is to choose from, to put in order or to fill in.

    Examples
    --------
    >>> from robonav.drills import Choice
    >>> one, other = (Question("Which?", Choice("a", {"b": hint}), hint) for hint in ("No.", "Not this."))
    >>> seen(one) == seen(other)
    True
    """
    asked = question.asked
    shown: tuple[object, ...] = ()
    if isinstance(asked, Choice):
        shown = tuple(sorted(asked.options))
    elif isinstance(asked, Order):
        shown = tuple(sorted(asked.steps))
    elif isinstance(asked, Table):
        shown = (*asked.rows, *asked.columns)
    elif isinstance(asked, Place):
        shown = tuple(sorted(asked.places))
    return question.text, question.picture, *shown


def varied(drills: Sequence[Drill], papers: int, each: int = 1) -> list[Drill]:
    """Return the drills that have enough different questions for an exam.

    In one paper no two questions are equal, and many papers should not ask the same of everybody. A drill must
    therefore have as many different questions as there are papers, up to 8, times those on a paper.

    Parameters
    ----------
    drills : sequence of Drill
    papers : int
        How many papers there are.
    each : int, default 1
        Questions of each drill on a paper.

    Returns
    -------
    list of Drill

    Examples
    --------
    >>> [drill.name for drill in varied(selected(drills=["td-error", "epsilon-greedy"]), papers=30, each=2)]
    ['epsilon-greedy', 'td-error']
    """
    check_integer("papers", papers, at_least=1)
    needed = each * min(papers, VARIED)
    return [one for one in drills if len(_different(one, 0, needed)) == needed]


def drawn(drills: Sequence[Drill], seed: int = 0, each: int = 1) -> list[Drawn]:
    """Draw questions of drills, all of them different.

    A drill's questions depend on its name and on the seed alone, so they stay the same if other drills are added.

    Parameters
    ----------
    drills : sequence of Drill
    seed : int, default 0
        Seed of the questions.
    each : int, default 1
        Questions of each drill. A drill that has fewer gives all that it has.

    Returns
    -------
    list of Drawn

    Examples
    --------
    >>> [one.name for one in drawn(selected(drills=["td-error"]), seed=3, each=2)]
    ['td-error-1', 'td-error-2']
    """
    check_integer("seed", seed, at_least=0)
    check_integer("each", each, at_least=1)
    return [
        Drawn(drill, number, question)
        for drill in drills
        for number, question in enumerate(_different(drill, seed, each), start=1)
    ]


def _different(drill: Drill, seed: int, count: int) -> list[Question]:
    """The first questions of a drill that differ from each other."""
    questions: dict[tuple[object, ...], Question] = {}
    name = zlib.crc32(drill.name.encode())
    for k in range(count + TRIES):
        if len(questions) == count:
            break
        state = np.random.SeedSequence([seed, name, k]).generate_state(1)
        question = drill.question(int(state[0]))
        questions.setdefault(seen(question), question)
    return list(questions.values())
