"""Drills of the page on NNQL, step by step."""

from __future__ import annotations

import numpy as np

from robonav import nnql
from robonav.networks import Network, NetworkStack

from ..pictures import CELL, box, label, picture, place
from ..question import Choice, Number, Place, Question, Table
from ..registry import drill
from ..runs import Line, as_list, some_in_order
from ..text import sign

Rng = np.random.Generator
NAMES = ("F", "L30", "L60")
FREE = 10.0  # what a sensor reads if nothing is in its range


def _list(numbers: np.ndarray) -> str:
    """Numbers between commas."""
    return ", ".join(f"{number:.3g}" for number in numbers)


@drill("nnql", "The target of the last step")
def last_step(rng: Rng) -> Question:
    """Compute the new value of the action of an episode's last step."""
    q = float(rng.integers(1, 10)) / 10
    following = float(rng.integers(3, 10)) / 10
    rate, discount = float(rng.choice([0.5, 0.8])), float(rng.choice([0.6, 0.7]))
    reward, end = [
        (1.0, "arrives"),
        (-1.0, "collides"),
        (0.6, "is stopped, because its time is over"),
    ][int(rng.integers(3))]
    terminal = end != "is stopped, because its time is over"
    new, other, undiscounted = (
        float(nnql.q_targets(np.array([q]), 0, reward, value, rate, discount)[0])
        for value in (
            0.0 if terminal else following,
            following if terminal else 0.0,
            following / discount,
        )
    )
    future = 0.0 if terminal else discount * following
    wrong = {
        "Nothing follows an arrival or a collision, so the future value is left out."
        if terminal
        else "The episode was only cut off: the robot could have gone on, so the future value counts.": other,
        "This is the whole target. The value moves by the part $\\alpha$ of the error.": reward
        + future,
        "The error is the target minus the old value.": q + rate * (reward + future),
    }
    if not terminal:
        wrong["The discount is missing."] = undiscounted
    kept = f" {sign(future)}" if future else ""
    return Question(
        f"The robot takes an action with the value ${q:g}$ and {end}. The reward is ${reward:g}$, and for the state "
        f"reached the network's largest value is ${following:g}$. Which value does line 13 "
        f"of NNQL give the action, with $\\alpha = {rate:g}$ and $\\gamma = {discount:g}$, before it is "
        "brought into $[0, 1]$?",
        Number(new, wrong=wrong),
        ("Nothing follows: " if terminal else "The future value counts: ")
        + f"${q:g} + {rate:g} \\, ({reward:g}{kept} {sign(-q)}) = {new:.4g}$.",
    )


@drill("nnql", "Steps of gradient descent in an episode")
def descents_of_episode(rng: Rng) -> Question:
    """Count how many pairs an episode of NNQL and one of online learning train on."""
    decisions, passes = int(rng.integers(6, 61)), int(rng.integers(1, 4))
    growing = passes * decisions * (decisions + 1) // 2
    online = passes * decisions
    times = f"{passes} \\cdot " if passes > 1 else ""
    often = ["one pass", "two passes", "three passes"][passes - 1]
    return Question(
        f"An episode has ${decisions}$ decisions. After each of them, training makes {often} through its pairs, and a "
        "step of gradient descent for each pair. How many steps does NNQL make in the episode, and how many the online "
        "method?",
        Table(
            ["NNQL", "online"],
            ["steps"],
            [[growing], [online]],
            tolerance=0.5,
            wrong={
                "The list of pairs grows during the episode. After the third decision it has three pairs.": [
                    [passes * decisions**2],
                    [online],
                ],
                "NNQL trains on all pairs so far, after each decision.": [
                    [online],
                    [online],
                ],
                "The online method trains on the latest pair alone.": [
                    [growing],
                    [growing],
                ],
                "After the last decision the list has all pairs, and NNQL trains on them, too.": [
                    [passes * decisions * (decisions - 1) // 2],
                    [online],
                ],
            },
        ),
        f"NNQL: ${times}(1 + 2 + \\dots + {decisions}) = {growing}$. Online: ${times}{decisions} = {online}$."
        if passes > 1
        else f"NNQL: $1 + 2 + \\dots + {decisions} = {growing}$. Online: one each, ${online}$.",
    )


@drill("nnql", "When has the list so many pairs?")
def pairs_so_far(rng: Rng) -> Question | None:
    """Find the step after which NNQL trains on a given number of pairs."""
    ranges = np.round(rng.uniform(3.6, 9.5, size=7), 1)
    free = rng.random(7) < 0.4
    ranges[free] = FREE
    learns = nnql.property_at(ranges) != nnql.Property.SAFE
    if not 3 <= learns.sum() <= 5:
        return None
    count = int(rng.integers(2, learns.sum() + 1))
    step = int(np.flatnonzero(learns)[count - 1]) + 1
    if count == step:
        return None
    wrong = {str(count): "In safe states the reflex acts, and no pair is kept."}
    parts = []
    for k, metres in enumerate(ranges, start=1):
        x = 1 + 1.05 * CELL * (k - 1)
        cell = box(x, 1, CELL, 50, fill="transparent")
        cell += label(x + CELL / 2, 16, f"step {k}", size=13)
        cell += label(x + CELL / 2, 36, f"{metres:g} m", size=13)
        parts.append(place(str(k), cell))
    return Question(
        "The picture shows the distance of the nearest thing before each step of an episode. Sensors reach 10 m, and "
        f"where nothing is in range the reflex acts. After which step does NNQL train on ${count}$ pairs for the "
        "first time?",
        Place([str(k) for k in range(1, 8)], [str(step)], wrong),
        "Steps in which something is in range give a pair: "
        + ", ".join(str(k + 1) for k in np.flatnonzero(learns))
        + f". The list has {count} pairs after step {step}.",
        picture(
            1.05 * CELL * 7,
            52,
            *parts,
            title="Seven steps, each with the distance of the nearest thing: "
            + ", ".join(f"{metres:g} m" for metres in ranges)
            + ".",
        ),
    )


@drill("nnql", "The error of each output")
def errors_of_outputs(rng: Rng) -> Question:
    """Compute the errors of all outputs after an update and its rescaling."""
    q = np.round(rng.choice(np.arange(2, 9), size=3, replace=False) / 10, 1)
    taken, rate = int(rng.integers(3)), float(rng.choice([0.5, 0.8]))
    target = float(rng.choice([-1.0, -0.6, 0.2, 0.5, 1.0, 1.4, 1.6]))
    new = nnql.q_targets(q, taken, target, 0.0, rate, 0.6)
    errors, cut, raw = (
        nnql.network_error(values, q)
        for values in (nnql.shift(new), nnql.clip(new), new)
    )
    whole = nnql.network_error(
        nnql.shift(nnql.q_targets(q, taken, target, 0.0, 1.0, 0.6)), q
    )
    wrong = {
        "The value moves by the part $\\alpha$ of the TD error.": [whole.tolist()],
        "The error is the target minus the output.": [(-errors).tolist()],
    }
    leaves = not np.allclose(errors, raw)
    if leaves:
        wrong["This is before rescaling: a value lies outside the outputs' range."] = [
            raw.tolist()
        ]
        wrong["Shifting moves the values of the other actions, too."] = [cut.tolist()]
    value = new[taken]
    return Question(
        f"In $s$ the outputs are ${_list(q)}$ for F, L30 and L60. The robot takes {NAMES[taken]}, and the TD target "
        f"$r + \\gamma \\max Q(s', a)$ is ${target:g}$. With $\\alpha = {rate:g}$, what is the error $\\delta$ of each "
        "output? Shift the new values first: map the range from the smaller of 0 and the least to the larger of 1 and "
        "the greatest onto the range from 0 to 1. Give three decimals.",
        Table(
            ["error"],
            list(NAMES),
            [errors.tolist()],
            tolerance=0.0011,
            wrong=wrong,
        ),
        f"{NAMES[taken]} gets ${q[taken]:g} + {rate:g} \\, ({target:g} {sign(-q[taken])}) = {value:.3g}$. "
        + (
            f"Shifted into $[0, 1]$ the values are {_list(nnql.shift(new))}. "
            if leaves
            else "All values lie in $[0, 1]$, so that only one error is not 0. "
        )
        + f"Minus the outputs: {_list(np.round(errors, 3) + 0.0)}.",
    )


@drill("nnql", "How the output weights change")
def output_weights(rng: Rng) -> Question:
    """Compute one step of gradient descent for the weights of an output."""
    hidden = rng.choice([0.1, 0.2, 0.3, 0.5, 0.6, 0.7, 0.9], size=2, replace=False)
    q, target = rng.choice([0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8], size=2, replace=False)
    step = float(rng.choice([0.1, 0.2, 0.3, 0.5]))
    weights = np.array([[1.0, -1.0]])
    bias = np.log(q / (1 - q)) - weights @ hidden  # so that the output is q
    before = Network((weights,), (bias,))
    after = nnql.train_on_pairs(
        before, [hidden], [np.array([target])], step, passes=1, tolerance=0.0
    )
    change = np.append(after.weights[0] - before.weights[0], after.biases[0] - bias)
    error, slope = target - q, q * (1 - q)
    return Question(
        f"For the action taken the output is ${q:g}$ and the rescaled target ${target:g}$. The two hidden units have "
        f"the activations ${hidden[0]:g}$ and ${hidden[1]:g}$. How much do the two weights and the bias of this "
        f"output change in a step of gradient descent on the cross-entropy with the size $\\sigma = {step:g}$? Give "
        "three decimals.",
        Table(
            ["change"],
            ["weight 1", "weight 2", "bias"],
            [change.tolist()],
            tolerance=0.0011,
            wrong={
                "The weights move so that the output comes nearer to its target.": [
                    (-change).tolist()
                ],
                "Under the cross-entropy the slope $Q (1 - Q)$ cancels.": [
                    (change * slope).tolist()
                ],
                "The step size $\\sigma$ is missing.": [(change / step).tolist()],
                "Each weight's change is multiplied by the activation of its hidden unit.": [
                    [step * error] * 3
                ],
            },
        ),
        f"$\\delta = {target:g} - {q:g} = {error:.2g}$. Each change is $\\sigma \\delta a_j$, with $a = 1$ for the "
        f"bias: {_list(change)}.",
    )


@drill("nnql", "How long is a first value remembered?")
def memory_of_a_value(rng: Rng) -> Question | None:
    """Compute how much of a wrong first value is left after some updates."""
    rate = float(rng.choice([0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8]))
    updates, error = int(rng.integers(2, 8)), float(rng.choice([0.5, 1.0, 2.0]))
    value = np.array([error])
    for _ in range(updates):
        value = nnql.q_targets(value, 0, 0.0, 0.0, rate, 0.6)
    left = float(value[0])
    if left < 0.01:
        return None
    times = "" if error == 1 else f"{error:g} \\cdot "
    return Question(
        f"A value is too large by ${error:g}$ at first. All later targets are right. By how much is it still too large "
        f"after ${updates}$ updates with $\\alpha = {rate:g}$, if the network stores each value exactly? Give three "
        "decimals.",
        Number(
            left,
            tolerance=0.0011,
            wrong={
                "An update keeps the part $1 - \\alpha$ of the error, not $\\alpha$.": error
                * rate**updates,
                "Each update takes a part of what is left, not of the first error.": error
                * (1 - rate * updates),
                "This is the part of the error that has gone.": error - left,
                "This is what is left after one update less.": error
                * (1 - rate) ** (updates - 1),
            },
        ),
        f"Each update keeps $1 - \\alpha$ of the error: ${times}{1 - rate:g}^{updates} = {left:.3f}$.",
    )


@drill("nnql", "Signed and absolute changes")
def sums_of_changes(rng: Rng) -> Question | None:
    """Sum the changes of a layer's weights in two ways."""
    changes = np.round(rng.uniform(-0.6, 0.6, size=5), 1)
    if 0 in changes:
        return None
    weights = np.stack([np.zeros(4), changes[:4]])[None, :, None, :]
    biases = np.array([0.0, changes[4]])[None, :, None]
    history = NetworkStack((weights,), (biases,))
    signed, absolute = (
        float(nnql.weight_changes(history, absolute=kind)[0, 0, 0])
        for kind in (False, True)
    )
    shown = " ".join(sign(change) for change in changes).removeprefix("+ ")
    sizes = " + ".join(f"{abs(change):g}" for change in changes)
    return Question(
        f"In an episode the four weights and the bias of a layer change by ${', '.join(f'{c:g}' for c in changes)}$. "
        "What are the sums of the signed and of the absolute changes?",
        Table(
            ["signed", "absolute"],
            ["sum"],
            [[signed], [absolute]],
            wrong={
                "The two are exchanged.": [[absolute], [signed]],
                "The absolute value is taken of each change, before they are added.": [
                    [signed],
                    [abs(signed)],
                ],
                "The bias belongs to the layer, too.": [
                    [signed - changes[4]],
                    [absolute - abs(changes[4])],
                ],
            },
        ),
        f"Signed: ${shown} = {signed:.2g}$. Absolute: ${sizes} = {absolute:.2g}$. Signed changes cancel, so a small "
        "sum does not show that the weights stay.",
    )


def _step_of_nnql(rng: Rng, number: int, pairs: int) -> list[Line]:
    """What NNQL does in one step of an episode, with numbers."""
    q = np.round(rng.choice(np.arange(2, 9), size=3, replace=False) / 10, 1)
    taken, following = int(rng.integers(3)), float(rng.integers(2, 10)) / 10
    reward = float(rng.choice([-1.0, -0.5, 0.1, 0.5, 1.0]))
    new = nnql.q_targets(q, taken, reward, following, 0.8, 0.6)
    lines = [
        (
            f"the network gives ${_list(q)}$ for F, L30 and L60.",
            "The network is asked at the beginning of a step, after it was trained in the step before.",
        ),
        (
            f"the softmax policy draws {NAMES[taken]}, and the robot carries it out.",
            "The softmax policy needs the values that the network gives in this step.",
        ),
        (
            f"the reward is ${reward:g}$, and the largest value of the next state ${following:g}$.",
            "The reward and the next state are known after the action.",
        ),
        (
            f"line 13 of NNQL gives the value ${new[taken]:.3g}$.",
            "The update needs the reward and the next state, which follow the action.",
        ),
        (
            f"shifted into the range from 0 to 1 the three values are ${_list(nnql.shift(new))}$.",
            "The update can lead out of the range, so the values are brought into it afterwards.",
        ),
        (
            f"with this pair the list has {pairs} pairs.",
            "A pair holds the rescaled values of its step, so these come first.",
        ),
        (
            f"the network is trained on {pairs} pairs.",
            "The pair of the step is among those that the network is trained on.",
        ),
    ]
    return [Line(f"Step {number}: {text}", why) for text, why in lines]


@drill("nnql", "A run of NNQL")
def order_of_nnql(rng: Rng) -> Question:
    """Put what NNQL does in one step of an episode in order."""
    number = int(rng.integers(3, 30))
    pairs = int(rng.integers(2, number + 1))
    lines = _step_of_nnql(rng, number, pairs) + _step_of_nnql(rng, number + 1, pairs + 1)  # fmt: skip
    asked = some_in_order(rng, lines, 5)
    return Question(
        f"In steps {number} and {number + 1} of an episode something is in range, so that the robot learns. With "
        "$\\alpha = 0.8$ and $\\gamma = 0.6$ NNQL prints these lines. Put them in order.",
        asked,
        f"Lines 9 to 16 of NNQL: values, action, update, rescaling, pair, training. {as_list(asked)}",
    )


LEARNED = {
    "the weights of the network": "They are what was learned. Without them the training begins again from the start.",
    "the number of episodes so far": "How the robot explores, and the seeds of the next episode, depend on it.",
}
ALSO_OF_DQN = {
    "the weights of the target network": "They are older than those of the network, and the next targets need them.",
    "the transitions in the replay memory": "The next batches are drawn from all of them.",
    "the means that Adam keeps of past gradients": "The next step of Adam depends on them.",
}
NOT_NEEDED = {
    "the maps of the episodes so far": "A map is made again from its seed and its number.",
    "the random numbers drawn so far": "Those of an episode depend only on its seed and its number.",
    "the paths of the robot": "No later step depends on where the robot was.",
    "how much the robot explored in the last episode": "That follows from the number of the episode.",
    "the Q-values of the states that it has seen": "The network computes them again.",
    "what the sensors read at the end of the last episode": "The next episode begins in another map.",
}
EMPTY = "the pairs of the last episode"
NEW = "the batch of the last step"
METHODS = {
    "NNQL": (LEARNED, {EMPTY: "Each episode begins with an empty list of pairs."}),
    "online Q-learning": (LEARNED, {EMPTY: "It trains on the latest pair alone."}),
    "DQN": (LEARNED | ALSO_OF_DQN, {NEW: "Each step draws a batch of its own."}),
}


LEARNS = {
    "NNQL": "It begins each episode with an empty list of pairs, and trains the network by plain gradient steps.",
    "online Q-learning": "It trains the network by plain gradient steps, each on the latest pair alone.",
    "DQN": "It trains the network with Adam on batches from a replay memory, and takes the targets from a copy of the "
    "network that is renewed now and then.",
}
EPISODES = (
    "Each robot's seed and all settings are known. From a robot's seed and the number of an episode follow the map of "
    "the episode, its random numbers, which begin anew in each episode, and how much the robot explores in it."
)


@drill("nnql", "What must a checkpoint hold?")
def what_a_checkpoint_holds(rng: Rng) -> Question:
    """Tell what has to be saved between two episodes so that a training continues as if never interrupted."""
    seeds, episodes = int(rng.choice([4, 8, 16])), int(rng.choice([50, 100, 200]))
    method = str(rng.choice([*METHODS], p=[0.3, 0.2, 0.5]))
    needed, not_needed = METHODS[method]
    not_needed = NOT_NEEDED | not_needed
    is_needed = bool(rng.integers(2))
    good, bad = (needed, not_needed) if is_needed else (not_needed, needed)
    right = str(rng.choice([*good]))
    others = [str(name) for name in rng.permutation([*bad])[:3]]
    return Question(
        f"A training of {seeds} robots with {method} is saved after {episodes} episodes and continued later, as if it "
        f"had never been interrupted. {LEARNS[method]} {EPISODES} Which of these "
        f"{'has to be' if is_needed else 'need not be'} in the file?",
        Choice(right, {name: bad[name] for name in others}),
        good[right],
    )
