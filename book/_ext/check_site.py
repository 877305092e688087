"""Check the built book: every page of _toc.yml exists, contains text, and shows no error.

``make book`` runs this after a build. It prints the faults and exits with 1 if there are any.
"""

from __future__ import annotations

import html
import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parents[2]
SITE = Path(
    os.environ.get("BOOK_SITE", ROOT / "_build" / "html")
)  # the folder of a book that was built elsewhere
LEAST_TEXT = 400  # a page with fewer characters in its article counts as empty
FAILURES = {
    "a failed cell": re.compile(r"Traceback \(most recent call last\)|ansi-red-fg"),
    "a directive or role that did not parse": re.compile(
        r'class="system-message|class="problematic'
    ),
    "an unresolved reference": re.compile(
        r"<code[^>]*>\{(?:ref|eq|numref|cite[^}]*|prf:ref)\}"
    ),
}

NO_PROSE = re.compile(
    r"<(pre|code|script|style)\b.*?</\1>|<(span|div) class=\"math\b.*?</\2>", re.DOTALL
)
BARE_TEX = re.compile(r"\\[a-zA-Z]{2,}")


def pages(entry: Any) -> Iterator[str]:
    """Return every page named in a table of contents, with those of parts and sections."""
    if isinstance(entry, dict):
        yield from (entry[key] for key in ("root", "file") if key in entry)
        entry = [value for value in entry.values() if isinstance(value, list)]
    if isinstance(entry, list):
        for inner in entry:
            yield from pages(inner)


def faults(page: str) -> Iterator[str]:
    """Yield one sentence for each fault of a built page."""
    built = SITE / f"{page}.html"
    if not built.is_file():
        yield "was not built"
        return
    source = built.read_text("utf-8")
    article = re.search(r"<article\b.*?</article>", source, re.DOTALL)
    text = html.unescape(re.sub(r"<[^>]+>", " ", article[0] if article else ""))
    if len(" ".join(text.split())) < LEAST_TEXT:
        yield f"holds fewer than {LEAST_TEXT} characters"
    if article and BARE_TEX.search(NO_PROSE.sub("", article[0])):
        yield "shows a formula that did not parse"
    yield from (
        f"shows {name}"
        for name, sign in FAILURES.items()
        if article and sign.search(article[0])
    )


def main() -> int:
    listed = list(pages(yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))))
    found = [f"{page} {fault}" for page in listed for fault in faults(page)]
    print(
        "\n".join(found)
        or f"{len(listed)} pages, each built, filled and without a failure"
    )
    return bool(found) or not listed


if __name__ == "__main__":
    sys.exit(main())
