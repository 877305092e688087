"""Drills of the page on networks for Q-values."""

from __future__ import annotations

import numpy as np
from gymnasium.spaces import MultiDiscrete

from robonav import nnql
from robonav.mdp.discrete_spaces import space_size

from ..question import Number, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator
ACTIONS = ("F", "L30", "L60", "R30", "R60")


def _values(rng: Rng, count: int) -> np.ndarray:
    """Q-values of a state, all different."""
    return rng.choice(np.arange(1, 20), size=count, replace=False) * 0.05


@drill("networks-for-q", "The target of one update")
def one_target(rng: Rng) -> Question:
    """Compute the updated Q-value of the action taken."""
    q, next_q = _values(rng, 3), _values(rng, 3)
    taken, reward = int(rng.integers(3)), float(rng.choice([-0.5, 0.1, 0.5]))
    rate, discount = float(rng.choice([0.5, 0.8])), float(rng.choice([0.6, 0.9]))
    new = float(nnql.q_targets(q, taken, reward, next_q.max(), rate, discount)[taken])
    target = reward + discount * next_q.max()
    old = q[taken]
    shown, following = (
        ", ".join(f"{value:.2g}" for value in values) for values in (q, next_q)
    )
    return Question(
        f"In $s$ the network gives ${shown}$ for the actions F, L30 and L60, and in $s'$ "
        f"${following}$. The robot took "
        f"{ACTIONS[taken]} and got the reward ${reward:g}$. Which value does the update of Q-learning, Eq. (4.9), give "
        f"this action, with "
        f"$\\alpha = {rate:g}$ and $\\gamma = {discount:g}$?",
        Number(
            new,
            wrong={
                "This is the whole target: the old value moves towards it by the part $\\alpha$ only.": target,
                "This uses the next value of the same action. Q-learning takes the largest.": old
                + rate * (reward + discount * next_q[taken] - old),
                "The discount is missing.": old + rate * (reward + next_q.max() - old),
                "The old value is missing in the TD error.": old + rate * target,
            },
        ),
        f"${old:.2g} + {rate:g} \\, ({reward:g} {sign(discount * next_q.max())} {sign(-old)}) = {new:.4g}$.",
    )


@drill("networks-for-q", "Clip or shift")
def rescaled(rng: Rng) -> Question:
    """Bring targets into the network's range in two ways."""
    q = np.round(rng.uniform(0.1, 0.9, size=3), 1)
    outside = int(rng.integers(3))
    q[outside] = float(rng.choice([-0.6, -0.25, 1.25, 1.5, 2.0]))
    clipped, shifted = nnql.clip(q), nnql.shift(q)
    shown = ", ".join(f"{value:g}" for value in q)
    return Question(
        f"After an update the Q-values of a state are ${shown}$. The network's outputs lie between 0 and 1. "
        "Rescale the values in both ways. Clipping sets a value outside to the nearer end. Shifting maps the range "
        "from the smaller of 0 and the least value to the larger of 1 and the greatest onto the range from 0 to 1.",
        Table(
            ["clip", "shift"],
            ["F", "L30", "L60"],
            [clipped.tolist(), shifted.tolist()],
            wrong={
                "The two are exchanged.": [shifted.tolist(), clipped.tolist()],
                "Shifting moves all three values, those in range too.": [
                    clipped.tolist(),
                    clipped.tolist(),
                ],
                "Clipping moves only the value outside the range.": [
                    shifted.tolist(),
                    shifted.tolist(),
                ],
            },
        ),
        f"Clipping changes only the value outside: {', '.join(f'{v:g}' for v in clipped)}. Shifting "
        f"subtracts the smaller "
        "of 0 and the least value and divides by what the range then is: "
        f"{', '.join(f'{v:.4g}' for v in shifted)}.",
    )


@drill("networks-for-q", "How many states has a table?")
def count_states(rng: Rng) -> Question:
    """Count the states of a discretised robot."""
    sensors, degrees = int(rng.integers(3, 7)), int(rng.integers(2, 8))
    regions = int(rng.choice([3, 4, 5, 6, 8, 9, 12]))
    answer = space_size("states", MultiDiscrete([*[degrees] * sensors, regions, 2]))
    return Question(
        f"A robot has ${sensors}$ sensors with ${degrees}$ degrees of danger each, knows which of "
        f"${regions}$ sectors holds "
        "its target, and whether the target is seen. How many states are there?",
        Number(
            answer,
            tolerance=0.5,
            wrong={
                "Sensors vary independently: their numbers of degrees are multiplied, not added.": sensors
                * degrees
                * regions
                * 2,
                "Whether the target is seen doubles the number.": answer / 2,
                "Base and exponent of the power are exchanged.": sensors**degrees
                * regions
                * 2,
                "The sectors of the target are a factor, too.": degrees**sensors * 2,
            },
        ),
        f"${degrees}^{sensors} \\cdot {regions} \\cdot 2 = {answer}$.",
    )


@drill("networks-for-q", "The cost of one state")
def cost_of_outputs(rng: Rng) -> Question:
    """Compute the cross-entropy of two outputs."""
    targets = rng.choice([0.0, 0.5, 1.0], size=2)
    outputs = rng.choice([0.2, 0.4, 0.5, 0.8, 0.9], size=2)
    logits = np.log(outputs / (1 - outputs))
    cost = float(nnql.cross_entropy(targets, logits))
    half = float(-(targets * np.log(outputs)).sum())
    return Question(
        f"The targets of two actions are ${targets[0]:g}$ and ${targets[1]:g}$, and the outputs ${outputs[0]:g}$ and "
        f"${outputs[1]:g}$. What is the cost $J$ of Eq. (4.11), the sum of their cross-entropies, with natural "
        "logarithms?",
        Number(
            cost,
            wrong={
                "The terms $(1 - q) \\log (1 - Q)$ are missing.": half,
                "The cost is a sum over the actions, not a mean.": cost / 2,
                "The sign is wrong: a logarithm of a number below 1 is negative.": -cost,
                "The two logarithms are exchanged: $q$ belongs to $\\log Q$, and $1 - q$ to $\\log (1 - Q)$.": float(
                    -(
                        targets * np.log(1 - outputs) + (1 - targets) * np.log(outputs)
                    ).sum()
                ),
                "This is the squared error.": float(((targets - outputs) ** 2).sum()),
                "This has the misprint of the thesis: $1 - \\log Q$ in the place of $\\log (1 - Q)$.": float(
                    -(
                        targets * np.log(outputs)
                        + (1 - targets) * (1 - np.log(outputs))
                    ).sum()
                ),
            },
        ),
        "Each action adds $-q \\log Q - (1 - q) \\log (1 - Q)$: "
        + " and ".join(
            f"{float(nnql.cross_entropy(t[None], z[None])):.4g}"
            for t, z in zip(targets, logits, strict=True)
        )
        + f", together ${cost:.4g}$.",
    )


@drill("networks-for-q", "What a table has never seen")
def never_seen(rng: Rng) -> Question:
    """Compute in which share of the steps a table has no value."""
    known = sorted(int(n) for n in rng.choice(12, size=5, replace=False))
    steps = [int(n) for n in rng.choice(12, size=8)]
    new = ~np.isin(steps, known)
    answer = float(new.mean())
    states = np.unique(steps)
    by_state = float((~np.isin(states, known)).mean())
    wrong = {
        "This is the share of the steps in which the table has a value.": 1 - answer
    }
    if abs(by_state - answer) > 0.02:
        wrong["Count steps, not different states."] = by_state
    return Question(
        f"In training a robot met the states {', '.join(map(str, known))}. In a new map it meets, "
        f"step by step, the states "
        f"{', '.join(map(str, steps))}. In which share of these steps does a table have no value?",
        Number(answer, wrong=wrong),
        f"In {int(new.sum())} of the {len(steps)} steps the state is not among those of the training: "
        f"${int(new.sum())} / {len(steps)} = {answer:.4g}$. A network gives values there as well.",
    )
