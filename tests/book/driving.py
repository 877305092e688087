"""Driving maps in the page by keyboard, as a reader would who sees the way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from playwright.sync_api import Locator, Page

from robonav.benchmark.policies import method
from robonav.lfd import (
    ComputerExpert,
    Demonstrations,
    demonstrate,
    record_demonstrations,
)
from robonav.networks import NetworkPolicy
from robonav.robot import Simulator, Worlds, random_worlds
from robonav.widgets.robot_playground import robot_playground
from robonav.widgets.simulator import page_policy

KEYS = (
    "ArrowUp", "ArrowLeft", "Shift+ArrowLeft", "ArrowRight", "Shift+ArrowRight", "ArrowDown",
)  # fmt: skip
WAITS = """(lab) => {
  const said = lab.querySelector(".status").textContent;
  return /waits for you|Arrived|Collided/.test(said) && said;
}"""


KEEP = """(robots) => {
  robots.forEach((robot, k) => localStorage.setItem(`robonav.robot.test ${k}`, JSON.stringify(robot)));
  dispatchEvent(new StorageEvent("storage", { key: null }));
}"""


def keep_robots(page: Page, *robots: dict[str, Any]) -> None:
    """Put robots, the oldest first, where the pages keep those that the reader has trained."""
    page.evaluate(KEEP, list(robots))


def kept_robot(name: str, policy: NetworkPolicy) -> dict[str, Any]:
    """A policy as the pages keep it."""
    network, packed = policy.network, page_policy(policy)
    return {
        "name": name,
        "network": {
            "sizes": list(network.sizes),
            "weights": [weight.ravel().tolist() for weight in network.weights],
            "biases": [bias.tolist() for bias in network.biases],
        },
        "encoder": packed["encoder"],
        "temperature": packed["temperature"],
    }


def playground() -> Any:
    """A small playground."""
    learned = method("lfd")
    assert isinstance(learned, NetworkPolicy)
    return robot_playground(
        {"10 obstacles": random_worlds(1, 10, seed=41)}, {"LfD": learned}
    )


def own_map(number: int) -> Worlds:
    """The reader's map of a number."""
    return random_worlds(1, 10, seed=500_000 + number)


def good_demonstration(number: int) -> Demonstrations:
    """How a reader drives through a map who plans well."""
    return demonstrate(own_map(number))


class Wanderer:
    """A driver who turns on the spot for a while where something comes into range, and then drives well."""

    def __init__(self, turns: int = 40) -> None:
        self._left, self._expert = turns, ComputerExpert()

    def __call__(self, simulator: Simulator, robots: Any) -> Any:
        """Turn left by 60° while nothing is close and there are turns left."""
        if self._left > 0 and simulator.sense().ranges[0].min() > 5:
            self._left -= 1
            return np.full(len(robots), 2)
        return self._expert(simulator, robots)


def clumsy_demonstration(number: int) -> Demonstrations:
    """How a reader drives through a map who turns round and round."""
    return record_demonstrations(Wanderer(), own_map(number))


def keys_of(demonstration: Demonstrations) -> list[str]:
    """The keys that a demonstration takes where the robot waits."""
    return [KEYS[action] for action in demonstration.actions if action < 5]


def fast(lab: Locator) -> None:
    """As many steps a second as there may be."""
    lab.locator("input[aria-label='steps a second']").evaluate(
        "(input) => { input.value = input.max; input.dispatchEvent(new Event('input')); }"
    )


def drive_map(lab: Locator, keys: Sequence[str]) -> str:
    """Drive the reader's next map with these keys; gives what is said at the end."""
    lab.get_by_role("button", name="Drive a new map yourself").press("Enter")
    left = list(keys)
    said = lab.locator(".status").first.inner_text()
    if "waits for you" not in said:
        lab.page.keyboard.press("ArrowUp")  # off it goes
    while True:
        waiting = lab.page.wait_for_function(WAITS, arg=lab.element_handle())
        said = str(waiting.json_value())
        if "waits" not in said or not left:
            return said
        lab.page.keyboard.press(left.pop(0))
