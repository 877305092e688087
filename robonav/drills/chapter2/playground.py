"""Drills of the playground: speed, motion and memory."""

from __future__ import annotations

import math

import numpy as np

from robonav import mdp, robot

from ..pictures import grid_picture
from ..question import Number, Place, Question
from ..registry import drill

Rng = np.random.Generator
RANGE = 10.0  # metres that a sensor sees
ARRIVAL = 3.0  # metres from the target at which an episode ends


def _readings(gap: float, speed: float) -> list[float]:
    """What the sensor ahead reads each second on the way to a post, until less than a step is left."""
    world = robot.make_world(circles=[(20 + gap, 50, 1)], start=(19, 50))
    simulator = robot.Simulator(world, speed)
    simulator.poses = np.array([[19.0, 50.0, 0.0]])
    readings = [float(simulator.sense().ranges[0, 0])]
    while readings[-1] > speed + 1:
        simulator.step(np.array([int(robot.Action.F)]))
        readings.append(float(simulator.sense().ranges[0, 0]))
    return readings


@drill("playground", "Too fast for its sensors")
def noticed_late(rng: Rng) -> Question:
    """Compute how near an obstacle is when the robot first reacts to it."""
    speed = float(rng.choice([1.5, 2.0, 2.5, 3.0]))
    limit = float(rng.choice([6.0, 8.0]))
    gap = round(float(rng.uniform(12, 20)), 1)
    readings = _readings(gap, speed)
    at = next(k for k, reading in enumerate(readings) if reading < limit)
    answer = readings[at]
    return Question(
        f"A robot senses once a second and goes ${speed:g}$ m/s. It turns as soon as something ahead is nearer than "
        f"${limit:g}$ m. It goes straight towards an obstacle that is ${gap:g}$ m away now. How near is the obstacle "
        "when the robot turns?",
        Number(
            answer,
            unit="m",
            wrong={
                "It senses once a second, and so it notices the obstacle only at the next reading.": limit,
                f"At this reading the obstacle is not yet nearer than {limit:g} m.": answer
                + speed,
                "It has noticed the obstacle one second earlier.": answer - speed,
            },
        ),
        f"After {at} seconds the obstacle is ${gap:g} - {at} \\cdot {speed:g} = {answer:.4g}$ m away. "
        f"One second earlier "
        f"it was ${answer + speed:.4g}$ m.",
    )


@drill("playground", "An obstacle that comes nearer")
def seconds_until_seen(rng: Rng) -> Question:
    """Compute when a moving obstacle comes into range."""
    while True:
        speed, approach = (
            float(rng.choice([1.0, 2.0, 3.0])),
            float(rng.choice([0.5, 1.0])),
        )
        gap, closing = round(float(rng.uniform(14, 40)), 1), speed + approach
        if 0.05 < (gap - RANGE) / closing % 1 < 0.95:  # not at the border of a second
            break
    # seen from the obstacle, the robot comes with both speeds
    answer = float(next(k for k, r in enumerate(_readings(gap, closing)) if r < RANGE))
    wrong = {
        "The obstacle moves as well, so the distance shrinks by both speeds.": float(
            math.ceil((gap - RANGE) / speed)
        ),
        "This is when they meet. A sensor sees 10 m.": float(math.ceil(gap / closing)),
    }
    return Question(
        f"A robot goes at ${speed:g}$ m/s straight towards an obstacle that is ${gap:g}$ m away and "
        f"moves towards it at "
        f"${approach:g}$ m/s. It senses once a second, as far as $10$ m. After how many seconds does a sensor see it "
        "for the first time?",
        Number(answer, tolerance=0.4, wrong=wrong, unit="s"),
        f"Each second the distance shrinks by ${closing:g}$ m. After {answer:g} seconds it is "
        f"${gap - answer * closing:.4g}$ m, and one second earlier "
        f"${gap - (answer - 1) * closing:.4g}$ m.",
    )


@drill("playground", "How long is an episode?")
def steps_of_an_episode(rng: Rng) -> Question:
    """Compute how many steps a free way to the target takes."""
    speed = float(rng.choice([1.0, 1.5, 2.0, 3.0]))
    distance = float(rng.integers(20, 80))
    world = robot.make_world(start=(10, 50), target=(10 + distance, 50))
    answer = int(robot.navigate(robot.straight, world, speed).steps[0])
    whole = math.ceil(distance / speed)
    wrong = {
        f"The episode ends as soon as the robot is within {ARRIVAL:g} m of its target.": float(
            whole
        )
    }
    if (distance - ARRIVAL) % speed:
        wrong["After so many steps the robot is still too far away."] = float(
            answer - 1
        )
    return Question(
        f"Nothing stands between a robot and its target, which lies straight ahead, ${distance:g}$ m away. An episode "
        f"ends when the target is at most ${ARRIVAL:g}$ m away. How many steps of one second does it take at "
        f"${speed:g}$ m/s?",
        Number(float(answer), tolerance=0.4, wrong=wrong, unit="steps"),
        f"The robot has to go ${distance:g} - {ARRIVAL:g} = {distance - ARRIVAL:g}$ m, and "
        f"${distance - ARRIVAL:g} / {speed:g} = {(distance - ARRIVAL) / speed:.4g}$. With whole steps these are "
        f"${answer}$.",
    )


WAYS = {"right": (0, 1), "up": (-1, 0), "down": (1, 0), "left": (0, -1)}
PLACES = {"right": "left", "left": "right", "down": "top", "up": "bottom"}
ALONG = {"right": "row", "left": "row", "down": "column", "up": "column"}
Cells = np.ndarray


def _turned(cells: Cells, ahead: str) -> Cells:
    """A grid whose robot goes right, as one whose robot goes ahead."""
    turned = {
        "right": cells,
        "left": cells[:, ::-1],
        "down": cells.T,
        "up": cells.T[::-1],
    }
    return turned[ahead]


@drill("playground", "A robot without a memory")
def without_memory(rng: Rng) -> Question:
    """Follow a rule that remembers nothing into a pocket, and see what it does there."""
    row, length = int(rng.integers(1, 3)), int(rng.integers(2, 4))
    cells = np.full((4, 5), ".")
    cells[row - 1 : row + 2, length + 1] = "#"
    cells[[row - 1, row - 1, row + 1, row + 1], [length, length - 1] * 2] = "#"
    cells[row, 0] = "S"
    ahead = str(rng.choice([*WAYS]))
    cells = _turned(cells, ahead)
    back = {"right": "left", "left": "right", "up": "down", "down": "up"}[ahead]
    aside = rng.permutation([way for way in WAYS if way not in (ahead, back)])
    order = [ahead, *map(str, aside), back]
    grid = mdp.GridWorld("\n".join("".join(symbols) for symbols in cells))
    start = tuple(int(k) for k in np.argwhere(cells == "S")[0])
    steps = int(rng.integers(length + 1, length + 7))
    numbers = [list(map(tuple, mdp.gridworld.STEPS)).index(WAYS[way]) for way in order]
    at = int(grid.numbers[start])
    visited = [at]
    for _ in range(steps):
        moves = grid.moves[at]
        at = next(int(moves[a]) for a in numbers if moves[a] != at)
        visited.append(at)
    places = [(int(i), int(j)) for i, j in grid.cells]
    name = list("ABCDEFGHIJKLMNOPQRST"[: len(places)])
    letters = dict(zip(places, name, strict=True))
    wrong = {}
    if visited[-2] != at:
        wrong[name[visited[-2]]] = "This is where it is one step earlier. Count again."
    inner = [name[k] for k in visited if k not in (at, visited[-2])]
    wrong |= dict.fromkeys(inner, "It is there earlier, but not after so many steps.")
    shown: list[list[str | None]] = [
        [None if symbol == "#" else "" for symbol in symbols] for symbols in cells
    ]
    shown[start[0]][start[1]] = "robot"
    last = ", ".join(name[state] for state in visited)
    line = start[0] if ALONG[ahead] == "row" else start[1]
    return Question(
        f"A robot goes to the first free cell in the order {', '.join(order)}, and remembers nothing. Walls and "
        f"the border are not free. In which cell is it after {steps} steps?",
        Place([*name], [name[at]], wrong),
        f"It visits {last}. In the same place it senses the same and does the same again, so it goes to and fro and "
        "never leaves the pocket.",
        grid_picture(
            shown,
            names=letters,
            title=f"A grid of {len(cells)} rows and {len(cells[0])} columns. The robot stands in {ALONG[ahead]} "
            f"{line + 1} at the {PLACES[ahead]}. A pocket of walls opens towards it.",
        ),
    )
