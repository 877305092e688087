"""What widgets answer under a kernel, asked as JupyterLab asks, at the least, the first and the largest settings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from jupyter_client.blocking import BlockingKernelClient
from jupyter_client.manager import start_new_kernel

from robonav.widgets.explorables.training import TRAININGS, Menu
from robonav.widgets.q_learning_settings import QLearningSettings

PATIENCE = 300  # seconds

MAKE = """
import numpy as np
from itertools import product
from robonav import mdp
from robonav.robot import random_worlds
from robonav.widgets.grid_lab import grid_lab, replay
from robonav.widgets.search_lab import search_lab
from robonav.widgets.training_lab import Curve, training_lab

def solve(grid, choices):
    model = grid.mdp(float(choices[0]))
    swept = mdp.value_iteration(model, 0.1, record=True)
    steps = [f"sweep {k}" for k in range(len(swept.history))]
    return {"sweeps": replay(model, swept.history, swept.policies, best=swept.values, steps=steps)}

discounts = ["0", "0.9", "0.99"]
grid = mdp.GridWorld("S . X\\n. # .\\n. . G", step_reward=-0.04)
given = {("map", discount): solve(grid, (discount,)) for discount in discounts}
grids = grid_lab({"map": grid}, {"discount": discounts}, given, solve=solve)

searches = search_lab({"none": random_worlds(1, 0, seed=1), "many": random_worlds(1, 30, seed=2)}, cells=(1.0, 10.0))

def train(choices):
    for done in range(1, 4):
        yield done, 3, {"cost": Curve(range(done), np.full(done, float(choices[0])))}

runs = {(rate,): {"cost": Curve([0, 1], [1, 0])} for rate in ("0", "1", "1e9")}
trainings = training_lab({"rate": ["0", "1", "1e9"]}, runs, step="step", measures={"cost": "J"}, train=train)
print(grids.comm.comm_id, searches.comm.comm_id, trainings.comm.comm_id)
"""
WORK = {
    "demonstrations",
    "episodes",
    "fastest",
    "iterations",
    "maps",
    "steps",
    "trainings",
}
"""Settings of explorables that say how much is to be done: they stay small."""


class Asker:
    """The page's side of a kernel."""

    def __init__(self, client: BlockingKernelClient) -> None:
        self.client = client

    def run(self, code: str) -> str:
        """What a cell prints; it must not fail."""
        printed: list[str] = []

        def hear(message: dict[str, Any]) -> None:
            assert message["msg_type"] != "error", message["content"]
            if message["msg_type"] == "stream":
                printed.append(message["content"]["text"])

        self.client.execute_interactive(code, timeout=PATIENCE, output_hook=hear)
        return "".join(printed)

    def ask(
        self, widget: str, question: dict[str, Any], until: str
    ) -> list[dict[str, Any]]:
        """What a widget says, up to an answer that holds a certain word."""
        content = {"comm_id": widget, "data": {"method": "custom", "content": question}}
        self.client.shell_channel.send(self.client.session.msg("comm_msg", content))
        answers: list[dict[str, Any]] = []
        while True:
            message = self.client.get_iopub_msg(timeout=PATIENCE)
            assert message["msg_type"] not in ("error", "stream"), message["content"]
            if (
                message["msg_type"] == "comm_msg"
                and message["content"]["data"].get("method") == "custom"
            ):
                answers.append(message["content"]["data"]["content"])
                assert "error" not in answers[-1], answers[-1]
                if until in answers[-1]:
                    return answers


@pytest.fixture(scope="module")
def kernel() -> Iterator[tuple[Asker, list[str]]]:
    manager, client = start_new_kernel(startup_timeout=PATIENCE)
    try:
        asker = Asker(client)
        yield asker, asker.run(MAKE).split()
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)


def test_every_lab_says_that_a_kernel_is_there(kernel):
    asker, widgets = kernel
    for widget in widgets:
        assert asker.ask(widget, {"ask": "kernel"}, "kernel") == [{"kernel": True}]


@pytest.mark.parametrize("discount", ["0", "0.9", "0.99"])
@pytest.mark.parametrize(
    "text",
    [".G", "S . X\n. # .\n. . G", "\n".join([". " * 12] * 11 + [". " * 11 + "G"])],
)
def test_maps_are_solved(kernel, discount, text):
    asker, (grids, *_) = kernel
    (answer,) = asker.ask(
        grids, {"ask": "solve", "text": text, "choices": [discount]}, "run"
    )
    assert len(answer["grid"]["cells"]) == answer["run"][0]["values"]["shape"][1]


@pytest.mark.parametrize("chosen", [[0, 0, 0], [1, 0, 0], [1, 2, 1]])
def test_ways_are_found(kernel, chosen):
    asker, (_, searches, _) = kernel
    for target in ([2, 2], [50, 90], [98, 98]):
        (answer,) = asker.ask(
            searches, {"ask": "search", "chosen": chosen, "target": target}, "run"
        )
        assert [search["kind"] for search in answer["run"]] == ["actions", "grid"]


@pytest.mark.parametrize("rate", ["0", "1", "1e9"])
def test_a_run_is_trained(kernel, rate):
    asker, (*_, trainings) = kernel
    answers = asker.ask(trainings, {"ask": "train", "choices": [rate]}, "ended")
    assert answers[-1] == {"run": 0, "ended": "Trained."}
    assert answers[-2]["done"] == answers[-2]["total"] == 3
    asker.ask(trainings, {"ask": "kernel"}, "kernel")  # it is still listening


def test_robots_learn_from_a_reward(kernel):
    asker, _ = kernel
    lab = asker.run(
        "from robonav.widgets.q_learning_lab import q_learning_lab\n"
        "learning = q_learning_lab()\n"
        "print(learning.comm.comm_id)"
    ).strip()
    settings = QLearningSettings(episodes=20, obstacles=4).for_page()
    question = {"ask": "train", "run": 7, "settings": settings, "robots": 2}
    *told, last = asker.ask(lab, question, "ended")
    live = [item for answer in told for item in answer.get("live", ())]
    assert [item["at"] for item in live] == [1, 2]
    assert told[-1]["done"] == told[-1]["total"] == 40
    assert last["run"] == 7
    assert last["ended"].startswith("2 robots cross ")
    assert asker.run("print(len(learning.trainings))").strip() == "2"


@pytest.mark.parametrize("largest", [False, True], ids=["least", "largest"])
@pytest.mark.parametrize("name", TRAININGS)
def test_an_explorable_is_trained(kernel, name, largest):
    asker, _ = kernel
    widget = asker.run(
        "from robonav.widgets.explorables import explorable\n"
        f"explored = explorable({name!r})\n"
        "print(explored.comm.comm_id)"
    ).strip()
    settings: dict[str, Any] = {}
    for key, own in TRAININGS[name].settings.items():
        if isinstance(own, Menu):
            settings[key] = own.options[-1 if largest else 0]
        else:
            settings[key] = own.stop if largest and key not in WORK else own.start
    asked = {"ask": "train", "run": 1, "settings": settings}
    ended = asker.ask(widget, asked, "ended")[-1]["ended"]
    assert ended["sentence"].endswith(".")
    assert ended["given"]
    assert int(asker.run("print(len(explored.trainings))")) > 0
