"""GAIL: the discriminator against its definition and its optimum, the twin, and what the rewards teach."""

import gymnasium
import numpy as np
import pytest
import torch

from robonav.deep import (
    actor_critic,
    best_discriminator,
    constant_reward,
    deceiving_reward,
    discriminator_loss,
    gail,
    hurrying_reward,
    log_odds,
    navigation_task,
    random_discriminator,
    train_gail,
)
from robonav.deep.adversarial_training import expert_pairs
from robonav.deep.gail import minibatch_pairs, own_pairs, pairs, rewarded
from robonav.deep.ppo import Actor
from robonav.lfd import demonstrate
from robonav.networks import random_network
from robonav.networks.torch_module import as_module
from robonav.robot import navigate, random_worlds

ACTIONS = 5


@pytest.fixture(scope="module")
def shown():
    return demonstrate(random_worlds(10, obstacles=10, seed=777), speed=2.0)


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


def test_loss_is_the_cross_entropy_of_its_definition():
    rng = np.random.default_rng(2)
    learners, experts = rng.normal(size=(2, 3, 9))
    decided = rng.random((3, 9)) < 0.6
    found = discriminator_loss(*map(torch.tensor, (learners, experts, decided)))
    expected = [
        np.mean([-np.log(sigmoid(f)) for f in learners[k][decided[k]]])
        + np.mean([-np.log(1 - sigmoid(f)) for f in experts[k]])
        for k in range(3)
    ]
    np.testing.assert_allclose(found.numpy(), expected, rtol=1e-12)


def test_gradient_of_the_loss_against_differences():
    judge = as_module(random_discriminator(gymnasium.make("CartPole-v1"), seed=3))
    rng = np.random.default_rng(0)
    own, expert = torch.tensor(rng.normal(size=(2, 7, 6)))
    decided = torch.tensor(rng.random(7) < 0.7)

    def loss():
        return discriminator_loss(judge(own)[..., 0], judge(expert)[..., 0], decided)

    loss().backward()
    for parameter in judge.parameters():
        place = np.unravel_index(int(parameter.grad.abs().argmax()), parameter.shape)
        slope = parameter.grad[place].item()
        changed = []
        for step in (1e-5, -1e-5):
            with torch.no_grad():
                parameter[place] += step
                changed.append(loss().item())
                parameter[place] -= step
        assert slope == pytest.approx((changed[0] - changed[1]) / 2e-5, rel=1e-5)


def test_the_best_discriminator_is_the_share_of_the_learner():
    """Where both make a pair with the probabilities p and q, the loss is least at D = p / (p + q)."""
    p, q = np.array([0.6, 0.3, 0.1]), np.array([0.2, 0.3, 0.5])
    counts = [np.repeat(range(3), np.round(20 * each).astype(int)) for each in (p, q)]
    own, expert = (torch.eye(3, dtype=torch.float64)[torch.tensor(c)] for c in counts)
    logits = torch.zeros(3, dtype=torch.float64, requires_grad=True)
    optimiser = torch.optim.LBFGS(
        [logits], max_iter=200, tolerance_grad=1e-9, tolerance_change=0
    )

    def closure():
        optimiser.zero_grad()
        loss = discriminator_loss(own @ logits, expert @ logits, own[:, 0] >= 0)
        loss.backward()
        return loss

    optimiser.step(closure)
    found = sigmoid(logits.detach().numpy())
    np.testing.assert_allclose(found, best_discriminator(p, q), atol=1e-6)


def test_rewards():
    logits = torch.tensor([-3.0, 0.0, 2.0], dtype=torch.float64)
    d = sigmoid(logits.numpy())
    np.testing.assert_allclose(deceiving_reward(logits), -np.log(d))
    np.testing.assert_allclose(hurrying_reward(logits), np.log(1 - d))
    np.testing.assert_allclose(log_odds(logits), np.log(1 - d) - np.log(d))
    assert (deceiving_reward(logits) > 0).all()
    assert (hurrying_reward(logits) < 0).all()
    assert constant_reward(logits).tolist() == [1, 1, 1]


def test_pairs_join_states_and_indicators():
    joined = pairs(np.array([[0.5, 2.0], [3.0, 4.0]]), np.array([2, 0]), 3)
    assert joined.tolist() == [[0.5, 2, 0, 0, 1], [3, 4, 1, 0, 0]]


def test_steps_of_a_reflex_earn_nothing_and_are_not_judged():
    env = navigation_task(max_steps=40).environment()
    networks = actor_critic(env, seed=1)
    judge = as_module(random_discriminator(env, seed=1))
    rollout = Actor(env, 0, 0).act(as_module(networks.policy), 40)
    assert 0 < rollout.decided.sum() < 40
    own, decided = own_pairs([rollout], ACTIONS)
    logits = judge(own)[:, 0].detach()
    found = rewarded(rollout, judge, deceiving_reward, ACTIONS).rewards
    assert (found[~rollout.decided] == 0).all()
    np.testing.assert_allclose(
        found[rollout.decided], deceiving_reward(logits[rollout.decided])
    )
    other = torch.where(decided, logits, logits + 5.0)
    losses = [
        discriminator_loss(x, torch.zeros(4), decided).item() for x in (logits, other)
    ]
    assert losses[0] == losses[1]


def test_minibatches_go_through_the_learner_and_draw_from_the_expert():
    made = list(minibatch_pairs(10, 4, 2, 3, np.random.default_rng(0)))
    assert [len(own) for own, _ in made] == [4, 3, 3] * 2
    assert sorted(np.concatenate([own for own, _ in made[:3]])) == list(range(10))
    assert all(len(own) == len(expert) for own, expert in made)
    assert set(np.concatenate([expert for _, expert in made])) == {0, 1, 2, 3}


def test_expert_pairs_leave_the_reflex_out(shown):
    task = navigation_task()
    found = expert_pairs(shown, task)
    chosen = shown.actions < ACTIONS
    assert 0 < chosen.sum() < len(shown)
    assert found.shape == (chosen.sum(), task.encoder.size + ACTIONS)
    actions = found[:, task.encoder.size :].argmax(dim=1).numpy()
    np.testing.assert_array_equal(actions, shown.actions[chosen])


@pytest.mark.parametrize("reward", [deceiving_reward, log_odds])
def test_twin_equal_to_readable_function(shown, reward):
    task = navigation_task(max_steps=60)
    settings = {"updates": 3, "steps": 40, "epochs": 2, "batches": 3, "reward": reward}
    envs = [task.environment() for _ in range(3)]
    start = actor_critic(envs[0], hidden=(9, 6), seed=7)
    judge = random_discriminator(envs[0], hidden=(9, 6), seed=7)
    chosen = shown[shown.actions < ACTIONS]
    states = task.encoder(chosen.sensing)
    readable = gail(envs, start, judge, states, chosen.actions, seed=7, **settings)
    others = shown.select_trajectories([0, 1])
    twin = train_gail([others, shown], [3, 7], task=task, actors=3, hidden=(9, 6), **settings)  # fmt: skip
    assert twin.ended[1].sum() > 3
    for one, several in ((readable.policy, twin.policy), (readable.value, twin.value)):
        parts = zip(
            (*one.weights, *one.biases),
            (*several.weights, *several.biases),
            strict=True,
        )
        for expected, found in parts:
            np.testing.assert_allclose(found[1], expected, rtol=1e-8, atol=1e-8)


@pytest.mark.slow
def test_a_robot_learns_from_drives_and_not_from_staying_alive(shown):
    worlds = random_worlds(100, obstacles=10, seed=5)
    success = {}
    for reward in (deceiving_reward, constant_reward):
        result = train_gail(shown, 1, 30, reward=reward)
        found = [navigate(policy, worlds).success.mean() for policy in result.policies]
        success[reward.__name__] = np.mean(found)
    assert success["deceiving_reward"] > 0.75
    assert success["constant_reward"] < 0.6


def test_progress_is_reported(shown):
    seen = []
    train_gail(shown, 1, 2, actors=2, steps=4, progress=lambda done, total: seen.append((done, total)))  # fmt: skip
    assert seen == [(1, 2), (2, 2)]


def on_cartpole(**changes):
    env = gymnasium.make("CartPole-v1")
    given = {
        "discriminator": random_discriminator(env, seed=0),
        "states": np.zeros((2, 4)),
        "actions": [0, 1],
    } | changes
    return gail([env], actor_critic(env, seed=0), updates=1, steps=8, seed=0, **given)


@pytest.mark.parametrize(
    ("changes", "error", "message"),
    [
        ({"states": np.zeros((2, 3))}, ValueError, "states must have a row of 4 numbers for each of the 2 actions"),
        ({"states": np.zeros((0, 4)), "actions": []}, ValueError, "states must have a row of 4 numbers"),
        ({"actions": [0, 2]}, ValueError, "actions must be from 0 to 1, got 0 to 2"),
        ({"actions": [0.5, 1]}, ValueError, "actions must hold whole numbers"),
        ({"discriminator": random_network((5, 1), seed=0)}, ValueError, "discriminator must take the 4 numbers"),
        ({"discriminator": None}, TypeError, "discriminator must be Network, got NoneType"),
        ({"reward": 3}, TypeError, "reward must be"),
    ],
)  # fmt: skip
def test_wrong_input_gets_one_sentence(changes, error, message):
    assert on_cartpole().policy.sizes == (4, 32, 2)
    with pytest.raises(error, match=message) as caught:
        on_cartpole(**changes)
    assert "\n" not in str(caught.value)


def test_demonstrations_without_decisions_are_refused(shown):
    reflexes = shown[shown.actions >= ACTIONS]
    with pytest.raises(ValueError, match="at least one step without a reflex"):
        train_gail(reflexes, 1, 1)
    with pytest.raises(TypeError, match="demonstrations must be Demonstrations"):
        train_gail(3, 1, 1)
    with pytest.raises(ValueError, match="one for each of 2 seeds, got 3"):
        train_gail([shown] * 3, 2, 1)
