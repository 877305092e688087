"""The planners of chapter 6 in the worlds of the leaderboard."""

from __future__ import annotations

from robonav.benchmark import BASELINES, SETTINGS, VERSION, evaluate_policy, leaderboard

from ..runner.experiment import Case, Experiment, Numbers, Plot
from .setup import PLANNERS, WORLDS, WORLDS_KNOWN_MAP, planner, tuned

METHODS = ("freer-side", *PLANNERS, "known-map")
BOARD = (
    "10 obstacles",
    "20 obstacles",
    "30 obstacles",
    "10 and 10 moving",
    "20, ranges off by 0.5 m",
    "20, a fifth of actions slips",
)
"""The settings of the leaderboard in which planners are tested."""


def evaluate_planner(case: Case, seed: int, scale: str) -> Numbers:
    """Evaluate a planner in one set of worlds of a setting."""
    name, setting = str(case["method"]), str(case["setting"])
    if name in BASELINES:
        return evaluate_policy(BASELINES[name], setting, seed, WORLDS[scale])
    worlds = WORLDS_KNOWN_MAP if name == "known-map" else WORLDS
    chosen = planner(name, tuned().get(name, {}), SETTINGS[setting].speed)
    return evaluate_policy(chosen, setting, seed, worlds[scale])


def table() -> Experiment:
    """Return the experiment with the settings that were tuned last."""
    return Experiment(
        name="planners",
        title="Outcomes and SPL of the planners of chapter 6 in the worlds of the leaderboard",
        cases=[
            {"method": name, "setting": setting}
            for name in METHODS
            for setting in BOARD
        ],
        run=evaluate_planner,
        seeds={"quick": 1, "thesis": leaderboard.SETS},
        settings={
            "version of the worlds": VERSION,
            "worlds a set": WORLDS,
            "worlds a set, known map": WORLDS_KNOWN_MAP,
            "settings": {name: dict(values) for name, values in tuned().items()},
        },
        note="The planner known-map knows the map and the place of the target, and is the upper end.",
        plot=Plot("experiments.draw_board", metric="success"),
    )


EXPERIMENTS = (table(),)
