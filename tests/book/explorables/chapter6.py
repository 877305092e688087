"""What the explorables of chapter 6 have to show."""

from __future__ import annotations

import numpy as np
import torch

from robonav.benchmark import pareto_front
from robonav.deep import (
    advantages,
    clipped_surrogate,
    deceiving_reward,
    hurrying_reward,
    log_odds,
)
from robonav.memory import GRU
from robonav.planners import (
    PotentialField,
    polar_histogram,
    potential_field,
    target_bearing,
    vector_field_histogram,
)
from robonav.planners.vector_field_histogram import DIRECTIONS, FARTHEST
from robonav.robot import Simulator, navigate
from robonav.robot.team.plain import least_distance
from robonav.sensing import picture_around, sector_ranges, shapes_of
from robonav.style import BLUE, GREEN, OBSTACLE, ORANGE, ROBOT, SKY, VERMILION

from .maps import pose_of, sensed, towards_target, world_of
from .reader import choose, keys, slide
from .robot import ending
from .shown import Shown
from .table import expects


@expects(
    slide("repulsion", 0.4),
    by_keyboard=[
        choose("move the circle", "second"),
        keys("ArrowUp ArrowUp ArrowLeft"),
        slide("inertia", 0.5),
    ],
    by_touch=[slide("inertia", 0.3)],
)
def potential_field_forces(shown: Shown) -> None:
    drawn = shown.map(50.0)
    world = world_of(shown.given["world"], drawn.circles(OBSTACLE)[:, :2].round(6))
    settings = {"repulsion": shown.number("repulsion"), "influence": 10.0}
    policy = PotentialField(**settings, inertia=shown.number("inertia"))
    result = navigate(policy, world, max_steps=120, record_paths=True)
    shown.says(ending(result, 120, "the robot still has not arrived."))
    drawn.has_line(BLUE, result.paths[0][:, :2])

    middles = np.arange(1.25, 50, 2.5)
    places = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    poses = towards_target(world, places)
    seen = sensed(world, poses)
    free = seen.ranges.min(axis=1) >= 1
    attraction, repulsions = potential_field(seen, **settings)
    force = attraction + repulsions.sum(axis=1)
    angle = poses[:, 2] + np.arctan2(force[:, 1], force[:, 0])
    tips = places + 0.8 * np.column_stack([np.cos(angle), np.sin(angle)])
    weak = np.hypot(*force.T) < 0.35
    for colour, chosen in ((VERMILION, free & weak), (SKY, free & ~weak)):
        np.testing.assert_allclose(drawn.squares(colour), tips[chosen], atol=1e-6)


@expects(
    slide("heading", 0.1),
    slide("clearance", 0.6),
    slide("threshold", 0.3),
    by_keyboard=[keys("ArrowRight ArrowRight ArrowUp")],
)
def polar_histogram_openings(shown: Shown) -> None:
    world, (x, y, heading) = world_of(shown.given["world"]), pose_of(shown)
    clearance, threshold = shown.number("clearance"), shown.number("threshold")
    seen = sensed(world, (x, y, heading))
    histogram = polar_histogram(seen.ranges, clearance=clearance, half_width=0.0)
    (bearing,) = vector_field_histogram(
        histogram, target_bearing(seen), threshold=threshold, wide=16, keep=0.2
    )
    in_order = DIRECTIONS.argsort()  # from right to left
    free = (histogram[0] < threshold) & (abs(DIRECTIONS) <= FARTHEST)
    count = (np.diff(free[in_order].astype(int)) == 1).sum()
    degrees = round(float(np.degrees(bearing)))
    side = f"{abs(degrees)}° to the {'left' if degrees > 0 else 'right'}"
    shown.says(
        "there is 1 opening" if count == 1 else f"there are {count} openings",
        "Nothing is free: the robot steps back."
        if not free.any() or degrees == 180
        else f"It goes {'straight ahead' if degrees == 0 else side}, where the red line points.",
    )
    bars, heights = shown.picture(), np.minimum(histogram[0], 3)
    bars.has_bars(GREEN, heights[free])
    bars.has_bars(ORANGE, heights[~free])
    if degrees < 180:
        way = heading + bearing
        end = (x + 8 * np.cos(way), y + 8 * np.sin(way))
        shown.map(world.size).has_line(VERMILION, [(x, y), end])


@expects(
    slide("advantage A", 0.2),
    slide("ratio ρ", 0.8),
    slide("ratio ρ", 0.2),
    slide("ε", 0.7),
    by_keyboard=[slide("advantage A", 0.7), slide("ratio ρ", 0.9)],
)
def clipped_objective(shown: Shown) -> None:
    """The gradient is torch's, of the package's own function."""
    now, advantage = shown.number("ratio ρ"), shown.number("advantage A")
    epsilon = shown.number("ε")
    corners = [0.0, round(1 - epsilon, 10), round(1 + epsilon, 10), 2.0, now]
    ratio = torch.tensor(corners, dtype=torch.float64, requires_grad=True)
    gains = clipped_surrogate(ratio, torch.full_like(ratio, advantage), epsilon)
    gains.sum().backward()
    gain, slope = gains[-1].item(), ratio.grad[-1].item()
    clipped = min(max(now, 1 - epsilon), 1 + epsilon)
    shown.says(
        f"Gain: the smaller of {now} · {advantage} and {clipped} · {advantage}, which is {gain:.9f}.",
        f"Gradient with respect to the ratio: {slope}.",
        "this step does not change the policy"
        if slope == 0
        else f"makes the action {'likelier' if slope > 0 else 'less likely'}.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, np.column_stack([corners[:4], gains[:4].detach()]))
    chart.has_dots(VERMILION, [(now, gain)])


@expects(
    slide("λ", 0.6),
    slide("discount γ", 0.4),
    by_keyboard=[choose("how the episode ends", "it collides"), slide("λ", 0.9)],
    by_touch=[choose("how the episode ends", "the time is over")],
)
def advantages_of_an_episode(shown: Shown) -> None:
    discount, trace_decay = shown.number("discount γ"), shown.number("λ")
    end = shown.chosen("how the episode ends")
    values = torch.tensor(shown.given["values"], dtype=torch.float64)
    rewards, terminal = torch.zeros_like(values), torch.zeros(len(values)) > 0
    rewards[-1] = {"it arrives": 1.0, "it collides": -1.0}.get(end, 0.0)
    terminal[-1] = end != "the time is over"
    next_values = torch.cat([values[1:], values.new_tensor([shown.given["after"]])])
    ended = torch.arange(len(values)) == len(values) - 1
    episode = (rewards, values, next_values, terminal, ended, discount)
    errors, found = (advantages(*episode, decay) for decay in (0.0, trace_decay))
    for name, numbers in (("Errors δ", errors), ("Advantages", found)):
        shown.says(f"{name}: {', '.join(f'{number:.9f}' for number in numbers)}.")
    shown.says(f"= {(discount * trace_decay) ** (len(values) - 1):.9f}.")
    for number, (colour, heights) in enumerate(((ORANGE, errors), (BLUE, found))):
        shown.picture(number).has_bars(colour, heights)


@expects(
    slide("D of every step", 0.8),
    slide("steps of the longer episode", 0.9),
    by_keyboard=[choose("reward", "log(1 − D)"), slide("D of every step", 0.5)],
    by_touch=[choose("reward", "log(1 − D) − log D")],
)
def return_under_a_judge(shown: Shown) -> None:
    """The rewards are the package's own, of the logit of D."""
    rewards = {
        "−log D": deceiving_reward,
        "log(1 − D)": hurrying_reward,
        "log(1 − D) − log D": log_odds,
    }
    d, steps = (
        shown.number("D of every step"),
        shown.number("steps of the longer episode"),
    )
    logit = torch.tensor(d, dtype=torch.float64).logit()
    reward = rewards[shown.chosen("reward")](logit).item()
    shown.says(
        f"Reward of a step: {reward:.9f}.",
        f"Return of 10 steps: {10 * reward:.9f}.",
        f"Return of {steps:.0f} steps: {steps * reward:.9f}.",
        "Both earn the same."
        if abs(reward) < 1e-9
        else f"The {'longer' if reward > 0 else 'shorter'} episode earns more.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, [(0, 0), (60, 60 * reward)])
    chart.has_dots(VERMILION, [(10, 10 * reward), (steps, steps * reward)])


@expects(
    slide("update gate z", 0.98),
    slide("window k", 0.6),
    slide("steps since the niche", 0.5),
    by_keyboard=[slide("window k", 0.1), slide("steps since the niche", 0.9)],
)
def what_a_memory_keeps(shown: Shown) -> None:
    """A unit of the package with this update gate, and inputs of 0."""
    z, k = shown.number("update gate z"), int(shown.number("window k"))
    now = int(shown.number("steps since the niche"))
    gru = GRU(1, 1, seed=0)
    with torch.no_grad():
        for weights in (gru.W, gru.U):
            weights.zero_()
        gru.b[1] = torch.tensor([z], dtype=torch.float64).logit()
        later = gru(torch.zeros(40, 1, 1).double(), torch.ones(1, 1).double())
    left = [1.0, *later[:, 0, 0].tolist()]
    shown.says(
        f"The unit keeps {z:.9f} in each step, and {left[now]:.9f} after {now} steps.",
        f"The window of {k} "
        + ("still holds" if now in range(k) else "has lost")
        + " the step beside the niche.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, list(enumerate(left)))
    chart.has_curve(ORANGE, [(0, 1), (k, 1), (k, 0), (40, 0)])
    chart.has_dots(VERMILION, [(now, left[now])])


@expects(
    slide("ahead of the first robot", 0.3),
    slide("to its left", 0.8),
    slide("heading of the second robot", 0.25),
    by_keyboard=[slide("to its left", 0.5), slide("heading of the second robot", 0.75)],
)
def nearest_moment(shown: Shown) -> None:
    """The least distance is the package's own."""
    before = np.array(
        [shown.number("ahead of the first robot"), shown.number("to its left")]
    )
    heading = np.radians(shown.number("heading of the second robot"))
    after = before + 2 * np.array([np.cos(heading), np.sin(heading)]) - [2.0, 0.0]
    nearest = float(least_distance(before, after))
    times = np.linspace(0, 1, 41)
    distances = np.hypot(*(before + times[:, None] * (after - before)).T)
    # the squared distance is a parabola
    curved, slope, _ = np.polyfit(times, distances**2, 2)
    moment = min(max(-slope / (2 * curved), 0.0), 1.0) if curved > 1e-9 else 0.0
    shown.says(
        f"At the ends the distance is {distances[0]:.9f} m and {distances[-1]:.9f} m.",
        f"{nearest:.9f} m. They {'collide' if nearest < 2 else 'pass'}.",
    )
    chart = shown.picture()
    chart.has_curve(BLUE, np.column_stack([times, distances]))
    chart.has_dots(VERMILION, [(moment, nearest)])


@expects(
    choose("sectors", "36"),
    slide("heading", 0.3),
    choose("sectors", "72"),
    by_keyboard=[
        choose("sectors", "18"),
        keys("ArrowRight ArrowRight ArrowUp ArrowRight ArrowRight"),
        slide("heading", 0.9),
    ],
)
def ring_and_picture(shown: Shown) -> None:
    """Ranges and picture are those of the readable functions."""
    world, pose = world_of(shown.given["world"]), np.array(pose_of(shown))
    sectors, shapes = int(shown.chosen("sectors")), shapes_of(Simulator(world), 0)
    ranges = sector_ranges(*shapes, pose, sectors)
    free = int((ranges >= 10).sum())
    ahead = f"reads {ranges[0]:.9f} m" if ranges[0] < 10 else "is free"
    dark = np.argwhere(picture_around(*shapes, pose, 32))
    shown.says(
        f"The sector ahead, {360 // sectors}° wide, {ahead}.",
        f"{free} of {sectors} sectors are free, together {free * 360 // sectors}° of 360°.",
        f"The picture has {len(dark)} dark cells.",
    )
    drawn = shown.map(world.size)
    arcs = [line for line in drawn.of("line", BLUE) if len(line) == 2]
    np.testing.assert_allclose([arc[1, 2] for arc in arcs], ranges, atol=1e-6)
    cells = shown.picture().of("rect", fill=OBSTACLE)
    places = [[float(cell["y"]) / 8, float(cell["x"]) / 8] for cell in cells]
    assert places == dark.tolist()
    (robot,) = drawn.of("shape", ROBOT)
    tip = pose[:2] + 2.2 * np.array([np.cos(pose[2]), np.sin(pose[2])])
    np.testing.assert_allclose(robot[0, :2], tip, atol=1e-6)


@expects(
    slide("method", 0.5),
    choose("second criterion", "no collision"),
    by_keyboard=[choose("obstacles", "30 obstacles"), slide("method", 0.9)],
    by_touch=[choose("obstacles", "10 obstacles"), slide("method", 0.2)],
)
def two_criteria(shown: Shown) -> None:
    """The front is that of the package's function, for the numbers that the explorable was given."""
    worlds, criterion = shown.chosen("obstacles"), shown.chosen("second criterion")
    second = criterion.removesuffix(" (SPL)")
    methods = shown.given["methods"]
    names = [one["name"] for one in methods]
    values = [one["values"][worlds] for one in methods]
    xy = np.array([[own["success"], own[second]] for own in values], float)
    front = np.array(names)[pareto_front(xy)]
    chosen = names.index(shown.chosen("method"))
    better = [n for n, one in zip(names, xy, strict=True) if (one > xy[chosen]).all()]
    shown.says(
        f"{names[chosen]}: {xy[chosen, 0]:.9f} % arrive, {second}: {xy[chosen, 1]:.9f} %.",
        f"Better in both: {', '.join(better)}."
        if better
        else f"No method is better than {names[chosen]} in both.",
        f"Not beaten by any: {', '.join(front)}.",
    )
    chart = shown.picture()
    chart.has_dots(BLUE, xy[pareto_front(xy)])
    chart.has_dots(VERMILION, xy[[chosen]])


@expects(
    slide("forward", 0.8),
    slide("to the left", 0.3),
    slide("turn", 0.75),
    by_keyboard=[slide("forward", 0.2), slide("turn", 0.4)],
)
def three_wheels(shown: Shown) -> None:
    """Each wheel rolls as fast as its place moves along the circle of the base."""
    forward, left, turn = (
        shown.number(name) for name in ("forward", "to the left", "turn")
    )
    speeds = []
    for degrees in (60, 180, 300):
        place = 0.7 * np.exp(1j * np.radians(degrees))
        moves = complex(forward, left) + 1j * turn * place
        along = 1j * place / abs(place)
        speeds.append((moves * along.conjugate()).real / 0.2)
    shown.says(
        f"Wheel 1, ahead to the left: {speeds[0]:.9f} rad/s.",
        f"Wheel 2, behind: {speeds[1]:.9f} rad/s.",
        f"Wheel 3, ahead to the right: {speeds[2]:.9f} rad/s.",
    )
    shown.picture().has_bars(BLUE, speeds)
