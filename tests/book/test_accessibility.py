"""axe-core finds nothing serious or critical of ours on any page, in the light and in the dark."""

from __future__ import annotations

from pathlib import Path

import pytest
from browser import Visit

AXE = Path(__file__).parent / "third-party" / "axe.min.js"
RUN = """async () => {
  const { violations } = await axe.run(document, { resultTypes: ["violations"] });
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .flatMap(({ id, nodes }) => nodes.map(({ target, html }) => [id, target.flat().join(" "), html.slice(0, 160)]));
}"""

# The theme's own faults: the rule, and a part of the element's selector or of its source.
BASELINE = [
    ("label-content-name-mismatch", "search-button-field"),
    ("label-content-name-mismatch", "theme-switch-button"),
    ("label-content-name-mismatch", 'aria-label="Toggle hidden content"'),
    ("aria-required-children", "citation-list"),
]


def ours(violation: list[str]) -> bool:
    """Whether a violation is not in the baseline."""
    rule, selector, source = violation
    return not any(
        rule == known and (part in selector or part in source)
        for known, part in BASELINE
    )


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_serious_of_ours(
    visit: Visit, http: str, page_name: str, scheme: str
) -> None:
    visit.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    visit.open(f"{http}/{page_name}.html")
    visit.page.evaluate(
        "() => { window.define = undefined; }"
    )  # else axe hands itself to require.js
    visit.page.evaluate(AXE.read_text("utf-8"))
    assert [
        violation for violation in visit.page.evaluate(RUN) if ours(violation)
    ] == []
