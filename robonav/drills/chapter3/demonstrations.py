"""Drills of the page on demonstrations."""

from __future__ import annotations

import numpy as np

from robonav import robot
from robonav.lfd.astar import Node

from ..pictures import CELL, box, label, picture, place
from ..question import Number, Place, Question, Table
from ..registry import drill

Rng = np.random.Generator
FREE = 10.0  # metres that a sector reads with nothing in range


@drill("demonstrations", "Degrees of danger")
def degrees_of_danger(rng: Rng) -> Question:
    """Read the degrees of danger of distances from Table 3.1."""
    ranges = np.round(rng.uniform(0.6, 10.0, size=4), 1)
    degrees = robot.degree_of_danger(ranges)
    reversed_degrees = (7 - degrees).tolist()
    return Question(
        f"Four sensors read ${', '.join(f'{r:g}' for r in ranges)}$ m. Which degrees of danger, 0 to 7, does "
        "Table 3.1 give them?",
        Table(
            ["degree"],
            [f"{r:g} m" for r in ranges],
            [degrees.tolist()],
            tolerance=0.1,
            wrong={"A large degree means a near obstacle.": [reversed_degrees]},
        ),
        "The degree falls from 7, a collision, by one with each interval of Table 3.1: "
        + ", ".join(f"{r:g} m gives {d}" for r, d in zip(ranges, degrees, strict=True))
        + ".",
    )


@drill("demonstrations", "Which node does A* expand next?")
def next_node(rng: Rng) -> Question:
    """Choose the open node with the smallest sum of cost and heuristic."""
    names = "ABCDE"
    cost, estimate = (np.round(rng.uniform(1, 9, size=5), 1) for _ in range(2))
    pairs = enumerate(zip(cost.tolist(), estimate.tolist(), strict=True))
    nodes = [Node(index=(k,), point=(0.0, 0.0), G=g, H=h) for k, (g, h) in pairs]
    total = np.array([node.F for node in nodes])
    best = nodes.index(min(nodes, key=lambda node: node.priority))
    wrong = {}
    nearest, cheapest = int(estimate.argmin()), int(cost.argmin())
    if cheapest != best:
        wrong[names[cheapest]] = (
            "This is the node nearest to the start. Dijkstra's algorithm expands it; A* adds the estimate."
        )
    if nearest not in (best, cheapest):
        wrong[names[nearest]] = (
            "This is the node nearest to the target by its estimate. A* also counts the way from the start."
        )
    tied = np.flatnonzero(np.isclose(total, total.min()))
    for k, name in enumerate(names):
        if k not in tied and name not in wrong:
            wrong[name] = (
                f"The sum $G + H = {total[k]:.4g}$ of this node is not the smallest."
            )
    parts = []
    for k, name in enumerate(names):
        x = 1 + 1.4 * CELL * k
        cell = box(x, 1, 1.3 * CELL, CELL, fill="transparent")
        cell += label(x + 0.65 * CELL, 14, name, size=13)
        cell += label(x + 0.65 * CELL, 34, f"G = {cost[k]:g}", size=13)
        cell += label(x + 0.65 * CELL, 52, f"H = {estimate[k]:g}", size=13)
        parts.append(place(name, cell))
    shown = picture(
        1.4 * CELL * 5,
        CELL + 2,
        *parts,
        title="Five open nodes, each with its cost G and its estimate H.",
    )
    sums = ", ".join(f"{name} {t:.4g}" for name, t in zip(names, total, strict=True))
    return Question(
        "Five nodes are open. $G$ is the cost of the way from the start, $H$ the estimate of the way that is left. "
        "Which node does A* expand next?",
        Place([*names], [names[k] for k in tied], wrong),
        f"A* expands the node with the smallest $F = G + H$: {sums}.",
        shown,
    )


@drill("demonstrations", "How many steps of a demonstration count?")
def effective_steps(rng: Rng) -> Question:
    """Count the steps in which the reflex left the decision to the expert."""
    total, safe = int(rng.integers(40, 70)), int(rng.integers(10, 25))
    blocked = int(rng.integers(1, 6))
    ranges = np.full((total, 9), FREE)
    ranges[safe:, 0] = 6.0  # something is in range
    ranges[safe : safe + blocked, [0, 1, 2, 7, 8]] = 2.0
    sensing = robot.Sensing(
        ranges, np.zeros((total, 9), bool), np.ones(total, int), np.zeros(total, bool)
    )
    effective = int((robot.Reflex()(sensing, 2.0) < 0).sum())
    return Question(
        f"A demonstration has ${total}$ steps. In ${safe}$ of them nothing is in sensor range, and in "
        f"${blocked}$ all five "
        "sectors ahead are blocked. How many steps become examples for training?",
        Number(
            effective,
            tolerance=0.1,
            wrong={
                "All steps are counted here. Where the reflex acts the expert decides nothing.": total,
                "In a safe state the reflex acts, too.": total - blocked,
                "Where the robot is blocked the reflex acts, too.": total - safe,
                "These are the steps in which the reflex acts.": safe + blocked,
            },
        ),
        f"The reflex acts in safe and in blocked states. The others are left: "
        f"${total} - {safe} - {blocked} = {effective}$.",
    )


PARTS = [[3, 4], [6, 8], [8, 6], [5, 12], [4, 3], [4, -3], [8, -6], [12, 5], [3, -4], [12, -9]]  # fmt: skip


@drill("demonstrations", "The length of a path")
def path_length(rng: Rng) -> Question:
    """Compare the length of a planned path with the distance of its ends."""
    points = np.cumsum(
        [[20, 40], *rng.choice(PARTS, size=3)],
        axis=0,
    ).astype(float)
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    straight = float(np.linalg.norm(points[-1] - points[0]))
    answer = float(lengths.sum())
    shown = ", ".join(f"({x:g}, {y:g})" for x, y in points)
    return Question(
        f"A path leads through the points {shown}. How long is it?",
        Number(
            answer,
            unit="m",
            wrong={
                "This is the distance of the two ends, a lower bound as the heuristic of A* is.": straight,
                "Distances are Euclidean; this adds up the differences of the coordinates.": float(
                    abs(steps).sum()
                ),
                "The last part is missing.": float(lengths[:-1].sum()),
            },
        ),
        f"${' + '.join(f'{n:g}' for n in lengths)} = {answer:g}$ m.",
    )
