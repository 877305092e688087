"""Drills of the page on deep reinforcement learning."""

from __future__ import annotations

import numpy as np
import torch

from robonav.deep import advantages, clipped_surrogate

from ..question import Choice, Number, Question, Table
from ..registry import drill

Rng = np.random.Generator
PAGE = "deep-reinforcement-learning"


def _gain_and_slope(ratio: float, advantage: float, clip: float) -> tuple[float, float]:
    """The clipped surrogate of one step, and its derivative with respect to the ratio."""
    rho = torch.tensor(ratio, dtype=torch.float64, requires_grad=True)
    gain = clipped_surrogate(rho, torch.tensor(advantage, dtype=torch.float64), clip)
    gain.backward()
    assert rho.grad is not None
    return gain.item(), rho.grad.item()


def _last_advantages(
    rewards: list[float], values: list[float], discount: float, trace_decay: float
) -> list[float]:
    """The advantages of the last steps of an episode that a collision or an arrival ends."""
    last = torch.arange(len(rewards)) == len(rewards) - 1
    found = advantages(
        torch.tensor(rewards, dtype=torch.float64),
        torch.tensor(values, dtype=torch.float64),
        torch.tensor([*values[1:], 0.0], dtype=torch.float64),
        last, last, discount, trace_decay,
    )  # fmt: skip
    return found.tolist()


@drill(PAGE, "One step of the policy gradient")
def step_of_the_gradient(rng: Rng) -> Question:
    """Compute how much one step raises the score of the action that was taken."""
    probability = float(rng.choice([0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.6]))
    advantage = float(rng.choice([-2.0, -1.5, -1.0, 1.0, 1.5, 2.0]))
    rate = float(rng.choice([0.4, 0.5, 0.8]))
    scores = torch.tensor([probability, 1 - probability], dtype=torch.float64).log()
    scores.requires_grad_()
    (advantage * scores.log_softmax(dim=0)[0]).backward()
    assert scores.grad is not None
    answer = rate * scores.grad[0].item()
    return Question(
        "The policy is the softmax of one score for each action. It chose an action of the probability "
        f"{probability:g}, whose advantage is ${advantage:g}$. Make one step of gradient ascent of the size "
        f"{rate:g} on $A \\log \\pi(a \\mid s)$. By how much does the score of this action change?",
        Number(
            answer,
            wrong={
                "The derivative of $\\log \\pi(a)$ with respect to the action's own score is $1 - \\pi(a)$.": (
                    rate * advantage * probability
                ),
                "The step of gradient ascent is missing.": answer / rate,
                "This is a step down. Gradient ascent adds the gradient.": -answer,
            },
        ),
        "The derivative of $\\log \\pi(a)$ with respect to the score of $a$ is $1 - \\pi(a)$: "
        f"${rate:g} \\cdot {_factor(advantage)} \\cdot (1 - {probability:g}) = {answer:.4g}$.",
    )


def _factor(number: float) -> str:
    """A number as a factor in a formula."""
    return f"({number:g})" if number < 0 else f"{number:g}"


@drill(PAGE, "Advantages of the last three steps")
def last_three_advantages(rng: Rng) -> Question:
    """Compute generalised advantages from the end of an episode."""
    while True:
        values = [float(v) / 10 for v in rng.choice(np.arange(1, 10), 3, replace=False)]
        end = float(rng.choice([1.0, -1.0]))
        discount, decay = 0.9, float(rng.choice([0.5, 0.8]))
        rewards = [0.0, 0.0, end]
        answer = _last_advantages(rewards, values, discount, decay)
        errors = _last_advantages(rewards, values, discount, 0.0)
        if min(abs(a - e) for a, e in zip(answer[:2], errors[:2], strict=True)) > 0.05:
            break
    following = [answer[1], answer[2]]
    return Question(
        f"The last three steps of an episode have the rewards $0$, $0$ and ${end:g}$, and their states have the values "
        f"{values[0]:g}, {values[1]:g} and {values[2]:g}. Let $\\gamma = {discount:g}$ and $\\lambda = {decay:g}$. "
        "Compute the advantages by generalised advantage estimation.",
        Table(
            rows=("advantage",),
            columns=("first step", "second step", "last step"),
            answer=[answer],
            wrong={
                "These are the errors $\\delta$ alone: add $\\gamma \\lambda$ times the next advantage.": [
                    errors
                ],
                "The factor of the next advantage is $\\gamma \\lambda$, not $\\gamma$.": [
                    _last_advantages(rewards, values, discount, 1.0)
                ],
            },
        ),
        f"The last error is ${end:g} - {values[2]:g} = {errors[2]:.4g}$, because nothing follows. From the end: "
        + "; ".join(
            f"${error:.4g} + {discount * decay:g} \\cdot {_factor(round(later, 4))} = {found:.4g}$"
            for error, later, found in reversed(
                list(zip(errors[:2], following, answer[:2], strict=True))
            )
        )
        + ".",
    )


@drill(PAGE, "The clipped gain")
def clipped_gain(rng: Rng) -> Question:
    """Compute the clipped surrogate of one step."""
    clip = float(rng.choice([0.1, 0.2, 0.3]))
    advantage = float(rng.choice([-2.0, -1.5, -1.0, 1.0, 1.5, 2.0]))
    before = float(rng.choice([0.2, 0.4, 0.5]))
    ratio = 1 + float(rng.choice([-0.6, -0.5, -0.4, 0.4, 0.5, 0.6]))
    answer, _ = _gain_and_slope(ratio, advantage, clip)
    clipped = float(np.clip(ratio, 1 - clip, 1 + clip))
    other = ({ratio * advantage, clipped * advantage} - {answer}).pop()
    return Question(
        f"An action had the probability {before:g} when it was taken, and has {before * ratio:.2g} now. Its advantage "
        f"is ${advantage:g}$, and $\\varepsilon = {clip:g}$. How large is its clipped objective?",
        Number(
            answer,
            wrong={
                "The objective takes the smaller of the two products, and this is the larger one.": other,
                "The ratio is the probability now divided by that when the action was taken.": (
                    _gain_and_slope(1 / ratio, advantage, clip)[0]
                ),
            }
            if _tells_apart(ratio, advantage, clip)
            else {
                "The objective takes the smaller of the two products, and this is the larger one.": other,
            },
        ),
        f"The ratio is ${ratio:g}$, clipped ${clipped:g}$. The smaller of ${ratio:g} \\cdot {_factor(advantage)}$ and "
        f"${clipped:g} \\cdot {_factor(advantage)}$ is ${answer:.4g}$.",
    )


def _tells_apart(ratio: float, advantage: float, clip: float) -> bool:
    """Whether the ratio upside down gives a gain of its own."""
    inverted, _ = _gain_and_slope(1 / ratio, advantage, clip)
    clipped = float(np.clip(ratio, 1 - clip, 1 + clip))
    own = (ratio * advantage, clipped * advantage)
    return min(abs(inverted - gain) for gain in own) > 0.02


RISES = "The action becomes likelier"
FALLS = "The action becomes less likely"
STAYS = "This step changes nothing"


@drill(PAGE, "Where does the gradient push?")
def push_of_the_gradient(rng: Rng) -> Question:
    """Say what gradient ascent on the clipped objective does to the probability of an action."""
    right = (RISES, FALLS, STAYS)[int(rng.integers(3))]
    while True:
        clip = float(rng.choice([0.1, 0.2, 0.3]))
        advantage = float(rng.choice([-2.0, -1.5, -0.5, 0.5, 1.5, 2.0]))
        ratio = float(rng.choice([0.4, 0.5, 0.6, 0.95, 1.05, 1.4, 1.5, 1.6]))
        gain, slope = _gain_and_slope(ratio, advantage, clip)
        if right == (RISES if slope > 0 else FALLS if slope < 0 else STAYS):
            break
    clipped = float(np.clip(ratio, 1 - clip, 1 + clip))
    gains = f"${ratio:g} \\cdot {_factor(advantage)} = {ratio * advantage:.4g}$"
    if ratio == clipped:
        why = f"The ratio lies within the bounds, so the gain is {gains}, with the gradient of $\\rho A$."
    else:
        smaller = "ratio" if gain == ratio * advantage else "clipped ratio"
        why = (
            f"The products are {gains} and "
            f"${clipped:g} \\cdot {_factor(advantage)} = {clipped * advantage:.4g}$. "
            f"The smaller one has the {smaller}, "
            + ("which does not change with the policy." if right == STAYS else "so its gradient is that of $\\rho A$.")
        )  # fmt: skip
    return Question(
        f"An action has the ratio $\\rho = {ratio:g}$ and the advantage ${advantage:g}$, and "
        f"$\\varepsilon = {clip:g}$. What does gradient ascent on the clipped objective of this step alone do?",
        Choice(
            right,
            {answer: why for answer in (RISES, FALLS, STAYS) if answer != right},
            order=(RISES, FALLS, STAYS),
        ),
        why,
    )


def _thousands(number: float) -> str:
    """A whole number in a formula, with a comma that makes no gap."""
    return f"{number:,.0f}".replace(",", "{,}")


@drill(PAGE, "How many episodes, how many steps?")
def data_of_a_training(rng: Rng) -> Question:
    """Compute how much experience an update has, and how often it is used."""
    actors = int(rng.choice([4, 8, 16, 32]))
    steps = int(rng.choice([64, 128, 256]))
    epochs, batches = int(rng.choice([3, 4, 10])), int(rng.choice([2, 4, 8]))
    updates = int(rng.choice([20, 30, 50]))
    experience = float(actors * steps * updates)
    gradient_steps = float(epochs * batches * updates)
    return Question(
        f"PPO has {actors} actors. They make {steps} steps each before an update, which goes through all steps in "
        f"{epochs} epochs of {batches} minibatches. How many steps do the actors make in {updates} updates, and how "
        "many steps does Adam make?",
        Table(
            rows=("number",),
            columns=("steps of the actors", "steps of Adam"),
            answer=[[experience, gradient_steps]],
            tolerance=0.5,
            wrong={
                "All actors count.": [[experience / actors, gradient_steps]],
                "Adam makes one step for each minibatch, not for each step of an actor.": [
                    [experience, epochs * experience]
                ],
                "Each epoch goes through all minibatches.": [
                    [experience, gradient_steps / epochs]
                ],
            },
        ),
        f"${actors} \\cdot {steps} \\cdot {updates} = {_thousands(experience)}$ steps of the actors, and "
        f"${epochs} \\cdot {batches} \\cdot {updates} = {_thousands(gradient_steps)}$ steps of Adam.",
    )
