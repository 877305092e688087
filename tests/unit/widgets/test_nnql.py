"""The page's Q-learning against Python's readable functions: worlds, updates, whole trainings."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest
import torch
from scipy.stats import binomtest

from robonav.experiments import bootstrap_interval
from robonav.networks import CROSS_ENTROPY
from robonav.nnql import (
    STARTS,
    TARGETS,
    q_network,
    reward_row,
    train,
    train_on_pairs,
)
from robonav.nnql.reward import REWARDS
from robonav.robot import Sensing, navigate, random_worlds
from robonav.widgets.q_learning_faults import FAULTS, OF_THE_TABLES
from robonav.widgets.q_learning_lab import MAPS_SEED
from robonav.widgets.q_learning_settings import INPUTS, QLearningSettings
from robonav.widgets.simulator import page_world

MODULES = {"nnql": "nnql", "online": "nnql", "dqn": "dqn"}
FILES = (
    "simulator",
    "learning/random",
    "learning/network",
    "learning/worlds",
    "learning/nnql",
    "learning/trials",
    "learning/dqn",
)

DQN = {
    "method": "dqn",
    "inputs": "sine-cosine",
    "discount": 0.7,
    "gradient_step": (0.003, 0.003),
}

FIRST_UPDATES = """
const slopes = ({ sizes, parameters }, { inputs, targets, gradient }) => {
  if (gradient) return { gradient: [...gradient], cost: null };
  const examples = page.examplesOf(inputs.map((row) => [...row]), targets.map((row) => [...row]));
  const own = new Float64Array(parameters.length);
  const cost = page.costFunction("cross-entropy", sizes, examples).evaluate(parameters, own);
  return { gradient: [...own], cost };
};
return data.map((settings) => {
  const first = settings.method === "dqn" ? 32 : 1; // DQN waits for a batch
  const [seen, looked] = [[], [1, 10, 100].map((update) => first - 1 + update)];
  let updates = 0;
  const watch = ({ q, network, ...learned }) => {
    updates += 1;
    if (!looked.includes(updates)) return;
    seen.push({ q: [...q], weights: [...network.parameters], ...slopes(network, learned) });
  };
  for (const _ of page.neuralQLearning(settings, { watch })) if (seen.length === 3) break;
  return seen;
});
"""
"""Of updates 1, 10 and 100: the Q-values before, the weights after, and the cost and its gradient in these weights, of
the pairs that were learned. DQN gives the gradient that it descends."""


class Enough(Exception):
    """The updates that a test looks at have been made."""


def flat(network):
    """Weights and then biases as one array."""
    return np.concatenate(
        [part.ravel() for part in (*network.weights, *network.biases)]
    )


def first_updates(monkeypatch, settings):
    """What FIRST_UPDATES gives, of a readable function."""
    module = import_module(f"robonav.nnql.{MODULES[settings.method]}")
    values, updates = [], []
    softmax_policy = module.softmax_policy

    def watched_policy(q, temperature):
        values.append(q)
        return softmax_policy(q, temperature)

    def watch(**update):
        updates.append({"q": values[-1], **update})
        if len(updates) == 100:
            raise Enough

    class WatchedAdam(torch.optim.Adam):
        def step(self, closure=None):
            super().step(closure)
            parts = self.param_groups[0]["params"]  # weights and biases take turns
            parts = [*parts[::2], *parts[1::2]]
            weights = torch.cat([part.detach().ravel() for part in parts])
            gradient = torch.cat([part.grad.ravel() for part in parts])
            watch(weights=weights.numpy(), gradient=gradient.numpy(), cost=None)

    def watched_descent(network, inputs, targets, *more):
        network = train_on_pairs(network, inputs, targets, *more)
        x, y = np.array(inputs), np.array(targets)
        watch(
            weights=flat(network),
            gradient=flat(CROSS_ENTROPY.gradient(network, x, y)),
            cost=CROSS_ENTROPY.cost(network, x, y),
        )
        return network

    env, method = settings.task().environment(), getattr(module, settings.method)
    network = q_network(env, hidden=settings.hidden, seed=settings.seed)
    hyperparameters = settings.hyperparameters()
    with monkeypatch.context() as patch:
        patch.setattr(module, "softmax_policy", watched_policy)
        patch.setattr(torch.optim, "Adam", WatchedAdam)
        if settings.method != "dqn":
            patch.setattr(module, "train_on_pairs", watched_descent)
        with pytest.raises(Enough):
            method(
                env,
                network,
                episodes=settings.episodes,
                seed=settings.seed,
                **hyperparameters,
            )
    return [updates[update - 1] for update in (1, 10, 100)]


def same_updates(node, monkeypatch, cases):
    """The page makes the same updates as Python."""
    shown = node(FILES, FIRST_UPDATES, [settings.for_page() for settings in cases])
    for settings, updates in zip(cases, shown, strict=True):
        expected = first_updates(monkeypatch, settings)
        for theirs, ours in zip(expected, updates, strict=True):
            for what in ("q", "weights", "gradient"):
                np.testing.assert_allclose(ours[what], theirs[what], rtol=0, atol=1e-9)
            assert ours["cost"] == pytest.approx(theirs["cost"], abs=1e-9)


def test_updates_are_pythons(node, monkeypatch):
    cases = [QLearningSettings(), QLearningSettings(**DQN)]
    same_updates(node, monkeypatch, cases)


@pytest.mark.slow
def test_updates_of_twenty_seeds_are_pythons(node, monkeypatch):
    cases = [QLearningSettings(seed=seed) for seed in range(20)]
    same_updates(node, monkeypatch, cases)


@pytest.mark.slow
def test_updates_are_pythons_in_every_setting(node, monkeypatch):
    online = {
        "method": "online",
        "learning_rate": (0.8, 0.8),
        "discount": 0.7,
        "gradient_step": (0.3, 0.3),
        "rescale": "clip",
        "passes": 1,
    }
    paid = REWARDS.copy()
    paid[[2, 6]] = 0.6, 0.0
    cases = [
        QLearningSettings(obstacles=14, moving=6, speed=1.5, seed=4),
        QLearningSettings(temperature=(0.03, 0.03), hidden=4, seed=5),
        QLearningSettings(rewards=tuple(paid), must_move_away=True, seed=6),
        QLearningSettings(**{**online, "method": "nnql"}, seed=7),
        *(QLearningSettings(inputs=inputs, seed=8) for inputs in INPUTS),
        *(QLearningSettings(**online, seed=seed) for seed in range(20)),
        *(QLearningSettings(**DQN, seed=seed) for seed in range(20)),
    ]
    same_updates(node, monkeypatch, cases)


TRAINED = """
const { settings, worlds, speed, steps } = data;
return settings.map((own) => {
  const outcomes = [];
  let network = null;
  for (const episode of page.neuralQLearning(own)) {
    if (!episode) continue; // within an episode
    outcomes.push(episode.outcome);
    network = episode.network;
  }
  const policy = { network, encoder: page.encoderOf(own) };
  const demonstrations = worlds.map((world) => page.rollout(policy, world, { speed, maxSteps: steps }).outcome);
  return { outcomes, arrived: demonstrations.filter((outcome) => outcome === "arrived").length };
});
"""


LONGEST = """
let [longest, last] = [0, process.cpuUsage()];
for (const _ of page.neuralQLearning(data)) {
  const { user } = process.cpuUsage(last);
  [longest, last] = [Math.max(longest, user / 1000), process.cpuUsage()];
}
return longest;
"""
"""Milliseconds of computing between two places where the page may answer."""


@pytest.mark.slow
def test_without_a_worker_the_page_answers_within_100_ms(node):
    """The job gives the page a turn within an episode, too: with many passes an episode takes longer than a second."""
    slow = QLearningSettings(
        obstacles=30, moving=10, hidden=20, passes=10, tolerance=0, episodes=25
    )
    assert node(FILES, LONGEST, slow.for_page()) < 100


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize(
    ("method", "seeds"),
    [
        ("nnql", 5),
        ("dqn", 5),
        *(
            pytest.param(method, 20, marks=pytest.mark.exhaustive)
            for method in ("nnql", "online", "dqn")
        ),
    ],
)
def test_whole_trainings_succeed_as_often_as_pythons(node, method, seeds):
    online = {"rescale": "clip", "passes": 1, "discount": 0.7}
    own = {"nnql": {}, "online": online, "dqn": DQN}[method]
    first = QLearningSettings(**own | {"method": method})
    settings = [replace(first, seed=seed) for seed in range(seeds)]
    worlds = random_worlds(200, 10, seed=44_000, starts=STARTS, targets=TARGETS)
    data = {
        "settings": [own.for_page() for own in settings],
        "worlds": [page_world(world) for world in worlds],
        "speed": 2.5,
        "steps": 400,
    }
    page = node(FILES, TRAINED, data)
    python = train(method, 20, 300, task=first.task(), **first.hyperparameters())
    learning = [np.mean([end == "arrived" for end in one["outcomes"]]) for one in page]
    driving = [one["arrived"] / 200 for one in page]
    rates = [navigate(p, worlds, 2.5, 400).success.mean() for p in python.policies]
    for ours, theirs in (
        (learning, python.successes.mean(axis=1)),
        (driving, np.array(rates)),
    ):
        (low, high), (least, most) = (
            bootstrap_interval(100 * np.array(both)) for both in (ours, theirs)
        )
        assert low <= most
        assert least <= high


def test_rows_of_the_reward_are_pythons(node):
    rng = np.random.default_rng(0)
    nearest = (
        np.round(rng.uniform(0.5, 12, (2000, 2)).clip(0, 10) * 4) / 4
    )  # borders, too
    outcome = rng.choice([0, 0, 0, 1, 2], 2000).astype(np.int8)
    before, after = (Sensing.empty(2000) for _ in range(2))
    before.ranges[:], after.ranges[:] = nearest[:, :1], nearest[:, 1:]
    expected = reward_row(before, after, outcome)
    body = """return data.map(([before, after, outcome]) =>
      page.rewardRow({ ranges: [before, 10] }, { ranges: [10, after] }, outcome));"""
    names = np.array(["running", "arrived", "collided"])[outcome].tolist()
    steps = [[*pair, name] for pair, name in zip(nearest.tolist(), names, strict=True)]
    assert node(FILES, body, steps) == expected.tolist()
    assert set(expected.tolist()) == set(range(13))


def test_worlds_of_a_training_are_pythons(node):
    settings = QLearningSettings(obstacles=12, moving=3, episodes=40, seed=9)
    body = "const at = page.trainingWorlds(data); return Array.from({ length: 40 }, (_, e) => at(e));"
    seen = node(FILES, body, settings.for_page())
    worlds = settings.task().worlds([9], 0, 40)
    for world, drawn in zip(worlds, seen, strict=True):
        expected = page_world(world)
        assert drawn["key"] == expected["key"]
        assert (drawn["start"], drawn["target"]) == (
            expected["start"],
            expected["target"],
        )
        for mine, theirs in zip(drawn["obstacles"], expected["obstacles"], strict=True):
            assert mine == pytest.approx(theirs, abs=1e-9)


def test_wilson_interval_is_scipys(node):
    body = "return data.map(([arrived, n]) => page.wilsonInterval(arrived, n));"
    counts = [(0, 100), (47, 100), (99, 100), (100, 100), (3, 200)]
    expected = [
        [ends.low, ends.high]
        for ends in (binomtest(k, n).proportion_ci(method="wilson") for k, n in counts)
    ]
    np.testing.assert_allclose(node(FILES, body, counts), expected, atol=1e-9)


def test_settings_go_to_the_page_and_back():
    settings = QLearningSettings(discount=0.7, temperature=(0.5, 0.2), inputs="raw")
    assert (
        QLearningSettings.from_page(json.loads(json.dumps(settings.for_page())))
        == settings
    )
    with pytest.raises(ValueError, match="inputs must be one of"):
        QLearningSettings.from_page(settings.for_page() | {"inputs": "colours"})


FAULTY = """
const kept = new Map(); // presets share their cures
const trained = (settings) => {
  const [outcomes, outside] = [[], []];
  let network = null;
  for (const episode of page.neuralQLearning(settings)) {
    if (!episode) continue; // within an episode
    outcomes.push(episode.outcome);
    if (episode.outside !== null) outside.push(episode.outside);
    ({ network } = episode);
  }
  const { speed, maxSteps, direction, obstacles, moving } = settings;
  const policy = { network, encoder: page.encoderOf(settings) };
  const ends = page.randomWorlds(100, { seed: data.seed, obstacles, moving, ...page.NNQL_ENDS })
    .map((world) => page.rollout(policy, world, { speed, maxSteps, direction }).outcome);
  const count = (list, end) => list.filter((outcome) => outcome === end).length;
  const late = outside.slice(-100);
  return {
    arrived: count(ends, "arrived"), endless: count(ends, "out of steps"),
    training: count(outcomes.slice(-100), "arrived"),
    outside: (100 * late.reduce((sum, share) => sum + share, 0)) / late.length,
  };
};
return data.settings.map((settings) => {
  const key = JSON.stringify(settings);
  if (!kept.has(key)) kept.set(key, trained(settings));
  return kept.get(key);
});
"""


@pytest.mark.slow
@pytest.mark.long
def test_faults_show_where_the_lab_says_and_are_cured(node):
    """Each fault with its seed, and its cure with the same seed in the same maps: 100 that no training has seen."""
    faults = [fault.settings for fault in FAULTS]
    cures = [
        replace(OF_THE_TABLES, seed=own.seed, obstacles=own.obstacles) for own in faults
    ]
    data = {"settings": [own.for_page() for own in faults + cures], "seed": MAPS_SEED}
    trained = node(FILES, FAULTY, data)
    for fault, poor, good in zip(
        FAULTS, trained[: len(FAULTS)], trained[len(FAULTS) :], strict=True
    ):
        lost = good["arrived"] - poor["arrived"]
        shows = {
            "maps": lost >= 15,
            "training": good["training"] - poor["training"] >= 30 and lost < 15,
            "targets": poor["outside"] >= 50
            and good["outside"] <= 35
            and poor["endless"] >= good["endless"] + 3
            and poor["arrived"] >= 90,
            "nothing": abs(lost) <= 4,
        }
        assert shows[fault.shows], (fault.name, poor, good)
        assert good["arrived"] >= (93 if fault.settings.obstacles == 10 else 70)
