"""Chapter 4 again: Table 4.2, 4.3 and what equal steps change in it, Fig. 4.3, 4.4, 4.6 and 4.7, and denser maps."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.networks import NetworkPolicy
from robonav.nnql import METHODS, weight_changes
from robonav.robot import Policy

from ..baselines import RULES
from ..runner.experiment import Case, Experiment
from ..runner.results import RESULTS as RESULTS
from .setup import (
    COLD,
    COLD_DQN,
    EPISODES,
    NAVIGATIONS,
    TEST_WORLDS,
    Numbers,
    blocks,
    judged,
    new_worlds,
)
from .tuning import trained, trial_settings

CHOSEN = {"nnql": 2, "online": 0, "nfq": 9, "dqn": 14}
"""The best trial of each method: the winner of :data:`robonav.experiments.chapter4.tuning.FINALS`."""

DENSE = {
    "the thesis's": trial_settings("nnql", 0),
    "rates that fall": {
        "gamma": 0.7, "alpha": (0.4, 0.05), "rate": (0.3, 0.05), "temperature": (0.9, 0.05), "passes": 1,
        "rescale": "clip", "target": "sine-cosine",
    },
}  # fmt: skip
"""Settings for 20 obstacles: in ours both learning rates fall, and the target's sector has no break."""

SPEEDS = (1.5, 2.0, 2.5, 3.0, 3.5, 4.0)
SAME_SPEED = "nnql, learned at this speed"


def settings(method: str) -> dict[str, Any]:
    """What was chosen for a method, see :data:`robonav.experiments.chapter4.tuning.SPACE`."""
    return dict(trial_settings(method, CHOSEN[method]))


def cold(method: str) -> float:
    """The temperature at which the policies of a method are all but greedy."""
    return COLD_DQN if method == "dqn" else COLD


def robot(name: str, seed: int, scale: str, **changes: Any) -> Policy:
    """A rule by its name, or what one seed of a method comes to with the settings chosen for it."""
    if name in RULES:
        return RULES[name]
    return trained(name, seed, scale, settings(name), **changes).policies[0]


def compare(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.3: one seed of a method; or a rule, which learns nothing."""
    name, worlds = (
        str(case["robot"]),
        new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed),
    )
    return judged(robot(name, seed, scale), worlds, temperature=cold(name))


def with_as_many_steps(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.3, each method stopped after the last episode within as many learning steps as NNQL's training has.

    NNQL's are those of the same seed. A method that has fewer goes through all its episodes.
    """
    name, worlds = (
        str(case["robot"]),
        new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed),
    )
    allowed = trained("nnql", seed, scale, settings("nnql")).decisions[0].sum()
    training = trained(name, seed, scale, settings(name), record=True)
    assert training.history is not None
    spent, driven = training.decisions[0].cumsum(), training.steps[0].cumsum()
    last = int(np.searchsorted(spent, allowed, side="right"))
    policy = NetworkPolicy(training.history[0, last], training.encoder)
    means = {
        "episodes": last,
        "learning steps": spent[last - 1],
        "seconds driven": driven[last - 1],
    }
    whole = {
        "learning steps, whole training": spent[-1],
        "seconds driven, whole training": driven[-1],
    }
    return judged(policy, worlds, temperature=cold(name)) | means | whole


def learn(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 4.4 and 4.6: successful episodes in every 30."""
    method = str(case["method"])
    won = trained(method, seed, scale, settings(method)).successes[0]
    return {
        "successes": blocks(won[None])[0],
        "of the first 100": won[:100].sum(),
        "of the last 100": won[-100:].sum(),
    }


def change(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 4.3: what the weights of a layer changed by in each episode."""
    training = trained("nnql", seed, scale, settings("nnql"), record=True)
    assert training.history is not None
    changes = weight_changes(training.history, absolute=case["sum"] == "absolute")[0]
    return {"first layer": changes[:, 0], "second layer": changes[:, 1]}


def at_speed(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.2: a robot that learned at 2.5 m/s, or at the speed it drives at, or a rule."""
    speed, name = float(case["speed"]), str(case["robot"])
    policy = (
        robot("nnql", seed, scale, speed=speed)
        if name == SAME_SPEED
        else robot(name, seed, scale)
    )
    return judged(policy, new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed), speed)


def among_movers(case: Case, seed: int, scale: str) -> Numbers:
    """Standing and moving obstacles (Fig. 4.7), for a robot that learned among standing ones, or a rule."""
    worlds = new_worlds(
        NAVIGATIONS[scale],
        TEST_WORLDS + seed,
        int(case["standing"]),
        int(case["moving"]),
    )
    return judged(robot(str(case["robot"]), seed, scale), worlds)


def in_dense_maps(case: Case, seed: int, scale: str) -> Numbers:
    """Twenty obstacles: NNQL with the thesis's settings or ours, trained for so many episodes; or a rule."""
    name, worlds = (
        str(case["robot"]),
        new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed, 20),
    )
    if name in RULES:
        return judged(RULES[name], worlds)
    length = float(case["episodes"]) / EPISODES
    return judged(
        trained("nnql", seed, scale, DENSE[name], length=length, obstacles=20).policies[
            0
        ],
        worlds,
    )


_ABOUT = {
    "episodes": EPISODES,
    "drives a run": NAVIGATIONS,
    "first seed of the worlds": TEST_WORLDS,
    "temperature of a cold policy": {method: cold(method) for method in METHODS},
    "settings": {
        method: trial_settings(method, trial) for method, trial in CHOSEN.items()
    },
}
_SEEDS = {"quick": 2, "thesis": 50}

TABLE_4_2 = Experiment(
    name="table-4.2",
    title="Six speeds: NNQL that learned at 2.5 m/s or at the same speed, and two rules",
    cases=[
        {"robot": name, "speed": speed}
        for name in ("nnql", SAME_SPEED, *RULES)
        for speed in SPEEDS
    ],
    run=at_speed,
    seeds={"quick": 1, "thesis": 24},
    settings=_ABOUT,
)
TABLE_4_3 = Experiment(
    name="table-4.3",
    title="NNQL, online Q-learning, NFQ, DQN, and two rules that learn nothing: success in new maps",
    cases=[{"robot": name} for name in (*METHODS, *RULES)],
    run=compare,
    seeds=_SEEDS,
    thesis={"success": [98, 56, 87, None, None, None]},
    settings=_ABOUT,
)
STEPS = Experiment(
    name="nnql-steps",
    title="Table 4.3 with as many learning steps for each method as NNQL has",
    cases=[{"robot": name} for name in METHODS],
    run=with_as_many_steps,
    seeds=_SEEDS,
    settings=_ABOUT,
)
FIGURE_4_3 = Experiment(
    name="figure-4.3",
    title="What the weights change by in each episode",
    cases=[{"sum": "signed"}, {"sum": "absolute"}],
    run=change,
    seeds={"quick": 1, "thesis": 4},
    settings=_ABOUT,
)
FIGURE_4_4 = Experiment(
    name="figure-4.4",
    title="Successful episodes in every 30, NNQL",
    cases=[{"method": "nnql"}],
    run=learn,
    seeds=_SEEDS,
    settings=_ABOUT,
)
FIGURE_4_6 = Experiment(
    name="figure-4.6",
    title="Successful episodes in every 30, four methods",
    cases=[{"method": method} for method in METHODS],
    run=learn,
    seeds=_SEEDS,
    settings=_ABOUT,
)
FIGURE_4_7 = Experiment(
    name="figure-4.7",
    title="Among moving obstacles: NNQL that learned among standing ones, and two rules",
    cases=[
        {"robot": name, "standing": standing, "moving": moving}
        for name in ("nnql", *RULES)
        for standing, moving in ((10, 0), (5, 5), (0, 10), (10, 10))
    ],
    run=among_movers,
    seeds=_SEEDS,
    settings=_ABOUT,
)
TWENTY = Experiment(
    name="nnql-20-obstacles",
    title="NNQL with 20 obstacles: the thesis's settings, learning rates that fall, and two rules",
    cases=[
        {"robot": name, "episodes": episodes}
        for name in DENSE
        for episodes in (300, 600)
    ]
    + [{"robot": name, "episodes": 0} for name in RULES],
    run=in_dense_maps,
    seeds={"quick": 1, "thesis": 24},
    settings=_ABOUT | {"settings": DENSE},
)

EXPERIMENTS = (
    TABLE_4_2,
    TABLE_4_3,
    STEPS,
    FIGURE_4_3,
    FIGURE_4_4,
    FIGURE_4_6,
    FIGURE_4_7,
    TWENTY,
)
