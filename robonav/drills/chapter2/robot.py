"""Drills of the page on the robot and its worlds."""

from __future__ import annotations

import math

import numpy as np

from robonav import robot

from ..question import Choice, Number, Question, Table
from ..registry import drill

Rng = np.random.Generator
NAMES = ("F", "L30", "L60", "R30", "R60", "B")
FREE = 10.0  # metres that a sector reads with nothing in range


def _alike(table: list[list[float]], position: np.ndarray) -> bool:
    """Whether a mistake does not show in this question."""
    return bool(np.abs(table[0] - position).max() < 0.02)


@drill("robot", "Where does a step lead?")
def one_step(rng: Rng) -> Question:
    """Compute the pose after an action."""
    x, y = (float(rng.integers(20, 80)) for _ in range(2))
    heading, action = int(rng.choice([0, 30, 60, 90, 120, 180])), int(rng.integers(6))
    speed = float(rng.choice([1.0, 2.0, 3.0]))
    simulator = robot.Simulator(robot.make_world(), speed)
    simulator.poses = np.array([[x, y, math.radians(heading)]])
    simulator.step(np.array([action]))
    after = simulator.poses[0, :2]

    def moved(degrees: float, distance: float = speed) -> list[list[float]]:
        angle = math.radians(degrees)
        return [[x + distance * math.cos(angle), y + distance * math.sin(angle)]]

    turn = (0, 30, 60, -30, -60, 0)[action]
    wrong = {}
    if turn:
        wrong["The robot turns first, and then goes in the new direction."] = moved(
            heading
        )
        wrong["Left turns are positive, right turns are negative."] = moved(
            heading - turn
        )
    if NAMES[action] == "B":
        wrong["B goes backwards."] = moved(heading)
    end = heading + turn
    sign = -1 if NAMES[action] == "B" else 1
    wrong["The cosine belongs to x and the sine to y."] = moved(90 - end, sign * speed)
    if speed > 1:
        wrong["The step is as long as the robot goes in a second."] = moved(end, sign)
    wrong = {hint: table for hint, table in wrong.items() if not _alike(table, after)}
    return Question(
        f"The robot stands at $({x:g}, {y:g})$ with the heading ${heading}°$ and goes at ${speed:g}$ m/s in an empty "
        f"map. Where is it after one step of action {NAMES[action]}? L and R turn left and right before the step, and "
        "B steps backwards.",
        Table(["position"], ["x", "y"], [after.tolist()], wrong=wrong),
        f"The new heading is ${end}°$. "
        + ("It goes backwards: " if NAMES[action] == "B" else "")
        + f"$x = {x:g} {'-' if NAMES[action] == 'B' else '+'} {speed:g} \\cos {end}° = {after[0]:.4g}$ and "
        f"$y = {y:g} {'-' if NAMES[action] == 'B' else '+'} {speed:g} \\sin {end}° = {after[1]:.4g}$.",
    )


@drill("robot", "What does a sensor read?")
def sensor_reading(rng: Rng) -> Question:
    """Compute the distance that a sector reads."""
    ahead = float(rng.integers(8, 19)) / 2
    radius = float(rng.choice([0.5, 1.0, 1.5, 2.0]))
    side = float(rng.choice([-1.0, -0.5, 0.0, 0.5, 1.0]))
    world = robot.make_world(circles=[(50 + ahead, 50 + side, radius)])
    reading = float(robot.sense(world, [(50, 50, 0)]).ranges[0, 0])
    distance = math.hypot(ahead, side)
    return Question(
        f"The robot stands at $(50, 50)$ and looks along the x axis. A round obstacle of radius "
        f"${radius:g}$ m has its "
        f"centre at $({50 + ahead:g}, {50 + side:g})$. What does sensor 1, the one ahead, read?",
        Number(
            reading,
            unit="m",
            wrong={
                "This is the distance of the centre. A sensor reads the distance of the surface.": distance,
                "The radius is subtracted, not added.": distance + radius,
                "The radius counts once, not the diameter.": distance - 2 * radius,
            },
        ),
        f"The centre is ${distance:.4g}$ m away, and the surface is one radius nearer: "
        f"${distance:.4g} - {radius:g} = {reading:.4g}$ m.",
    )


@drill("robot", "In which sector does it lie?")
def sector_of_point(rng: Rng) -> Question:
    """Tell which of the nine sectors holds a point."""
    bearing = int(rng.integers(-17, 18)) * 10
    heading = int(rng.choice([0, 30, 90, 150]))
    if (bearing - 20) % 40 == 0:  # on a border between two sectors
        bearing += 10
    angle = math.radians(heading + bearing)
    target = (50 + 20 * math.cos(angle), 50 + 20 * math.sin(angle))
    world = robot.make_world(target=target)
    sensing = robot.sense(world, [(50, 50, math.radians(heading))])
    sector = int(sensing.target_region[0])
    mirrored = 1 if sector == 1 else 11 - sector
    without = int(robot.sense(world, [(50, 50, 0)]).target_region[0])
    wrong = {}
    if mirrored != sector:
        wrong[str(mirrored)] = (
            "Sectors are numbered counter-clockwise, to the left first."
        )
    if without not in (sector, mirrored):
        wrong[str(without)] = "Sectors turn with the robot: subtract its heading."
    for other in (sector % 9 + 1, (sector - 2) % 9 + 1, (sector + 3) % 9 + 1):
        if str(other) not in wrong and other != sector:
            wrong[str(other)] = (
                "Each sector is 40 degrees wide, and sector 1 reaches from -20 to 20 degrees."
            )
    return Question(
        f"The robot's heading is ${heading}°$. The target lies in the direction "
        f"${(heading + bearing) % 360}°$ of the "
        "map. Which of the robot's nine sectors holds it? Sector 1 lies ahead, the others follow counter-clockwise.",
        Choice(str(sector), wrong),
        f"Seen from the robot the target lies at ${(heading + bearing) % 360}° - {heading}°$, that is "
        f"at ${bearing}°$. "
        f"Sector 1 reaches from $-20°$ to $20°$, and each further one, counter-clockwise, is $40°$ wide: sector "
        f"{sector}.",
    )


@drill("robot", "What does the reflex do?")
def what_the_reflex_does(rng: Rng) -> Question:
    """Predict whether the reflex or the policy acts."""
    speed = float(rng.choice([1.0, 2.0, 3.0]))
    kind = rng.choice(["free", "blocked", "near"])
    ranges = np.full(9, FREE)
    if kind == "blocked":
        ranges[[0, 1, 2, 7, 8]] = np.round(rng.uniform(1.0, speed + 0.9, size=5), 1)
    if kind == "near":
        ranges[[0, 1, 2, 7, 8]] = np.round(rng.uniform(1.0, speed + 0.9, size=5), 1)
        ranges[int(rng.choice([1, 2, 7, 8]))] = round(
            float(rng.uniform(speed + 1.2, 8)), 1
        )
    sensing = robot.Sensing(
        ranges[None], np.zeros((1, 9), bool), np.array([1]), np.array([False])
    )
    command = int(robot.Reflex()(sensing, speed)[0])
    if command == robot.Action.TO_SECTOR:
        command = (
            robot.Action.TO_TARGET
        )  # what the robot knows of the direction does not matter here
    answers = {
        robot.Action.TO_TARGET: "The reflex turns the robot towards the target, and it goes forward.",
        robot.Action.B: "The reflex makes it step back.",
        -1: "The policy chooses the action.",
    }
    hints = {
        robot.Action.TO_TARGET: "That happens only if no sector reads less than 10 m.",
        robot.Action.B: "That happens only if each of the five sectors ahead reads less than one step plus 1 m.",
        -1: "The policy is asked only if something is in range and not all five sectors ahead are blocked.",
    }
    wrong = {answers[key]: hints[key] for key in answers if key != command}
    limit = speed + 1
    why = {
        robot.Action.TO_TARGET: "Nothing is in range, so the state is safe.",
        robot.Action.B: f"All five sectors ahead, 8, 9, 1, 2 and 3, read less than ${speed:g} + 1 = {limit:g}$ m.",
        -1: f"Something is in range, and a sector ahead reads at least ${speed:g} + 1 = {limit:g}$ m.",
    }
    return Question(
        f"At ${speed:g}$ m/s sensors 1 to 9 read ${', '.join(f'{r:g}' for r in ranges)}$ m. They reach 10 m. A sector "
        "is blocked if it reads less than one step plus 1 m. Who acts?",
        Choice(answers[robot.Action(command) if command >= 0 else -1], wrong),
        why[command],
    )
