"""Equations that carry the thesis's own numbers.

An equation labelled ``eq-2.24`` is shown and referred to as (2.24), so that a reader can lay the thesis beside the
book. Every other labelled equation is ours and is counted 1, 2, 3 down its page.
"""

from __future__ import annotations

import re
from typing import Any

from sphinx.application import Sphinx
from sphinx.domains.math import MathDomain

THESIS_LABEL = re.compile(r"eq-(\d+\.\d+)")


def thesis_number(label: str) -> str | None:
    """The thesis's number in a label, or None for an equation of our own."""
    match = THESIS_LABEL.fullmatch(label)
    return match[1] if match else None


class ThesisMathDomain(MathDomain):
    """Sphinx's domain for mathematics with the numbers taken from the labels."""

    def note_equation(self, docname: str, labelid: str, location: Any = None) -> None:
        number = thesis_number(labelid)
        if number is None:
            super().note_equation(docname, labelid, location)
            return
        if labelid in self.equations:
            raise ValueError(f"{docname}: equation {number} is already on page {self.equations[labelid][0]}")
        self.equations[labelid] = (docname, number)


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_domain(ThesisMathDomain, override=True)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
