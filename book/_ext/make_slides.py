"""``make slides``: a deck of slides for each lecture, from the built book. A lecture is a page of a chapter with marks.

Usage: python make_slides.py [--parts] [PAGE ...], after a build. Without pages it makes all decks and ``index.html``,
in ``_build/slides``, and says which other pages of these parts have no deck and why. With ``--parts`` it prints the
parts of the pages instead, by the names that a mark can show (:mod:`slides`).

Each deck is one HTML file. It works from disk, without a network. ``PAGE.html`` is the lecture of 45 minutes,
``PAGE.html?long`` that of 90, and ``?print-pdf`` (or ``?long&print-pdf``) lays out pages for printing. S opens the
speaker's view. What a deck loads lies beside it; formulas, pictures and interactive figures are those of the page.
"""

from __future__ import annotations

import copy
import json
import os
import re
import shutil
import struct
import sys
from html import escape
from pathlib import Path

import yaml
from bs4 import BeautifulSoup, Tag
from check_site import ROOT, SITE
from lecture import (
    COLUMNS_BESIDE,
    LINES_BELOW,
    LINES_BESIDE,
    MINUTES,
    Page,
    Part,
    Slide,
    inner,
    lecture,
    plain,
)

from robonav.widgets.explorables import EXPLORABLES

TARGET = Path(os.environ.get("BOOK_SLIDES", ROOT / "_build" / "slides"))
SOURCES = ROOT / "book" / "_slides"
BOOK = yaml.safe_load((ROOT / "_config.yml").read_text("utf-8"))["title"]
STATIC = (  # of the built book's, what decks load
    "pygments.css", "drills.css", "drills.js", "drills", "widgets.js", "third-party/mathjax",
    "third-party/LICENSES.md", "favicon.svg",
)  # fmt: skip
STYLES = ("third-party/reveal/reveal.css", "pygments.css", "drills.css", "slides.css")
SCRIPTS = (
    "third-party/mathjax/tex-mml-chtml.js",
    "third-party/reveal/reveal.js",
    "third-party/reveal/notes.js",
    "drills.js",
    "widgets.js",
    "slides.js",
)
MATHJAX = {
    "tex": {"inlineMath": [["\\(", "\\)"]]},
    "options": {"processHtmlClass": "math"},
}
COUNTED = re.compile(  # the book's own number of an algorithm, beside which the thesis's would confuse
    r'(<p class="admonition-title">)<span class="caption-number">[^<]*</span>\s*\((.*?)\)</p>'
)
STOP = re.compile(r"(?:\s|\\[,;:! ])*(?<!\\)[.,;]\s*((?:\\end\{\w+\}\s*)*\\\])")
PARTS = ("Chapter", "Beyond the thesis", "The thesis again")  # with lectures
WITHOUT_DECK = {  # pages of these parts that are no lectures, and why
    "reproduction": "it compares tables and figures one by one, and is for looking up",
    "leaderboard": "it is a table that a reader sorts, and a form for a policy of one's own",
    "use-it-with": "it is a list of recipes for other libraries",
    "cluster": "it is a manual for running experiments on many machines",
    "benchmarks": "it lists times of this package, and is for looking up",
}
WIDE = (
    1.75  # a picture this much wider than high stands below its points, not beside them
)


def chapter_pages() -> dict[str, list[str]]:
    """Return the pages of the thesis's and of later chapters, by the captions of their parts."""
    contents = yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))
    return {
        part["caption"]: [
            entry["file"].removeprefix("book/") for entry in part["chapters"]
        ]
        for part in contents["parts"]
        if part["caption"].startswith(PARTS)
    }


def lectures() -> dict[str, list[str]]:
    """Return the pages that are lectures, those with marks, by the captions of their parts."""
    found = {
        caption: [name for name in names if has_marks(name)]
        for caption, names in chapter_pages().items()
    }
    return {caption: names for caption, names in found.items() if names}


def without_deck() -> dict[str, str]:
    """Return why each of the pages without marks is no lecture; a page without a reason is an error."""
    pages = [name for names in chapter_pages().values() for name in names]
    missing = [name for name in pages if not has_marks(name)]
    if forgotten := [name for name in missing if name not in WITHOUT_DECK]:
        raise ValueError(
            f"no slides are marked in {', '.join(forgotten)}: mark them, as book/instructors.md explains, "
            "or say in WITHOUT_DECK why the page is no lecture"
        )
    return {name: WITHOUT_DECK[name] for name in missing}


def has_marks(name: str) -> bool:
    """Return whether a page says something about its slides."""
    source = (ROOT / "book" / f"{name}.md").read_text("utf-8")
    return re.search(r"^```\{slide\}", source, re.MULTILINE) is not None


def read(name: str) -> Page:
    """Return a built page."""
    titles = {asked.title: name for name, asked in EXPLORABLES.items()}
    return Page((SITE / "book" / f"{name}.html").read_text("utf-8"), titles)


# ---- One slide as HTML -----------------------------------------------------------------------------------------------


def part_html(part: Part) -> str:
    """Return a part as HTML for a slide."""
    tag = part.tag
    if part.kind == "animation":
        scripts = tag.parent.find_all("script") if tag.parent else []
        outside = [str(script) for script in scripts if tag not in script.parents]
        return f'<div class="animated">{inner(tag)}{"".join(outside)}</div>'
    if part.kind == "widget":
        return f'<div class="live">{tag}</div>'
    if part.kind == "drill":
        first = tag.select_one("details.drill")
        return f'<div class="live">{first}</div>' if first else ""
    if part.kind == "figure":
        picture = in_halves(part) if part.halves else inner(tag)
        return f"<figure>{picture}</figure>"
    if part.kind in ("equation", "formula"):
        attributes = " ".join(tag.get("class") or ())
        return f'<div class="{attributes}">{without_stop(inner(tag))}</div>'
    if part.kind == "output":
        lines = sum(len(block.get_text().split("\n")) for block in tag.select("pre"))
        code = tag.select_one(".cell_input")
        if code is not None and lines > LINES_BESIDE:
            return inner(tag).replace(str(code), "")
        return inner(tag)
    attributes = " ".join(tag.get("class") or ())
    content = lit(inner(tag)) if part.kind == "listing" else inner(tag)
    if part.kind == "algorithm":
        content = COUNTED.sub(r"\1\2</p>", content)
    return f'<{tag.name} class="{attributes}">{content}</{tag.name}>'


def without_stop(formula: str) -> str:
    """Return a formula without the comma or full stop of the sentence in which it stands on the page."""
    return STOP.sub(r"\1", formula)


def in_halves(part: Part) -> str:
    """Return a high picture as two: its upper half, and its lower half beside it."""
    tag = copy.copy(part.tag)
    upper = tag.find("img")
    if not isinstance(upper, Tag):
        raise ValueError("a picture that is shown in halves must be an image")
    lower = copy.copy(upper)
    upper["class"], lower["class"] = "upper", "lower"
    lower["alt"] = ""  # the upper one's text tells all
    both = BeautifulSoup("", "html.parser").new_tag("div")
    both["class"], both["style"] = "halves", f"--aspect: {aspect(part) / 2:.3f}"
    upper.replace_with(both)
    both.extend([upper, lower])
    return inner(tag)


def lit(listing: str) -> str:
    """Return a listing in which the lines that compute a numbered equation are lit."""
    lines = [
        f'<span class="hll">{line}</span>' if re.search(r"#.*Eq\. \(", line) else line
        for line in listing.split("\n")
    ]
    return "\n".join(lines)


def aspect(part: Part) -> float:
    """Return how much wider than high a picture is."""
    image = part.tag.find("img", src=True)
    path = SITE / "book" / str(image["src"]) if image else None
    if path is None or path.suffix != ".png" or not path.is_file():
        return 1.4
    width, height = struct.unpack(">II", path.read_bytes()[16:24])
    return width / height * (4 if part.halves else 1)


def layout(slide: Slide) -> str:
    """Return how a slide is laid out: points and parts side by side, or one below the other."""
    kinds = [part.kind for part in slide.parts]
    picture = slide.parts and kinds[-1] in ("figure", "animation")
    if len(kinds) > 1 and picture and aspect(slide.parts[-1]) <= WIDE:
        return "picture-beside"
    if not slide.points and not (len(kinds) > 1 and kinds[-1] == "listing"):
        return "stacked"
    if kinds[:1] in (["figure"], ["animation"]) and len(kinds) == 1:
        return "stacked" if aspect(slide.parts[0]) > WIDE else "beside"
    listing = next((part for part in slide.parts if part.kind == "listing"), None)
    if listing is None or kinds[0] not in ("equation", "figure", "algorithm"):
        return "stacked"
    beside = listing.columns <= COLUMNS_BESIDE and listing.lines > LINES_BELOW
    return "code-beside" if beside else "stacked"


def body(slide: Slide) -> str:
    """Return the content of a slide below its title."""
    points = "".join(f"<li>{point}</li>" for point in slide.points)
    listed = f'<ul class="points">{points}</ul>' if points else ""
    how = layout(slide)
    parts = [part_html(part) for part in slide.parts]
    if how in ("code-beside", "picture-beside"):
        at_right = ("listing",) if how == "code-beside" else ("figure", "animation")
        code = [part.kind in at_right for part in slide.parts]
        left = "".join(
            html for html, is_code in zip(parts, code, strict=True) if not is_code
        )
        right = "".join(
            html for html, is_code in zip(parts, code, strict=True) if is_code
        )
        return (
            f'<div class="fit {how}"><div>{listed}{left}</div><div>{right}</div></div>'
        )
    if not parts:
        return f'<div class="fit {how}">{listed}</div>'
    return f'<div class="fit {how}">{f"<div>{listed}</div>" if listed else ""}<div>{"".join(parts)}</div></div>'


def section(slide: Slide, context: str) -> str:
    """Return a slide as a section of reveal.js."""
    long = " data-long" if slide.long else ""
    notes = f'<p class="minutes"></p>{"".join(slide.notes)}'
    named = slide.section and plain(slide.title) != slide.section
    where = f'<p class="where">{escape(slide.section) if named else ""}</p>'
    if slide.kind == "title":
        content = f'<p class="context">{context}</p><h1>{slide.title}</h1><p class="versions"></p>'
    else:
        content = f'{where}<h2>{slide.title}</h2><div class="body">{body(slide)}</div>'
    time = f'data-minutes="{slide.minutes.get("short", 0):g}" data-minutes-long="{slide.minutes["long"]:g}"'
    return (
        f'<section class="kind-{slide.kind}" {time}{long}>'
        f'{content}<aside class="notes">{notes}</aside></section>'
    )


# ---- One deck --------------------------------------------------------------------------------------------------------


def states(page: Page, slides: list[Slide]) -> str:
    """Return what the deck's widgets hold, without that of others on the page."""
    views = [
        part.tag for slide in slides for part in slide.parts if part.kind == "widget"
    ]
    names = [json.loads(view.get_text())["model_id"] for view in views]
    state = {"state": {name: page.states[name] for name in names}}
    text = json.dumps(state, separators=(",", ":")).replace("</", "<\\/")
    return f'<script type="application/vnd.jupyter.widget-state+json">{text}</script>'


def local(html: str) -> str:
    """Return HTML of a page with the addresses of files as seen from the deck."""
    return re.sub(
        r'((?:src|href|data-source)=")\.\./(_static|_images)/', r"\1\2/", html
    )


def deck(page: Page, slides: list[Slide], caption: str) -> str:
    """Return the deck of a page."""
    sections = local("\n".join(section(slide, escape(caption)) for slide in slides))
    links = "".join(f'<link rel="stylesheet" href="_static/{name}">' for name in STYLES)
    scripts = "".join(
        f'<script defer src="_static/{name}"></script>' for name in SCRIPTS
    )
    return (
        '<!doctype html><html lang="en" data-theme="light" data-mode="light"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<title>{escape(page.title)}: slides</title><link rel="icon" href="_static/favicon.svg">{links}'
        f"<script>window.MathJax = {json.dumps(MATHJAX)}</script>"
        f"{states(page, slides)}{scripts}</head>"
        f'<body class="tex2jax_ignore mathjax_ignore" data-book="{escape(BOOK)}">'
        f'<div class="reveal"><div class="slides">\n{sections}\n</div></div></body></html>\n'
    )


def write_files(decks: dict[str, str]) -> None:
    """Write decks with the files that they load."""
    static = TARGET / "_static"
    static.mkdir(parents=True, exist_ok=True)
    for name in STATIC:
        source = SITE / "_static" / name
        if source.is_dir():
            shutil.copytree(source, static / name, dirs_exist_ok=True)
        elif source.is_file():
            (static / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, static / name)
    shutil.copytree(SOURCES, static, dirs_exist_ok=True)
    for name, html in decks.items():
        (TARGET / f"{name}.html").write_text(html, "utf-8")
        for image in sorted(
            set(re.findall(r'src="(_images/[^"]+|_static/[^"/]+)"', html))
        ):
            if not (TARGET / image).exists():
                (TARGET / image).parent.mkdir(exist_ok=True)
                shutil.copy2(SITE / image, TARGET / image)


def index(made: dict[str, tuple[str, list[Slide]]]) -> str:
    """Return the list of all decks."""
    rows = []
    for caption, names in lectures().items():
        rows.append(f'<tr><th colspan="4" scope="colgroup">{escape(caption)}</th></tr>')
        for name in names:
            title, slides = made[name]
            short = sum(not slide.long for slide in slides)
            rows.append(
                f'<tr><td>{escape(title)}</td><td><a href="{name}.html">{MINUTES} minutes, {short} slides</a></td>'
                f'<td><a href="{name}.html?long">{2 * MINUTES} minutes, {len(slides)} slides</a></td>'
                f'<td><a href="{name}.html?print-pdf">to print</a>, '
                f'<a href="{name}.html?long&amp;print-pdf">long</a></td></tr>'
            )
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        f'<title>Slides: {escape(BOOK)}</title><link rel="icon" href="_static/favicon.svg">'
        '<link rel="stylesheet" href="_static/index.css"></head><body><main>'
        f"<h1>Slides</h1><p>{escape(BOOK)}: a lecture for each page of the chapters, and for the "
        "conclusions. They work without a network.</p>"
        "<p>Page Down and Page Up turn the slides, also while a figure has the keyboard. S opens the speaker's view "
        "with notes and a clock, Escape leaves a figure and then shows all slides. To print, open a version "
        f"to print in Chrome or Chromium, and print it.</p><table>{''.join(rows)}</table></main></body></html>\n"
    )


def make(names: list[str]) -> int:
    """Make the decks of pages, and the list of decks if they are all of them. Return the exit code."""
    captions = {name: caption for caption, part in lectures().items() for name in part}
    try:
        reasons = without_deck() if set(names) == set(captions) else {}
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    made: dict[str, tuple[str, list[Slide]]] = {}
    decks: dict[str, str] = {}
    for name in names:
        page = read(name)
        try:
            slides = lecture(page)
        except ValueError as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
        made[name] = page.title, slides
        decks[name] = deck(page, slides, captions[name])
    write_files(decks)
    if set(made) == set(captions):
        (TARGET / "index.html").write_text(index(made), "utf-8")
    for name, reason in reasons.items():
        print(f"no deck of {name}: {reason}")
    print(f"{len(made)} decks in {TARGET}")
    return 0


def print_parts(names: list[str]) -> None:
    """Print the parts of pages by section, with the names that a mark can show."""
    for name in names:
        for block in read(name).blocks:
            if isinstance(block, Part):
                known = " ".join(sorted(block.names, key=len))
                print(f"{name}: {block.heading}: {known}")


def main() -> int:
    if not (SITE / "index.html").is_file():
        print("the book is not built: run make book first", file=sys.stderr)
        return 2
    known = [name for part in lectures().values() for name in part]
    names = [name for name in sys.argv[1:] if name != "--parts"]
    if "--parts" in sys.argv:
        print_parts(names or known)
        return 0
    if unknown := [name for name in names if name not in known]:
        print(
            f"no page with slides is named {', '.join(unknown)}; there are {', '.join(known)}",
            file=sys.stderr,
        )
        return 2
    return make(names or known)


if __name__ == "__main__":
    sys.exit(main())
