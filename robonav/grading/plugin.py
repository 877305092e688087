"""The pytest plugin: ``pytest tests/exercises --submission DIR`` grades one submission.

The plugin is opt-in: ``tests/exercises/pytest.ini`` loads it with ``-p robonav.grading.plugin``. A test is one part
of an exercise, ``@pytest.mark.part("2.1", points=2)``. Its fixtures are ``answer`` (the student's function, in the
sandbox) and ``rng``, and its docstring tells the student what the part asks for. Only trusted code runs in this
process, and only with few environment variables. With more than those, the command starts itself again without them.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Generator, Sequence
from pathlib import Path

import pytest

KEPT = (
    "HOME",
    "LANG",
    "LC_ALL",
    "PATH",
    "ROBONAV_SECRET",
    "SYSTEMROOT",
    "TERM",
    "TMPDIR",
    "TEMP",
)
CLEAN = "ROBONAV_GRADER_IS_CLEAN"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the grader's options to the pytest command."""
    group = parser.getgroup("robonav", "grading a submission to the book's exercises")
    group.addoption(
        "--submission", metavar="PATH", help="the folder, zip file or notebook to grade"
    )
    group.addoption(
        "--grade-json",
        metavar="FILE",
        help="write points, states and feedback to this file",
    )
    group.addoption(
        "--secret",
        metavar="FILE",
        help="a file whose content seeds the cases; ROBONAV_SECRET does the same",
    )
    group.addoption(
        "--tier",
        choices=["official", "restricted", "practice"],
        help="the sandbox tier; the default is the strictest that works",
    )
    group.addoption(
        "--exercise",
        metavar="ID",
        action="append",
        default=[],
        help="grade only this exercise; may be repeated",
    )


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_load_initial_conftests(early_config: pytest.Config) -> Generator[None]:
    """Restart with a clean environment before pytest reads a configuration or conftest of somebody else."""
    known = early_config.known_args_namespace
    if known.submission and CLEAN not in os.environ:
        from .course import Course

        # The tests named on the command line, or the tests of this package: a submission may contain tests of its own.
        tests = Course.around(
            *[Path(name.partition("::")[0]) for name in known.file_or_dir]
        ).tests
        arguments = [
            *early_config.invocation_params.args,
            *([] if known.file_or_dir else [str(tests)]),
        ]
        raise SystemExit(
            subprocess.run(command(tests, arguments), env=environment()).returncode
        )
    return (yield)


def command(tests: Path, arguments: Sequence[str]) -> list[str]:
    """Return a pytest command that reads only the course's own configuration and plugins."""
    isolated = [sys.executable, "-I", "-m", "pytest", "-c", str(tests / "pytest.ini")]
    return [*isolated, "--rootdir", str(tests), "--confcutdir", str(tests), *arguments]


def environment() -> dict[str, str]:
    """Return the few environment variables that the grader keeps."""
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    return {**kept, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", CLEAN: "1"}


def pytest_configure(config: pytest.Config) -> None:
    """Declare the marker ``part``, and start the grading run if a submission is given."""
    config.addinivalue_line(
        "markers", "part(exercise, points): a part of an exercise and its points"
    )
    if config.getoption("submission"):
        from .run import Run

        config.pluginmanager.register(Run(config), "robonav-grading-run")
