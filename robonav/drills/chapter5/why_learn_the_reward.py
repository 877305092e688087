"""Drills of the page on why a reward is learned."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from robonav import mdp, nirl
from robonav.nirl.refinement import count_pairs

from ..pictures import grid_picture
from ..question import Choice, Number, Place, Question, Table
from ..registry import drill

Rng = np.random.Generator
Floats = NDArray[np.float64]
STATES, ACTIONS = "AB", ("stay", "go")
MOVES = np.array([np.eye(2), np.eye(2)[::-1]])  # stay, go to the other state


CLEAR = 0.2  # by so much the optimal action leads


def _optimal(rewards: Floats, discount: float) -> tuple[Floats, float]:
    """The optimal policy in two states, and by how much its actions lead."""
    model = mdp.FiniteMDP(MOVES, rewards, discount)
    solution = mdp.policy_iteration(model)
    q = model.action_values(solution.values)
    return np.asarray(solution.policy), float(abs(q[:, 0] - q[:, 1]).min())


def _said(policy: Floats) -> str:
    return ", ".join(
        f"{ACTIONS[int(action)]} in {state}"
        for state, action in zip(STATES, policy, strict=True)
    )


def _kept(rng: Rng, rewards: Floats, discount: float) -> dict[str, tuple[Floats, str]]:
    """Rewards under which the same policy is optimal, each with the reason."""
    factor, constant = int(rng.integers(2, 6)), int(rng.choice([-3, -2, 2, 4, 5]))
    potential = rng.choice(np.arange(1, 9), size=2, replace=False).astype(float)
    reached = np.array([[potential[0], potential[1]], [potential[1], potential[0]]])
    given = f"$\\Phi(A) = {potential[0]:g}$ and $\\Phi(B) = {potential[1]:g}$"
    shaped = rewards + discount * reached - potential[:, None]
    return {
        f"${factor} R$": (
            factor * rewards,
            "A positive factor multiplies the values of all policies alike.",
        ),
        f"$R {'-' if constant < 0 else '+'} {abs(constant)}$": (
            rewards + constant,
            "The task never ends, so a constant adds the same sum to the values of all policies.",
        ),
        f"$R + {discount:g} \\Phi(s') - \\Phi(s)$ with {given}": (
            shaped,
            "A potential takes the same number, $\\Phi(s)$, from the values of all actions in $s$.",
        ),
    }


def _drawn_until_changed(
    draw: Callable[[], tuple[str, Floats]], policy: Floats, discount: float
) -> tuple[str, str]:
    """A reward under which another policy is clearly optimal, and this policy in words."""
    while True:
        name, rewards = draw()
        other, lead = _optimal(rewards, discount)
        if lead > CLEAR and (other != policy).any():
            return name, f"Under this reward the optimal policy is {_said(other)}."


def _changed(
    rng: Rng, rewards: Floats, policy: Floats, discount: float
) -> dict[str, str]:
    """Rewards under which another policy is optimal, each with this policy."""

    def with_one_potential() -> tuple[str, Floats]:
        a, b = rng.choice(np.arange(0, 31), size=2, replace=False)
        name = f"$R + \\Phi(s')$ with $\\Phi(A) = {a}$ and $\\Phi(B) = {b}$"
        return name, rewards + np.array([[a, b], [b, a]])

    def with_one_number() -> tuple[str, Floats]:
        i, j, number = (
            int(rng.integers(2)),
            int(rng.integers(2)),
            int(rng.integers(-20, 21)),
        )
        other = rewards.copy()
        other[i, j] = number
        name = f"$R$, but with $R({STATES[i]}, \\text{{{ACTIONS[j]}}}) = {number}$"
        return name, other

    return dict(
        _drawn_until_changed(draw, policy, discount)
        for draw in (lambda: ("$-R$", -rewards), with_one_potential, with_one_number)
    )


@drill("why-learn-the-reward", "Which rewards explain the same policy?")
def same_optimal_policy(rng: Rng) -> Question:
    """Tell which changes of a reward leave the optimal policy as it is."""
    discount = float(rng.choice([0.5, 0.8, 0.9]))
    while True:
        rewards = rng.integers(-3, 6, size=(2, 2)).astype(float)
        policy, lead = _optimal(rewards, discount)
        opposite, lead_of_opposite = _optimal(-rewards, discount)
        if min(lead, lead_of_opposite) > CLEAR and (opposite != policy).any():
            break
    kept = _kept(rng, rewards, discount)
    under = _changed(rng, rewards, policy, discount)
    which = {name: reason for name, (_, reason) in kept.items()}
    if rng.random() < 0.5:
        right = str(rng.choice(list(which)))
        asks, wrong, why = "the same policy optimal", under, which[right]
    else:
        right = str(rng.choice(list(under)))
        asks, wrong, why = "another policy optimal", which, under[right]
    table = ", ".join(
        f"$R({s}, \\text{{{a}}}) = {rewards[i, j]:g}$"
        for i, s in enumerate(STATES)
        for j, a in enumerate(ACTIONS)
    )
    return Question(
        f"Two states A and B, two actions: stay, and go to the other state. The task never ends, and $\\gamma = "
        f"{discount:g}$. {table}. The optimal policy is {_said(policy)}. Which of these rewards makes {asks}?",
        Choice(right, wrong),
        why,
    )


COSTS = {"r": -1, "g": -2, "m": -5}  # road, grass, mud
WORDS = {"r": "road", "g": "grass", "m": "mud"}
ARRIVAL = 10


def _planned(
    cells: NDArray[np.str_], target: tuple[int, int]
) -> tuple[mdp.GridWorld, Floats]:
    """The grid with a target, and the return of each first action in each cell."""
    symbols = cells.copy()
    symbols[target] = "T"
    legend = {name: mdp.Cell(reward=cost) for name, cost in COSTS.items()} | {
        "T": mdp.Cell(reward=ARRIVAL, ends=True)
    }
    grid = mdp.GridWorld("\n".join("".join(row) for row in symbols), legend=legend)
    model = grid.mdp(1.0)
    return grid, np.asarray(model.action_values(mdp.value_iteration(model).values))


@drill("why-learn-the-reward", "The target has moved")
def target_has_moved(rng: Rng) -> Question:
    """Plan again with a learned reward where a copied action goes wrong."""
    while True:
        cells = rng.choice([*COSTS], size=(3, 3), p=[0.4, 0.35, 0.25])
        start, target = (divmod(int(k), 3) for k in rng.permutation(9)[:2])
        grid, q = _planned(cells, target)
        at = int(grid.numbers[start])
        ordered = np.sort(q[at])
        if ordered[-1] - ordered[-2] > 0.5:
            break
    best = int(q[at].argmax())
    names: dict[tuple[int, int], str] = {}
    reached: dict[int, str] = {}
    for action, (down, right) in enumerate(mdp.gridworld.STEPS):
        cell = (start[0] + int(down), start[1] + int(right))
        if 0 <= cell[0] < 3 and 0 <= cell[1] < 3:
            reached[action] = names[cell] = "ABCD"[len(names)]
    old = int(rng.choice([action for action in reached if action != best]))
    wrong = {
        name: f"From S over {name} the best return is ${q[at, action]:g}$, and another way gives more."
        for action, name in reached.items()
        if action != best
    }
    wrong[reached[old]] = (
        "This is the expert's step to the old target. A copied action does not move with the target."
    )
    shown: list[list[str | None]] = [
        [f"{WORDS[kind]} {COSTS[kind]}" for kind in row] for row in cells
    ]
    shown[start[0]][start[1]] = "S"
    shown[target[0]][target[1]] = f"T +{ARRIVAL}"
    returns = ", ".join(f"{name} ${q[at, k]:g}$" for k, name in reached.items())
    said = ". ".join(
        f"Row {i + 1}: "
        + ", ".join(
            f"{text}{' (' + names[i, j] + ')' if (i, j) in names else ''}"
            for j, text in enumerate(row)
        )
        for i, row in enumerate(shown)
    )
    return Question(
        f"A step gives the learned reward of the cell that it enters: road ${COSTS['r']}$, grass ${COSTS['g']}$, mud "
        f"${COSTS['m']}$; the target gives ${ARRIVAL}$ and ends the episode. There is no discount. As long as the "
        f"target was in {reached[old]}, the expert went from S to {reached[old]}. Now the target is at T. Into which "
        "cell does a robot step from S that plans again with the same reward?",
        Place([*reached.values()], [reached[best]], wrong),
        f"The best return over each neighbour: {returns}.",
        grid_picture(shown, names=names, title=said),
    )


@drill("why-learn-the-reward", "Likelihoods of a rare and of a frequent action")
def rare_and_frequent(rng: Rng) -> Question | None:
    """Compute the likelihoods from which contradictory demonstrations are corrected."""
    here = rng.choice(np.arange(1, 21), size=2, replace=False)
    there = rng.choice([0, 5, 10, 20, 30, 50, 60], size=2, replace=False)
    if here[0] * there[1] == here[1] * there[0]:
        return None  # the likelihoods are equal
    states = np.repeat([0, 0, 1, 1], [*here, *there])
    actions = np.repeat([0, 1, 0, 1], [*here, *there])
    counts, _ = count_pairs(states, actions, 2)
    likelihood = (counts[0] / counts.sum(axis=0)).tolist()
    counted, uniform = (
        int(refine(states, actions, 2).changed[states == 0].sum())
        for refine in (nirl.most_frequent, nirl.map_uniform_prior)
    )
    other = int(here.sum()) - uniform
    share = [float(n / here.sum()) for n in here]

    def column(*numbers: float) -> list[list[float]]:
        return [[number] for number in numbers]

    return Question(
        f"In the state s forward was demonstrated {here[0]} times and left {here[1]} times. In all other states "
        f"forward was demonstrated {there[0]} times and left {there[1]} times. Compute the likelihoods "
        "$P(s \\mid a)$. Eq. (5.12) keeps the action with the largest $P(s \\mid a) P(a)$. How many decisions in s "
        "does it change if the prior $P(a)$ is uniform?",
        Table(
            [
                "$P(s \\mid \\text{forward})$",
                "$P(s \\mid \\text{left})$",
                "changed decisions",
            ],
            ["s"],
            column(*likelihood, uniform),
            wrong={
                "These are the shares $P(a \\mid s)$. A likelihood divides by all steps with the action.": column(
                    *share, uniform
                ),
                "These are the shares $P(a \\mid s)$, and the count belongs to the other action.": column(
                    *share, other
                ),
                "The decisions that agree with the likelier action stay. The others change.": column(
                    *likelihood, other
                ),
            },
        ),
        f"$P(s \\mid \\text{{forward}}) = {here[0]} / {here[0] + there[0]} = {likelihood[0]:.4g}$ and "
        f"$P(s \\mid \\text{{left}}) = {here[1]} / {here[1] + there[1]} = {likelihood[1]:.4g}$. The "
        f"larger one wins, so "
        f"{uniform} decisions change. With the counted prior the most frequent action wins, and {counted} change.",
    )


@drill("why-learn-the-reward", "Which reward did the expert have?")
def belief_over_rewards(rng: Rng) -> Question:
    """Compute the probability of a reward from demonstrated actions."""
    q = rng.choice(np.arange(0, 11), size=(2, 2)) / 10
    eta, prior = float(rng.choice([2.0, 4.0, 5.0])), float(rng.choice([0.2, 0.5, 0.8]))
    times = rng.choice([1, 2, 3, 4], size=2, replace=False)
    policy = [nirl.boltzmann_policy(values, eta) for values in q]
    likelihoods = [float(np.prod(p**times)) for p in policy]
    posterior, _ = mdp.bayes([prior, 1 - prior], likelihoods)
    answer = float(posterior[0])
    alone = likelihoods[0] / sum(likelihoods)
    once, _ = mdp.bayes([prior, 1 - prior], [float(p[0]) for p in policy])
    wrong = {
        "Only one decision counts here. Multiply the probabilities of all decisions.": float(
            once[0]
        ),
        "This is the probability of the second reward.": 1 - answer,
    }
    if prior != 0.5:
        wrong["The prior is missing."] = alone
    return Question(
        f"In a state the expert chose a {times[0]} times and b {times[1]} times. Under the reward $R_1$ the values are "
        f"$Q(a) = {q[0, 0]:g}$ and $Q(b) = {q[0, 1]:g}$, under $R_2$ they are $Q(a) = {q[1, 0]:g}$ and "
        f"$Q(b) = {q[1, 1]:g}$. The expert's policy is Boltzmann's with $\\eta = {eta:g}$. Before, $R_1$ had the "
        f"probability ${prior:g}$. Which probability does it have now?",
        Number(answer, wrong=wrong),
        f"Under $R_1$ the expert chooses a with probability {policy[0][0]:.4g}, under $R_2$ with {policy[1][0]:.4g}. "
        f"The likelihoods are ${policy[0][0]:.4g}^{times[0]} \\cdot {policy[0][1]:.4g}^{times[1]} = "
        f"{likelihoods[0]:.4g}$ and ${policy[1][0]:.4g}^{times[0]} \\cdot {policy[1][1]:.4g}^{times[1]} = "
        f"{likelihoods[1]:.4g}$. By Bayes' rule ${prior:g} \\cdot {likelihoods[0]:.4g}$ is divided by the sum of both "
        f"products: {answer:.4g}.",
    )


@drill("why-learn-the-reward", "A reward that is linear in features")
def linear_reward(rng: Rng) -> Question:
    """Compute the reward of each action from the weights."""
    danger, turned = (float(n) for n in rng.integers(0, 8, size=2))
    theta = rng.choice([-2.0, -1.0, -0.5, 0.5, 1.0, 2.0], size=(2, 2))
    features = np.zeros((1, 2, 4))
    for action in range(2):
        features[0, action, 2 * action : 2 * action + 2] = danger, turned
    task = nirl.RewardFreeMDP(np.ones((2, 1, 1)), features, 0.9, np.ones(1))
    answer = task.with_reward(theta.ravel()).rewards[0]
    all_blocks = float(theta.sum(axis=0) @ [danger, turned])
    f, left = (f"({a:g}, {b:g})" for a, b in theta)
    swapped = theta[:, ::-1] @ [danger, turned]
    return Question(
        f"A state has the features ${danger:g}$ and ${turned:g}$. They stand in the block of the action that is taken, "
        f"and the other block is 0. The weights of the block F are ${f}$, those of the block L30 "
        f"${left}$. What are the "
        "rewards of the two actions, which are linear in the features?",
        Table(
            ["reward"],
            ["F", "L30"],
            [answer.tolist()],
            wrong={
                "The blocks are exchanged.": [answer[::-1].tolist()],
                "Only the block of the action counts. The other one is 0.": [
                    [all_blocks, all_blocks]
                ],
                "The weights belong to the other feature each.": [swapped.tolist()],
            },
        ),
        f"F: ${_product(theta[0], danger, turned)} = {answer[0]:g}$. "
        f"L30: ${_product(theta[1], danger, turned)} = {answer[1]:g}$.",
    )


def _product(weights: Floats, danger: float, turned: float) -> str:
    second = f"({weights[1]:g})" if weights[1] < 0 else f"{weights[1]:g}"
    return f"{weights[0]:g} \\cdot {danger:g} + {second} \\cdot {turned:g}"
