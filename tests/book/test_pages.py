"""Every page of the book as a reader with no network meets it, over http and from disk."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from browser import DESKTOP, PHONE, Visit
from check_site import faults
from measure import (
    LARGEST_PAGE,
    LARGEST_SITE,
    TRAININGS,
    Training,
    weight,
    weight_of_site,
)
from page_visits import Shown


def test_page_was_built_whole(site: Path, page_name: str) -> None:
    assert list(faults(page_name)) == []


WHOLE: dict[str, list[str]] = {
    "formulas": [],
    "cut": [],
    "barred": [],
    "pictures": [],
    "unnamed": [],
}


def test_page_from_disk_is_quiet_and_complete(shown: Shown) -> None:
    assert shown.external == []
    assert shown.errors == []
    assert shown.broken == WHOLE


def test_page_over_http_is_quiet_and_complete(served_dark: Shown) -> None:
    assert served_dark.external == []
    assert served_dark.errors == []
    assert served_dark.broken == WHOLE


def test_widgets_take_up_room_and_are_photographed(shown: Shown) -> None:
    assert shown.flat == []
    assert [size for size in shown.photographs if size <= 1_000] == []
    assert shown.illegible["desktop"] == []


def test_tab_goes_through_widgets_in_order_visibly_and_out_again(shown: Shown) -> None:
    assert shown.focus == []


def test_page_fits_a_phone(shown: Shown) -> None:
    assert shown.overhang <= 1
    assert shown.illegible["phone"] == []


def test_formulas_in_lines_fit_a_phone(shown: Shown) -> None:
    """A formula in a line does not scroll: a long one is written as several, between which the line can break."""
    assert shown.formulas_cut == []


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
    visit.leave_formulas()
    visit.open(f"{http}/{training.page}.html")
    assert training.button(visit.page).is_enabled()


COUNTING = """(() => {
  const counts = window.formulaCounts = new Set();
  setInterval(() => counts.add(document.querySelectorAll("mjx-container").length), 20);
})()"""


def test_a_page_answers_while_its_formulas_are_set(visit: Visit, site: Path) -> None:
    """A timer of the page finds only some of them set, many times."""
    visit.page.add_init_script(COUNTING)
    visit.open(f"{site.as_uri()}/book/neural-network.html")
    counts = visit.page.evaluate("[...formulaCounts]")
    assert visit.page.locator("mjx-container").count() > 200
    assert len(counts) > 10
    assert visit.page.locator(".math:not(:has(mjx-container))").count() == 0


HEIGHTS = """async () => {
  const heights = new Set();
  for (let frame = 0; frame < 20; frame += 1) {
    await new Promise((resolve) => requestAnimationFrame(resolve));
    heights.add(document.body.scrollHeight);
  }
  return heights.size;
}"""


def test_a_page_at_rest_keeps_its_height(visit: Visit, http: str) -> None:
    """A line that says that an output scrolls must not make the output change for ever."""
    visit.page.set_viewport_size(PHONE)
    visit.leave_formulas()
    visit.open(f"{http}/book/neural-network.html")
    assert visit.page.evaluate(HEIGHTS) == 1
