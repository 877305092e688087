"""Drills of the page on a planner as the expert."""

from __future__ import annotations

import numpy as np

from robonav.lfd.astar import Node

from ..pictures import CELL, box, label, picture, place
from ..question import Choice, Number, Place, Question
from ..registry import drill

Rng = np.random.Generator


@drill("a-star", "Which node does A* expand next?")
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


PARTS = [[3, 4], [6, 8], [8, 6], [5, 12], [4, 3], [4, -3], [8, -6], [12, 5], [3, -4], [12, -9]]  # fmt: skip


@drill("a-star", "The length of a path")
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


@drill("a-star", "Two estimates to be checked")
def admissible_or_consistent(rng: Rng) -> Question | None:
    """Say whether an estimate is admissible and whether it is consistent."""
    first, second = (float(x) for x in rng.integers(2, 7, size=2))
    x, y = (float(n) for n in rng.integers(0, 11, size=2))
    admissible = x <= first + second and y <= second
    consistent = admissible and x <= first + y
    right = {
        (True, True): "admissible and consistent",
        (True, False): "admissible, but not consistent",
        (False, False): "neither",
    }[admissible, consistent]
    if rng.random() > {"neither": 0.4}.get(right, 1.0):
        return None  # most estimates that are drawn are too large
    reasons = {
        "admissible and consistent": "Compare each estimate with the length that is left, and the difference of the "
        "two estimates with the step between them.",
        "admissible, but not consistent": "Admissible: no estimate is larger than what is left. Consistent: along a "
        "step the estimate falls by no more than the length of the step.",
        "neither": "An estimate that is not larger than what is left is admissible. Check both nodes.",
    }
    return Question(
        f"The only path goes from X to Y, a step of ${first:g}$ m, and from Y to the target, a step of "
        f"${second:g}$ m. The estimates are $H(X) = {x:g}$, $H(Y) = {y:g}$ and $0$ at the target. Is $H$ admissible, "
        "and is it consistent?",
        Choice(right, {name: hint for name, hint in reasons.items() if name != right}),
        f"${first + second:g}$ m are left at X and ${second:g}$ m at Y, so $H$ is "
        f"{'admissible' if admissible else 'not admissible, and then not consistent either'}. "
        + (
            f"From X to Y it falls by ${x - y:g}$, and the step has ${first:g}$ m; from Y to the target by ${y:g}$, "
            f"and the step has ${second:g}$ m: it is {'consistent' if consistent else 'not consistent'}."
            if admissible
            else ""
        ),
    )


@drill("a-star", "Another path to an open node")
def path_to_open_node(rng: Rng) -> Question:
    """Enter a neighbour into the open list with the shorter of two paths."""
    here, step, estimate = (float(n) for n in np.round(rng.uniform(1, 9, size=3), 1))
    old = round(here + step + float(rng.choice([-2.5, -1.2, 0.8, 1.5, 3.0])), 1)
    tentative = here + step
    node = Node(index=(0,), point=(0.0, 0.0), G=min(old, tentative), H=estimate)
    shorter = tentative < old
    return Question(
        f"A* expands a node with $G = {here:g}$. A neighbour, ${step:g}$ m away, is in the open list already, with "
        f"$G = {old:g}$ and $H = {estimate:g}$. Which $F$ does the neighbour have afterwards?",
        Number(
            node.F,
            unit="m",
            wrong={
                (
                    "The path through the expanded node is shorter. The neighbour takes it."
                    if shorter
                    else "The path through the expanded node is longer. The neighbour keeps its own."
                ): max(old, tentative) + estimate,
                "This is $G$ alone. $F$ also contains the estimate of the rest.": node.G,
                "The step to the neighbour is missing.": here + estimate,
            },
        ),
        f"Through the expanded node $G$ would be ${here:g} + {step:g} = {tentative:.4g}$, "
        f"{'less' if shorter else 'more'} than ${old:g}$. So $F = {node.G:.4g} + {estimate:g} = {node.F:.4g}$.",
    )
