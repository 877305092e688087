"""From the thesis to the code: ``{thesis-index} equations`` (or ``algorithms``, ``tables``, ``figures``).

For each number the directive lists the function or class that defines it, then all public names that use it. The module
``citations.py`` finds them. For an equation that computes nothing, the list tells which symbol it introduces. The
number of an equation is a link to the page that shows it.
"""

from __future__ import annotations

import citations
from citations import Documented, Number, written
from docutils import nodes
from docutils.parsers.rst import directives
from package_code import code_reference
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from thesis_numbers import equation_reference


class ThesisIndex(SphinxDirective):
    """The directive ``{thesis-index}``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        kind = directives.choice(self.arguments[0], tuple(citations.KINDS))
        for path in citations.PACKAGE.rglob("*.py"):
            self.env.note_dependency(str(path))
        self.env.note_dependency(citations.__file__)
        self.env.note_dependency(str(citations.SYMBOLS_FILE))
        title = kind.removesuffix("s")
        head = nodes.thead(
            "", _row([nodes.Text(title)], [nodes.Text("in the package")])
        )
        defined, used = citations.definitions(kind), citations.uses(kind)
        wanted = {
            "equations": citations.EQUATIONS,
            "algorithms": citations.ALGORITHMS,
        }.get(kind, sorted({*defined, *used}))
        body = nodes.tbody()
        for number in wanted:
            named = f"{title.capitalize()} {written(number)}"
            if kind == "equations":
                first = [equation_reference(written(number), self.env.docname)]
            elif kind == "algorithms":
                link = f"{{prf:ref}}`{named} <alg-{written(number)}>`"
                first = self.parse_inline(link)[0]
            else:
                first = [nodes.Text(named)]
            code = self.symbol(number) if kind == "equations" else []
            code = code or self.names(defined.get(number, []))
            others = self.names(used.get(number, []))
            if code and others:
                code.append(nodes.Text("; used in "))
            body += _row(first, code + others)
        columns = [nodes.colspec(colwidth=width) for width in (15, 85)]
        return [nodes.table("", nodes.tgroup("", *columns, head, body, cols=2))]

    def symbol(self, number: Number) -> list[nodes.Node]:
        """Return the sentence about an equation that only introduces a symbol, or nothing."""
        sentence = citations.symbols().get(number)
        if sentence is None:
            return []
        inline, messages = self.parse_inline(sentence.removesuffix("."))
        return [*inline, *messages]

    def names(self, items: list[Documented]) -> list[nodes.Node]:
        """Return names as links with commas between them."""
        found: list[nodes.Node] = []
        for name in dict.fromkeys(item.name for item in items):
            if found:
                found.append(nodes.Text(", "))
            shown = name.removeprefix("robonav.")
            found.append(code_reference(name, shown, self.env.docname))
        return found


def _row(*cells: list[nodes.Node]) -> nodes.row:
    return nodes.row(
        "", *(nodes.entry("", nodes.paragraph("", "", *content)) for content in cells)
    )


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("thesis-index", ThesisIndex)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
