"""What the explorables of chapter 5 have to show."""

from __future__ import annotations

import numpy as np
from scipy.special import logsumexp

from robonav import mdp, nirl
from robonav.style import BLUE, GREEN, GREY, ORANGE, VERMILION
from robonav.widgets.explorables.chapter5 import TARGETS, terrain_with

from .chapter4 import listed
from .grids import Grid, grid_of
from .reader import choose, slide, slide_all
from .shown import Shown
from .table import expects


@expects(
    choose("the target stands", "top left"), choose("the learner has", "the reward")
)
def reward_transfer(shown: Shown) -> None:
    grid, task = terrain_with(TARGETS[shown.chosen("the target stands")])
    model = task.with_reward(nirl.TRUE_WEIGHTS)
    before = terrain_with(TARGETS["where it was"])[1].with_reward(nirl.TRUE_WEIGHTS)
    copied = mdp.policy_iteration(before).policy
    best = mdp.policy_iteration(model)
    inside = np.flatnonzero(~grid.terminal)
    q = model.action_values(best.values)
    still = (q[inside, copied[inside]] >= q[inside].max(axis=1) - 1e-9).sum()
    start = int(grid.start.argmax())
    shown.says(
        f"The copied action is still the best one in {still} of {len(inside)} cells.",
        f"Value of the start with the copied actions: {mdp.policy_evaluation(model, copied)[start]}.",
        f"With the best actions for the same reward: {best.values[start]}.",
    )
    policy = {"the actions": copied, "the reward": best.policy}
    own = policy[shown.chosen("the learner has")]
    arrows = Grid(shown.picture(), grid.cells.tolist()).arrows()
    assert arrows == {s: own[s] for s in inside}


@expects(by_keyboard=[slide_all, slide("forward, in this state", 0.1)])
def inconsistent_expert(shown: Shown) -> None:
    here, elsewhere = (
        np.array(
            [int(shown.number(f"{name}, {where}")) for name in ("forward", "left")]
        )
        for where in ("in this state", "elsewhere")
    )
    every, total = here + elsewhere, (here + elsewhere).sum()
    likelihood = here / np.maximum(every, 1)  # P(s | a)
    joint = here / max(total, 1)  # P(s | a) P(a)

    def meant(evidence: np.ndarray) -> str:
        forward, left = evidence
        if forward == left:
            return "either action"
        return "left" if left > forward else "forward"

    shown.says(
        f"With equally likely actions: {meant(likelihood)}.",
        f"With the actions' own frequencies as prior: {meant(joint)}.",
    )
    states = np.repeat([0, 0, 1, 1], [*here, *elsewhere])
    actions = np.repeat([0, 1, 0, 1], [*here, *elsewhere])
    for evidence, refined in (
        (likelihood, nirl.map_uniform_prior),
        (joint, nirl.most_frequent),
    ):
        if evidence[0] != evidence[1]:
            assert refined(states, actions, 2).actions[0] == evidence.argmax()
    bars = np.column_stack([likelihood, joint / (joint.max() or 1)])
    shown.picture().has_bars(BLUE, bars[0])
    shown.picture().has_bars(ORANGE, bars[1])


@expects(
    slide("discount γ", 0.3), slide("reward of mud", 0.2), slide("reward of road", 0.4)
)
def trajectory_features(shown: Shown) -> None:
    discount = shown.number("discount γ")
    weights = [shown.number(f"reward of {kind}") for kind in nirl.TERRAIN_KINDS]
    trajectories, values, sums = shown.given["trajectories"], [], []
    for trajectory in trajectories:
        features = np.eye(4)[trajectory["kinds"]]
        one_trajectory = np.zeros(len(features), dtype=int)
        mu = nirl.discounted_feature_sums(features, one_trajectory, discount)[0]
        sums.append(mu)
        values.append(nirl.value_of_expectations(weights, mu))
        shown.says(f"{trajectory['name']}: μ = ({listed(mu)}), θ·μ = {values[-1]}")
    shown.says(
        "Both are equally good."
        if abs(values[0] - values[1]) < 1e-9
        else f"Better: {trajectories[int(np.argmax(values))]['name']}."
    )
    for number, colour in enumerate((BLUE, ORANGE)):
        assert grid_of(shown).trajectory(number) == trajectories[number]["states"]
        shown.picture(1).has_bars(colour, sums[number])


@expects(by_keyboard=[slide_all])
def soft_maximum_of_three(shown: Shown) -> None:
    values = [shown.number(f"value of action {k}") for k in (1, 2, 3)]
    temperature, hard = shown.number("temperature"), max(values)
    now = nirl.soft_maximum(values, temperature) if temperature > 0 else hard
    shown.says(
        f"Hard maximum: {hard}. Soft maximum: {now}.",
        f"It is larger by {now - hard}; the most it can be larger is {temperature * np.log(3)},",
    )
    chart, temperatures = shown.picture(), np.arange(1, 121) / 40
    scaled = np.divide.outer(values, temperatures)
    curve = temperatures * logsumexp(scaled, axis=0)
    chart.has_curve(BLUE, [[0, hard], *zip(temperatures, curve, strict=True)])
    chart.has_dots(VERMILION, [[temperature, now]])


@expects(slide("direction of the reward", 0.1), by_keyboard=[slide_all])
def widest_margin(shown: Shown) -> None:
    angle = np.radians(shown.number("direction of the reward"))
    expert = np.array([shown.number(f"expert, feature {k}") for k in (1, 2)])
    others = np.random.default_rng(4).normal(size=(6, 2))
    theta = np.array([np.cos(angle), np.sin(angle)])
    lead = ((expert - others) @ theta).min()
    widest = nirl.maximum_margin(expert, others).margin
    shown.says(
        f"The expert's margin is {lead}."
        if lead > 0
        else f"The expert has no margin: the return of another policy is larger by {-lead}.",
        "The expert has a margin in no direction"
        if widest <= 0.0005
        else "This is nearly the largest possible margin."
        if lead > 0.99 * widest
        else f"The largest margin of all directions is {widest}.",
    )
    chart = shown.picture()
    chart.has_dots(ORANGE, expert)
    chart.has_dots(GREY, others)
    chart.has_curve(BLUE, [[0, 0], 1.6 * theta])


@expects(slide("policies found after the first", 0.2), slide("expert, feature 1", 0.6))
def projection_steps(shown: Shown) -> None:
    angles = 2 * np.pi * np.arange(12) / 12
    points = np.column_stack([np.cos(angles), np.sin(angles)])
    expert = np.array([shown.number(f"expert, feature {k}") for k in (1, 2)])
    policies = int(shown.number("policies found after the first"))
    mixtures, taken = [points[7]], [7]
    for _ in range(20):
        reward = expert - mixtures[-1]
        taken.append(int((points @ reward).argmax()))
        mixtures.append(nirl.project(mixtures[-1], points[taken[-1]], expert))
    distances = np.linalg.norm(expert - mixtures, axis=1)
    shown.says(
        f"Distance of the mixture to the expert: {distances[policies]}.",
        "It will not come within 0.1"
        if distances.min() > 0.1
        else "It is within 0.1."
        if policies >= (distances <= 0.1).argmax()
        else "It is not yet within 0.1.",
    )
    chart = shown.picture()
    chart.has_dots(ORANGE, expert)
    chart.has_dots(GREEN, [points[taken[policies]], mixtures[policies]])
    chart.has_curve(BLUE, [mixtures[policies], expert])


@expects(by_keyboard=[slide_all])
def boltzmann_temperature(shown: Shown) -> None:
    values = [shown.number(f"value of action {k}") for k in (1, 2, 3)]
    eta = shown.number("inverse temperature η")
    now = nirl.boltzmann_policy(values, eta)
    shown.says(
        f"Probabilities: {listed(now)}.",
        "The best action is taken at least nine times in ten."
        if now.max() >= 0.9
        else "The best action is taken less than nine times in ten.",
    )
    chart, etas = shown.picture(), np.arange(121) / 2
    curves = nirl.boltzmann_policy(np.multiply.outer(etas, values), 1.0)
    for action, colour in enumerate((BLUE, ORANGE, GREEN)):
        chart.has_curve(colour, np.column_stack([etas, curves[:, action]]))
        chart.has_dots(colour, [[eta, now[action]]])


@expects(by_keyboard=[slide_all])
def accuracy_or_balance(shown: Shown) -> None:
    forward = shown.share("the expert goes forward in")
    careful = shown.share("the careful policy predicts")
    other = (1 - forward) / 4
    counts = np.round(8000 * np.array([forward, other, other, other, other])).astype(
        int
    )
    actions = np.repeat(np.arange(5), counts)
    right = np.concatenate([np.arange(n) < round(careful * n) for n in counts])
    policies = {
        "careful": np.where(right, actions, (actions + 1) % 5),
        "always forward": np.zeros_like(actions),
    }
    bars = []
    for measure, name in (
        (nirl.accuracy, "Accuracy"),
        (nirl.balanced_accuracy, "Balanced accuracy"),
    ):
        one, two = (measure(predicted, actions) for predicted in policies.values())
        better = "careful" if one > two else "always forward"
        kept = "neither" if abs(one - two) < 1e-9 else better
        shown.says(f"{name}: {one} against {two}. Kept: {kept}.")
        bars.append([one, two])
    for number, colour in enumerate((BLUE, ORANGE)):
        shown.picture().has_bars(colour, np.array(bars)[:, number])


@expects(by_keyboard=[slide_all])
def weights_of_samples(shown: Shown) -> None:
    theta = 20 * shown.number("θ, per step to the right")
    features = np.random.default_rng(9).binomial(20, 0.5, size=50) / 20
    samples, alike = features[:, None], np.zeros(50)
    weights = nirl.importance_weights([theta], samples, alike)
    (gradient,) = nirl.dual_gradient([theta], [0.8], samples, alike, [0.0])
    shown.says(
        f"Weighted mean: {weights @ features}. The expert's: 0.8. "
        f"The gradient of the dual is their difference, {gradient}.",
        f"correspond to {1 / (weights**2).sum()} samples of equal weight.",
        f"the largest share is {features.max()}."
        if features.max() < 0.8
        else "Some samples go to the right at least as often as the expert.",
    )
    drawn = np.column_stack([features, np.minimum(weights, 0.5)])
    shown.picture().has_dots(BLUE, drawn)


@expects(by_keyboard=[slide_all])
def value_of_an_end(shown: Shown) -> None:
    reward, end = shown.number("reward of each step"), shown.number("value of an end")
    discount = shown.number("discount γ")
    values = []
    for steps in range(16):  # the end counts like this reward in each step for ever
        rewards = [reward] * steps + [end] * 500
        values.append((1 - discount) * mdp.discounted_return(rewards, discount)[0])
    shown.says(
        f"Ending now: {values[0]}. After 5 steps: {values[5]}. Never: {reward}.",
        "All times of ending have the same value."
        if abs(reward - end) < 1e-9
        else "It delays the end"
        if reward > end
        else "It tries to end the episode",
    )
    drawn = np.column_stack([np.arange(16), values])
    shown.picture().has_curve(BLUE, drawn)
    shown.picture().has_dots(BLUE, drawn)
