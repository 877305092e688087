"""Remove everything from the pages that would be loaded from the network.

The front-end files that a page needs are committed in ``book/_static/third-party``. Files that Jupyter Book would load
although no page needs them are removed here, and so are the theme's files that no browser loads.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

# sphinx-thebe is loaded by Jupyter Book, is off in this book, and fails twice on every page if its tags stay.
UNWANTED_SCRIPT = re.compile(r"thebe", re.IGNORECASE)


def drop_unwanted_scripts(
    app: Sphinx,
    page: str,
    template: str,
    context: dict[str, Any],
    doctree: nodes.document | None,
) -> None:
    """Remove the script tags of unused tools from a page's template context."""
    context["script_files"] = [
        script
        for script in context.get("script_files", [])
        if not UNWANTED_SCRIPT.search(
            f"{getattr(script, 'filename', script)} {getattr(script, 'attributes', '')}"
        )
    ]


NEVER_LOADED = (".map", ".po", ".mo")
"""Source maps, and catalogues of translations, which the theme reads when the book is built."""


def remove_what_no_browser_loads(app: Sphinx, error: Exception | None) -> None:
    """Remove the theme's files that no browser loads from the site: about four megabytes.

    Every browser of the last ten years takes the WOFF2 file of a font. The TrueType file of the same font is for older
    ones.
    """
    for path in (Path(app.outdir) / "_static").rglob("*"):
        older = path.suffix == ".ttf" and path.with_suffix(".woff2").exists()
        if older or path.suffix in NEVER_LOADED:
            path.unlink()


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("html-page-context", drop_unwanted_scripts, priority=900)
    app.connect("build-finished", remove_what_no_browser_loads)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
