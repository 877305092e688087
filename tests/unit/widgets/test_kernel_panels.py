"""Trainings in the kernel: what the labs of chapter 3 train in Python, and that each page that trains offers it."""

from __future__ import annotations

import re
import threading
from itertools import product
from typing import Any

import numpy as np
import pytest
import yaml

from robonav.benchmark.policies import method
from robonav.lfd import demonstrate
from robonav.networks import fit, lbfgs, random_network, toy_datasets
from robonav.robot import random_worlds
from robonav.widgets import (
    boundary_lab,
    dagger_lab,
    grid_lab,
    imitation_lab,
    key_points_lab,
    q_learning_lab,
    reward_learning,
)
from robonav.widgets.explorables import explorable
from robonav.widgets.explorables.training import TRAININGS
from robonav.widgets.kernel_training import Cancelled, Report
from robonav.widgets.shared import HERE

ROOT = HERE.parents[1]
LABS = {
    "boundary_lab": boundary_lab.BoundaryLab,
    "dagger_lab": dagger_lab.DaggerLab,
    "grid_lab": grid_lab.GridLab,
    "imitation_lab": imitation_lab.ImitationLab,
    "key_points_lab": key_points_lab.KeyPointsLab,
    "q_learning_lab": q_learning_lab.QLearningLab,
    "reward_learning": reward_learning.RewardLearning,
}


def chapter_pages() -> list[str]:
    """The playground, and the pages of chapters 2 to 5 without exercises and results."""
    parts = yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))["parts"]
    chapters = [part for part in parts if re.match(r"Chapter [2-5]", part["caption"])]
    pages = [page["file"] for part in chapters for page in part["chapters"]]
    return list(dict.fromkeys(["book/playground", *pages]))


def code_of(page: str) -> str:
    text = (ROOT / f"{page}.md").read_text("utf-8")
    return "\n".join(re.findall(r"```\{code-cell\}[^\n]*\n(.*?)\n```", text, re.DOTALL))


def widgets_on(page: str) -> list[Any]:
    """The labs of a page, as classes, and its explorables for which Python trains something."""
    code = code_of(page)
    labs = [LABS[name] for name in re.findall(rf"\b({'|'.join(LABS)})\(", code)]
    named = re.findall(r"^(\w+) = explorable\(\"(\w+)\"\)\n\1$", code, re.MULTILINE)
    explorables = [explorable(name) for _, name in named]
    return [*labs, *(widget for widget in explorables if widget.uses_kernel())]


@pytest.mark.parametrize("page", chapter_pages())
def test_a_page_offers_a_training_in_the_kernel(page):
    widgets = widgets_on(page)
    assert widgets
    for widget in widgets:
        assert "kernelPanel({" in str(widget._esm)


@pytest.mark.parametrize("name", TRAININGS)
def test_a_name_of_the_notebook_holds_what_was_trained(name):
    """The explorable that trains has a name on its page, and the text says what ``trainings`` holds."""
    call = rf"^(\w+) = explorable\(\"{name}\"\)\n\1$"
    texts = {page: (ROOT / f"{page}.md").read_text("utf-8") for page in chapter_pages()}
    (variable,) = {
        found[1] for text in texts.values() if (found := re.search(call, text, re.M))
    }
    assert any(f"`{variable}.trainings`" in text for text in texts.values())


@pytest.fixture
def told():
    """What a page is told, and a report that tells it."""
    messages: list[dict] = []
    return messages, Report(messages.append, threading.Event())


def points(messages: list[dict], name: str) -> list[float]:
    return [
        point[name]
        for message in messages
        for point in message.get("live", [])
        if name in point
    ]


def small_boundary_lab() -> boundary_lab.BoundaryLab:
    controls = {"problem": ["disc", "xor"], "hidden units": ["2"]}
    examples = {
        name: getattr(toy_datasets, name)(40, seed=0) for name in ("disc", "xor")
    }
    runs = {
        setting: fit(*examples[setting[0]], iterations=3, record=True)
        for setting in product(*controls.values())
    }
    return boundary_lab.boundary_lab(controls, runs, examples, frames=[0, 1, 20])


@pytest.mark.parametrize("how", ["gradient descent", "L-BFGS"])
def test_a_network_in_the_plane_learns_the_chosen_problem(told, how):
    messages, report = told
    lab = small_boundary_lab()
    settings = {
        "hidden": 4,
        "step": 1.0,
        "regularisation": 0.01,
        "seed": 3,
        "spread": 1.0,
    }
    ended = lab.train({"problem": 1, "method": how, "settings": settings}, report)
    (history,) = lab.trainings
    x, y = toy_datasets.xor(40, seed=0)
    start = random_network((2, 4, 1), seed=3, spread=1.0)
    np.testing.assert_array_equal(history.networks[0].weights[0], start.weights[0])
    if how == "L-BFGS":
        expected = lbfgs(start, x, y, regularisation=0.01, iterations=20)
        np.testing.assert_allclose(history.costs, expected.costs)
    assert history.costs[-1] < history.costs[0]
    assert points(messages, "cost")[-1] == history.costs[-1]
    assert messages[-1]["done"] == messages[-1]["total"] == 20
    assert len(ended["run"]["networks"]["weights"]) == 2
    assert f"{history.costs[-1]:.3f}" in ended["sentence"]


def test_experts_are_compared_by_the_robots_that_learn_from_them(told):
    messages, report = told
    lab = key_points_lab.key_points_lab(obstacles=10)
    settings = {
        "demonstrations": 3, "margin": 3.0, "caution": 2.0, "slips": 0.0,
        "hidden": 4, "regularisation": 0.1, "iterations": 5, "seed": 0,
    }  # fmt: skip
    request = {"robots": 2, "settings": settings, "demonstrations": None}
    ended = lab.train(request, report)
    shown = demonstrate(random_worlds(3, 10, seed=key_points_lab.EXPERT_SEED))
    begun = (
        f"3 demonstrations with {len(shown.effective)} steps to learn from. 2 robots"
    )
    assert ended["sentence"].startswith(begun)
    assert len(lab.trainings) == 2
    assert messages[-1]["done"] == messages[-1]["total"] == 3 + 5 + 2
    assert len(points(messages, "accuracy")) == 6


@pytest.mark.slow
def test_dagger_is_tried_round_after_round(told):
    messages, report = told
    lab = dagger_lab.dagger_lab(method("dagger"), n_worlds=10)
    settings = {"demonstrations": 1, "rounds": 2, "maps": 2, "beta": 0.0}
    sentence = lab.train({"robots": 1, "settings": settings}, report)
    (result,) = lab.trainings
    assert len(result.policies) == 3
    rates = points(messages, "arrived")
    assert len(rates) == 3
    assert sentence.startswith(f"One robot crosses {rates[-1]:.1f} % of 400 new maps.")
    assert f"it was {rates[0]:.1f} %" in sentence
    assert rates[-1] > rates[0]


@pytest.mark.slow
def test_a_cancelled_training_of_dagger_ends_at_its_next_round():
    cancelled = threading.Event()
    cancelled.set()
    lab = dagger_lab.dagger_lab(method("dagger"), n_worlds=10)
    settings = {"demonstrations": 1, "rounds": 1, "maps": 1, "beta": 0.0}
    with pytest.raises(Cancelled):
        lab.train({"robots": 1, "settings": settings}, Report(print, cancelled))
    assert lab.trainings == []
