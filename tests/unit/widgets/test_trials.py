"""Policies tried in the page's maps against Python's, under every condition of the leaderboard."""

import numpy as np
import pytest

from robonav.benchmark import EXACT_REFLEX, SETTINGS
from robonav.benchmark.policies import method
from robonav.networks import NetworkPolicy
from robonav.robot import (
    Reflex,
    navigate,
    neighbour_slip,
    random_worlds,
    straight,
)
from robonav.widgets.leaderboard_row import leaderboard_row
from robonav.widgets.simulator import page_policy

FILES = ("simulator", "learning/random", "learning/worlds", "learning/trials")
DRIVE = """
const unpacked = ({ network, ...rest }) => (network ? { ...rest, network: page.networks(network)() } : rest);
const policies = data.policies.map(unpacked);
const worlds = page.randomWorlds(data.count, { seed: data.seed, ...data.conditions });
return policies.map((policy) => worlds.map((world) => {
  const { poses, outcome } = page.rollout(policy, world, data.conditions);
  return { steps: poses.length - 1, outcome };
}));
"""


def conditions_of_board(name):
    """The conditions of a setting, as the page of the leaderboard has them."""
    settings = leaderboard_row({}).data["settings"]
    (conditions,) = (own["conditions"] for own in settings if own["name"] == name)
    return conditions


@pytest.mark.parametrize("name", SETTINGS)
def test_policies_drive_in_the_page_as_on_the_leaderboard(node, name):
    check_driven(node, SETTINGS[name], conditions_of_board(name), EXACT_REFLEX)


def test_robots_that_know_the_sector_drive_in_the_page_as_in_python(node):
    conditions = conditions_of_board("20 obstacles") | {"direction": "sector"}
    check_driven(node, SETTINGS["20 obstacles"], conditions, Reflex("sector"))


def check_driven(node, setting, conditions, reflex):
    slip = neighbour_slip(setting.slip) if setting.slip else None
    learned = method("lfd")
    assert isinstance(learned, NetworkPolicy)
    policies = [{"rule": "straight"}, page_policy(learned)]
    data = {"policies": policies, "seed": 77, "count": 40, "conditions": conditions}
    driven = node(FILES, DRIVE, data)
    worlds = random_worlds(40, setting.obstacles, setting.moving, seed=77)
    for policy, ours in zip((straight, learned), driven, strict=True):
        theirs = navigate(
            policy, worlds, setting.speed, noise=setting.noise, slip=slip, reflex=reflex
        )
        assert [end["outcome"] for end in ours] == list(theirs.outcome)
        assert [end["steps"] for end in ours] == theirs.steps.tolist()


def test_job_counts_arrivals(node):
    body = """
    const job = page.trialsJob(data);
    let step = job.next();
    const seen = [];
    for (; !step.done; step = job.next()) seen.push(step.value.live);
    return { arrived: step.value, seen };
    """
    data = {
        "policies": [{"rule": "straight"}, {"rule": "freer-side"}],
        "seed": 5,
        "count": 20,
        "conditions": {"obstacles": 10, "speed": 2.0},
    }
    found = node(FILES, body, data)
    expected = navigate(straight, random_worlds(20, 10, seed=5)).success.sum()
    assert found["arrived"][0] == expected
    assert found["seen"][-1] == {"at": 20, "arrived": found["arrived"]}


def test_interval_is_wilsons(node):
    found = node(
        FILES,
        "return data.map(([k, n]) => page.wilsonInterval(k, n));",
        [[0, 10], [7, 10], [200, 200]],
    )
    # closed form: the roots of (p - k/n)^2 = z^2 p (1 - p) / n
    z = 1.959963984540054
    for (k, n), interval in zip([(0, 10), (7, 10), (200, 200)], found, strict=True):
        roots = np.roots([1 + z**2 / n, -2 * k / n - z**2 / n, (k / n) ** 2])
        np.testing.assert_allclose(interval, np.sort(roots.real), atol=1e-9)
