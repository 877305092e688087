"""The training lab: its data, training for the page bit by bit, and its JavaScript under Node."""

import threading

import numpy as np
import pytest

from robonav.widgets.training_lab import Curve, training_lab

CONTROLS = {"rate": ["0.1", "1"], "hidden": ["2", "8", "20"]}
MEASURES = {"cost": "cost J", "success": "success (%)"}


def run(rate, hidden):
    steps = np.arange(0, 101, 4)
    cost = np.exp(-float(rate) * steps / 20)
    success = np.array([[10, 50, 90], [20, 60, 95]]) / float(hidden)
    return {"cost": Curve(steps, cost), "success": Curve([0, 50, 100], success)}


RUNS = {
    (rate, hidden): run(rate, hidden)
    for rate in CONTROLS["rate"]
    for hidden in CONTROLS["hidden"]
}


def lab(train=None, **changes):
    return training_lab(
        **{"controls": CONTROLS, "runs": RUNS, "measures": MEASURES} | changes,
        step="step",
        train=train,
    )


def answers_of(widget, *asked):
    """What the widget sends when it is asked these things, once its thread is through."""
    answers = []
    widget.send = answers.append
    for message in asked:
        widget._answer(widget, message, [])
    if widget._thread is not None:
        widget._thread.join(timeout=60)
        assert not widget._thread.is_alive()
    return answers


def test_every_combination_reaches_the_page(node):
    data = lab(start=("1", "8")).data
    assert [control["value"] for control in data["controls"]] == [1, 1]
    seen = node("training_lab", "return data.map(page.curvesOf);", data["runs"])
    for curves, expected in zip(seen, RUNS.values(), strict=True):
        np.testing.assert_allclose(
            curves["cost"]["mean"], expected["cost"].values, rtol=1e-6
        )
        assert curves["cost"]["steps"] == expected["cost"].steps.tolist()
        for part, of in (("mean", np.mean), ("low", np.min), ("high", np.max)):
            np.testing.assert_allclose(
                curves["success"][part],
                of(expected["success"].values, axis=0),
                rtol=1e-6,
            )
    assert [seen[0]["cost"]["seeds"], seen[0]["success"]["seeds"]] == [1, 2]


def test_readings_are_the_last_ones_taken(node):
    data = lab().data["runs"][0]
    body = "const curves = page.curvesOf(data); return [0, 49, 50, 100].map((s) => page.reading(curves.success, s));"
    assert node("training_lab", body, data) == ["7.5 (5 to 10)"] * 2 + [
        "27.5 (25 to 30)",
        "46.3 (45 to 47.5)",
    ]
    body = "return [7, 0.12345, 12.345, 1234.5].map(page.digits);"
    assert node("training_lab", body, None) == ["7", "0.123", "12.3", "1235"]


def trainer(choices):
    for done in range(1, 6):
        yield done, 5, {"cost": Curve(range(done), np.full(done, float(choices[0])))}


def test_a_training_is_told_bit_by_bit():
    answers = answers_of(
        lab(trainer), {"ask": "kernel"}, {"ask": "train", "choices": ["0.1", "2"]}
    )
    assert answers[0] == {"kernel": True}
    assert [(answer["done"], answer["total"]) for answer in answers[1:-1]][-1] == (5, 5)
    assert answers[-2]["live"][-1]["cost"]["steps"]["shape"] == [5]
    assert answers[-1] == {"run": 0, "ended": "Trained."}


def test_a_training_is_cancelled_where_it_stands():
    going, heard = threading.Event(), threading.Event()

    def endless(choices):
        for done in range(1_000_000):
            going.set()
            assert heard.wait(60)
            yield done, 1_000_000, {"cost": Curve([0], [0])}

    widget = lab(endless)
    answers = []
    widget.send = answers.append
    train = {"ask": "train", "choices": ["1", "2"]}
    widget._answer(widget, train, [])
    assert going.wait(60)
    first = widget._thread
    widget._answer(widget, train | {"run": 1}, [])  # the second replaces the first
    heard.set()
    first.join(timeout=60)
    assert {"run": 0, "cancelled": True} in answers
    widget._answer(widget, {"ask": "cancel"}, [])
    widget._thread.join(timeout=60)
    assert answers[-1] == {"run": 1, "cancelled": True}


def test_what_fails_in_a_training_is_said():
    def fails(choices):
        yield 1, 2, {"cost": Curve([0], [1])}
        raise ValueError("rate must be positive")

    answers = answers_of(lab(fails), {"ask": "train", "choices": ["1", "2"]})
    assert answers[-1] == {"run": 0, "error": "ValueError: rate must be positive"}


def test_without_a_trainer_nothing_is_trained():
    assert answers_of(
        lab(), {"ask": "kernel"}, {"ask": "train", "choices": ["1", "2"]}
    ) == [{"kernel": False}]


def test_what_cannot_be_shown_is_refused():
    with pytest.raises(
        ValueError, match=r"runs must hold for \('0.3', '2'\) the curves cost, success"
    ):
        lab(controls={"rate": ["0.3"], "hidden": ["2"]})
    with pytest.raises(ValueError, match="runs must hold for"):
        lab(measures={"cost": "cost J"})
    with pytest.raises(ValueError, match="values of cost must have shape"):
        lab(
            runs={
                key: curves | {"cost": Curve([0, 1], [1])}
                for key, curves in RUNS.items()
            }
        )
