"""The names that others rely on: signatures, results, commands, and an example for every public function."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from dataclasses import fields
from enum import Enum
from itertools import chain
from pathlib import Path
from typing import Any, Protocol

import gymnasium
import pytest
import typer.main
from numpydoc.docscrape import NumpyDocString
from numpydoc.validate import validate

import robonav
from robonav.cli import app

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
BOOK = Path(__file__).resolve().parents[2] / "book"
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
    "deep.ppo",
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


def public_packages() -> list[str]:
    """The packages, none of them private, that name what is public in ``__all__``."""
    walked = pkgutil.walk_packages(robonav.__path__, "robonav.")
    public = [m.name for m in walked if m.ispkg and "._" not in m.name]
    return [
        name for name in public if hasattr(importlib.import_module(name), "__all__")
    ]


def public_callables(package: str) -> dict[str, Any]:
    """The functions, classes and methods that a package offers, by their whole names."""
    here, found = importlib.import_module(package), {}
    for name in here.__all__:
        thing = getattr(here, name)
        if getattr(thing, "__module__", "").startswith("robonav."):
            if inspect.isroutine(thing) or inspect.isclass(thing):
                found[f"{package}.{name}"] = thing
            for part, method in vars(thing).items() if inspect.isclass(thing) else ():
                bare = getattr(method, "__func__", method)
                if inspect.isfunction(bare) and not part.startswith("_"):
                    found[f"{package}.{name}.{part}"] = bare
    return found


def own_functions(package: str) -> dict[str, Any]:
    """The functions of a package's files, by their whole names."""
    found = {}
    for module in pkgutil.iter_modules(importlib.import_module(package).__path__):
        here = importlib.import_module(f"{package}.{module.name}")
        for name, thing in vars(here).items():
            own = getattr(thing, "__module__", "") == here.__name__
            if own and inspect.isfunction(thing) and not name.startswith("_"):
                found[f"{here.__name__}.{name}"] = thing
    return found


def drawings(package: str) -> dict[str, Any]:
    """The functions of ``plots`` that draw what they are given. Others draw one experiment, from its ``results``."""
    return {
        name: function
        for name, function in own_functions(package).items()
        if "results" not in inspect.signature(function).parameters
    }


def widgets_of_pages(package: str) -> dict[str, Any]:
    """The functions that make a page's widget: each has the name of its file."""
    return {
        name: function
        for name, function in own_functions(package).items()
        if name.split(".")[-1] == name.split(".")[-2]
    }


def parts_of_pages(package: str) -> dict[str, Any]:
    """The functions of a package that the code cells of the book's pages import from its files."""
    named = rf"^from ({package}[\w.]*) import ([\w, ]+)$"
    pages = [page.read_text("utf-8") for page in sorted(BOOK.glob("*.md"))]
    imports = [each for page in pages for each in re.findall(named, page, re.MULTILINE)]
    found = {}
    for module, names in imports:
        for name in names.split(", "):
            thing = getattr(
                importlib.import_module(module), name.split(" as ")[0], None
            )
            if inspect.isfunction(thing):
                found[f"{module}.{thing.__name__}"] = inspect.unwrap(thing)
    return found


# What is public, by package: what is in ``__all__``, what draws, and what pages use
DOCUMENTED = dict.fromkeys(public_packages(), public_callables)
DOCUMENTED["robonav.plots"] = drawings
DOCUMENTED["robonav.widgets"] = widgets_of_pages
DOCUMENTED["robonav.experiments.chapter"] = parts_of_pages
DOCUMENTED["robonav.experiments.runner"] = parts_of_pages


# numpydoc's names for: a parameter that does not exist, the wrong order of parameters, one without a type, no section
# on what is returned, more than the type on its first line, the wrong order of sections, a summary that does not end
# with a period, no section of examples
DOCSTRING_FAULTS = {"PR02", "PR03", "PR04", "RT01", "RT02", "GL07", "SS03", "EX01"}


def docstring_faults(name: str, thing: Any) -> Iterator[str]:
    """Yield what numpydoc, or this project, has against a docstring."""
    for code, text in validate(name)["errors"]:
        if code in DOCSTRING_FAULTS:
            yield f"{name}: {text}"
    docstring = inspect.getdoc(thing) or ""
    if ">>> " not in docstring:
        yield f"{name}: no example that runs"
    for parameter in undocumented(thing, NumpyDocString(docstring)):
        yield f"{name}: {parameter} is not documented"


def undocumented(thing: Any, docstring: NumpyDocString) -> set[str]:
    """The parameters that a docstring leaves out. A dataclass names its fields as attributes."""
    if inspect.isclass(thing) and issubclass(thing, Enum | Protocol):
        return set()  # nobody makes one
    sections = ("Parameters", "Other Parameters", "Attributes")
    entries = [entry.name for section in sections for entry in docstring[section]]
    named = {name.strip("* ") for entry in entries for name in entry.split(",")}
    return set(inspect.signature(thing).parameters) - {"self", "cls"} - named


@pytest.mark.parametrize("package", DOCUMENTED)
def test_numpydoc_finds_no_fault_in(package: str) -> None:
    public = DOCUMENTED[package](package)
    faults = [docstring_faults(*named) for named in public.items()]
    assert list(chain(*faults)) == []


# The words of a type. A shape stands in parentheses, a choice of strings in braces, and classes have capital letters.
TYPE_WORDS = re.compile(
    "arrays?|bools?|bytes|callable|default|dict|floats?|function|ints?|iterable|list|mappings?|matri(x|ces)|module|"
    "numbers|object|of|optional|or|and|pair|path|probabilities|sequences?|slice|sparse|str|tensor|to|tuple|two|uint32|"
    r"\d+"
)
NOT_A_WORD = re.compile(
    r"\((?:[^()]|\([^()]*\))*\)|\{[^}]*\}|\"[^\"]*\"|[A-Z]\w*|\w+(?:\.\w+)+"
)


def prose_in(kind: str) -> list[str]:
    """The words of a type that belong into the description, and commas, which stand in lists of types."""
    alone = re.sub(r", (optional|default .*)$", r" \1", NOT_A_WORD.sub(" ", kind))
    words = re.findall(r"[^\s,]+|,", alone)
    return [word for word in words if not TYPE_WORDS.fullmatch(word)]


@pytest.mark.parametrize(
    ("kind", "prose"),
    [
        ("float", []),
        ("(S,) array of ints or (S, A) array of probabilities", []),
        ('{"shift", "clip"}, optional', []),
        ("int or numpy.random.Generator", []),
        ("sequence of (s[l + 1], s[l]) arrays", []),
        ("largest loss of value", ["largest", "loss", "value"]),
        ("(S,) the policy", ["the", "policy"]),
        ("int, float", [","]),  # of two parameters in one entry
    ],
)
def test_prose_in_type(kind: str, prose: list[str]) -> None:
    assert prose_in(kind) == prose


@pytest.mark.parametrize("package", DOCUMENTED)
def test_types_are_types(package: str) -> None:
    wrong = []
    for name, thing in DOCUMENTED[package](package).items():
        sections = NumpyDocString(inspect.getdoc(thing) or "")
        for section in ("Parameters", "Attributes", "Returns", "Yields"):
            for entry in sections[section]:
                typed = bool(entry.type) or entry.name.startswith("*")
                if not typed or prose_in(entry.type):
                    wrong.append(f"{name}: {entry.name} : {entry.type}")
    assert wrong == []


def test_errors_and_warnings_are_explained_below_their_names() -> None:
    """With ``ValueError : if ...`` on one line, numpydoc takes the explanation for a type."""
    wrong = []
    for path in sorted(Path(robonav.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            described = isinstance(node, ast.FunctionDef | ast.ClassDef)
            docstring = (described and ast.get_docstring(node)) or ""
            if "Raises\n" in docstring or "Warns\n" in docstring:
                sections = NumpyDocString(docstring)
                entries = [*sections["Raises"], *sections["Warns"]]
                wrong += [
                    f"{path.name}:{node.lineno} {entry.name} : {entry.type}"
                    for entry in entries
                    if entry.name or " if " in entry.type
                ]
    assert wrong == []
