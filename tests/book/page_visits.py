"""What a page of the book does and shows, in one visit over http and one from disk.

The first visit is on a light desktop, the second on a dark phone, whose window then becomes a desktop's. The tests of a
page share both visits, because most of their time is the page's loading. In the dark, axe-core looks at colours only,
because the colour scheme changes only those.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from accessibility import COLOURS, violations
from browser import DESKTOP, PHONE, ROOT, Visit, visiting
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
  cut: [...document.querySelectorAll("div.math, div.math mjx-container")]
    .filter((place) => place.scrollWidth > place.clientWidth + 1).map((place) => place.textContent.slice(0, 60)),
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
FORMULAS_CUT = """() => [...document.querySelectorAll("mjx-container:not([display])")]
  .filter((formula) => !formula.closest(".scroll, table, .tableholder"))
  .filter((formula) => formula.getBoundingClientRect().right > innerWidth)
  .map((formula) => formula.textContent)"""


@dataclass
class Shown:
    """Faults of a page. Dictionaries have the visits' names, ``http`` and ``file``, or the colour schemes."""

    external: dict[str, list[str]] = field(default_factory=dict)
    errors: dict[str, list[str]] = field(default_factory=dict)
    broken: dict[str, dict[str, list[str]]] = field(default_factory=dict)
    illegible: dict[str, list[str]] = field(default_factory=dict)
    violations: dict[str, list[list[str]]] = field(default_factory=dict)
    flat: list[str] = field(default_factory=list)
    photographs: list[int] = field(default_factory=list)  # sizes in bytes
    overhang: int = 0
    formulas_cut: list[str] = field(default_factory=list)


def shown_by(context: BrowserContext, http: str, disk: str, page_name: str) -> Shown:
    """Visit a page over http and from disk."""
    shown = Shown()
    with visiting(context) as visit:
        visit.page.set_viewport_size(DESKTOP)
        visit.open(f"{http}/{page_name}.html")
        _photograph(visit, page_name, shown)
        shown.illegible["http"] = visit.page.evaluate(ILLEGIBLE)
        _note_errors(visit, "http", shown)
        shown.violations["light"] = violations(visit.page)
        shown.broken["http"] = _broken(visit)
    with visiting(context) as visit:
        visit.page.emulate_media(color_scheme="dark")
        visit.page.set_viewport_size(PHONE)
        visit.open(f"{disk}/{page_name}.html")
        shown.overhang = visit.page.evaluate(OVERHANG)
        shown.illegible["file"] = visit.page.evaluate(ILLEGIBLE)
        shown.formulas_cut = visit.page.evaluate(FORMULAS_CUT)
        visit.page.set_viewport_size(DESKTOP)
        _note_errors(visit, "file", shown)
        shown.violations["dark"] = violations(visit.page, COLOURS)
        shown.broken["file"] = _broken(visit)
    return shown


def _photograph(visit: Visit, page_name: str, shown: Shown) -> None:
    """Take a picture of each widget when all of them have their height."""
    try:
        visit.page.wait_for_function(f"() => !({FLAT})().length")
    except PlaywrightTimeout:
        shown.flat = visit.page.evaluate(FLAT)
    place = page_name.removeprefix("book/").replace("/", "-")
    for which, widget in enumerate(
        visit.page.locator(".widget-subarea .robonav").all()
    ):
        picture = PICTURES / f"{place}-{which}.png"
        widget.screenshot(path=picture)
        shown.photographs.append(picture.stat().st_size)


def _note_errors(visit: Visit, where: str, shown: Shown) -> None:
    """Note what the page requested and which errors it had, and stop its motion for axe-core, which is not its own."""
    shown.external[where] = list(visit.external)
    shown.errors[where] = list(visit.errors)
    visit.page.emulate_media(reduced_motion="reduce")


def _broken(visit: Visit) -> dict[str, list[str]]:
    """Look for broken parts with the whole page laid out."""
    visit.page.add_style_tag(content=UNFOLDED)
    return dict(visit.page.evaluate(BROKEN))
