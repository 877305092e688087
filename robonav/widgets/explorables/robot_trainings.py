"""What the kernel computes for the explorables on the robot: paths and outcomes in many of the reader's worlds."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.lfd import GridPlan, Plan, plan, plan_on_grid
from robonav.robot import (
    Action,
    Navigation,
    Reflex,
    Sensing,
    navigate,
    random_worlds,
    straight,
    turn_to_clearer_side,
)

from ..kernel_training import Report
from ..simulator import page_world
from .chapter3 import grid_to_search
from .training import Curve, Dial, Menu, Trained, trains

RULES = {"turn to the clearer side": turn_to_clearer_side, "straight on": straight}
REFLEXES = {
    "it knows its target's direction": Reflex("exact"),
    "it knows its target's sector": Reflex("sector"),
    "none": None,
}
AT_ONCE = 20
"""Worlds between two points of a curve."""

SEED = 59_000
SAID = {
    "arrived": "arrived",
    "collided": "collided",
    "out of steps": "ran out of steps",
}
"""How a robot's episode ended, in the words of the page."""

ARRIVED = Curve("arrived (%)", high=100.0, digits=0)
COLLIDED = Curve("collided (%)", high=100.0, digits=0)
OBSTACLES = Dial("obstacles that stand still", 0, 40, 5, 10)
MOVING = Dial("obstacles that move", 0, 20, 5, 0)


def percent(flags: NDArray[np.bool_]) -> float:
    """The share of true ones, in per cent."""
    return 100 * float(flags.mean())


@trains(
    "reflex_map",
    "Drive many maps by a rule and a reflex of your choice",
    action="Drive in Python",
    unit="maps",
    length="maps",
    settings={
        "rule": Menu("rule", tuple(RULES)),
        "reflex": Menu("reflex", tuple(REFLEXES)),
        "obstacles": OBSTACLES,
        "moving": MOVING,
        "speed": Dial("speed", 1, 8, 1, 2, " m/s"),
        "maps": Dial("maps", 20, 2000, 20, 200),
    },
    curves={"arrived": ARRIVED, "collided": COLLIDED},
)
def rule_and_reflex(settings: dict[str, Any], report: Report) -> Trained:
    """Episodes of a rule in random worlds; the page gets a map of each outcome with the robot's path."""
    total, speed = settings["maps"], settings["speed"]
    worlds = random_worlds(total, settings["obstacles"], settings["moving"], seed=SEED)
    outcomes: list[str] = []
    steps: list[int] = []
    paths: list[NDArray[np.float64]] = []
    for first in range(0, total, AT_ONCE):
        driven = navigate(
            RULES[settings["rule"]],
            worlds[first : first + AT_ONCE],
            speed,
            record_paths=True,
            reflex=REFLEXES[settings["reflex"]],
        )
        assert driven.paths is not None
        outcomes += driven.outcome.tolist()
        steps += driven.steps.tolist()
        paths += driven.paths
        ended = np.array(outcomes)
        report(
            len(ended),
            total,
            at=len(ended),
            arrived=percent(ended == "arrived"),
            collided=percent(ended == "collided"),
        )
    result = Navigation(np.array(outcomes), np.array(steps), tuple(paths))
    shown = [
        {
            "name": said,
            "path": paths[at][:, :2].round(2).tolist(),
            **page_world(worlds[at]),
        }
        for outcome, said in SAID.items()
        for at in np.flatnonzero(result.outcome == outcome)[:1]
    ]
    arrived, collided = percent(result.success), percent(result.collision)
    return Trained(
        [result],
        f"It arrives in {arrived:.1f} % of {total} maps, collides in {collided:.1f} %, and is out of steps in "
        f"{100 - arrived - collided:.1f} %. The picture shows a map of each kind with the robot's path.",
        {
            "worlds": shown,
            "maps": "a map in which the robot",
            "map": len(shown) - 1,
            "speed": speed,
        },
    )


def turning_at(metres: float) -> Callable[[Sensing, np.random.Generator], Any]:
    """The rule of the explorable: turn left by 60 degrees when something ahead is nearer than ``metres``."""

    def rule(sensing: Sensing, _rng: np.random.Generator) -> NDArray[np.int64]:
        return np.where(sensing.ranges[:, 0] < metres, Action.L60, Action.F)

    return rule


SIGHTS = {f"{metres} m": metres for metres in (10, 8, 6, 4)}


@trains(
    "speed_and_sight",
    "The same rule in many maps, faster and faster",
    action="Drive in Python",
    unit="speed in m/s",
    length="fastest",
    settings={
        "sight": Menu("turns when something ahead is nearer than", tuple(SIGHTS)),
        "obstacles": OBSTACLES,
        "moving": MOVING,
        "maps": Dial("maps for each speed", 20, 1000, 20, 200),
        "fastest": Dial("fastest speed", 2, 9, 1, 9, " m/s"),
    },
    curves={"arrived": ARRIVED, "collided": COLLIDED},
)
def faster_and_faster(settings: dict[str, Any], report: Report) -> Trained:
    """Episodes at each speed; the page gets the first map in which the robot collides at the lowest such speed."""
    sight, fastest = SIGHTS[settings["sight"]], settings["fastest"]
    worlds = random_worlds(
        settings["maps"], settings["obstacles"], settings["moving"], seed=SEED
    )
    results: list[Navigation] = []
    for speed in range(1, fastest + 1):
        results.append(
            navigate(
                turning_at(sight),
                worlds,
                speed,
                progress=report.part((speed - 1) * len(worlds), fastest * len(worlds)),
            )
        )
        report(
            speed * len(worlds),
            fastest * len(worlds),
            at=speed,
            arrived=percent(results[-1].success),
            collided=percent(results[-1].collision),
        )
    hit = [at for at, driven in enumerate(results) if driven.collision.any()]
    speed = hit[0] + 1 if hit else fastest
    world = int(results[speed - 1].collision.argmax())
    rates = [percent(driven.success) for driven in results]
    shown = (
        f"The picture shows the first map with a collision at {speed} m/s."
        if hit
        else f"It never collides; the picture shows the first map at {speed} m/s."
    )
    return Trained(
        results,
        f"At 1 m/s it arrives in {rates[0]:.1f} % of {len(worlds)} maps, and at {fastest} m/s in {rates[-1]:.1f} %. "
        f"{shown}",
        {"world": page_world(worlds[world]), "speed": speed, "turnAt": sight},
    )


SEARCHES: dict[str, Callable[..., Plan | GridPlan]] = {
    "modified A*": plan,
    "A* on a grid": plan_on_grid,
}
COARSE = 12.5
"""Metres between the points of the grid on which the page searches."""

START, TARGET = (COARSE, COARSE), (7 * COARSE, 7 * COARSE)
STRAIGHT = math.dist(START, TARGET)


def planned_length(found: Plan | GridPlan) -> float:
    """The length of a path, and the straight distance that it leaves to the target."""
    return found.length + math.dist(found.points[-1], TARGET)


@trains(
    "astar_by_hand",
    "Paths through many random maps",
    action="Plan in Python",
    unit="maps",
    length="maps",
    settings={
        "search": Menu("search", tuple(SEARCHES)),
        "obstacles": Dial("obstacles", 0, 40, 5, 20),
        "margin": Dial("margin", 1.0, 4.0, 0.5, 2.0, " m"),
        "maps": Dial("maps", 20, 500, 20, 100),
        "seed": Dial("seed", 0, 20, 1, 0),
    },
    curves={
        "longer": Curve(
            "longer (%)",
            "By how much the paths found so far are longer than the straight line, on average.",
            digits=1,
        ),
        "expanded": Curve(
            "nodes expanded", "How many nodes a search expands, on average.", digits=0
        ),
    },
)
def many_searches(settings: dict[str, Any], report: Report) -> Trained:
    """Searches in random maps; the page gets the first of them, with a coarse grid on which to search by hand."""
    search, margin, total = settings["search"], settings["margin"], settings["maps"]
    worlds = random_worlds(
        total,
        settings["obstacles"],
        seed=SEED + settings["seed"],
        starts=(START,),
        targets=(TARGET,),
    )
    plans: list[Plan | GridPlan] = []
    lengths: list[float] = []
    for number in range(total):
        plans.append(SEARCHES[search](worlds[number], margin=margin))
        if plans[-1].found:
            lengths.append(planned_length(plans[-1]))
        report(
            len(plans),
            total,
            at=len(plans),
            expanded=float(np.mean([made.expanded for made in plans])),
            **({"longer": longer_than_straight(lengths)} if lengths else {}),
        )
    expanded = np.mean([made.expanded for made in plans])
    lengthened = (
        f" On average it is {longer_than_straight(lengths):.1f} % longer than the straight line."
        if lengths
        else ""
    )
    return Trained(
        plans,
        f"With {search}, a path was found in {len(lengths)} of {total} maps.{lengthened} A search expands "
        f"{expanded:.0f} nodes on average. The picture has the first map and a coarse grid.",
        grid_to_search(worlds[0], COARSE, margin),
    )


def longer_than_straight(lengths: list[float]) -> float:
    """By how many per cent paths are longer than the straight line, on average."""
    return 100 * (float(np.mean(lengths)) / STRAIGHT - 1)
