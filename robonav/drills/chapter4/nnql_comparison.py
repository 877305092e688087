"""Drills of the page that compares NNQL with other methods."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.experiments import probability_of_improvement

from ..question import Choice, Number, Question, Table
from ..registry import drill
from ..text import sign

Rng = np.random.Generator


@drill("nnql-comparison", "Targets of DQN and of double DQN")
def two_targets(rng: Rng) -> Question | None:
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
    other_way = reward + discount * own[other.argmax()]
    if own.max() == other.max():
        return (
            None  # DQN's target would be the same with the value of the wrong network
        )
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
                    [double],
                ],
                "In double DQN the trained network chooses the action, and the target network gives its value.": [
                    [plain],
                    [other_way],
                ],
                "Both take the largest value of the target network here. Double DQN chooses by the trained one.": [
                    [plain],
                    [plain],
                ],
            },
        ),
        f"DQN: ${reward:g} {sign(discount * other.max())} = {plain:.4g}$, with the largest value of "
        "the target network. "
        f"Double DQN: the trained network prefers action {best + 1}, which the target network values at "
        f"${other[best]:.2g}$: ${reward:g} {sign(discount * other[best])} = {double:.4g}$.",
    )


@drill("nnql-comparison", "How noise lifts a maximum")
def lifted_maximum(rng: Rng) -> Question:
    """Compute the mean of a maximum of noisy estimates."""
    value = round(float(rng.uniform(-1, 2)), 1) + 0.0  # no -0
    error = float(rng.choice([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8]))
    words, cases = [("Two", 4), ("Three", 8)][int(rng.integers(2))]
    high, low = value + error, value - error
    answer = ((cases - 1) * high + low) / cases
    return Question(
        f"{words} actions have the same true value ${value:g}$. Each estimate is too high or too low by "
        f"${error:g}$, with equal "
        "probability and independently of the others. What is the mean of the largest estimate?",
        Number(
            answer,
            wrong={
                "Each estimate is right on average, but the largest of them is not.": value,
                f"The largest one is too high in {cases - 1} of {cases} cases, not always.": high,
                f"The largest one is too low only if all are: in one of {cases} cases.": (
                    high + (cases - 1) * low
                )
                / cases,
                "This is half as much above the true value as it should be.": value
                + (answer - value) / 2,
            },
        ),
        f"All estimates are too low in one of {cases} cases. In the others the largest is "
        f"${high:.4g}$: $({cases - 1} \\cdot {_in_brackets(high)} {sign(low)}) / {cases} = {answer:.4g}$.",
    )


def _in_brackets(number: float) -> str:
    """A factor of a product."""
    return f"({number:.4g})" if number < 0 else f"{number:.4g}"


@drill("nnql-comparison", "Targets of NFQ")
def targets_of_nfq(rng: Rng) -> Question | None:
    """Compute the clipped targets of three transitions."""
    import torch

    from robonav.networks import Network
    from robonav.nnql import clip, nfq_targets
    from robonav.nnql.dqn import Batch

    values = rng.choice([0.2, 0.4, 0.5, 0.6, 0.8, 0.9], size=3, replace=False)
    discount = float(rng.choice([0.6, 0.7, 0.9]))
    rewards = np.array(
        [
            rng.choice([0.4, 0.5, 0.6]),
            rng.choice([-0.5, -0.2, 0.0]),
            rng.choice([0.2, 0.4, 0.6]),
        ]
    )
    terminal = np.array([False, False, True])
    logits = np.log(values / (1 - values))
    network = Network((np.stack([logits, logits - 1]),), (np.zeros(2),))
    transitions = Batch(
        states=torch.zeros(3, 3),
        actions=torch.zeros(3, dtype=torch.int64),
        rewards=torch.from_numpy(rewards),
        next_states=torch.eye(3, dtype=torch.float64),
        terminal=torch.from_numpy(terminal),
    )
    answer = nfq_targets(network, transitions, discount).tolist()
    future = discount * values
    raw = rewards + np.where(terminal, 0, future)
    if np.allclose(answer, raw):
        return None  # nothing has to be clipped
    wrong = {
        "The arrival ends the episode: no future value is added to its reward.": clip(
            rewards + future
        ).tolist(),
        "The discount is missing.": clip(
            rewards + np.where(terminal, 0, values)
        ).tolist(),
        "Targets are clipped into the range of the outputs, 0 to 1.": raw.tolist(),
    }
    shown = "; ".join(
        f"${reward:g}$ and ${value:g}$"
        for reward, value in zip(rewards, values, strict=True)
    )
    sums = ", ".join(
        f"${reward:g} {sign(later)} = {reward + later:.3g}$"
        for reward, later in zip(rewards[:2], future[:2], strict=True)
    )
    return Question(
        "A sweep of NFQ computes the targets of three transitions. Each has a reward, and the largest value of the "
        f"network in the next state: {shown}. The third one is an arrival. What are the targets, with "
        f"$\\gamma = {discount:g}$?",
        Table(
            ["target"],
            ["first", "second", "third"],
            [answer],
            wrong={hint: [table] for hint, table in wrong.items()},
        ),
        f"Before clipping the first two are {sums}. The arrival has its reward, ${rewards[2]:g}$. Clipped: "
        + ", ".join(f"{target:.3g}" for target in answer)
        + ".",
    )


@drill("nnql-comparison", "On how many pairs does each method train?")
def pairs_of_methods(rng: Rng) -> Question | None:
    """Say how many pairs or transitions the training of each method uses at once."""
    episodes, decisions = int(rng.integers(5, 21)), int(rng.integers(10, 41))
    batch = int(rng.choice([16, 32, 64]))
    whole = episodes * decisions
    if len({1, decisions, whole, batch}) < 4 or whole <= 2 * batch:
        return None
    return Question(
        f"Each of ${episodes}$ episodes had ${decisions}$ decisions, and the last one has just been made. NFQ now "
        f"fits its network, and DQN draws batches of ${batch}$. On how many pairs or transitions does the next "
        "training step of each method work: the pass of online learning and of NNQL, the fit of NFQ, the update of "
        "DQN?",
        Table(
            ["online", "NNQL", "NFQ", "DQN"],
            ["number"],
            [[1], [decisions], [whole], [batch]],
            tolerance=0.1,
            wrong={
                "NNQL forgets its pairs when an episode ends.": [
                    [1],
                    [whole],
                    [whole],
                    [batch],
                ],
                "Online learning trains on the latest pair alone.": [
                    [decisions],
                    [decisions],
                    [whole],
                    [batch],
                ],
                "NFQ keeps the transitions of all episodes.": [
                    [1],
                    [decisions],
                    [decisions],
                    [batch],
                ],
                "DQN keeps all transitions, but each update takes only a batch of them.": [
                    [1],
                    [decisions],
                    [whole],
                    [whole],
                ],
            },
        ),
        f"Online: the latest pair. NNQL: the ${decisions}$ pairs of this episode. NFQ: all "
        f"${episodes} \\cdot {decisions} = {whole}$ transitions. DQN: a batch of ${batch}$ of them.",
    )


@drill("nnql-comparison", "How surely is one method better?")
def better_robot(rng: Rng) -> Question | None:
    """Compute the probability that a robot of one method beats one of another."""
    ours = np.sort(rng.integers(88, 100, size=4))
    theirs = np.sort(rng.integers(86, 99, size=3))
    wins = int((ours[:, None] > theirs).sum())
    ties = int((ours[:, None] == theirs).sum())
    answer, pairs = probability_of_improvement(ours, theirs).probability, 12
    if wins == pairs:
        return None
    wrong = {
        "This is the probability that the other method is better.": 1 - answer,
    }
    if ties:
        wrong["A tie counts one half."] = wins / pairs
    return Question(
        f"Four robots of one method arrive in ${', '.join(map(str, ours))}$ % of the maps, and three robots of another "
        f"in ${', '.join(map(str, theirs))}$ %. What is the probability of improvement of the first method over the "
        "second?",
        Number(answer, wrong=wrong),
        f"Of ${pairs}$ pairs of robots the first wins ${wins}$ and ties in ${ties}$: "
        f"$({wins} + {ties} / 2) / {pairs} = {answer:.3g}$.",
    )


UNFAIR = {
    "{a} was tuned in {n} trials, {b} has the settings of its first paper": "Both must have the same number of trials.",
    "{a} was tuned in the {m} maps of the final test": "Settings are chosen on other maps than those of the test.",
    "{a} saw the target's sector as sine and cosine, {b} as a number": "Both must have the same inputs.",
    "The best of ten runs of {a} stands beside the mean of ten runs of {b}": "The same statistic must be compared.",
    "{a} trained for {m} episodes, and {b} until it arrived in nine of ten maps": "Both must have "
    "the same budget, or the budget is what is reported.",
    "{a} was tested in {m} maps with 10 obstacles, and {b} in as many with 20": "Both must be tested in the same maps.",
    "{n} robots of {a} and one robot of {b} were trained": "One robot may be lucky; both need as many.",
    "{a} drove at 1 m/s and {b} at 2 m/s in the same {m} maps": "Both must drive at the same speed.",
    "The {n} robots of {a} that failed in training were left out, those of {b} were not": "A failure counts for both.",
}
FAIR = (
    "{a} and {b} had {n} trials each, in maps that the test does not use",
    "{a} and {b} were tested in the same {m} maps, which neither had seen",
    "{a} and {b} have settings of their own, found in {n} trials each on tuning maps",
    "Of {a} and of {b} the mean of {n} runs is given, each with its interval",
    "{n} robots of {a} and as many of {b} were trained, and all of them count",
    "{a} and {b} drove at the same speed in {m} maps with as many obstacles",
)


@drill("nnql-comparison", "Fair or not?")
def fair_or_not(rng: Rng) -> Question:
    """Tell a fair comparison from an unfair one."""
    a, b = (
        str(name)
        for name in rng.choice(
            ["NNQL", "NFQ", "DQN", "online Q-learning"], 2, replace=False
        )
    )
    fill = {
        "a": a,
        "b": b,
        "n": int(rng.choice([8, 16, 25])),
        "m": int(rng.choice([100, 200, 1000])),
    }
    if rng.random() < 0.5:
        asks, right = "unfair", str(rng.choice([*UNFAIR]))
        others = rng.choice(FAIR, size=2, replace=False)
        wrong = {
            str(text).format(**fill): "This is as it should be: both are treated alike."
            for text in others
        }
        why = UNFAIR[right]
    else:
        asks, right = "fair", str(rng.choice(FAIR))
        others = rng.choice([*UNFAIR], size=2, replace=False)
        wrong = {str(text).format(**fill): UNFAIR[str(text)] for text in others}
        why = "Both are treated alike."
    return Question(
        f"{a} and {b} are compared. Which of these is {asks}?",
        Choice(right.format(**fill), wrong),
        why,
    )
