"""The reference of the package, made from its docstrings: ``{reference} robonav.mdp``.

The directive lists the public names of a subpackage (its ``__all__``): constants with their values, then functions and
classes with signature and docstring, each under its own heading. The role ``{name}`` and the index of equations link
here.
"""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import re
import textwrap
from collections.abc import Iterator
from enum import Enum, EnumType
from textwrap import shorten
from typing import Any

from docutils import nodes
from numpydoc.docscrape import NumpyDocString, Parameter
from sphinx.application import Sphinx
from sphinx.domains.python import PythonDomain
from sphinx.util.docutils import SphinxDirective

VALUES = bool | int | float | str | tuple | Enum
ROLE = re.compile(r":\w+:`~?([^`]+)`")
FUNCTION = re.compile(r"<function (\S+) at 0x[0-9a-f]+>")


LISTED = (
    "Parameters",
    "Other Parameters",
    "Attributes",
    "Returns",
    "Yields",
    "Raises",
    "Warns",
)
TEXTS = ("Notes", "References", "Examples")
TYPE_ALONE = {
    "Returns",
    "Yields",
    "Raises",
    "Warns",
}  # an item may be a type without a name
EXAMPLE = re.compile(r"^>>> .*(?:\n.+)*", re.MULTILINE)


def markdown(docstring: str) -> str:
    """A numpydoc docstring in Markdown: section titles in bold, parameters as lists, examples as code."""
    found = NumpyDocString(ROLE.sub(r"`\1`", inspect.cleandoc(docstring)))
    blocks = [
        found["Signature"],
        *map("\n".join, (found["Summary"], found["Extended Summary"])),
    ]
    for section in LISTED:
        if found[section]:
            items = [
                _item(item, type_alone=section in TYPE_ALONE) for item in found[section]
            ]
            blocks += [f"**{section}**", "\n".join(items)]
    for section in TEXTS:
        if found[section]:
            text = "\n".join(found[section])
            blocks += [f"**{section}**", EXAMPLE.sub("```pycon\n\\g<0>\n```", text)]
    return "\n\n".join(block.strip("\n") for block in blocks if block.strip())


def _item(item: Parameter, *, type_alone: bool) -> str:
    """Return one parameter, attribute, result or error as an entry of a list: names, type and description."""
    names, kind = (item.name or item.type, item.type if item.name else "")
    if not item.name and type_alone and not names.isidentifier():
        head = f"- {_plain(names)}"
    else:
        head = "- " + ", ".join(f"`{name.strip()}`" for name in names.split(","))
    if kind:
        head += f" ({_plain(kind)})"
    text = textwrap.indent("\n".join(item.desc).strip("\n"), "  ").strip()
    return f"{head}: {text}" if text else head


def _plain(text: str) -> str:
    """Return a type as text, with the characters escaped that Markdown would read as markup."""
    return re.sub(r"([\[\]*_<|])", r"\\\1", text)


def signature(name: str, found: Any) -> str:
    """Return the call of a function: names and defaults, without types, which the docstring gives."""
    if isinstance(found, EnumType):
        return f"{name}: {', '.join(found.__members__)}"
    try:
        called = inspect.signature(found)
    except (TypeError, ValueError):
        return name
    bare = [
        parameter.replace(
            annotation=inspect.Parameter.empty, default=Named.of(parameter.default)
        )
        for parameter in called.parameters.values()
        if parameter.name != "self"
    ]
    return f"{name}{called.replace(parameters=bare, return_annotation=inspect.Signature.empty)}"


class Named:
    """A default that is shown by its name alone."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __repr__(self) -> str:
        return self.name

    @classmethod
    def of(cls, default: Any) -> Any:
        """Return a default that is shown by its name if it is a class or function, and otherwise as in Python."""
        if default is inspect.Parameter.empty:
            return default
        return cls(getattr(default, "__qualname__", FUNCTION.sub(r"\1", repr(default))))


def methods(found: Any) -> Iterator[tuple[str, Any]]:
    """Return the public methods and properties that a class defines itself, in the order of its source."""
    for name, member in vars(found).items():
        function = (
            member.fget
            if isinstance(member, property)
            else getattr(member, "__func__", member)
        )
        if (
            not name.startswith("_")
            and inspect.isfunction(function)
            and function.__doc__
        ):
            yield name, member


def own_docstring(found: Any) -> str:
    """Return the docstring, unless ``dataclass`` or another class made it."""
    written = found.__doc__ or ""
    generated = dataclasses.is_dataclass(found) and written.startswith(
        f"{getattr(found, '__name__', '')}("
    )
    return "" if generated else written


class Reference(SphinxDirective):
    """The directive ``{reference}``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        module = importlib.import_module(self.arguments[0])
        named = [(name, getattr(module, name)) for name in module.__all__]
        callables = [
            (name, found)
            for name, found in named
            if inspect.isclass(found) or inspect.isroutine(found)
        ]
        constants = [
            (name, found) for name, found in named if isinstance(found, VALUES)
        ]
        made: list[nodes.Node] = self.constants(constants) if constants else []
        callables.sort(
            key=lambda named: (not inspect.isclass(named[1]), named[0].casefold())
        )
        return made + [
            self.entry(f"{module.__name__}.{name}", name, found)
            for name, found in callables
        ]

    def constants(self, named: list[tuple[str, Any]]) -> list[nodes.Node]:
        """Return the constants and their values. Long values are cut; type aliases and tables are left out."""
        lines = [f"- `{name} = {shorten(repr(found), 80)}`" for name, found in named]
        return self.parse_text_to_nodes("\n".join(lines))

    def entry(self, path: str, name: str, found: Any) -> nodes.section:
        """Return one function or class: heading, signature, docstring, methods."""
        section = nodes.section(ids=[path], names=[path])
        section += nodes.title("", "", nodes.literal("", name))
        kind = "class" if inspect.isclass(found) else "function"
        self.note(path, kind, path, f"{found.__module__}.{found.__qualname__}")
        section += self.code(signature(name, found))
        section += self.parse_text_to_nodes(markdown(own_docstring(found)))
        for method, member in methods(found) if kind == "class" else ():
            section += self.method(path, name, method, member)
        return section

    def method(self, path: str, owner: str, name: str, member: Any) -> nodes.Node:
        """Return one method of a class, indented below the class."""
        function = (
            member.fget
            if isinstance(member, property)
            else getattr(member, "__func__", member)
        )
        block = nodes.container(ids=[f"{path}.{name}"], classes=["reference-method"])
        self.note(
            f"{path}.{name}",
            "method",
            f"{path}.{name}",
            f"{function.__module__}.{function.__qualname__}",
        )
        shown = f"{owner}.{name}"
        block += self.code(
            shown if isinstance(member, property) else signature(shown, function)
        )
        block += self.parse_text_to_nodes(markdown(function.__doc__ or ""))
        return block

    def code(self, text: str) -> nodes.literal_block:
        return nodes.literal_block(
            text, text, language="python", classes=["reference-signature"]
        )

    def note(self, path: str, kind: str, anchor: str, definition: str) -> None:
        """Register the name for links, under its public path and that of its definition."""
        domain = self.env.get_domain("py")
        assert isinstance(domain, PythonDomain)
        domain.note_object(path, kind, anchor, location=self.get_location())
        if definition not in domain.objects:
            domain.note_object(
                definition, kind, anchor, aliased=True, location=self.get_location()
            )


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("reference", Reference)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
