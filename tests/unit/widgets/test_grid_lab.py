"""The grid lab: its data, its JavaScript under Node, and what it answers a map drawn by the reader."""

import json

import numpy as np
import pytest

from robonav import mdp
from robonav.plots.mdp import colour_of_value
from robonav.widgets.grid_lab import Replay, grid_lab, replay

LAB = ("grid", "grid_lab")
MAP = "S . # .\n. . . G\n. . # X"


def solved(grid, discount=0.9):
    """The replay of value iteration on a grid."""
    model = grid.mdp(discount)
    swept = mdp.value_iteration(model, 0.1, record=True)
    best = mdp.policy_iteration(model).values
    steps = [f"sweep {k}" for k in range(len(swept.history))]
    return replay(model, swept.history, swept.policies, best=best, steps=steps)


@pytest.fixture
def grid():
    return mdp.GridWorld(MAP, slip=0.2)


def test_a_replay_says_how_far_each_frame_is_from_the_best(grid):
    model, shown = grid.mdp(0.9), solved(grid)
    best = mdp.policy_iteration(model).values
    assert shown.said[0].startswith(
        f"sweep 0: values off by up to {abs(best).max():.3g}, "
    )
    lost = (best - mdp.policy_evaluation(model, shown.policies[0])).max()
    assert shown.said[0].endswith(f"the arrows lose up to {lost:.3g}")
    assert shown.said[-1].endswith("arrows optimal")
    exact = replay(
        model,
        [best],
        [mdp.policy_iteration(model).policy],
        best=best,
        steps=["the best"],
    )
    assert exact.said == ["the best: values exact, arrows optimal"]


def test_a_replay_of_another_length_is_refused(grid):
    model = grid.mdp(0.9)
    frames = np.zeros((2, grid.n_states)), np.zeros((2, grid.n_states), dtype=int)
    best = np.zeros(grid.n_states)
    with pytest.raises(ValueError, match="values must have shape"):
        replay(model, *frames, best=best, steps=["one"])
    with pytest.raises(
        ValueError, match="trajectories must be as many as steps, 2, got 1"
    ):
        replay(model, *frames, best=best, steps=["one", "two"], trajectories=[[0, 1]])


def test_the_lab_holds_every_combination(grid):
    other = mdp.GridWorld("..G")
    controls = {"discount": ["0.5", "0.9"]}
    grids = {"wide": grid, "narrow": other}
    runs = {
        (name, d): {"sweeps": solved(grids[name], float(d))}
        for name in grids
        for d in controls["discount"]
    }
    lab = grid_lab(grids, controls, runs, start=("narrow", "0.9"))
    assert [control["label"] for control in lab.data["controls"]] == ["map", "discount"]
    assert [control["value"] for control in lab.data["controls"]] == [1, 1]
    assert [run[0]["values"]["shape"][1] for run in lab.data["runs"]] == [10, 10, 3, 3]
    assert lab.data["grids"][0]["ends"] == [6, 9]
    assert lab.data["grids"][0]["rewards"][6] == 1
    with pytest.raises(
        ValueError, match=r"runs must hold replays for \('wide', '0.7'\)"
    ):
        grid_lab(grids, {"discount": ["0.5", "0.7"]}, runs)
    with pytest.raises(ValueError, match="values of sweeps must have shape"):
        grid_lab({"wide": other}, {}, {("wide",): {"sweeps": solved(grid)}})


def test_a_map_of_the_reader_is_solved_or_its_fault_named(grid):
    asked = []

    def solve(drawn, choices):
        asked.append(choices)
        return {"sweeps": solved(drawn)}

    lab = grid_lab(
        {"map": grid},
        {"slip": ["0"]},
        {("map", "0"): {"sweeps": solved(grid)}},
        solve=solve,
    )
    answers = []
    lab.send = answers.append
    lab._answer(lab, {"ask": "kernel"}, [])
    lab._answer(lab, {"ask": "solve", "text": "..G\n...", "choices": ["0"]}, [])
    lab._answer(lab, {"ask": "solve", "text": "..?", "choices": ["0"]}, [])
    assert answers[0] == {"kernel": True}
    assert answers[1]["grid"]["rows"] == ["..G", "..."]
    assert answers[1]["run"][0]["values"]["shape"][1] == 6
    assert asked == [("0",)]
    assert "symbols of the legend" in answers[2]["error"]


def test_the_map_that_the_editor_offers_first_is_solved_as_it_is():
    """It may use symbols that only the page knows, as the exits of the 4 x 3 world."""
    world = mdp.four_by_three()
    seen = []

    def solve(drawn, choices):
        seen.append(drawn)
        return {"sweeps": solved(drawn)}

    lab = grid_lab(
        {"4 x 3": world}, {}, {("4 x 3",): {"sweeps": solved(world)}}, solve=solve
    )
    answers = []
    lab.send = answers.append
    lab._answer(
        lab,
        {
            "ask": "solve",
            "text": "\n".join(lab.data["grids"][0]["rows"]),
            "choices": [],
        },
        [],
    )
    assert answers[0]["grid"] == lab.data["grids"][0]
    np.testing.assert_array_equal(seen[0].terminal, world.terminal)


def test_without_a_solver_nothing_is_solved(grid):
    lab = grid_lab({"map": grid}, {}, {("map",): {"sweeps": solved(grid)}})
    answers = []
    lab.send = answers.append
    lab._answer(lab, {"ask": "kernel"}, [])
    lab._answer(lab, {"ask": "solve", "text": "..G", "choices": []}, [])
    assert answers == [{"kernel": False}]


def test_cells_have_the_colours_of_the_drawings(node):
    shares = [-2, -1, -0.3, 0, 0.01, 0.5, 1]
    seen = node(LAB, "return data.map(page.colourOf);", shares)
    for share, colour in zip(shares, seen, strict=True):
        rgb = [
            int(part)
            for part in colour.removeprefix("rgb(").removesuffix(")").split(",")
        ]
        np.testing.assert_allclose(
            rgb, 255 * np.array(colour_of_value(share)), atol=1.01
        )


def test_numbers_are_short(node):
    values = [0, 0.004, -0.004, -0.5, 1.234, 9.949, 9.96, -12.34, 99.6, -123.4]
    expected = [
        "0.00",
        "0.00",
        "0.00",
        "−0.50",
        "1.23",
        "9.95",
        "10.0",
        "−12.3",
        "100",
        "−123",
    ]
    assert node(LAB, "return data.map(page.short);", values) == expected


def test_the_mark_moves_over_walls_and_stops_at_borders(node, grid):
    body = "return data.moves.map(([state, move]) => page.beside(data.cells, state, move));"
    up, right, down, left = (0, -1), (1, 0), (0, 1), (-1, 0)
    moves = [
        (0, up),
        (0, right),
        (1, right),
        (1, left),
        (7, up),
        (8, right),
        (9, down),
        (2, left),
        (5, up),
    ]
    seen = node(LAB, body, {"cells": grid.cells.tolist(), "moves": moves})
    assert seen == [0, 1, 2, 0, 3, 9, 9, 1, 5]


def test_frames_reach_the_page_and_stay_at_the_end(node, grid):
    shown = solved(grid)
    lab = grid_lab(
        {"map": grid},
        {},
        {("map",): {"sweeps": Replay(shown.values, shown.policies, shown.said)}},
    )
    body = """const { last, at } = page.framesOf(data, 10);
      return [last, [0, 2, last, last + 5].map((f) => { const a = at(f);
        return [[...a.values], [...a.policy], a.said, a.trajectory]; })];"""
    last, frames = node(LAB, body, lab.data["runs"][0][0])
    assert last == len(shown.said) - 1
    for place, (values, policy, said, trajectory) in zip(
        [0, 2, last, last], frames, strict=True
    ):
        np.testing.assert_allclose(values, shown.values[place], atol=1e-6)
        assert policy == shown.policies[place].tolist()
        assert said == shown.said[place]
        assert trajectory == []


def test_trajectories_reach_the_page(grid):
    frames = np.zeros((2, grid.n_states)), np.zeros((2, grid.n_states), dtype=int)
    shown = replay(
        grid.mdp(0.9),
        *frames,
        best=frames[0][0],
        steps=["a", "b"],
        trajectories=[np.array([7, 3, 0]), np.array([7])],
    )
    lab = grid_lab({"map": grid}, {}, {("map",): {"learning": shown}})
    assert lab.data["runs"][0][0]["trajectories"] == [[7, 3, 0], [7]]
    assert json.dumps(lab.data)


LEARN = {
    "ask": "train",
    "run": 3,
    "text": "S . G",
    "learner": "Q-learning",
    "settings": {
        "episodes": 40, "learning_rate": 0.5, "epsilon": 0.1, "discount": 1, "slip": 0, "seed": 2,
    },
}  # fmt: skip


def answers_of(lab, message):
    answers = []
    lab.send = answers.append
    lab._answer(lab, message, [])
    lab._thread.join(timeout=60)
    return answers


@pytest.fixture
def learning_lab():
    grid = mdp.GridWorld(MAP, step_reward=-1)
    runs = {("map",): {"sweeps": solved(grid)}}
    return grid_lab({"map": grid}, {}, runs, learners={"Q-learning": mdp.q_learning})


def test_a_method_learns_on_a_map_of_the_reader(learning_lab):
    *told, last = answers_of(learning_lab, LEARN)
    env = mdp.GridWorld("S . G", step_reward=-1).environment()
    expected = mdp.q_learning(
        env, 40, discount=1.0, learning_rate=0.5, epsilon=0.1, max_steps=500, seed=2
    )
    live = [item for answer in told for item in answer["live"]]
    assert [item["at"] for item in live] == list(range(1, 41))
    means = [expected.returns[max(0, k - 20) : k].mean() for k in range(1, 41)]
    np.testing.assert_allclose([item["earned"] for item in live], means)
    assert told[-1]["done"] == told[-1]["total"] == 40
    (learned,) = learning_lab.trainings
    np.testing.assert_array_equal(learned.q, expected.q)
    assert last["run"] == 3
    assert last["ended"]["grid"]["rows"] == ["S.G"]
    (replayed,) = last["ended"]["run"]
    assert replayed["name"] == "Q-learning"
    assert replayed["said"][0] == "before the first episode"
    assert replayed["said"][-1].startswith("after episode 40, with a return of ")
    assert last["ended"]["sentence"] == (
        "The greedy policy ends 100 of 100 episodes within 500 steps; their mean return is -1."
    )


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"text": "S ? G"}, "ValueError: text must use symbols of the legend"),
        ({"learner": "none"}, "ValueError: learner must be"),
        (
            {"settings": LEARN["settings"] | {"discount": 2}},
            "ValueError: discount must",
        ),
    ],
)
def test_what_cannot_be_learned_gets_one_sentence(learning_lab, change, error):
    (answer,) = answers_of(learning_lab, LEARN | change)
    assert answer["run"] == 3
    assert answer["error"].startswith(error)
