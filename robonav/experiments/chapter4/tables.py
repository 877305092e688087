"""Tables 4.2 and 4.3, Figs. 4.3, 4.4, 4.6 and 4.7, Table 4.3 with equal learning steps, and denser maps."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.benchmark import BASELINES
from robonav.networks import NetworkPolicy
from robonav.nnql import METHODS, weight_changes

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers, Plot
from .setup import (
    ABOUT,
    CONDITIONS,
    DECAYING,
    EPISODES,
    EVALUATION_TEMPERATURE,
    SETUP,
    THESIS,
    blocks,
    evaluate,
    trained_policy,
    training,
    tuned,
)

DENSE = {"nnql-thesis": THESIS["nnql"], "nnql-decaying": DECAYING}
"""Hyperparameters of NNQL among 20 obstacles."""

SPEEDS = tuple(CONDITIONS["speeds"])
SAME_SPEED = "nnql-same-speed"


def compare(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.3: one seed of a method, or a baseline."""
    name = str(case["method"])
    worlds = SETUP.test_worlds(seed, scale)
    temperature = EVALUATION_TEMPERATURE.get(name, 0.0)
    return evaluate(trained_policy(name, seed, scale), worlds, temperature=temperature)


def compare_with_equal_steps(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.3, where each method stops after as many learning steps as NNQL takes with the same seed.

    A method stops after the last episode within that number. A method that takes fewer steps goes through all episodes.
    """
    name = str(case["method"])
    allowed = training("nnql", seed, scale, tuned()["nnql"]).decisions[0].sum()
    trained = training(name, seed, scale, tuned()[name], record=True)
    assert trained.history is not None
    learning, seconds = trained.decisions[0].cumsum(), trained.steps[0].cumsum()
    last = int(np.searchsorted(learning, allowed, side="right"))
    policy = NetworkPolicy(trained.history[0, last], trained.encoder)
    rates = evaluate(
        policy,
        SETUP.test_worlds(seed, scale),
        temperature=EVALUATION_TEMPERATURE[name],
    )
    return rates | {
        "episodes": last,
        "learning steps": learning[last - 1],
        "simulated seconds": seconds[last - 1],
        "learning steps, whole training": learning[-1],
        "simulated seconds, whole training": seconds[-1],
    }


def learning_curve(case: Case, seed: int, scale: str) -> Numbers:
    """Figs. 4.4 and 4.6: successful episodes in every 30."""
    method = str(case["method"])
    arrived = training(method, seed, scale, tuned()[method]).successes[0]
    return {
        "successes": blocks(arrived[None])[0],
        "success, first 100 episodes": arrived[:100].sum(),
        "success, last 100 episodes": arrived[-100:].sum(),
    }


def weights_over_time(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 4.3: how much the weights of each layer change in each episode."""
    trained = training("nnql", seed, scale, tuned()["nnql"], record=True)
    assert trained.history is not None
    changes = weight_changes(trained.history, absolute=case["sum"] == "absolute")[0]
    return {"first layer": changes[:, 0], "second layer": changes[:, 1]}


def at_speed(case: Case, seed: int, scale: str) -> Numbers:
    """Table 4.2: a robot trained at 2.5 m/s or at the speed of its test, or a baseline."""
    speed, name = float(case["speed"]), str(case["method"])
    policy = (
        trained_policy("nnql", seed, scale, speed=speed)
        if name == SAME_SPEED
        else trained_policy(name, seed, scale)
    )
    return evaluate(policy, SETUP.test_worlds(seed, scale), speed)


def among_moving_obstacles(case: Case, seed: int, scale: str) -> Numbers:
    """Fig. 4.7: standing and moving obstacles, for a robot trained with standing ones, or a baseline."""
    worlds = SETUP.test_worlds(seed, scale, int(case["obstacles"]), int(case["moving"]))
    return evaluate(trained_policy(str(case["method"]), seed, scale), worlds)


def in_dense_maps(case: Case, seed: int, scale: str) -> Numbers:
    """Twenty obstacles: NNQL with the thesis's hyperparameters or ours, or a baseline."""
    name, worlds = str(case["method"]), SETUP.test_worlds(seed, scale, 20)
    if name in BASELINES:
        return evaluate(BASELINES[name], worlds)
    length = float(case["episodes"]) / EPISODES
    trained = training("nnql", seed, scale, DENSE[name], length=length, obstacles=20)
    return evaluate(trained.policies[0], worlds)


_ABOUT: dict[str, Any] = {
    **ABOUT,
    "evaluation temperature": EVALUATION_TEMPERATURE,
    "settings": {method: dict(tuned()[method]) for method in METHODS},
}
_SEEDS = {"quick": 2, "thesis": 50}

TABLE_4_2 = Experiment(
    name="table-4.2",
    title="Success at six speeds: NNQL trained at 2.5 m/s or at the same speed, and two baselines",
    cases=[
        {"method": name, "speed": speed}
        for name in ("nnql", SAME_SPEED, *BASELINES)
        for speed in SPEEDS
    ],
    run=at_speed,
    seeds={"quick": 1, "thesis": 24},
    settings=_ABOUT,
    plot=Plot("nnql.plot_speeds"),
)
TABLE_4_3 = Experiment(
    name="table-4.3",
    title="Success in new maps: NNQL, online Q-learning, NFQ, DQN, and two baselines",
    cases=[{"method": name} for name in (*METHODS, *BASELINES)],
    run=compare,
    seeds=_SEEDS,
    thesis={"success": [98, 56, 87, None, None, None]},
    settings=_ABOUT,
    plot=Plot("nnql.plot_rates"),
)
EQUAL_STEPS = Experiment(
    name="nnql-steps",
    title="Success in new maps: the methods of Table 4.3, each with as many learning steps as NNQL",
    cases=[{"method": name} for name in METHODS],
    run=compare_with_equal_steps,
    seeds=_SEEDS,
    settings=_ABOUT,
    plot="Table 4.3 has the figure; here the numbers of steps count",
)
FIGURE_4_3 = Experiment(
    name="figure-4.3",
    title="Changes of the weights in each episode",
    cases=[{"sum": "signed"}, {"sum": "absolute"}],
    run=weights_over_time,
    seeds={"quick": 1, "thesis": 4},
    settings=_ABOUT,
    plot=Plot("nnql.plot_weight_changes"),
)
FIGURE_4_4 = Experiment(
    name="figure-4.4",
    title="Successful episodes in every 30, NNQL",
    cases=[{"method": "nnql"}],
    run=learning_curve,
    seeds=_SEEDS,
    settings=_ABOUT,
    plot=Plot("nnql.plot_learning"),
)
FIGURE_4_6 = Experiment(
    name="figure-4.6",
    title="Successful episodes in every 30, four methods",
    cases=[{"method": method} for method in METHODS],
    run=learning_curve,
    seeds=_SEEDS,
    settings=_ABOUT,
    plot=Plot("nnql.plot_learning"),
)
FIGURE_4_7 = Experiment(
    name="figure-4.7",
    title="Success with standing and moving obstacles: NNQL trained with standing ones, and two baselines",
    cases=[
        {"method": name, "obstacles": obstacles, "moving": moving}
        for name in ("nnql", *BASELINES)
        for obstacles, moving in ((10, 0), (5, 5), (0, 10), (10, 10))
    ],
    run=among_moving_obstacles,
    seeds=_SEEDS,
    settings=_ABOUT,
    plot=SUCCESS_BARS,
)
TWENTY_OBSTACLES = Experiment(
    name="nnql-20-obstacles",
    title="Success with 20 obstacles: NNQL with the thesis's and with decaying learning rates, and two baselines",
    cases=[
        {"method": name, "episodes": episodes}
        for name in DENSE
        for episodes in (300, 600)
    ]
    + [{"method": name, "episodes": 0} for name in BASELINES],
    run=in_dense_maps,
    seeds={"quick": 1, "thesis": 24},
    settings=_ABOUT | {"settings": {name: dict(s) for name, s in DENSE.items()}},
    plot=SUCCESS_BARS,
)

EXPERIMENTS = (
    TABLE_4_2,
    TABLE_4_3,
    EQUAL_STEPS,
    FIGURE_4_3,
    FIGURE_4_4,
    FIGURE_4_6,
    FIGURE_4_7,
    TWENTY_OBSTACLES,
)
