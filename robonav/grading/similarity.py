"""Which submissions of a class are too alike, over all exercises together.

A short function tells nothing: two honest answers to a small exercise may be equal to the letter. Ten exercises are
enough, because honest students do not write alike in all of them. For each exercise all pairs of the class are
compared. What many answers share, because the stub or the exercise forces it, weighs little; what few share weighs
much. An answer that is written as many write is like many others, so that a pair's likeness is measured against how
alike each of the two answers is to the others. The pair's rank among all pairs says how likely so much of it is by
chance, and Fisher's method combines these probabilities over the exercises that both answered.

A small class alone cannot tell what is common. Honest answers that come with the course are therefore compared as if
further students had handed them in.

A group of three or more who copied from one another would make its own likeness common. Such a ring therefore counts as
one student: in how many of the class have something, and in the pairs that a pair is ranked among.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .fingerprints import MOST_TIMES, Feature, Fingerprint

VIEWS = ("structure", "flow")
SPREAD = 0.02  # of likeness, that any answer is expected to have
THRESHOLD = 2.0  # of a pair's score, from which it is reported
NEAR = 1.3  # from which it is worth a look: one in twenty
CLEAR = 0.02  # chance at most of a pair's likeness in an exercise that stands out
REST = 1.3  # of a patchwork's score, without its strongest source
FEWEST = 3  # exercises that both answered, below which a pair is not reported
NEARLY_EQUAL = 0.8  # from which structure or flow of two answers are nearly equal
MOST_BY_CHANCE = 4  # exercises in which two honest students may be nearly equal
SMALLEST_RING = 3  # students


@dataclass(frozen=True)
class Likeness:
    """How alike two answers to an exercise are.

    Attributes
    ----------
    structure, flow : float
        The share of what they have in common, from 0 to 1, weighted by how rare it is.
    chance : float
        The share of all pairs that stand out as much. A ring counts as one student.
    """

    structure: float
    flow: float
    chance: float

    @property
    def nearly_equal(self) -> bool:
        """Whether the answers differ in little that counts."""
        return max(self.structure, self.flow) >= NEARLY_EQUAL


@dataclass(frozen=True)
class Patchwork:
    """A student whose answers are like those of several others, each like the answer of another one.

    Attributes
    ----------
    student : str
        The name.
    score : float
        How unlikely it is by chance that in each exercise somebody's answer is so much alike, as for a pair.
    sources : dict of str to tuple of str
        The exercises in which a pair stands out, by the name of the student whose answer is most alike.
    """

    student: str
    score: float
    sources: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Pair:
    """Two submissions.

    Attributes
    ----------
    first, second : str
        Their names.
    score : float
        How unlikely so much likeness is by chance, over all exercises: 2 is one in a hundred.
    exercises : dict of str to Likeness
        The exercises that both answered.
    """

    first: str
    second: str
    score: float
    exercises: Mapping[str, Likeness]

    @property
    def reported(self) -> bool:
        """Whether the pair is to be looked at."""
        return self.score >= THRESHOLD and len(self.exercises) >= FEWEST

    @property
    def near(self) -> bool:
        """Whether the pair is not reported, but nearly."""
        return NEAR <= self.score < THRESHOLD and len(self.exercises) >= FEWEST


def pairs(
    answers: Mapping[str, Mapping[str, Fingerprint]],
    known: Mapping[str, Sequence[Fingerprint]] | None = None,
) -> list[Pair]:
    """Compare all pairs of a class.

    Parameters
    ----------
    answers : dict of str to dict
        The fingerprints of each student's answers by exercise.
    known : dict of str to sequence of Fingerprint, optional
        Other answers by exercise, such as the stub, solutions, and answers of honest students elsewhere. They are
        compared as answers of the class are: what they have weighs less, and their pairs are ranked too.

    Returns
    -------
    list of Pair
        All pairs with an exercise in common, those that stand out most first.

    Examples
    --------
    >>> import ast
    >>> from robonav.grading.fingerprints import fingerprint
    >>> one = fingerprint(ast.parse("def f(a): return a + 5"), "f")
    >>> [pair.first for pair in pairs({"ada": {"2.1": one}, "bo": {"2.1": one}})]
    ['ada']
    """
    found = _compared(answers, known or {}, {})
    rings = _rings(found)
    if rings:
        found = _compared(answers, known or {}, rings)
    scored = [
        Pair(
            first,
            second,
            _combined([one.chance for one in likenesses.values()]),
            likenesses,
        )
        for (first, second), likenesses in found.items()
    ]
    return sorted(scored, key=lambda pair: (-pair.score, pair.first, pair.second))


def patchworks(pairs: Sequence[Pair]) -> list[Patchwork]:
    """Return the students whose answers are like those of several others.

    For each of a student's answers, the one in the class is found that is most alike. That the most alike of many
    stands out is likelier than that a certain one does, which is taken into account. The chances of all exercises are
    combined as those of a pair. One source alone makes a pair and no patchwork, so what is left without the strongest
    source must stand out too.

    Parameters
    ----------
    pairs : sequence of Pair
        All pairs of a class, from :func:`pairs`.

    Returns
    -------
    list of Patchwork
        Those that stand out, the most outstanding first.

    Examples
    --------
    >>> patchworks([Pair("ada", "bo", 3.0, {"2.1": Likeness(1, 1, 0.001)})])
    []
    """
    likenesses: dict[str, dict[str, list[tuple[float, str]]]] = {}
    for pair in pairs:
        for name, other in ((pair.first, pair.second), (pair.second, pair.first)):
            for id, likeness in pair.exercises.items():
                found = likenesses.setdefault(name, {}).setdefault(id, [])
                found.append((likeness.chance, other))
    every = [_patchwork(name, found) for name, found in likenesses.items()]
    return sorted(
        (one for one in every if one is not None),
        key=lambda one: (-one.score, one.student),
    )


def _patchwork(
    name: str, found: Mapping[str, Sequence[tuple[float, str]]]
) -> Patchwork | None:
    """Return the patchwork of a student, or nothing if the answers do not stand out or have a single source."""
    nearest = {id: min(others) for id, others in found.items()}
    # the chance that the most alike of so many answers stands out so much
    chances = {
        id: 1 - (1 - chance) ** len(found[id]) for id, (chance, _) in nearest.items()
    }
    score = _combined(list(chances.values()))
    sources: dict[str, list[str]] = {}
    for id, (chance, other) in nearest.items():
        if chance <= CLEAR:
            sources.setdefault(other, []).append(id)
    if score < THRESHOLD or len(found) < FEWEST or len(sources) < 2:
        return None
    strongest = min(sources, key=lambda other: math.prod(chances[id] for id in sources[other]))  # fmt: skip
    rest = [chances[id] for id in found if id not in sources[strongest]]
    if _combined(rest) < REST:
        return None
    ordered = sorted(sources.items(), key=lambda item: (-len(item[1]), item[0]))
    return Patchwork(name, score, {other: tuple(ids) for other, ids in ordered})


def _compared(
    answers: Mapping[str, Mapping[str, Fingerprint]],
    known: Mapping[str, Sequence[Fingerprint]],
    rings: Mapping[str, str],
) -> dict[tuple[str, str], dict[str, Likeness]]:
    """Return how alike each two students are in each exercise."""
    found: dict[tuple[str, str], dict[str, Likeness]] = {}
    for id in sorted({id for own in answers.values() for id in own}):
        own = {name: prints[id] for name, prints in answers.items() if id in prints}
        for names, likeness in _likenesses(own, known.get(id, ()), rings):
            found.setdefault(names, {})[id] = likeness
    return found


def _rings(
    found: Mapping[tuple[str, str], Mapping[str, Likeness]],
) -> dict[str, str]:
    """Return a name of the ring of each student who is in one: students who are linked with one another."""
    rings: dict[str, set[str]] = {}
    for (first, second), likenesses in found.items():
        if _linked(likenesses):
            both = rings.get(first, {first}) | rings.get(second, {second})
            rings.update(dict.fromkeys(both, both))
    return {
        name: min(ring) for name, ring in rings.items() if len(ring) >= SMALLEST_RING
    }


def _linked(likenesses: Mapping[str, Likeness]) -> bool:
    """Whether two belong together.

    Their answers are nearly equal in more exercises than chance explains, and in at least half of those that both
    answered.
    """
    equal = sum(one.nearly_equal for one in likenesses.values())
    return equal > MOST_BY_CHANCE and 2 * equal >= len(likenesses)


def _combined(chances: Sequence[float]) -> float:
    """Return minus the logarithm of the chance of so small chances in all exercises together."""
    evidence = -math.fsum(math.log(chance) for chance in chances)
    return -math.log10(_fisher(evidence, len(chances)))


def _fisher(evidence: float, number: int) -> float:
    """Return the chance that minus the logarithms of that many chances add up to so much."""
    if evidence <= 0:
        return 1.0
    terms = (k * math.log(evidence) - math.lgamma(k + 1) for k in range(number))
    return min(1.0, math.fsum(math.exp(term - evidence) for term in terms))


def _likenesses(
    own: Mapping[str, Fingerprint],
    known: Sequence[Fingerprint],
    rings: Mapping[str, str],
) -> Iterator[tuple[tuple[str, str], Likeness]]:
    """Yield how alike each two answers to one exercise are."""
    names = list(own)
    everything = [*own.values(), *known]
    first, second = np.triu_indices(len(everything), 1)
    leaders = [rings.get(name, name) for name in names]
    groups = [leaders.index(leader) for leader in leaders]  # by their first members
    groups += range(len(names), len(everything))
    leads = np.equal(groups, np.arange(len(everything)))
    # A pair is ranked among the pairs of different groups, and itself.
    ranked = leads[first] & leads[second]
    number = ranked.sum() + ~ranked
    tables = [
        _shared([getattr(one, view) for one in everything], groups) for view in VIEWS
    ]
    # Of the two views, the one counts in which a pair stands out more.
    outstanding = np.max(
        [_outstanding(table, groups, leads) for table in tables], axis=0
    )[first, second]
    below = np.searchsorted(np.sort(outstanding[ranked]), outstanding - 1e-9)
    chances = (1 - below / number).tolist()
    alike = [table[first, second].tolist() for table in tables]
    for k, (a, b) in enumerate(zip(first.tolist(), second.tolist(), strict=True)):
        if b < len(names):
            yield (names[a], names[b]), Likeness(alike[0][k], alike[1][k], chances[k])


def _outstanding(
    table: np.ndarray, groups: Sequence[int], leads: np.ndarray
) -> np.ndarray:
    """Return, for each two, how much more alike they are than each of them is to the others.

    It is the mean of two numbers of standard deviations. The others are the first members of the other groups.
    """
    others = leads & np.not_equal.outer(groups, groups)
    number = np.maximum(others.sum(axis=1, keepdims=True), 1)
    above = table - (table * others).sum(axis=1, keepdims=True) / number
    spread = np.sqrt((above**2 * others).sum(axis=1, keepdims=True) / number)
    apart = above / (spread + SPREAD)
    return (apart + apart.T) / 2


def _shared(counts: Sequence[Counter[Feature]], groups: Sequence[int]) -> np.ndarray:
    """Return, for each two, the share of what they have in common, in which features of few groups weigh more."""
    columns: dict[Feature, int] = {}
    for one in counts:
        for feature in one:
            columns.setdefault(feature, len(columns))
    table = np.zeros((len(counts), max(len(columns), 1)))
    for row, one in enumerate(counts):
        for feature, number in one.items():
            table[row, columns[feature]] = number
    apart = sorted(set(groups))
    holders = sum((table[np.equal(groups, one)] > 0).any(axis=0) for one in apart)
    rare = np.log((len(apart) + 1) / np.maximum(holders, 1))
    common = sum(
        ((table >= times) * rare) @ (table >= times).T
        for times in range(1, MOST_TIMES + 1)
    )
    whole = np.diag(common)
    either = whole[:, None] + whole[None, :] - common
    return np.divide(common, either, out=np.zeros_like(either), where=either > 0)
