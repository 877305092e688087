"""PPO with a window: what robots record while they act, and what is left as it is."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from robonav.deep.episodes import act_together
from robonav.memory import (
    MemoryPolicy,
    RecurrentNetwork,
    WindowNetwork,
    ppo_with_window,
)
from robonav.memory.ppo import act_with_window
from robonav.networks import NetworkPolicy
from robonav.networks.torch_module import as_network
from robonav.robot import Encoder, Simulator, crossing_worlds

ENCODED = Encoder().size


def policy_of(k):
    network = WindowNetwork(ENCODED, k=k, hidden=8, seed=0)
    return MemoryPolicy(network, temperature=1.0)


def crossings(rng):
    return Simulator(crossing_worlds(5, seed=int(rng.integers(99))), max_steps=40)


def test_a_window_of_one_step_acts_as_the_plain_policy():
    policy = policy_of(1)
    plain = NetworkPolicy(as_network(policy.network.layers), Encoder(), 1.0)
    found, expected = (
        act(crossings(np.random.default_rng(1)), *more, np.random.default_rng(2))
        for act, more in ((act_with_window, (policy,)), (act_together, (plain, None)))
    )
    assert len(found) == len(expected) == 5
    for one, other in zip(found, expected, strict=True):
        for name, values in vars(one).items():
            assert torch.equal(values, vars(other)[name]), name


def test_windows_move_on_by_one_step_and_hold_the_actions():
    rng = np.random.default_rng(3)
    for one in act_with_window(crossings(rng), policy_of(3), rng):
        assert torch.equal(one.states[1:], one.next_states[:-1])
        assert one.ended.tolist() == [False] * (len(one.ended) - 1) + [True]
        step = ENCODED + 5
        assert not one.states[0, ENCODED:].any()  # nothing happened before
        for t in range(len(one.actions)):
            before = one.next_states[t, ENCODED:step]
            assert before.tolist() == np.eye(5)[one.actions[t]].tolist()
            assert torch.equal(
                one.next_states[t, step : step + ENCODED], one.states[t, :ENCODED]
            )


def test_training_changes_a_copy():
    policy = policy_of(2)
    before = [part.clone() for part in policy.network.parameters()]
    learned = ppo_with_window(policy, crossings, 1, batches=2, seed=0)
    after = list(learned.network.parameters())
    assert all(
        torch.equal(a, b)
        for a, b in zip(before, policy.network.parameters(), strict=True)
    )
    assert not all(torch.equal(a, b) for a, b in zip(before, after, strict=True))
    assert learned.temperature == policy.temperature
    again = ppo_with_window(policy, crossings, 1, batches=2, seed=0)
    for a, b in zip(after, again.network.parameters(), strict=True):
        assert torch.equal(a, b)


def test_a_recurrent_network_is_refused():
    policy = MemoryPolicy(RecurrentNetwork(ENCODED, units=4, seed=0))
    with pytest.raises(TypeError, match=r"policy\.network"):
        ppo_with_window(policy, crossings, 1, seed=0)
