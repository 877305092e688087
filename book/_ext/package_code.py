"""The package's code on a page: the directive ``{source}`` shows it, and the role ``{name}`` names it.

``{source} robonav.mdp.value_iteration`` shows the source of a function or class, read from the imported package, so a
page cannot show an old copy. The docstring is left out, because the page's text explains the code; ``:docstring:``
keeps it.

A name in the role is a link into the reference and must exist, or the build fails: ``{name}`robonav.robot.Worlds```, or
an argument, ``{name}`robonav.robot.navigate(speed)```. The leading ``robonav.`` is not shown.
"""

from __future__ import annotations

import importlib
import inspect
import re
import sys
import textwrap
from pathlib import Path
from typing import Any, ClassVar

from citations import without_docstring
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.directives.code import container_wrapper
from sphinx.environment import BuildEnvironment
from sphinx.util.docutils import SphinxDirective, SphinxRole
from sphinx.util.nodes import make_refnode

NAME = re.compile(r"(?P<name>robonav(?:\.\w+)+)(?:\((?P<argument>\w+)\))?")
CODE_WORD = re.compile(r'(?<=<span class="pre">)[^<]+')
BREAK = re.compile(r"(?<=[._/(])(?=[a-zA-Z])")


def resolve(name: str) -> Any:
    """Return the object of a dotted name: an attribute if there is one, as in Python, else a module."""
    package, *parts = name.split(".")
    found: Any = importlib.import_module(package)
    path = package
    for part in parts:
        if (
            not inspect.ismodule(found)
            and not hasattr(found, part)
            and path in sys.modules
        ):
            found = sys.modules[
                path
            ]  # a package may give a function the name of its module
        path = f"{path}.{part}"
        fields = getattr(found, "__dataclass_fields__", {})
        if part in fields:
            found = fields[part]
        elif inspect.ismodule(found) and not hasattr(found, part):
            found = importlib.import_module(f"{found.__name__}.{part}")
        else:
            found = getattr(found, part)
    return (
        inspect.unwrap(getattr(found, "py_func", found)) if callable(found) else found
    )


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
        code = nodes.literal_block(
            source, source, language="python", classes=["function-source"]
        )
        return [container_wrapper(self, code, f"`{name}`")]


def code_reference(name: str, shown: str, docname: str) -> nodes.Node:
    """Return a name as code, with a link to its entry in the reference or to that of its owner."""
    target = {"refdomain": "py", "reftype": "obj", "reftarget": name, "refdoc": docname}
    return pending_xref("", nodes.literal("", shown), **target)


def link_to_owner(
    app: Sphinx, env: BuildEnvironment, node: pending_xref, content: nodes.Element
) -> nodes.Node | None:
    """Link a field or a part without an entry of its own to its owner. Without an owner, leave it as plain code."""
    if node.get("refdomain") != "py" or node.get("reftype") != "obj":
        return None
    name: str = node["reftarget"]
    objects = env.get_domain("py").data["objects"]
    while name and name not in objects:
        name = name.rpartition(".")[0]
    if not name:
        return content
    found = objects[name]
    return make_refnode(
        app.builder, node["refdoc"], found.docname, found.node_id, content, name
    )


class CodeName(SphinxRole):
    """The role ``{name}``."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        match = NAME.fullmatch(self.text)
        try:
            if match is None:
                raise ValueError("not a dotted name")
            found = resolve(match["name"])
            if (
                match["argument"]
                and match["argument"] not in inspect.signature(found).parameters
            ):
                raise ValueError(f"it has no argument {match['argument']}")
        except (ImportError, AttributeError, TypeError, ValueError) as error:
            message = self.inliner.reporter.warning(
                f"{self.text} is not in the package: {error}", line=self.lineno
            )
            return [], [message]
        return [
            code_reference(
                match["name"], self.text.removeprefix("robonav."), self.env.docname
            )
        ], []


def let_names_break(
    app: Sphinx,
    page: str,
    template: str,
    context: dict[str, Any],
    doctree: nodes.document | None,
) -> None:
    """Let a name of code break after its dots, underscores and brackets in a narrow column."""
    if body := context.get("body"):
        context["body"] = CODE_WORD.sub(lambda word: BREAK.sub("<wbr>", word[0]), body)


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("source", FunctionSource)
    app.add_role("name", CodeName())
    app.connect("missing-reference", link_to_owner)
    app.connect("html-page-context", let_names_break)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
