"""A page in another language than the book's says so: ``lang: fr`` at the top of its source.

A screen reader then pronounces it rightly, and a browser hyphenates and translates it as what it is.
"""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx


def mark(
    app: Sphinx,
    page: str,
    template: str,
    context: dict[str, Any],
    doctree: nodes.document | None,
) -> None:
    """Put the page's body into an element that names its language."""
    language = app.env.metadata.get(page, {}).get("lang")
    if language and "body" in context:
        context["body"] = f'<div lang="{language}">{context["body"]}</div>'


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("html-page-context", mark)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
