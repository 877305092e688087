"""Drills of the page on policies that remember."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import torch
from scipy.sparse.csgraph import shortest_path

from robonav import mdp
from robonav.benchmark import success_interval
from robonav.mdp.gridworld import ARROWS
from robonav.memory import GRU, WindowNetwork
from robonav.robot import crossing_worlds
from robonav.robot.pockets import open_on_the_left

from ..pictures import grid_picture
from ..question import Choice, Number, Place, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator
PAGE = "memory"
ROWS, COLUMNS = 3, 4
LETTERS = "ABCDEFHIJKLM"  # G is the goal


def _best_actions(grid: mdp.GridWorld) -> list[set[int]] | None:
    """The best actions of each cell but the goal, or None if no way leads from some cell to the goal."""
    links = np.zeros((grid.n_states, grid.n_states))
    links[grid.moves, np.arange(grid.n_states)[:, None]] = (
        1  # from the cell reached to the cell
    )
    (goal,) = np.flatnonzero(grid.terminal)
    far = shortest_path(links, indices=goal, unweighted=True)
    if not np.isfinite(far).all():
        return None
    nearer = far[grid.moves] < far[:, None]
    return [set(np.flatnonzero(row)) for row in nearer[~grid.terminal]]


def _groups(keys: list[tuple[bool, ...]]) -> list[list[int]]:
    """The indices of equal keys, group by group."""
    found: dict[tuple[bool, ...], list[int]] = defaultdict(list)
    for k, key in enumerate(keys):
        found[key].append(k)
    return list(found.values())


@drill(PAGE, "Where must a policy without a memory err?")
def where_a_policy_must_err(rng: Rng) -> Question | None:
    """Find two places with the same senses and different best actions."""
    symbols = np.full(ROWS * COLUMNS, ".")
    walls, goal = int(rng.integers(2, 5)), int(rng.integers(ROWS * COLUMNS))
    symbols[rng.choice(ROWS * COLUMNS, size=walls, replace=False)] = "#"
    symbols[goal] = "G"
    rows = symbols.reshape(ROWS, COLUMNS)
    grid = mdp.GridWorld("\n".join("".join(row) for row in rows))
    best = _best_actions(grid)
    if best is None:
        return None
    states = np.flatnonzero(~grid.terminal)
    names = [LETTERS[k] for k in range(len(states))]
    arrows, right, wrong = [""] * len(names), [], {}
    for group in _groups([tuple(grid.moves[s] != s) for s in states]):
        common = set.intersection(*(best[k] for k in group))
        for k in group:
            arrows[k] = ARROWS[min(common or best[k])]
            others = ", ".join(names[other] for other in group if other != k)
            if not common:
                right.append(names[k])
            elif others:
                wrong[names[k]] = (
                    f"The robot senses the same in {others}, and the same action is right there."
                )
            else:
                wrong[names[k]] = "In no other cell does the robot sense the same."
    if len(right) not in (2, 3):  # all of one group
        return None
    places = [(int(i), int(j)) for i, j in grid.cells[states]]
    shown: list[list[str | None]] = [
        [None if symbol == "#" else "goal" for symbol in row] for row in rows
    ]
    for (i, j), arrow in zip(places, arrows, strict=True):
        shown[i][j] = arrow
    told = ", ".join(f"{name} {arrows[names.index(name)]}" for name in right)
    return Question(
        "A robot senses which of the four cells beside its own are free; walls, which are grey, and the border are "
        "not. Each arrow begins a shortest way to the goal. A policy without a memory cannot be right in all cells. "
        "Click on a cell in which it may be wrong.",
        Place(names, right, wrong),
        f"What the robot senses is the same in {' and '.join(right)}; no action is the best in all of them: {told}. "
        "A function of the senses gives the same action there, so it is wrong in at least one.",
        grid_picture(
            shown,
            names=dict(zip(places, names, strict=True)),
            title=f"A grid of {ROWS} by {COLUMNS} cells with walls, a goal and an arrow in each other cell.",
        ),
    )


@drill(PAGE, "How often right without a memory?")
def right_without_a_memory(rng: Rng) -> Question:
    """Compute how often a policy without a memory takes the open branch."""
    worlds = int(rng.choice([20, 25, 40, 50, 80]))
    seed = int(rng.integers(1000))
    left = int(open_on_the_left(crossing_worlds(worlds, seed=seed)).sum())
    turns = float(rng.choice([0.1, 0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9]))
    share = left / worlds
    mean = share * turns + (1 - share) * (1 - turns)
    best = max(share, 1 - share)
    return Question(
        f"In {left} of {worlds} worlds the left branch of a crossing is open, in the others the right one. What the "
        f"robot senses at the crossing is the same in all. A policy without a memory turns left with the probability "
        f"{turns:g}, and otherwise right. In which share of the worlds does it take the open branch on average, and "
        "in which share does the best policy without a memory take it?",
        Table(
            rows=("share",),
            columns=("this policy", "the best one"),
            answer=[[mean, best]],
            wrong={
                "Where the right branch is open, a turn to the right is right, too.": [
                    [share * turns, best]
                ],
                "The best one has no memory either: its action is the same in all worlds.": [
                    [mean, 1.0]
                ],
                "A fixed turn may be right in more than half of the worlds.": [
                    [mean, 0.5]
                ],
            },
        ),
        f"It turns left where left is open with ${share:g} \\cdot {turns:g}$, and right where right is open with "
        f"${1 - share:g} \\cdot {1 - turns:g}$: together ${mean:.4g}$. The best one always turns to the side that is "
        f"open more often: ${best:g}$.",
    )


def _place_in_the_window(steps: int) -> int:
    """At which place of a window, counted from 1, a state stands that was sensed some steps ago."""
    network = WindowNetwork(1, k=steps + 9, hidden=1, seed=0)
    memory, x = network.begin(1), torch.zeros(1, network.inputs, dtype=torch.float64)
    sensed = x.clone()
    sensed[0, 0] = 1
    for step in range(steps + 1):
        _, memory = network.step(memory, x if step else sensed)
    return int(memory[0, :, 0].argmax()) + 1


@drill(PAGE, "The shortest window that reaches back")
def window_that_reaches_back(rng: Rng) -> Question:
    """Compute how long a window must be to hold a sign that was passed."""
    speed, steps = float(rng.choice([1, 1.5, 2, 2.5, 3])), int(rng.integers(3, 31))
    distance = speed * steps
    answer = _place_in_the_window(steps)
    wrong = {
        "The window has to hold the step beside the sign as well as the one at the crossing.": float(
            steps
        ),
        "Each step leads the robot through the distance that it goes in a second.": (
            distance + 1
        ),
    }
    if speed == 1:
        wrong = {hint: n for hint, n in wrong.items() if n != answer}
    return Question(
        f"A robot passes a sign, and ${distance:g}$ m later it comes to a crossing, where it has to know the sign. It "
        f"goes ${speed:g}$ m/s and senses once a second. It sensed the sign for the last time right beside it. Its "
        "network reads the states of the last $k$ steps, the present one included. Which is the smallest $k$ with "
        "which it still reads the sign at the crossing?",
        Number(float(answer), tolerance=0.4, wrong=wrong),
        f"The way takes ${distance:g} / {speed:g} = {steps}$ steps. The state beside the sign is {steps} steps old and "
        f"the present one 0, so the window holds $k = {steps} + 1 = {answer}$ states.",
    )


@drill(PAGE, "How many numbers does a window hold?")
def numbers_in_a_window(rng: Rng) -> Question:
    """Count the inputs of a network that reads the last k steps."""
    encoded, k = int(rng.integers(9, 37)), int(rng.integers(2, 25))
    answer = WindowNetwork(encoded, k=k, hidden=1, seed=0).seen
    return Question(
        f"A network reads the last {k} states, encoded as {encoded} numbers each, and the actions between them. An "
        "action is a 1 among four zeros. How many inputs has the network?",
        Number(
            float(answer),
            tolerance=0.4,
            wrong={
                f"Between {k} states there are only {k - 1} actions.": float(
                    k * (encoded + 5)
                ),
                "The actions between the states are inputs, too.": float(k * encoded),
                "An action is five numbers, a 1 and four zeros.": float(
                    k * encoded + k - 1
                ),
            },
        ),
        f"${k} \\cdot {encoded}$ numbers of the states and ${k - 1} \\cdot 5$ of the actions: ${answer}$.",
    )


def _unit(**weights: float) -> GRU:
    """A single gated recurrent unit with one input; weights that are not named are 0."""
    unit, order = GRU(1, 1, seed=0), ("r", "z", "")
    with torch.no_grad():
        for part, parameter in (("W", unit.W), ("U", unit.U), ("b", unit.b)):
            for k, gate in enumerate(order):
                parameter[k] = weights.get(f"{part}{gate}", 0.0)
    return unit


def _after(unit: GRU, x: float, h: float) -> float:
    """The state of a unit after one input."""
    with torch.no_grad():
        step = unit.step(torch.tensor([[x]]).double(), torch.tensor([[h]]).double())
    return step.item()


def _sigmoid(number: float) -> float:
    return float(1 / (1 + np.exp(-number)))


@drill(PAGE, "One step of a gated recurrent unit")
def one_step_of_a_unit(rng: Rng) -> Question:
    """Compute the next state of a gated recurrent unit."""
    x, h = float(rng.choice([-1, 1, 2])), float(rng.choice([-0.8, -0.5, 0.4, 0.5, 0.9]))
    wz, uz = float(rng.choice([-1, -0.5, 0.5, 1])), float(rng.choice([-1, 1, 2]))
    w, u = float(rng.choice([-1, -0.5, 0.5, 1])), float(rng.choice([-1, 1, 2]))
    answer = _after(_unit(Wz=wz, Uz=uz, W=w, U=u, br=50.0), x, h)  # r is 1
    z, candidate = _sigmoid(wz * x + uz * h), float(np.tanh(w * x + u * h))
    return Question(
        f"A gated recurrent unit has the state $h = {h:g}$ and reads $x = {x:g}$. Its weights are $W_z = {wz:g}$, "
        f"$U_z = {uz:g}$, $W = {w:g}$ and $U = {u:g}$, its biases are 0, and its reset gate is 1. What is its next "
        "state $h'$, if $z$ is the share of the old state that stays? Give three decimals.",
        Number(
            answer,
            tolerance=0.00051,
            wrong={
                "The gate keeps $z$ of the old state, and takes $1 - z$ of the candidate.": (
                    (1 - z) * h + z * candidate
                ),
                "This is the candidate. The update gate mixes it with the old state.": candidate,
                "This is the update gate. It says how much of the old state stays.": z,
                "The candidate is a hyperbolic tangent, not a sigmoid.": (
                    z * h + (1 - z) * _sigmoid(w * x + u * h)
                ),
            },
        ),
        f"$z = \\sigma({wz * x:g} {sign(uz * h)}) = {z:.4f}$ and "
        f"$\\tilde h = \\tanh({w * x:g} {sign(u * h)}) = {candidate:.4f}$. So $h' = {z:.4f} \\cdot {_factor(h)} + "
        f"{1 - z:.4f} \\cdot {_factor(round(candidate, 4))} = {answer:.4f}$.",
    )


def _factor(number: float) -> str:
    """A number as a factor in a formula."""
    return f"({number:g})" if number < 0 else f"{number:g}"


@drill(PAGE, "What is left in the unit?")
def left_in_a_unit(rng: Rng) -> Question:
    """Compute what a constant update gate leaves of a number."""
    z = float(rng.choice([0.5, 0.6, 0.7, 0.8, 0.9, 0.95]))
    stored, steps = (
        float(rng.choice([-0.9, -0.8, 0.7, 0.8, 0.9])),
        int(rng.integers(2, 9)),
    )
    unit, h = _unit(bz=float(np.log(z / (1 - z)))), stored
    for _ in range(steps):
        h = _after(unit, 0.0, h)
    return Question(
        f"A unit of a GRU has stored ${stored:g}$. In each of the next {steps} steps its update gate is $z = {z:g}$, "
        "the share of the old state that stays, and its candidate is 0. Which number is left? Give three decimals.",
        Number(
            h,
            tolerance=0.00051,
            wrong={
                "This is what is left after one step.": stored * z,
                "Here each step keeps $1 - z$. The update gate keeps $z$ of the old state.": (
                    stored * (1 - z) ** steps
                ),
                "Each step keeps a share of what the step before has left: the losses do not add up.": (
                    stored * (1 - steps * (1 - z))
                ),
            },
        ),
        f"Each step multiplies the state by $z$: ${_factor(stored)} \\cdot {z:g}^{{{steps}}} = {h:.4f}$.",
    )


NOT_STORED = "The memory does not hold the side"
NOT_USED = "The memory holds the side, but the policy does not use it"
USED = "The memory holds the side, and the policy uses it"


def _beyond_chance(right: int, worlds: int) -> bool:
    """Whether a 95 % interval lies above one half."""
    return success_interval(right, worlds)[0] > 0.5


@drill(PAGE, "Stored, or also used?")
def stored_or_used(rng: Rng) -> Question:
    """Judge by a probe and by a test what a policy remembers, and whether it uses it."""
    right = str(rng.choice([NOT_STORED, NOT_USED, USED]))
    worlds = int(rng.choice([100, 150, 200, 400]))
    high, low = (0.8, 1.0), (0.45, 0.53)
    read, taken = (
        int(worlds * float(rng.uniform(*(high if beyond else low))))
        for beyond in (right != NOT_STORED, right == USED)
    )
    found = (
        NOT_STORED
        if not _beyond_chance(read, worlds)
        else USED
        if _beyond_chance(taken, worlds)
        else NOT_USED
    )
    shares = f"The probe is right in {100 * read / worlds:.3g} %, and the robot in {100 * taken / worlds:.3g} %"
    why = {
        NOT_STORED: f"{shares}. Chance alone gives 50 %, so neither shows a memory of the side.",
        NOT_USED: f"{shares}. The side can be read from the memory, and the turns are like chance.",
        USED: f"{shares}. Both are far more than the 50 % of chance.",
    }[found]
    return Question(
        "A sign on one side of a corridor tells which of two branches is open, and each side is as frequent as the "
        f"other. In {worlds} new worlds a linear probe, fitted in other worlds, reads the side from the memory rightly "
        f"in {read}. The robot takes the open branch in {taken}. What do the two numbers show?",
        Choice(
            found,
            {option: why for option in (NOT_STORED, NOT_USED, USED) if option != found},
            order=(NOT_STORED, NOT_USED, USED),
        ),
        why,
    )
