"""Drills of the page that compares NNQL with other methods."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..question import Number, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator


@drill("nnql-comparison", "Targets of DQN and of double DQN")
def two_targets(rng: Rng) -> Question:
    """Compute the targets of plain and of double DQN."""
    import torch

    from robonav.nnql import double_dqn_targets, dqn_targets
    from robonav.nnql.dqn import Batch

    own, other = (
        rng.choice(np.arange(1, 20), size=3, replace=False) * 0.05 for _ in range(2)
    )
    reward, discount = (
        float(rng.choice([-0.5, 0.1, 0.5])),
        float(rng.choice([0.6, 0.9])),
    )
    batch = Batch(
        states=torch.zeros(1, 1),
        actions=torch.zeros(1, dtype=torch.int64),
        rewards=torch.tensor([reward], dtype=torch.float64),
        next_states=torch.zeros(1, 1),
        terminal=torch.tensor([False]),
    )

    def always(values: Any) -> Any:
        """A network that gives these values in every state."""
        return lambda states: torch.from_numpy(values)[None]

    networks = always(own), always(other)
    plain = float(dqn_targets(*networks, batch, discount)[0])
    double = float(double_dqn_targets(*networks, batch, discount)[0])
    largest = reward + discount * own.max()
    shown = [", ".join(f"{value:.2g}" for value in q) for q in (own, other)]
    best = int(own.argmax())
    return Question(
        f"A step gave the reward ${reward:g}$ and led to $s'$. There the trained network gives "
        f"${shown[0]}$ for three "
        f"actions, and the target network ${shown[1]}$. What are the targets of DQN and of double DQN, with "
        f"$\\gamma = {discount:g}$?",
        Table(
            ["DQN", "double DQN"],
            ["target"],
            [[plain], [double]],
            wrong={
                "The two are exchanged: double DQN lets the trained network choose the action.": [
                    [double],
                    [plain],
                ],
                "The value comes from the target network in both methods.": [
                    [largest],
                    [largest],
                ],
                "Both take the largest value of the target network here. Double DQN chooses by the trained one.": [
                    [plain],
                    [plain],
                ],
            },
        ),
        f"DQN: ${reward:g} {sign(discount * other.max())} = {plain:.4g}$, with the largest value of "
        f"the target network. "
        f"Double DQN: the trained network prefers action {best + 1}, which the target network values at "
        f"${other[best]:.2g}$: ${reward:g} {sign(discount * other[best])} = {double:.4g}$.",
    )


@drill("nnql-comparison", "How noise lifts a maximum")
def lifted_maximum(rng: Rng) -> Question:
    """Compute the mean of a maximum of two noisy estimates."""
    value, error = (
        round(float(rng.uniform(0, 1)), 1),
        float(rng.choice([0.1, 0.2, 0.4])),
    )
    answer = value + error / 2
    return Question(
        f"Two actions have the same true value ${value:g}$. Each estimate is too high or too low by "
        f"${error:g}$, with equal "
        "probability and independently of the other. What is the mean of the larger estimate?",
        Number(
            answer,
            wrong={
                "Each estimate is right in the mean, but the larger of the two is not.": value,
                "The larger one is too high in three of four cases, not always.": value
                + error,
                "The larger one is too low only if both are: in one of four cases.": value
                - error / 2,
                "The two cases with opposite errors count as well: there, too, the larger one is too high.": value
                + error / 4,
            },
        ),
        f"In three of four cases the larger estimate is ${value + error:.4g}$, in one it is ${value - error:.4g}$: "
        f"$(3 \\cdot {value + error:.4g} {sign(value - error)}) / 4 = {answer:.4g}$.",
    )
