"""Drills of the page on several robots."""

from __future__ import annotations

import math

import numpy as np

from robonav.robot import make_world, straight
from robonav.robot.team import ROBOT_RADIUS, Teams, TeamSimulator, navigate_team
from robonav.robot.team.plain import least_distance

from ..question import Number, Question
from ..registry import drill

Rng = np.random.Generator


@drill("several-robots", "How near do two robots come?")
def nearest_moment(rng: Rng) -> Question:
    """Compute the least distance of two robots in a second."""
    before = np.array([float(rng.integers(1, 6)), float(rng.integers(-3, 4))])
    while True:
        way = rng.integers(-4, 5, 2).astype(float)
        moment = -(before @ way) / max(way @ way, 1.0)
        if 0.1 < moment < 0.9:
            break
    after = before + way
    answer = least_distance(before, after)
    ends = math.hypot(*before), math.hypot(*after)
    nearest = before + moment * way
    collide = "they collide" if answer < 2 * ROBOT_RADIUS else "they do not collide"
    return Question(
        f"Seen from the first robot, the second is at $({before[0]:g}, {before[1]:g})$ m at the start of a second and "
        f"at $({after[0]:g}, {after[1]:g})$ m at its end. Both go straight. How near do their centres come, in metres?",
        Number(
            answer,
            tolerance=0.006,
            unit="m",
            wrong={
                "This is the lesser distance of the two ends; look between them, too.": min(
                    ends
                ),
                "This is the distance in the middle of the second.": math.hypot(
                    *(before + after) / 2
                ),
                "Two centres are asked for, not the reading of a sensor.": answer
                - ROBOT_RADIUS,
            },
        ),
        f"$\\mathbf{{v}} = ({way[0]:g}, {way[1]:g})$, so $t^* = {-(before @ way):g} / {way @ way:g} = {moment:.3g}$ "
        f"and $\\mathbf{{d}} = ({nearest[0]:.3g}, {nearest[1]:.3g})$, which is {answer:.3g} m long: {collide}.",
    )


@drill("several-robots", "What does the sensor read?")
def reading_of_another_robot(rng: Rng) -> Question:
    """Read the distance to another robot straight ahead."""
    x, y = (float(n) for n in rng.integers(10, 40, 2))
    legs = [(3, 4), (6, 8), (5, 0), (0, 7), (0, 9), (8, 0), (4, 3), (8, 6)]
    right, up = legs[int(rng.integers(len(legs)))]
    place = (x + right, y + up)
    beyond = (x + 5 * right, y + 5 * up)  # the target: the robot faces the other
    starts, targets = [[(x, y), place]], [[beyond, (50.0, 50.0)]]
    teams = Teams(make_world(), np.array(starts), np.array(targets))
    answer = float(TeamSimulator(teams).sense().ranges[0, 0])
    distance = math.hypot(right, up)
    return Question(
        f"A robot at $({x:g}, {y:g})$ m faces another robot, which is at $({place[0]:g}, {place[1]:g})$ m. Nothing "
        "else is near. Both are discs with a radius of 1 m. What does sensor 1, which looks ahead, read, in metres?",
        Number(
            answer,
            unit="m",
            wrong={
                "This is the distance of the centres. The other robot is a disc with a radius of 1 m.": distance,
                "Only the other robot's radius is subtracted: a range is measured from the robot's centre.": (
                    distance - 2 * ROBOT_RADIUS
                ),
                "Add the squares of the two differences, and take the root.": right
                + up
                - ROBOT_RADIUS,
            },
        ),
        f"$\\sqrt{{{right}^2 + {up}^2}} - 1 = {answer:g}$ m.",
    )


@drill("several-robots", "In which second do they collide?")
def second_of_the_collision(rng: Rng) -> Question:
    """Say in which second two robots collide that go towards each other."""
    speed, apart = float(rng.choice([1, 1.5, 2, 2.5, 3])), int(rng.integers(12, 61))
    starts, targets = [[(20, 50), (20 + apart, 50)]], [[(95, 50), (5, 50)]]
    teams = Teams(make_world(), np.array(starts), np.array(targets))
    crossed = navigate_team(straight, teams, speed, reflex=None)
    answer = int(crossed.steps[0, 0])
    seconds = (apart - 2 * ROBOT_RADIUS) / (2 * speed)
    return Question(
        f"Two robots go straight towards each other at ${speed:g}$ m/s each. Their centres are ${apart}$ m apart. In "
        "which second do they collide? The first second is number 1.",
        Number(
            answer,
            wrong={
                "Both move: they come nearer by twice the speed.": math.floor(
                    (apart - 2 * ROBOT_RADIUS) / speed
                )
                + 1,
                "They collide before their centres meet: at less than 2 m.": math.floor(
                    apart / (2 * speed)
                )
                + 1,
                "This is the number of whole seconds before the collision. They collide in the next one.": (
                    answer - 1
                ),
            },
        ),
        f"Every second they come ${2 * speed:g}$ m nearer. They are 2 m apart after $({apart} - 2) / {2 * speed:g} = "
        f"{seconds:.3g}$ s, and nearer in second {answer}.",
    )


@drill("several-robots", "What did the others contribute?")
def gain_of_learning_together(rng: Rng) -> Question:
    """Compute which share of the failures learning together avoids."""
    alone = int(rng.integers(40, 81))
    together = int(rng.integers(alone + 5, 96))
    before = int(rng.integers(3, 12))
    answer = 100 * (together - alone) / (100 - alone)
    return Question(
        f"Among sixteen robots, a policy that learned alone arrives in {alone} %. The same learner arrives in "
        f"{together} % after as many episodes among seven others, and before any training in {before} %. Which share "
        "of the failures did learning together avoid, in per cent?",
        Number(
            answer,
            tolerance=0.06,
            unit="%",
            wrong={
                "These are points of arrivals. The failures of the policy that learned alone are the whole.": (
                    together - alone
                ),
                "Compare with the policy that learned alone: training alone helps, too.": (
                    100 * (together - before) / (100 - before)
                ),
                "This is the share of the failures that is left.": 100 - answer,
            },
        ),
        f"Of {100 - alone} failures in a hundred, {100 - together} are left: $({100 - alone} - {100 - together}) / "
        f"{100 - alone} = {answer:.4g}$ %.",
    )
