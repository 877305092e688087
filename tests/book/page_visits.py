"""What a page of the book does and shows, from disk and over http.

The visit from disk is on a phone, whose window then becomes a desktop's. The visit over http is on a dark desktop. The
tests of a page share its visits, because most of their time is the page's loading. In the dark, axe-core looks at
colours only, because the colour scheme changes only those.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from accessibility import COLOURS, violations
from browser import DESKTOP, PHONE, ROOT, Visit, visiting
from focus import focus_faults
from labels import LABEL_FAULTS
from playwright.sync_api import BrowserContext
from playwright.sync_api import TimeoutError as PlaywrightTimeout

PICTURES = ROOT / "_build" / "widgets"  # kept, to look at after the tests
UNFOLDED = (
    "* { content-visibility: visible !important; }"  # lay out what is far below, too
)
FLAT = """() => [...document.querySelectorAll(".widget-subarea > *")]
  .filter((widget) => widget.clientHeight <= 10).map((widget) => widget.outerHTML.slice(0, 160))"""
BROKEN = """() => ({
  formulas: [...document.querySelectorAll("mjx-merror")].map((node) => node.textContent),
  cut: [...document.querySelectorAll("div.math, div.math mjx-container, div.highlight:not(.cell_output *) pre")]
    .filter((place) => place.scrollWidth > place.clientWidth + 1).map((place) => place.textContent.slice(0, 60)),
  barred: [...document.querySelectorAll("span.math")].filter((place) => {
    const { overflowX, scrollbarWidth } = getComputedStyle(place);
    return place.scrollWidth > place.clientWidth && overflowX !== "hidden" && scrollbarWidth !== "none";
  }).map((place) => place.textContent.slice(0, 60)),
  pictures: [...document.images].filter((image) => image.complete && !image.naturalWidth).map((image) => image.src),
  unnamed: [...document.images].filter((image) => !image.alt && image.offsetParent).map((image) => image.src),
})"""
OVERHANG = (
    "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"
)
ILLEGIBLE = """() => [...document.querySelectorAll(".robonav svg text")].filter((text) => {
  const picture = text.ownerSVGElement;
  const [inner, outer] = [text, picture].map((element) => element.getBoundingClientRect());
  const size = (parseFloat(getComputedStyle(text).fontSize) * outer.width) / (picture.viewBox.baseVal.width || 1);
  const [across, down] = [["left", "right"], ["top", "bottom"]].map(([low, high]) =>
    Math.max(outer[low] - inner[low], inner[high] - outer[high]));
  return text.textContent && inner.width > 0 && (size < 8 || Math.max(across, down) > 2);
}).map((text) => text.textContent)"""
CROWDED = f"""() => [...document.querySelectorAll(".robonav svg")]
  .filter((picture) => picture.checkVisibility()).flatMap({LABEL_FAULTS})"""
THEME_WAITS = 600
"""Milliseconds after which the theme has looked which code scrolls at a new width, and lets Tab reach it."""

FORMULAS_CUT = """() => {
  const folded = [...document.querySelectorAll("details:not([open])")];
  for (const part of folded) part.open = true;
  const cut = [...document.querySelectorAll("mjx-container:not([display])")]
    .filter((formula) => formula.checkVisibility() && !formula.closest(".scroll, table, .tableholder"))
    .filter((formula) => formula.getBoundingClientRect().right > innerWidth)
    .map((formula) => formula.textContent);
  for (const part of folded) part.open = false;
  return cut;
}"""


@dataclass
class Shown:
    """Faults of a page in one visit, and the sizes of the pictures taken of its widgets."""

    external: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    broken: dict[str, list[str]] = field(default_factory=dict)
    violations: list[list[str]] = field(default_factory=list)
    illegible: dict[str, list[str]] = field(default_factory=dict)  # by screen
    flat: list[str] = field(default_factory=list)
    photographs: list[int] = field(default_factory=list)  # bytes
    overhang: int = 0
    formulas_cut: list[str] = field(default_factory=list)
    focus: list[str] = field(default_factory=list)


def from_disk(context: BrowserContext, folder: str, page_name: str) -> Shown:
    """Visit a page from disk, on a phone and then on a desktop."""
    shown = Shown()
    with visiting(context) as visit:
        visit.page.set_viewport_size(PHONE)
        visit.open(f"{folder}/{page_name}.html")
        shown.overhang = visit.page.evaluate(OVERHANG)
        shown.illegible["phone"] = visit.page.evaluate(ILLEGIBLE)
        shown.illegible["phone"] += visit.page.evaluate(CROWDED)
        shown.formulas_cut = visit.page.evaluate(FORMULAS_CUT)
        visit.page.set_viewport_size(DESKTOP)
        visit.page.wait_for_timeout(THEME_WAITS)
        _photograph(visit, page_name, shown)
        shown.illegible["desktop"] = visit.page.evaluate(ILLEGIBLE)
        shown.illegible["desktop"] += visit.page.evaluate(CROWDED)
        shown.focus = focus_faults(visit.page)
        _examine(visit, shown)
    return shown


def over_http(context: BrowserContext, address: str, page_name: str) -> Shown:
    """Visit a page over http, on a desktop in the dark."""
    shown = Shown()
    with visiting(context) as visit:
        visit.page.emulate_media(color_scheme="dark")
        visit.page.set_viewport_size(DESKTOP)
        visit.open(f"{address}/{page_name}.html")
        _examine(visit, shown, COLOURS)
    return shown


def _photograph(visit: Visit, page_name: str, shown: Shown) -> None:
    """Take a picture of each widget when all of them have their height."""
    try:
        visit.page.wait_for_function(f"() => !({FLAT})().length")
    except PlaywrightTimeout:
        shown.flat = visit.page.evaluate(FLAT)
    place = page_name.removeprefix("book/").replace("/", "-")
    widgets = visit.page.locator(".widget-subarea .robonav")
    for which, widget in enumerate(widgets.all()):
        picture = PICTURES / f"{place}-{which}.png"
        widget.screenshot(path=picture)
        shown.photographs.append(picture.stat().st_size)


def _examine(visit: Visit, shown: Shown, rules: Sequence[str] | None = None) -> None:
    """Note errors before axe-core runs, because its own are not the page's, and look for what is broken at last."""
    shown.external, shown.errors = list(visit.external), list(visit.errors)
    visit.page.emulate_media(reduced_motion="reduce")
    shown.violations = violations(visit.page, rules)
    visit.page.add_style_tag(content=UNFOLDED)
    shown.broken = visit.page.evaluate(BROKEN)
