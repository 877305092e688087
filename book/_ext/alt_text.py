"""Warn about pictures without an alternative text, and about cells that have such a text but no picture.

The build treats warnings as errors.

The text for a cell's figure is in the cell's metadata, as ``mystnb: {image: {alt: ...}}``. The text for a picture of
the page is in ``![the text](file)`` or in the ``:alt:`` option of its directive.
"""

from __future__ import annotations

import re

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)
SCRIPT = re.compile(r"<script\b.*?</script>", re.IGNORECASE | re.DOTALL)
IMAGE_TAG = re.compile(r"<img\b[^>]*>", re.IGNORECASE)
ALT = re.compile(r"\balt\s*=\s*([\"'])\s*\S", re.IGNORECASE)


def lint(app: Sphinx, doctree: nodes.document) -> None:
    """Check the pictures of one page, which are nodes or raw HTML."""
    for image in doctree.findall(nodes.image):
        if not image.get("alt", "").strip():
            LOGGER.warning(
                "picture without alternative text: %s", image.get("uri"), location=image
            )
    for cell in doctree.findall(nodes.container):
        promised = cell.get("cell_metadata", {}).get("mystnb", {}).keys() & {
            "image",
            "figure",
        }
        if (
            promised
            and not any(cell.findall(nodes.image))
            and not any(cell.findall(nodes.raw))
        ):
            LOGGER.warning(
                "cell has a text for a picture but shows none", location=cell
            )
    for raw in doctree.findall(nodes.raw):
        shown = SCRIPT.sub("", raw.astext()) if raw.get("format") == "html" else ""
        for tag in IMAGE_TAG.findall(shown):
            if not ALT.search(tag):
                LOGGER.warning(
                    "picture without alternative text: %.120s", tag, location=raw
                )


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("doctree-read", lint)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
