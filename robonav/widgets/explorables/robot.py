"""The numbers of the explorables on the robot and its playground."""

from __future__ import annotations

from typing import Any

from robonav.robot import make_world, random_worlds

from ..simulator import page_world
from .registry import asks

SIMULATOR = ("simulator", "maps")


@asks(
    "Nine sensors that turn with the robot",
    "The robot turns by 40° to the left, on the spot. "
    "What happens to its nine readings?",
    guesses=[
        "they stay, as the robot has not moved",
        "only the readings ahead change",
        "each moves to a neighbouring sensor",
        "all nine become new numbers",
    ],
    right="each moves to a neighbouring sensor",
    because="A turn by 40° is a turn by exactly one sector, so each sensor now reads what its left "
    "neighbour read before.",
    files=SIMULATOR,
)
def sensor_sectors() -> dict[str, Any]:
    """A small world and the robot's first place in it."""
    world = make_world(
        circles=[(26, 24, 2.5), (12, 30, 2)],
        rectangles=[(28, 12, 6, 3, 30)],
        start=(5, 5),
        target=(35, 35),
        size=40.0,
    )
    return {"world": page_world(world), "pose": [17.0, 18.0]}


@asks(
    "Policy or reflex: who decides?",
    "Guess for 10 obstacles and a sensor range of 10 m, then set the map to 10 obstacles: "
    "in what share of the free places does the policy decide, and not a reflex?",
    guesses=["20 %", "40 %", "67 %", "90 %"],
    right="67 %",
    because="Each obstacle is sensed from 10 m away, and so is the border of the map, so most places "
    "are not safe.",
    files=SIMULATOR,
)
def reflex_map(seed: int = 41) -> dict[str, Any]:
    """Worlds with 5, 10, 20 and 30 obstacles."""
    worlds = [
        {"name": str(number), **page_world(random_worlds(1, number, seed=seed))}
        for number in (5, 10, 20, 30)
    ]
    return {"worlds": worlds, "maps": "obstacles", "map": 2, "speed": 2}


@asks(
    "Too fast for its sensors",
    "The robot senses once a second, and it turns by 60° when something ahead is nearer than 6 m. "
    "Up to which speed does it always get past the obstacle?",
    guesses=["2 m/s", "4 m/s", "6 m/s", "8 m/s"],
    right="4 m/s",
    because="At 4.5 m/s it may notice the obstacle only 1.5 m ahead, and after its turn it then passes "
    "nearer than 1 m, which is a collision.",
    files=SIMULATOR,
)
def speed_and_sight() -> dict[str, Any]:
    """One circle between start and target."""
    world = make_world(circles=[(50, 50, 4)], start=(10, 50), target=(90, 50))
    return {"world": page_world(world), "speed": 2, "turnAt": 6}


@asks(
    "A pocket in the way",
    "A pocket of 12 m width opens towards the robot, which turns to the side with more room "
    "and remembers nothing. "
    "From which depth on does it no longer get out?",
    guesses=["4 m", "8 m", "16 m", "it always gets out"],
    right="8 m",
    because="From this depth on, first one side and then the other has more room, and the robot goes "
    "to and fro.",
    files=SIMULATOR,
)
def pocket() -> dict[str, Any]:
    """An empty world; the page builds the pocket."""
    return {"world": page_world(make_world(start=(20, 50), target=(90, 50)))}
