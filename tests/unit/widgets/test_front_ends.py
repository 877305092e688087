"""Every front end is one valid module, and asks nothing of its host but what anywidget gives everywhere."""

from __future__ import annotations

import importlib
import pkgutil
import re

import anywidget
import pytest

from robonav import widgets
from robonav.widgets.shared import HERE

SCRIPTS = sorted(HERE.rglob("*.js"))
MODEL = {"get", "on", "send"}
"""What anywidget's model has in JupyterLab, in Colab, in VS Code, and on a page without a kernel."""


def front_ends() -> dict[str, str]:
    """The module of each widget, by the name of its class."""
    found = {}
    for module in pkgutil.walk_packages(widgets.__path__, "robonav.widgets."):
        for kind in vars(importlib.import_module(module.name)).values():
            if isinstance(kind, type) and issubclass(kind, anywidget.AnyWidget):
                found[kind.__name__] = getattr(kind, "_esm", None)
    return {name: str(text) for name, text in found.items() if text}


def test_every_widget_is_one_module_without_names_that_clash(ask):
    found = front_ends()
    assert {"RobotPlayground", "ImitationLab", "QLearningLab"} <= set(found)
    for name, text in found.items():
        assert "default" in ask(text, "return Object.keys(page);", None), name


@pytest.mark.parametrize(
    "script",
    [path for path in SCRIPTS if re.search(r"\nfunction render\(", path.read_text())],
    ids=lambda path: path.stem,
)
def test_every_widget_has_a_name_for_screen_readers(script):
    assert script.read_text("utf-8").count("asWidget(el, ") == 1


@pytest.mark.parametrize(
    "sheet", sorted(HERE.rglob("*.css")), ids=lambda path: path.stem
)
def test_styles_do_not_depend_on_their_order(sheet):
    """Each widget of a page brings ``shared.css`` anew, so a widget's own rules must be stronger than those."""
    text = re.sub(r"/\*[\s\S]*?\*/|@media[^{]*\{", "", sheet.read_text("utf-8"))
    for selector in re.findall(r"([^{}]+)\{", text):
        assert selector.strip().startswith(".robonav"), selector


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_nothing_depends_on_jupyterlab(script):
    text = re.sub(r"--jp-[\w-]+", "", script.read_text("utf-8"))  # colours
    code = re.sub(r"//.*|/\*[\s\S]*?\*/", "", text)
    if (
        "model, el }" in code or script.stem == "kernel_panel"
    ):  # elsewhere, a decision process
        assert set(re.findall(r"\bmodel\.(\w+)", code)) <= MODEL
    assert not re.search(r"jupyter|lumino|requirejs|\brequire\(|\bimport ", code, re.I)
