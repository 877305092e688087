"""Chapter 4 again: Table 4.2 and 4.3, Fig. 4.3, 4.4 and 4.6, moving obstacles (Fig. 4.7) and denser maps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from robonav.lfd import NetworkPolicy
from robonav.nnql import METHODS, boltzmann, choose, weight_changes
from robonav.robot import Policy, Sensing, freer_side, straight

from .experiment import Case, Experiment
from .nnql_course import EPISODES, NAVIGATIONS, TEST_WORLDS, Numbers, blocks, driven, new_worlds
from .nnql_tuning import trained, trial_settings

RESULTS = Path(__file__).parent / "results"
"""What these experiments gave at the thesis's scale: the pages show it."""

CHOSEN = {"nnql": 0, "online": 0, "nfq": 0, "dqn": 0}
"""The best trial of each method."""

DENSE = {
    "gamma": 0.7, "alpha": (0.4, 0.05), "rate": (0.3, 0.05), "temperature": (0.9, 0.05), "passes": 1, "rescale": "clip",
    "target": "sine-cosine",
}  # fmt: skip
"""For 20 obstacles: both learning rates fall, and the target's sector has no break."""

RULES: dict[str, Policy] = {"straight": straight, "freer side": freer_side}
COLD = 0.02  # temperature of a policy that is all but greedy


def settings(method: str) -> dict[str, Any]:
    """What was chosen for a method, see :data:`robonav.experiments.nnql_tuning.SPACE`."""
    return dict(trial_settings(method, CHOSEN[method]))


def cold(policy: NetworkPolicy, temperature: float = COLD) -> Policy:
    """The Boltzmann policy, Eq. (4.7), of a network's values: cold, it is greedy but where two values are close."""

    def drawn(sensing: Sensing, rng: np.random.Generator) -> np.ndarray:
        values = policy.network.forward(policy.encoder(sensing))
        return choose(boltzmann(values, temperature), rng.random(len(sensing)))

    return drawn


def compare(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.3: one seed of a method with its chosen settings; or a rule, which learns nothing."""
    method, worlds = str(case["method"]), new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed)
    if method in RULES:
        return driven(RULES[method], worlds)
    return driven(trained(method, seed, EPISODES[scale], settings(method)).policies[0], worlds)


def learn(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 4.4 and 4.6: successful episodes in every 30."""
    training = trained(str(case["method"]), seed, EPISODES[scale], settings(str(case["method"])))
    won = training.successes[0]
    return {"successes": blocks(won[None])[0], "of the first 100": won[:100].sum(), "of the last 100": won[-100:].sum()}


def change(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 4.3: what the weights of a layer changed by in each episode."""
    training = trained("nnql", seed, EPISODES[scale], settings("nnql"), record=True)
    assert training.history is not None
    changes = weight_changes(training.history, absolute=case["sum"] == "absolute")[0]
    return {"first layer": changes[:, 0], "second layer": changes[:, 1]}


def at_speed(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.2: a robot that learned at 2.5 m/s, or a rule, drives at another speed."""
    worlds, speed = new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed), float(case["speed"])
    if case["method"] in RULES:
        return driven(RULES[str(case["method"])], worlds, speed)
    return driven(trained("nnql", seed, EPISODES[scale], settings("nnql")).policies[0], worlds, speed)


def among_movers(case: Case, seed: int, scale: str) -> Numbers:
    """Standing and moving obstacles (Fig. 4.7), for a robot that learned among standing ones; beside a rule."""
    worlds = new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed, int(case["standing"]), int(case["moving"]))
    if case["method"] in RULES:
        return driven(RULES[str(case["method"])], worlds)
    return driven(trained("nnql", seed, EPISODES[scale], settings("nnql")).policies[0], worlds)


def in_dense_maps(case: Case, seed: int, scale: str) -> Numbers:
    """Twenty obstacles: training with the thesis's settings or ours, of 300 episodes or 600; greedy, and cold."""
    options = trial_settings("nnql", 0) if case["settings"] == "the thesis's" else DENSE
    episodes = int(case["episodes"]) * EPISODES[scale] // EPISODES["thesis"]
    policy = trained("nnql", seed, episodes, options, obstacles=20).policies[0]
    worlds = new_worlds(NAVIGATIONS[scale], TEST_WORLDS + seed, 20)
    return driven(policy, worlds) | {"success, cold": driven(cold(policy), worlds)["success"]}


_ABOUT = {
    "episodes": EPISODES,
    "drives a run": NAVIGATIONS,
    "first seed of the worlds": TEST_WORLDS,
    "settings": {method: trial_settings(method, trial) for method, trial in CHOSEN.items()},
}
_SEEDS = {"quick": 2, "thesis": 50}

TABLE_4_2 = Experiment(
    name="table-4.2",
    title="NNQL at six speeds, learned at 2.5 m/s or at the same speed",
    cases=[
        {"speed": speed, "learned at": learned}
        for learned in ("2.5 m/s", "the same")
        for speed in (1.5, 2, 2.5, 3, 3.5, 4)
    ],
    run=at_speed,
    seeds=_SEEDS,
    settings=_ABOUT,
)
TABLE_4_3 = Experiment(
    name="table-4.3",
    title="NNQL, online Q-learning, NFQ, DQN, and two rules that learn nothing: success in new maps",
    cases=[{"method": method} for method in (*METHODS, *RULES)],
    run=compare,
    seeds=_SEEDS,
    thesis={"success": [98, 56, 87, None, None, None]},
    settings=_ABOUT,
)
FIGURE_4_3 = Experiment(
    name="figure-4.3",
    title="What the weights change by in each episode",
    cases=[{"sum": "signed"}, {"sum": "absolute"}],
    run=change,
    seeds={"quick": 1, "thesis": 16},
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
    title="NNQL, learned among standing obstacles, and a rule among moving ones",
    cases=[
        {"method": method, "standing": standing, "moving": moving}
        for method in ("nnql", "freer side")
        for standing, moving in ((10, 0), (5, 5), (0, 10), (10, 10))
    ],
    run=among_movers,
    seeds=_SEEDS,
    settings=_ABOUT,
)
TWENTY = Experiment(
    name="nnql-20-obstacles",
    title="NNQL with 20 obstacles: the thesis's settings, and learning rates that fall",
    cases=[{"settings": which, "episodes": n} for which in ("the thesis's", "ours") for n in (300, 600)],
    run=in_dense_maps,
    seeds={"quick": 1, "thesis": 24},
    settings=_ABOUT | {"settings": {"the thesis's": trial_settings("nnql", 0), "ours": DENSE}, "cold": COLD},
)

EXPERIMENTS = (TABLE_4_2, TABLE_4_3, FIGURE_4_3, FIGURE_4_4, FIGURE_4_6, FIGURE_4_7, TWENTY)
