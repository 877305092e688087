"""A question bank or an exam as somebody asks for it, and the files that are made of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from robonav.validation import check_integer

from ..registry import Drill
from . import files
from .moodle import moodle_xml
from .package import qti_zip
from .paper import Paper, exam_pdf, solutions_pdf
from .selection import Drawn, drawn, selected, spread, varied

OF_AN_EXAM = 10  # drills, unless another number is asked for


@dataclass(frozen=True)
class Request:
    """Which questions are exported, and how.

    Attributes
    ----------
    format : str
        "moodle", "qti" or "pdf"; empty if the file's name tells.
    chapters : sequence of int
        Drills of these chapters take part.
    pages : sequence of str
        Drills of these pages take part.
    drills : sequence of str
        These drills take part. If nothing is named all do.
    at_most : int
        At most so many drills; 0 is 10 for an exam, and all for a bank.
    each : int
        Questions of each drill.
    seed : int
        Seed of the questions. It is the number of the first paper.
    papers : int
        How many papers an exam has.
    paper : str
        "a4" or "letter".
    platform : str
        "canvas" or "blackboard", for QTI.
    title : str
        The title of the bank or exam.

    Examples
    --------
    >>> from robonav.drills.export import Request
    >>> Request(format="pdf", chapters=[2], papers=30).seed
    1
    """

    format: str = ""
    chapters: Sequence[int] = ()
    pages: Sequence[str] = ()
    drills: Sequence[str] = ()
    at_most: int = 0
    each: int = 1
    seed: int = 1
    papers: int = 1
    paper: str = "a4"
    platform: str = "canvas"
    title: str = "Robot learning"


@dataclass(frozen=True)
class Exported:
    """What was written.

    Attributes
    ----------
    paths : sequence of Path
        The files.
    papers : int
        How many papers each has.
    questions : int
        How many questions a bank or a paper has.
    left_out : sequence of str
        Drills that have too few different questions for so many papers.
    fewer : sequence of str
        Drills that gave fewer questions than were asked for, because they have no more.

    Examples
    --------
    >>> from pathlib import Path
    >>> from robonav.drills.export import Exported
    >>> Exported([Path("bank.xml")], papers=1, questions=6, left_out=[], fewer=[]).questions
    6
    """

    paths: Sequence[Path]
    papers: int
    questions: int
    left_out: Sequence[str]
    fewer: Sequence[str]


def export(file: Path, request: Request, *, force: bool = False) -> Exported:
    """Write a question bank, or an exam and its solutions.

    Parameters
    ----------
    file : Path
        The file to write. The solutions of an exam are written beside it.
    request : Request
        What is asked for.
    force : bool, default False
        Whether files that exist are written over.

    Returns
    -------
    Exported

    Raises
    ------
    ValueError
        If there is no such format, drill, page or platform, if a number is too small, if a file exists, if a package is
        missing, or if no drill has enough different questions.

    Examples
    --------
    >>> import tempfile
    >>> bank = Path(tempfile.mkdtemp(), "bank.xml")
    >>> export(bank, Request(drills=["td-error", "softmax"], each=3)).questions
    6
    """
    kind = files.format_of(file, request.format)
    files.check_installed(kind)
    check_integer("papers", request.papers, at_least=1)
    if request.papers > 1 and kind != "pdf":
        raise ValueError("only an exam (--format pdf) has several papers")
    chosen, left_out = _chosen(request, kind)
    paths = [file, files.beside(file, "solutions")][: 2 if kind == "pdf" else 1]
    files.check_free(*paths, force=force)
    seeds = range(request.seed, request.seed + request.papers)
    sets = [drawn(chosen, seed, request.each) for seed in seeds]
    contents = _contents(request, kind, dict(zip(seeds, sets, strict=True)))
    files.write(dict(zip(paths, contents, strict=True)))
    drew = [one.drill.name for one in sets[0]]
    fewer = [one.name for one in chosen if drew.count(one.name) < request.each]
    return Exported(paths, request.papers, len(drew), left_out, fewer)


def _chosen(request: Request, kind: str) -> tuple[list[Drill], list[str]]:
    """The drills that take part, and the names of those that an exam leaves out."""
    every = selected(request.chapters, request.pages, request.drills)
    if kind != "pdf":
        return (spread(every, request.at_most) if request.at_most else every), []
    enough = varied(every, request.papers, request.each)
    named = request.drills  # a drill that is named takes part in any case
    kept = [one for one in every if one in enough or one.name in named]
    left_out = [one.name for one in every if one not in kept]
    if not kept:
        raise ValueError(
            f"too few different questions for {request.papers} papers: {', '.join(left_out)}; "
            "choose more drills, or name these with --drill"
        )
    return spread(kept, request.at_most or OF_AN_EXAM), left_out


def _contents(request: Request, kind: str, sets: dict[int, list[Drawn]]) -> list[bytes]:
    """What the files hold."""
    title = request.title
    if kind == "pdf":
        exams = [Paper(seed, questions) for seed, questions in sets.items()]
        return [make(exams, title, request.paper) for make in (exam_pdf, solutions_pdf)]
    questions = sets[request.seed]
    if kind == "qti":
        return [qti_zip(questions, title, request.platform)]
    return [moodle_xml(questions, title)]
