"""Node, which runs the JavaScript of the widgets."""

import json
import shutil
import subprocess

import pytest

from robonav.widgets.shared import front_end


@pytest.fixture
def node(tmp_path):
    """Run a few lines of JavaScript with the exports of a widget or of several files, and with some data."""
    program = shutil.which("node")
    if program is None:
        pytest.skip("Node is not installed")

    def run(widget, body, data):
        names = (widget,) if isinstance(widget, str) else widget
        (tmp_path / "widget.mjs").write_text(front_end(*names), "utf-8")
        (tmp_path / "data.json").write_text(json.dumps(data), "utf-8")
        (tmp_path / "run.mjs").write_text(
            'import * as page from "./widget.mjs"; import { readFileSync } from "node:fs";\n'
            'const data = JSON.parse(readFileSync(new URL("data.json", import.meta.url)));\n'
            f"const result = await (() => {{ {body} }})();\nconsole.log(JSON.stringify(result));",
            "utf-8",
        )
        done = subprocess.run(
            [program, tmp_path / "run.mjs"], capture_output=True, text=True, timeout=600
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run
