"""Neural inverse reinforcement learning in the page against Python's, with the same random numbers."""

import numpy as np
import pytest

from robonav.lfd import demonstrate
from robonav.nirl import RobotTask, expert_decisions, nirl
from robonav.robot import random_worlds

FILES = (
    "simulator",
    "learning/random",
    "learning/worlds",
    "learning/network",
    "learning/nirl",
)
LEARN = """
const { inputs, actions, settings, seed } = data;
const expert = { inputs: inputs.map((row) => Float64Array.from(row)), actions };
const run = page.nirl(expert, { ...page.NIRL_SETTINGS, ...settings }, seed);
const seen = [];
let next = run.next();
for (; !next.done; next = run.next()) seen.push({ ...next.value, theta: [...next.value.theta] });
const { network, theta, iteration, balanced } = next.value;
return { seen, weights: network.weights.map((w) => [...w]), theta: [...theta], iteration, balanced };
"""


def in_page(node, expert, seed, **settings):
    """What the page learns from these decisions."""
    data = {
        "inputs": expert.inputs.tolist(),
        "actions": expert.actions.tolist(),
        "settings": settings,
        "seed": seed,
    }
    return node(FILES, LEARN, data)


@pytest.mark.parametrize("seed", range(3))
def test_nirl_in_the_page_learns_what_python_learns(node, seed):
    expert = expert_decisions(demonstrate(random_worlds(4, 20, seed=30 + seed)))
    expected = nirl(expert, RobotTask(), iterations=3, seed=seed)
    ours = in_page(node, expert, seed, iterations=3)
    history = expected.history
    for name, values in (
        ("margin", history.margins),
        ("cost", history.costs),
        ("arrived", history.arrived),
        ("collided", history.collided),
    ):
        np.testing.assert_allclose(
            [step[name] for step in ours["seen"]], values, rtol=0, atol=1e-9
        )
    np.testing.assert_allclose(
        [step["theta"] for step in ours["seen"]],
        history.weights.reshape(3, -1),
        rtol=0,
        atol=1e-9,
    )
    assert ours["iteration"] == expected.chosen
    for mine, its in zip(ours["weights"], expected.network.weights, strict=True):
        np.testing.assert_allclose(mine, its.ravel(), rtol=0, atol=1e-9)
