"""What the explorables of chapter 4 have to show."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.integrate import quad
from scipy.special import ndtr
from scipy.stats import norm

from robonav import mdp, networks, nnql
from robonav.nnql.reward import TABLE
from robonav.nnql.updates import RESCALE
from robonav.robot import Sensing
from robonav.robot._fast import RUNNING
from robonav.style import BLUE, GREEN, GREY, ORANGE, VERMILION

from .reader import choose, slide, slide_all
from .shown import Shown
from .table import expects


def listed(numbers: np.ndarray) -> str:
    """Numbers with commas between them."""
    return ", ".join(str(float(number)) for number in numbers)


@expects(choose("rescaled by", "shifting and dividing"), by_keyboard=[slide_all])
def one_q_update(shown: Shown) -> None:
    q = np.array([0.2, 0.9, 0.5, 0.4, 0.6])
    target = shown.number("new target of the second action")
    how = {"clipping": "clip", "shifting and dividing": "shift"}
    updated = nnql.q_targets(q, 1, target, 0.0, 1.0, 0.0)
    learned = RESCALE[how[shown.chosen("rescaled by")]](updated)
    moved = (abs(learned - q) > 1e-9)[[0, 2, 3, 4]].sum()
    shown.says(
        f"The new target of L30 is {target}.",
        f"The network learns: {listed(learned)}.",
        f"The targets of {moved} other actions differ from their values"
        if moved
        else "The targets of the other actions equal their values.",
    )
    for colour, values in ((GREY, q), (BLUE, updated), (ORANGE, learned)):
        shown.picture().has_bars(colour, values, thinnest=0.5)


@expects(choose("the action trained, in state A", "action 3"), by_keyboard=[slide_all])
def moving_together(shown: Shown) -> None:
    action = int(shown.number("the action trained, in state A")) - 1
    target, steps = (
        shown.number("its target"),
        int(shown.number("steps of gradient descent")),
    )
    states = np.array([[1.0, 0.3], [0.6, 0.8]])
    first = network = networks.random_network((2, 4, 3), seed=8)
    for _ in range(steps):
        wanted = network.forward(states[0])
        wanted[action] = target
        network = nnql.train_on_pairs(network, [states[0]], [wanted], 1.0, 1, 0.0)
    before, after = first.forward(states), network.forward(states)
    change = after - before
    shown.says(
        f"State A: action {action + 1} changed by {change[0, action]}.",
        f"State B: the actions changed by {listed(change[1])}.",
    )
    for state in range(2):
        shown.picture(state).has_bars(GREY, before[state])
        shown.picture(state).has_bars(BLUE, after[state])


def at_distance(nearest: float) -> Sensing:
    """What a robot senses whose sensors all read the same."""
    nowhere = np.zeros((1, 9), dtype=bool)
    return Sensing(np.full((1, 9), nearest), nowhere, np.array([1]), nowhere[:, 0])


@expects(
    slide("nearest thing before the step", 0.4),
    slide("nearest thing after the step", 0.1),
    slide("nearest thing after the step", 0.5),
    slide("nearest thing before the step", 0.9),
)
def row_of_the_reward(shown: Shown) -> None:
    before = shown.number("nearest thing before the step")
    after = shown.number("nearest thing after the step")
    states = at_distance(before), at_distance(after)
    (row,) = nnql.reward_row(*states, np.array([RUNNING]))
    was, now = (nnql.Property(nnql.state_property(state)[0]) for state in states)
    shown.says(
        f"Before: {before} m, {was.name.lower()}. After: {after} m, {now.name.lower()}.",
        f"Nearer by {max(0, int(np.floor(before - after)))} whole metres.",
        f"The reward is {TABLE[row].reward}.",
    )
    _, *rows = shown.contents["rows"]
    for words, own in zip(rows, TABLE, strict=True):
        assert words[:2] == [f"{own.before} → {own.after}", own.condition or "anywhere"]
        assert words[2] == f"{own.reward:.1f}".replace("-", "−")
    assert shown.contents["held"] == row + 1  # the first one is the head


@expects(by_keyboard=[slide_all])
def cooling_down(shown: Shown) -> None:
    schedule = shown.number("first temperature"), shown.number("last temperature")
    values = np.array([shown.number("lead of the best action"), 0, 0, 0, 0])
    temperatures = nnql.geometric_schedule(schedule, np.arange(300) / 299)
    taken = nnql.softmax_policy(np.tile(values, (300, 1)), temperatures)[:, 0]
    episode = int(shown.number("episode"))
    shown.says(
        f"Temperature in episode {episode}: {temperatures[episode - 1]}.",
        f"The best action is taken in {100 * taken[episode - 1]} % of the decisions.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, np.column_stack([np.arange(1, 301), taken]))
    chart.has_dots(VERMILION, [[episode, taken[episode - 1]]])


@expects(by_keyboard=[slide_all])
def work_of_an_episode(shown: Shown) -> None:
    decisions = int(shown.number("decisions in the episode"))
    passes = int(shown.number("passes after each decision"))
    steps = sum(passes * pairs for pairs in range(1, decisions + 1))
    shown.says(
        f"All pairs: {passes} · {decisions} · {decisions + 1} / 2 = {steps} steps.",
        f"The latest pair alone: {passes * decisions} steps.",
    )
    chart = shown.picture()
    chart.has_dots(BLUE, [[decisions, steps / 1000]])
    chart.has_dots(ORANGE, [[decisions, passes * decisions / 1000]])


@cache
def mean_of_largest(n: int) -> float:
    """The mean of the largest of n standard normal numbers: the integral of P(largest > x), less that below 0."""
    above, _ = quad(lambda x: 1 - ndtr(x) ** n, 0, 10)
    below, _ = quad(lambda x: ndtr(x) ** n, -10, 0)
    return above - below


@expects(by_keyboard=[slide_all])
def overestimation(shown: Shown) -> None:
    error, discount = (
        shown.number("standard deviation of the errors"),
        shown.number("discount γ"),
    )
    actions = int(shown.number("actions"))
    biases = error * np.array([mean_of_largest(n) for n in range(1, 21)])
    bias = biases[actions - 1]
    rise = mdp.discounted_return(np.full(700, bias), discount)[0]  # every target again
    shown.says(
        f"Mean of the largest estimate: {bias}. True largest value: 0.",
        f"If each target adds this error, the values rise by {rise} in the end.",
    )
    chart = shown.picture()
    chart.has_curve(VERMILION, np.column_stack([np.arange(1, 21), biases]))
    (dot,) = chart.of("circle", fill=VERMILION)
    assert abs(float(dot["cx"]) - chart.x(actions)) < 1e-6
    assert abs(float(dot["cy"]) - chart.y(bias)) < 1e-3
    chart.has_curve(GREEN, [[1, 0], [20, 0]])


@expects(by_keyboard=[slide_all])
def seeds_to_tell_apart(shown: Shown) -> None:
    seeds = int(shown.number("trainings of each method"))
    difference = shown.number("true difference, in points")
    scatter = shown.number("standard deviation of single trainings")
    spread = scatter * np.sqrt(2 / np.arange(1, 65))  # of the difference of two means
    x = np.linspace(-6, 6, 241)
    right = np.interp(difference / spread, x, norm.cdf(x))  # the page has this table
    np.testing.assert_allclose(right, norm.cdf(difference / spread), atol=1e-4)
    shown.says(
        f"has the higher mean in {100 * right[seeds - 1]} % of such comparisons.",
        f"A 95 % interval of the difference is about ±{1.96 * spread[seeds - 1]} points.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, np.column_stack([np.arange(1, 65), right]))
    chart.has_dots(VERMILION, [[seeds, right[seeds - 1]]])


@expects(by_keyboard=[slide_all])
def circle_or_target(shown: Shown) -> None:
    circling = shown.number("reward of a second of circling")
    seconds, discount = (
        int(shown.number("seconds to the target")),
        shown.number("discount γ"),
    )
    ways = [np.r_[np.zeros(n), 1.0] for n in range(40)]
    target = np.array([mdp.discounted_return(way, discount)[0] for way in ways])
    circle = mdp.discounted_return(np.full(700, circling), discount)[0]
    shown.says(
        f"Target: 1 · γ^{seconds - 1} = {target[seconds - 1]}.",
        f"Circle: {circling} / (1 − γ) = {circle}.",
        "Circling has the larger return"
        if circle > target[seconds - 1]
        else "Going to the target has the larger return.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, np.column_stack([np.arange(1, 41), target]))
    chart.has_curve(VERMILION, [[1, min(circle, 2)], [40, min(circle, 2)]])
    chart.has_dots(BLUE, [[seconds, target[seconds - 1]]])


@expects(
    slide("learning rate of the first update", 0.05),
    slide("of the last update", 0.05),
    by_keyboard=[slide_all],
)
def weight_of_targets(shown: Shown) -> None:
    schedule = (
        shown.number("learning rate of the first update"),
        shown.number("of the last update"),
    )
    rates = nnql.geometric_schedule(schedule, np.arange(20) / 19)
    parts = np.zeros(21)  # of the value: one for each target, and what it began with
    parts[-1] = 1
    for update, rate in enumerate(rates):
        parts = parts + rate * (np.eye(21)[update] - parts)  # Eq. (4.9)
    shown.says(
        f"{100 * parts[19]} % of the value come from the latest target "
        f"and {100 * parts[18]} % from the one before.",
        f"as reliable as a mean of {1 / (parts**2).sum()} targets.",
        f"{100 * parts[20]} % of the value come from the initial value.",
    )
    chart = shown.picture()
    chart.has_bars(BLUE, parts[:19])
    chart.has_bars(ORANGE, parts[19])


@expects(choose("values above 1 are", "shifted and divided"), by_keyboard=[slide_all])
def values_out_of_range(shown: Shown) -> None:
    rewards, discount = np.array([0.6, 0.5, 0.4, 0.2, 0.0]), shown.number("discount γ")
    model = mdp.FiniteMDP(np.ones((5, 1, 1)), [rewards], discount)
    (values,) = model.action_values(mdp.policy_iteration(model).values)
    how = {"clipped": "clip", "shifted and divided": "shift"}
    targets = RESCALE[how[shown.chosen("values above 1 are")]](values)
    kinds, (best, second) = len(set(targets.round(6))), np.sort(targets)[:-3:-1]
    shown.says(
        f"True values: {listed(values)}.",
        f"Targets: {listed(targets)}.",
        "The network cannot distinguish any two actions."
        if kinds == 1
        else f"The value of the best action exceeds the next one by {best - second}; "
        f"the targets have {kinds} different values.",
    )
    shown.picture().has_bars(BLUE, values)
    shown.picture(1).has_bars(ORANGE, targets)
