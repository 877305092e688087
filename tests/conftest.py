"""Settings of all tests.

With the option ``--no-skips``, a test that would be skipped fails instead. With ``--rerun-browser``, a test in a
browser that fails runs once more, and counts as failed only if it fails again; the option ``-r R`` lists these tests.
The name of a test that fails is printed at once, so that a run which is cut off has told what it found. Hypothesis
tries 100 examples of each property, and 20 with its profile ``quick``, which ``make check`` uses. Examples have no
deadline, because a slow or busy machine would miss it.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Generator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

settings.register_profile("thorough", deadline=None)
settings.register_profile("quick", max_examples=20, deadline=None)
settings.load_profile("thorough")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(
    config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Begin with the tests marked long. The others keep their order, so that tests of one fixture are together.

    With the option, each test in a browser may run twice.
    """
    items.sort(key=lambda item: item.get_closest_marker("long") is None)
    if config.getoption("--rerun-browser"):
        for item in items:
            if item.get_closest_marker("browser"):
                item.add_marker(pytest.mark.flaky(reruns=1))


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--no-skips",
        action="store_true",
        help="a test that would be skipped fails instead",
    )
    parser.addoption(
        "--rerun-browser",
        action="store_true",
        help="a test in a browser that fails runs once more",
    )


def _refuse_skip(report: Any, config: pytest.Config) -> None:
    if (
        report.skipped
        and not hasattr(report, "wasxfail")
        and config.getoption("--no-skips")
    ):
        reason = (
            report.longrepr[2]
            if isinstance(report.longrepr, tuple)
            else report.longrepr
        )
        report.outcome = "failed"
        report.longrepr = (
            f"{report.nodeid}: skipped where no skip is allowed ({reason})"
        )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    _refuse_skip(report, item.config)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    _refuse_skip(report, collector.config)
    return report


class FailuresAtOnce:
    """Prints the name of each test that fails when it fails, and not only at the end."""

    def __init__(self, reporter: pytest.TerminalReporter) -> None:
        self.reporter = reporter

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Print the name of a failed test."""
        if report.failed:
            self.reporter.ensure_newline()
            self.reporter.write_line(f"FAILED {report.nodeid}")


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Let the garbage collector pass over what the tests are made of: it would look at it again and again in vain."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.fixture
def page_text() -> Callable[[str], str]:
    """The source of a page of the book by its name. Without the book the test is skipped."""
    book = Path(__file__).parents[1] / "book"
    if not book.is_dir():
        pytest.skip("the book is not here")
    return lambda page: (book / f"{page}.md").read_text("utf-8")


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    if reporter is not None:
        config.pluginmanager.register(FailuresAtOnce(reporter))
