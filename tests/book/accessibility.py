"""Find faults of accessibility with axe-core."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from playwright.sync_api import Page

AXE = Path(__file__).parent / "third-party" / "axe.min.js"
RUN = """async (rules) => {
  const only = rules ? { runOnly: { type: "rule", values: rules } } : {};
  const { violations } = await axe.run(document, { resultTypes: ["violations"], ...only });
  const more = ["empty-table-header", "landmark-unique"];
  return violations
    .filter(({ id, impact }) => ["serious", "critical"].includes(impact) || more.includes(id))
    .flatMap(({ id, nodes }) => nodes.map(({ target, html }) => [id, target.flat().join(" "), html.slice(0, 160)]));
}"""
RUN_FROM_DISK = RUN.replace("resultTypes:", "preload: false, resultTypes:")
"""On a page from disk, which may not read its own style sheets again."""
ONE_OF_EACH = """() => {
  const behind = (part) => {
    const { backgroundColor } = getComputedStyle(part);
    return backgroundColor === "rgba(0, 0, 0, 0)" && part.parentElement ? behind(part.parentElement) : backgroundColor;
  };
  const seen = new Set();
  const repeated = [...document.querySelectorAll(".highlight pre span")].filter((token) => {
    if (!token.textContent.trim() || !token.checkVisibility()) return false;
    const { color, fontSize, fontWeight } = getComputedStyle(token);
    return seen.size === seen.add([behind(token), color, fontSize, fontWeight].join()).size;
  });
  for (const token of repeated) token.replaceWith(...token.childNodes);
  for (const text of document.querySelectorAll("mjx-assistive-mml")) text.textContent = text.textContent;
}"""
"""Leaves of all visible tokens of listings with the same colours one, and of a formula's hidden text one element.

A page has thousands of them, and axe-core needs a millisecond and more for each.
"""

# The theme's own faults: the rule, and a part of the element's selector or of its source.
BASELINE = [
    ("label-content-name-mismatch", "search-button-field"),
    ("label-content-name-mismatch", "theme-switch-button"),
    ("label-content-name-mismatch", 'aria-label="Toggle hidden content"'),
    ("aria-required-children", "citation-list"),
]


# The rules that depend on the colour scheme.
COLOURS = [
    "color-contrast",
    "link-in-text-block",
]


def ours(violation: list[str]) -> bool:
    """Whether a violation is not in the baseline."""
    rule, selector, source = violation
    return not any(
        rule == known and (part in selector or part in source)
        for known, part in BASELINE
    )


def violations(page: Page, rules: Sequence[str] | None = None) -> list[list[str]]:
    """Return what axe-core finds serious or critical on a page, apart from the theme's own faults.

    It also returns two faults that axe-core finds less serious: a table's heading without a word, and landmarks of one
    name.

    With ``rules``, only these of axe-core's rules are tested.
    """
    page.evaluate(ONE_OF_EACH)
    page.evaluate(AXE.read_text("utf-8"))
    found = page.evaluate(RUN, None if rules is None else list(rules))
    return [violation for violation in found if ours(violation)]
