"""Networks with a memory, policies made of them, and their training."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from robonav.lfd import ComputerExpert
from robonav.memory import (
    MemoryPolicy,
    RecurrentNetwork,
    WindowNetwork,
    dagger_with_memory,
    labelled_episodes,
)
from robonav.memory.dagger import UNKNOWN
from robonav.networks import NetworkPolicy
from robonav.networks.torch_module import as_network
from robonav.robot import (
    REFLEX,
    Encoder,
    Simulator,
    crossing_worlds,
    navigate,
    random_worlds,
)

ENCODED = Encoder().size


def made(name, seed=0):
    if name == "gru":
        return RecurrentNetwork(ENCODED, units=6, seed=seed)
    return WindowNetwork(ENCODED, k=int(name), hidden=8, seed=seed)


@pytest.fixture(params=["1", "2", "7", "gru"])
def network(request):
    return made(request.param)


@pytest.mark.parametrize("temperature", [0.0, 0.4])
@pytest.mark.parametrize("reflex", [REFLEX, None])
def test_a_window_of_one_step_is_the_plain_policy(temperature, reflex):
    network = made("1")
    plain = NetworkPolicy(as_network(network.layers), Encoder(), temperature)
    window = MemoryPolicy(network, Encoder(), temperature)
    worlds = random_worlds(20, obstacles=10, seed=3)
    ends = [
        navigate(policy, worlds, record_paths=True, reflex=reflex, seed=4)
        for policy in (plain, window)
    ]
    assert (ends[0].outcome == ends[1].outcome).all()
    for one, other in zip(ends[0].paths, ends[1].paths, strict=True):
        assert np.array_equal(one, other)


def test_step_by_step_as_whole_sequences(network):
    xs = torch.rand(11, 3, ENCODED + 5, generator=torch.Generator().manual_seed(0))
    xs, memory = xs.double(), network.begin(3)
    for x, expected in zip(xs, network(xs), strict=True):
        logits, memory = network.step(memory, x)
        torch.testing.assert_close(logits, expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize("k", [1, 2, 7])
def test_a_window_sees_k_steps_and_no_more(k):
    network = made(str(k))
    xs = torch.rand(12, 1, ENCODED + 5, dtype=torch.float64)
    for t in range(12):
        changed = xs.clone()
        changed[t, :, :ENCODED] += 1.0
        differs = not torch.equal(network(changed)[-1], network(xs)[-1])
        assert differs == (t >= 12 - k)


def test_episodes_are_apart(network):
    """What a robot does depends neither on the robots beside it nor on episodes before."""
    policy = MemoryPolicy(network, Encoder())
    worlds = crossing_worlds(6, seed=1)
    together = navigate(policy, worlds, max_steps=60, reflex=None, record_paths=True)
    alone = navigate(policy, worlds[4], max_steps=60, reflex=None, record_paths=True)
    assert np.array_equal(together.paths[4], alone.paths[0])
    simulator = Simulator(worlds[[4]])
    select, robot = policy.begin(simulator, np.random.default_rng(0)), np.array([0])
    actions = []
    for _ in range(2):
        simulator.restart(robot, worlds[[4]])
        for _ in range(8):
            actions.append(int(select(simulator, simulator.sense(), robot)[0]))
            simulator.step(np.array(actions[-1:]))
    assert actions[:8] == actions[8:]


def test_labels_are_the_experts_actions_and_inputs_what_was_done():
    worlds = crossing_worlds(3, seed=2)
    policy = MemoryPolicy(made("gru"), Encoder())
    simulator = Simulator(worlds, max_steps=90)
    rng = np.random.default_rng(0)
    seen = labelled_episodes(simulator, policy, ComputerExpert(), True, rng, None)
    assert (simulator.outcome == 1).all()
    for robot, steps in enumerate(simulator.steps):
        labels = seen.labels[:steps, robot]
        assert labels.min() >= 0
        assert (seen.labels[steps:, robot] == UNKNOWN).all()
        before = seen.inputs[1:steps, robot, ENCODED:]
        assert torch.equal(before.argmax(dim=1), labels[:-1])
        assert not seen.inputs[0, robot, ENCODED:].any()
        assert not seen.inputs[steps:, robot].any()


@pytest.mark.slow
def test_training_is_determined_by_its_seeds():
    def weights(seed):
        policy = MemoryPolicy(made("2"), Encoder(), 0.1)
        rounds = [crossing_worlds(2, seed=s) for s in (1, 2)]
        trained = dagger_with_memory(
            policy, rounds, reflex=None, validation=crossing_worlds(2, seed=3),
            steps=4, seed=seed,
        )  # fmt: skip
        return trained.network.layers[0].weight

    assert torch.equal(weights(0), weights(0))
    assert not torch.equal(weights(0), weights(1))


def test_a_memory_learns_what_a_plain_policy_cannot():
    """The expert turns to the side that was shown four steps ago; all else is the same."""
    draw = np.random.default_rng(0)
    sides = draw.integers(2, size=64)
    xs = torch.zeros(5, 64, ENCODED + 5, dtype=torch.float64)
    xs[0, :, 0] = torch.tensor(2.0 * sides - 1)
    wanted = torch.tensor(1 + 2 * sides)  # L30 or R30

    def right(network):
        adam = torch.optim.Adam(network.parameters(), lr=0.03)
        for _ in range(150):
            loss = torch.nn.functional.cross_entropy(network(xs)[-1], wanted)
            adam.zero_grad()
            loss.backward()
            adam.step()
        return float((network(xs)[-1].argmax(dim=1) == wanted).double().mean())

    assert right(made("gru")) == 1.0
    assert right(made("5", seed=1)) == 1.0
    assert right(made("4")) <= 0.7  # the side has left the window
