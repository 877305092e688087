"""Drills of the page on chapter 3's results."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav import lfd, mdp, robot
from robonav.lfd.dagger import beta_schedule

from ..question import Choice, Number, Question, Table
from ..registry import drill
from ..runs import Line, as_list, some_in_order

Rng = np.random.Generator
NAMES = ("F", "L30", "L60", "R30", "R60")
FREE = 10.0  # what a sensor reads if nothing is in its range


@drill("lfd-results", "Two bounds on what errors cost")
def two_bounds(rng: Rng) -> Question:
    """Tell the bound for a cloned policy from that of errors in a policy's own states."""
    steps = 10 * int(rng.integers(2, 16))
    error = float(rng.choice([0.001, 0.002, 0.003, 0.004, 0.005, 0.006, 0.008, 0.01, 0.015, 0.02]))  # fmt: skip
    own, expert = error * steps, error * steps**2
    return Question(
        "A policy takes another action than the expert with probability $\\varepsilon$, in episodes of $T$ steps. "
        "Measured in the expert's states, this lets it cost at most $\\varepsilon T^2$ more than the expert, if a step "
        "costs between 0 and 1. Measured in the policy's own states, it lets it cost at most $u \\varepsilon T$ more, "
        f"if an error costs at most $u$. With $T = {steps}$ and $\\varepsilon = {error:g}$, what is the bound if the "
        "probability was measured in the expert's states, and what if it was measured in the policy's own states and "
        "$u = 1$?",
        Table(
            ["expert's states", "own states"],
            ["bound"],
            [[expert], [own]],
            wrong={
                "The two are exchanged: the expert's states do not say how often it errs after an error.": [
                    [own],
                    [expert],
                ],
                "An error can cost 1 in every step that is left, so that $T$ counts twice.": [
                    [own],
                    [own],
                ],
                "In the policy's own states, too, the errors of all $T$ steps add up.": [
                    [expert],
                    [error],
                ],
                "In the policy's own states each error costs 1, so that $T$ counts once.": [
                    [expert],
                    [expert],
                ],
            },
        ),
        f"Measured in the expert's states: $\\varepsilon T^2 = {error:g} \\cdot {steps**2} = {expert:g}$. In its own "
        f"states: $\\varepsilon T = {error:g} \\cdot {steps} = {own:g}$.",
    )


@drill("lfd-results", "Errors after the first error")
def compounding(rng: Rng) -> Question:
    """Compute the expected number of errors if the first one is never repaired."""
    error = float(rng.integers(2, 41)) / 100
    steps = int(rng.integers(2, 6))
    # state 0 is on the expert's path and state 1 off it; the reward counts errors; action 1 would end the episode
    forward = [[1 - error, error, 0], [0, 1, 0], [0, 0, 1]]
    rewards = [[error, 0], [1, 0], [0, 0]]
    model = mdp.FiniteMDP([forward, [[0, 0, 1]] * 3], rewards, discount=1)
    answer = float(mdp.finite_horizon_evaluation(model, [0, 0, 0], steps)[0])
    right = 1 - error
    terms = [1 - right**t for t in range(1, steps + 1)]
    return Question(
        f"On the expert's path a policy errs with probability ${error:g}$ in each step. After its first error it is "
        f"off the path, and every later step is an error, too. How many errors do you expect in ${steps}$ steps? "
        "Give three decimals.",
        Number(
            answer,
            tolerance=0.0011,
            wrong={
                "This holds if each error is repaired at once.": error * steps,
                "This is the bound of the theorem. It counts all steps for each first error.": error
                * steps**2,
                "This is the probability of at least one error.": terms[-1],
            },
        ),
        f"Step $t$ is an error unless all steps up to it were right: $1 - {right:g}^t$. "
        f"${' + '.join(f'{term:.4g}' for term in terms)} = {answer:.3f}$.",
    )


@drill("lfd-results", "How many examples has DAgger?")
def dagger_examples(rng: Rng) -> Question:
    """Count the examples that a round of DAgger trains on."""
    first = int(rng.integers(200, 500))
    added = rng.integers(150, 400, size=3)
    last = int(rng.integers(1, 4))
    answer = first + int(added[:last].sum())
    wrong = {
        "DAgger keeps the data of all rounds, the demonstrations too.": int(
            added[last - 1]
        ),
        "The policy of a round is trained after the data of this round were added.": answer
        - int(added[last - 1]),
    }
    if last < 3:
        wrong["These are data that only a later round adds."] = answer + int(
            added[last]
        )
    if last > 1:
        wrong["The demonstrations of round 0 stay in the data."] = answer - first
    terms = " + ".join(str(n) for n in (first, *added[:last]))
    return Question(
        f"The demonstrations give ${first}$ effective pairs. Rounds 1, 2 and 3 of DAgger visit ${added[0]}$, "
        f"${added[1]}$ and ${added[2]}$ more states in which the expert is asked. On how many examples is the policy "
        f"$\\pi_{last}$ trained?",
        Number(answer, tolerance=0.1, wrong=wrong),
        f"$\\pi_{last}$ is trained on the demonstrations and the data of all rounds up to {last}: ${terms} = "
        f"{answer}$.",
    )


@drill("lfd-results", "What a state adds to the data")
def labelled_state(rng: Rng) -> Question:
    """Say which example a state that the learner visits adds to DAgger's data."""
    ranges = np.full(9, FREE)
    free = rng.random() < 0.25
    if not free:
        ranges[int(rng.choice([0, 1, 8]))] = round(float(rng.uniform(4, 9)), 1)
    sensing = robot.Sensing(
        ranges[None], np.zeros((1, 9), bool), np.array([1]), np.array([False])
    )
    asked = int(robot.Reflex()(sensing, 2.0)[0]) < 0
    expert, learner = rng.choice(NAMES, size=2, replace=False)
    options = {
        f"the state, with {expert}": "No policy is asked here: nothing is in range, and the reflex acts.",
        f"the state, with {learner}": "The label is what the expert would do there, not what the learner did.",
        "nothing": "Something is in range, so the expert labels the state although the learner acted.",
    }
    if free:
        options[f"the state, with {learner}"] = options[f"the state, with {expert}"]
    right = f"the state, with {expert}" if asked else "nothing"
    wrong = {option: hint for option, hint in options.items() if option != right}
    return Question(
        f"In a round of DAgger with $\\beta = 0$ the least of the robot's nine ranges is ${ranges.min():g}$ m; its "
        f"sensors reach ${FREE:g}$ m. The "
        f"learner's network prefers {learner} in this state, and the expert {expert}. What does the step add to the "
        "training examples?",
        Choice(right, wrong),
        f"The reflex acts, because nothing is nearer than ${FREE:g}$ m, and such steps are no examples."
        if free
        else f"The robot is steered by the learner, which takes {learner}. The state is labelled with the expert's "
        f"{expert}.",
    )


@drill("lfd-results", "Who steers in which round?")
def mixture_of_rounds(rng: Rng) -> Question:
    """Compute the probabilities of the mixture that collects DAgger's data."""
    decay = float(rng.integers(10, 91)) / 100
    of_expert = bool(rng.integers(2))
    betas = beta_schedule(decay, 3)
    learner = [1 - beta for beta in betas]
    late = [decay ** (i + 1) for i in range(4)]
    steady = [max(1 - (1 - decay) * i, 0.0) for i in range(4)]

    def asked(beta: list[float]) -> list[list[float]]:
        """What is asked for, if these are the probabilities of the expert."""
        return [beta if of_expert else [1 - b for b in beta]]

    who = "expert" if of_expert else "learner"
    return Question(
        f"DAgger begins with the expert alone, and `beta_decay={decay:g}` multiplies the expert's share from round to "
        f"round. With which probability does the *{who}* choose a step's "
        "action in rounds 0 to 3? Give three decimals.",
        Table(
            [who],
            [f"round {i}" for i in range(4)],
            asked(betas),
            tolerance=0.0011,
            wrong={
                "$\\beta$ is the probability that the expert chooses.": asked(learner),
                "Round 0 is steered by the expert alone: $\\beta_0 = 1$.": asked(late),
                "$\\beta$ is multiplied by the same factor in each round.": asked(
                    steady
                ),
                "Without a decay $\\beta$ would be 0 from round 1 on. Here it is a power of the decay.": asked(
                    [1.0, 0.0, 0.0, 0.0]
                ),
            },
        ),
        f"$\\beta_i = {decay:g}^i$ is the expert's probability, and $1 - \\beta_i$ the learner's: "
        + ", ".join(f"{share:.3f}" for share in (betas if of_expert else learner))
        + ".",
    )


@drill("lfd-results", "More data, or other data?")
def share_of_other_data(rng: Rng) -> Question:
    """Split the gain of a round of DAgger by a control with equally much data."""
    few = int(rng.integers(60, 85))
    control = few + int(rng.integers(2, 10))
    aggregated = control + int(rng.integers(2, 7))
    more, other = control - few, aggregated - control
    return Question(
        f"A policy cloned from 10 demonstrations arrives in ${few}$ % of the maps, one cloned from 35 demonstrations "
        f"in ${control}$ %. After a round of DAgger in 25 maps, which began with the 10 demonstrations, it is "
        f"${aggregated}$ %. How many points come from more data, and how many from other states?",
        Table(
            ["more data", "other states"],
            ["points"],
            [[more], [other]],
            tolerance=0.1,
            wrong={
                "The two are exchanged: the control has more data from the same kind of states.": [
                    [other],
                    [more],
                ],
                "A part of the whole gain is that of the control, which has as many maps.": [
                    [more],
                    [aggregated - few],
                ],
                "The control shows that more data alone help, too.": [
                    [0],
                    [aggregated - few],
                ],
            },
        ),
        f"The control has 35 maps as well, so ${control} - {few} = {more}$ points come from more data. The states of "
        f"the learner add ${aggregated} - {control} = {other}$.",
    )


class _AtZero:
    """An encoder that gives one number, 0, for every state."""

    def __call__(self, sensing: Any) -> np.ndarray:
        return np.zeros((1, 1))


@drill("lfd-results", "A vote of neighbours")
def vote_of_neighbours(rng: Rng) -> Question | None:
    """Predict the action of a policy by nearest neighbours."""
    k = int(rng.choice([3, 5]))
    distances = np.round(np.sort(rng.uniform(0.1, 2.0, size=7)), 2)
    actions = rng.integers(3, size=7)
    names = np.array(["F", "L30", "R30"])
    votes = np.bincount(actions[:k], minlength=3)
    if np.diff(distances).min() < 0.02 or (votes == votes.max()).sum() > 1:
        return None
    at_zero: Any = _AtZero()
    states = distances[:, None].astype(np.float64)
    policy = lfd.NeighbourPolicy(states, actions, at_zero, k)
    chosen = int(policy(at_zero, rng)[0])
    everyone = np.bincount(actions, minlength=3)
    if chosen == actions[0] == everyone.argmax():
        return None  # every rule gives the same answer
    wrong = {}
    for action in range(3):
        hint = f"Fewer of the {k} nearest states have this action."
        if action == int(everyone.argmax()):
            hint = f"Only the {k} nearest states vote. This action is most frequent among all seven."
        if action == actions[0]:
            hint = "This is the action of the nearest state. The others vote, too."
        if action != chosen:
            wrong[str(names[action])] = hint
    shown = ", ".join(
        f"${d:g}$ ({names[a]})" for d, a in zip(distances, actions, strict=True)
    )
    return Question(
        "The recorded states nearest to the robot's state have these distances and actions. "
        f"{shown}. Which action does the vote of ${k}$ neighbours take?",
        Choice(str(names[chosen]), wrong, order=names.tolist()),
        f"The votes of the {k} nearest are "
        + ", ".join(f"{name} {n}" for name, n in zip(names, votes, strict=True))
        + ".",
    )


def _round(
    number: int, maps: int, before: int, visited: int, steered: int
) -> list[Line]:
    """The lines of one round of DAgger."""
    after = before + visited
    return [
        Line(
            f"In {maps} new maps the robot, steered by the policy of {steered} pairs, visits {visited} states in which "
            "a policy is asked.",
            "There must be a policy, trained on the data so far, before it can steer.",
        ),
        Line(
            f"The expert says what it would do in the {visited} states of round {number}.",
            "The states that are labelled are those that the policy of the round before visits.",
        ),
        Line(
            f"The data grow to {after} pairs.",
            "Pairs are added when the expert has labelled the states of the round, and no earlier ones are lost.",
        ),
        Line(
            f"A policy is trained on {after} pairs.",
            "A new policy is trained on all data, with those of its round.",
        ),
    ]


@drill("lfd-results", "A run of DAgger")
def order_of_dagger(rng: Rng) -> Question:
    """Put the steps of DAgger in order."""
    demonstrations, maps = int(rng.integers(5, 16)), int(rng.choice([10, 20, 25]))
    first = int(rng.integers(150, 400))
    added = [int(n) for n in rng.choice(np.arange(120, 300), size=2, replace=False)]
    lines = [
        Line(f"The expert drives {demonstrations} demonstrations.", ""),
        Line(
            f"A policy is cloned from {first} pairs.",
            "The first policy is cloned from the demonstrations, so these come first.",
        ),
        *_round(1, maps, first, added[0], first),
        *_round(2, maps, first + added[0], added[1], first + added[0]),
    ]
    asked = some_in_order(rng, lines, 5)
    return Question(
        f"A run of DAgger begins with ${first}$ pairs from demonstrations. Its rounds 1 and 2 visit ${added[0]}$ and "
        f"${added[1]}$ states in which the expert is asked. Put these lines of the run in order.",
        asked,
        f"A round of DAgger visits, labels, adds and trains. The first policy is a clone. {as_list(asked)}",
    )
