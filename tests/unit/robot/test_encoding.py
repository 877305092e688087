"""Degrees of danger, states, encodings: Table 3.1, Eq. (3.17), Eq. (4.5)."""

from __future__ import annotations

import json
from dataclasses import asdict

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robonav.robot import (
    NNQL_SENSORS,
    TARGET_ENCODINGS,
    Encoder,
    Sensing,
    degree_of_danger,
    lfd_state,
    nnql_state,
    random_worlds,
    sense,
)


@pytest.mark.parametrize(
    ("centimetres", "degree"),
    [
        (0, 7),
        (2.9, 7),
        (3, 6),
        (6.9, 6),
        (7, 5),
        (11, 4),
        (14.9, 4),
        (15, 3),
        (20, 2),
        (25, 1),
        (29.9, 1),
        (30, 0),
    ],
)
def test_table_3_1(centimetres, degree):
    assert degree_of_danger(centimetres * 10 / 30) == degree


@given(st.lists(st.floats(0, 10), min_size=2, max_size=20))
def test_danger_never_grows_with_distance(ranges):
    assert (np.diff(degree_of_danger(np.sort(ranges))) <= 0).all()


def some_sensing(n=50):
    worlds = random_worlds(n, 15, seed=3)
    rng = np.random.default_rng(0)
    return sense(
        worlds, np.column_stack([rng.uniform(1, 99, (n, 2)), rng.uniform(-3, 3, n)])
    )


def test_the_state_of_eleven_numbers():
    read = some_sensing()
    state = lfd_state(read)
    assert state.shape == (50, 11)
    np.testing.assert_array_equal(state[:, :9], degree_of_danger(read.ranges))
    np.testing.assert_array_equal(state[:, 9], read.target_region)
    np.testing.assert_array_equal(state[:, 10], read.target_seen)


def test_the_state_of_sixteen_numbers_leaves_out_sensors_five_and_six():
    read = some_sensing()
    state = nnql_state(read)
    assert state.shape == (50, 16)
    kept = [0, 1, 2, 3, 6, 7, 8]
    assert [s - 1 for s in NNQL_SENSORS] == kept
    np.testing.assert_array_equal(state[:, :7], degree_of_danger(read.ranges)[:, kept])
    np.testing.assert_array_equal(state[:, 7], read.target_region)
    np.testing.assert_array_equal(state[:, 9:], read.walls[:, kept])


def test_target_encodings():
    region = np.arange(1, 10)
    signed = TARGET_ENCODINGS["signed"](region)[:, 0]
    np.testing.assert_allclose(signed, np.array([0, 1, 2, 3, 4, -4, -3, -2, -1]) / 4)
    np.testing.assert_allclose(TARGET_ENCODINGS["number"](region)[:, 0], region / 9)
    np.testing.assert_array_equal(TARGET_ENCODINGS["one-hot"](region), np.eye(9))
    pair = TARGET_ENCODINGS["sine-cosine"](region)
    np.testing.assert_allclose((pair**2).sum(axis=1), 1)
    np.testing.assert_allclose(pair[0], [0, 1])
    steps = np.linalg.norm(np.roll(pair, -1, axis=0) - pair, axis=1)
    np.testing.assert_allclose(steps, steps[0])  # sector 9 is as near to 1 as 2 is


@pytest.mark.parametrize("target", TARGET_ENCODINGS)
@pytest.mark.parametrize("walls", [False, True])
def test_encoders_give_inputs_of_their_size_between_minus_one_and_one(target, walls):
    encoder = Encoder(NNQL_SENSORS, walls, target)
    inputs = encoder(some_sensing())
    assert inputs.shape == (50, encoder.size)
    assert np.abs(inputs).max() <= 1
    assert inputs.dtype == float


def test_default_encoders_have_the_thesis_sizes_with_a_number_for_the_sector():
    assert Encoder(target="number").size == 11
    assert Encoder(NNQL_SENSORS, True, "number").size == 16


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0,),), "sensors must be at least 1"),
        (((1,), False, "polar"), "target must be one of number, signed"),
    ],
)
def test_bad_encoders_are_refused_with_a_sentence(arguments, message):
    with pytest.raises(ValueError, match=message):
        Encoder(*arguments)


def test_picking_rows_of_sensing():
    read = some_sensing()
    assert isinstance(read[:3], Sensing)
    assert len(read[read.safe]) == read.safe.sum()


@pytest.mark.parametrize(
    "sensors", [[1, 2, 9], np.array([1, 2, 9]), (1, np.int8(2), 9)]
)
def test_the_encoder_takes_what_json_and_numpy_give(sensors):
    encoder = Encoder(sensors, walls=np.True_)
    assert encoder == Encoder((1, 2, 9), walls=True)
    assert hash(encoder) == hash(Encoder((1, 2, 9), walls=True))
    assert json.dumps(asdict(encoder))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"sensors": "123"}, "sensors must be a sequence of numbers, got '123'"),
        ({"sensors": np.array(3)}, "sensors must be a sequence of numbers"),
        ({"sensors": [[1], [2]]}, "sensors must be a whole number"),
        ({"walls": 1}, "walls must be True or False, got 1"),
    ],
)
def test_the_encoder_names_what_it_cannot_take(arguments, message):
    with pytest.raises(TypeError, match=message):
        Encoder(**arguments)
