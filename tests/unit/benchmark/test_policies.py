"""Methods by name and from a reader's files; the commands that drive and reproduce."""

import json

import pytest
from typer.testing import CliRunner

from robonav.benchmark.policies import evaluate, method, methods
from robonav.cli import app, main
from robonav.networks import Weights, save_weights
from robonav.networks.multilayer_perceptron import random_network
from robonav.robot import (
    Encoder,
    Reflex,
    navigate,
    random_worlds,
    turn_to_clearer_side,
)

OWN = "import numpy as np\n\ndef policy(sensing, rng):\n    return np.where(sensing.ranges[:, 0] < 6, 2, 0)\n"


def test_every_named_method_drives():
    assert {"straight", "freer-side"} <= set(methods())
    for name in methods():
        result = evaluate(name, obstacles=5, moving=1, speed=2.0, worlds=3, seed=1)
        assert sum(result["outcomes"].values()) == 3


def test_an_episode_is_navigate():
    result = evaluate(
        "freer-side", obstacles=20, moving=0, speed=2.0, worlds=50, seed=7
    )
    expected = navigate(turn_to_clearer_side, random_worlds(50, 20, seed=7))
    assert result["success"] == expected.success.mean()
    low, high = result["interval"]
    assert low < result["success"] < high


@pytest.mark.parametrize("direction", ["sector", "exact"])
def test_an_episode_takes_and_names_the_reflex(direction):
    done = run(
        "navigate", "--method", "freer-side", "--obstacles", "20", "--seed", "7", "--json", "-",
        *(["--reflex", direction] if direction == "exact" else []),
    )  # fmt: skip
    expected = navigate(
        turn_to_clearer_side, random_worlds(200, 20, seed=7), reflex=Reflex(direction)
    )
    result = json.loads(done.stdout)
    assert (result["reflex"], result["success"]) == (direction, expected.success.mean())
    assert f"reflex: {direction}" in done.stderr


def test_a_readers_own_code_and_weights(tmp_path):
    (tmp_path / "own.py").write_text(OWN)
    assert callable(method(str(tmp_path / "own.py")))
    encoder = Encoder()
    weights = Weights(
        random_network((encoder.size, 5), seed=0), "own", encoder, temperature=0.4
    )
    save_weights(tmp_path / "own.safetensors", weights)
    policy = method(str(tmp_path / "own.safetensors"))
    assert (policy.encoder, policy.temperature) == (encoder, 0.4)


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("x = 1", "must define policy"),
        ("1 / 0", "does not run: ZeroDivisionError"),
        ("def", "does not run: SyntaxErr"),
    ],
)
def test_code_without_a_policy_is_refused_with_a_sentence(tmp_path, code, message):
    (tmp_path / "own.py").write_text(code)
    with pytest.raises(ValueError, match=message):
        method(str(tmp_path / "own.py"))


def test_unknown_methods_are_refused_naming_those_there_are():
    with pytest.raises(ValueError, match="method must be one of straight, freer-side"):
        method("telepathy")


def run(*arguments):
    return CliRunner().invoke(app, arguments)


def test_the_navigate_command(tmp_path):
    settings = [
        "--obstacles",
        "20",
        "--moving",
        "0",
        "--speed",
        "2",
        "--worlds",
        "20",
        "--seed",
        "7",
    ]
    done = run(
        "navigate",
        "--method",
        "straight",
        *settings,
        "--json",
        str(tmp_path / "out.json"),
    )
    assert done.exit_code == 0, done.output
    assert "% arrive in 20 worlds" in done.output
    got = json.loads((tmp_path / "out.json").read_text())
    assert got["method"] == "straight"
    assert got["outcomes"]["arrived"] == round(20 * got["success"])


@pytest.mark.slow
def test_the_reproduce_command(tmp_path):
    assert "baselines" in run("reproduce", "--list").output
    done = run(
        "reproduce",
        "baselines",
        "--out",
        str(tmp_path),
        "--jobs",
        "1",
        "--json",
        str(tmp_path / "y.json"),
    )
    assert done.exit_code == 0, done.output
    (got,) = json.loads((tmp_path / "y.json").read_text())
    assert len(got["cases"]) == 10
    assert 25 <= got["cases"][0]["metrics"]["success"]["mean"] <= 50
    assert {p.name for p in tmp_path.glob("baselines.*")} >= {
        "baselines.csv",
        "baselines.svg",
        "baselines.png",
    }


@pytest.mark.parametrize(
    "arguments",
    [
        ["navigate", "--method", "straight", "--speed", "0"],
        ["navigate", "--method", "straight", "--worlds", "0"],
        ["navigate", "--method", "straight", "--reflex", "north"],
        ["reproduce", "table-9.9"],
        ["reproduce", "baselines", "--json", "/dev/null/y.json"],
        ["navigate", "--method", "straight", "--json", "/dev"],
    ],
)
def test_a_wrong_input_is_one_line_and_exit_code_two(monkeypatch, capsys, arguments):
    monkeypatch.setattr("sys.argv", ["robonav", *arguments])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 2
    said = capsys.readouterr().err.strip()
    assert said.startswith("robonav: ")
    assert "\n" not in said
