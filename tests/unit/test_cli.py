"""The command's own options and its help, which users read."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from robonav import __version__
from robonav.cli import app

COMMANDS = ["check", "grade", "reproduce", "navigate", "leaderboard", "exercises"]


def output(*arguments: str) -> str:
    done = CliRunner().invoke(app, list(arguments))
    assert done.exit_code == 0
    return done.output


def test_version() -> None:
    assert output("--version") == f"robonav {__version__}\n"


def test_help_is_for_users() -> None:
    text = output("--help")
    assert "reinforcement learning" in " ".join(text.split())
    assert "import" not in text.replace("important", "")
    assert all(command in text for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_command(command: str) -> None:
    assert "Usage:" in output(command, "--help")
