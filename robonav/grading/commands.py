"""The commands ``robonav grade``, ``gradebook`` and ``similarity``. Each imports what it needs when it runs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robonav.counting import counted

if TYPE_CHECKING:
    from .classroom import GradingConfig
    from .course import Course
    from .gradebook import Gradebook
    from .variants import EachStudent

gradebook = typer.Typer(
    no_args_is_help=True,
    help="Turn grades into marks: roster, deadlines, changes by hand, objections, exports.",
)
Graded = Annotated[
    Path, typer.Argument(help="The folder that robonav grade wrote its grades to.")
]
Who = Annotated[
    str, typer.Argument(help="The student's id, name, login or email address.")
]
Which = Annotated[str, typer.Argument(help="The exercise, such as 2.3.")]


# The arguments and options of robonav grade.
Folder = Annotated[
    Path,
    typer.Argument(
        help="A folder that holds one folder, zip file or notebook per student."
    ),
]
Out = Annotated[
    Path, typer.Option(help="The folder for grades, feedback and the overview.")
]
Secret = Annotated[
    Path | None,
    typer.Option(
        help="A file whose content seeds the test cases. The variable ROBONAV_SECRET can hold the seed instead."
    ),
]
Students = Annotated[
    list[str] | None, typer.Option(help="Grade this student again. May be repeated.")
]
Exercises = Annotated[
    list[str] | None,
    typer.Option(help="Grade only this exercise again. May be repeated."),
]
Jobs = Annotated[
    int, typer.Option(help="How many submissions at once; -1 for one per processor.")
]
Scheduler = Annotated[
    str | None, typer.Option(help="Address of a Dask scheduler that does the work.")
]
Variant = Annotated[
    str | None,
    typer.Option(
        help="The text that chose the variant of the exercises, as for robonav exercises build."
    ),
]
OwnVariants = Annotated[
    bool,
    typer.Option(
        "--each-student",
        help="Each student has a variant of their own, as with robonav exercises build --student NAME. A name is "
        "that of the submission.",
    ),
]
Practice = Annotated[
    bool,
    typer.Option(
        "--practice", help="Continue without a sandbox. The grades do not count."
    ),
]
NewSecret = Annotated[
    bool,
    typer.Option(
        "--new-secret", help="Grade everybody again with another secret than before."
    ),
]
Roster = Annotated[
    Path | None,
    typer.Option(
        help="The class as CSV, as for robonav gradebook start; it is kept beside the grades."
    ),
]
Alike = Annotated[
    bool,
    typer.Option(
        "--similarity",
        help="Also write similarity.html: the pairs of submissions that are too alike.",
    ),
]


def grade(
    folder: Folder,
    out: Out,
    secret: Secret = None,
    student: Students = None,
    exercise: Exercises = None,
    jobs: Jobs = -1,
    scheduler: Scheduler = None,
    variant: Variant = None,
    each_student: OwnVariants = False,
    practice: Practice = False,
    new_secret: NewSecret = False,
    roster: Roster = None,
    alike: Alike = False,
) -> None:
    """Grade a class. Run the command again to resume: grades that exist are kept."""
    from robonav import progress

    from . import paths
    from .classroom import grade_class
    from .gradebook import ROSTER

    course, each = class_course(folder, out, variant, each_student=each_student)
    check_roster_and_rules(out, roster, course)  # before the work, not after it
    ids = [course.named(key).id for key in exercise or []]
    config = grading_config(course, secret, each, practice=practice)
    with paths.without_submissions(folder), progress.bar("grading") as report:
        unfinished = grade_class(
            config,
            folder,
            out,
            again=student or [],
            ids=ids,
            jobs=jobs,
            scheduler=scheduler,
            progress=report,
            new_secret=new_secret,
            roster=roster or next(out.glob(ROSTER), None),
        )
    if roster is not None:
        keep_roster(out, roster)
    write_all(out)
    print(f"{out / 'index.html'}")
    if alike:
        tell_similar(folder, out / "similarity.html", course)
    if unfinished:
        print(
            f"The grader failed for {', '.join(unfinished)}. Run the command again to grade them.",
            file=sys.stderr,
        )
        raise typer.Exit(1)


def class_course(
    folder: Path, out: Path, variant: str | None, *, each_student: bool
) -> tuple[Course, EachStudent | None]:
    """Return the course with which a class is graded, and the exercises of each student's own if they have them.

    Raises
    ------
    ValueError
        If the class was graded with other options before.

    Examples
    --------
    >>> class_course(Path("class"), Path("graded"), None, each_student=True)
    Traceback (most recent call last):
    ValueError: --each-student needs --variant
    """
    from . import variants
    from .course import Course

    course = Course.of_checkout()
    if each_student and variant is None:
        raise ValueError("--each-student needs --variant")
    if variant is None:
        variants.check_same_options(out, "")
        return course, None
    if each_student:
        return course, variants.for_each_student(course, variant, folder, out)
    return variants.course_for(course, variant, folder, out), None


def check_roster_and_rules(out: Path, roster: Path | None, course: Course) -> None:
    """Check that the rules and a roster can be read.

    Raises
    ------
    ValueError
        If one of them has something that it should not.

    Examples
    --------
    >>> import tempfile
    >>> out = Path(tempfile.mkdtemp())
    >>> _ = (out / "rules.toml").write_text("[late]\\npenalty = -1\\n")
    >>> from robonav.grading.course import Course
    >>> check_roster_and_rules(out, None, Course.of_checkout())
    Traceback (most recent call last):
    ValueError: ...: penalty must be a number from 0 to 100, got -1
    """
    from .roster import read_roster
    from .rules import read_rules

    rules = read_rules(out, course)
    if roster is not None:
        read_roster(roster, rules.teams)


def grading_config(
    course: Course, secret: Path | None, each: EachStudent | None, *, practice: bool
) -> GradingConfig:
    """Return how a class is graded on this machine.

    Raises
    ------
    ValueError
        If the machine has no sandbox, and practice is not wanted or there is a secret.

    Examples
    --------
    >>> from robonav.grading.course import Course
    >>> grading_config(Course.of_checkout(), None, None, practice=True).secret
    b''
    """
    from . import sandbox_check
    from .cases import secret_from
    from .classroom import GradingConfig

    config = GradingConfig(course, sandbox_check.best(), secret_from(secret), each)
    if config.tier == "practice" and not practice:
        raise ValueError(
            f"this machine has no sandbox, so only --practice works: {sandbox_check.fault('official')}"
        )
    if config.tier == "practice" and config.secret:
        raise ValueError("without a sandbox no secret is safe: give none")
    return config


@gradebook.command()
def start(
    graded: Graded,
    roster: Annotated[
        Path | None,
        typer.Option(
            help="The class as CSV: an export of Moodle, Canvas, Gradescope or GitHub Classroom, or your own file."
        ),
    ] = None,
) -> None:
    """Put the roster and a commented file of rules into the folder of grades."""
    from robonav.atomic import write_text

    from .rules import RULES, TEMPLATE

    if roster is not None:
        keep_roster(graded, roster)
    if not (graded / RULES).exists():
        write_text(graded / RULES, TEMPLATE)
    print(f"deadlines, groups, extensions: {graded / RULES}")


def keep_roster(graded: Path, roster: Path) -> None:
    """Put a roster into a folder of grades, and print how many students it has.

    Raises
    ------
    ValueError
        If the roster cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> graded = Path(tempfile.mkdtemp())
    >>> _ = (graded / "class.csv").write_text("name\\nAda\\n")
    >>> keep_roster(graded, graded / "class.csv")
    1 student: .../roster.csv
    """
    from robonav.atomic import atomic_write

    from .gradebook import ROSTER
    from .roster import ignored_groups, read_roster
    from .rules import RULES, read_rules

    rules = read_rules(graded, _course(graded))
    students = read_roster(roster, rules.teams)
    content = roster.read_bytes()
    with atomic_write(graded / ROSTER) as file:
        file.write(content)
    print(f"{counted(len(students), 'student')}: {graded / ROSTER}")
    if ignored_groups(students):
        print(
            "The column Groups makes no teams, so every submission counts for one student; "
            f"if its groups are teams, write teams = true at the top of {graded / RULES}."
        )


@gradebook.command()
def update(graded: Graded) -> None:
    """Write the marks and the statistics again, after a change of the roster or the rules."""
    _tell(write_all(graded))
    print(graded / "marks.html")


@gradebook.command("mark")
def mark_by_hand(
    graded: Graded,
    student: Who,
    exercise: Which,
    points: Annotated[
        str,
        typer.Argument(
            help="The points that count, before a penalty for lateness. The word grader takes an earlier change back."
        ),
    ],
    reason: Annotated[str, typer.Option(help="Why. It is kept in the log.")],
    by: Annotated[str, typer.Option(help="Who decided. It is kept in the log.")],
) -> None:
    """Change a mark by hand. The change stays when the class is graded again."""
    from .gradebook import change, plain, why_no_mark

    book = _book(graded)
    account, id = book.account(student), book.course.named(exercise).id
    if id not in account.marks:
        raise ValueError(why_no_mark(book, account, id))
    try:
        given = None if points == "grader" else float(points)
    except ValueError:
        raise ValueError(
            f"points must be a number, or grader to take a change back, got {points}"
        ) from None
    change(book, account, id, given, reason, by)
    mark = write_all(graded).account(account.student.id).marks[id]
    print(
        f"{account.student.id} {id}: {plain(mark.points)} of {mark.most} points count"
    )


@gradebook.command()
def explain(
    graded: Graded,
    student: Who,
    exercise: Which,
    repeat: Annotated[
        Path | None,
        typer.Option(
            help="The folder of submissions: run the exercise again on the same cases, and show those that failed."
        ),
    ] = None,
) -> None:
    """Say how a mark came about: file, hash, runs, cases, seed, versions, sandbox, messages, changes."""
    from . import objection, paths

    book = _book(graded)
    account, chosen = book.account(student), book.course.named(exercise)
    print(objection.explain(book, account, chosen))
    if repeat is not None:
        with paths.without_submissions(repeat):
            print(objection.repeat(book, account, chosen, repeat))


@gradebook.command()
def export(
    graded: Graded,
    file: Annotated[Path, typer.Argument(help="The CSV file to write.")],
    platform: Annotated[
        str, typer.Option("--format", help="moodle, canvas or gradescope.")
    ],
    title: Annotated[
        str,
        typer.Option(
            help="The assignment as the platform calls it; on Canvas with its number, as in 'Chapter 2 (1234)'."
        ),
    ] = "Exercises",
) -> None:
    """Write the marks as a learning platform imports them. Marks that are not settled stay empty."""
    from robonav.atomic import write_text

    from . import exports

    book = _book(graded)
    write_text(file, exports.marks_for(book, platform, title))
    print(file)
    if platform == "canvas" and (remark := exports.without_canvas_id(book)):
        print(remark, file=sys.stderr)
    if platform == "moodle" and (remark := exports.other_maximum(book)):
        print(remark, file=sys.stderr)
    for said in exports.not_all_taken(book):
        print(said, file=sys.stderr)
    if names := exports.unsettled(book):
        print(f"Left empty, because they are not settled: {', '.join(names)}.", file=sys.stderr)  # fmt: skip
        for account in book.accounts:
            for problem in account.problems if account.student.id in names else ():
                print(f"  {account.student.id}: {problem}", file=sys.stderr)
        raise typer.Exit(1)


@gradebook.command()
def feedback(
    graded: Graded,
    folder: Annotated[Path, typer.Argument(help="The folder for the zip files.")],
) -> None:
    """Write a zip file for each student: the feedback page and the marks that count."""
    from .exports import write_feedback

    print(f"{len(write_feedback(_book(graded), folder))} zip files in {folder}")


def write_all(folder: Path) -> Gradebook:
    """Write the marks and the statistics of a class, and return the gradebook.

    Examples
    --------
    >>> import tempfile
    >>> write_all(Path(tempfile.mkdtemp()))
    Traceback (most recent call last):
    ValueError: ... holds no grades; make them with robonav grade
    """
    from .class_statistics import write_statistics
    from .gradebook import write_gradebook

    book = _book(folder)
    write_gradebook(book)
    write_statistics(book)
    return book


def _book(folder: Path) -> Gradebook:
    from .gradebook import read_gradebook

    return read_gradebook(folder, _course(folder))


def _course(folder: Path) -> Course:
    """Return the course with which a class was graded."""
    from .course import Course
    from .variants import MARK

    course = Course.of_checkout()
    if (folder / "exercises" / MARK).is_file():
        course = Course((folder / "exercises").resolve())  # of robonav grade --variant
    return course


def _tell(book: Gradebook) -> None:
    """Print what is not settled."""
    for problem in book.problems:
        print(problem, file=sys.stderr)
    for account in book.accounts:
        for problem in account.problems:
            print(f"{account.student.name}: {problem}", file=sys.stderr)


def similarity(
    folder: Annotated[
        Path,
        typer.Argument(
            help="The class: a folder that holds one folder, zip file or notebook per student."
        ),
    ],
    out: Annotated[
        Path, typer.Option(help="The page to write; its scores go beside it as CSV.")
    ] = Path("similarity.html"),
    variant: Variant = None,
) -> None:
    """Show the pairs of submissions that are too alike, side by side. No code is run."""
    from tempfile import TemporaryDirectory

    from .course import Course
    from .variants import write

    if variant is None:
        tell_similar(folder, out, Course.of_checkout())
        return
    with TemporaryDirectory() as place:
        tell_similar(folder, out, write(Course.of_checkout(), variant, Path(place)))


def tell_similar(folder: Path, out: Path, course: Course) -> None:
    """Write the page of the pairs that are too alike, and print how many there are."""
    from . import copies, paths

    with paths.without_submissions(folder):
        found = copies.compare_class(course, folder)
    copies.write_comparison(found, course, out)
    print(
        f"Pairs that are too alike: {len(found.pairs)} of {found.compared}; see {out}"
    )
    if found.patchworks:
        print(f"Answers like those of several others: {len(found.patchworks)}")
    if found.near:
        print(f"Worth a look, not reported: {len(found.near)}")
    if found.few:
        print(
            f"Pairs with fewer than {copies.FEWEST} exercises in common, too few to tell: {found.few}. Put the "
            "submissions of several weeks into one folder for each student."
        )
    for problem in found.problems:
        print(f"Not compared: {problem}", file=sys.stderr)
