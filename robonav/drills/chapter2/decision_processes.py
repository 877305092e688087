"""Drills of the page on decision processes."""

from __future__ import annotations

import numpy as np

from robonav import mdp

from ..question import Choice, Number, Question, Table
from ..registry import drill
from ..text import sign, terms

Rng = np.random.Generator


@drill("decision-processes", "The return of an episode")
def discounted_return(rng: Rng) -> Question:
    """Compute the return of a short episode by hand."""
    rewards = rng.integers(-3, 6, size=4).astype(float)
    discount = rng.choice([0.5, 0.8, 0.9])
    returns = mdp.discounted_return(rewards, discount)
    powers = discount ** np.arange(4)
    return Question(
        f"An episode has the rewards ${', '.join(f'{r:g}' for r in rewards)}$. "
        f"What is its return $G_0$ with $\\gamma = {discount:g}$?",
        Number(
            returns[0],
            wrong={
                "This is the sum without discount.": rewards.sum(),
                "The first reward is not discounted: its factor is $\\gamma^0 = 1$.": discount
                * returns[0],
                "This is the return after the first step, $G_1$. The first reward counts too.": returns[
                    1
                ],
                "This is the mean of the rewards. The return is a sum.": rewards.mean(),
                "The discount's power grows by one in each step; here it stays at 1 after the first.": rewards[
                    0
                ]
                + discount * rewards[1:].sum(),
            },
        ),
        f"$G_0 = {terms(rewards, powers)} = {returns[0]:.4g}$.",
    )


@drill("decision-processes", "From one return to the one before")
def return_backwards(rng: Rng) -> Question:
    """Use the recursion of the return."""
    reward, following = float(rng.integers(-4, 5)), round(float(rng.uniform(-6, 9)), 1)
    discount = rng.choice([0.5, 0.8, 0.9, 0.95])
    answer = mdp.discounted_return([reward, following], discount)[0]
    return Question(
        f"The return from step 8 on is $G_8 = {following:g}$, and step 7 gave the reward $R_8 = {reward:g}$. "
        f"What is $G_7$ with $\\gamma = {discount:g}$?",
        Number(
            answer,
            wrong={
                "The return of the next step must be discounted once.": reward
                + following,
                "The discount belongs to $G_8$. The reward $R_8$ comes at once.": following
                + discount * reward,
                "The reward $R_8$ is not discounted.": discount * (reward + following),
                "The reward $R_8$ is missing.": discount * following,
            },
        ),
        f"$G_7 = R_8 + \\gamma G_8 = {reward:g} {sign(discount * following)} = {answer:.4g}$.",
    )


def _two_states(rng: Rng) -> tuple[mdp.FiniteMDP, float, float]:
    """A model in which the only action stays in state 0 with probability p, and else ends; p and its reward."""
    stay = float(rng.integers(1, 10)) / 10
    reward = float(rng.choice([-5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, 8, 10]))
    discount = float(rng.choice([0.5, 0.6, 0.8, 0.9, 0.95]))
    model = mdp.FiniteMDP([[[stay, 1 - stay], [0, 1]]], [[reward], [0]], discount)
    return model, stay, reward


@drill("decision-processes", "The value of a state that is left at random")
def value_of_a_loop(rng: Rng) -> Question:
    """Solve Bellman's equation of a policy for one state."""
    model, stay, reward = _two_states(rng)
    discount = model.discount
    value = mdp.policy_evaluation(model, [0, 0])[0]
    return Question(
        f"In state A each step gives the reward ${reward:g}$. Then the robot stays in A with probability ${stay:g}$, "
        f"and otherwise the episode ends. What is $V(A)$ with $\\gamma = {discount:g}$?",
        Number(
            value,
            wrong={
                "The probability of staying is missing: $V = r + \\gamma V$ would hold if it always stayed.": reward
                / (1 - discount),
                "The discount is missing.": reward / (1 - stay),
                "This is one step only. After it the robot may be in A again.": reward,
                "This is two steps. The value counts all later steps, so solve the equation for $V(A)$.": reward
                * (1 + discount * stay),
                "The probability of ending stands in place of the probability of staying.": reward
                / (1 - discount * (1 - stay)),
            },
        ),
        f"$V(A) = {reward:g} + {discount:g} \\cdot {stay:g} \\, V(A)$, "
        f"so $V(A) = {reward:g} / (1 - {discount * stay:.4g}) = {value:.4g}$.",
    )


@drill("decision-processes", "Advantages of two actions")
def advantages(rng: Rng) -> Question:
    """Compute values and advantages of a policy that chooses at random."""
    q = np.round(rng.uniform(-2, 6, size=2), 1)
    probability = float(rng.choice([0.2, 0.25, 0.4, 0.7]))
    # state 0 is s, and both of its actions end the episode in state 1
    model = mdp.FiniteMDP([[[0, 1], [0, 1]]] * 2, [q, [0, 0]], discount=0.9)
    policy = np.array([[probability, 1 - probability], [1, 0]])
    value = float(mdp.policy_evaluation(model, policy)[0])
    of_a, of_b = (float(a) for a in mdp.advantage(model, policy)[0])
    return Question(
        f"A policy takes action a with probability ${probability:g}$ and action b otherwise. "
        f"$Q(s, a) = {q[0]:g}$ and $Q(s, b) = {q[1]:g}$. Fill in the state's value and both advantages.",
        Table(
            ["s"],
            ["V(s)", "A(s, a)", "A(s, b)"],
            [[value, of_a, of_b]],
            wrong={
                "The value of a policy weights the actions by its probabilities; this is the maximum.": [
                    [q.max(), q[0] - q.max(), q[1] - q.max()]
                ],
                "The actions are not equally probable.": [
                    [q.mean(), q[0] - q.mean(), q[1] - q.mean()]
                ],
                "The advantage is $Q - V$, not $V - Q$.": [[value, -of_a, -of_b]],
            },
        ),
        f"$V(s) = {probability:g} \\cdot {q[0]:g} + {1 - probability:g} \\cdot {q[1]:g} = {value:.4g}$. "
        f"An advantage is $A(s, a) = Q(s, a) - V(s)$: {of_a:.4g} and {of_b:.4g}.",
    )


FAULTS = {
    "sum": "The probabilities of a row do not sum to 1.",
    "negative": "A probability is negative.",
    "terminal": "There is no discount, and some state never reaches a terminal state.",
    "none": "It finds nothing: this is a model.",
}


def _fault(rows: list[list[float]], reward: float, discount: float) -> str:
    """What the package's check says of a model with one action, in a word."""
    try:
        mdp.FiniteMDP([rows], [[reward], [0.0]], discount)
    except ValueError as error:
        return next(word for word in FAULTS if word in str(error))
    return "none"


@drill("decision-processes", "What does the check find?")
def what_the_check_finds(rng: Rng) -> Question | None:
    """Tell whether numbers are a model of a decision process."""
    fault = str(rng.choice([*FAULTS]))
    discount = 1.0 if fault == "terminal" else float(rng.choice([0.8, 0.9, 1.0]))
    stays, returns = (int(n) / 10 for n in rng.integers(1, 10, size=2))
    ends = discount == 1 and fault != "terminal"  # then B has to be terminal
    first = [stays, round(1 - stays, 1)]
    second = [0.0, 1.0] if ends else [returns, round(1 - returns, 1)]
    rows = [first, second]
    broken = rows[int(rng.integers(1 if ends else 2))]
    if fault == "sum":
        broken[1] = round(broken[1] + float(rng.choice([-0.1, 0.1])), 1)
    if fault == "negative":
        broken[:] = [round(1 + broken[0], 1), -broken[0]]
    found = _fault(rows, 1.0, discount)
    if ends and first[1] <= 0:  # B would be terminal, but A would not reach it
        return None
    hints = {
        "sum": "Each row sums to 1.",
        "negative": "No number is below 0.",
        "terminal": "The discount is below 1, so nothing has to end."
        if discount < 1
        else "B is terminal: it returns to itself with reward 0, and A reaches it.",
        "none": f"There is a fault: {FAULTS[found][0].lower()}{FAULTS[found][1:]}",
    }
    return Question(
        f"A model has two states and one action. From A the action leads to A with probability ${first[0]:g}$ and to B "
        f"with ${first[1]:g}$, "
        f"from B to A with ${second[0]:g}$ and to B with ${second[1]:g}$. The reward is 1 in A and 0 in B, and "
        f"$\\gamma = {discount:g}$. What does the package find when it checks this model?",
        Choice(
            FAULTS[found],
            {FAULTS[word]: hints[word] for word in FAULTS if word != found},
            order=tuple(FAULTS.values()),
        ),
        f"{FAULTS[found]} The rows are ${first[0]:g}, {first[1]:g}$ and ${second[0]:g}, {second[1]:g}$.",
    )
