"""Gridworlds: the map read right, the model by hand, and the environment that agrees with it."""

import dataclasses

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import Cell, FiniteMDP, GridWorld, four_by_three, value_iteration

MAP = """
    S . # G
    . ~ . X
    . # $ .
"""
MUD = {"$": Cell(reward=-5)}


@pytest.fixture
def grid():
    return GridWorld(MAP, legend=MUD, slip=0.2, step_reward=-1)


@st.composite
def grids(draw):
    rows, columns = draw(st.integers(1, 5)), draw(st.integers(1, 5))
    cells = st.text(alphabet=".#SGX~$", min_size=columns, max_size=columns)
    lines = draw(st.lists(cells, min_size=rows, max_size=rows))
    text = "\n".join(["." + lines[0][1:], *lines[1:]])  # at least one cell to be in
    return GridWorld(
        text, legend=MUD, slip=draw(st.floats(0, 1)), step_reward=draw(st.floats(-1, 1))
    )


def test_the_map_is_read_row_by_row(grid):
    assert grid.shape == (3, 4)
    assert grid.numbers.tolist() == [[0, 1, -1, 2], [3, 4, 5, 6], [7, -1, 8, 9]]
    assert grid.cells[[0, 2, 9]].tolist() == [[0, 0], [0, 3], [2, 3]]
    assert np.flatnonzero(grid.terminal).tolist() == [2, 6]
    assert grid.start.tolist() == [1] + 9 * [0]
    np.testing.assert_allclose(grid.cell_rewards[[0, 2, 6, 8]], [-1, 0, -2, -6])
    assert grid.on_map(np.arange(10)).tolist()[0][3] == 2
    assert np.isnan(grid.on_map(np.arange(10))[0, 2])
    assert grid.on_map(np.arange(10), walls=-1).dtype.kind == "i"


def test_moves_stop_at_walls_and_borders(grid):
    assert grid.moves[0].tolist() == [0, 1, 3, 0]  # up, right, down, left
    assert grid.moves[1].tolist() == [1, 1, 4, 0]  # a wall on the right
    assert grid.moves[8].tolist() == [5, 9, 8, 8]


def test_a_slip_goes_aside_and_ice_slips_more(grid):
    mdp = grid.mdp(0.9)
    up, right = mdp.transitions[0].toarray(), mdp.transitions[1].toarray()
    np.testing.assert_allclose(right[3, [4, 0, 7]], [0.8, 0.1, 0.1])
    np.testing.assert_allclose(up[4, [1, 3, 5]], [1 / 3, 1 / 3, 1 / 3])
    assert mdp.rewards[9, 3] == pytest.approx(
        -1 + 0.8 * -5 + 0.1 * -1
    )  # to the mud, or to the pit, or nowhere
    assert mdp.rewards[2].tolist() == [0, 0, 0, 0]


def test_a_cell_may_be_firm_where_the_grid_is_not():
    grid = GridWorld("..\n!.", legend={"!": Cell(slip=0.0)}, slip=0.5)
    np.testing.assert_allclose(grid.outcomes[1][:, 0, 0], [0.5, 0.5, 1, 0.5])


def test_no_cell_vanishes_however_little_it_pays():
    """Zero-reward cells are states like others."""
    grid = GridWorld("...\n...\n..G")
    assert grid.n_states == 9
    mdp = grid.mdp(0.5)
    assert mdp.n_states == 9
    assert value_iteration(mdp).values[0] == pytest.approx(0.5**3)


def test_the_same_grid_otherwise():
    slippery = four_by_three()
    sure = dataclasses.replace(slippery, slip=0.0)
    assert sure.step_reward == slippery.step_reward
    assert (sure.outcomes[1][..., 0] == 1).all()


@settings(max_examples=40, deadline=None)
@given(grids())
def test_model_and_environment_have_the_same_table(grid):
    model = grid.mdp(0.9)
    from_table = FiniteMDP.from_gymnasium(grid.environment(), 0.9)
    reachable = ~grid.terminal
    difference = abs(model.rows - from_table.rows).tocsr()
    assert difference.max() < 1e-12
    np.testing.assert_allclose(model.rewards, from_table.rewards, atol=1e-12)
    assert (model.terminal[reachable] == from_table.terminal[reachable]).all()


def test_the_environment_behaves_as_the_model_says(grid):
    """Frequencies of 20,000 steps with random actions, within four standard errors."""
    env, mdp = grid.environment(), grid.mdp(0.9)
    rng = np.random.default_rng(0)
    counts, rewards = np.zeros((4, 10, 10)), np.zeros((10, 4))
    state, _ = env.reset(seed=0)
    for _ in range(20_000):
        action = int(rng.integers(4))
        reached, reward, ended, cut_off, _ = env.step(action)
        counts[action, state, reached] += 1
        rewards[state, action] += reward
        assert not cut_off
        assert ended == grid.terminal[reached]
        state = env.reset()[0] if ended else reached
    tries = counts.sum(axis=2)
    for action, matrix in enumerate(mdp.transitions):
        expected = matrix.toarray()
        often = tries[action] > 50
        error = np.sqrt(
            expected * (1 - expected) / np.maximum(tries[action], 1)[:, None]
        )
        off = abs(counts[action] / np.maximum(tries[action], 1)[:, None] - expected)
        assert (off <= 4 * error + 1e-12)[often].all()
    often = tries.T > 50
    np.testing.assert_allclose(
        (rewards / np.maximum(tries.T, 1))[often], mdp.rewards[often], atol=0.6
    )


def test_gymnasium_s_checker_is_content(grid):
    check_env(
        gym.wrappers.TimeLimit(grid.environment(), 50).unwrapped, skip_render_check=True
    )


def test_seeds_reproduce_a_walk(grid):
    def walk(seed):
        env = grid.environment()
        return [
            env.reset(seed=seed)[0],
            *(env.step(action % 4)[0] for action in range(30)),
        ]

    assert walk(3) == walk(3)
    assert walk(3) != walk(4)


def test_starts_are_drawn_among_the_start_cells():
    two = GridWorld("S.S\n..G").environment()
    assert {two.reset(seed=seed)[0] for seed in range(20)} == {0, 2}
    anywhere = GridWorld("..\n.G").environment()
    assert {anywhere.reset(seed=seed)[0] for seed in range(40)} == {0, 1, 2}


def test_the_robot_is_seen_on_the_map(grid):
    env = grid.environment(render_mode="ansi")
    env.reset(seed=0)
    assert env.render() == "R . # G\n. ~ . X\n. # $ .\n"
    assert grid.environment().render() is None
    with pytest.raises(ValueError, match="render_mode must be one of"):
        grid.environment(render_mode="human")


@pytest.mark.parametrize(
    ("action", "error", "sentence"),
    [
        (1.7, TypeError, "action must be a whole number, got 1.7"),
        (7, ValueError, "action must be at most 3, got 7"),
        (-1, ValueError, "action must be at least 0"),
    ],
)
def test_actions_that_do_not_exist_are_refused(grid, action, error, sentence):
    env = grid.environment()
    env.reset(seed=0)
    with pytest.raises(error, match=sentence):
        env.step(action)


@pytest.mark.parametrize("numbers", [[1, 2], 5.0, np.zeros((10, 3))])
def test_a_map_takes_one_number_a_state(grid, numbers):
    with pytest.raises(ValueError, match=r"numbers must have shape \(..., 10\)"):
        grid.on_map(numbers)


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        (["..G"], {}, "text must be str, got list"),
        ("..G", {"legend": {"G": 1.0}}, "legend\\['G'\\] must be Cell, got float"),
        ("..G", {"legend": "G"}, "legend must be Mapping, got str"),
    ],
)
def test_what_is_no_map_is_refused(text, options, sentence):
    with pytest.raises(TypeError, match=sentence):
        GridWorld(text, **options)


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        ("..\n...", {}, r"rows of one length, got lengths \[2, 3\]"),
        ("..?\n..!", {}, r"symbols of the legend, .*, got !\?"),
        ("##\n##", {}, "a cell that is neither a wall"),
        ("", {}, "text must have rows"),
        ("..", {"slip": 1.5}, "slip must be"),
        ("..", {"step_reward": np.inf}, "step_reward must be finite"),
        ("..", {"legend": {"m": Cell(slip=2)}}, "slip of 'm' must be"),
        ("..", {"legend": {"m": Cell(reward=np.nan)}}, "reward of 'm' must be finite"),
        ("GX", {}, "a cell that is neither a wall nor terminal"),
    ],
)
def test_maps_that_make_no_sense_are_refused(text, options, sentence):
    with pytest.raises(ValueError, match=sentence):
        GridWorld(text, **options)
