"""The whole book as a PDF: the built pages are joined into one document, which Chromium prints.

Usage: python print_book.py FILE, after a build. Links between pages become links inside the document. Interactive
figures are printed in their first state, animations at their middle frame, and folded answers are open. Needs Chromium.
"""

from __future__ import annotations

import os
import posixpath
import re
import shutil
import sys
import tempfile
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

import yaml
from bs4 import BeautifulSoup, Tag
from check_site import ROOT, SITE, pages

CONFIG = yaml.safe_load((ROOT / "_config.yml").read_text("utf-8"))
TITLE, AUTHOR = CONFIG["title"], CONFIG["author"]
NOT_PRINTED = (
    "script:not([type^='application/vnd.jupyter']), .headerlink, .prev-next-area, .toctree-wrapper, "
    "details.hide:not(.above-output), .hide > summary, button.copybtn"
)
FRAME = re.compile(r'frames\[\d+\] = "(data:[^"]+)"')  # of matplotlib's animations
LOADED = (
    "link[rel=stylesheet], script[src*='third-party'], script[src*='/widgets.js'], "
    "script[type='application/vnd.jupyter.widget-state+json'], "
    "script:-soup-contains('window.MathJax')"
)
FOOT = '<div style="font-size: 8px; width: 100%; text-align: center" class="pageNumber"></div>'
STYLE = """
  @page { size: A4; margin: 18mm 16mm 20mm; }
  html { font-size: 11pt; scroll-behavior: auto; }
  body { background: #fff; }
  .printed { max-width: none; padding: 0; }
  .printed > section { break-before: page; }
  .cover { height: 240mm; display: flex; flex-direction: column; justify-content: center; text-align: center; }
  nav ul { columns: 2; }
  :is(h1, h2, h3, h4, .code-block-caption, .rubric) { break-after: avoid; }
  :is(figure, img, tr, .math, .quiz, .animation, .robonav, .admonition) { break-inside: avoid; }
  .cell_input { break-inside: avoid; }
  :is(.literal-block-wrapper, .literal-block-wrapper div) { display: block !important; break-inside: auto !important; }
  :is(pre, .highlight, .math, .output, .output > div, .pst-scrollable-table-container) { overflow: visible !important; }
  pre { break-inside: auto !important; orphans: 4; }
  table { font-size: 0.8rem; }
  table.table :is(td, th) { padding: 0.3rem; overflow-wrap: break-word; }
  .robonav::after { content: "In the pages of the book this can be touched."; font-size: 0.8rem; font-style: italic; }
"""
READY = """async () => {
  await window.MathJax?.startup?.promise;
  await document.fonts.ready;
  await Promise.all([...document.images].map((image) => image.decode().catch(() => {})));
}"""
WIDGETS_DRAWN = """() => [...document.querySelectorAll("script[type='application/vnd.jupyter.widget-view+json']")]
  .every(({ parentElement: place }) => place.querySelector(".widget-subarea > * > *"))"""
WIDGETS_SETTLED = """() => [...document.querySelectorAll(".robonav [role=status]")]
  .every(({ textContent: said }) => !said.endsWith("…"))"""


def anchor(page: str, fragment: str = "") -> str:
    """Return the anchor in the document of a place on a page."""
    return (
        f"{page.replace('/', '-')}--{fragment}" if fragment else page.replace("/", "-")
    )


def inside(page: str, address: str, known: set[str]) -> str:
    """Return the address in the document of an address on a page: an anchor for a page, a file for a file."""
    parts = urlsplit(address)
    if parts.scheme or parts.netloc:
        return address
    if not parts.path:
        return f"#{anchor(page, unquote(parts.fragment))}"
    at = PurePosixPath(
        posixpath.normpath(PurePosixPath(page).parent / unquote(parts.path))
    )
    if at.suffix == ".html" and str(at.with_suffix("")) in known:
        return f"#{anchor(str(at.with_suffix('')), unquote(parts.fragment))}"
    return str(at)


def still(article: Tag) -> None:
    """Give each animation its middle frame as a picture, which a script would otherwise set."""
    for animation in article.select(".animation"):
        script = animation.find_next("script", string=FRAME)
        frames = FRAME.findall(script.get_text()) if script else []
        if frames and animation.img:
            animation.img["src"] = frames[len(frames) // 2].replace("\\\n", "")


def prepared(page: str, source: str, known: set[str]) -> Tag:
    """Return the article of a page with unique anchors, open folded sections, and no controls."""
    article = BeautifulSoup(source, "html.parser").find("article")
    assert isinstance(article, Tag)
    still(article)
    for tag in article.select(NOT_PRINTED):
        tag.decompose()
    for tag in article.select("details.hide"):  # an output in a fold
        tag.unwrap()
    for tag in article.find_all("details"):
        tag["open"] = ""
    for tag in article.find_all(id=True):
        tag["id"] = anchor(page, tag["id"])
    for tag in article.find_all(["label", "button"], attrs={"for": True}):
        tag["for"] = anchor(page, tag["for"])
    for name in ("href", "src", "data"):
        for tag in article.find_all(attrs={name: True}):
            tag[name] = inside(page, tag[name], known)
    for link in article.select(
        "a[href]:not([href^='#'], [href*=':'])"
    ):  # to a file beside the pages
        if address := os.environ.get("BOOK_ADDRESS"):
            link["href"] = f"{address.rstrip('/')}/{link['href']}"
        else:
            link.unwrap()
    article.name = "section"
    article["id"] = anchor(page)
    return article


def needed(listed: list[str], sources: list[str]) -> str:
    """Return what the heads of the pages contain: styles, settings of formulas, states and scripts of widgets."""
    found: dict[str, None] = {}
    for page, source in zip(listed, sources, strict=True):
        for tag in BeautifulSoup(source, "html.parser").head.select(LOADED):
            for name in ("href", "src"):
                if tag.get(name):
                    tag[name] = inside(page, tag[name], set())
            found[str(tag)] = None
    return "".join(found)


def joined(listed: list[str]) -> str:
    """Return one document of all pages."""
    sources = [(SITE / f"{page}.html").read_text("utf-8") for page in listed]
    sections = [
        prepared(page, source, set(listed))
        for page, source in zip(listed, sources, strict=True)
    ]
    titles = [section.find("h1") for section in sections]
    contents = "".join(
        f'<li><a href="#{anchor(page)}">{title.get_text().removesuffix("#")}</a></li>'
        for page, title in zip(listed, titles, strict=True)
        if isinstance(title, Tag)
    )
    cover = f"<h1>{TITLE}</h1><p>The book where every equation runs</p><p>{AUTHOR}, {datetime.now(UTC):%B %Y}</p>"
    return (
        '<!doctype html><html lang="en" data-theme="light" data-mode="light"><head><meta charset="utf-8">'
        f"<title>{TITLE}</title>{needed(listed, sources)}<style>{STYLE}</style></head>"
        f'<body><main class="bd-content"><div class="bd-article printed"><div class="cover">{cover}</div>'
        f"<nav><h2>Contents</h2><ul>{contents}</ul></nav>{''.join(map(str, sections))}</div></main></body></html>"
    )


def print_to(target: Path, document: Path) -> None:
    """Print a document with Chromium when its formulas and figures are ready."""
    from playwright.sync_api import sync_playwright

    found = next(
        filter(
            None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))
        ),
        None,
    )
    if found is None:
        raise SystemExit(
            "make pdf needs Chromium: install it, for instance with apt install chromium"
        )
    with tempfile.TemporaryDirectory() as profile, sync_playwright() as playwright:
        context = playwright.chromium.launch_persistent_context(
            profile, executable_path=found, args=["--no-sandbox", "--disable-gpu"], color_scheme="light",
            viewport={"width": 800, "height": 1100},
        )  # fmt: skip
        context.set_default_timeout(180_000)
        page = context.new_page()
        page.goto(document.as_uri())
        page.evaluate(READY)
        page.wait_for_function(WIDGETS_DRAWN)
        page.wait_for_function(WIDGETS_SETTLED)
        page.pdf(
            path=target, prefer_css_page_size=True, print_background=True, outline=True, tagged=True,
            display_header_footer=True, header_template="<span></span>", footer_template=FOOT,
        )  # fmt: skip
        context.close()


def main() -> None:
    listed = list(pages(yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))))
    missing = [page for page in listed if not (SITE / f"{page}.html").is_file()]
    if missing:
        raise SystemExit(f"not built: {', '.join(missing)}; run make book first")
    target = Path(sys.argv[1])
    document = (
        SITE / "print.html"
    )  # where the pages' files are, and for as long as it takes
    try:
        document.write_text(joined(listed), "utf-8")
        target.parent.mkdir(parents=True, exist_ok=True)
        print_to(target.resolve(), document)
    finally:
        document.unlink(missing_ok=True)
    print(f"{target}: {target.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
