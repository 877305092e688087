"""The numbers of chapter 3's explorables."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from robonav.lfd import demonstrate, learn_policy, plan
from robonav.lfd.astar import EIGHT_DIRECTIONS, step_clearance
from robonav.networks import toy_datasets
from robonav.robot import (
    Policy,
    Worlds,
    clearance,
    make_world,
    navigate,
    random_worlds,
    straight,
    turn_to_clearer_side,
)

from ..simulator import page_world
from .registry import asks


@asks(
    "One neuron, two weights and its line",
    "The output of a neuron is above 0.5 on one side of a line and below 0.5 on the other. "
    "You double both weights and the bias. "
    "What happens?",
    guesses=[
        "the line moves away from the origin",
        "the line turns towards an axis",
        "the line stays, the output gets steeper",
        "neither the line nor the output changes",
    ],
    right="the line stays, the output gets steeper",
    because="Where w₁x₁ + w₂x₂ + b is 0, twice this sum is 0 too, but beside the line the sum is "
    "twice as large.",
)
def neuron_line(points: int = 40) -> dict[str, Any]:
    """Two sets of labelled points: one that a line can divide, one that none can."""
    rng = np.random.default_rng(3)
    labels = np.arange(points) % 2
    clouds = np.array([[-1.0, -0.6], [1.1, 0.9]])[labels]
    clouds = clouds + rng.normal(scale=0.4, size=(points, 2))
    corners, opposite = toy_datasets.xor(points, seed=0)
    sets = {
        "two clouds": (clouds, labels),
        "opposite corners": (2 * corners, opposite.ravel()),
    }
    return {
        "sets": [
            {
                "name": name,
                "points": np.round(x, 3).tolist(),
                "labels": np.asarray(y).astype(int).tolist(),
            }
            for name, (x, y) in sets.items()
        ]
    }


@asks(
    "Backpropagation, a number at a time",
    "The first weight is 1. "
    "You raise it to 8, so that the output of the hidden unit is close to 1. "
    "What happens to the gradient of this weight?",
    guesses=["it grows eightfold", "it stays the same", "it nearly vanishes"],
    right="it nearly vanishes",
    because="The gradient contains the slope a(1 − a) of the hidden unit, which is 0.002 at a = "
    "0.998.",
)
def backpropagation_by_hand() -> dict[str, Any]:
    """Nothing: the page computes all numbers from the reader's."""
    return {}


def small_map() -> Worlds:
    """A map of 40 m with an angle of two walls in the way."""
    walls = [(22, 22, 3, 16, 0), (15, 29, 14, 3, 0)]
    return make_world(rectangles=walls, start=(5, 5), target=(35, 35), size=40)


@asks(
    "A* by hand",
    "A* expands the open node with the smallest F = G + H: the length of the path to the "
    "node, plus its straight distance to the target. "
    "Leave H out, and expand the node with the smallest G. "
    "What changes?",
    guesses=[
        "a longer path",
        "the same length, more nodes",
        "a longer path, fewer nodes",
        "nothing",
    ],
    right="the same length, more nodes",
    because="H directs the search towards the target; without it, 39 nodes are expanded instead of "
    "22, and the path is still a shortest one.",
)
def astar_by_hand() -> dict[str, Any]:
    """The points of a coarse grid over a small map, and the steps that keep the margin."""
    return grid_to_search(small_map(), cell=5.0, margin=2.0)


def grid_to_search(world: Worlds, cell: float, margin: float) -> dict[str, Any]:
    """The points of a grid that has start and target of a map among them, and the steps that keep the margin."""
    middles = np.arange(cell, world.size, cell)
    points = [(float(x), float(y)) for x, y in product(middles, middles)]
    place = {point: number for number, point in enumerate(points)}
    steps = []
    for x, y in points:
        beside = [(x + cell * right, y + cell * up) for right, up in EIGHT_DIRECTIONS]
        steps.append(
            [
                place[point]
                for point in beside
                if point in place
                and step_clearance(world, (x, y), point, margin) >= margin
            ]
        )
    return {
        "points": points,
        "steps": steps,
        "start": place[tuple(world.starts[0].tolist())],
        "target": place[tuple(world.targets[0].tolist())],
        "size": world.size,
        "obstacles": page_world(world)["obstacles"],
    }


@asks(
    "What does a margin cost?",
    "The planner may pass obstacles at a distance of 1 m, and its path is 114 m long. "
    "Now it must keep a margin of 3 m from everything. "
    "How much longer is the path?",
    guesses=["not at all", "about 5 %", "about 15 %", "there is no path"],
    right="not at all",
    because="Between the obstacles there are many paths of nearly the same length, and one of them "
    "keeps 3 m away.",
    files=("simulator", "maps"),
)
def margin_and_caution(seed: int = 21) -> dict[str, Any]:
    """The expert's paths in one map for some margins and some caution."""
    world = random_worlds(1, obstacles=15, seed=seed)
    margins, cautions = [1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0], [0, 1, 2, 3]
    paths = []
    for caution, margin in product(cautions, margins):
        made = plan(world, margin=margin, caution=caution, cell=2)
        along = world[np.zeros(len(made.points), int)]
        paths.append(
            {
                "points": made.points.round(2).tolist(),
                "length": float(made.length),
                "clearance": float(clearance(along, made.points).min()),
            }
        )
    return {
        "world": page_world(world),
        "margins": margins,
        "cautions": cautions,
        "paths": paths,
    }


@asks(
    "What does accuracy say?",
    "Two policies have learned nothing: one always goes straight on, the other turns to the "
    "freer side. "
    "Near obstacles, each takes the expert's action in 44.1 % of the steps. "
    "How far apart are their success rates in new maps?",
    guesses=["they are equal", "up to 10 points", "more than 50 points"],
    right="more than 50 points",
    because="Accuracy is counted in the states that the expert visits; in their own episodes the two "
    "policies meet other states.",
)
def accuracy_and_success(maps: int = 500) -> dict[str, Any]:
    """How often three policies take the expert's action, by action, and how often they arrive."""
    worlds = random_worlds(25, obstacles=10, seed=7)
    demonstrations = demonstrate(worlds)
    pairs = demonstrations.effective
    unseen = random_worlds(maps, obstacles=10, seed=2024)
    policies: dict[str, Policy] = {
        "straight on": straight,
        "freer side": turn_to_clearer_side,
        "learned": learn_policy(demonstrations, seed=0),
    }
    rows = []
    for name, policy in policies.items():
        chosen = np.asarray(policy(pairs.sensing, np.random.default_rng(0)))
        same = chosen == pairs.actions
        right = [int(same[pairs.actions == action].sum()) for action in range(5)]
        success = float(navigate(policy, unseen).success.mean())
        rows.append({"name": name, "right": right, "success": success})
    return {
        "policies": rows,
        "counts": np.bincount(pairs.actions, minlength=5).tolist(),
        "safe": len(demonstrations) - len(pairs),
        "maps": maps,
    }


@asks(
    "How many maps make a test?",
    "A policy reaches its target in 8 of 8 new maps. "
    "Where does the 95 % interval of its true success rate begin?",
    guesses=["at 99 %", "at 95 %", "at 90 %", "at 68 %"],
    right="at 68 %",
    because="A policy that arrives in seven of ten maps passes such a test once in seventeen times, "
    "so eight maps cannot exclude it.",
    files=("learning/trials",),
)
def wilson_interval() -> dict[str, Any]:
    """Nothing: the page computes the intervals."""
    return {}


@asks(
    "Errors that add up",
    "A policy errs once in 100 decisions on the expert's path. "
    "An error takes it off the path, where it errs in 90 of 100 decisions, and a right "
    "decision leads back to the path in one of five cases. "
    "How many errors do you expect in 100 decisions?",
    guesses=["about 1", "about 5", "about 21", "about 90"],
    right="about 21",
    because="In many episodes the first error comes early, and after it nearly every decision is "
    "wrong.",
)
def compounding_errors() -> dict[str, Any]:
    """Nothing: the page computes the expected errors."""
    return {}


@asks(
    "Sectors as numbers",
    "The target moves around the robot, one sector at a time. "
    "With which encoding is the largest change of the network's inputs smallest?",
    guesses=["1 to 9", "−4 to 4", "one-hot", "sine and cosine"],
    right="sine and cosine",
    because="With sine and cosine every step to a neighbouring sector changes the inputs by 0.68, and "
    "every other encoding has a larger jump somewhere.",
    files=("simulator",),
)
def target_encoding() -> dict[str, Any]:
    """Nothing: the page's simulator has the encodings."""
    return {}
