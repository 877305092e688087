"""Drills of the page on a robot with a body."""

from __future__ import annotations

import math

import numpy as np

from ..question import Number, Question
from ..registry import drill

Rng = np.random.Generator
ANGLES = (60, 180, 300)


@drill("body", "How fast does the wheel turn?")
def speed_of_a_wheel(rng: Rng) -> Question:
    """Compute how fast a wheel turns for a motion of its base."""
    wheel = int(rng.integers(3))
    forward, left, turn = (float(n) / 2 for n in rng.integers(-4, 5, 3))
    if turn == 0 or (forward == 0 and left == 0):
        turn, forward = 1.0, 1.5
    angle = math.radians(ANGLES[wheel])
    rim = -math.sin(angle) * forward + math.cos(angle) * left
    speed = rim + 0.7 * turn
    answer = speed / 0.2
    return Question(
        f"A wheel with a radius of 0.2 m is 0.7 m from the middle of its base, in the direction $\\alpha = "
        f"{ANGLES[wheel]}°$. The base drives forward at ${forward:g}$ m/s and to the left at ${left:g}$ m/s, and turns "
        f"at ${turn:g}$ rad/s. How fast does the wheel turn, in rad/s?",
        Number(
            answer,
            tolerance=0.051,
            unit="rad/s",
            wrong={
                "This is the speed of the rim, in m/s. Divide it by the radius of the wheel.": speed,
                "The turn of the base is missing.": rim / 0.2,
                "The turn of the base has the wrong sign.": (rim - 0.7 * turn) / 0.2,
            },
        ),
        f"The rim moves at $-\\sin {ANGLES[wheel]}° \\cdot {forward:g}$ $+ \\cos {ANGLES[wheel]}° \\cdot {left:g}$ "
        f"$+ 0.7 \\cdot {turn:g} = {speed:.4g}$ m/s, and the wheel turns at ${speed:.4g} / 0.2 = {answer:.3g}$ rad/s.",
    )


@drill("body", "Where does it believe it is?")
def error_of_odometry(rng: Rng) -> Question:
    """Compute how wrong odometry is when wheels slip."""
    speed, seconds = float(rng.integers(2, 9)) / 2, int(rng.integers(2, 13))
    share = 5 * int(rng.integers(1, 10))
    answer = speed * seconds * share / 100
    return Question(
        f"The wheels of a robot turn as for ${speed:g}$ m/s straight on, for ${seconds}$ s. Of each turn, {share} % "
        "slips. How far is the robot from where its odometry says it is, in metres?",
        Number(
            answer,
            unit="m",
            wrong={
                "This is how far the robot has driven. What is the difference to what the wheels say?": (
                    speed * seconds - answer
                ),
                "This is how far the robot believes it has driven.": speed * seconds,
                "This is the error of one second. It adds up.": answer / seconds,
            },
        ),
        f"The wheels say ${speed:g} \\cdot {seconds} = {speed * seconds:g}$ m. Of this, {share} % was not driven: "
        f"${answer:.4g}$ m.",
    )


@drill("body", "What pushes the base?")
def push_of_a_wheel(rng: Rng) -> Question:
    """Say whether the motor or the floor limits the push of a wheel, and how much it is."""
    torque, load = int(rng.integers(4, 31)), 10 * int(rng.integers(8, 21))
    friction = float(rng.integers(2, 10)) / 10
    motor, floor = torque / 0.2, friction * load
    answer = min(motor, floor)
    limit = "the wheel slips" if floor < motor else "the wheel does not slip"
    return Question(
        f"A motor gives ${torque}$ N m to a wheel with a radius of 0.2 m. The wheel carries ${load}$ N, and the "
        f"friction between it and the floor is ${friction:g}$. How hard does the wheel push the base, in newtons?",
        Number(
            answer,
            tolerance=0.51,
            unit="N",
            wrong={
                "The motor and the floor both limit the push. The smaller of the two limits counts.": max(
                    motor, floor
                ),
                "A torque divided by the radius is a force; this is their product.": 0.2
                * torque,
                "The two limits do not add up. The smaller one counts.": motor + floor,
            },
        ),
        f"The motor could push with ${torque} / 0.2 = {motor:g}$ N, and the floor holds up to ${friction:g} \\cdot "
        f"{load} = {floor:g}$ N. The smaller one counts, so {limit}.",
    )


@drill("body", "How long does it take to go back?")
def seconds_to_turn_around(rng: Rng) -> Question:
    """Compute how long a robot takes to go backward, and how far it goes on."""
    speed = float(rng.integers(5, 46)) / 10
    friction = float(rng.integers(1, 10)) / 10
    deceleration = 9.81 * friction
    answer = 2 * speed / deceleration
    return Question(
        f"A robot drives forward at ${speed:g}$ m/s and is to drive backward as fast. It has four ordinary wheels "
        f"whose friction is ${friction:g}$, and strong motors at each. So it can brake with ${friction:g} \\cdot "
        "9.81$ m/s². How many seconds does it take until it drives backward at this speed?",
        Number(
            answer,
            tolerance=0.011,
            unit="s",
            wrong={
                "After this time it stands still. It still has to speed up, backward.": answer
                / 2,
                "Divide the change of speed by the acceleration, friction times 9.81.": 2
                * speed
                / 9.81,
                "This is how far it goes on, in metres, until it stands still.": (
                    speed**2 / (2 * deceleration)
                ),
            },
        ),
        f"The speed changes by ${2 * speed:g}$ m/s, at ${deceleration:.3g}$ m/s²: ${2 * speed:g} / "
        f"{deceleration:.3g} = {answer:.3g}$ s.",
    )


@drill("body", "What does randomisation bring back?")
def brought_back(rng: Rng) -> Question:
    """Compute which share of the loss a training with randomisation brings back."""
    simulator = int(rng.integers(90, 100))
    plain = int(rng.integers(50, simulator - 12))
    randomised = int(rng.integers(plain + 4, simulator - 3))
    answer = 100 * (randomised - plain) / (simulator - plain)
    return Question(
        f"A policy arrives in {simulator} % of the worlds in the simulator, and in {plain} % with a body. Trained in "
        f"randomised simulators, the same learner arrives in {randomised} % with the body. Which share of the loss "
        "does the randomisation bring back, in per cent?",
        Number(
            answer,
            tolerance=0.06,
            unit="%",
            wrong={
                "These are points of arrivals. The loss is the whole.": randomised
                - plain,
                "This is the share of the loss that remains.": 100 - answer,
                "The whole is what was lost, and not all failures with the body.": (
                    100 * (randomised - plain) / (100 - plain)
                ),
            },
        ),
        f"The body costs ${simulator} - {plain} = {simulator - plain}$ points, and ${randomised} - {plain} = "
        f"{randomised - plain}$ of them come back: {answer:.4g} %.",
    )
