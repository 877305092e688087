"""The built book, served over http and read from disk, and a browser that cannot access the network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from browser import (
    DESKTOP,
    PATIENCE,
    PHONE,
    ROOT,
    SITE,
    Visit,
    chromium,
    executable,
    served,
    visiting,
)
from check_site import pages
from page_visits import Shown, from_disk, over_http
from playwright.sync_api import BrowserContext, expect

expect.set_options(timeout=PATIENCE)
pytest.register_assert_rewrite("explorables")  # so that their failures say what differs
PAGES = list(pages(yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))))


@pytest.fixture(scope="session", params=PAGES)
def page_name(request: pytest.FixtureRequest) -> str:
    """Each page of the book. Tests of the same page run one after the other, so that they share its visits."""
    return str(request.param)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark tests that open a browser or read the built book."""
    for item in items:
        if {"site", "context"} & set(getattr(item, "fixturenames", ())):
            item.add_marker("browser")


@pytest.fixture(scope="session")
def site() -> Path:
    """Return the folder of the built book."""
    if not (SITE / "index.html").is_file():
        pytest.skip("the book is not built: run `make book` first")
    return SITE


@pytest.fixture(scope="session")
def context() -> Iterator[BrowserContext]:
    """One desktop browser for all tests of a run."""
    if executable() is None:
        pytest.skip("Chromium is not installed")
    with chromium(viewport=DESKTOP, color_scheme="light") as browser_context:
        yield browser_context


@pytest.fixture
def visit(context: BrowserContext) -> Iterator[Visit]:
    """A new, empty page. A test that leaves another one open fails: its widgets would slow all later tests down."""
    before = set(context.pages)
    with visiting(context) as new:
        yield new
    left = [page for page in context.pages if page not in before]
    addresses = [page.url for page in left]
    for page in left:
        page.close()
    assert addresses == []


@pytest.fixture(scope="session")
def http(site: Path) -> Iterator[str]:
    """Return the address at which the book is served."""
    with served(site) as address:
        yield address


@pytest.fixture(scope="session")
def shown(context: BrowserContext, site: Path, page_name: str) -> Shown:
    """What a page shows from disk."""
    return from_disk(context, site.as_uri(), page_name)


@pytest.fixture(
    scope="session",
    params=[
        pytest.param(name, marks=pytest.mark.exhaustive if number % 3 else ())
        for number, name in enumerate(PAGES)
    ],
)
def some_page(request: pytest.FixtureRequest) -> str:
    """Every third page of the book; `make test-all` takes each."""
    return str(request.param)


@pytest.fixture(scope="session")
def served_dark(context: BrowserContext, http: str, some_page: str) -> Shown:
    """What a page shows over http, in the dark."""
    return over_http(context, http, some_page)


@pytest.fixture(params=["desktop", "phone"])
def place(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[str]:
    """Where the book is: served to a desktop, or on the disk of a phone without a network."""
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    yield request.getfixturevalue("http") if desktop else site.as_uri()
    assert visit.external == []


@pytest.fixture(params=["http", "file"])
def address(request: pytest.FixtureRequest, site: Path) -> str:
    """Return the book's address over http or on disk."""
    return request.getfixturevalue("http") if request.param == "http" else site.as_uri()
