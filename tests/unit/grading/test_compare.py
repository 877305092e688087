"""Comparing answers: what counts as the same, and what is said where it is not."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from robonav.grading.compare import call, difference

FLOATS = hnp.arrays(
    float,
    hnp.array_shapes(max_dims=3),
    elements=st.floats(-(2.0**20), 2.0**20, width=32, allow_subnormal=False),
)


@given(FLOATS)
def test_the_same_numbers_in_any_dress_agree(array):
    for dress in (
        array,
        array.tolist(),
        array.astype(np.float32),
        [*array],
        np.asfortranarray(array),
    ):
        assert difference(dress, array) is None


@given(FLOATS, st.data())
def test_a_changed_number_is_found_where_it_is(array, data):
    place = tuple(data.draw(st.integers(0, n - 1)) for n in array.shape)
    changed = array.copy()
    changed[place] += 1 + np.abs(array).max() / 100
    assert str(list(place)) in difference(changed, array)


@pytest.mark.parametrize(
    ("got", "expected", "says"),
    [
        (None, np.zeros(3), "expected an array of shape (3,), got None"),
        (
            [1, 2],
            np.zeros(3),
            "expected an array of shape (3,), got an array of shape (2,)",
        ),
        ([[1], [1, 2]], np.zeros(3), "got a list of 2"),
        (["1", "2", "3"], np.zeros(3), "got a list of 3"),
        (np.zeros((3, 1)), np.zeros(3), "got an array of shape (3, 1)"),
        ([0, float("nan"), 0], np.zeros(3), "at [1] expected 0, got nan"),
        ([[1.0]], np.array([[-0.0]]), "at [0, 0] expected 0, got 1"),
        ([-0.0, 2], np.array([1.0, 2]), "at [0] expected 1, got 0"),
        ([0, 1.5, 0], np.zeros(3, int), "at [1] expected 0, got 1.5"),
        (2, np.array([True]), "expected an array of shape (1,), got a whole number"),
        ([2], np.array([True]), "at [0] expected True, got 2"),
        (1.0, 2.0, "expected 2, got 1"),
        ((1, 2), (1, 2, 3), "expected 3 parts, got 2 parts"),
        (
            (np.zeros(2), 1),
            (np.zeros(2), 2),
            "in answer[1], expected 2, got 1",
        ),
        (np.zeros(2), {"a": 1}, "expected a dict of 1, got an array of shape (2,)"),
        ({"a": 2}, {"a": 1}, "in answer['a'], expected 1, got 2"),
        ("no", "yes", "expected a string, got a string"),
        (1, None, "expected None, got a whole number"),
        (
            [1e308, -1e308],
            np.array([-1e308, 1e308]),
            "at [0] expected -1e+308, got 1e+308",
        ),
        ([2**64 - 1], np.array([-1]), "at [0] expected -1, got 18446744073709551615"),
    ],
)
def test_a_difference_is_a_sentence(got, expected, says):
    assert says in difference(got, expected)


@pytest.mark.parametrize(
    ("got", "expected"),
    [
        ([1.0, 2.0], np.array([1, 2])),
        ([1, 0], np.array([True, False])),
        (np.array([[1, 2], [3, 4]]), (np.array([1, 2]), np.array([3, 4]))),
        ([0.1 + 0.2], np.array([0.3])),
        (np.array(5), 5),
        ([np.inf, -np.inf], np.array([np.inf, -np.inf])),
        ([1e6, 1e-3], np.array([1e6, 0.0])),
    ],
)
def test_these_agree(got, expected):
    assert difference(got, expected) is None


def test_strings_are_never_made_an_array_of():
    """Of the width of the longest, here 160 GB."""
    got = ["x" * 400_000, *[""] * 100_000]
    assert (
        difference(got, np.zeros(3))
        == "expected an array of shape (3,), got a list of 100001"
    )
    assert (
        difference([1, [None, "a"]], np.zeros(2))
        == "expected an array of shape (2,), got a list of 2"
    )


def test_a_small_number_among_small_ones_counts():
    assert difference([2e-9], np.array([1e-9])) is not None


def test_a_call_shows_small_arguments_and_the_kinds_of_large_ones():
    arguments = (np.array([1.5, 2.0]), 0.25, [1, 2], np.zeros(1000), {"key": "word"})
    assert call("f", arguments).startswith(
        "f([1.5, 2. ], 0.25, [1, 2], an array of shape (1000,), {"
    )


def test_minus_zero_is_shown_as_zero_and_other_signs_stay():
    arguments = (
        -0.0,
        np.array([-0.0, -1e-9, -0.5, -10.0]),
        [-0.0, -0.25],
        -0.0625,
        "a-0",
    )
    shown = call("f", arguments)
    assert shown.startswith("f(0, [")
    assert "-0.0," not in shown.replace("-0.0625", "")
    assert not re.search(r"-0\.?[ ,\]]", shown)
    for kept in ("-0.5", "-10.", "-0.25", "-0.0625", "a-0"):
        assert kept in shown
