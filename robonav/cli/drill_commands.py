"""The command ``robonav drills``: the list of drills, and question banks and exams made of them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from robonav.counting import counted

drills = typer.Typer(
    no_args_is_help=True,
    help="Make question banks and exams of drills, which draw new numbers for each question.",
)

Chapters = Annotated[
    list[int] | None,
    typer.Option("--chapter", help="Only drills of this chapter. May be repeated."),
]
Pages = Annotated[
    list[str] | None,
    typer.Option(
        "--page",
        help="Only drills of this page, such as dynamic-programming. May be repeated.",
    ),
]


@drills.command("list")
def drills_list(chapter: Chapters = None, page: Pages = None) -> None:
    """List the drills: name, page, and learning goal."""
    from robonav.drills.export import selected

    for one in selected(chapter or (), page or ()):
        print(f"{one.name:26} {one.page:22} {one.goal}")


@drills.command("export")
def drills_export(
    file: Annotated[Path, typer.Argument(help="The file to write.")],
    format: Annotated[
        str,
        typer.Option(
            help="moodle (.xml, Moodle's question bank), qti (.zip, for Canvas and Blackboard), or pdf (an exam to "
            "print, and a second file with its solutions). By default the extension of the file decides."
        ),
    ] = "",
    chapter: Chapters = None,
    page: Pages = None,
    drill: Annotated[
        list[str] | None,
        typer.Option(help="This drill. May be repeated. See: robonav drills list"),
    ] = None,
    at_most: Annotated[
        int,
        typer.Option(
            help="At most this many drills, spread evenly over those chosen. 0 means 10 for an exam and all for a bank."
        ),
    ] = 0,
    each: Annotated[int, typer.Option(help="Questions of each drill.")] = 1,
    seed: Annotated[
        int,
        typer.Option(
            help="Seed of the questions: the same seed gives the same questions. It is the number of the first paper."
        ),
    ] = 1,
    papers: Annotated[
        int,
        typer.Option(help="For pdf: how many different papers, in one file."),
    ] = 1,
    paper: Annotated[str, typer.Option(help="For pdf: a4 or letter.")] = "a4",
    platform: Annotated[
        str,
        typer.Option(
            help="For qti: canvas (QTI 1.2), or blackboard (QTI 2.1), which other platforms read as well."
        ),
    ] = "canvas",
    title: Annotated[
        str, typer.Option(help="The title of the question bank or exam.")
    ] = "Robot learning",
    force: Annotated[
        bool, typer.Option("--force", help="Write over files that exist.")
    ] = False,
) -> None:
    """Write questions of drills as a question bank or an exam. All drills take part unless you choose."""
    from robonav.drills import export

    request = export.Request(
        format=format,
        chapters=chapter or (),
        pages=page or (),
        drills=drill or (),
        at_most=at_most,
        each=each,
        seed=seed,
        papers=papers,
        paper=paper,
        platform=platform,
        title=title,
    )
    made = export.export(file, request, force=force)
    many = f"{made.papers} papers of " if made.papers > 1 else ""
    for path in made.paths:
        print(f"{path}: {many}{counted(made.questions, 'question')}")
    if made.left_out:
        print(
            f"Left out, because they have too few different questions: {', '.join(made.left_out)}",
            file=sys.stderr,
        )
    if made.fewer:
        print(
            f"These have fewer than {each} different questions and gave all: {', '.join(made.fewer)}",
            file=sys.stderr,
        )
