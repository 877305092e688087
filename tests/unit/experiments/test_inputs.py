"""What NIRL and cloning read, and what NIRL visits."""

import numpy as np

from robonav.benchmark import display_name
from robonav.experiments import experiment
from robonav.experiments.chapter5.inputs import CountedTask, _as_bytes
from robonav.experiments.chapter5.setup import METHODS, tuned
from robonav.nirl import RobotTask


def test_the_note_of_table_5_2_says_which_encoding_each_method_reads():
    note = experiment("table-5.2").note
    for method in METHODS:
        target = tuned(method)["target"]
        (group,) = [part for part in note.split(";") if display_name(method) in part]
        assert f": {target}" in group


def test_equal_states_have_equal_bytes():
    states = np.array([[0.1, 1.0], [0.3 - 0.2, 1.0], [0.1, 0.0]])
    first, same, other = _as_bytes(states)
    assert first == same
    assert first != other


def test_a_counted_task_gives_the_episodes_of_the_task_and_keeps_their_states():
    def uniform(inputs):
        return np.full((len(inputs), 5), 0.2)

    plain, counted = RobotTask(2), CountedTask(2)
    expected = plain.rollout(uniform, np.random.default_rng(1))
    given = counted.rollout(uniform, np.random.default_rng(1))
    np.testing.assert_array_equal(given.inputs, expected.inputs)
    np.testing.assert_array_equal(counted.states[0], expected.inputs)
