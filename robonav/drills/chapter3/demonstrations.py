"""Drills of the page on demonstrations."""

from __future__ import annotations

import numpy as np

from robonav import robot

from ..question import Number, Question, Table
from ..registry import drill

Rng = np.random.Generator
FREE = SENSED = (
    10.0  # metres that a sector reads with nothing in range, and that caution reaches
)


@drill("demonstrations", "Degrees of danger")
def degrees_of_danger(rng: Rng) -> Question:
    """Read the degrees of danger of distances from Table 3.1."""
    ranges = np.round(rng.uniform(0.6, 10.0, size=4), 1)
    degrees = robot.degree_of_danger(ranges)
    reversed_degrees = (7 - degrees).tolist()
    borders = (
        f"{7 - k} below {border:.3g} m"
        for k, border in enumerate(robot.encoding.DANGER_BORDERS)
    )
    return Question(
        f"Four sensors read ${', '.join(f'{r:g}' for r in ranges)}$ m. By Table 3.1, for sensors that reach 10 m, the "
        f"degree of danger is {', '.join(borders)}, and 0 otherwise; the first that fits counts. Which degrees do "
        "the readings have?",
        Table(
            ["degree"],
            [f"{r:g} m" for r in ranges],
            [degrees.tolist()],
            tolerance=0.1,
            wrong={"A large degree means a near obstacle.": [reversed_degrees]},
        ),
        "The degree falls from 7, a collision, by one with each border that the reading reaches: "
        + ", ".join(f"{r:g} m gives {d}" for r, d in zip(ranges, degrees, strict=True))
        + ".",
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


BY_ANGLE = ("R60", "R30", "F", "L30", "L60")


@drill("demonstrations", "An expert that slips")
def slipping_expert(rng: Rng) -> Question:
    """Compute which actions an expert with an unsteady hand demonstrates."""
    chance = float(rng.integers(5, 46)) / 100
    meant = str(rng.choice(BY_ANGLE))
    numbers = [int(robot.Action[name]) for name in BY_ANGLE]
    answer = robot.neighbour_slip(chance)[int(robot.Action[meant]), numbers]
    at = BY_ANGLE.index(meant)
    beside = [k for k in (at - 1, at + 1) if 0 <= k < 5]
    whole, half = np.zeros(5), np.zeros(5)
    whole[at], half[at] = 1 - 2 * chance, 1 - chance
    whole[beside], half[beside] = chance, chance / 2
    wrong = {
        "Without slips only the intended action happens. It slips with the given probability.": np.eye(
            5
        )[at][:, None].tolist(),
    }
    if len(beside) == 2:
        wrong[
            "The given probability is that of a slip to either side, half to each."
        ] = whole[:, None].tolist()
    else:
        wrong["There is only one side, so it has the whole probability of a slip."] = (
            half[:, None].tolist()
        )
    named = " or ".join(BY_ANGLE[k] for k in beside)
    return Question(
        f"An expert's turns slip with probability ${chance:g}$: they come out $30°$ too large or too small, "
        "equally often; where only one of these actions exists, it is always that one. The expert means "
        f"{meant}. With which probability does the robot do each action?",
        Table(BY_ANGLE, ["probability"], answer[:, None].tolist(), wrong=wrong),
        f"With probability ${1 - chance:g}$ it does {meant}. The rest, ${chance:g}$, goes to {named}.",
    )


@drill("demonstrations", "What does caution add to a step?")
def cautious_step(rng: Rng) -> Question:
    """Compute what a step near an obstacle costs a cautious planner."""
    length, caution = float(rng.choice([1.0, 2.0, 3.0])), float(rng.integers(1, 6))
    distance = float(rng.integers(1, 10))
    near = 1 - distance / SENSED
    answer = length * (1 + caution * near**2)
    return Question(
        f"A step of ${length:g}$ m ends ${distance:g}$ m from the nearest obstacle. What does it cost an expert with "
        f"caution ${caution:g}$? A step of $l$ metres that ends $d$ metres from it costs "
        "$l \\, (1 + c \\, (1 - d / 10)^2)$ with caution $c$.",
        Number(
            answer,
            wrong={
                "This is the part that caution adds. The length of the step counts too.": length
                * caution
                * near**2,
                "The nearness is squared.": length * (1 + caution * near),
                "A step costs more where the obstacle is nearer: $1 - d / 10$ is squared, not $d / 10$.": length
                * (1 + caution * (distance / SENSED) ** 2),
                "The factor multiplies the length.": 1 + caution * near**2 + length,
            },
        ),
        f"${length:g} \\cdot (1 + {caution:g} \\cdot (1 - {distance:g} / 10)^2) = {answer:.4g}$.",
    )
