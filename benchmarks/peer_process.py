"""A peer that is timed in a virtual environment of its own, and the options that name it."""

from __future__ import annotations

import argparse
import os
import subprocess
from pathlib import Path

SCRIPTS = Path(__file__).parent / "peers"


def parser_with_peers(description: str | None) -> argparse.ArgumentParser:
    """The command line of a script that runs peers beside ours."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--peers", type=Path, help="folder with the peers' virtual environments"
    )
    return parser


def add_processor_clock(parser: argparse.ArgumentParser) -> None:
    """Add the option for a machine that others use too."""
    parser.add_argument(
        "--cpu", action="store_true", help="count seconds of the processor"
    )


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
