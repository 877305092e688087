"""The numbers of the explorables of chapter 6."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from robonav.robot import make_world

from ..simulator import page_world
from .registry import asks

SIMULATOR = ("simulator", "maps")
PLANNERS = (*SIMULATOR, "planners")

EXAMPLE = [
    {
        "name": name,
        "values": {
            worlds: {"success": success, "short ways": ways, "no collision": 96}
            for worlds, success in successes.items()
        },
    }
    for name, ways, successes in (
        ("careful", 70, {"10 obstacles": 99, "20 obstacles": 95, "30 obstacles": 92}),
        ("quick", 80, {"10 obstacles": 98, "20 obstacles": 90, "30 obstacles": 81}),
    )
]
"""Two methods that do not beat each other; the page gives those of the leaderboard."""


@asks(
    "Forces that cancel",
    "The robot follows the forces alone, without inertia. "
    "You move the two circles close together in the middle of its way, so that it cannot pass between them. "
    "What happens?",
    guesses=[
        "the robot goes round both circles",
        "the robot does not arrive",
        "the robot pushes through between them",
    ],
    right="the robot does not arrive",
    because="In front of the two circles the repulsion cancels the attraction, and beside that place "
    "the forces lead back to it.",
    files=PLANNERS,
)
def potential_field_forces() -> dict[str, Any]:
    """A small world with two circles, which the reader moves."""
    world = make_world(
        circles=[(22, 29, 3.5), (30, 14, 3.5)],
        start=(4, 25),
        target=(46, 25),
        size=50.0,
    )
    return {"world": page_world(world)}


@asks(
    "Openings in the polar histogram",
    "The robot keeps a clearance of 1 m. "
    "What happens to the openings ahead of it when it has to keep 3 m?",
    guesses=[
        "they stay, as the obstacles have not moved",
        "they become wider",
        "they become narrower, or close",
        "they move to the left",
    ],
    right="they become narrower, or close",
    because="Each reading covers the angle that the clearance takes at its distance, to either side.",
    files=PLANNERS,
)
def polar_histogram_openings() -> dict[str, Any]:
    """A small world with three obstacles, and the robot's first place in it."""
    world = make_world(
        circles=[(24, 26, 2), (25, 15, 2.5)],
        rectangles=[(34, 21, 3, 6, 20)],
        start=(5, 5),
        target=(38, 20),
        size=40.0,
    )
    return {"world": page_world(world), "pose": [17.0, 20.0]}


@asks(
    "An action that became likelier by mistake",
    "An action has the advantage −1, so it was worse than expected. "
    "A few steps of gradient ascent on other states have made it likelier all the same: its ratio "
    "is 1.5, and ε is 0.2. "
    "What does the gradient of the clipped objective do now?",
    guesses=[
        "nothing, because 1.5 is outside of 0.8 to 1.2",
        "it makes the action less likely",
        "it makes the action likelier",
    ],
    right="it makes the action less likely",
    because="The objective takes the smaller of ρ A = −1.5 and the clipped −1.2, and −1.5 is the one "
    "that still depends on the ratio.",
)
def clipped_objective() -> dict[str, Any]:
    """The advantage and epsilon with which it begins."""
    return {"advantage": 1.0, "epsilon": 0.2}


@asks(
    "Which steps learn from the end?",
    "A robot earns 1 if it arrives, −1 if it collides, and nothing on the way. "
    "λ is 0. "
    "The same episode ends with a collision in place of an arrival. "
    "Which advantages change?",
    guesses=[
        "only that of the last step",
        "those of all steps, by the same amount",
        "those of all steps, the last one's most",
    ],
    right="only that of the last step",
    because="With λ = 0 an advantage is a single error of the value function, and only the last "
    "error contains the reward.",
)
def advantages_of_an_episode() -> dict[str, Any]:
    """The values of six states, and that of the state in which the robot is when the time is over."""
    return {"values": [0.5, 0.6, 0.4, 0.5, 0.8, 0.7], "after": 0.6}


@asks(
    "Stay or end?",
    "The discriminator takes every step for the expert's with the probability 0.7, so D is 0.3. "
    "One episode ends after 10 steps at the target, another one goes on for 40 steps and never arrives. "
    "Which one has the larger return under the reward −log D?",
    guesses=[
        "the one that arrives",
        "the one that goes on",
        "neither, as all steps earn the same",
    ],
    right="the one that goes on",
    because="−log D is positive for every D, so each further step adds to the return.",
)
def return_under_a_judge() -> dict[str, Any]:
    """The probability D with which it begins."""
    return {"d": 0.3}


@asks(
    "What is left of the niche?",
    "A unit stores the side of the niche as a number. "
    "Then its update gate is 0.9 in every step, and its candidate is 0. "
    "How much of the number is left after 20 steps?",
    guesses=["nine tenths", "about an eighth", "nothing"],
    right="about an eighth",
    because="Each step keeps nine tenths of what the step before has left: 0.9 to the power of 20 is 0.12.",
)
def what_a_memory_keeps() -> dict[str, Any]:
    """The update gate with which it begins."""
    return {"z": 0.9}


@asks(
    "How near do two robots come?",
    "Two robots drive at 2 m/s towards each other. "
    "The second one is 3.5 m ahead of the first, and 1 m to its left. "
    "At the end of the second it is 0.5 m behind the first. "
    "Do they collide, though their centres are 1 m apart in the sideways direction all the time?",
    guesses=[
        "no, they pass beside each other",
        "yes, because their centres come nearer than 2 m",
        "only if one of them turns",
    ],
    right="yes, because their centres come nearer than 2 m",
    because="Each robot is a disc with a radius of 1 m, and their centres come as near as 1 m.",
)
def nearest_moment() -> dict[str, Any]:
    """Where the second robot is seen from the first, and where it goes."""
    return {"x": 3.5, "y": 1.0, "heading": 180}


@asks(
    "Which rings show the gap?",
    "The robot stands in front of a gap of 2.8 m between two circles, and it needs 2 m. "
    "The edges of the circles lie 9.7° to its left and to its right. "
    "Which rings of sectors show the gap, as a sector ahead that is free?",
    guesses=[
        "all four",
        "those with 18, 36 and 72 sectors",
        "those with 36 and 72 sectors",
        "only the one with 72 sectors",
    ],
    right="those with 36 and 72 sectors",
    because="The sector ahead is free only if it is narrower than twice 9.7°, and one of 18 is 20° wide.",
    files=SIMULATOR,
)
def ring_and_picture() -> dict[str, Any]:
    """A small world with a gap between two circles, and the robot's first place in front of it."""
    world = make_world(
        circles=[(20, 23.4, 2), (20, 16.6, 2)],
        rectangles=[(9, 33, 6, 3, 30)],
        start=(5, 5),
        target=(35, 20),
        size=40.0,
    )
    return {"world": page_world(world), "pose": [12.0, 20.0]}


@asks(
    "Which method is better?",
    "A method is beaten if another one arrives more often and has shorter ways as well. "
    "With 20 obstacles, how many of the methods are not beaten?",
    guesses=["exactly one, the best method", "a few", "nearly all"],
    right="a few",
    because="A method that arrives more often mostly has longer ways, so that several trade one for the other.",
)
def two_criteria(methods: Sequence[Mapping[str, Any]] = EXAMPLE) -> dict[str, Any]:
    """The criteria of each method by the number of obstacles, in per cent."""
    return {"worlds": list(methods[0]["values"]), "methods": list(methods)}


@asks(
    "Three wheels, three directions",
    "The base drives straight ahead. One of its wheels is ahead to the left, one behind, one ahead to the right. "
    "How do they turn?",
    guesses=[
        "all three equally fast",
        "the one behind drives, and the other two roll along",
        "the two ahead drive in opposite senses, and the one behind stands still",
    ],
    right="the two ahead drive in opposite senses, and the one behind stands still",
    because="The wheel behind rolls sideways only, so its rollers turn; the two ahead push forward from both sides.",
)
def three_wheels() -> dict[str, Any]:
    """The motion with which it begins: the base stands still."""
    return {"forward": 0.0, "left": 0.0, "turn": 0.0}
