"""The names that others rely on: signatures, results, commands, and an example for every public function."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
from dataclasses import fields
from pathlib import Path
from typing import Any

import gymnasium
import pytest
import typer.main
from numpydoc.docscrape import NumpyDocString
from numpydoc.validate import validate

import robonav
from robonav.cli import app

PUBLIC = ("mdp", "robot", "networks", "lfd", "nnql", "nirl", "planners")

# Each call: its first parameters, in order, as they may be given by position. More may follow as keywords.
CALLS = {
    "mdp.FiniteMDP": "transitions, rewards, discount",
    "mdp.value_iteration": "mdp, tolerance=1e-06",
    "mdp.policy_iteration": "mdp",
    "mdp.modified_policy_iteration": "mdp",
    "mdp.policy_evaluation": "mdp, policy",
    "mdp.q_learning": "env, episodes",
    "mdp.sarsa": "env, episodes",
    "mdp.monte_carlo_control": "env, episodes",
    "mdp.POMDP": "mdp, observations",
    "mdp.POMDP.update": "self, belief, action, observation",
    "robot.random_worlds": "n, obstacles=10, moving=0",
    "robot.navigate": "policy, worlds, speed=2.0, max_steps=500, record_paths=False",
    "lfd.plan": "world",
    "lfd.plan_on_grid": "world",
    "lfd.demonstrate": "worlds",
    "lfd.learn_policy": "demonstrations, hidden=8, regularisation=1.0, iterations=300, seed=0",
    "nnql.train": "method='nnql', seeds=16, episodes=300",
    "nirl.learn": "demonstrations, method='nirl', seed=0",
}
KEYWORDS = {
    "mdp.value_iteration": {"record"},
    "mdp.policy_iteration": {"record"},
    "mdp.modified_policy_iteration": {"record"},
    "robot.random_worlds": {"seed"},
}
# Readable functions that stand beside the dispatching `train` and `learn`.
READABLE = [
    "nnql.nnql",
    "nnql.online",
    "nnql.nfq",
    "nnql.dqn",
    "lfd.behaviour_cloning",
    "lfd.dagger",
    "nirl.nirl",
    "nirl.apprenticeship",
    "nirl.relative_entropy",
    "nirl.scirl",
]
RESULTS = {
    "mdp.Solution": {"values", "policy", "iterations", "history"},
    "robot.Navigation": {"outcome", "success", "collision", "steps", "paths"},
    "lfd.Plan": {"found", "points", "headings", "actions", "length", "expanded"},
    "lfd.GridPlan": {"found", "points", "length", "expanded"},
}
COMMANDS = {
    "reproduce": {"--json", "--scale", "--backend", "--scheduler"},
    "navigate": {"--method", "--obstacles", "--moving", "--speed", "--worlds", "--seed", "--json"},
    "grade": {"--out"},
    "check": set(),
    "leaderboard": {"--json"},
    "exercises": set(),
}  # fmt: skip


def found(name: str) -> Any:
    """A public object by its name without ``robonav.``."""
    package, *rest = name.split(".")
    thing: Any = importlib.import_module(f"robonav.{package}")
    for part in rest:
        thing = getattr(thing, part)
    return thing


def written(parameter: inspect.Parameter) -> str:
    if parameter.default is inspect.Parameter.empty:
        return parameter.name
    return f"{parameter.name}={parameter.default!r}"


@pytest.mark.parametrize("name", CALLS)
def test_signature(name: str) -> None:
    parameters = inspect.signature(found(name)).parameters.values()
    wanted = CALLS[name].split(", ")
    positional = [
        written(parameter)
        for parameter in parameters
        if parameter.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD
    ][: len(wanted)]
    if name in ("mdp.policy_iteration", "mdp.modified_policy_iteration"):
        positional = positional[:1]
    assert positional == wanted
    assert KEYWORDS.get(name, set()) <= {parameter.name for parameter in parameters}


@pytest.mark.parametrize("name", READABLE)
def test_readable_function(name: str) -> None:
    assert inspect.isfunction(found(name))


@pytest.mark.parametrize("name", RESULTS)
def test_result_attributes(name: str) -> None:
    result = found(name)
    assert RESULTS[name] <= {field.name for field in fields(result)} | set(dir(result))


@pytest.mark.parametrize("id", ["robonav/Navigation-v0"])
def test_registered_environment(id: str) -> None:
    spec = gymnasium.spec(id)
    assert spec.entry_point is not None
    assert spec.vector_entry_point is not None
    assert spec.max_episode_steps == 500


def test_commands_and_options() -> None:
    command: Any = typer.main.get_command(app)
    for name, options in COMMANDS.items():
        parameters = command.commands[name].params
        assert options <= {option for each in parameters for option in each.opts}


def test_version() -> None:
    assert (
        robonav.__version__ == importlib.import_module("robonav._version").__version__
    )


def public_callables(package: str) -> list[tuple[str, Any]]:
    module = importlib.import_module(f"robonav.{package}")
    named = [(name, getattr(module, name)) for name in module.__all__]
    return [
        (name, thing)
        for name, thing in named
        if getattr(thing, "__module__", "").startswith("robonav.")
        and (inspect.isclass(thing) or inspect.isroutine(thing))
    ]


def without_example(package: str) -> list[str]:
    """The public functions and classes of a package whose docstring has no example that runs."""
    return [
        name
        for name, thing in public_callables(package)
        if "Examples\n" not in (doc := inspect.getdoc(thing) or "") or ">>> " not in doc
    ]


@pytest.mark.parametrize("package", PUBLIC)
def test_every_public_name_has_an_example(package: str) -> None:
    assert without_example(package) == []


# numpydoc's names for: a parameter not documented, one that does not exist, the wrong order of parameters, one without
# a type, no section on what is returned, the wrong order of sections
DOCSTRING_FAULTS = {"PR01", "PR02", "PR03", "PR04", "RT01", "GL07"}


def public_functions() -> list[str]:
    """The functions in ``__all__`` of every package that is not private."""
    names: dict[Any, str] = {}
    for module in pkgutil.walk_packages(robonav.__path__, "robonav."):
        private = any(part.startswith("_") for part in module.name.split("."))
        if private or not module.ispkg:
            continue
        here = importlib.import_module(module.name)
        for name in getattr(here, "__all__", ()):
            if inspect.isfunction(getattr(here, name)):
                names.setdefault(getattr(here, name), f"{module.name}.{name}")
    return sorted(names.values())


@pytest.mark.parametrize("name", public_functions())
def test_numpydoc_finds_no_fault_in(name: str) -> None:
    faults = validate(name)["errors"]
    assert [text for code, text in faults if code in DOCSTRING_FAULTS] == []


def test_errors_and_warnings_are_explained_below_their_names() -> None:
    """With ``ValueError : if ...`` on one line, numpydoc takes the explanation for a type."""
    wrong = []
    for path in sorted(Path(robonav.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                sections = NumpyDocString(ast.get_docstring(node) or "")
                entries = [*sections["Raises"], *sections["Warns"]]
                wrong += [
                    f"{path.name}:{node.lineno} {entry.name} : {entry.type}"
                    for entry in entries
                    if entry.name or " if " in entry.type
                ]
    assert wrong == []
