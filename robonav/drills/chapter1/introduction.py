"""Drills of the introduction."""

from __future__ import annotations

import math

import numpy as np
from gymnasium.spaces import MultiDiscrete

from robonav import robot
from robonav.mdp.discrete_spaces import space_size
from robonav.robot.encoding import DANGER_BORDERS, LFD_SENSORS, NNQL_SENSORS

from ..pictures import label, picture, place
from ..question import Choice, Number, Place, Question
from ..registry import drill
from ..runs import some_in_order
from .processes import PROCESSES

Rng = np.random.Generator

GUIDED, MOBILE, ARM = (
    "An automated guided vehicle",
    "An autonomous mobile robot",
    "An arm that needs no sensors",
)
WAYS = {
    GUIDED: (
        "It follows a wire in the floor",
        "It follows a line that was painted for it",
        "It goes from one magnet in the floor to the next",
        "It runs along a reflecting strip",
        "It runs on a rail, and turns where somebody has set a switch",
    ),
    MOBILE: (
        "It chooses its way from what a laser shows",
        "It decides at each moment where to go, by its sonar",
        "It finds its own way with two cameras",
        "It plans its way again when a door is closed",
        "Nobody has shown it a way, and it drives to any room that you name",
    ),
    ARM: (
        "It is bolted to the floor and repeats a programmed motion",
        "Each part is brought to it, and it does not move from its place",
        "It is bolted to a table, and a computer repeats its motions",
    ),
}
HABITS = {
    GUIDED: (
        "A bumper stops it at an obstacle",
        "It waits until somebody has taken the obstacle away",
        "Sensors at its front make it slow down",
        "It rings a bell until the obstacle goes away",
    ),
    MOBILE: (
        "It goes around an obstacle",
        "A bumper stops it, and then it takes another way",
        "It slows down and passes an obstacle",
        "It turns around in a blocked corridor",
    ),
    ARM: (
        "It stops if somebody opens the fence",
        "It goes on, whatever stands beside it",
        "It welds one seam after the other",
    ),
}
KINDS = {
    GUIDED: "Its way was laid out for it, and it cannot leave it.",
    MOBILE: "It senses its surroundings and decides for itself where to go.",
    ARM: "It stays where it is, and each of its motions was programmed.",
}
NOT_THIS = {
    GUIDED: "An automated guided vehicle follows a way that somebody has laid out.",
    MOBILE: "Sensors are not enough. An autonomous mobile robot decides for itself where to go.",
    ARM: "Such an arm does not move from its place.",
}


@drill("introduction", "Guided vehicle or autonomous robot?")
def guided_or_autonomous(rng: Rng) -> Question:
    """Tell an automated guided vehicle from an autonomous mobile robot."""
    kind = str(rng.choice([GUIDED, MOBILE, ARM], p=[0.45, 0.45, 0.1]))
    where = rng.choice(["factory", "hospital", "warehouse", "laboratory"])
    way, habit = rng.choice(WAYS[kind]), rng.choice(HABITS[kind])
    return Question(
        f"A machine works in a {where}. {way}. {habit}. What is it?",
        Choice(kind, {other: NOT_THIS[other] for other in KINDS if other != kind}),
        KINDS[kind],
    )


COMPETENCES = {
    "perception": (
        "What is around me?",
        "A robot tells a wall from a person in the reading of its laser",
        "A robot turns echoes into the distances of the nearest things",
        "A robot recognises in a camera's picture that the door before it is open",
        "A robot finds out whether the dark spot ahead is a hole or a shadow",
        "A robot notices that something comes nearer from behind",
        "A robot tells by the nine numbers of its sensors that its left side is free",
    ),
    "exploration": (
        "Where should I go next, knowing little?",
        "A robot goes to the part of a cellar of which it knows least",
        "A robot tries an action whose value it does not know yet",
        "A robot searches an unknown building and decides which corridor to look into first",
        "A robot leaves a room that it knows by heart, to see what lies behind the next door",
        "A robot that learns takes the action with the second best value now and then",
        "A robot in an unknown garden drives first to the place where it will learn most about it",
    ),
    "mapping": (
        "What does this place look like as a whole?",
        "A robot joins all its readings into a plan of the floor",
        "A robot marks in a grid which cells are free and which are not",
        "A robot notes where the walls of all rooms stand, for later journeys",
        "A robot draws a plan of all shelves of a warehouse while it drives through",
        "A robot enters a door that it has found into its sketch of the house",
        "A robot joins what it saw on two journeys into one plan",
    ),
    "localisation": (
        "Where am I?",
        "A robot has a plan of the building, is switched on, and finds out in which room it stands",
        "A robot compares its readings with a map, to find its own position in it",
        "A robot counts the turns of its wheels, to know how far it is from where it began",
        "A robot was carried to another floor, and finds out which one it is",
        "A robot sees two towers whose positions it knows, and computes its own",
        "A robot believes with probability 0.8 that it stands in the kitchen, and looks for the stove to be sure",
    ),
    "path planning": (
        "Which way leads to the goal?",
        "A robot with a complete map searches for the shortest way to the lift before it moves",
        "A robot runs A* on a grid",
        "A robot chooses between two corridors that both lead to its goal on the map",
        "A robot computes from a plan which stairs it can avoid on its way",
        "A robot works out in which order of rooms it comes to the exit soonest",
        "A robot's map says that a bridge is closed, and it computes another way before it starts",
    ),
    "path execution": (
        "Which motion now, given what I sense now?",
        "A box stands on the planned way, and within a second the robot turns 30 degrees to the left",
        "A robot keeps to a given path although its wheels slip",
        "A robot has to choose between turning left and going on, with a wall 3 m ahead",
        "A person steps into the robot's way, and it brakes",
        "A robot that was pushed 10 cm aside steers back to the line that it follows",
        "A robot steps back, because all its sensors ahead report less than 3 m",
    ),
}

OURS = {
    "perception": "Our robot has it: nine sensors, each for a sector of 40 degrees.",
    "exploration": "Our robot has it in chapters 4 and 5, where it tries actions.",
    "mapping": "Our robot does without it: it keeps no map.",
    "localisation": "Our robot does without it: its policy knows only in which sector the target lies.",
    "path planning": "Our robot leaves it to the expert of chapter 3, who sees the whole map.",
    "path execution": "Our robot learns it in every chapter.",
}


@drill("introduction", "Which competence is at work?")
def which_competence(rng: Rng) -> Question:
    """Name the competence of navigation that a situation needs."""
    right, *others = (str(name) for name in rng.permutation([*COMPETENCES])[:4])
    why = f'{right.capitalize()} answers the question "{COMPETENCES[right][0]}" {OURS[right]}'
    if rng.random() < 0.5:
        return Question(
            f"{rng.choice(COMPETENCES[right][1:])}. Which competence of navigation is this?",
            Choice(
                right,
                {
                    other: f'{other.capitalize()} answers another question, "{COMPETENCES[other][0]}".'
                    for other in others
                },
            ),
            why,
        )
    shown = {name: str(rng.choice(COMPETENCES[name][1:])) for name in (right, *others)}
    return Question(
        f"In which of these situations is {right} at work?",
        Choice(
            shown[right],
            {
                shown[
                    other
                ]: f'This is {other}. It answers the question "{COMPETENCES[other][0]}".'
                for other in others
            },
        ),
        why,
    )


IMITATION, TRIALS, INVERSE = (
    "Learning from demonstration",
    "Reinforcement learning",
    "Inverse reinforcement learning",
)
GIVEN = {
    IMITATION: (
        (
            "An expert can drive the robot well",
            "A person steers the robot through many rooms without an error",
            "A planner that knows all maps can act as the expert",
            "There are ten thousand recorded steps of a driver who made no mistake",
            "A skilled driver has an hour for us",
        ),
        (
            "every collision would destroy the robot, so it must not practise",
            "there is no time for trials, and the robot stays in rooms like those of the expert",
            "a policy is needed within a minute, for places like those that were shown",
            "the robot may not move before it has a policy, and it will see only rooms like those that were shown",
            "trials are forbidden, and the robot's rooms look like the expert's",
        ),
        "Imitation needs an expert and no trials of the robot's own. The copied policy holds in "
        "states like those that the expert visited.",
    ),
    TRIALS: (
        (
            "Nobody knows how to do the task",
            "No expert is at hand",
            "The robot has a shape that nobody has ever driven",
            "There is no record of anybody who did the task",
            "The robot should become better than any human driver, and nobody shows it how to drive",
        ),
        (
            "a simulator allows a million collisions, and everybody agrees on what each step is worth",
            "the robot may fail as often as it likes, and it is easy to score what it does",
            "trials cost nothing, and the reward has three lines",
            "the robot practises night after night, and a counter says how well it did",
            "a step in the simulator takes a microsecond, and the success of an episode can be written as a number",
        ),
        "Trial and error needs no expert. It needs a reward that describes the task, and many trials.",
    ),
    INVERSE: (
        (
            "An expert drives with a few errors",
            "People show how to do it, and contradict each other now and then",
            "An expert drives well, but cannot say by which rule",
            "Drives of several people are recorded, some of them clumsy",
            "A driver shows what matters to him, now and then with a slip of the hand",
        ),
        (
            "the robot may practise, nobody manages to write a reward down, and other robots must do the task later at "
            "another speed",
            "every reward that was written by hand led to circles; the robot may practise, and should become better "
            "than what it was shown",
            "the robot may practise, and its reward should state the aim so that it can train a robot of another size",
            "the robot may practise; the aim should outlive the robot, whose wheels will be replaced by legs",
            "the robot may practise, and nobody can say in numbers what the expert wants; the same aim is to be "
            "reached in a town with other streets",
        ),
        "The reward is inferred from the demonstrations. It states the aim, and other robots can be trained with it.",
    ),
}
WEAKNESS = {
    IMITATION: {
        TRIALS: "There is no expert here whom the robot could imitate.",
        INVERSE: "A copied policy holds only for this robot in such places, and it does not state the aim.",
    },
    TRIALS: {
        IMITATION: "Trial and error needs many trials, and none are possible here.",
        INVERSE: "It needs a reward that somebody has written down.",
    },
    INVERSE: {
        IMITATION: "It infers a reward and then needs many trials. None are possible here.",
        TRIALS: "It infers the reward from demonstrations, and here there are none.",
    },
}


def _situation(rng: Rng, way: str) -> str:
    """What is given, and what is wanted, where one way to learn fits best."""
    experts, circumstances, _ = GIVEN[way]
    return f"{rng.choice(experts)}; {rng.choice(circumstances)}"


@drill("introduction", "Which way to learn?")
def which_way_to_learn(rng: Rng) -> Question:
    """Choose one of the three ways to learn a policy by what is given."""
    right = str(rng.choice([*GIVEN]))
    others = [other for other in GIVEN if other != right]
    why = GIVEN[right][2]
    if rng.random() < 0.5:
        return Question(
            f"{_situation(rng, right)}. Which of the three ways fits best?",
            Choice(right, {other: WEAKNESS[other][right] for other in others}),
            why,
        )
    return Question(
        f"Where does {right[0].lower()}{right[1:]} fit best?",
        Choice(
            _situation(rng, right),
            {_situation(rng, other): WEAKNESS[right][other] for other in others},
        ),
        why,
    )


PUT_IN_ORDER = (
    "These are parts of {}. Put them in order.",
    "The parts of {} are mixed up here. Put them in order.",
    "In which order do these parts of {} follow each other?",
)


@drill("introduction", "One round, in order")
def one_round_in_order(rng: Rng) -> Question:
    """Put the steps of a way to learn in order."""
    name = str(rng.choice([*PROCESSES]))
    asked = some_in_order(rng, PROCESSES[name], int(rng.integers(4, 6)))
    return Question(
        str(rng.choice(PUT_IN_ORDER)).format(name),
        asked,
        "; ".join(f"{k + 1}. {step}" for k, step in enumerate(asked.steps)) + ".",
    )


MIDDLE, RADIUS = 140.0, 120.0


def _sectors(heading: float) -> str:
    """Nine sectors around the robot, in the map's directions; sector 1 looks ahead."""
    parts = []
    for k in range(9):
        low, high = (heading + 40 * k + half for half in (-20, 20))
        ends = [
            (
                MIDDLE + RADIUS * math.cos(math.radians(angle)),
                MIDDLE - RADIUS * math.sin(math.radians(angle)),
            )
            for angle in (low, high)
        ]
        (a, b), (c, d) = ends
        path = (
            f'<path d="M{MIDDLE:g} {MIDDLE:g}L{a:.1f} {b:.1f}A{RADIUS:g} {RADIUS:g} 0 0 0 {c:.1f} {d:.1f}Z" '
            'fill="transparent"/>'
        )
        middle = math.radians(heading + 40 * k)
        at = (
            MIDDLE + 0.75 * RADIUS * math.cos(middle),
            MIDDLE - 0.75 * RADIUS * math.sin(middle),
        )
        parts.append(place(f"sector {k + 1}", path, label(*at, str(k + 1))))
    tip = math.radians(heading)
    line = (
        f'<path d="M{MIDDLE:g} {MIDDLE:g}L{MIDDLE + 55 * math.cos(tip):.1f} {MIDDLE - 55 * math.sin(tip):.1f}" '
        'stroke-width="4"/>'
    )
    return picture(
        2 * MIDDLE,
        2 * MIDDLE,
        *parts,
        line,
        title=f"A robot with the heading {heading:g} degrees and its nine sectors, numbered "
        f"counter-clockwise from ahead. "
        "The map's x axis points to the right, its y axis upwards.",
    )


@drill("introduction", "Which sensor reports it?")
def which_sensor_reports(rng: Rng) -> Question:
    """Click on the sector in which an obstacle lies."""
    heading = int(rng.choice([0, 30, 60, 90, 120, 180, 210, 270]))
    bearing, distance = int(rng.integers(-17, 18)) * 10, int(rng.integers(4, 9))
    if (bearing - 20) % 40 in (0, 10, 30):  # a border lies too near
        bearing = 40 * (bearing // 40)
    angle = math.radians(heading + bearing)
    dx, dy = (round(distance * part(angle), 1) for part in (math.cos, math.sin))
    pose = (50, 50, math.radians(heading))
    world = robot.make_world(circles=[(50 + dx, 50 + dy, 0.1)])
    sector = int(robot.sense(world, [pose]).ranges[0].argmin()) + 1
    mirrored = 1 if sector == 1 else 11 - sector
    without = int(robot.sense(world, [(50, 50, 0)]).ranges[0].argmin()) + 1
    wrong = {}
    if without != sector:
        wrong[f"sector {without}"] = (
            "Sectors turn with the robot. Its heading is not 0° here."
        )
    if mirrored != sector:
        wrong[f"sector {mirrored}"] = (
            "Left and right are exchanged: sectors are numbered counter-clockwise."
        )
    for beside in (sector % 9 + 1, (sector - 2) % 9 + 1):
        low = (40 * (beside - 1) + 180) % 360 - 200
        wrong.setdefault(
            f"sector {beside}",
            f"Seen from ahead, this sector reaches from ${low}°$ to ${low + 40}°$.",
        )
    return Question(
        f"The robot's heading is ${heading}°$. A post stands ${dx:g}$ m from it along the x axis "
        f"and ${dy:g}$ m along the y axis. Click on the sector whose sensor reports it.",
        Place([f"sector {k}" for k in range(1, 10)], [f"sector {sector}"], wrong),
        f"The post lies in the direction of about ${(heading + bearing) % 360}°$ on the map, and that is "
        f"about ${bearing}°$ from ahead. "
        f"Sector 1 reaches from $-20°$ to $20°$, and the others follow counter-clockwise: sector {sector}.",
        _sectors(heading),
    )


@drill("introduction", "How many situations would a program have to list?")
def situations_to_list(rng: Rng) -> Question:
    """Count the situations that a programmer would have to foresee."""
    sensors = int(rng.choice([3, 4, 6, 8, len(NNQL_SENSORS), len(LFD_SENSORS)]))
    degrees = int(rng.choice([2, 3, 4, 5, len(DANGER_BORDERS) + 1]))
    sectors = int(rng.choice([4, 6, 9, 12]))
    answer = space_size("situations", MultiDiscrete([*[degrees] * sensors, sectors]))
    listed = sensors * degrees * sectors
    return Question(
        f"A robot has {sensors} sensors, and each reports one of {degrees} degrees of danger. The "
        f"target lies in one of "
        f"{sectors} sectors. A program lists all situations and says what to do in each. How many are there?",
        Number(
            float(answer),
            tolerance=0.5,
            wrong={
                "Every combination of readings is a situation of its own: multiply, do not add.": float(
                    listed
                ),
                "The target's sector is missing.": float(answer // sectors),
                "Base and exponent are exchanged: each sensor multiplies the number by its degrees.": float(
                    sensors**degrees * sectors
                ),
            },
        ),
        f"${degrees}^{{{sensors}}} \\cdot {sectors} = {answer}$. A learned policy generalises from a "
        f"small part of them.",
    )
