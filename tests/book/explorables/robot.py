"""What the explorables of the robot and of its playground have to show."""

from __future__ import annotations

import numpy as np

from robonav.robot import (
    Action,
    Navigation,
    Reflex,
    Sensing,
    concatenate_worlds,
    degree_of_danger,
    make_world,
    navigate,
    random_worlds,
    turn_to_clearer_side,
)
from robonav.style import BLUE, GREEN, ROBOT, SKY, VERMILION

from .maps import pose_of, sensed, towards_target, world_of
from .reader import choose, keys, press, slide
from .shown import Shown
from .table import expects

SAFE, ASKED, BLOCKED, HIT = range(4)


@expects(
    slide("heading", 0.7),
    press("Turn 40° left"),
    by_keyboard=[keys("ArrowRight ArrowRight ArrowDown")],
)
def sensor_sectors(shown: Shown) -> None:
    world, (x, y, heading) = world_of(shown.given["world"]), pose_of(shown)
    seen = sensed(world, (x, y, heading))
    (ranges,), degrees = seen.ranges, degree_of_danger(seen.ranges)[0]
    _, metres, danger = shown.contents["rows"]
    assert metres[1:] == [f"{r:.1f}" if r < 10 else "10" for r in ranges]
    assert danger[1:] == [str(degree) for degree in degrees]
    at, region = ranges.argmin(), seen.target_region[0]
    what = "to the border of the map" if seen.walls[0, at] else "to an obstacle"
    shown.says(
        f"Sensor {at + 1} reads least: {ranges[at]} m, {what}, degree of danger {degrees[at]}."
        if ranges[at] < 10
        else "Nothing is within 10 m: all sensors read 10 m.",
        f"The target is in sector {region}.",
    )
    drawn = shown.map(world.size)
    sectors = [line for line in drawn.of("line", BLUE) if len(line) == 2]
    np.testing.assert_allclose([sector[1, 2] for sector in sectors], ranges, atol=1e-6)
    tip = np.array([x, y]) + 2.2 * np.array([np.cos(heading), np.sin(heading)])
    (robot,) = drawn.of("shape", ROBOT)
    np.testing.assert_allclose(robot[0, :2], tip, atol=1e-6)


@expects(
    choose("the sensors see", "6 m"), slide("speed", 0.9), choose("obstacles", "30")
)
def reflex_map(shown: Shown) -> None:
    world = random_worlds(1, int(shown.chosen("obstacles")), seed=41)
    sight, speed = shown.number("the sensors see"), shown.number("speed")
    middles = np.arange(1.0, 100, 2)
    places = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    seen = sensed(world, towards_target(world, places))
    nearest = seen.ranges.min(axis=1)
    near = Sensing(
        np.where(seen.ranges < sight, seen.ranges, 10.0),
        seen.walls,
        seen.target_region,
        seen.target_seen,
    )
    blocked = Reflex()(near, speed) == Action.B
    kinds = np.select(
        [nearest < 1, nearest >= sight, blocked], [HIT, SAFE, BLOCKED], ASKED
    )
    shares = [100 * (kinds == kind).sum() / (kinds != HIT).sum() for kind in range(3)]
    shown.says(
        f"it goes to the target by itself in {shares[SAFE]} %,",
        f"the policy decides in {shares[ASKED]} %,",
        f"it steps back by itself in {shares[BLOCKED]} %.",
    )
    drawn = shown.map(world.size)
    for kind, colour in enumerate((GREEN, SKY, VERMILION)):
        np.testing.assert_allclose(
            drawn.squares(colour), places[kinds == kind], atol=1e-6
        )


@expects(
    choose("turns when something ahead is nearer than", "10 m"), slide("speed", 0.5)
)
def speed_and_sight(shown: Shown) -> None:
    speed = shown.number("speed")
    near = shown.number("turns when something ahead is nearer than")
    worlds = concatenate_worlds(
        [
            make_world([(50, 50, 4)], start=(10 + k * speed / 40, 50), target=(90, 50))
            for k in range(40)
        ]
    )

    def policy(sensing: Sensing, rng: np.random.Generator) -> np.ndarray:
        return np.where(sensing.ranges[:, 0] < near, Action.L60, Action.F)

    result = navigate(policy, worlds, speed, max_steps=400, record_paths=True)
    shown.says(
        f"{result.collision.sum()} of 40 episodes collide.",
        f"In one second the robot goes {speed} m",
        f"as late as {max(0, near - speed)} m away.",
    )
    drawn = shown.map(worlds.size)
    for path, collides in zip(result.paths, result.collision, strict=True):
        drawn.has_line(VERMILION if collides else BLUE, path[:, :2])


def ending(result: Navigation, after: int, unfinished: str) -> str:
    """How the only episode ended, in the page's words."""
    if result.success[0]:
        return f"arrives after {result.steps[0]} s."
    if result.collision[0]:
        return f"collides after {result.steps[0]} s."
    return f"After {after} s {unfinished}"


@expects(slide("depth of the pocket", 0.6), slide("width of the pocket", 0.7))
def pocket(shown: Shown) -> None:
    depth, width = (
        shown.number("depth of the pocket"),
        shown.number("width of the pocket"),
    )
    sides = (width / 2 + 1, -width / 2 - 1)
    arms = [(60 - depth / 2, 50 + side, depth, 2, 0) for side in sides if depth > 0]
    walls = [(60, 50, 2, width + 4, 0), *arms]
    world = make_world(rectangles=walls, start=(20, 50), target=(90, 50))
    result = navigate(
        turn_to_clearer_side,
        world,
        max_steps=300,
        record_paths=True,
        reflex=Reflex("exact"),
    )
    shown.says(ending(result, 300, "it is still going to and fro."))
    colour = BLUE if result.success[0] else VERMILION
    shown.map(world.size).has_line(colour, result.paths[0][:, :2])
