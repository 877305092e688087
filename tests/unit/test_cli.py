"""The command's own options and its help, which users read."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from robonav import __version__
from robonav.cli import app

COMMANDS = [
    "check",
    "grade",
    "reproduce",
    "navigate",
    "leaderboard",
    "exercises",
    "drills",
    "gradebook",
]


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


def test_json_goes_to_standard_output_alone(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = ["navigate", "--method", "straight", "--worlds", "3", "--json", "-"]
    done = CliRunner().invoke(app, arguments)
    assert json.loads(done.stdout)["method"] == "straight"
    assert "% arrive in 3 worlds" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["none.safetensors", "none.py"])
def test_a_missing_file_of_a_method_is_said_to_be_missing(name) -> None:
    done = CliRunner().invoke(app, ["navigate", "--method", name])
    assert str(done.exception) == f"method must name a file that exists, got {name!r}"


@pytest.mark.parametrize("arguments", [[], ["--list"], ["--method", "straight"]])
def test_a_number_of_worlds_below_1_is_one_sentence(arguments) -> None:
    done = CliRunner().invoke(app, ["navigate", *arguments, "--worlds", "0"])
    assert str(done.exception) == "worlds must be at least 1, got 0"
    assert done.output == ""
