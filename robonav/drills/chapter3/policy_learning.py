"""Drills of the page on learning the policy."""

from __future__ import annotations

import math

import numpy as np

from robonav import lfd, networks, robot
from robonav.benchmark import success_interval
from robonav.lfd.behaviour_cloning import stacked_pairs

from ..pictures import CELL, box, label, picture, place
from ..question import Choice, Number, Place, Question, Table
from ..registry import drill

Rng = np.random.Generator
NAMES = ("F", "L30", "R30")
Z = 1.96  # of a 95 % interval
FREE = 10.0  # metres that a sector reads with nothing in range


def _confusion(rng: Rng) -> np.ndarray:
    """How often the network chose each action (column) where the expert took another one or the same (row)."""
    counts = rng.integers(1, 10, size=(3, 3))
    counts[0, 0] += rng.integers(20, 60)
    counts[[1, 2], [1, 2]] += rng.integers(0, 30, size=2)
    return counts


SAYS_ITS_INPUT = networks.Network((np.eye(3),), (np.zeros(3),))


def _labelled(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The states of a confusion matrix: the network's actions and the expert's, each a 1 among zeros."""
    expert, chosen = np.indices(counts.shape).reshape(2, -1).repeat(counts.ravel(), 1)
    return np.eye(3)[chosen], np.eye(3)[expert]


def _matrix_picture(counts: np.ndarray) -> str:
    """The matrix, its rows as places."""
    parts = [label(CELL * (j + 1.5), 14, name) for j, name in enumerate(NAMES)]
    for i, name in enumerate(NAMES):
        y = 28 + 40 * i
        row = box(1, y, 4 * CELL, 36, fill="transparent")
        row += label(CELL / 2, y + 18, name)
        for j, count in enumerate(counts[i]):
            row += label(CELL * (j + 1.5), y + 18, str(count))
        parts.append(place(name, row))
    rows = "; ".join(
        f"expert {name}: {', '.join(map(str, row))}"
        for name, row in zip(NAMES, counts, strict=True)
    )
    title = f"A confusion matrix with the network's actions F, L30 and R30 in its columns. {rows}."
    return picture(4 * CELL + 2, 150, *parts, title=title)


READING = "The picture counts the states of a validation set by the expert's action (row) and the network's (column). "


@drill("policy-learning", "Accuracy, and that of a constant answer")
def accuracy_of_two(rng: Rng) -> Question:
    """Read from a confusion matrix how often a network and a constant answer agree with the expert."""
    counts = _confusion(rng)
    chosen, labels = _labelled(counts)
    forward = np.tile(np.eye(3)[0], (len(labels), 1))
    accuracy, always = (
        networks.network_accuracy(SAYS_ITS_INPUT, actions, labels)
        for actions in (chosen, forward)
    )
    total = int(counts.sum())
    by_row = float((counts.diagonal() / counts.sum(axis=1)).mean())
    column = float(counts[:, 0].sum() / total)
    diagonal = " + ".join(map(str, counts.diagonal()))
    return Question(
        READING
        + "How often does the network agree with the expert, and how often does a robot that always goes straight on "
        "(F)? Give fractions between 0 and 1.",
        Table(
            ["network", "always F"],
            ["accuracy"],
            [[accuracy], [always]],
            wrong={
                "All states count the same: divide the sum of the diagonal by the number of all states.": [
                    [by_row],
                    [always],
                ],
                "The rows are the expert's actions, so the constant answer is right in the states of row F.": [
                    [accuracy],
                    [column],
                ],
                "The constant answer is right in all states of row F, not only where the network is right, too.": [
                    [accuracy],
                    [float(counts[0, 0] / total)],
                ],
            },
        ),
        f"There are ${total}$ states. The network is right in those of the diagonal: "
        f"$({diagonal}) / {total} = {accuracy:.3g}$. Always F is right in the states of row F: "
        f"$({' + '.join(map(str, counts[0]))}) / {total} = {always:.3g}$.",
        _matrix_picture(counts),
    )


@drill("policy-learning", "Which action is learned worst?")
def least_recalled(rng: Rng) -> Question | None:
    """Find the action of the expert that a network repeats in the smallest part of its states."""
    counts = _confusion(rng)
    repeated = counts.diagonal()
    chosen, labels = _labelled(counts)
    recall = np.array(
        [
            networks.network_accuracy(SAYS_ITS_INPUT, chosen[rows], labels[rows])
            for rows in labels.T.astype(bool)
        ]
    )
    precision = repeated / counts.sum(axis=0)
    right = [NAMES[int(recall.argmin())]]
    if np.diff(np.sort(recall))[0] < 0.02:
        return None  # too near to tell apart by two decimals
    wrong = {
        name: f"Its share, ${hit} / {row} = {share:.2f}$, is not the smallest."
        for name, hit, row, share in zip(
            NAMES, repeated, counts.sum(axis=1), recall, strict=True
        )
        if name not in right
    }
    for name, hint in (
        (
            NAMES[int(precision.argmin())],
            "When the network chooses this action it is wrong most often: that is a share of the column.",
        ),
        (
            NAMES[int(repeated.argmin())],
            "This action has the smallest number on the diagonal, but it may also be the rarest. Divide by the row.",
        ),
    ):
        if name not in right:
            wrong[name] = hint
    return Question(
        READING
        + "Which action of the expert does the network repeat least often, as a share of the states in which the "
        "expert takes it? Click on its row.",
        Place(NAMES, right, wrong),
        "The share is the number on the diagonal divided by the sum of the row: "
        + ", ".join(
            f"{name} ${hit} / {row} = {share:.2f}$"
            for name, hit, row, share in zip(
                NAMES, repeated, counts.sum(axis=1), recall, strict=True
            )
        )
        + ".",
        _matrix_picture(counts),
    )


@drill("policy-learning", "Choosing the regularisation")
def chosen_regularisation(rng: Rng) -> Question:
    """Choose a constant by the cost on a validation set."""
    decays = (0.01, 0.1, 1.0)
    best = int(rng.integers(3))
    while True:
        training = np.round(np.sort(rng.uniform(1.0, 2.2, size=3)), 2)
        validation = np.round(training + rng.uniform(0.02, 1.2, size=3), 2)
        apart = np.diff(np.sort([*training, *validation])).min() > 0.02
        if apart and best == validation.argmin():
            break
    fitted = int(training.argmin())
    closest = int((validation - training).argmin())
    wrong = {}
    for k in range(3):
        hint = "Another value has a lower cost on demonstrations that the network has not seen."
        if k == closest:
            hint = (
                "Here the two costs are closest, but both are higher than they need be."
            )
        if k == fitted:
            hint = "Here the cost is lowest on the examples learned from. Look at the other demonstrations."
        if k != best:
            wrong[f"$\\lambda = {decays[k]:g}$"] = hint
    shown = "; ".join(
        f"$\\lambda = {decay:g}$: ${a:g}$ and ${b:g}$"
        for decay, a, b in zip(decays, training, validation, strict=True)
    )
    return Question(
        "You train with three values of $\\lambda$. The costs at the end, without the penalty, are given first for "
        f"the demonstrations learned from and then for 25 others. {shown}. Which $\\lambda$ do you choose?",
        Choice(
            f"$\\lambda = {decays[best]:g}$",
            wrong,
            order=[f"$\\lambda = {decay:g}$" for decay in decays],
        ),
        "The cost on the other demonstrations counts, because the network did not learn from them. It is smallest, "
        f"${validation[best]:g}$, with $\\lambda = {decays[best]:g}$.",
    )


@drill("policy-learning", "Is a success rate possible?")
def rate_in_interval(rng: Rng) -> Question | None:
    """Decide by Wilson's condition whether a true rate is in the interval of a test."""
    n = int(rng.choice([50, 100, 200, 400]))
    k = round(n * rng.uniform(0.75, 0.97))
    away = (
        rng.choice([-1, 1])
        * rng.uniform(0.3, 2)
        * Z
        * math.sqrt(k / n * (1 - k / n) / n)
    )
    p = min(round(float(k / n + away), 3), 0.99)
    low, high = success_interval(k, n)
    inside = float(low <= p <= high)
    gap = abs(k / n - p)
    error = math.sqrt(p * (1 - p) / n)
    simple = math.sqrt(k / n * (1 - k / n) / n)
    if abs(gap - Z * error) < 0.003:
        return None  # too near to decide by three decimals
    return Question(
        f"A policy arrives in ${k}$ of ${n}$ maps. Does Wilson's 95 % interval contain $p = {p:g}$? Its condition is "
        "$|k/n - p| \\leq 1.96 \\sqrt{p \\, (1 - p) / n}$. Give both sides with three decimals, and then 1 for yes or "
        "0 for no.",
        Table(
            ["$|k/n - p|$", "right side", "1 or 0"],
            ["number"],
            [[gap], [Z * error], [inside]],
            tolerance=0.0011,
            wrong={
                "The standard error is that of the rate $p$ which is tested, not that of $k/n$.": [
                    [gap],
                    [Z * simple],
                    [float(gap <= Z * simple)],
                ],
                "The factor 1.96 is missing.": [
                    [gap],
                    [error],
                    [float(gap <= error)],
                ],
                "The root of $n$ is missing: $p (1 - p)$ is divided by $n$ before the root is taken.": [
                    [gap],
                    [Z * math.sqrt(p * (1 - p)) / n],
                    [float(gap <= Z * math.sqrt(p * (1 - p)) / n)],
                ],
                "The interval contains $p$ if the gap is at most the right side.": [
                    [gap],
                    [Z * error],
                    [1 - inside],
                ],
            },
        ),
        f"$|{k / n:.4g} - {p:g}| = {gap:.4g}$. The right side is "
        f"$1.96 \\sqrt{{{p:g} \\cdot {1 - p:.3g} / {n}}} = {Z * error:.3f}$. "
        f"So the interval {'contains' if inside else 'does not contain'} ${p:g}$.",
    )


@drill("policy-learning", "A test without a failure")
def perfect_test(rng: Rng) -> Question:
    """Compute where Wilson's interval begins after a test in which every episode arrived."""
    n = int(rng.integers(8, 300))
    low, _ = success_interval(n, n)
    only_below = (n - Z**2) / n
    wrong = {
        "Policies with a smaller rate pass such a test, too. The simplest interval overlooks this.": 1.0,
        "The 95 % say how often such intervals contain the true rate, not where they begin.": 0.95,
        "The 1.96 is squared.": n / (n + Z),
    }
    if low - only_below > 0.003:
        hint = "The square of 1.96 is added to the denominator, not subtracted from the numerator."
        wrong[hint] = only_below
    return Question(
        f"A policy arrives in all of ${n}$ new maps. Where does Wilson's 95 % interval of its success rate begin? It "
        "holds all $p$ with $|k/n - p| \\leq 1.96 \\sqrt{p \\, (1 - p) / n}$. Give a fraction with three decimals.",
        Number(
            low,
            tolerance=0.0011,
            wrong=wrong,
        ),
        "With $k = n$ the condition is $1 - p \\le 1.96^2 p / n$. The interval begins at "
        f"${n} / ({n} + 3.84) = {low:.3f}$.",
    )


@drill("policy-learning", "A lucky test")
def lucky_test(rng: Rng) -> Question | None:
    """Compute how often a policy that fails sometimes passes a short test."""
    one_in = int(rng.choice([4, 5, 8, 10, 12, 15, 20, 25, 30, 40, 50]))
    maps = int(rng.integers(4, 26))
    passed = (1 - 1 / one_in) ** maps
    if passed < 0.05:
        return None  # else 0 would be right within the tolerance
    return Question(
        f"A policy fails in one map of ${one_in}$. With which probability does it arrive in all of ${maps}$ new maps?",
        Number(
            passed,
            wrong={
                "This is the probability of at least one failure.": 1 - passed,
                "Failures do not add up, since several maps of a test may fail: multiply the rates of success.": 1
                - maps / one_in,
                "This is the probability that it arrives in one map.": 1 - 1 / one_in,
            },
        ),
        f"The maps are independent: ${1 - 1 / one_in:.4g}^{{{maps}}} = {passed:.3g}$.",
    )


def _shapes(
    steps: np.ndarray, safe: np.ndarray, back: np.ndarray, encoder: robot.Encoder
) -> tuple[int, int, int]:
    """Rows of S and A of recorded trajectories, and the columns of each."""
    total, trajectory = int(steps.sum()), np.repeat(np.arange(len(steps)), steps)
    ranges = np.full((total, 9), 6.0)
    actions = np.zeros(total, dtype=np.int64)
    for first, n, m in zip(np.cumsum(steps) - steps, safe, back, strict=True):
        ranges[first : first + n] = FREE
        actions[first + n : first + n + m] = robot.Action.B
    sensing = robot.Sensing(
        ranges, np.zeros((total, 9), bool), np.ones(total, int), np.zeros(total, bool)
    )
    recorded = lfd.Demonstrations(
        worlds=robot.random_worlds(len(steps), seed=0),
        trajectory=trajectory,
        sensing=sensing,
        actions=actions,
        poses=np.zeros((total, 3)),
        speed=2.0,
        outcome=np.repeat("arrived", len(steps)),
    )
    states, labels = stacked_pairs(recorded, encoder)
    return len(states), states.shape[1], labels.shape[1]


@drill("policy-learning", "The shapes of the training data")
def stacked_shapes(rng: Rng) -> Question:
    """Say how many rows and columns the matrices S and A have."""
    steps = rng.integers(45, 65, size=3)
    safe = rng.integers(20, 35, size=3)
    back = rng.integers(0, 3, size=3)
    thesis = bool(rng.integers(2))
    encoders = robot.Encoder(), robot.Encoder(target="number")
    rows, size, learned = _shapes(steps, safe, back, encoders[thesis])
    other = encoders[not thesis].size
    target = (
        "the number of the target's sector"
        if thesis
        else "the sine and the cosine of the direction of the target's sector"
    )
    shown = "; ".join(
        f"${n}$ steps: ${s}$ safe, ${b}$ back"
        for n, s, b in zip(steps, safe, back, strict=True)
    )
    return Question(
        f"Three demonstrations were recorded. {shown}. *Safe* are steps in safe states, *back* those in which the "
        "robot stepped back. A state is encoded by the degrees of danger of nine sensors, "
        f"{target}, and whether the target is seen. The expert chooses among F, L30, L60, R30 and R60. How many rows "
        "and columns have the training matrices, $S$ of the states and $A$ of the actions?",
        Table(
            ["$S$", "$A$"],
            ["rows", "columns"],
            [[rows, size], [rows, learned]],
            tolerance=0.1,
            wrong={
                "Only effective pairs are kept. In safe states, and where the robot steps back, the reflex acts.": [
                    [int(steps.sum()), size],
                    [int(steps.sum()), learned],
                ],
                "The reflex also makes the steps back.": [
                    [int((steps - safe).sum()), size],
                    [int((steps - safe).sum()), learned],
                ],
                "An action is a row of $A$: a 1 among four zeros.": [
                    [rows, size],
                    [rows, 1],
                ],
                "A sector's number is one component, and sine and cosine are two.": [
                    [rows, other],
                    [rows, learned],
                ],
            },
        ),
        f"Effective pairs are left: ${' + '.join(str(n - s - b) for n, s, b in zip(steps, safe, back, strict=True))} "
        f"= {rows}$ rows. A state has ${size}$ components, and an action ${learned}$.",
    )


@drill("policy-learning", "How strong is the penalty?")
def penalty(rng: Rng) -> Question:
    """Compute the term of the cost that holds the weights small."""
    squares, decay = float(rng.integers(20, 80)), float(rng.choice([0.1, 0.5, 2.0]))
    pairs = int(rng.choice([20, 40, 50, 60, 500]))
    network = networks.Network((np.array([[math.sqrt(squares)]]),), (np.zeros(1),))
    examples = np.zeros((pairs, 1)), np.zeros((pairs, 1))
    with_it, without = (
        networks.cross_entropy_cost(network, *examples, regularisation=strength)
        for strength in (decay, 0.0)
    )
    term = with_it - without
    return Question(
        f"A network was trained on ${pairs}$ effective pairs. The squares of its weights add up to ${squares:g}$. How "
        "much does the penalty $\\lambda / (2 m)$ times this sum, for $m$ pairs, add to the cost with "
        f"$\\lambda = {decay:g}$? Give three decimals.",
        Number(
            term,
            tolerance=0.0011,
            wrong={
                "The factor $1/2$ is missing.": 2 * term,
                "The penalty is divided by the number of pairs.": term * pairs,
                "$\\lambda$ is missing.": term / decay,
            },
        ),
        f"$\\lambda / 2m$ times the sum of squares: ${decay:g} / (2 \\cdot {pairs}) \\cdot {squares:g} = {term:.3f}$. "
        "Few pairs make the penalty strong.",
    )
