"""What the training lab replays: every combination, as long as it says, and again the same."""

from itertools import product

import numpy as np
import pytest

from robonav.experiments import labs, read_results


@pytest.fixture(params=labs.EXPERIMENTS, ids=lambda experiment: experiment.name)
def results(request):
    return read_results(request.param)


def test_every_combination_is_there_in_the_order_of_its_choices(results):
    choices = labs.choices(results)
    cases = [
        tuple(str(choice) for choice in case.values())
        for case in results.experiment.cases
    ]
    assert cases == list(product(*choices.values()))


def test_every_number_is_taken_where_it_is_said_to_be(results):
    for metric, steps in labs.STEPS[results.experiment.name].items():
        for case in range(len(results.experiment.cases)):
            assert results.values(metric, case).shape == (
                results.experiment.seeds["thesis"],
                len(steps),
            )


@pytest.mark.parametrize(
    ("name", "case"),
    [("lab-lfd", 3), ("lab-nirl", 0)],
)
@pytest.mark.slow
def test_a_run_comes_out_again(name, case):
    experiment = next(found for found in labs.EXPERIMENTS if found.name == name)
    kept = read_results(experiment)
    again = experiment.run(experiment.cases[case], 1, "thesis")
    for metric in labs.STEPS[name]:
        np.testing.assert_allclose(
            kept.values(metric, case)[1], again[metric], rtol=1e-6, err_msg=metric
        )


def test_a_quick_run_is_a_short_one():
    experiment = labs.EXPERIMENTS[1]
    numbers = experiment.run(experiment.cases[0], 0, "quick")
    assert 0 < len(numbers["success"]) <= len(labs.STEPS["lab-nnql"]["success"])
    np.testing.assert_allclose(
        numbers["success"] + numbers["collision"] <= 100 + 1e-9, True
    )
