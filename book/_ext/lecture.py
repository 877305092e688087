"""A built page as the slides of a lecture.

The parts of a page (figures, equations, listings, explorables, theorems, questions) are found in its HTML, where
everything is already computed and drawn. Marks in the page (:mod:`slides`) say which parts stand together, under which
claim. Each other part gets a slide of its own: its title is the part's own or the section's heading, its points are
sentences of the text beside it, and the whole text becomes the speaker's notes.

The short lecture takes :data:`MINUTES`. The long one takes twice as long: it has more slides, and more time for each.
Marked slides belong to both unless they say ``long``. In sections without marks the most telling parts do.
"""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from html import escape, unescape

from bs4 import BeautifulSoup, NavigableString, Tag

MINUTES = 45  # of the short lecture; the long one has as many more
STEP = 0.5  # minutes; the time of a slide is a multiple of it
MOST_POINTS = 3
LENGTHS_OF_A_POINT = range(20, 126)  # characters
LINES_BESIDE, COLUMNS_BESIDE = 20, 70  # of a listing beside its equation
LINES_BELOW = 8  # of a listing below its equation
MOST_LINES = 25  # of a listing on one slide; a longer one gets two
LONGEST_TITLE = 76  # characters
MOST_WANTED = (
    50  # minutes of slides that only the long lecture has, before they share its time
)

STATE = re.compile(
    r'<script type="application/vnd\.jupyter\.widget-state\+json">(.*?)</script>', re.S
)
ARTICLE = re.compile(r"<article\b.*?</article>", re.S)
SENTENCE = re.compile(
    r"(?:(?<!\bFig)(?<!\bEq)(?<!\bSec)\.|[?!])['”)]?(?=\s+[A-Z0-9(]|\s*$)|:\s*$"
)
ASIDE = re.compile(
    r"\s*\((?:Fig|Table|Algorithm|Eq)[^()]*\)"
)  # where the thesis has it
PROOFS = ("theorem", "lemma", "definition", "proposition", "corollary", "axiom")
WANTED = {  # minutes and rank of a part's slide: the higher the rank, the sooner it is in the short lecture
    "title": (1, 9), "goals": (1.5, 9), "summary": (2, 9), "homework": (1, 9),
    "widget": (4, 6), "figure": (2.5, 5), "animation": (2.5, 5), "equation": (3, 5), "algorithm": (3, 5),
    "theorem": (2.5, 4), "mistakes": (2, 4), "quiz": (2, 3.5), "drill": (3, 3), "table": (2, 3), "listing": (2, 3),
    "formula": (2, 2), "box": (1.5, 2.5), "proof": (3, 1), "output": (1.5, 1.5), "text": (1.5, 1.5), "list": (1.5, 2),
}  # fmt: skip
NOT_A_POINT = re.compile(  # beginnings of sentences that need the one before, or talk about the page
    r"(for example|for instance|here|the next|next|below|above|see|this|these|it|they|so|then|but|both|one|to see|"
    r"in words|that|the other|the same|he|she|take|you|now|first|second|third|their|its|such|and|also|again|compare|"
    r"everything|section|at (first|last)|after|all methods|more to try|think first|press|\(|all (two|three|four)|"
    r"each of (them|these)|the (figure|picture|bar|player|listing|curve|table|code|example|function))\b",
    re.I,
)
NO_CLAIM = re.compile(
    r"\b(this page|the thesis|this book|above|below|following|last page|next page|\[\d{4}\])|\(\d\.\d+\)"
)


@dataclass
class Part:
    """Something that a slide can show, with the text of the page beside it."""

    kind: str
    tags: list[Tag]
    names: set[str]
    heading: str
    section: str
    before: list[Tag] = field(default_factory=list)
    after: list[Tag] = field(default_factory=list)
    lines: int = 0  # of a listing
    columns: int = 0
    halves: bool = False  # of a picture: the lower half stands beside the upper one

    @property
    def tag(self) -> Tag:
        return self.tags[0]


@dataclass
class Mark:
    """What a page says about a slide."""

    title: str
    show: list[str]
    minutes: float | None
    long: bool
    halves: bool
    points: list[str]
    notes: list[str]
    section: str


@dataclass
class Slide:
    """One slide: HTML of its title, points and notes, and the parts that it shows."""

    kind: str
    title: str
    section: str
    parts: list[Part] = field(default_factory=list)
    points: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    wanted: float = 1
    rank: float = 0
    fixed: float | None = None  # minutes that a mark sets
    marked: bool = False
    long: bool = False
    minutes: dict[str, float] = field(
        default_factory=dict
    )  # in the short and in the long lecture


class NoSuchPart(ValueError):
    """A mark shows something that the page does not have."""


def key(name: str) -> str:
    """Return a name as it is compared: labels lose their dots on the way into HTML."""
    plain = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
    return plain.removeprefix("equation-")


def plain(html: str | Tag) -> str:
    """Return the text of HTML on one line."""
    text = html.get_text() if isinstance(html, Tag) else re.sub(r"<[^>]+>", "", html)
    return " ".join(unescape(text).split())


def inner(tag: Tag) -> str:
    """Return a tag's content as HTML for a slide, where links between pages lead nowhere."""
    kept = copy.copy(tag)
    for link in kept.select(".headerlink"):
        link.decompose()
    for link in kept.find_all("a"):
        link.unwrap()
    for section in kept.find_all("section"):  # reveal.js would take it for a slide
        section.name = "div"
    return kept.decode_contents().strip()


def first_sentence(paragraph: Tag) -> str:
    """Return the first sentence of a paragraph as HTML, without citations."""
    kept = copy.copy(paragraph)
    for cited in kept.select(".bibtex-citation, .headerlink"):
        if plain(cited).startswith(("[", "#")):
            cited.decompose()
    found = ""
    for child in kept.children:
        if not isinstance(child, NavigableString):
            found += str(child)
            continue
        end = SENTENCE.search(str(child))
        if end:
            found += escape(str(child)[: end.end()], quote=False)
            break
        found += escape(str(child), quote=False)
    found = re.sub(r"</?a\b[^>]*>", "", " ".join(found.split()))
    return re.sub(r"\s+([.,:;])", r"\1", found).rstrip(".:,;").strip()


def points_of(paragraphs: Iterable[Tag], most: int = MOST_POINTS) -> list[str]:
    """Return first sentences that can stand alone, those nearest to the part that they belong to."""
    found = []
    for paragraph in paragraphs:
        if paragraph.name != "p":
            continue
        sentence = first_sentence(paragraph)
        text = plain(sentence)
        whole = text[:1].isupper() or text.startswith("\\(")
        good = whole and not NOT_A_POINT.match(text) and not NO_CLAIM.search(text)
        if len(text) in LENGTHS_OF_A_POINT and good:
            found.append(sentence)
    return found[-most:]


# ---- The parts of a page ---------------------------------------------------------------------------------------------


def kind_of(tag: Tag) -> str:
    """Return what a block of a page is."""
    classes = set(tag.get("class") or ())
    if tag.name == "template":
        return "mark"
    if tag.name == "p":
        return "text"
    if tag.name in ("ul", "ol", "dl"):
        return "list"
    if tag.name == "figure":
        return "figure"
    if "math" in classes:
        return "equation" if tag.select_one(".eqno") else "formula"
    if "cell" in classes:
        return kind_of_cell(tag)
    if tag.select_one(".function-source"):
        return "listing"
    if "proof" in classes:
        if "algorithm" in classes:
            return "algorithm"
        return "theorem" if classes & set(PROOFS) else "proof"
    if "quiz" in classes:
        return "quiz"
    if "drills" in classes:
        return "drill"
    if "dropdown" in classes:
        return "answer"
    if tag.name == "table" or tag.select_one("table"):
        return "table"
    if tag.name == "details":
        return "answer"
    if "admonition" in classes:
        return "box"
    return "nothing"


def kind_of_cell(cell: Tag) -> str:
    """Return what a cell of a notebook shows."""
    output = cell.select_one(".cell_output")
    if output is None:
        return "nothing"
    if output.select_one("script[type$='widget-view+json']"):
        return "widget"
    if output.select_one(".animation"):
        return "animation"
    if output.select_one("figure"):
        return "figure"
    if output.select_one("table"):
        return "table"
    if output.select_one("pre"):
        return "output"
    return "nothing"


class Page:
    """A built page: its title, its sections, and what its widgets hold."""

    def __init__(self, html: str, titles: dict[str, str]) -> None:
        state = STATE.search(html)
        self.states: dict[str, dict] = json.loads(state[1])["state"] if state else {}
        article = ARTICLE.search(html)
        if article is None:
            raise ValueError("a page must have an article")
        self.article = BeautifulSoup(article[0], "html.parser")
        self.title = plain(self.article.h1).rstrip("#")
        self.explorables = titles
        self.counts: dict[str, int] = {}
        self.blocks = list(self.read())

    def read(self) -> Iterator[Part | Mark]:
        """Yield the parts and marks of the page in order; the text between them stands with the parts."""
        top = self.article.find("section")
        assert isinstance(top, Tag)
        yield from self.read_section(top, "", "")

    def read_section(
        self, place: Tag, section: str, heading: str
    ) -> Iterator[Part | Mark]:
        """Yield what is in one section, and in the sections in it."""
        pending: list[Tag] = []
        last: Part | None = None
        found: list[Part | Mark] = []

        def keep(part: Part) -> None:
            nonlocal pending, last
            part.before, pending, last = pending, [], part
            found.append(part)

        for tag in place.find_all(recursive=False):
            if tag.name in ("h1", "h2", "h3", "h4"):
                if tag.name != "h1":
                    heading = plain(tag).rstrip("#")
                    section = section or heading
                continue
            if tag.name == "section":
                self.close(found, pending, section, heading)
                pending, last = [], None
                found.extend(self.read_section(tag, section, ""))
                continue
            kind = kind_of(tag)
            if kind == "mark":
                mark = self.mark(tag, section)
                if not mark.show:  # it stands for the text before it
                    mark.notes += [
                        f"<{text.name}>{inner(text)}</{text.name}>" for text in pending
                    ]
                    pending = []
                found.append(mark)
            elif kind == "answer":
                if last is not None:
                    last.after.append(tag)
            elif kind in ("text", "list"):
                pending.append(tag)
            elif kind == "listing" and tag.name == "details":
                for wrapper in tag.select(".literal-block-wrapper"):
                    keep(self.part("listing", wrapper, section, heading))
            elif kind != "nothing":
                keep(self.part(kind, tag, section, heading))
        self.close(found, pending, section, heading)
        yield from found

    def close(
        self, found: list[Part | Mark], pending: list[Tag], section: str, heading: str
    ) -> None:
        """Give the text at the end of a section to its last part, or make a part of it."""
        parts = [
            part
            for part in found
            if isinstance(part, Part) and part.heading == (heading or self.title)
        ]
        if not pending:
            return
        if parts:
            parts[-1].after += pending
        else:
            lists = [tag for tag in pending if tag.name != "p"]
            kind = "list" if lists else "text"
            part = self.part(kind, lists[0] if lists else pending[0], section, heading)
            part.before = pending
            found.append(part)

    def part(self, kind: str, tag: Tag, section: str, heading: str) -> Part:
        """Return a part with its names."""
        self.counts[kind] = self.counts.get(kind, 0) + 1
        names = {f"{kind}-{self.counts[kind]}"}
        names |= {key(found) for found in (tag.get("id"),) if found}
        shown: Tag | None = tag
        if kind == "figure":
            shown = tag if tag.name == "figure" else tag.select_one("figure")
        elif kind == "widget":
            shown = tag.select_one("script[type$='widget-view+json']")
        elif kind == "animation":
            shown = tag.select_one(".cell_output")
        elif kind == "table":
            inside = ".cell_output, .pst-scrollable-table-container, table"
            shown = tag.select_one(inside) or tag  # a fold is left out
        assert shown is not None
        if shown.get("id"):
            names.add(key(str(shown["id"])))
        names |= {key(str(inside["id"])) for inside in shown.select("div.math[id]")}
        part = Part(kind, [shown], names, heading or self.title, section)
        if kind == "listing":
            code = shown.pre.get_text().rstrip("\n").split("\n")
            part.lines, part.columns = len(code), max(map(len, code))
            name = plain(shown.select_one(".caption-text")).replace(" ", "")
            pieces = name.split(".")
            part.names |= {key(".".join(pieces[at:])) for at in range(len(pieces))}
        if kind == "widget":
            part.names |= {key(name) for name in self.widget_names(shown)}
        return part

    def widget_names(self, view: Tag) -> Iterator[str]:
        """Yield the names of a widget: that of an explorable, or of a lab."""
        state = self.states[json.loads(view.get_text())["model_id"]]["state"]
        module = state.get("_anywidget_id", "")
        title = state.get("data", {}).get("title")
        if module.endswith(".Explorable") and title in self.explorables:
            yield self.explorables[title]
        elif module:
            yield module.split(".")[-2]

    def widget_title(self, view: Tag) -> str | None:
        """Return the title of an explorable."""
        state = self.states[json.loads(view.get_text())["model_id"]]["state"]
        title = state.get("data", {}).get("title")
        return title if isinstance(title, str) else None

    def mark(self, tag: Tag, section: str) -> Mark:
        """Return what a mark says."""
        title, *rest = tag.find_all(recursive=False)
        minutes = str(tag.get("data-minutes") or "")
        return Mark(
            title=inner(title),
            show=str(tag.get("data-show") or "").split(),
            minutes=float(minutes) if minutes else None,
            long=tag.has_attr("data-long"),
            halves=tag.has_attr("data-halves"),
            points=[
                inner(item.p or item)
                for block in rest
                if block.name in ("ul", "ol")
                for item in block.find_all("li", recursive=False)
            ],
            notes=[str(block) for block in rest if block.name not in ("ul", "ol")],
            section=section,
        )


# ---- The slides of a page --------------------------------------------------------------------------------------------


def notes_of(part: Part) -> list[str]:
    """Return the text beside a part as notes."""
    notes = []
    for tag in part.before + part.after:
        if kind_of(tag) == "answer":
            content = tag.select_one(".sd-summary-content") or tag
            notes.append(f"<p><strong>Answer.</strong></p>{inner(content)}")
        else:
            notes.append(f"<{tag.name}>{inner(tag)}</{tag.name}>")
    return notes


def title_of(part: Part, page: Page) -> str:
    """Return the title of a part's slide: its own, or the heading above it."""
    if part.kind == "widget":
        return escape(page.widget_title(part.tag) or part.heading)
    if part.kind in ("theorem", "algorithm"):
        named = re.search(
            r"\((.+)\)\s*$", plain(part.tag.select_one(".admonition-title"))
        )
        own = (
            re.sub(r"(\. In the thesis.*|\s*\([^()]*\)?)$", "", named[1])
            if named
            else ""
        )
        return escape(own if 0 < len(own) <= 70 else part.heading)
    if part.kind == "figure":
        caption = part.tag.select_one(".caption-text") or part.tag.select_one(
            "figcaption"
        )
        if caption is not None:
            sentence = ASIDE.sub("", first_sentence(caption))
            if len(plain(sentence)) <= 64:
                return sentence
    if part.kind == "proof":
        return f"{escape(part.heading)}: the proof"
    if part.kind == "listing" and part.lines > LINES_BELOW:
        pieces = plain(part.tag.select_one(".caption-text")).replace(" ", "").split(".")
        of_class = len(pieces) > 1 and pieces[-2][0].isupper()
        name = ".".join(pieces[-2:] if of_class else pieces[-1:])
        return f"<code>{escape(name)}</code> as it runs"
    return escape(part.heading)


def of_part(part: Part, page: Page) -> Slide:
    """Return the slide of one part."""
    wanted, rank = WANTED[part.kind]
    rank -= (
        max(0, part.lines - LINES_BESIDE) / 6
    )  # long code is hard to read in a lecture
    slide = Slide(
        part.kind,
        title_of(part, page),
        part.heading,
        [part],
        notes=notes_of(part),
        wanted=wanted,
        rank=rank,
    )
    if part.kind in ("figure", "equation", "formula", "animation"):
        following = [tag for tag in part.after if tag.name == "p"][:1]
        slide.points = points_of(part.before + following)
    elif part.kind in ("theorem", "listing", "table", "output", "box"):
        slide.points = points_of(part.before, 1)
    elif part.kind in ("text", "list"):
        slide.parts, slide.section = [], part.heading
        slide.points = points_of(part.before, 5)
        if part.kind == "list":
            slide.points = list_points(part.tag)
        elif not slide.points:
            slide.points = [first_sentence(tag) for tag in part.before[:4]]
    claim(slide, part)
    return slide


def claim(slide: Slide, part: Part) -> None:
    """Make a short point the title of a slide that has only the heading of its section."""
    if slide.title != escape(part.heading) or part.kind in ("quiz", "drill", "list"):
        return
    short = [point for point in slide.points if len(plain(point)) <= LONGEST_TITLE]
    if short:
        slide.title = short[0]
        slide.points.remove(short[0])


def list_points(tag: Tag, most: int = 6) -> list[str]:
    """Return the items of a list as points: each one's name in bold, or its first sentence."""
    points = []
    for item in tag.find_all("li", recursive=False)[:most]:
        text = item.p or item
        sentence = first_sentence(text)
        bold = text.find(["strong", "code"], recursive=False)
        if len(plain(sentence)) > 150 and isinstance(bold, Tag):
            sentence = str(bold)
        points.append(sentence)
    return points


def joins(first: Slide, second: Slide) -> bool:
    """Return whether an equation and what follows it, an equation or a short listing, fit on one slide."""
    if first.kind != "equation" or first.parts[0].heading != second.parts[0].heading:
        return False
    kinds = [part.kind for part in first.parts]
    part = second.parts[0]
    if part.kind == "equation":
        return kinds == ["equation"] and len(part.before) <= 2
    beside = part.lines <= LINES_BESIDE and part.columns <= COLUMNS_BESIDE
    return (
        part.kind == "listing"
        and kinds[-1] == "equation"
        and (beside or part.lines <= LINES_BELOW)
    )


def paired(slides: list[Slide]) -> list[Slide]:
    """Put equations and their short listings together."""
    together: list[Slide] = []
    for slide in slides:
        previous = together[-1] if together else None
        if (
            previous
            and slide.parts
            and previous.parts
            and not previous.marked
            and joins(previous, slide)
        ):
            previous.parts += slide.parts
            previous.notes += slide.notes
            previous.points = previous.points[-2:] or slide.points[:1]
            previous.wanted += 0.5
        else:
            together.append(slide)
    return together


def of_section(name: str, blocks: list[Part | Mark], page: Page) -> list[Slide]:
    """Return the slides of one section. Its marks are the short lecture; what they leave out is for the long one.

    What a mark of another section shows is not shown again.
    """
    marks = [block for block in blocks if isinstance(block, Mark)]
    everywhere = [block for block in page.blocks if isinstance(block, Mark)]
    taken = {id(part) for mark in everywhere for part in shown_by(mark, page)}
    marked: dict[int, Slide] = {}
    for mark in marks:
        shown = [replace(part, halves=mark.halves) for part in shown_by(mark, page)]
        wanted = sum(WANTED[part.kind][0] for part in shown) or 2
        notes = mark.notes + [note for part in shown for note in notes_of(part)]
        kind = shown[0].kind if shown else "text"
        marked[id(mark)] = Slide(
            kind,
            mark.title,
            name,
            shown,
            mark.points,
            notes,
            wanted,
            8,
            mark.minutes,
            True,
            mark.long,
        )
    slides: list[Slide] = []
    for block in blocks:
        if isinstance(block, Mark):
            slides.append(marked[id(block)])
        elif id(block) not in taken:
            slide = of_part(block, page)
            slide.long = bool(marks) or name == "Related work"
            slides.append(slide)
    return paired(slides)


def shown_by(mark: Mark, page: Page) -> list[Part]:
    """Return the parts that a mark shows."""
    parts = [block for block in page.blocks if isinstance(block, Part)]
    before = page.blocks[
        : next(at for at, block in enumerate(page.blocks) if block is mark)
    ]
    return [
        last(name.removeprefix("last-"), before)
        if name.startswith("last-")
        else named(name, parts)
        for name in mark.show
    ]


def last(kind: str, blocks: list[Part | Mark]) -> Part:
    """Return the last part of a kind."""
    found = [
        block for block in blocks if isinstance(block, Part) and block.kind == kind
    ]
    if not found:
        raise NoSuchPart(f"a slide shows last-{kind}, but no {kind} stands before it")
    return found[-1]


def named(name: str, parts: list[Part]) -> Part:
    """Return the part of a name."""
    found = [part for part in parts if key(name) in part.names]
    if not found:
        known = sorted({min(part.names, key=len) for part in parts})
        raise NoSuchPart(
            f"a slide shows {name}, which the page does not have; it has {', '.join(known)}"
        )
    # an explorable may be called as a function is, but for the dots of its module
    return next(
        (part for part in found if ("." in name) != (part.kind == "widget")), found[0]
    )


# ---- The sections that every page has --------------------------------------------------------------------------------


def items_of(tags: Iterable[Tag]) -> list[str]:
    """Return the items of the lists among some tags as HTML."""
    return [
        inner(item.p or item)
        for tag in tags
        if tag.name in ("ul", "ol")
        for item in tag.find_all("li", recursive=False)
    ]


def summary(name: str, parts: list[Part]) -> list[Slide]:
    """Return the slide of the section "In short": its items."""
    points = items_of(part.tag for part in parts)
    return [Slide("summary", "In short", name, points=points, wanted=2, rank=9)]


def questions(name: str, parts: list[Part]) -> list[Slide]:
    """Return a slide for each quiz of "Check yourself", and one for its drills. The first one is in both lectures."""
    asked = [part for part in parts if part.kind in ("quiz", "drill")]
    slides = []
    for count, part in enumerate(asked):
        wanted, rank = WANTED[part.kind]
        title = "Check yourself" if part.kind == "quiz" else "Drills"
        slide = Slide(part.kind, title, name, [part], wanted=wanted)
        slide.rank = 9 if count == 0 else rank - count / 4
        slide.long = count > 1
        slides.append(slide)
    return slides


def mistakes(name: str, parts: list[Part]) -> list[Slide]:
    """Return the slide of "Common mistakes": what each is called, with the whole text in the notes."""
    tags = [tag for part in parts for tag in part.before + part.after + part.tags]
    lists = [tag for tag in dict.fromkeys(tags) if tag.name == "ul"]
    slide = Slide("mistakes", "Common mistakes", name, wanted=2, rank=4)
    slide.points = [point for tag in lists for point in list_points(tag, 7)][:6]
    slide.notes = [f"<ul>{inner(tag)}</ul>" for tag in lists]
    return [slide] if slide.points else []


def homework(name: str, parts: list[Part]) -> list[Slide]:
    """Return the slide of "Exercises": those that belong to the page."""
    found = dict.fromkeys(tag for part in parts for tag in part.before + part.tags)
    slide = Slide("homework", "Homework", name, wanted=1, rank=9)
    slide.points = items_of(found)
    slide.notes = [f"<p>{inner(tag)}</p>" for tag in found if tag.name == "p"]
    return [slide] if slide.points else []


def nothing(name: str, parts: list[Part]) -> list[Slide]:
    """Return no slide: the section is to be read."""
    return []


BY_HEADING = {  # what makes the slides of these sections
    "In short": summary,
    "Check yourself": questions,
    "Drills": questions,
    "Common mistakes": mistakes,
    "Exercises": homework,
    "Where to read on": nothing,
    "References": nothing,
}


def of_heading(name: str, blocks: list[Part | Mark], page: Page) -> list[Slide]:
    """Return the slides of a section: by its heading, or as its parts and marks say."""
    if name in BY_HEADING:
        parts = [block for block in blocks if isinstance(block, Part)]
        return BY_HEADING[name](name, parts)
    return of_section(name, blocks, page)


def opening(page: Page, blocks: list[Part | Mark]) -> list[Slide]:
    """Return the title slide, the goals, and slides of what stands above the first heading."""
    slides = [Slide("title", escape(page.title), "", wanted=1, rank=9)]
    parts = [block for block in blocks if isinstance(block, Part)]
    text = [tag for part in parts[:1] for tag in part.before]
    goals = next((tag for tag in text if tag.name == "ul"), None)
    slides[0].notes = [f"<p>{inner(tag)}</p>" for tag in text if tag.name == "p"]
    if goals is not None:
        points = [
            inner(item.p or item).rstrip(";.")
            for item in goals.find_all("li", recursive=False)
        ]
        slides.append(
            Slide(
                "goals",
                "After this lecture you can",
                "",
                points=points,
                wanted=1.5,
                rank=9,
            )
        )
    rest = [
        block
        for block in blocks
        if not (isinstance(block, Part) and block.kind in ("text", "list"))
    ]
    return slides + (of_section("", rest, page) if rest else [])


def lecture(page: Page) -> list[Slide]:
    """Return the slides of a page, each with its minutes, in the order of the page; the homework comes last."""
    sections: dict[str, list[Part | Mark]] = {"": []}
    for block in page.blocks:
        sections.setdefault(block.section, []).append(block)
    slides = opening(page, sections.pop(""))
    for name, blocks in sections.items():
        slides += of_heading(name, blocks, page)
    slides.sort(
        key=lambda slide: (
            (slide.kind in ("summary", "homework")) + (slide.kind == "homework")
        )
    )
    slides = with_short_listings(choose(slides))
    share([slide for slide in slides if not slide.long], "short", MINUTES)
    share(slides, "long", 2 * MINUTES)
    return slides


def place_to_cut(lines: list[str]) -> int:
    """Return where a listing is cut in two: near its middle, before a line that is indented least."""
    middle = len(lines) / 2

    def unfit(at: int) -> tuple[float, float]:
        line, before = lines[at], lines[at - 1]
        inside = len(line) - len(line.lstrip()) if line.strip() else 99
        opened = before.rstrip().endswith((":", "(", "[", "{", ","))
        return inside + 8 * opened - 2 * (not before.strip()), abs(at - middle)

    return min(range(len(lines) // 2 - 5, len(lines) // 2 + 6), key=unfit)


def cut(part: Part) -> list[Part]:
    """Return a listing as two, if it is too long for one slide."""
    if part.kind != "listing" or part.lines <= MOST_LINES:
        return [part]
    lines = part.tag.pre.get_text().rstrip("\n").split("\n")
    code = part.tag.pre.decode_contents().rstrip("\n").split("\n")
    if len(code) != len(lines):
        raise ValueError(f"the markup of {min(part.names)} spans lines")
    at = place_to_cut(lines)
    halves = []
    for found in (code[:at], code[at:]):
        tag = copy.copy(part.tag)
        text = "\n".join(found).strip("\n")
        # outside of pre the parser makes one space of those that indent a line
        tag.pre.replace_with(BeautifulSoup(f"<pre>{text}</pre>", "html.parser"))
        half = Part("listing", [tag], part.names, part.heading, part.section)
        texts = tag.pre.get_text().split("\n")
        half.lines, half.columns = len(texts), max(map(len, texts))
        halves.append(half)
    halves[0].before, halves[1].after = part.before, part.after
    return halves


def with_short_listings(slides: list[Slide]) -> list[Slide]:
    """Return slides on which each listing is short enough to be read: a long one continues on the next slide."""
    found = []
    for slide in slides:
        found.append(slide)
        pieces = [cut(part) for part in slide.parts]
        later = [halves[1] for halves in pieces if len(halves) > 1]
        if not later:
            continue
        rest = replace(slide, title=f"{slide.title} (continued)", parts=later)
        rest.points, rest.minutes = [], {}
        rest.notes = ["<p>The second half of the function.</p>"]
        slide.parts = [halves[0] for halves in pieces]
        rest.wanted = slide.wanted = slide.wanted / 2
        if slide.fixed:
            rest.fixed = max(STEP, slide.fixed / 2 // STEP * STEP)
            slide.fixed -= rest.fixed
        found.append(rest)
    return found


def choose(slides: list[Slide]) -> list[Slide]:
    """Return the slides of both lectures. The short one has the highest ranks, and something from under each heading.

    What has the lowest ranks is in none.
    """
    seen: dict[tuple[str, str], int] = {}
    for slide in sorted(slides, key=lambda slide: -slide.rank):
        if not slide.marked and slide.kind not in ("quiz", "drill"):
            slide.rank += 1.5 if (slide.section, "") not in seen else 0
            slide.rank -= 0.7 * seen.get((slide.section, slide.kind), 0)
        seen[slide.section, ""] = 1
        seen[slide.section, slide.kind] = seen.get((slide.section, slide.kind), 0) + 1
    lowest = sorted(reversed(slides), key=lambda slide: slide.rank)  # noqa: C414
    short = [slide for slide in lowest if not slide.long]
    time = sum(slide.fixed or slide.wanted for slide in short)
    for slide in short:
        if time <= MINUTES * 1.1 or slide.marked or slide.rank >= 9:
            break
        slide.long = True
        time -= slide.wanted
    longer = [slide for slide in lowest if slide.long]
    time = sum(slide.fixed or slide.wanted for slide in longer)
    left_out = set()
    for slide in longer:
        if time <= MOST_WANTED or slide.marked:
            break
        left_out.add(id(slide))
        time -= slide.wanted
    return [slide for slide in slides if id(slide) not in left_out]


def share(slides: list[Slide], lecture: str, minutes: float) -> None:
    """Set the minutes of slides so that they add up: set ones stay, the others are in proportion."""
    fixed = sum(slide.fixed or 0 for slide in slides)
    free = [slide for slide in slides if slide.fixed is None]
    left = minutes - fixed
    if left < STEP * len(free) or (not free and left):
        raise ValueError(
            f"the minutes of marked slides add up to {fixed:g}; "
            f"{len(free)} other slides need the rest of {minutes}"
        )
    spare = left - STEP * len(free)
    whole = sum(slide.wanted for slide in free)
    exact = {id(slide): spare * slide.wanted / whole / STEP for slide in free}
    for slide in slides:
        extra = 0 if slide.fixed else int(exact[id(slide)]) * STEP
        slide.minutes[lecture] = (slide.fixed or STEP) + extra
    missing = round((left - sum(slide.minutes[lecture] for slide in free)) / STEP)
    for slide in sorted(free, key=lambda slide: -(exact[id(slide)] % 1))[:missing]:
        slide.minutes[lecture] += STEP
