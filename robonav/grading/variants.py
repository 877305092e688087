"""Variants of the exercises: the same ideas with other details, chosen by a secret.

A knob is one detail of an exercise, such as which of several equally good actions is taken. Its first value is the
book's, so that the book's exercise is the variant in which every knob has its first value. What a knob changes is data,
in ``solutions/variants/chN/name.toml``: rows of text fragments, one fragment for each value. The first fragment of a
row stands in the exercise's files. A variant has another fragment of the row in its place. Rows of different knobs
never touch the same place, so every combination of values is a variant.

``write`` makes a course of its own from a secret. Everything else in this package works with that course as it does
with the book's: stubs, notebooks, the zip for students, the page, the checks at home and the grades.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import itertools
import json
import math
import re
import shutil
import textwrap
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robonav.atomic import write_text

from .cases import stretched
from .course import Course, Exercise

MARK = "variant.json"  # in the root of a course that ``write`` made
EACH = "students.key"  # in a folder with a course for each student
WIDTH = 88  # of a line in a question
VARIANT, VARIANT_EACH = "--variant", "--variant and --each-student"  # robonav grade

Values = Mapping[str, str]  # the value of each knob, by the knob's name


@dataclass(frozen=True)
class Knob:
    """One detail of an exercise that may be otherwise.

    Attributes
    ----------
    name : str
        What the knob decides.
    values : tuple of str
        The values; the first is the book's.
    hints : tuple of str
        For each value but the first, the hint for a student who answers with the book's value.
    everywhere, source, wrong, tests, title : tuple of tuple of str
        Rows of fragments, one for each value. A fragment of the first column stands at least once in the exercise's
        three files, or in what the field names: its solution, its known mistakes, its parts, its title. A space in it
        matches any white space.
    wrap : tuple of str
        For each value but the first, a Python expression for the answer of a known mistake, or an empty string if
        the rows say it all. It may use ``mistake``, the mistake in the book's exercise, ``np``, and the arguments of
        the variant, by their names or together as ``arguments``.
    without : tuple of tuple of str
        For each value but the first, the known mistakes that are none with it, or that the knob's own hint covers.
    alone : bool
        Whether it may be the only knob that differs from the book. It may not if it changes too few parts.

    Examples
    --------
    >>> ties = Knob("ties", ("lowest", "highest"), ("Here the highest index wins.",))
    >>> ties.column("highest")
    1
    """

    name: str
    values: tuple[str, ...]
    hints: tuple[str, ...]
    everywhere: tuple[tuple[str, ...], ...] = ()
    source: tuple[tuple[str, ...], ...] = ()
    wrong: tuple[tuple[str, ...], ...] = ()
    tests: tuple[tuple[str, ...], ...] = ()
    title: tuple[tuple[str, ...], ...] = ()
    wrap: tuple[str, ...] = ()
    without: tuple[tuple[str, ...], ...] = ()
    alone: bool = True

    def __post_init__(self) -> None:
        others = len(self.values) - 1
        for field, found in (
            ("hints", len(self.hints)),
            ("wrap", len(self.wrap) or others),
            ("without", len(self.without) or others),
        ):
            if found != others:
                raise ValueError(
                    f"{field} of knob {self.name} must have an entry for each value but the first, "
                    f"{others}, got {found}"
                )
        for row in (
            *self.everywhere,
            *self.source,
            *self.wrong,
            *self.tests,
            *self.title,
        ):
            if len(row) != len(self.values):
                raise ValueError(
                    f"a row of knob {self.name} must have {len(self.values)} fragments, got {row!r}"
                )

    def column(self, value: str) -> int:
        """Return which column of the rows belongs to a value."""
        return self.values.index(value)


@dataclass(frozen=True)
class Texts:
    """The texts of an exercise: its solution, its known mistakes, its parts in the chapter's tests, and its title."""

    source: str
    wrong: str
    tests: str
    title: str


def knobs(course: Course, exercise: Exercise) -> tuple[Knob, ...]:
    """Return the knobs of an exercise; none if it has no variants."""
    path = course.solutions / "variants" / exercise.chapter / f"{exercise.name}.toml"
    if not path.is_file():
        return ()
    with path.open("rb") as file:
        return tuple(Knob(**_tuples(knob)) for knob in tomllib.load(file)["knob"])


def chosen(secret: str, exercise: Exercise, of: Sequence[Knob]) -> dict[str, str]:
    """Return the value of each knob that a secret chooses. One knob that may stand alone differs from the book.

    Each value follows from a hash of the secret, the exercise's id and the knob's name.

    Examples
    --------
    >>> exercise = Exercise("2.2", "improve", "Ties", 4, "warm-up", 10, "dynamic-programming")
    >>> chosen("autumn", exercise, [Knob("ties", ("lowest", "highest"), ("The highest.",))])
    {'ties': 'highest'}
    """
    if not of:
        raise ValueError(f"exercise {exercise.id} has no variants yet")
    key = stretched(b"variant/" + secret.encode())
    for attempt in itertools.count():
        values = {}
        for knob in of:
            text = f"/{exercise.id}/{knob.name}/{attempt}".encode()
            number = int.from_bytes(hashlib.sha256(key + text).digest()[:8], "big")
            values[knob.name] = knob.values[number % len(knob.values)]
        if any(knob.alone and knob.column(values[knob.name]) > 0 for knob in of):
            return values
    raise AssertionError


def book(of: Sequence[Knob]) -> dict[str, str]:
    """Return the value of each knob in the book."""
    return {knob.name: knob.values[0] for knob in of}


def combinations(of: Sequence[Knob]) -> list[dict[str, str]]:
    """Return all combinations of values, the book's first.

    Examples
    --------
    >>> [len(combinations([Knob(str(k), ("a", "b"), ("?",)) for k in range(n)])) for n in (1, 3, 6)]
    [2, 8, 64]
    """
    names = [knob.name for knob in of]
    return [
        dict(zip(names, values, strict=True))
        for values in itertools.product(*(knob.values for knob in of))
    ]


def covering(every: Sequence[dict[str, str]]) -> list[dict[str, str]]:
    """Return some of the combinations in which every two values that stand together in any of them do so, too.

    Examples
    --------
    >>> len(covering(combinations([Knob(k, ("a", "b"), ("?",)) for k in "xyz"])))
    4
    """
    taken, missing = [every[0]], set().union(*map(_pairs, every)) - _pairs(every[0])
    while missing:
        best = max(every, key=lambda values: len(_pairs(values) & missing))
        taken.append(best)
        missing -= _pairs(best)
    return taken


def texts(course: Course, exercise: Exercise) -> Texts:
    """Return the texts of the book's exercise."""
    return Texts(
        source=(course.solutions / exercise.file).read_text("utf-8"),
        wrong=(course.solutions / "wrong" / exercise.file).read_text("utf-8"),
        tests=_sections(course, exercise.chapter).get(exercise.id, ""),
        title=exercise.title,
    )


def rendered(course: Course, exercise: Exercise, values: Values) -> Texts:
    """Return the texts of the variant of an exercise with these values.

    Raises
    ------
    ValueError
        If the exercise has no knobs, a fragment does not stand in its files, or fragments of two knobs overlap.
    """
    of, plain = knobs(course, exercise), texts(course, exercise)
    if not of:
        raise ValueError(f"exercise {exercise.id} has no variants yet")
    _check_that_all_stand(exercise, of, plain)
    source = _wrapped_lines(_edited(plain.source, of, values, "source"), plain.source)
    wrong = _edited(plain.wrong, of, values, "wrong")
    for knob in of:
        if (column := knob.column(values[knob.name])) > 0:
            wrong = _without(wrong, knob.without[column - 1] if knob.without else ())
    wrong += _wraps(of, values, _signature(source, exercise.name))
    for knob in of:
        if (column := knob.column(values[knob.name])) > 0:
            near = {**values, knob.name: knob.values[0]}
            other = _edited(plain.source, of, near, "source")
            wrong += _as_in_the_book(exercise, knob, knob.hints[column - 1], other)
    tests, title = (
        _edited(getattr(plain, field), of, values, field)
        for field in ("tests", "title")
    )
    return Texts(source, wrong, tests, title)


def without_variants(course: Course) -> list[Exercise]:
    """Return the exercises that have no knobs yet."""
    return [
        exercise
        for exercise in course.exercises.values()
        if not knobs(course, exercise)
    ]


def write(course: Course, secret: str, out: Path) -> Course:
    """Write the variant of the course that a secret chooses, and return it.

    ``out`` then holds what the book's repository holds: solutions, known mistakes, tests, stubs and notebooks, and in
    addition ``variant.json`` with the values of all knobs. It is for the instructor. Exercises without knobs are left
    out.

    Parameters
    ----------
    course : Course
        The book's course.
    secret : str
        Any text.
    out : Path
        A new folder, or one that this function wrote before.

    Raises
    ------
    ValueError
        If the secret is empty, or the folder holds something else.
    """
    return write_values(course, _values(course, secret), out)


def check_replaces_nothing(course: Course, secret: str, out: Path) -> None:
    """Check that a folder holds no other variant than the one that a secret chooses.

    Raises
    ------
    ValueError
        If it holds another one, or if the secret is empty.

    Examples
    --------
    >>> check_replaces_nothing(Course.around(), "autumn", Path("no-such-folder"))
    """
    if not _may_hold(out, _values(course, secret)):
        raise ValueError(
            f"{out} holds another variant of the exercises; choose another folder, or remove it first"
        )


def _may_hold(out: Path, values: Mapping[str, Values]) -> bool:
    """Whether a folder holds the variant with these values, or none."""
    mark = out / MARK
    if not mark.is_file():
        return True
    try:
        return bool(json.loads(mark.read_bytes()) == values)
    except ValueError:
        return False


def _values(course: Course, secret: str) -> dict[str, dict[str, str]]:
    """Return the values that a secret chooses for each exercise that has knobs."""
    if not secret.strip():
        raise ValueError("the secret of a variant must be a text, got an empty one")
    return {
        exercise.id: chosen(secret, exercise, of)
        for exercise in course.exercises.values()
        if (of := knobs(course, exercise))
    }


def course_for(course: Course, secret: str, folder: Path, out: Path) -> Course:
    """Write the variant that grades the class in ``folder`` into ``out/exercises``, and return it.

    Raises
    ------
    ValueError
        If the class was graded with another variant or other options before, or ``out`` lies in the class folder.
    """
    _check_out(folder, out)
    check_same_options(out, VARIANT)
    if not _may_hold(out / "exercises", _values(course, secret)):
        raise ValueError(
            f"{out} was graded with another variant; choose another folder"
        )
    return write(course, secret, out / "exercises")


def check_same_options(out: Path, options: str) -> None:
    """Check that a class that was graded before is graded with the same options again.

    Otherwise answers to one variant of the exercises would be graded as answers to another.

    Parameters
    ----------
    out : Path
        The folder of the grades.
    options : str
        ``--variant``, ``--variant and --each-student``, or an empty string.

    Raises
    ------
    ValueError
        If the class was graded with other options.

    Examples
    --------
    >>> import tempfile
    >>> out = Path(tempfile.mkdtemp())
    >>> check_same_options(out, "")
    >>> (out / "students").mkdir()
    >>> check_same_options(out, "--variant")
    Traceback (most recent call last):
    ValueError: ... was graded without a variant; choose another folder
    """
    if (out / "exercises" / EACH).is_file():
        before = VARIANT_EACH
    elif (out / "exercises" / MARK).is_file():
        before = VARIANT
    elif (out / "students").is_dir():
        before = ""
    else:  # not graded yet
        return
    if options == before:
        return
    if before == "":
        raise ValueError(f"{out} was graded without a variant; choose another folder")
    again = {
        VARIANT: "give the same --variant again",
        VARIANT_EACH: "give both again, with the same text",
    }[before]
    without = ", without --each-student" if options == VARIANT_EACH else ""
    raise ValueError(f"{out} was graded with {before}; {again}{without}")


@dataclass(frozen=True)
class EachStudent:
    """Exercises of each student's own, chosen by a secret and the student's name.

    Attributes
    ----------
    course : Course
        The book's course.
    secret : str
        Any text.
    folder : Path
        The folder that gets a folder with a course for each student.

    Examples
    --------
    >>> each = EachStudent(Course.around(), "autumn", Path("term"))
    >>> each.of("../ada")
    Traceback (most recent call last):
    ValueError: a student's name must be the name of a folder, got '../ada'
    """

    course: Course
    secret: str
    folder: Path

    def of(self, student: str) -> Course:
        """Write the course of a student, and return it.

        Raises
        ------
        ValueError
            If the name is not that of a folder.
        """
        if student in ("", ".", "..") or "/" in student or "\\" in student:
            raise ValueError(
                f"a student's name must be the name of a folder, got {student!r}"
            )
        return write(self.course, self.secret_of(student), self.folder / student)

    def secret_of(self, student: str) -> str:
        """Return the text that chooses a student's variant."""
        return f"{self.secret}/{student}"

    def key(self) -> str:
        """Return a hash of everything that the courses depend on, besides the book's exercises."""
        key = stretched(b"variant/" + self.secret.encode())
        digest = hashlib.sha256(b"each/" + key)
        for path in sorted((self.course.solutions / "variants").rglob("*.toml")):
            digest.update(path.name.encode() + path.read_bytes())
        return digest.hexdigest()


def for_each_student(
    course: Course, secret: str, folder: Path, out: Path
) -> EachStudent:
    """Return the exercises of each student's own that grade the class in ``folder``.

    Raises
    ------
    ValueError
        If the secret is empty, the class was graded with other exercises before, or ``out`` lies in the class folder.
    """
    each = EachStudent(course, secret, out / "exercises")
    _values(course, secret)  # refuses an empty secret
    _check_out(folder, out)
    check_same_options(out, VARIANT_EACH)
    path = each.folder / EACH
    key = hashlib.sha256(b"each/" + stretched(b"variant/" + secret.encode()))
    before = path.read_text("utf-8") if path.is_file() else ""
    if path.is_file() and before != key.hexdigest():
        raise ValueError(
            f"{out} was graded with other exercises; choose another folder"
        )
    write_text(path, key.hexdigest())
    return each


def own_course(course: Course, out: Path, student: str) -> Course:
    """Return the course with which a student of a graded class was graded: the student's own, or else the class's."""
    folder = out / "exercises" / student
    return Course(folder.resolve()) if (folder / MARK).is_file() else course


def _check_out(folder: Path, out: Path) -> None:
    if out.resolve().is_relative_to(folder.resolve()):
        raise ValueError(
            f"out must not lie in the class folder, where it would be a student, got {out}"
        )


def write_values(course: Course, values: Mapping[str, Values], out: Path) -> Course:
    """Write the variant of the course with these values of each exercise's knobs, and return it."""
    from .build import build

    if out.exists() and not (out / MARK).is_file() and any(out.iterdir()):
        raise ValueError(
            f"{out} must be a new folder, or one with an earlier variant of the exercises"
        )
    for folder in ("solutions", "tests"):
        shutil.rmtree(out / folder, ignore_errors=True)
    out.mkdir(parents=True, exist_ok=True)
    write_text(out / MARK, json.dumps(values, indent=1) + "\n")
    made = {
        id: rendered(course, course.exercises[id], chosen)
        for id, chosen in values.items()
    }
    variant = _written(course, made, out)
    build(variant)
    return variant


def write_some(course: Course, wanted: Iterable[Exercise], out: Path) -> Course:
    """Write a course with some of a course's exercises into a new folder, as they are, and return it.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> course = Course.around()
    >>> with TemporaryDirectory() as folder:
    ...     list(write_some(course, course.selected("2.2"), Path(folder)).exercises)
    ['2.2']
    """
    return _written(course, {one.id: texts(course, one) for one in wanted}, out)


def _written(course: Course, made: Mapping[str, Texts], out: Path) -> Course:
    """Write what a course with these texts is made from into a folder, and return it."""
    for name, text in _files(course, made):
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_text(text, "utf-8", newline="\n")
    return Course(out.resolve())


def _files(course: Course, made: Mapping[str, Texts]) -> Iterator[tuple[str, str]]:
    """Yield the files that a course with these texts is made from, all but the generated ones, by their path."""
    yield "tests/exercises/pytest.ini", (course.tests / "pytest.ini").read_text("utf-8")
    head, *entries = (
        (course.tests / "manifest.toml").read_text("utf-8").split("[[exercise]]")
    )
    kept = []
    for entry in entries:
        if (id := tomllib.loads(entry)["id"]) in made:
            kept.append(entry.replace(course.exercises[id].title, made[id].title))
    yield "tests/exercises/manifest.toml", "[[exercise]]".join([head, *kept])
    for chapter, exercises in course.chapters():
        sections = dict(_sections(course, chapter))
        for exercise in exercises:
            if exercise.id in made:
                sections[exercise.id] = made[exercise.id].tests
                yield f"solutions/{exercise.file}", made[exercise.id].source
                yield f"solutions/wrong/{exercise.file}", made[exercise.id].wrong
            else:
                sections[exercise.id] = _without_parts(sections[exercise.id])
        if any(exercise.id in made for exercise in exercises):
            yield f"tests/exercises/test_{chapter}.py", "".join(sections.values())


def _sections(course: Course, chapter: str) -> dict[str, str]:
    """Return the text of a chapter's tests, cut into the sections of its exercises.

    What stands before the parts of an exercise, and after those of the one before, belongs to it.
    """
    return _cut((course.tests / f"test_{chapter}.py").read_text("utf-8"))


@functools.cache
def _cut(text: str) -> dict[str, str]:
    """Return a chapter's tests, cut into sections; the same text is parsed once. Nothing may change the result."""
    lines, sections, start = text.splitlines(keepends=True), {}, 0
    ends: dict[str, int] = {}
    for node in ast.parse(text).body:
        if id := _part_of(node):
            assert node.end_lineno is not None
            ends[id] = node.end_lineno
    for id, end in ends.items():
        sections[id] = "".join(lines[start:end])
        start = end
    sections[id] += "".join(lines[start:])
    return sections


def _part_of(node: ast.stmt) -> str:
    """Return the id of the exercise that a statement is a part of, or an empty string."""
    for decorator in getattr(node, "decorator_list", ()):
        match decorator:
            case ast.Call(
                func=ast.Attribute(attr="part"), args=[ast.Constant(value=str(id)), *_]
            ):
                return id
    return ""


@functools.cache
def _without_parts(section: str) -> str:
    """Return a section of tests with its helpers only, which other exercises may use."""
    return _without(
        section,
        [node.name for node in ast.parse(section).body if _part_of(node)],  # type: ignore[attr-defined]
    )


def _without(text: str, names: Sequence[str]) -> str:
    """Return a text without the functions of these names.

    Raises
    ------
    ValueError
        If there is no function of such a name.
    """
    lines, found = text.splitlines(keepends=True), set()
    for node in reversed(ast.parse(text).body):
        if isinstance(node, ast.FunctionDef) and node.name in names:
            first = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            del lines[first - 1 : node.end_lineno]
            found.add(node.name)
    if missing := set(names) - found:
        raise ValueError(f"no function {', '.join(sorted(missing))} to leave out")
    return re.sub(r"\n{4,}", "\n\n\n", "".join(lines))


def _edited(text: str, of: Sequence[Knob], values: Values, field: str) -> str:
    """Return a text with the fragments of these values."""
    spans: list[tuple[int, int, str, str]] = []
    for knob in of:
        column = knob.column(values[knob.name])
        for row in _rows(knob, field) if column else ():
            spans += [
                (*found.span(), row[column], knob.name)
                for found in _pattern(row[0]).finditer(text)
            ]
    spans.sort(key=lambda span: (span[0], -span[1]))
    parts, at, last = [], 0, ""
    for start, end, fragment, name in spans:
        if start < at:
            if name == last and end <= at:  # part of a longer fragment
                continue
            raise ValueError(
                f"knobs {last} and {name} change the same place: {text[start:end]!r}"
            )
        parts += [text[at:start], fragment]
        at, last = end, name
    return "".join([*parts, text[at:]])


def _rows(knob: Knob, field: str) -> tuple[tuple[str, ...], ...]:
    anywhere = knob.everywhere if field != "title" else ()
    return (*anywhere, *getattr(knob, field))


def _pattern(fragment: str) -> re.Pattern[str]:
    """Return a pattern for a fragment. A space matches any white space, and words are whole."""
    words = r"\s+".join(map(re.escape, fragment.split()))
    before = r"(?<!\w)" if re.match(r"\w", fragment) else ""
    after = r"(?!\w)" if re.search(r"\w$", fragment) else ""
    return re.compile(before + words + after)


def _check_that_all_stand(exercise: Exercise, of: Sequence[Knob], plain: Texts) -> None:
    """Refuse a fragment that stands nowhere, because the exercise has changed since."""
    for knob in of:
        for field in ("everywhere", "source", "wrong", "tests", "title"):
            chosen = [getattr(plain, field)] if field != "everywhere" else []
            places = chosen or [plain.source, plain.wrong, plain.tests]
            for row in getattr(knob, field):
                if not any(_pattern(row[0]).search(text) for text in places):
                    raise ValueError(
                        f"knob {knob.name} of exercise {exercise.id} changes a text that does not stand there: "
                        f"{row[0]!r}"
                    )


def _wrapped_lines(source: str, plain: str) -> str:
    """Return a source with the paragraphs of its question and docstrings that differ from the plain source filled."""
    known = set(plain.split("\n\n"))
    known |= {
        paragraph
        for text in _docstrings(plain).values()
        for paragraph in text.split("\n\n")
    }
    lines = source.splitlines()
    for (start, end), text in sorted(_docstrings(source).items(), reverse=True):
        paragraphs = [
            paragraph if paragraph in known else _filled(paragraph)
            for paragraph in text.split("\n\n")
        ]
        lines[start:end] = "\n\n".join(paragraphs).splitlines()
    return "\n".join([*lines, ""])


def _docstrings(source: str) -> dict[tuple[int, int], str]:
    """Return the docstrings of a source as they stand there, by the lines that they stand in."""
    found, lines = {}, source.splitlines()
    tree = ast.parse(source)
    nodes: list[ast.Module | ast.FunctionDef] = [tree]
    for node in [
        *nodes,
        *(inner for inner in tree.body if isinstance(inner, ast.FunctionDef)),
    ]:
        docstring = node.body[0]
        start, end = docstring.lineno - 1, docstring.end_lineno or docstring.lineno
        found[start, end] = "\n".join(lines[start:end])
    return found


def _filled(block: str) -> str:
    """Return a block of lines without blank ones, filled to the width of a page."""
    items: list[list[str]] = []
    for line in block.splitlines():
        indent = len(line) - len(line.lstrip())
        before = len(items[-1][0]) - len(items[-1][0].lstrip()) if items else -1
        begins = _ITEM.match(line) or line.lstrip().startswith(('"""', "---", "$$"))
        after_rule = items and items[-1][0].lstrip().startswith(("---", "$$"))
        if begins or after_rule or indent < before or not items:
            items.append([line])
        else:
            items[-1].append(line)
    return "\n".join(_filled_item(item) for item in items)


_ITEM = re.compile(r"\s+\w[\w, ]* : ")


def _filled_item(lines: Sequence[str]) -> str:
    """Return the lines of one item or paragraph, filled."""
    first = lines[0]
    indent = " " * (len(first) - len(first.lstrip()))
    if len(lines) == 1 and len(first) <= WIDTH:
        return first
    return textwrap.fill(
        " ".join(line.strip() for line in lines),
        WIDTH,
        initial_indent=indent,
        subsequent_indent=indent + " " * 4 if _ITEM.match(first) else indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _signature(source: str, name: str) -> list[str]:
    for node in ast.parse(source).body:
        if isinstance(node, ast.FunctionDef) and node.name == name:
            return [argument.arg for argument in node.args.args]
    raise ValueError(f"the solution defines no {name}")


def _wraps(of: Sequence[Knob], values: Values, names: Sequence[str]) -> str:
    """Return code that turns the known mistakes of the book's exercise into those of the variant."""
    expressions = {
        knob.name: knob.wrap[column - 1]
        for knob in of
        if knob.wrap and (column := knob.column(values[knob.name])) > 0
    }
    code = ""
    for name, expression in expressions.items():
        if not expression:
            continue
        indented = textwrap.indent(textwrap.dedent(expression).strip(), " " * 12)
        code += f'''

def _with_{name}(mistake):
    """Return the mistake where this detail differs from the book."""

    @functools.wraps(mistake)
    def variant({", ".join(names)}):
        arguments = ({", ".join(names)},)
        return (
{indented}
        )

    return variant


for _name, _mistake in list(globals().items()):
    if inspect.isfunction(_mistake) and not _name.startswith("_"):
        globals()[_name] = _with_{name}(_mistake)
'''
    return f"\n\nimport functools\nimport inspect\n{code}" if code else ""


def _as_in_the_book(exercise: Exercise, knob: Knob, hint: str, source: str) -> str:
    """Return a known mistake: what answers the variant but for one knob, which has the book's value."""
    lines = source.splitlines()[ast.parse(source).body[0].end_lineno or 0 :]
    body = textwrap.indent("\n".join(lines).strip(), " " * 4)
    return f'''

def _{knob.name}_as_in_the_book():
{body}

    return {exercise.name}


def {knob.name}_as_in_the_book(*arguments):
    """{hint}"""
    return _{knob.name}_as_in_the_book()(*arguments)
'''


def _pairs(values: Mapping[str, str]) -> set[tuple[Any, ...]]:
    """Return all pairs of a combination's values, with their knobs."""
    items = sorted(values.items())
    return set(itertools.combinations(items, 2)) or set(items)


def _tuples(value: Any) -> Any:
    """Return tables with tuples instead of lists."""
    if isinstance(value, dict):
        return {key: _tuples(part) for key, part in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def product(of: Sequence[Knob]) -> int:
    """Return how many variants an exercise with these knobs has, the book's included.

    Examples
    --------
    >>> product([Knob(k, ("a", "b"), ("?",)) for k in "xyz"])
    8
    """
    return math.prod(len(knob.values) for knob in of)
