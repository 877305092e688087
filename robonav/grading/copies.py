"""Compare the submissions of a class, and show the pairs that are too alike side by side.

Students' code is read and never run. It is read in a process of its own, because a hostile file could crash the program
that reads it; the submission of such a file is named, and the others are compared.
"""

from __future__ import annotations

import ast
import json
import multiprocessing
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from robonav.atomic import write_text

from . import answers, notebook
from .classroom import students
from .course import Course
from .fingerprints import Feature, Fingerprint, fingerprint
from .report import csv_text, page
from .similarity import FEWEST, THRESHOLD, Pair, Patchwork, pairs, patchworks
from .submission import Refused

SECONDS = 20.0  # to read one submission
MEMORY = 2 << 30
MOST_SHOWN = 200  # pairs on the page
MOST_NEAR = 20  # pairs just below the threshold
NOT_REPORTED = "worth a look, not reported"
CSV_COLUMNS = ["list", "first", "second", "score", "exercises", "most_alike"]
HONEST = "honest"  # the folder of honest answers, in that of the solutions


@dataclass(frozen=True, eq=False)
class Answer:
    """A student's answer to an exercise.

    Attributes
    ----------
    source : str
        The function, and what it uses.
    print : Fingerprint
        What it is compared by.
    """

    source: str
    print: Fingerprint


@dataclass(frozen=True, eq=False)
class Comparison:
    """A class that was compared.

    Attributes
    ----------
    answers : dict of str to dict
        The answers of each student by exercise.
    pairs : list of Pair
        The pairs that are too alike, those that are most first.
    near : list of Pair
        The nearest pairs below the threshold, which are not reported.
    patchworks : list of Patchwork
        The students whose answers are like those of several others.
    compared : int
        Number of pairs that were compared.
    few : int
        How many of them have too few exercises in common to tell anything.
    problems : list of str
        What could not be compared.
    """

    answers: Mapping[str, Mapping[str, Answer]]
    pairs: list[Pair]
    near: list[Pair]
    patchworks: list[Patchwork]
    compared: int
    few: int
    problems: list[str]

    @property
    def by_chance(self) -> float:
        """How many pairs of honest students one would expect in the list."""
        return (self.compared - self.few) / 10**THRESHOLD


def compare_class(course: Course, folder: Path) -> Comparison:
    """Compare all submissions in a folder.

    Parameters
    ----------
    course : Course
        The course, whose stubs and solutions are what everybody may share.
    folder : Path
        The class, as for ``robonav grade``.

    Returns
    -------
    Comparison
        The pairs that are too alike.

    Raises
    ------
    ValueError
        If there is no submission.

    Examples
    --------
    >>> compare_class(Course.around(Path()), Path("nowhere"))
    Traceback (most recent call last):
    ValueError: the class must be a folder of submissions, got nowhere
    """
    wanted = [[e.id, e.chapter, e.name] for e in course.exercises.values()]
    found, problems, reader = dict[str, dict[str, Answer]](), list[str](), _Reader()
    try:
        for name, handin in students(folder).items():
            loaded = handin.load()
            if isinstance(loaded, Refused):
                problems.append(f"{name}: {loaded}")
                continue
            told = reader.read(loaded.files, wanted)
            if isinstance(told, str):
                problems.append(f"{name}: {told}")
                continue
            found[name] = {id: _answer(one) for id, one in told.items()}
    finally:
        reader.close()
    prints = {n: {id: one.print for id, one in own.items()} for n, own in found.items()}
    answered = {id for own in prints.values() for id in own}
    every = pairs(prints, {id: _known(course, id) for id in answered})
    return Comparison(
        found,
        pairs=[pair for pair in every if pair.reported],
        near=[pair for pair in every if pair.near][:MOST_NEAR],
        patchworks=patchworks(every),
        compared=len(every),
        few=sum(len(pair.exercises) < FEWEST for pair in every),
        problems=problems,
    )


def _known(course: Course, id: str) -> list[Fingerprint]:
    """Return what everybody may share: the stub, the solutions and the honest answers to an exercise."""
    exercise, known = course.exercises[id], list[Fingerprint]()
    for place in (course.stubs, course.solutions, course.solutions / "otherwise"):
        if (path := place / exercise.file).is_file():
            known.append(fingerprint(ast.parse(path.read_bytes()), exercise.name))
    book = _book(course)
    return [*known, *honest_answers(book, id)] if id in book.exercises else known


def _book(course: Course) -> Course:
    """Return the course itself, or the book's if the course is a variant, which has no honest answers."""
    if course.solutions.joinpath(HONEST).is_dir():
        return course
    return Course.of_checkout()


def honest_answers(course: Course, id: str) -> list[Fingerprint]:
    """Return the fingerprints of the honest answers to an exercise that come with the course.

    They were written for the book's exercise. A variant changes few of their statements.

    Examples
    --------
    >>> len(honest_answers(Course.around(), "2.4"))
    30
    """
    return list(_honest(course.solutions / HONEST / course.exercises[id].file))


@cache
def _honest(path: Path) -> tuple[Fingerprint, ...]:
    """Return the fingerprints of the functions in a file of honest answers, each apart."""
    if not path.is_file():
        return ()
    tree = ast.parse(path.read_bytes())
    imports = [n for n in tree.body if isinstance(n, ast.Import | ast.ImportFrom)]
    return tuple(
        fingerprint(ast.Module([*imports, node], []), node.name)
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
    )


class _Reader:
    """A process that reads submissions. It is started again when one has crashed it."""

    def __init__(self) -> None:
        self._process: Any = None
        self._pipe: Connection | None = None

    def read(self, files: Mapping[str, bytes], wanted: Sequence[Sequence[str]]) -> Any:
        """Return the answers in these files, or what is wrong with them."""
        if self._process is None:
            context = multiprocessing.get_context("spawn")
            self._pipe, other = context.Pipe()
            self._process = context.Process(target=_serve, args=(other,), daemon=True)
            self._process.start()
            other.close()
        assert self._pipe is not None
        request = {"files": {n: c.decode("latin-1") for n, c in files.items()}, "wanted": wanted}  # fmt: skip
        try:
            self._pipe.send_bytes(json.dumps(request).encode())
            if not self._pipe.poll(SECONDS):
                raise EOFError
            return json.loads(self._pipe.recv_bytes())
        except (EOFError, OSError):
            self.close()
            return "it could not be read within the limits"

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
        self._process = None


def _serve(pipe: Connection) -> None:
    """Answer requests until the other end closes."""
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    while True:
        try:
            request = json.loads(pipe.recv_bytes())
        except EOFError:
            return
        files = {n: c.encode("latin-1") for n, c in request["files"].items()}
        pipe.send_bytes(json.dumps(read_answers(files, request["wanted"])).encode())


def read_answers(
    files: Mapping[str, bytes], wanted: Sequence[Sequence[str]]
) -> dict[str, Any]:
    """Return each answer in a submission: its text, and its fingerprint as JSON can hold it.

    Examples
    --------
    >>> read_answers({"a.py": b"def f(x): return x"}, [["2.1", "ch2", "f"]])["2.1"]["source"]
    'def f(x): return x'
    """
    found = {}
    with tempfile.TemporaryDirectory() as name:
        for path, content in files.items():
            target = Path(name, path)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        for id, chapter, function in wanted:
            try:
                where = answers.find(Path(name), chapter, function).path
                if where and (text := _text(Path(name, where), function)):
                    one = fingerprint(ast.parse(text), function)
                    found[id] = {
                        "source": text,
                        "structure": [[*item] for item in one.structure.items()],
                        "flow": [[*item] for item in one.flow.items()],
                        "lines": [[n, sorted(x)] for n, x in one.lines.items()],
                    }
            except (SyntaxError, ValueError, RecursionError, MemoryError, OSError):
                continue
    return found


def _text(path: Path, name: str) -> str:
    """Return the function and what it uses, as it was written, without imports."""
    content = path.read_bytes()
    cells = (
        notebook.sources(content)
        if path.suffix == ".ipynb"
        else [content.decode("utf-8-sig", "replace")]
    )
    needed = {ast.dump(node) for node in notebook.definitions(cells, name).body}
    pieces = list[str]()
    for cell in cells:
        lines = cell.splitlines()
        for node in notebook.parsed(cell):
            if isinstance(node, ast.Import | ast.ImportFrom):
                continue
            if ast.dump(notebook.without_stub_line(node)) in needed:
                pieces.append("\n".join(lines[node.lineno - 1 : node.end_lineno]))
    text = "\n\n".join(pieces)
    try:
        ast.parse(text)
    except SyntaxError:  # IPython's own syntax
        return ast.unparse(notebook.definitions(cells, name))
    return text


def _answer(told: Mapping[str, Any]) -> Answer:
    counts = [
        Counter({tuple(feature): number for feature, number in told[view]})
        for view in ("structure", "flow")
    ]
    lines = {n: {tuple(feature) for feature in found} for n, found in told["lines"]}
    return Answer(told["source"], Fingerprint(counts[0], counts[1], lines))


def write_comparison(comparison: Comparison, course: Course, path: Path) -> None:
    """Write the page with the pairs side by side, and beside it a CSV file with their scores.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "similarity.html"
    >>> write_comparison(Comparison({}, [], [], [], 0, 0, []), Course.around(), path)
    >>> sorted(file.name for file in path.parent.iterdir())
    ['similarity.csv', 'similarity.html']
    """
    write_text(path.with_suffix(".csv"), csv_text(_rows(comparison)))
    text = page(
        "similarity.html",
        comparison=comparison,
        shown=_side_by_side(comparison, comparison.pairs[:MOST_SHOWN]),
        near=_side_by_side(comparison, comparison.near),
        course=course,
        fewest=FEWEST,
        chance=_one_in,
        csv=path.with_suffix(".csv").name,
    )
    write_text(path, text)


def _rows(comparison: Comparison) -> list[list[Any]]:
    """Return the rows of the CSV file: pairs that are reported, students with several sources, and pairs below."""
    rows: list[list[Any]] = [CSV_COLUMNS]
    for name, found in (
        ("reported", comparison.pairs),
        (NOT_REPORTED, comparison.near),
    ):
        for pair in found:
            alike, score = _by_likeness(pair), round(pair.score, 2)
            rows.append([name, pair.first, pair.second, score, len(alike), " ".join(alike[:5])])  # fmt: skip
    for one in comparison.patchworks:
        rows += [
            ["several sources", one.student, source, round(one.score, 2), len(ids), " ".join(ids)]
            for source, ids in one.sources.items()
        ]  # fmt: skip
    return rows


Shown = tuple[Pair, list[tuple[Any, ...]]]


def _side_by_side(comparison: Comparison, found: Sequence[Pair]) -> list[Shown]:
    """Return what the page shows of each pair: by exercise how alike it is, and the lines of both."""
    return [
        (pair, [(id, pair.exercises[id], *_marked(comparison, pair, id)) for id in _by_likeness(pair)])
        for pair in found
    ]  # fmt: skip


def _one_in(score: float) -> str:
    """Return the chance of a score in words. No class can tell more than one in a million."""
    return f"one in {10**score:,.0f}" if score < 6 else "less than one in a million"


def _by_likeness(pair: Pair) -> list[str]:
    """Return the exercises, those that are most alike first."""
    return sorted(pair.exercises, key=lambda id: pair.exercises[id].chance)


def _marked(
    comparison: Comparison, pair: Pair, id: str
) -> tuple[list[tuple[str, bool]], list[tuple[str, bool]]]:
    """Return the lines of both answers, and whether the other has the same statement and few in the class do."""
    both_names = {pair.first, pair.second}
    pairs_of_both = [
        {one.first, one.second}
        for one in comparison.pairs
        if both_names & {one.first, one.second}
    ]
    ring = set().union(*pairs_of_both) - both_names  # others who copied the same
    every = [
        own[id].print.structure
        for name, own in comparison.answers.items()
        if id in own and name not in ring
    ]
    holders = Counter(feature for one in every for feature in one)
    few = max(2, len(every) // 5)
    first, second = (comparison.answers[name][id] for name in (pair.first, pair.second))
    both = {
        feature
        for feature in first.print.structure.keys() & second.print.structure.keys()
        if holders[feature] <= few
    }
    return _lines(first, both), _lines(second, both)


def _lines(answer: Answer, both: set[Feature]) -> list[tuple[str, bool]]:
    found = answer.print.lines
    return [
        (line, bool(found.get(number, set()) & both))
        for number, line in enumerate(answer.source.splitlines(), start=1)
    ]
