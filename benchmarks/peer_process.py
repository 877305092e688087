"""A peer that is timed in a virtual environment of its own."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

SCRIPTS = Path(__file__).parent / "peers"


def printed_by_peer(
    folder: Path, environment: str, script: str, *options: str
) -> float:
    """Run a script of ``peers`` in one of the virtual environments of a folder; its last line is a number."""
    return float(lines_of_peer(folder, environment, script, *options)[-1])


def lines_of_peer(
    folder: Path, environment: str, script: str, *options: str
) -> list[str]:
    """Run a script of ``peers`` in one of the virtual environments of a folder, and return what it printed."""
    command = [
        str(folder / environment / "bin" / "python"),
        str(SCRIPTS / script),
        *options,
    ]
    quiet = os.environ | {"PYTHONWARNINGS": "ignore"}
    shown = subprocess.run(
        command, capture_output=True, text=True, check=True, env=quiet
    )
    return shown.stdout.strip().splitlines()
