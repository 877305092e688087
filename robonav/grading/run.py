"""One grading run inside pytest: fixtures for the parts, states from their outcomes, and the grade at the end."""

from __future__ import annotations

import json
from collections.abc import Generator
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from robonav.atomic import write_text

from . import sandbox_check, submission
from .cases import generator, outcome, secret_from, seed_of
from .check import remarks, with_public_feedback
from .course import Course, Exercise
from .evidence import Evidence
from .grade import Part, exercise_grade, grade
from .reference import reference
from .session import Answer, Session


class Run:
    """One grading run: the plugin that is registered when a submission is given.

    Parameters
    ----------
    config : pytest.Config
        The configuration of pytest, with the grader's options.

    Raises
    ------
    pytest.UsageError
        If an exercise is unknown, the submission or the secret cannot be read, or marks are asked for where no sandbox
        works.
    """

    def __init__(self, config: pytest.Config) -> None:
        if config.getoption("grade_json"):
            Path(config.getoption("grade_json")).unlink(missing_ok=True)
        paths = [Path(argument.partition("::")[0]) for argument in config.args]
        try:
            self.course = Course.around(*paths)
            self.only = {
                self.course.named(key).id for key in config.getoption("exercise")
            }
            loaded = submission.load_submission(config.getoption("submission"))
            secret = secret_from(config.getoption("secret"))
        except ValueError as error:
            raise pytest.UsageError(str(error)) from None
        tier = config.getoption("tier") or sandbox_check.best()
        if secret and tier == "practice":
            raise pytest.UsageError(
                f"no marks in the practice tier: {sandbox_check.fault('official')}"
            )
        digest = "" if isinstance(loaded, submission.Refused) else loaded.digest
        self.loaded, self.secret = loaded, bool(secret)
        self.seed = seed_of(secret or b"", digest)
        self.session = Session(loaded, tier)
        self.entries: list[dict[str, Any]] = []  # when all parts have run
        self.reference = reference(self.course)
        self.parts: dict[str, list[Part]] = {}
        self.evidence: dict[str, Evidence] = {}
        if (
            self.course.tests in [path.resolve() for path in paths]
            and not config.option.keyword
        ):
            self.parts = {
                id: []
                for id in self.course.exercises
                if not self.only or id in self.only
            }

    @pytest.fixture
    def answer(self, request: pytest.FixtureRequest) -> Answer:
        """The student's function."""
        exercise, _ = self._exercise(request.node)
        if exercise.id not in self.evidence:
            names = self.course.parameters(exercise)
            self.evidence[exercise.id] = Evidence(self.reference, names)
        evidence = self.evidence[exercise.id]
        return Answer(self.session, evidence, exercise, request.node.name)

    @pytest.fixture
    def rng(self, request: pytest.FixtureRequest) -> np.random.Generator:
        """The random generator of this part, from the secret or the public seed."""
        return generator(self.seed, request.node.name)

    def _exercise(self, item: pytest.Item) -> tuple[Exercise, int]:
        """Return the exercise that a test belongs to, and the test's points."""
        marker = item.get_closest_marker("part")
        if marker is None:
            raise pytest.UsageError(
                f"{item.nodeid} must say which exercise it is a part of"
            )
        return self.course.exercises[marker.args[0]], marker.kwargs["points"]

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Keep the requested exercises, and let ``-k`` find them by name and id."""
        for item in items:
            exercise, _ = self._exercise(item)
            item.extra_keyword_matches.update({exercise.id, exercise.name})
        items[:] = [
            item
            for item in items
            if not self.only or self._exercise(item)[0].id in self.only
        ]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Record the points of a part, and replace the traceback in the report by the feedback."""
        report = yield
        if call.when == "call" or call.excinfo is not None:
            exercise, points = self._exercise(item)
            test = cast(pytest.Function, item).function
            error = call.excinfo.value if call.excinfo else None
            part = outcome(test, points, error, secret=self.secret)
            self.parts.setdefault(exercise.id, []).append(part)
            if part.state not in ("correct", "grader-fault"):
                # The traceback would show the grader's own code.
                report.longrepr = part.feedback
        return report

    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        """Stop the sandbox, and write the grade file if one is asked for and the run was complete."""
        self.session.close()
        self.entries = self._graded()
        if session.config.getoption("grade_json") and exitstatus in (
            pytest.ExitCode.OK,
            pytest.ExitCode.TESTS_FAILED,
        ):
            grade = json.dumps(self.grade(), indent=1, ensure_ascii=False)
            write_text(session.config.getoption("grade_json"), grade)

    def grade(self) -> dict[str, Any]:
        """Return the grade of all requested exercises."""
        said = remarks(self.loaded, self.session)
        return grade(self.entries, self.session.tier) | said

    def _graded(self) -> list[dict[str, Any]]:
        """Return the entries of all requested exercises in the manifest's order, with their feedback."""
        exercises, tier = self.course.exercises, self.session.tier
        in_order = sorted(self.parts, key=list(exercises).index)
        if self.secret:
            entries = [exercise_grade(exercises[id], self.parts[id]) for id in in_order]
            return with_public_feedback(self.course, entries, self.loaded, tier)
        known = {id: self.evidence.get(id, Evidence(self.reference)) for id in in_order}
        return [
            exercise_grade(exercises[id], known[id].explained(self.parts[id]))
            for id in in_order
        ]

    def pytest_terminal_summary(
        self, terminalreporter: pytest.TerminalReporter
    ) -> None:
        """Print the points and the state of each exercise."""
        result = self.grade()
        terminalreporter.section(
            f"{result['points']} of {result['max_points']} points ({result['tier']} sandbox)"
        )
        for problem in result["problems"]:
            terminalreporter.line(f"Not taken: {problem}.")
        for entry in result["exercises"]:
            points = "?" if entry["points"] is None else entry["points"]
            title = self.course.exercises[entry["id"]].title
            terminalreporter.line(
                f"{entry['id']}  {points}/{entry['max_points']}  {entry['state']:12}  {title}"
            )
            lines = map(str.strip, entry["feedback"].splitlines())
            for hint in dict.fromkeys(x for x in lines if x.startswith("Hint: ")):
                terminalreporter.line(f"      {hint}")
