"""Links inside the book lead somewhere, and nothing on a page is fetched from elsewhere."""

from __future__ import annotations

from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {
    "script": "src",
    "img": "src",
    "iframe": "src",
    "video": "src",
    "audio": "src",
    "source": "src",
}


class Anchors(HTMLParser):
    """The anchors of a page, its links, and the addresses that a browser loads with it."""

    def __init__(self) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = {name: value for name, value in attrs if value}
        self.anchors.update(found[name] for name in ("id", "name") if name in found)
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if (
            tag == "link"
            and "canonical" not in found.get("rel", "")
            and "href" in found
        ):
            self.loaded.append(found["href"])
        if tag in LOADED and LOADED[tag] in found:
            self.loaded.append(found[LOADED[tag]])


@cache
def read(page: Path) -> Anchors:
    """One page, taken apart."""
    parser = Anchors()
    parser.feed(page.read_text("utf-8"))
    return parser


def broken(page: Path, address: str) -> bool:
    """Whether an address on a page leads to a file or anchor of the book that does not exist."""
    parts = urlsplit(address)
    if parts.scheme or parts.netloc:
        return False
    target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
    if target.is_dir():
        target /= "index.html"
    if not target.is_file():
        return True
    return (
        bool(parts.fragment)
        and target.suffix == ".html"
        and unquote(parts.fragment) not in read(target).anchors
    )


def test_links_and_anchors_exist(site: Path, page_name: str) -> None:
    page = site / f"{page_name}.html"
    found = read(page)
    assert [
        address for address in found.links + found.loaded if broken(page, address)
    ] == []


def test_nothing_is_loaded_from_elsewhere(site: Path, page_name: str) -> None:
    found = read(site / f"{page_name}.html")
    assert [
        address
        for address in found.loaded
        if urlsplit(address).scheme in ("http", "https")
    ] == []
    assert [address for address in found.loaded if address.startswith("//")] == []
