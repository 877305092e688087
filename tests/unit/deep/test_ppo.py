"""PPO: its estimates and its objective against their definitions, its twin, and what it learns."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
import torch

from robonav.deep import (
    ActorCritic,
    Batch,
    actor_critic,
    advantages,
    clipped_surrogate,
    navigation_task,
    objective,
    ppo,
    train_ppo,
)
from robonav.deep._fast import StackedModule
from robonav.deep.ppo import Actor, batch_of, minibatches, standardised
from robonav.networks import random_network, stacked
from robonav.networks.torch_module import as_module
from robonav.nnql import navigate_greedily
from robonav.robot import navigate, random_worlds

CLIP, VALUE_WEIGHT, ENTROPY_WEIGHT = 0.2, 0.7, 0.05


def doubles(*numbers):
    return torch.tensor(numbers, dtype=torch.float64)


def random_batch(steps=12, states=3, actions=4, *, stack=(), seed=0):
    """Steps with ratios far from 1, of which some were a reflex's."""
    rng = np.random.default_rng(seed)
    shape = (*stack, steps)
    return Batch(
        states=torch.tensor(rng.normal(size=(*shape, states))),
        actions=torch.tensor(rng.integers(actions, size=shape)),
        log_probabilities=torch.tensor(np.log(rng.uniform(0.1, 0.6, shape))),
        advantages=torch.tensor(rng.normal(size=shape)),
        returns=torch.tensor(rng.normal(size=shape)),
        decided=torch.tensor(rng.random(shape) < 0.7),
    )


def networks(states=3, actions=4, *, seed=0):
    return ActorCritic(
        random_network((states, 5, actions), seed=seed),
        random_network((states, 5, 1), seed=seed + 100),
    )


def by_hand(own, batch):
    """Eq. (9) in a loop over the steps, with the networks of this package and not of torch."""
    surrogates, errors = [], []
    for k in range(len(batch)):
        state = batch.states[k].numpy()
        z = own.policy.logits(state)
        p = np.exp(z) / np.exp(z).sum()
        ratio = p[batch.actions[k]] / np.exp(batch.log_probabilities[k].item())
        a = batch.advantages[k].item()
        surrogate = min(ratio, 1 + CLIP) * a if a >= 0 else max(ratio, 1 - CLIP) * a
        if batch.decided[k]:
            surrogates.append(surrogate - ENTROPY_WEIGHT * (p * np.log(p)).sum())
        errors.append((own.value.logits(state)[0] - batch.returns[k].item()) ** 2)
    return np.mean(surrogates) - VALUE_WEIGHT * np.mean(errors)


def test_advantages_are_the_sum_of_their_definition():
    rng = np.random.default_rng(3)
    steps, gamma, decay = 40, 0.9, 0.7
    rewards, values, next_values = rng.normal(size=(3, steps))
    terminal = rng.random(steps) < 0.1
    ended = terminal | (rng.random(steps) < 0.1)
    assert terminal.any()
    assert (ended & ~terminal).any()
    expected = []
    for t in range(steps):
        total = 0.0
        for k in range(t, steps):
            delta = rewards[k] - values[k]
            if not terminal[k]:
                delta += gamma * next_values[k]
            total += (gamma * decay) ** (k - t) * delta
            if ended[k]:
                break
        expected.append(total)
    given = map(torch.tensor, (rewards, values, next_values, terminal, ended))
    found = advantages(*given, gamma, decay)
    np.testing.assert_allclose(found.numpy(), expected, rtol=1e-12)


def test_with_lambda_1_advantages_are_returns_less_values():
    rewards, values, no = doubles(1, 2, 4), doubles(5, 6, 7), torch.zeros(3) > 0
    next_values, last = doubles(6, 7, 8), torch.tensor([False, False, True])
    found = advantages(rewards, values, next_values, no, last, 0.5, 1.0)
    # 1 + 2/2 + 4/4 + 8/8 - 5, and so on
    np.testing.assert_allclose(found.numpy(), [-1, 0, 1])
    at_end = advantages(rewards, values, next_values, last, last, 0.5, 1.0)
    np.testing.assert_allclose(at_end.numpy(), [-2, -2, -3])


@pytest.mark.parametrize(
    ("ratio", "advantage", "surrogate", "slope"),
    [
        (1.1, 2.0, 2.2, 2.0),  # within the bounds
        (1.3, 2.0, 2.4, 0.0),  # better than the bound: nothing more to gain
        (0.7, 2.0, 1.4, 2.0),  # worse: the way back pays
        (0.7, -2.0, -1.6, 0.0),
        (1.3, -2.0, -2.6, -2.0),
    ],
)
def test_clipped_surrogate(ratio, advantage, surrogate, slope):
    rho = doubles(ratio).requires_grad_()
    found = clipped_surrogate(rho, doubles(advantage), CLIP)
    found.sum().backward()
    np.testing.assert_allclose(found.detach().numpy(), [surrogate])
    np.testing.assert_allclose(rho.grad.numpy(), [slope])


def test_objective_is_the_equation_written_out():
    own, batch = networks(), random_batch()
    found = objective(
        as_module(own.policy), as_module(own.value), batch,
        CLIP, VALUE_WEIGHT, ENTROPY_WEIGHT,
    )  # fmt: skip
    assert found.item() == pytest.approx(by_hand(own, batch), rel=1e-12)


def test_gradient_is_the_numerical_one():
    own, batch = networks(), random_batch()
    policy, value = as_module(own.policy), as_module(own.value)
    weights = (CLIP, VALUE_WEIGHT, ENTROPY_WEIGHT)
    objective(policy, value, batch, *weights).backward()
    for parameter in [*policy.parameters(), *value.parameters()]:
        flat, slope = parameter.data.view(-1), parameter.grad.view(-1)
        for k in range(len(flat)):
            before, ends = flat[k].item(), []
            for step in (1e-6, -1e-6):
                flat[k] = before + step
                with torch.no_grad():
                    ends.append(objective(policy, value, batch, *weights).item())
            flat[k] = before
            assert slope[k].item() == pytest.approx(
                (ends[0] - ends[1]) / 2e-6, abs=1e-7
            )


def test_stacked_networks_have_the_objective_of_each():
    several = [networks(seed=seed) for seed in range(3)]
    batch = random_batch(stack=(3,))
    policy = StackedModule(stacked([one.policy for one in several]))
    value = StackedModule(stacked([one.value for one in several]))
    found = objective(policy, value, batch, CLIP, VALUE_WEIGHT, ENTROPY_WEIGHT)
    expected = [by_hand(one, batch[k]) for k, one in enumerate(several)]
    np.testing.assert_allclose(found.detach().numpy(), expected, rtol=1e-12)


def test_steps_of_a_reflex_teach_the_policy_nothing():
    own, batch = networks(), random_batch()
    policy, value = as_module(own.policy), as_module(own.value)
    other = replace(
        batch, actions=torch.where(batch.decided, batch.actions, 3 - batch.actions)
    )
    assert (other.actions != batch.actions).any()
    gains = [
        objective(policy, value, steps, CLIP, VALUE_WEIGHT, ENTROPY_WEIGHT).item()
        for steps in (batch, other)
    ]
    assert gains[0] == gains[1]
    nobody = replace(batch, decided=torch.zeros_like(batch.decided))
    alone = objective(policy, value, nobody, CLIP, VALUE_WEIGHT, ENTROPY_WEIGHT).item()
    errors = (value(batch.states)[:, 0] - batch.returns) ** 2
    assert alone == pytest.approx(-VALUE_WEIGHT * errors.mean().item())


def test_chosen_numbers_are_standardised():
    numbers, chosen = doubles(1, 2, 3, 100), torch.tensor([True, True, True, False])
    found = standardised(numbers, chosen).numpy()
    np.testing.assert_allclose(found[:3], np.array([-1, 0, 1]) * np.sqrt(1.5))
    assert np.isfinite(standardised(doubles(2, 2), torch.ones(2) > 0).numpy()).all()


def test_an_epoch_goes_through_every_step_once():
    orders = list(minibatches(10, 2, 3, np.random.default_rng(0)))
    assert [len(rows) for rows in orders] == [4, 3, 3] * 2
    epochs = [np.concatenate(orders[:3]), np.concatenate(orders[3:])]
    assert [sorted(epoch) for epoch in epochs] == [list(range(10))] * 2
    assert epochs[0].tolist() != epochs[1].tolist()


def test_batch_has_the_probabilities_and_returns_of_the_networks_that_acted():
    task = navigation_task(max_steps=30)
    env = task.environment()
    own = actor_critic(env, seed=1)
    policy, value = as_module(own.policy), as_module(own.value)
    rollout = Actor(env, 0, 0).act(policy, 50)
    batch = batch_of([rollout], policy, value, 0.9, 1.0)
    assert rollout.ended.sum() >= 1
    assert 0 < rollout.decided.sum() < 50
    z = own.policy.logits(rollout.states.numpy())
    p = np.exp(z) / np.exp(z).sum(axis=1, keepdims=True)
    taken = p[np.arange(50), rollout.actions.numpy()]
    np.testing.assert_allclose(batch.log_probabilities.exp().numpy(), taken)
    last = int(np.flatnonzero(rollout.ended.numpy())[0])
    total = 0.0 if rollout.terminal[last] else own.value.logits(rollout.next_states[last].numpy())[0]  # fmt: skip
    for t in range(last, -1, -1):
        total = rollout.rewards[t].item() + 0.9 * total
        assert batch.returns[t].item() == pytest.approx(total)


@pytest.mark.parametrize("seed", [0, 7])
def test_twin_equal_to_readable_function(seed):
    task = navigation_task(max_steps=60)
    settings = {"updates": 3, "steps": 40, "epochs": 2, "batches": 3}
    envs = [task.environment() for _ in range(3)]
    start = actor_critic(envs[0], hidden=(9, 6), seed=seed)
    readable = ppo(envs, start, seed=seed, **settings)
    twin = train_ppo([3, seed], task=task, actors=3, hidden=(9, 6), **settings)
    assert twin.ended[1].sum() > 3
    assert_same_networks(readable, twin)


def assert_same_networks(readable, twin):
    """The second seed of the twin has the networks of the readable function."""
    for one, several in ((readable.policy, twin.policy), (readable.value, twin.value)):
        pairs = zip(
            (*one.weights, *one.biases),
            (*several.weights, *several.biases),
            strict=True,
        )
        for expected, found in pairs:
            np.testing.assert_allclose(found[1], expected, rtol=1e-8, atol=1e-8)


def test_training_goes_on_in_other_worlds():
    settings = {"updates": 2, "steps": 40, "epochs": 2, "batches": 3}
    stages = [navigation_task(max_steps=60), navigation_task(obstacles=30, moving=2)]
    readable = actor_critic(stages[0].environment(), hidden=(9,), seed=5)
    twin = None
    for number, task in enumerate(stages):
        envs, seed = [task.environment() for _ in range(3)], 5 + 100 * number
        readable = ppo(envs, readable, seed=seed, **settings)
        twin = train_ppo([3, seed], task=task, actors=3, hidden=(9,), start=twin, **settings)  # fmt: skip
    assert_same_networks(readable, twin)
    assert twin.settings["hidden"] == (9,)


class Corridor(gymnasium.Env):
    """Five places in a row; action 1 goes right, 0 left; the right end gives 1 and ends the episode."""

    observation_space = gymnasium.spaces.Discrete(5)
    action_space = gymnasium.spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place = int(self.np_random.integers(4))
        return self.place, {}

    def step(self, action):
        self.place = max(self.place + (1 if action == 1 else -1), 0)
        end = self.place == 4
        return self.place, float(end), end, False, {}


def corridors(number=2):
    return [gymnasium.wrappers.TimeLimit(Corridor(), 30) for _ in range(number)]


def trained_in_corridor(seed, updates):
    envs = corridors()
    settings = {"updates": updates, "steps": 64, "discount": 0.9, "entropy_weight": 0.0}
    return ppo(envs, actor_critic(envs[0], hidden=(8,), seed=seed), seed=seed, **settings)  # fmt: skip


@pytest.mark.slow
def test_corridor_policy_and_values():
    trained = trained_in_corridor(0, 25)
    places = np.eye(5)[:4]
    assert trained.policy.logits(places).argmax(axis=1).tolist() == [1, 1, 1, 1]
    best = 0.9 ** np.array([3, 2, 1, 0])
    np.testing.assert_allclose(trained.value.logits(places)[:, 0], best, atol=0.15)


def test_same_seed_same_numbers():
    first, again, other = (trained_in_corridor(seed, 2) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.policy.weights[0], again.policy.weights[0])
    np.testing.assert_array_equal(first.value.weights[1], again.value.weights[1])
    assert (first.policy.weights[0] != other.policy.weights[0]).all()


@pytest.mark.slow
def test_cartpole():
    envs = [gymnasium.make("CartPole-v1") for _ in range(8)]
    trained = ppo(
        envs, actor_critic(envs[0], seed=0), updates=20, epochs=10, seed=0,
        entropy_weight=0.01,
    )  # fmt: skip
    lengths = [navigate_greedily(envs[0], trained.policy, seed=k)[0] for k in range(5)]
    assert np.mean(lengths) >= 195


@pytest.mark.slow
def test_robot_learns_to_cross_the_map():
    result = train_ppo(seeds=1, updates=30)
    worlds = random_worlds(100, obstacles=10, seed=5)
    found = [navigate(policy, worlds).success.mean() for policy in result.policies]
    assert min(found) > 0.9
    assert (result.arrived <= result.ended).all()
    assert (
        result.arrived[:, -5:].sum(axis=1) > result.arrived[:, :5].sum(axis=1)
    ).all()


def test_progress_is_reported():
    seen = []
    train_ppo(1, 2, actors=2, steps=4, progress=lambda done, total: seen.append((done, total)))  # fmt: skip
    assert seen == [(1, 2), (2, 2)]


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: ppo(corridors()[0], None, updates=1, seed=0), TypeError, "envs must be a sequence of at least one"),
        (lambda: ppo([], None, updates=1, seed=0), TypeError, "envs must be a sequence of at least one"),
        (lambda: ppo(corridors(), None, updates=1, seed=0), TypeError, "networks must be ActorCritic, got NoneType"),
        (lambda: ppo(corridors(), networks(), updates=1, seed=0), ValueError, "networks must take the 5 numbers"),
        (lambda: train_ppo(updates=0), ValueError, "updates must be at least 1, got 0"),
        (lambda: train_ppo(clip=1.0), ValueError, "clip must be greater than 0 and less than 1"),
        (lambda: train_ppo(batches=5000), ValueError, "batches must be at most 2048"),
        (lambda: train_ppo(step=3), TypeError, "the settings are steps, .*, got step"),
        (lambda: train_ppo(2, 1, start=train_ppo(1, 1, actors=2, steps=4)), ValueError, "start must be .* of 2 seeds"),
        (lambda: train_ppo(1, 1, start=3), TypeError, "start must be PPOResult, got int"),
        (lambda: train_ppo(hidden=32), TypeError, "hidden must be a sequence of whole numbers, got 32"),
        (lambda: train_ppo(task=3), TypeError, "task must be NavigationTask, got int"),
        (lambda: actor_critic(gymnasium.make("Pendulum-v1"), seed=0), TypeError, "must be discrete"),
    ],
)  # fmt: skip
def test_wrong_input_gets_one_sentence(call, error, message):
    with pytest.raises(error, match=message) as caught:
        call()
    assert "\n" not in str(caught.value)
