"""Drills of the page on planners that learn nothing."""

from __future__ import annotations

import math

import numpy as np

from robonav.planners import (
    BugMemory,
    bug,
    dynamic_window,
    free_way,
    potential_field,
    vector_field_histogram,
)
from robonav.planners.sectors import WAYS
from robonav.planners.vector_field_histogram import BINS
from robonav.robot import Sensing

from ..question import Choice, Number, Question
from ..registry import drill

Rng = np.random.Generator
FREE = 10.0  # metres that a sector reads with nothing in range


def _readings(ranges: np.ndarray, region: int = 1) -> Sensing:
    """What one robot senses: its nine ranges, and the sector of its target."""
    return Sensing(
        ranges[None], np.zeros((1, 9), bool), np.array([region]), np.array([False])
    )


@drill("planners", "The sum of two forces")
def sum_of_forces(rng: Rng) -> Question:
    """Compute the force of a potential field in front of an obstacle."""
    eta, influence = float(rng.integers(6, 31)), float(rng.choice([5, 6, 8, 10]))
    rho = float(rng.choice([2.0, 2.5, 3.0, 4.0]))
    ranges = np.full(9, FREE)
    ranges[0] = rho
    attraction, repulsions = potential_field(
        _readings(ranges), repulsion=eta, influence=influence
    )
    answer = float(attraction[0, 0] + repulsions[0, :, 0].sum())
    difference = 1 / rho - 1 / influence
    return Question(
        f"The target lies straight ahead and attracts the robot with a force of 1. Sensor 1, which looks ahead, reads "
        f"${rho:g}$ m, and all others read 10 m. An obstacle at the distance $\\rho$ has the potential "
        "$\\frac{\\eta}{2} (1 / \\rho - 1 / \\rho_0)^2$. What is the sum of the forces ahead, with "
        f"$\\eta = {eta:g}$ and $\\rho_0 = {influence:g}$ m?",
        Number(
            answer,
            wrong={
                "The repulsion pushes back, so it is subtracted.": 2 - answer,
                "This is the slope without the factor $1 / \\rho^2$.": 1
                - eta * difference,
                "The force is zero where the influence ends: $1 / \\rho_0$ is subtracted.": 1
                - eta / rho**3,
                "This is the potential, not the force.": 1 - eta / 2 * difference**2,
            },
        ),
        f"$1 - {eta:g} (1/{rho:g} - 1/{influence:g}) / {rho:g}^2 = {answer:.4g}$. "
        + ("The robot is pushed back." if answer < 0 else "The target still wins."),
    )


@drill("planners", "How wide does an obstacle become?")
def angle_of_the_clearance(rng: Rng) -> Question:
    """Compute the angle by which VFH+ enlarges an obstacle."""
    clearance = float(rng.integers(10, 21)) / 10
    distance = round(clearance * float(rng.uniform(1.25, 4)), 1)
    answer = math.degrees(math.asin(clearance / distance))
    return Question(
        f"A sensor reads ${distance:g}$ m. The robot and its safety distance take ${clearance:g}$ m. By how many "
        "degrees does VFH+ enlarge the obstacle to either side?",
        Number(
            answer,
            tolerance=0.06,
            unit="°",
            wrong={
                "The line that just passes is a tangent of the circle around the obstacle, at a right angle to its "
                "radius: take the arcsine.": math.degrees(
                    math.atan(clearance / distance)
                ),
                "This is the angle on both sides together.": 2 * answer,
                "This is clearance over distance as if it were an angle in radians.": (
                    math.degrees(clearance / distance)
                ),
            },
        ),
        f"$\\arcsin({clearance:g} / {distance:g}) = {answer:.4g}°$.",
    )


@drill("planners", "Which opening costs least?")
def cheapest_opening(rng: Rng) -> Question:
    """Choose a direction by the cost of VFH+."""
    place = int(rng.integers(3))  # of the right one from the right
    while True:
        keep = float(rng.choice([0.5, 1.0, 2.0]))
        middles = np.sort(rng.choice(np.arange(-16, 17, 4), size=3, replace=False))
        target = int(rng.choice([-60, -30, 0, 30, 60]))
        degrees = [int(5 * middle) for middle in middles]
        costs = [abs(d - target) + keep * abs(d) for d in degrees]
        first, second, _ = np.sort(costs)
        if np.diff(middles).min() > 4 and first < second and costs[place] == first:
            break
    free = np.zeros(BINS, bool)
    for middle in middles:
        free[(middle + np.arange(-1, 2)) % BINS] = True
    histogram = np.where(free, 0.0, 1.0)[None]
    found = vector_field_histogram(
        histogram,
        np.radians([target]),
        threshold=0.5,
        wide=8,
        keep=keep,
    )
    right = round(math.degrees(found[0]))
    written = [f"{d}°" for d in degrees]
    hints = {
        f"{d}°": f"Its cost is ${abs(d - target)} + {keep:g} \\cdot {abs(d)} = {cost:g}$."
        for d, cost in zip(degrees, costs, strict=True)
        if d != right
    }
    return Question(
        f"Three narrow openings have their middles at {', '.join(written)} (left is positive). The target lies at "
        f"{target}°. The cost of a direction is its angle to the target plus {keep:g} times its angle to the heading. "
        "Where does the robot go?",
        Choice(f"{right}°", hints, order=tuple(written)),
        "The costs are " + ", ".join(f"{cost:g}" for cost in costs) + " degrees.",
    )


BEARINGS = {1: 0, 2: 40, 3: 80, 8: -80, 9: -40}
"""Degrees of the middles of the sectors ahead, by their number."""


@drill("planners", "Which action wins in the window?")
def best_of_the_window(rng: Rng) -> Question:
    """Find the admissible action with the best score."""
    best, robot = int(rng.integers(5)), {"clearance": 1.0, "half_width": 0.0}
    while True:
        heading = float(rng.choice([0.2, 0.5, 1.0]))
        distance = float(rng.choice([0.2, 1.0]))
        region = int(rng.choice([*BEARINGS]))
        ranges = np.full(9, FREE)
        for sector in rng.choice([0, 1, 8], size=2, replace=False):
            ranges[sector] = float(rng.choice([2.5, 3.0, 4.0, 6.0, 10.0]))
        sensing = _readings(ranges, region)
        scores = dynamic_window(
            sensing, speed=2.0, heading=heading, distance=distance, **robot
        )[0, :5]
        others = np.delete(scores, best)
        if scores[best] - others.max() > 0.011:  # clear by two decimals
            break
    bearing = BEARINGS[region]
    ways = free_way(sensing.ranges, WAYS, **robot)[0, :5].round(1)
    names = ("F", "L30", "L60", "R30", "R60")
    hints = {
        name: "Its step is not admissible: the way is shorter than 2 m."
        if score < 0
        else f"Its score is ${score:.2f}$, that of {names[best]} ${scores[best]:.2f}$."
        for name, score in zip(names, scores, strict=True)
        if name != names[best]
    }
    listed = ", ".join(
        f"{name} {free:g}" for name, free in zip(names, ways, strict=True)
    )
    return Question(
        f"The ways that are free in metres are: {listed}. The target lies at {bearing}° (left is positive), and a "
        f"step is 2 m long. An admissible action with the free way $w$ and the angle $\\alpha$ to the target scores "
        f"${heading:g} \\, (1 - \\alpha / 180°) + {distance:g} \\, w / 10 + 1$. Which action wins?",
        Choice(names[best], hints, order=names),
        "The scores are "
        + ", ".join(
            f"{name} {score:.2f}" if score >= 0 else f"{name} not admissible"
            for name, score in zip(names, scores, strict=True)
        )
        + ".",
    )


STAYS, LEAVES = "It goes on following the obstacle", "It leaves the obstacle"


@drill("planners", "Leave the obstacle or follow it?")
def leave_or_follow(rng: Rng) -> Question:
    """Decide by its memory whether a bug leaves an obstacle."""
    least, ahead = float(rng.integers(20, 60)), float(rng.choice([6.0, 8.0, 10.0]))
    distance = least + float(rng.integers(0, 13))
    ranges = np.full(9, FREE)
    ranges[2] = 3.0  # the obstacle, on the left
    if ahead < FREE:
        ranges[0] = ahead + 1
    _, after = bug(
        BugMemory(np.array([1]), np.array([least])), _readings(ranges), np.zeros(1), np.array([distance]),
        speed=2.0, clearance=1.0, half_width=0.0, sight=4.0,
    )  # fmt: skip
    right = LEAVES if after.side[0] == 0 else STAYS
    seen = distance - ahead
    said = f"The free point is {seen:g} m from the target. "
    why = said + (
        f"This is more than a step nearer than {least:g} m."
        if right == LEAVES
        else f"This is not more than a step nearer than {least:g} m."
    )
    return Question(
        "A bug follows an obstacle on its left. Since it met it, it has never been nearer to the target than "
        f"{least:g} m. Now the target is {distance:g} m away, straight ahead, and the way to it is free for "
        f"{ahead:g} m. A step is 2 m long. The bug leaves if the farthest free point on this way is more than a "
        "step nearer to the target than the bug has been. What does it do?",
        Choice(
            right, {STAYS if right == LEAVES else LEAVES: why}, order=(STAYS, LEAVES)
        ),
        why,
    )
