"""The decorator that checks the arguments of functions."""

from functools import partial

import pytest

from robonav.validation import check_array, check_integer, check_real, checks

RULES = {
    "tolerance": partial(check_real, above=0),
    "rounds": partial(check_integer, at_least=1),
    "coarse.tolerance": partial(check_real, at_least=0),
}


def same_length(function, arguments):
    if "x" in arguments:
        arguments["x"] = check_array("x", arguments["x"], shape=("m",))
        check_array("y", arguments["y"], shape=arguments["x"].shape)


checked = checks(RULES, together=same_length)


@checked
def fine(tolerance, *, rounds=None):
    """The docstring."""
    return tolerance, rounds


@checked
def coarse(tolerance=-1.0):
    return tolerance


@checked
def paired(x, y):
    return type(x).__name__


def test_each_argument_is_checked_by_its_name():
    assert fine(1) == (1.0, None)
    with pytest.raises(ValueError, match="tolerance must be greater than 0, got 0"):
        fine(0)
    with pytest.raises(ValueError, match="rounds must be at least 1, got 0"):
        fine(1, rounds=0)
    with pytest.raises(TypeError, match="tolerance must be a number, got None"):
        fine(None)


def test_a_function_may_have_a_rule_of_its_own():
    assert coarse(0) == 0.0
    with pytest.raises(ValueError, match="tolerance must be at least 0"):
        coarse(-0.5)


def test_defaults_are_checked_too_but_an_optional_argument_may_stay_none():
    with pytest.raises(ValueError, match="tolerance must be at least 0, got -1"):
        coarse()
    assert fine(1, rounds=None) == (1.0, None)


def test_arguments_that_depend_on_each_other_are_checked_together():
    assert paired([1, 2], [3, 4]) == "ndarray"
    with pytest.raises(ValueError, match=r"y must have shape \(2,\), got \(3,\)"):
        paired([1, 2], y=[3, 4, 5])


def test_a_checked_function_keeps_its_name_and_complains_like_any_other():
    assert (fine.__name__, fine.__doc__) == ("fine", "The docstring.")
    with pytest.raises(TypeError, match="missing a required argument: 'y'"):
        paired([1])
    with pytest.raises(TypeError, match="unexpected keyword argument 'speed'"):
        fine(1, speed=2)
