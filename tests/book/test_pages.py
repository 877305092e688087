"""Every page of the book as a reader with no network meets it, over http and from disk."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from browser import DESKTOP, PHONE, ROOT, Visit
from check_site import faults
from measure import (
    LARGEST_PAGE,
    LARGEST_SITE,
    TRAININGS,
    Training,
    weight,
    weight_of_site,
)

PICTURES = ROOT / "_build" / "widgets"  # kept, to look at after the tests
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


def test_page_was_built_whole(site: Path, page_name: str) -> None:
    assert list(faults(page_name)) == []


def test_page_is_quiet_and_complete(visit: Visit, address: str, page_name: str) -> None:
    visit.open(f"{address}/{page_name}.html")
    assert visit.external == []
    assert visit.errors == []
    visit.page.add_style_tag(
        content="* { content-visibility: visible !important; }"
    )  # lay out what is far below, too
    assert visit.page.evaluate(BROKEN) == {
        "formulas": [],
        "cut": [],
        "pictures": [],
        "unnamed": [],
    }


def test_widgets_take_up_room_and_are_photographed(
    visit: Visit, http: str, page_name: str
) -> None:
    visit.open(f"{http}/{page_name}.html")
    visit.page.wait_for_function(
        "() => [...document.querySelectorAll('.widget-subarea > *')].every((widget) => widget.clientHeight > 10)"
    )
    for which, widget in enumerate(
        visit.page.locator(".widget-subarea .robonav").all()
    ):
        picture = (
            PICTURES
            / f"{page_name.removeprefix('book/').replace('/', '-')}-{which}.png"
        )
        widget.screenshot(path=picture)
        assert picture.stat().st_size > 1_000
    assert visit.page.evaluate(ILLEGIBLE) == []


def test_page_fits_a_phone(visit: Visit, http: str, page_name: str) -> None:
    visit.page.set_viewport_size(PHONE)
    visit.open(f"{http}/{page_name}.html")
    assert visit.page.evaluate(OVERHANG) <= 1
    assert visit.page.evaluate(ILLEGIBLE) == []


FORMULAS_CUT = """() => [...document.querySelectorAll("mjx-container:not([display])")]
  .filter((formula) => !formula.closest(".scroll, table, .tableholder"))
  .filter((formula) => formula.getBoundingClientRect().right > innerWidth)
  .map((formula) => formula.textContent)"""


def test_formulas_in_lines_fit_a_phone(visit: Visit, http: str, page_name: str) -> None:
    """A formula in a line does not scroll: a long one is written as several, between which the line can break."""
    visit.page.set_viewport_size(PHONE)
    visit.open(f"{http}/{page_name}.html")
    assert visit.page.evaluate(FORMULAS_CUT) == []


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_search_finds_a_page(visit: Visit, address: str, size: dict[str, int]) -> None:
    visit.page.set_viewport_size(size)
    visit.open(f"{address}/search.html?q=policy")
    visit.page.wait_for_selector(
        "#search-results ul.search li a[href*='book/intro.html']"
    )  # results come one by one
    assert visit.external == []
    assert visit.errors == []


def test_search_for_an_algorithm_finds_it_first(visit: Visit, address: str) -> None:
    visit.open(f"{address}/search.html?q=Algorithm+8")
    first = visit.page.wait_for_selector("#search-results ul.search li a")
    assert first is not None
    assert "book/nnql.html#alg-8" in (first.get_attribute("href") or "")


def test_first_page_leads_into_the_book(visit: Visit, address: str) -> None:
    visit.page.goto(f"{address}/index.html")
    visit.page.wait_for_url("**/book/intro.html")


def test_a_notebook_is_saved_by_its_button(
    visit: Visit, address: str, site: Path
) -> None:
    visit.open(f"{address}/book/playground.html")
    visit.page.get_by_label("Download this page").click()
    with visit.page.expect_download() as download:
        visit.page.locator(".dropdown-menu a", has_text=".ipynb").click()
    assert download.value.suggested_filename == "playground.ipynb"
    saved = json.loads(Path(download.value.path()).read_text("utf-8"))
    assert saved == json.loads(
        (site / "_sources/book/playground.ipynb").read_text("utf-8")
    )


def test_page_is_light(site: Path, page_name: str) -> None:
    assert weight(page_name) <= LARGEST_PAGE


def test_site_is_light(site: Path) -> None:
    assert weight_of_site() <= LARGEST_SITE


@pytest.mark.parametrize("training", TRAININGS, ids=lambda training: training.page)
def test_trainings_that_are_measured_are_on_their_pages(
    visit: Visit, http: str, training: Training
) -> None:
    visit.open(f"{http}/{training.page}.html")
    assert training.button(visit.page).is_enabled()
