"""Node, which runs the JavaScript of the widgets.

One Node process serves all tests of a test process, because a start of Node takes longer than most questions. No
question can change what another one finds: ``questions.mjs`` says why.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from robonav.widgets.shared import front_end

QUESTIONS = Path(__file__).with_name("questions.mjs")
SECONDS = 600
"""A question that takes longer hangs."""

Ask = Callable[[str, str, Any], Any]


@pytest.fixture(scope="session")
def ask() -> Iterator[Ask]:
    """Run the body of a function in Node with the exports of a module's text and with data; return what it returns."""
    program = shutil.which("node")
    if program is None:
        pytest.skip("Node is not installed")
    command = [program, "--experimental-vm-modules", "--no-warnings", str(QUESTIONS)]
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8") as errors,
        subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            encoding="utf-8",
        ) as process,
    ):

        def ask(module: str, body: str, data: Any) -> Any:
            question = json.dumps({"module": module, "body": body, "data": data})
            alarm = threading.Timer(SECONDS, process.kill)
            alarm.start()
            try:
                print(question, file=process.stdin, flush=True)
                line = process.stdout.readline()
            finally:
                alarm.cancel()
            if not line:
                errors.seek(0)
                pytest.fail(f"Node ended without an answer: {errors.read()}")
            answer = json.loads(line)
            assert "failure" not in answer, answer["failure"]
            return answer["result"]

        yield ask


@pytest.fixture
def node(ask: Ask) -> Callable[[str | Sequence[str], str, Any], Any]:
    """Run a few lines of JavaScript with the exports of a widget or of several files, and with some data."""

    def run(widget: str | Sequence[str], body: str, data: Any) -> Any:
        names = (widget,) if isinstance(widget, str) else widget
        return ask(front_end(*names), body, data)

    return run
