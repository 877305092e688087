"""Take pictures of built pages in full length: on desktop, on a phone and in dark mode.

Usage: python tests/book/screenshots.py FOLDER [PAGE ...]      (all pages of the book if none is named)
"""

from __future__ import annotations

import sys
from pathlib import Path

from browser import DESKTOP, PHONE, SITE, chromium, served, visiting

VIEWS = {
    "desktop": {"viewport": DESKTOP, "color_scheme": "light"},
    "dark": {"viewport": DESKTOP, "color_scheme": "dark"},
    "phone": {
        "viewport": PHONE,
        "color_scheme": "light",
        "is_mobile": True,
        "has_touch": True,
    },
}
TALLEST = 1_600  # pixels of one picture; a longer page continues in the next one


def photograph(folder: Path, pages: list[str]) -> None:
    """Write ``PAGE-VIEW-N.png`` for each page and view."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, options in VIEWS.items():
        with served(SITE) as address, chromium(**options) as context:
            for page in pages:
                with visiting(context) as visit:
                    visit.open(f"{address}/{page}.html")
                    visit.page.add_style_tag(
                        content="* { content-visibility: visible !important; }"
                    )
                    visit.page.wait_for_timeout(300)
                    height = visit.page.evaluate(
                        "document.documentElement.scrollHeight"
                    )
                    width = visit.page.viewport_size["width"]
                    for part, top in enumerate(range(0, height, TALLEST)):
                        path = folder / f"{page.replace('/', '-')}-{name}-{part}.png"
                        clip = {
                            "x": 0,
                            "y": top,
                            "width": width,
                            "height": min(TALLEST, height - top),
                        }
                        visit.page.screenshot(path=path, full_page=True, clip=clip)
                        print(path)
                    for fault in visit.errors + visit.external:
                        print("  ", fault)


if __name__ == "__main__":
    named = [page.removesuffix(".html").removesuffix(".md") for page in sys.argv[2:]]
    every = [
        str(path.relative_to(SITE).with_suffix(""))
        for path in sorted((SITE / "book").rglob("*.html"))
    ]
    photograph(Path(sys.argv[1]), named or every)
