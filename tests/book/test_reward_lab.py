"""The reward lab, used as a reader would, and its numbers compared with Python's."""

from __future__ import annotations

import re

import numpy as np
import pytest
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.lfd import demonstrate
from robonav.nirl import ENCODER, expert_decisions
from robonav.nirl.decisions import add_constant
from robonav.robot import navigate, random_worlds
from robonav.widgets.reward_lab import reward_lab

SHOWN = expert_decisions(demonstrate(random_worlds(6, 20, seed=3)))
THETA = np.linalg.lstsq(SHOWN.features, np.eye(5)[SHOWN.actions], rcond=None)[0].T
WORLDS = {"one": random_worlds(1, 20, seed=5), "another": random_worlds(1, 20, seed=9)}
OTHERS = random_worlds(10, 20, seed=6)


@pytest.fixture
def lab(visit, place):
    yield mounted(visit, place, reward_lab(THETA, ENCODER, SHOWN, WORLDS, OTHERS))
    assert visit.errors == []


def choose(lab: Locator, label: str, option: str) -> None:
    lab.get_by_label(label, exact=True).select_option(option)


def driven(theta, worlds):
    """How a robot ends that takes what the reward likes best."""

    def policy(sensing, rng):
        return (add_constant(ENCODER(sensing)) @ theta.T).argmax(axis=1)

    return navigate(policy, worlds, max_steps=200)


def shows(lab: Locator, theta: np.ndarray, world: str) -> None:
    """The lab says of this reward what Python says."""
    here, there = driven(theta, WORLDS[world]), driven(theta, OTHERS)
    verbs = {
        "arrived": "arrives after",
        "collided": "collides after",
        "out of steps": "is still on its way after",
    }
    ended = f"With this reward the robot {verbs[here.outcome[0]]} {here.steps[0]} s."
    expect(lab.locator(".status")).to_contain_text(ended)
    agreed = 100 * np.mean((SHOWN.features @ theta.T).argmax(axis=1) == SHOWN.actions)
    score = lab.locator("p.told")
    expect(score).to_contain_text(
        f"is the expert's in {agreed:.1f} % of {len(SHOWN)} decisions"
    )
    counted = [int((there.outcome == end).sum()) for end in verbs]
    expect(score).to_contain_text(
        f"Of 10 other maps the robot arrives in {counted[0]}, collides in {counted[1]} "
        f"and does not arrive in time in {counted[2]}."
    )


def push(lab: Locator, step: int) -> None:
    lab.get_by_label("change this weight", exact=True).and_(
        lab.locator("input")
    ).evaluate(
        "(input, step) => { input.value = step; input.dispatchEvent(new Event('input')); }",
        step,
    )


def test_rewards_drive_as_in_python(lab):
    danger = slice(0, len(ENCODER.sensors))
    walls = slice(ENCODER.size - len(ENCODER.sensors), ENCODER.size)
    shows(lab, THETA, "one")
    choose(lab, "map", "another")
    shows(lab, THETA, "another")
    fearless = THETA.copy()
    fearless[:, danger] = fearless[:, walls] = 0
    for attempt, theta in (
        ("all weights 0", 0 * THETA),
        ("weights of dangers and walls 0", fearless),
        ("opposite sign of all weights", -THETA),
    ):
        choose(lab, "begin with the reward", attempt)
        shows(lab, theta, "another")


def test_weights_are_changed_one_by_one_and_for_all_actions(lab):
    strongest = abs(THETA).max()
    choose(lab, "weight of", "danger in sector 1")
    choose(lab, "for", "F")
    push(lab, 40)
    changed = THETA.copy()
    changed[0, 0] += strongest
    shows(lab, changed, "one")
    choose(lab, "weight of", "constant")
    choose(lab, "for", "L60")
    push(lab, 30)
    changed[2, -1] += strongest / 2
    shows(lab, changed, "one")
    choose(lab, "for", "all actions")
    choose(lab, "weight of", "target ahead")
    push(lab, 0)
    changed[:, len(ENCODER.sensors) + 1] -= strongest
    shows(lab, changed, "one")
    lab.get_by_role("button", name="Undo all changes").click()
    shows(lab, THETA, "one")


def test_a_touched_weight_is_in_hand(lab):
    picture = lab.locator("svg.weights")
    picture.locator("rect").nth(2 * (ENCODER.size + 1) + 3).click()
    expect(lab.get_by_label("for", exact=True)).to_have_value("L60")
    expect(lab.get_by_label("weight of", exact=True)).to_have_value(
        "danger in sector 4"
    )
    expect(picture).to_have_attribute(
        "aria-label", re.compile("danger in sector 4 is marked")
    )


def test_the_episode_can_be_stepped_through(lab):
    lab.get_by_label("To the start").click()
    expect(lab.locator(".status")).to_contain_text("Second 0: ")
    lab.get_by_label("One on").click()
    expect(lab.locator(".status")).to_contain_text("Second 1: ")
    lab.get_by_label("Play").click()
    expect(lab.locator(".status")).not_to_contain_text("Second 1: ")
    choose(lab, "looks ahead", "2 decisions")
    expect(lab.locator("p.told")).to_contain_text("Of 10 other maps")


def test_colours_show_the_reward_of_an_action_or_of_the_best(lab):
    before = picture(lab)
    choose(lab, "colours show the reward of", "L60")
    after = picture(lab)
    assert after != before
    choose(lab, "colours show the reward of", "F")
    assert picture(lab) == before


def picture(lab: Locator) -> str:
    expect(lab.locator("p.told")).to_contain_text("Of 10 other maps")
    return lab.locator("canvas").evaluate("(canvas) => canvas.toDataURL()")
