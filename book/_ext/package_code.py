"""The package's code on a page: shown with the directive ``{source}``, named with the role ``{name}``.

``{source} robonav.mdp.value_iteration`` puts a function's or class's source on the page, read from the package as it is
imported, so a page cannot show an old copy. The docstring is left out, since the page's text takes its place;
``:docstring:`` keeps it.

A name in the role must exist, or the build fails: ``{name}`robonav.mdp.FiniteMDP.discount```, or an argument,
``{name}`robonav.robot.navigate(speed)```. The leading ``robonav.`` is not shown.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import re
import textwrap
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.directives.code import container_wrapper
from sphinx.util.docutils import SphinxDirective, SphinxRole

NAME = re.compile(r"(?P<name>robonav(?:\.\w+)+)(?:\((?P<argument>\w+)\))?")


def resolve(name: str) -> Any:
    """The object of a dotted name: an attribute where there is one, as Python has it, else a module."""
    package, *parts = name.split(".")
    found: Any = importlib.import_module(package)
    for part in parts:
        fields = getattr(found, "__dataclass_fields__", {})
        if part in fields:
            found = fields[part]
        elif inspect.ismodule(found) and not hasattr(found, part):
            found = importlib.import_module(f"{found.__name__}.{part}")
        else:
            found = getattr(found, part)
    return inspect.unwrap(getattr(found, "py_func", found)) if callable(found) else found


def without_docstring(source: str) -> str:
    """The same source with the docstring of its outermost definition cut out."""
    definition = ast.parse(source).body[0]
    if not isinstance(definition, ast.FunctionDef | ast.ClassDef) or ast.get_docstring(definition) is None:
        return source
    docstring = definition.body[0]
    lines = source.splitlines(keepends=True)
    after = docstring.end_lineno or docstring.lineno
    while after < len(lines) and not lines[after].strip():
        after += 1
    return "".join(lines[: docstring.lineno - 1] + lines[after:])


class FunctionSource(SphinxDirective):
    """The directive ``{source}``."""

    required_arguments = 1
    option_spec: ClassVar[dict[str, Any]] = {"docstring": directives.flag}

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        try:
            found = resolve(name)
            source = textwrap.dedent(inspect.getsource(found))
            path = Path(inspect.getsourcefile(found) or "")
        except (ImportError, AttributeError, TypeError, OSError) as error:
            raise self.error(f"cannot show the source of {name}: {error}") from error
        self.env.note_dependency(str(path))
        if "docstring" not in self.options:
            source = without_docstring(source)
        code = nodes.literal_block(source, source, language="python", classes=["function-source"])
        return [container_wrapper(self, code, f"`{name}`")]


class CodeName(SphinxRole):
    """The role ``{name}``."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        match = NAME.fullmatch(self.text)
        try:
            if match is None:
                raise ValueError("not a dotted name")
            found = resolve(match["name"])
            if match["argument"] and match["argument"] not in inspect.signature(found).parameters:
                raise ValueError(f"it has no argument {match['argument']}")
        except (ImportError, AttributeError, TypeError, ValueError) as error:
            message = self.inliner.reporter.warning(f"{self.text} is not in the package: {error}", line=self.lineno)
            return [], [message]
        return [nodes.literal(self.rawtext, self.text.removeprefix("robonav."))], []


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("source", FunctionSource)
    app.add_role("name", CodeName())
    return {"parallel_read_safe": True, "parallel_write_safe": True}
