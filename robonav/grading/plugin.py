"""The pytest plugin: ``pytest tests/exercises --submission DIR`` grades one submission.

A test is one part of an exercise, ``@pytest.mark.part("2.1", points=2)``, with the fixtures ``answer`` (the student's
function, in the sandbox) and ``rng``; its docstring says what it asks for. Only trusted code runs in this process, in a
clean environment: started in any other, the command starts itself again in one.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Generator, Sequence
from pathlib import Path

import pytest

KEPT = ("HOME", "LANG", "LC_ALL", "PATH", "ROBONAV_SECRET", "SYSTEMROOT", "TERM", "TMPDIR", "TEMP")
SECRET = "ROBONAV_SECRET"
CLEAN = "ROBONAV_GRADER_IS_CLEAN"


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("robonav", "grading a submission to the book's exercises")
    group.addoption("--submission", metavar="PATH", help="the folder, zip or notebook to grade")
    group.addoption("--grade-json", metavar="FILE", help="write points, states and feedback there")
    group.addoption(
        "--secret", metavar="FILE", help=f"draw the cases from its content, not the public ones; or ${SECRET}"
    )
    group.addoption("--tier", choices=["official", "restricted", "practice"], help="the sandbox; the best by default")
    group.addoption(
        "--exercise", metavar="ID", action="append", default=[], help="grade this one only; may be repeated"
    )


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_load_initial_conftests(early_config: pytest.Config) -> Generator[None]:
    """Before anything else is read that lies about: start again in a clean environment, unless this is one."""
    if early_config.known_args_namespace.submission and CLEAN not in os.environ:
        arguments = early_config.invocation_params.args
        raise SystemExit(subprocess.run(command(arguments, Path.cwd()), env=environment()).returncode)
    return (yield)


def command(arguments: Sequence[str], *starts: Path) -> list[str]:
    """Pytest on the course around ``starts``, reading neither configuration nor plugins of anybody else's."""
    from robonav.grading.course import Course

    tests = str(Course.around(*starts).tests)
    isolated = [sys.executable, "-I", "-m", "pytest", "-c", os.path.join(tests, "pytest.ini")]
    return [*isolated, "--rootdir", tests, "--confcutdir", tests, *arguments]


def environment() -> dict[str, str]:
    """The few variables that the grader keeps."""
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    return {**kept, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", CLEAN: "1"}


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "part(exercise, points): a part of an exercise and what it is worth")
    if config.getoption("submission"):
        from robonav.grading.run import Run

        config.pluginmanager.register(Run(config), "robonav-grading-run")
