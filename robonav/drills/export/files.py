"""Write question banks and exams to files, whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path

from robonav import atomic

FORMATS = {".xml": "moodle", ".zip": "qti", ".pdf": "pdf"}


def format_of(path: Path, wanted: str = "") -> str:
    """Return the format that a file gets: the one wanted, or else the one that its name tells.

    Parameters
    ----------
    path : Path
    wanted : str, optional
        "moodle", "qti" or "pdf".

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If there is no such format, or if the name tells none.

    Examples
    --------
    >>> format_of(Path("bank.xml")), format_of(Path("exam"), "pdf")
    ('moodle', 'pdf')
    """
    known = ", ".join(FORMATS.values())
    if wanted and wanted not in FORMATS.values():
        raise ValueError(f"format must be one of {known}, got {wanted}")
    if not wanted and path.suffix not in FORMATS:
        raise ValueError(
            f"name a format ({known}), or end the file's name in one of {', '.join(FORMATS)}"
        )
    return wanted or FORMATS[path.suffix]


def check_installed(kind: str) -> None:
    """Raise an error if a package is missing that a format needs.

    Parameters
    ----------
    kind : str
        "moodle", "qti" or "pdf".

    Raises
    ------
    ValueError
        If one is missing.

    Examples
    --------
    >>> check_installed("moodle")
    """
    needed = [
        "markdown_it",
        "mdit_py_plugins",
        *(["reportlab"] if kind == "pdf" else []),
    ]
    missing = [name for name in needed if find_spec(name) is None]
    if missing:
        raise ValueError(
            f"{' and '.join(missing)} is not installed: pip install 'robonav-book[exams]'"
        )


def beside(path: Path, word: str) -> Path:
    """Return the name of a file that belongs to another, with a word at the end.

    Examples
    --------
    >>> beside(Path("exam.pdf"), "solutions").name
    'exam-solutions.pdf'
    """
    return path.with_name(f"{path.stem}-{word}{path.suffix}")


def check_free(*paths: Path, force: bool) -> None:
    """Raise an error if a file exists and may not be written over, or if its name is a folder's.

    Parameters
    ----------
    *paths : Path
    force : bool
        Whether files may be written over.

    Raises
    ------
    ValueError
        If one of them is in the way.

    Examples
    --------
    >>> check_free(Path("no-such-file.pdf"), force=False)
    """
    for path in paths:
        if path.is_dir():
            raise ValueError(f"{path} is a folder, not a file to write")
        if path.exists() and not force:
            raise ValueError(f"{path} exists; to write over it, add --force")


def write(contents: Mapping[Path, bytes]) -> None:
    """Write files. Each appears complete or not at all.

    Parameters
    ----------
    contents : mapping of Path to bytes

    Raises
    ------
    ValueError
        If a folder cannot be made, or a file cannot be written in it.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> write({folder / "bank.xml": b"<quiz/>"})
    >>> (folder / "bank.xml").read_bytes()
    b'<quiz/>'
    """
    for path, content in contents.items():
        try:
            with atomic.atomic_write(path) as file:
                file.write(content)
        except OSError as error:
            raise ValueError(f"{path} cannot be written: {error.strerror}") from error
