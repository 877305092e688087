"""The leaderboard: frozen worlds, path lengths against A*'s, a reader's own method on the board."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from robonav.benchmark.leaderboard import (
    DIGESTS,
    SETTINGS,
    Setting,
    board_worlds,
    digest,
    evaluate_on_board,
    shortest_paths,
    spl,
)
from robonav.benchmark.policies import methods
from robonav.cli import app, main
from robonav.experiments.leaderboard import board
from robonav.lfd import plan_on_grid
from robonav.robot import Reflex, navigate, turn_to_clearer_side

OWN = """from robonav.robot import turn_to_clearer_side as rule

def policy(sensing, rng):
    return rule(sensing, rng)
"""


@pytest.mark.parametrize("setting", DIGESTS)
def test_the_worlds_are_frozen(setting):
    assert digest(setting) == DIGESTS[setting]


def test_every_setting_drives_in_frozen_worlds():
    frozen = {(SETTINGS[name].obstacles, SETTINGS[name].moving) for name in DIGESTS}
    assert {
        (setting.obstacles, setting.moving) for setting in SETTINGS.values()
    } == frozen


def test_worlds_of_a_setting_are_the_same_for_every_scale():
    few, many = board_worlds("20 obstacles", 3, 5), board_worlds("20 obstacles", 3, 9)
    np.testing.assert_array_equal(few.centres, many.centres[:5])


def test_spl_by_hand():
    """Two arrivals, one by the shortest way and one by a way twice as long; one failure; one shorter than A*'s."""
    success, driven = (
        np.array([True, True, False, True]),
        np.array([100.0, 200.0, 100.0, 80.0]),
    )
    assert spl(success, driven, np.full(4, 100.0)) == pytest.approx(
        (1 + 0.5 + 0 + 1) / 4
    )


def test_shortest_ways_end_where_the_robot_arrives():
    worlds = board_worlds("10 obstacles", 1, 4)
    expected = [plan_on_grid(worlds[i], margin=2.0).length - 3 for i in range(4)]
    np.testing.assert_allclose(shortest_paths(10, 1, 4), expected)


def test_an_entry_is_navigate_with_the_reflex_of_the_board():
    worlds = board_worlds("20 obstacles", 2, 20)
    episodes = navigate(turn_to_clearer_side, worlds, seed=2, reflex=Reflex("exact"))
    numbers = evaluate_on_board("freer-side", "20 obstacles", 2, 20)
    assert numbers["success"] == 100 * episodes.success.mean()
    assert sum(
        numbers[key] for key in ("success", "collision", "out of steps")
    ) == pytest.approx(100)
    lengths, shortest = 2.0 * episodes.steps, shortest_paths(20, 2, 20)
    expected = 100 * spl(episodes.success, lengths, shortest)
    assert numbers["SPL"] == pytest.approx(expected)
    assert 0 < numbers["SPL"] < numbers["success"]


def test_noise_slip_and_speed_reach_the_simulator():
    """Each makes another robot of the same rule in the same worlds."""
    found = {
        name: evaluate_on_board("freer-side", name, 0, 20)["SPL"]
        for name, setting in SETTINGS.items()
        if setting.obstacles == 20
    }
    assert len(set(found.values())) == len(found)
    assert (
        SETTINGS["20 obstacles"]
        == Setting(20)
        == dataclasses.replace(SETTINGS["20, 1 m/s"], speed=2.0)
    )


@pytest.mark.slow
def test_a_readers_method_stands_on_the_board(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(OWN)
    arguments = [
        "leaderboard",
        "mine.py",
        "freer-side",
        "--scale",
        "quick",
        "--json",
        "board.json",
    ]
    shown = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert shown.exit_code == 0
    mine, rule = [
        line
        for line in shown.stdout.splitlines()
        if line.startswith(("| mine.py", "| freer side"))
    ]
    assert mine.split("|")[2:] == rule.split("|")[2:]
    cases = json.loads((tmp_path / "board.json").read_text())[0]["cases"]
    assert len(cases) == 2 * len(SETTINGS)


def test_the_pages_example_beats_going_straight():
    example = Path(__file__).parents[3] / "book" / "_static" / "my_method.py"
    own, straight = (
        evaluate_on_board(name, "20 obstacles", 0, 20)["success"]
        for name in (str(example), "straight")
    )
    assert own > straight


def test_results_hang_on_the_file_of_a_method(tmp_path):
    """Another network under the same name is another experiment: nothing of the old one is kept."""
    path = tmp_path / "mine.py"
    path.write_text(OWN)
    before = board([str(path)]).settings["methods"]
    path.write_text(OWN + "\n# changed\n")
    assert board([str(path)]).settings["methods"] != before
    assert set(board(methods()).settings["methods"]) == set(methods())


def test_an_unknown_method_is_one_line(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["robonav", "leaderboard", "nobody"])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 2
    assert "method must be one of" in capsys.readouterr().err
