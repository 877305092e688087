"""Table 4.1 made exclusive and total: each row, and that always exactly one holds."""

import gymnasium
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import robonav  # noqa: F401 - registers the environments
from robonav.nnql.reward import (
    REWARDS,
    ROW_NUMBERS,
    TABLE,
    Property,
    reward,
    reward_row,
    state_property,
)
from robonav.robot import OUTCOMES, Sensing

RUNNING, ARRIVED, COLLIDED, LATE = range(4)


def sensing(*nearest):
    """Robots whose least range is given, each seen by another sensor."""
    ranges = np.full((len(nearest), 9), 10.0)
    for k, distance in enumerate(nearest):
        ranges[k, k % 9] = distance
    n = len(nearest)
    return Sensing(ranges, np.zeros((n, 9), bool), np.ones(n, int), np.zeros(n, bool))


def reward_of(before, after, outcome=RUNNING):
    return float(
        reward(sensing(before), sensing(after), np.array([outcome], np.int8))[0]
    )


@pytest.mark.parametrize(
    ("row", "before", "after", "outcome", "expected"),
    [
        (0, 6.0, 6.5, ARRIVED, 1.0),
        (0, 10.0, 10.0, ARRIVED, 1.0),
        (1, 3.0, 0.4, COLLIDED, -1.0),
        (
            1,
            6.0,
            2.0,
            COLLIDED,
            -1.0,
        ),  # hit something beside the way: the end of the step says nothing
        (2, 10.0, 10.0, RUNNING, 0.0),
        (2, 7.0, 10.0, RUNNING, 0.0),
        (2, 4.0, 10.0, RUNNING, 0.0),
        (3, 10.0, 9.0, RUNNING, 0.0),
        (3, 10.0, 3.0, RUNNING, 0.0),
        (4, 4.999999, 5.0, RUNNING, 0.5),
        (5, 5.0, 4.999999, RUNNING, 0.0),
        (5, 9.0, 2.0, RUNNING, 0.0),
        (6, 6.0, 9.0, RUNNING, 0.6),
        (6, 6.0, 6.0, RUNNING, 0.6),
        (6, 7.0, 6.000001, RUNNING, 0.6),
        (7, 7.0, 6.0, RUNNING, 0.0),
        (8, 8.0, 6.0, RUNNING, -0.2),
        (8, 9.0, 5.0, RUNNING, -0.2),
        (9, 3.0, 4.0, RUNNING, 0.4),
        (9, 3.0, 3.0, RUNNING, 0.4),
        (9, 3.0, 2.000001, RUNNING, 0.4),
        (10, 4.0, 3.0, RUNNING, -0.2),
        (11, 4.0, 2.0, RUNNING, -0.5),
        (12, 4.5, 1.5, RUNNING, -1.0),
        (12, 4.9, 1.0, LATE, -1.0),  # out of steps is no state of its own
    ],
)
def test_each_row(row, before, after, outcome, expected):
    assert reward_row(sensing(before), sensing(after), np.array([outcome]))[0] == row
    assert reward_of(before, after, outcome) == expected == TABLE[row].reward


def holds(row, before, after, outcome):
    """The table's words, read one by one."""
    kind = {0: "safe", 1: "cozy", 2: "dangerous"}
    was = kind[0 if before >= 10 else 1 if before >= 5 else 2]
    now = kind[0 if after >= 10 else 1 if after >= 5 else 2]
    now = {ARRIVED: "winning", COLLIDED: "failure"}.get(outcome, now)
    metres = max(int(np.floor(before - after)), 0)
    condition = {
        "": True,
        "not a metre nearer": metres == 0,
        "1 m nearer": metres == 1,
        "2 m nearer": metres == 2,
        "2 m nearer or more": metres >= 2,
        "3 m nearer or more": metres >= 3,
    }[row.condition]
    return (row.before == "any" or was in row.before) and now in row.after and condition


distances = st.one_of(
    st.floats(0.0, 10.0), st.integers(0, 10).map(float), st.sampled_from([5.0, 10.0])
)


@given(distances, distances, st.sampled_from([RUNNING, ARRIVED, COLLIDED, LATE]))
def test_exactly_one_row_holds_for_any_step(before, after, outcome):
    fitting = [k for k, row in enumerate(TABLE) if holds(row, before, after, outcome)]
    assert fitting == [
        reward_row(sensing(before), sensing(after), np.array([outcome]))[0]
    ]


def test_table_names_every_step_once():
    assert (ROW_NUMBERS[:3] >= 0).all()
    cells = [np.argwhere(ROW_NUMBERS[:3] == k) for k in range(len(TABLE))]
    assert all(len(found) for found in cells)
    assert REWARDS[ROW_NUMBERS[Property.DANGEROUS, Property.COZY]].tolist() == [0.5] * 4


def test_state_properties_are_exclusive_at_their_borders():
    read = sensing(10.0, 9.999999, 5.0, 4.999999, 1.0, 0.2)
    names = [Property(k).name for k in state_property(read)]
    assert names == ["SAFE", "COZY", "COZY", "DANGEROUS", "DANGEROUS", "DANGEROUS"]
    ends = state_property(
        read, np.array([ARRIVED, COLLIDED, RUNNING, LATE, ARRIVED, COLLIDED])
    )
    assert [Property(k).name for k in ends] == [
        "WINNING",
        "FAILURE",
        "COZY",
        "DANGEROUS",
        "WINNING",
        "FAILURE",
    ]


def test_the_codes_are_those_of_the_simulator():
    assert [str(name) for name in OUTCOMES] == [
        "running",
        "arrived",
        "collided",
        "out of steps",
    ]


def test_it_is_a_gymnasium_reward_single_and_vectorised():
    single = gymnasium.make(
        "robonav/Navigation-v0", obstacles=20, speed=2.5, reward=reward
    )
    batch = gymnasium.make_vec(
        "robonav/Navigation-v0",
        num_envs=3,
        vectorization_mode="vector_entry_point",
        obstacles=20,
        speed=2.5,
        reward=reward,
    )
    read, _ = single.reset(seed=5)
    batch.reset(seed=[5, 6, 7])
    total = []
    for _ in range(60):
        before = read["ranges"].min()
        read, gained, terminated, truncated, info = single.step(0)
        _, all_gained, *_ = batch.step([0, 0, 0])
        outcome = info["outcome"]
        assert (
            gained == reward_of(before, read["ranges"].min(), outcome) == all_gained[0]
        )
        total.append(gained)
        if terminated or truncated:
            break
    assert len(set(total)) > 2
