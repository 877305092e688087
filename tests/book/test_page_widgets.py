"""``book/_static/widgets.js`` draws the widgets of a page: near ones first, all in the end, also on paper."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from browser import ROOT, Visit
from playwright.sync_api import expect

DRAWS = """export default { render({ model, el }) {
  model.send({ ask: "kernel" });
  el.append(model.get("data").name);
} };"""
NAMES = ("near", "far", "farther")
NEVER_AT_REST = "globalThis.requestIdleCallback = () => 0;"


@pytest.fixture
def page(visit: Visit, tmp_path: Path) -> Callable[..., None]:
    """Opens a page from disk with three widgets, four screens apart from each other."""

    def opened(**modules: str) -> None:
        state = {
            name: {
                "state": {
                    "_esm": modules.get(name, DRAWS),
                    "_css": ".robonav { color: green; }",
                    "data": {"name": f"{name} is drawn"},
                }
            }
            for name in NAMES
        }
        places = [
            f"<div id={name}><script type='application/vnd.jupyter.widget-view+json'>"
            f"{json.dumps({'model_id': name})}</script></div><p style='height: 4000px'>"
            for name in NAMES
        ]
        script = (ROOT / "book/_static/widgets.js").as_uri()
        (tmp_path / "page.html").write_text(
            f"<!doctype html><title>three</title><script type='application/vnd.jupyter.widget-state+json'>"
            f"{json.dumps({'state': state})}</script><script defer src='{script}'></script>{''.join(places)}",
            "utf-8",
        )
        visit.page.goto((tmp_path / "page.html").as_uri())

    return opened


def drawn(visit: Visit, name: str) -> None:
    expect(visit.page.locator(f"#{name} .widget-subarea > div")).to_have_text(
        f"{name} is drawn"
    )


def test_all_are_drawn_while_the_page_rests(visit, page):
    page()
    for name in NAMES:
        drawn(visit, name)
    assert visit.page.locator("head style").count() == 1  # the style they share
    assert visit.errors == []


def test_who_scrolls_finds_what_was_not_drawn_yet(visit, page):
    visit.page.add_init_script(NEVER_AT_REST)
    page()
    drawn(visit, "near")
    assert visit.page.locator("#far .widget-subarea > *").count() == 0
    visit.page.locator("#far").scroll_into_view_if_needed()
    drawn(visit, "far")
    assert visit.page.locator("#farther .widget-subarea > *").count() == 0
    visit.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    drawn(visit, "farther")
    assert visit.errors == []


@pytest.mark.parametrize("missing", ["IntersectionObserver", "requestIdleCallback"])
def test_older_browsers_draw_them_too(visit, page, missing):
    visit.page.add_init_script(f"delete globalThis.{missing};")
    page()
    for name in NAMES:
        drawn(visit, name)
    assert visit.errors == []


def test_what_cannot_be_drawn_says_so_and_stops_no_other(visit, page):
    page(near="export default { render() { throw new Error('broken'); } };")
    expect(visit.page.locator("#near .widget-subarea")).to_contain_text("newer browser")
    drawn(visit, "farther")
    assert len(visit.errors) == 1
