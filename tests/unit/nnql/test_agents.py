"""What each method makes of its steps: against a plain loop, and on a small problem whose values are known."""

import numpy as np
import pytest
from scipy.special import expit

from robonav.mdp import FiniteMDP, value_iteration
from robonav.networks.multilayer_perceptron import (
    Network,
    cross_entropy_gradient,
    random_network,
)
from robonav.networks.network_stack import stacked
from robonav.nnql import double_dqn_targets, dqn_targets
from robonav.nnql._fast.agents import (
    Agent,
    DQNAgent,
    Experience,
    NFQAgent,
    NNQLAgent,
    adam,
    rprop,
)
from robonav.nnql._fast.networks import (
    BatchedNetworks,
    parameters_to_vectors,
    vectors_to_parameters,
)
from robonav.nnql._fast.replay_buffers import ReplayBuffers

GAMMA = 0.7
END = 3  # a corridor of states 0 to 3: action 0 goes left, 1 right; 3 is the end and gives 1


def corridor_values():
    """Q* (3, 2) of the corridor."""
    transitions, rewards = np.zeros((2, 4, 4)), np.zeros((4, 2))
    for state in range(END):
        transitions[0, state, max(state - 1, 0)] = transitions[1, state, state + 1] = 1
    transitions[:, END, END] = 1
    rewards[END - 1, 1] = 1
    mdp = FiniteMDP(transitions, rewards, GAMMA)
    return mdp.action_values(value_iteration(mdp, tolerance=1e-9).values)[:END]


def corridor_steps(agent, n, seeds=2, seed=0):
    """Random steps in the corridor, one of each seed at a time."""
    rng, rows = np.random.default_rng(seed), np.arange(seeds)
    for k in range(n):
        state, action = rng.integers(END, size=seeds), rng.integers(2, size=seeds)
        reached = np.where(action == 1, state + 1, np.maximum(state - 1, 0))
        inputs, after = np.eye(4)[state], np.eye(4)[reached]
        done = reached == END
        values = agent.values(rows, inputs)
        yield (
            rows,
            Experience(
                inputs,
                values,
                action,
                done.astype(float),
                after,
                done,
                np.full(seeds, k / n),
            ),
        )


def networks(sizes=(4, 8, 2), seeds=2):
    return BatchedNetworks(
        stacked([random_network(sizes, seed=k) for k in range(seeds)])
    )


def learned_values(agent):
    return np.stack(
        [agent.values(np.full(END, row), np.eye(4)[:END]) for row in range(2)]
    )


@pytest.mark.slow
def test_nfq_converges_to_the_known_values():
    agent = NFQAgent(
        networks(),
        (2, 4),
        discount=GAMMA,
        episodes_per_fit=1,
        sweeps=12,
        epochs=300,
        tolerance=1e-9,
    )
    for rows, steps in corridor_steps(agent, 60):
        agent.observe(rows, steps)
    agent.end_episode(np.arange(2), np.array([1, 1]))
    np.testing.assert_allclose(
        learned_values(agent), [corridor_values()] * 2, atol=0.02
    )


def test_nfq_looks_at_nothing_beyond_the_end():
    agent, rows = (
        NFQAgent(
            networks(),
            (2, 4),
            discount=GAMMA,
            episodes_per_fit=1,
            sweeps=3,
            epochs=300,
            tolerance=0,
        ),
        np.arange(2),
    )
    x, last = np.eye(4)[[2, 2]], np.array([True, True])
    agent.observe(
        rows,
        Experience(
            x,
            x[:, :2],
            np.array([1, 1]),
            np.full(2, 0.3),
            np.eye(4)[[3, 3]],
            last,
            np.zeros(2),
        ),
    )
    agent.end_episode(rows, np.array([1, 1]))
    np.testing.assert_allclose(agent.values(rows, x)[:, 1], 0.3, atol=0.01)


def test_dqn_draws_from_all_that_was_ever_made(monkeypatch):
    drawn, draw = [], ReplayBuffers.at
    monkeypatch.setattr(
        ReplayBuffers,
        "at",
        lambda memory, rows, steps: drawn.append(steps) or draw(memory, rows, steps),
    )
    agent = DQNAgent(
        networks(),
        (0, 1),
        4,
        discount=GAMMA,
        gradient_step=0.01,
        batch_size=10,
        target_update_interval=50,
    )
    for rows, steps in corridor_steps(agent, 200):
        agent.observe(rows, steps)
    latest = np.array(drawn[-100:])  # (100, 2, 10) of between 100 and 200 steps
    made = np.arange(101, 201)[:, None, None]
    assert (latest < made).all()
    np.testing.assert_allclose((latest / made).mean(), 0.5, atol=0.03)
    np.testing.assert_allclose((latest < made / 4).mean(), 0.25, atol=0.04)
    assert (latest[:, 0] != latest[:, 1]).any()


def test_dqn_converges_to_the_known_values():
    agent = DQNAgent(
        networks(),
        (0, 1),
        4,
        discount=GAMMA,
        gradient_step=0.01,
        batch_size=16,
        target_update_interval=50,
    )
    for rows, steps in corridor_steps(agent, 900):
        agent.observe(rows, steps)
    np.testing.assert_allclose(
        learned_values(agent), [corridor_values()] * 2, atol=0.04
    )


def test_online_learning_converges_to_the_known_values():
    settings = {
        "pairs": 1,
        "learning_rate": (0.8, 0.1),
        "gradient_step": (1.0, 0.1),
        "rescale": "clip",
        "passes": 4,
        "tolerance": 0,
    }
    agent = NNQLAgent(networks(), (2, 3000, 4, 2), discount=GAMMA, **settings)
    for rows, steps in corridor_steps(agent, 3000):
        agent.observe(rows, steps)
    np.testing.assert_allclose(
        learned_values(agent), [corridor_values()] * 2, atol=0.04
    )


def random_steps(n, inputs=6, actions=3, seed=3):
    rng = np.random.default_rng(seed)
    for k in range(n):
        yield (
            rng.random(inputs), int(rng.integers(actions)), float(rng.uniform(-1, 1)), rng.random(inputs),
            bool(rng.random() < 0.2), k / n,
        )  # fmt: skip


@pytest.mark.parametrize("pairs", [1, 4, 100])
def test_accumulated_training_is_a_plain_loop(pairs):
    """Algorithm 8, lines 9 to 16, for one robot: chapter 3's network and gradient, one pair after the other."""
    network = random_network((6, 8, 3), seed=5)
    agent = NNQLAgent(
        BatchedNetworks(stacked([network])), (1, 50, 6, 3), pairs=pairs, learning_rate=(0.8, 0.1), discount=GAMMA,
        gradient_step=(0.3, 0.05), rescale="clip", passes=2, tolerance=0.0,
    )  # fmt: skip
    gathered = []
    for k, (x, action, reward, reached, terminal, fraction) in enumerate(
        random_steps(40)
    ):
        if k == 25:  # a new episode
            agent.end_episode(np.array([0]), np.array([1]))
            gathered = []
        rows, one = np.array([0]), np.array([fraction])
        values = agent.values(rows, x[None])
        np.testing.assert_allclose(values[0], network.forward(x), rtol=1e-9)
        agent.observe(
            rows,
            Experience(
                x[None],
                values,
                np.array([action]),
                np.array([reward]),
                reached[None],
                np.array([terminal]),
                one,
            ),
        )
        target = network.forward(x)
        following = 0 if terminal else network.forward(reached).max()
        target[action] += (
            0.8
            * (0.1 / 0.8) ** fraction
            * (reward + GAMMA * following - target[action])
        )
        gathered.append((x, np.clip(target, 0, 1)))
        gradient_step = 0.3 * (0.05 / 0.3) ** fraction
        for _ in range(2):
            for x_i, y_i in gathered[-pairs:]:
                slope = cross_entropy_gradient(network, x_i[None], y_i[None])
                network = Network(
                    tuple(
                        w - gradient_step * d
                        for w, d in zip(network.weights, slope.weights, strict=True)
                    ),
                    tuple(
                        b - gradient_step * d
                        for b, d in zip(network.biases, slope.biases, strict=True)
                    ),
                )
    np.testing.assert_allclose(
        agent.networks.parameters(),
        parameters_to_vectors(stacked([network])),
        rtol=1e-8,
        atol=1e-10,
    )


def test_stored_targets_stay_as_they_were_computed():
    agent = NNQLAgent(
        networks(),
        (2, 9, 4, 2),
        pairs=9,
        learning_rate=0.8,
        discount=GAMMA,
        gradient_step=0.3,
        rescale="clip",
        passes=1,
        tolerance=0,
    )
    kept = []
    for rows, steps in corridor_steps(agent, 9):
        agent.observe(rows, steps)
        kept.append(agent.targets[:, agent.count[0] - 1].copy())
    np.testing.assert_array_equal(agent.targets, np.stack(kept, axis=1))


def test_a_learner_that_does_not_learn():
    agent = Agent(networks())
    before = agent.networks.parameters()
    for rows, steps in corridor_steps(agent, 3):
        z = np.stack(
            [
                vectors_to_parameters(before, (4, 8, 2))[k].logits(steps.inputs[k])
                for k in range(2)
            ]
        )
        np.testing.assert_allclose(steps.values, expit(z))
        agent.observe(rows, steps)
    np.testing.assert_array_equal(agent.networks.parameters(), before)


def test_nfq_fits_only_every_so_many_episodes():
    agent = NFQAgent(
        networks(),
        (2, 4),
        discount=GAMMA,
        episodes_per_fit=3,
        sweeps=1,
        epochs=5,
        tolerance=0,
    )
    for rows, steps in corridor_steps(agent, 5):
        agent.observe(rows, steps)
    before = agent.networks.parameters()
    agent.end_episode(np.array([0, 1]), np.array([1, 2]))
    np.testing.assert_array_equal(agent.networks.parameters(), before)
    agent.end_episode(np.array([1]), np.array([3]))
    np.testing.assert_array_equal(agent.networks.parameters()[0], before[0])
    assert (agent.networks.parameters()[1] != before[1]).any()


@pytest.mark.slow
def test_rprop_is_that_of_torch():
    import torch

    rng = np.random.default_rng(0)
    mine, curvature = rng.standard_normal(20), 5 * rng.random(20)
    theirs = torch.tensor(mine, requires_grad=True)
    optimiser = torch.optim.Rprop([theirs], lr=0.01)
    size, before = np.array(0.01), np.array(0.0)
    for _ in range(60):
        step, size, before = rprop(curvature * mine, size, before)
        mine = mine - step
        optimiser.zero_grad()
        (torch.tensor(curvature) * theirs**2 / 2).sum().backward()
        optimiser.step()
        np.testing.assert_allclose(mine, theirs.detach(), rtol=1e-12, atol=1e-15)
    assert np.abs(mine).max() < 0.05


def test_adam_is_that_of_torch():
    import torch

    rng = np.random.default_rng(0)
    mine, curvature = rng.standard_normal(20), 5 * rng.random(20)
    theirs = torch.tensor(mine, requires_grad=True)
    optimiser = torch.optim.Adam([theirs], lr=0.01)
    first = second = np.zeros(20)
    for k in range(30):
        step, first, second = adam(curvature * mine, first, second, k + 1)
        mine = mine - 0.01 * step
        optimiser.zero_grad()
        (torch.tensor(curvature) * theirs**2 / 2).sum().backward()
        optimiser.step()
        np.testing.assert_allclose(mine, theirs.detach(), rtol=1e-12, atol=1e-15)


def plain(own, target):
    """The largest value of the target network."""
    return target.max()


def double(own, target):
    """The target network's value of the action that the network chooses."""
    return target[own.argmax()]


@pytest.mark.parametrize(
    ("targets", "estimate"), [(dqn_targets, plain), (double_dqn_targets, double)]
)
def test_dqn_learns_from_its_estimate(targets, estimate):
    """One update on one step, of which the two estimates differ."""
    agent = DQNAgent(
        networks(seeds=1),
        (0,),
        4,
        discount=GAMMA,
        gradient_step=0.01,
        batch_size=1,
        target_update_interval=1000,
        targets=targets,
    )
    rng, zero = np.random.default_rng(1), np.array([0])
    agent.target.load(
        zero, agent.target.parameters() + 0.5 * rng.standard_normal((1, 58))
    )
    x, reached = np.eye(4)[[0]], np.eye(4)[[1]]
    own, target = (
        vectors_to_parameters(n.parameters(), (4, 8, 2))[0]
        for n in (agent.networks, agent.target)
    )
    after = own.logits(reached[0]), target.logits(reached[0])
    assert after[0].argmax() != after[1].argmax()
    wanted = 0.2 + GAMMA * estimate(*after)
    before, action = agent.networks.parameters(), np.array([[1]])
    slope, _ = agent.networks.gradients(
        zero, x[None], action, np.array([[wanted]]), linear=True
    )
    values = agent.values(zero, x)
    agent.observe(
        zero,
        Experience(
            x,
            values,
            action[0],
            np.array([0.2]),
            reached,
            np.array([False]),
            np.zeros(1),
        ),
    )
    step, _, _ = adam(slope, np.zeros(58), np.zeros(58), 1)
    np.testing.assert_allclose(
        agent.networks.parameters(), before - 0.01 * step, rtol=1e-12
    )


def test_the_target_network_stands_still_between_refreshes():
    agent = DQNAgent(
        networks(),
        (0, 1),
        4,
        discount=GAMMA,
        gradient_step=0.01,
        batch_size=2,
        target_update_interval=5,
    )
    stood = 0
    for k, (rows, steps) in enumerate(corridor_steps(agent, 12)):
        before = agent.target.parameters()
        agent.observe(rows, steps)
        updates = k + 1 - 2 + 1
        if updates > 0 and updates % 5 == 0:
            np.testing.assert_array_equal(
                agent.target.parameters(), agent.networks.parameters()
            )
        else:
            np.testing.assert_array_equal(agent.target.parameters(), before)
            stood += 1
    assert stood == 10


def test_replay_buffers_grow_and_come_back():
    buffers, rng, row = ReplayBuffers(2, 3), np.random.default_rng(0), np.array([1])
    kept = []
    for _ in range(1500):
        x = rng.random((1, 3))
        buffers.append(row, x, row, np.array([0.5]), x + 1, np.array([False]))
        kept.append(x[0])
    other = ReplayBuffers(2, 3)
    other.restore(buffers.state())
    for one in (buffers, other):
        assert one.count.tolist() == [0, 1500]
        np.testing.assert_array_equal(one.inputs[1, :1500], kept)
        np.testing.assert_array_equal(one.reached[1, :1500], np.array(kept) + 1)
    other.append(row, x, row, np.array([0.5]), x, np.array([True]))
    assert other.terminal[1, 1500]
