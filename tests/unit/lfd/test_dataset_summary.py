"""What a set of demonstrations holds, counted again by hand."""

import numpy as np
import pytest

from robonav.lfd import demonstrate, labelled_states, summarise_dataset
from robonav.robot import Encoder, random_worlds


def test_an_overview_counts():
    demonstrations = demonstrate(random_worlds(6, 12, seed=21))
    held = summarise_dataset(demonstrations)
    x, y = labelled_states(demonstrations, Encoder(target="number"))
    assert (held.trajectories, held.arrived, held.steps, held.effective) == (
        6,
        6,
        len(demonstrations),
        len(x),
    )
    assert held.states == len({tuple(row) for row in x.round(6)})
    assert held.states < held.effective
    assert held.actions.tolist() == y.sum(axis=0).tolist()
    assert held.closest == demonstrations.sensing.ranges.min() < 10
    text = str(held)
    assert text.startswith(
        f"6 trajectories, 6 arrived\n{len(demonstrations)} steps, {len(x)} effective pairs in {held.states} "
    )
    assert f"F {held.actions[0] / len(x):.0%}, L30" in text


def test_summary_of_no_demonstrations():
    held = summarise_dataset(demonstrate(random_worlds(0, 5, seed=1)))
    assert (
        held.trajectories,
        held.steps,
        held.effective,
        held.states,
        held.closest,
    ) == (
        0,
        0,
        0,
        0,
        10,
    )
    assert np.array_equal(held.actions, np.zeros(5))
    assert "F 0%" in str(held)


def test_only_demonstrations():
    with pytest.raises(
        TypeError, match="demonstrations must be Demonstrations, got str"
    ):
        summarise_dataset("x")
