"""The numbers of the explorables of chapter 6."""

from __future__ import annotations

from typing import Any

from robonav.robot import make_world

from ..simulator import page_world
from .registry import asks

PLANNERS = ("simulator", "maps", "planners")


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
        "those of all steps, all alike",
        "those of all steps, the last one's most",
    ],
    right="only that of the last step",
    because="With λ = 0 an advantage is a single error of the value function, and only the last "
    "error contains the reward.",
)
def advantages_of_an_episode() -> dict[str, Any]:
    """The values of six states, and that of the state in which the robot is when the time is over."""
    return {"values": [0.5, 0.6, 0.4, 0.5, 0.8, 0.7], "after": 0.6}
