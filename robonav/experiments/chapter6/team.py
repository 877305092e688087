"""Several robots on one map: how arrivals and collisions change with the number of robots."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.benchmark import method
from robonav.benchmark.evaluation import OUTCOMES
from robonav.deep import train_team
from robonav.robot import Action, Policy, PolicyWithMemory, Reflex, Sensing
from robonav.robot.team import TeamNavigation, Teams, navigate_team, random_teams

from ..runner.experiment import SUCCESS_BARS, Case, Experiment, Numbers, Plot
from .setup import CONDITIONS, PLANNERS, planner, tuned

TEAM: dict[str, Any] = CONDITIONS["team"]
LEARNING: dict[str, Any] = CONDITIONS["team_learning"]
METHODS = ("freer-side", "potential-field", "dagger", "nnql", "nirl")
REFLEX_OF_TEAMS = Reflex(TEAM["direction"])
LOOKS = {"ahead": [0], "ahead and beside": [0, 1, 8]}
"""Columns of the sectors in which a rule looks for something near."""

TURNS = ("to the freer side", "to the right")


def policy_of(name: str) -> Policy | PolicyWithMemory:
    """Return a tuned planner, or a policy of the leaderboard."""
    if name in PLANNERS:
        return planner(name, tuned()[name], TEAM["speed"])
    return method(name)


@lru_cache(maxsize=1)
def teams_of_run(seed: int, scale: str) -> Teams:
    """Return the maps of a run with the greatest number of robots."""
    return random_teams(
        TEAM["maps"][scale],
        max(TEAM["robots"]),
        TEAM["obstacles"],
        seed=TEAM["test_seed"] + seed,
    )


def team_rates(navigation: TeamNavigation) -> dict[str, float]:
    """The share of robots that arrive, that collide, and with what, and that run out of steps, in per cent."""
    rates = {
        name: (navigation.outcome == outcome).mean()
        for name, outcome in OUTCOMES.items()
    }
    rates["collision with a robot"] = navigation.met.mean()
    rates["collision with an obstacle"] = (navigation.collision & ~navigation.met).mean()  # fmt: skip
    return {name: 100 * float(rate) for name, rate in rates.items()}


def run_team(
    policy: Policy | PolicyWithMemory, robots: int, seed: int, scale: str
) -> Numbers:
    """Outcome rates of one policy that drives the first robots of each map of a run."""
    teams = teams_of_run(seed, scale).first(robots)
    navigation = navigate_team(
        policy, teams, TEAM["speed"], TEAM["max_steps"], reflex=REFLEX_OF_TEAMS
    )
    arrived = navigation.steps[navigation.success]
    return team_rates(navigation) | {"seconds to the target": float(arrived.mean())}


def evaluate_team(case: Case, seed: int, scale: str) -> Numbers:
    """Drive the robots of a case."""
    return run_team(policy_of(str(case["method"])), int(case["robots"]), seed, scale)


def rule(looks: str, turns: str) -> Policy:
    """Return a rule: if something is nearer than 6 m in the sectors of ``LOOKS[looks]``, turn; else go forward.

    With ``ahead`` and ``to the freer side`` it is :func:`robonav.robot.turn_to_clearer_side`.

    Parameters
    ----------
    looks : {"ahead", "ahead and beside"}
        In which sectors the rule looks for something near.
    turns : {"to the freer side", "to the right"}
        Where it turns then, by 60 degrees.

    Returns
    -------
    Policy

    Examples
    --------
    >>> from robonav.robot import navigate, random_worlds
    >>> worlds = random_worlds(100, obstacles=10, seed=1)
    >>> float(navigate(rule("ahead and beside", "to the right"), worlds).success.mean())
    0.56
    """

    def policy(sensing: Sensing, rng: np.random.Generator) -> NDArray[np.int64]:
        left = sensing.ranges[:, 1:3].min(axis=1)
        right = sensing.ranges[:, 7:9].min(axis=1)
        to_left = (left > right) & (turns == "to the freer side")
        turn = np.where(to_left, Action.L60, Action.R60)
        near = sensing.ranges[:, LOOKS[looks]].min(axis=1) < 6
        return np.where(near, turn, Action.F)

    return policy


def evaluate_rule(case: Case, seed: int, scale: str) -> Numbers:
    """Let the robots of a case cross the maps of a run by a rule."""
    policy = rule(str(case["looks"]), str(case["turns"]))
    return run_team(policy, int(case["robots"]), seed, scale)


@lru_cache(maxsize=64)
def learned_policy(robots: int, seed: int, scale: str) -> Policy:
    """Return the policy that robots learned together, with this number of them on each map."""
    return train_team(
        robots,
        LEARNING["updates"][scale],
        n_worlds=LEARNING["learners"] // robots,
        obstacles=TEAM["obstacles"],
        speed=TEAM["speed"],
        max_steps=TEAM["max_steps"],
        reflex=REFLEX_OF_TEAMS,
        seed=seed,
    ).policy


def evaluate_learning(case: Case, seed: int, scale: str) -> Numbers:
    """Train the robots of a case, and let as many as it says cross the maps of a run."""
    policy = learned_policy(int(case["robots in training"]), seed, scale)
    return run_team(policy, int(case["robots"]), seed, scale)


ABOUT = {
    "maps a run": TEAM["maps"],
    "obstacles": TEAM["obstacles"],
    "speed in m/s": TEAM["speed"],
    "most steps": TEAM["max_steps"],
    "first seed of the maps": TEAM["test_seed"],
    "direction of the reflex": TEAM["direction"],
}

EXPERIMENTS = (
    Experiment(
        name="team",
        title="Arrivals and collisions of several robots that cross one map",
        cases=[
            {"method": name, "robots": robots}
            for name in METHODS
            for robots in TEAM["robots"]
        ],
        run=evaluate_team,
        seeds={"quick": 1, "thesis": 10},
        settings=ABOUT | {"potential-field": dict(tuned()["potential-field"])},
        note="All robots of a map have the same policy. None was trained with other robots.",
        plot=Plot("team.draw_against_robots"),
    ),
    Experiment(
        name="team-rules",
        title="Rules that look ahead or beside it too, and turn to the freer side or to the right",
        cases=[
            {"looks": looks, "turns": turns, "robots": robots}
            for looks in LOOKS
            for turns in TURNS
            for robots in (1, max(TEAM["robots"]))
        ],
        run=evaluate_rule,
        seeds={"quick": 1, "thesis": 10},
        settings=ABOUT,
        note="All robots of a map have the same rule. The first one is freer-side.",
        plot=SUCCESS_BARS,
    ),
    Experiment(
        name="team-learning",
        title="Robots that learned alone, and robots that learned together, by PPO with shared weights",
        cases=[
            {"robots in training": learners, "robots": robots}
            for learners in LEARNING["robots"]
            for robots in TEAM["robots"]
        ],
        run=evaluate_learning,
        seeds={"quick": 1, "thesis": 6},
        settings=ABOUT
        | {
            "updates": LEARNING["updates"],
            "robots that act for an update": LEARNING["learners"],
        },
        shortened="A quick run has two updates.",
        note="All make as many episodes in training. Each run is one training.",
        plot=Plot("team.draw_against_robots"),
    ),
)
