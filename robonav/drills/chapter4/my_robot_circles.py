"""Drills of the page on robots that circle."""

from __future__ import annotations

import math

import numpy as np

from robonav import mdp, nnql

from ..pictures import SHIFTS, grid_picture
from ..question import Choice, Number, Place, Question, Table
from ..registry import drill
from ..text import terms

Rng = np.random.Generator
LETTERS = "ABCDEFHIJKL"  # G is the goal
GOAL = (0, 3)


def _forever(rewards: np.ndarray, discount: float) -> float:
    """The return of going round a circle with these rewards."""
    steps = np.roll(np.eye(len(rewards)), 1, axis=1)
    circle = mdp.FiniteMDP([steps], rewards[:, None], discount)
    return float(mdp.policy_evaluation(circle, np.zeros(len(rewards), int))[0])


def _arrival(steps: int, discount: float) -> float:
    """The return of an arrival some steps ahead."""
    return float(mdp.discounted_return([0] * (steps - 1) + [1], discount)[0])


@drill("my-robot-circles", "What a round earns, forever")
def round_forever(rng: Rng) -> Question | None:
    """Compute the return of going round a circle without end."""
    rewards = rng.choice([-0.5, -0.2, 0.0, 0.4, 0.5, 0.6], size=int(rng.integers(2, 4)))
    discount = float(rng.choice([0.5, 0.6, 0.8, 0.9]))
    answer, k = _forever(rewards, discount), len(rewards)
    if rewards[0] == 0 or len(set(rewards)) == 1:
        return None
    once = float(mdp.discounted_return(rewards, discount)[0])
    factors = discount ** np.arange(k)
    return Question(
        f"A greedy robot goes round a circle of ${k}$ steps forever. They earn "
        f"${', '.join(f'{r:g}' for r in rewards)}$. What is its return with $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "This is the return of one round. The robot goes round again and again.": once,
                f"The next round begins {k} steps later, so that it is discounted by $\\gamma^{k}$.": once
                / (1 - discount),
                "Within a round later rewards are discounted, too.": float(
                    rewards.sum()
                )
                / (1 - discount**k),
            },
        ),
        f"One round earns ${terms(rewards, factors)} = {once:.4g}$. Forever that is "
        f"${once:.4g} / (1 - {discount:g}^{k}) = {answer:.4g}$.",
    )


@drill("my-robot-circles", "The circle or the target?")
def circle_against_target(rng: Rng) -> Question:
    """Compare the returns of circling and of an arrival."""
    reward = float(rng.choice([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4]))
    discount = float(rng.choice([0.5, 0.6, 0.7, 0.8, 0.9]))
    steps = int(rng.integers(2, 9))
    circle, target = _forever(np.array([reward]), discount), _arrival(steps, discount)
    better = "the circle" if circle > target else "the target"
    return Question(
        f"A robot can stay where it earns ${reward:g}$ in each step, or arrive in ${steps}$ steps, where the last one "
        f"earns 1 and the others nothing. What are the two returns with $\\gamma = {discount:g}$? Give three "
        "decimals.",
        Table(
            ["circle", "target"],
            ["return"],
            [[circle], [target]],
            tolerance=0.0011,
            wrong={
                "The reward of the last step is discounted once less than there are steps.": [
                    [circle],
                    [target * discount],
                ],
                "The robot stays forever: the rewards are a geometric series.": [
                    [reward],
                    [target],
                ],
                "The arrival is discounted, because it comes later.": [[circle], [1]],
                "The first reward of the series is not discounted.": [
                    [circle * discount],
                    [target],
                ],
            },
        ),
        f"Circle: ${reward:g} / (1 - {discount:g}) = {circle:.3g}$. Target: ${discount:g}^{steps - 1} = {target:.3g}$. "
        f"The reward makes {better} optimal.",
    )


@drill("my-robot-circles", "From which reward on a circle pays")
def reward_that_pays(rng: Rng) -> Question:
    """Compute the reward of a step above which staying is worth more than an arrival."""
    discount = float(rng.choice([0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.9]))
    steps, prize = int(rng.integers(2, 7)), float(rng.choice([1, 2, 5, 10]))
    arrival = prize * _arrival(steps, discount)
    border = arrival / _forever(np.array([1.0]), discount)
    times = "" if prize == 1 else f"{prize:g} \\cdot "
    return Question(
        f"The target is ${steps}$ steps ahead, and an arrival earns ${prize:g}$. Above which reward per step does a "
        f"robot prefer to stay where it is, forever, with $\\gamma = {discount:g}$? Give three decimals.",
        Number(
            border,
            tolerance=0.0011,
            wrong={
                "The robot gets the reward in every step, so a smaller one is enough.": arrival,
                "An arrival in the next step is not discounted, so the exponent is the number of steps minus 1.": border
                * discount,
                "The arrival is later than the next step, and therefore discounted.": prize
                * (1 - discount),
            },
        ),
        f"Staying is worth more if $r / (1 - \\gamma) > {times}\\gamma^{{{steps - 1}}}$. The border is "
        f"${1 - discount:.2g} \\cdot {times}{discount:g}^{{{steps - 1}}} = {border:.3f}$.",
    )


@drill("my-robot-circles", "How far may the target be?")
def farthest_target(rng: Rng) -> Question | None:
    """Find the largest distance at which an arrival is worth more than a circle."""
    reward = float(rng.choice([0.01, 0.02, 0.05, 0.1, 0.2]))
    discount = float(rng.choice([0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9]))
    prize = float(rng.choice([1, 2, 5, 10]))
    circle = _forever(np.array([reward]), discount)
    arrivals = prize * np.array([_arrival(n, discount) for n in range(1, 80)])
    steps = int((arrivals > circle).sum())
    gaps = abs(arrivals[steps - 1 : steps + 1] - circle)
    if steps < 2 or gaps.min() < 0.002 * circle:
        return None
    times = "" if prize == 1 else f"{prize:g} \\cdot "
    return Question(
        f"A robot that stays earns ${reward:g}$ in each step, forever, and an arrival earns ${prize:g}$. With "
        f"$\\gamma = {discount:g}$, at most how many steps ahead may the target be, so that arriving has the "
        "larger return?",
        Number(
            steps,
            tolerance=0.1,
            wrong={
                "The arrival in the next step is not discounted: the exponent is the number of steps minus 1.": steps
                - 1,
                "With one step more the circle is better already.": steps + 1,
                "The circle earns its reward in every step, not once.": int(
                    (arrivals > reward).sum()
                ),
            },
        ),
        f"The circle's return is ${reward:g} / (1 - {discount:g}) = {circle:.3g}$. An arrival in {steps} steps has "
        f"${times}{discount:g}^{{{steps - 1}}} = {arrivals[steps - 1]:.3g}$, and one in {steps + 1} "
        f"steps ${arrivals[steps]:.3g}$.",
    )


SIGNS = {  # of each cause
    "nearly equal values": "training looks good, and a temperature of 0.4 ends the circles",
    "a reward that pays near obstacles only": "many episodes never end in training, too",
    "a reward that is too rare": "most episodes end in a collision, from the first to the last",
    "a learning rate that does not fall": "one robot of several is bad, and a temperature of 0.4 does not help it",
    "a high temperature to the end of the training": "training looks bad, and the greedy policies are good",
}


@drill("my-robot-circles", "From the symptom to the cause")
def cause_of_symptom(rng: Rng) -> Question:
    """Name the likely cause of a failure from the outcomes of training and test."""
    good, medium, bad = (
        int(rng.integers(*ends)) for ends in ((94, 100), (55, 80), (20, 45))
    )
    near = good - int(rng.integers(0, 3))
    outcomes = {
        "nearly equal values": (
            f"They arrive in ${good}$ of the last 100 episodes of training. Their greedy policies arrive in "
            f"${medium}$ % of new maps, and ${100 - medium}$ % of the episodes never end. At $T = 0.4$ they arrive "
            f"in ${near}$ %."
        ),
        "a reward that pays near obstacles only": (
            f"They arrive in ${medium}$ of the last 100 episodes of training, and the other ${100 - medium}$ never "
            f"end. Their greedy policies arrive in ${bad}$ % of new maps; the other episodes never end."
        ),
        "a reward that is too rare": (
            f"They collide in ${100 - bad + 8}$ of the first and in ${100 - bad}$ of the last 100 episodes of "
            f"training. Their greedy policies collide in ${100 - bad}$ % of new maps."
        ),
        "a learning rate that does not fall": (
            f"All but one arrive in ${good}$ % of new maps. That one arrives in ${medium}$ %. At $T = 0.4$ it "
            f"arrives in ${medium + 1}$ %."
        ),
        "a high temperature to the end of the training": (
            f"They arrive in ${bad}$ of the last 100 episodes of training, and their greedy policies in ${good}$ % "
            f"of new maps. At $T = 0.4$ they arrive in ${near}$ %."
        ),
    }
    right = str(rng.choice(list(SIGNS)))
    wrong = {
        cause: f"Then {signs}." for cause, signs in SIGNS.items() if cause != right
    }
    return Question(
        f"Eight robots were trained. {outcomes[right]} What is the likely cause?",
        Choice(right, wrong),
        f"The signs of {right}: {SIGNS[right]}.",
    )


@drill("my-robot-circles", "The lead of the best action")
def lead_after_rescaling(rng: Rng) -> Question:
    """Compute by how much the best action leads after clipping and after shifting."""
    top = float(rng.choice([1.2, 1.4, 1.6, 3.0, 6.0]))
    behind = np.sort(rng.choice(np.arange(1, 8), size=3, replace=False)) / 10
    q = np.round(np.append(top, top - behind), 1)
    rng.shuffle(q)

    def lead(values: np.ndarray) -> float:
        """The best value minus the second."""
        second, best = np.sort(values)[-2:]
        return float(best - second)

    clipped, shifted, plain = lead(nnql.clip(q)), lead(nnql.shift(q)), lead(q)
    wrong = {
        "The two are exchanged.": [[shifted], [clipped]],
        "Clipping sets all values above 1 to 1.": [[plain], [shifted]],
        "Shifting divides all values by the range, the leads too.": [
            [clipped],
            [plain],
        ],
    }
    return Question(
        f"After an update the values of a state's four actions are ${', '.join(f'{v:g}' for v in q)}$. By how much "
        "is the best action ahead of the second after clipping to the range from 0 to 1, and after shifting, which "
        "here divides all values by the largest? Give three decimals.",
        Table(
            ["clip", "shift"],
            ["lead"],
            [[clipped], [shifted]],
            tolerance=0.0011,
            wrong=wrong,
        ),
        f"Before it is ${plain:.2g}$. Clipping sets what is above 1 to 1: ${clipped:.2g}$ is left. All values are "
        f"positive, so shifting only divides by the largest: ${plain:.2g} / {top:g} = {shifted:.3f}$. A small network "
        "errs by more than a small lead.",
    )


def _ring(corner: tuple[int, int], clockwise: bool) -> dict[tuple[int, int], str]:
    """Arrows round a block of two by two cells."""
    i, j = corner
    cells = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
    if clockwise:
        return dict(zip(cells, "→↓←↑", strict=True))
    return dict(zip(cells, "↓←↑→", strict=True))


@drill("my-robot-circles", "Where does the greedy robot end?")
def caught_in_a_circle(rng: Rng) -> Question | None:
    """Follow a greedy policy until it repeats itself."""
    grid = mdp.GridWorld("S . . G \n . . . . \n . . . .")
    model = grid.mdp(discount=0.9)
    cells = [tuple(cell) for cell in grid.cells[:12].tolist()]
    arrows = list(mdp.gridworld.ARROWS)
    policy = np.zeros(model.n_states, int)
    for s, (i, j) in enumerate(cells):  # no arrow leads out of the grid
        inside = [
            action
            for action, arrow in enumerate(arrows)
            if (i + SHIFTS[arrow][1], j + SHIFTS[arrow][0]) in cells
        ]
        policy[s] = rng.choice(inside)
    ring = _ring((int(rng.integers(2)), int(rng.integers(2))), bool(rng.integers(2)))
    for cell, arrow in ring.items():
        policy[cells.index(cell)] = arrows.index(arrow)
    chain, _ = model.induced_chain(policy)
    steps = np.eye(model.n_states) @ chain  # from cell to cell
    powers = [np.linalg.matrix_power(steps, k) for k in range(60)]
    passed, later = np.sum(powers[:40], axis=0), np.sum(powers[40:], axis=0)
    into = [
        s
        for s, cell in enumerate(cells)
        if cell not in ring and cell != GOAL and later[s, cells.index(min(ring))] > 0
    ]
    if not into:
        return None
    start = int(rng.choice(into))
    names = dict(zip((c for c in cells if c != GOAL), LETTERS, strict=False))
    right = [names[cell] for s, cell in enumerate(cells) if later[start, s] > 0]
    once = [
        names[cell]
        for s, cell in enumerate(cells)
        if passed[start, s] > 0 and later[start, s] == 0
    ]
    shown: list[list[str | None]] = [[None] * 4 for _ in range(3)]
    for s, (i, j) in enumerate(cells):
        shown[i][j] = "goal" if (i, j) == GOAL else arrows[policy[s]]
    return Question(
        f"The arrows are a greedy policy that learned badly. The robot starts in {names[cells[start]]}. Click on a "
        "cell that it visits again and again.",
        Place(
            list(names.values()),
            right,
            dict.fromkeys(once, "The robot passes here, but does not come back."),
        ),
        f"From {names[cells[start]]} the arrows lead into the circle of {', '.join(right)}. A greedy policy without "
        "memory takes the same action in the same cell each time, so it never leaves it.",
        grid_picture(
            shown,
            names=names,
            title="Arrows in a grid of three by four cells, with the goal in the upper right corner.",
        ),
    )


@drill("my-robot-circles", "How many rounds until it leaves?")
def rounds_until_it_leaves(rng: Rng) -> Question:
    """Compute the mean number of rounds until a softmax policy leaves a circle."""
    gap = float(rng.choice([0.1, 0.2, 0.4, 0.6, 0.8]))
    temperature = float(rng.choice([0.2, 0.4, 0.5]))
    circle = round(float(rng.uniform(1, 2.5)), 1)
    out = round(circle - gap, 1)
    leaves = float(nnql.softmax_policy([circle, out], temperature)[1])
    odds = math.exp(gap / temperature)
    return Question(
        f"In one state of a circle two actions matter. Their logits are ${circle:g}$ for the one that goes on round "
        f"and ${out:g}$ for the one that leads out. The robot draws from the softmax of the logits at $T = "
        f"{temperature:g}$. In which round does it leave, on average? (An event with the probability $p$ in each "
        "round happens for the first time in round $1 / p$ on average.) Give one decimal.",
        Number(
            1 / leaves,
            tolerance=0.06,
            wrong={
                "This is $1 / p$ for the action that goes on.": 1 / (1 - leaves),
                "This is the ratio of the two probabilities. $1 / p$ is larger by 1.": odds,
                "The logits are divided by the temperature.": 1
                + math.exp(gap * temperature),
                "This is the probability of leaving in a round.": leaves,
            },
        ),
        f"$p = 1 / (1 + e^{{({circle:g} - {out:g}) / {temperature:g}}}) = {leaves:.3g}$, and "
        f"$1 / p = {1 / leaves:.3g}$. A greedy robot never leaves.",
    )
