"""Every deck of slides, opened from disk without a network: it fits, it lives, it keeps the time, and it prints."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import lecture
import make_slides
import pytest
from browser import Visit, visiting
from bs4 import BeautifulSoup, Tag
from labels import LABEL_FAULTS
from lecture import MINUTES, Mark, NoSuchPart, Page, Part, Slide
from notebooks import plain
from playwright.sync_api import BrowserContext, expect

SCREEN = {"width": 1280, "height": 720}
DECKS = [name for names in make_slides.lectures().values() for name in names]
WITHOUT_FORMULAS = {"introduction", "playground", "conclusions"}
WITHOUT_EXPLORABLES = {"introduction", "conclusions"}
FEW_PARTS = {"introduction", "playground"}
SOME_DECKS = [
    pytest.param(name, marks=pytest.mark.exhaustive if number % 3 else ())
    for number, name in enumerate(DECKS)
]

OVERFLOW = """() => Reveal.getSlides().flatMap((slide, number) => {
  Reveal.slide(number);
  const frame = slide.getBoundingClientRect();
  const kinds = "h1, h2, .points, .fit, .fit > div, figure, table, pre, .math, .robonav, img, svg";
  const inside = [...slide.querySelectorAll(kinds)];
  return inside.filter((part) => !part.closest("aside, .page-only") && part.checkVisibility())
    .map((part) => [part, part.getBoundingClientRect()])
    .filter(([, { left, right, top, bottom }]) =>
      left < frame.left - 1 || right > frame.right + 1 || top < frame.top - 1 || bottom > frame.bottom - 20)
    .map(([part]) => `slide ${number + 1}: ${part.tagName}.${part.className} ${part.textContent.slice(0, 40)}`);
})"""
READABLE, READABLE_FIGURE = 14, 16  # pixels of letters, on a slide of 1280 by 720
SMALL = """([least, leastLive]) => Reveal.getSlides().flatMap((slide, number) => {
  Reveal.slide(number);
  const texts = document.createTreeWalker(slide, NodeFilter.SHOW_TEXT);
  const range = document.createRange();
  const found = [];
  while (texts.nextNode()) {
    const text = texts.currentNode;
    const place = text.parentElement;
    if (!text.textContent.trim() || place.closest("aside, script, style, mjx-container, option")) continue;
    if (!place.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
    range.selectNodeContents(text);
    const { width, height } = range.getBoundingClientRect();
    if (!width || !height) continue;
    const matrix = place.ownerSVGElement && place.getScreenCTM();
    const drawn = matrix ? Math.sqrt(Math.abs(matrix.a * matrix.d - matrix.b * matrix.c)) : place.currentCSSZoom;
    const size = parseFloat(getComputedStyle(place).fontSize) * drawn;
    if (size < (place.closest(".live") ? leastLive : least) - 0.05) {
      found.push(`slide ${number + 1}: ${size.toFixed(1)} px: ${text.textContent.trim().slice(0, 30)}`);
    }
  }
  return found;
})"""
HIDDEN = """() => Reveal.getSlides().flatMap((slide, number) => {
  Reveal.slide(number);
  const frame = slide.getBoundingClientRect();
  const live = [...slide.querySelectorAll(".live .robonav")];
  const kinds = "button, select, input, canvas, svg, p, table";
  const shown = live.flatMap((widget) => [widget, ...widget.querySelectorAll(kinds)])
    .filter((part) => part.checkVisibility() && part.getBoundingClientRect().width > 0);
  const cut = shown.filter((part) => {
    const { left, right, top, bottom } = part.getBoundingClientRect();
    return left < frame.left - 1 || right > frame.right + 1 || top < frame.top - 1 || bottom > frame.bottom - 18;
  });
  const places = live.flatMap((widget) => [widget.closest(".body"), widget, ...widget.querySelectorAll(".hand, .eye")]);
  const scrolls = places.filter((part) => /auto|scroll/.test(getComputedStyle(part).overflowY))
    .filter((part) => part.scrollHeight > part.clientHeight + 1);
  return [...cut, ...scrolls]
    .map((part) => `slide ${number + 1}: ${part.tagName}.${part.className} ${part.textContent.slice(0, 30)}`);
})"""
CROWDED = f"""() => Reveal.getSlides().flatMap((slide, number) => {{
  Reveal.slide(number);
  return [...slide.querySelectorAll(".live svg")].filter((picture) => picture.checkVisibility())
    .flatMap({LABEL_FAULTS}).map((fault) => `slide ${{number + 1}}: ${{fault}}`);
}})"""
CUT_IN_PRINT = """() => [...document.querySelectorAll(".pdf-page")].flatMap((page, number) => {
  const { left, right, bottom } = page.getBoundingClientRect();
  return [...page.querySelectorAll("h1, h2, .points, .hand, .eye, pre, table, img")]
    .filter((part) => part.checkVisibility() && !part.closest("aside"))
    .map((part) => [part, part.getBoundingClientRect()])
    .filter(([, box]) => box.left < left + 30 || box.right > right - 30 || box.bottom > bottom - 15)
    .map(([part]) => `page ${number + 1}: ${part.tagName}.${part.className}`);
})"""
ANSWERED = """async () => {
  const rest = () => new Promise((resolve) => setTimeout(resolve, 150));
  for (const [number, slide] of Reveal.getSlides().entries()) {
    const widget = slide.querySelector(".live .explorable");
    if (!widget) continue;
    Reveal.slide(number);
    widget.querySelector(".guess input").click();
    const first = widget.querySelector(".row:not(.guess) :is(input[type=range], input[type=radio], button:enabled)");
    if (first?.type === "range") {
      first.value = first.max;
      first.dispatchEvent(new Event("input"));
    } else first?.click();
    await rest();
    widget.querySelector(".guess button").click();
    await rest();
  }
}"""
FOLDS = """async () => {
  const found = [];
  for (const [number, slide] of Reveal.getSlides().entries()) {
    Reveal.slide(number);
    const frame = slide.getBoundingClientRect();
    for (const fold of slide.querySelectorAll(".live .hand details")) {
      if (!fold.checkVisibility()) continue;
      fold.open = true;
      await new Promise((resolve) => setTimeout(resolve, 100));
      for (const part of fold.querySelectorAll("*")) {
        const { left, right, top, bottom, width } = part.getBoundingClientRect();
        const cut = left < frame.left || right > frame.right + 1 || top < frame.top || bottom > frame.bottom + 1;
        if (width && cut && part.checkVisibility()) found.push(`slide ${number + 1}: ${part.tagName}`);
      }
      fold.open = false;
    }
  }
  return found;
}"""
SUMMARY = """() => ({
  slides: Reveal.getTotalSlides(),
  minutes: Reveal.getSlides().reduce((sum, slide) => sum + Number(slide.dataset.minutes), 0),
  notes: Reveal.getSlides().filter((slide) => slide.querySelector("aside.notes")?.textContent.length > 60).length,
  formulas: document.querySelectorAll("section mjx-container").length,
  broken: [...document.querySelectorAll("mjx-merror")].map((formula) => formula.textContent),
  raw: [...document.querySelectorAll("section :is(p, li, h2)")].map((text) => text.textContent)
    .filter((text) => /\\\\\\(|\\\\\\[/.test(text)),
  pictures: [...document.images].filter((image) => !image.naturalWidth).map((image) => image.src),
  live: document.querySelectorAll(".live .robonav").length,
})"""


@pytest.fixture(scope="session")
def decks(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of decks, made for this run from the built book."""
    folder = tmp_path_factory.mktemp("slides")
    kept = make_slides.TARGET
    make_slides.TARGET = folder
    try:
        assert make_slides.make(DECKS) == 0
    finally:
        make_slides.TARGET = kept
    return folder


def opened(visit: Visit, address: str) -> dict[str, Any]:
    """Open a deck and say what it holds."""
    visit.page.set_viewport_size(SCREEN)
    visit.page.goto(address)
    visit.page.wait_for_selector("html[data-ready]", state="attached")
    return visit.page.evaluate(SUMMARY)


def a_control_reacts(visit: Visit) -> bool:
    """Press a key on the first control of the first live figure, and say whether anything changes."""
    number = visit.page.evaluate(
        "() => Reveal.getSlides().findIndex((slide) => slide.querySelector('.live .robonav :is(input, button)'))"
    )
    visit.page.evaluate("(number) => Reveal.slide(number)", number)
    widget = visit.page.locator("section.present .live .robonav").first
    before = widget.evaluate("(element) => element.outerHTML")
    control = widget.locator(
        "input[type=range], input[type=radio], button:enabled"
    ).first
    control.focus()
    control.press(
        "ArrowRight"
        if control.evaluate("({ type }) => type !== 'submit' && type !== 'button'")
        else "Enter"
    )
    visit.page.wait_for_timeout(300)
    stays = visit.page.evaluate("() => Reveal.getIndices().h") == number
    return stays and widget.evaluate("(element) => element.outerHTML") != before


@pytest.mark.parametrize("name", DECKS)
def test_deck(context: BrowserContext, decks: Path, name: str) -> None:
    address = (decks / f"{name}.html").as_uri()
    with visiting(context) as visit:
        short = opened(visit, address)
        assert visit.page.evaluate(OVERFLOW) == []
        assert visit.page.evaluate(SMALL, [READABLE, READABLE_FIGURE]) == []
        assert visit.page.evaluate(HIDDEN) == []
        assert visit.page.evaluate(CROWDED) == []
        assert short["minutes"] == MINUTES
        assert name in FEW_PARTS or 14 <= short["slides"] <= 26
        assert short["notes"] >= short["slides"] / 2
        assert short["broken"] == short["raw"] == short["pictures"] == []
        assert (short["formulas"] > 0) or name in WITHOUT_FORMULAS
        if name not in WITHOUT_EXPLORABLES:
            assert short["live"] >= 1
            assert a_control_reacts(visit)
            visit.page.evaluate(ANSWERED)
            assert visit.page.evaluate(HIDDEN) == []
            assert visit.page.evaluate(CROWDED) == []
            assert visit.page.evaluate(FOLDS) == []
        assert visit.errors == visit.external == []


@pytest.mark.parametrize("name", SOME_DECKS)
def test_long_deck(context: BrowserContext, decks: Path, name: str) -> None:
    address = (decks / f"{name}.html").as_uri()
    with visiting(context) as visit:
        long = opened(visit, f"{address}?long")
        assert visit.page.evaluate(OVERFLOW) == []
        assert visit.page.evaluate(SMALL, [READABLE, READABLE_FIGURE]) == []
        assert visit.page.evaluate(HIDDEN) == []
        assert visit.page.evaluate(CROWDED) == []
        assert long["minutes"] == 2 * MINUTES
        assert long["broken"] == long["raw"] == long["pictures"] == []
        assert visit.errors == visit.external == []


@pytest.mark.parametrize("name", SOME_DECKS)
def test_printed(context: BrowserContext, decks: Path, name: str) -> None:
    """The printable version has one page a slide, each with its content."""
    source = (decks / f"{name}.html").read_text("utf-8")
    slides = len(re.findall(r"<section class=\"kind-\w+\" data-minutes[^>]*>", source))
    long = len(
        re.findall(r"<section class=\"kind-\w+\" data-minutes[^>]* data-long>", source)
    )
    with visiting(context) as visit:
        opened_at = f"{(decks / f'{name}.html').as_uri()}?print-pdf"
        opened(visit, opened_at)
        pages = visit.page.locator(".pdf-page")
        assert pages.count() == slides - long
        assert visit.page.evaluate(CUT_IN_PRINT) == []
        printed = visit.page.pdf(prefer_css_page_size=True, print_background=True)
        assert len(re.findall(rb"/Type\s*/Page\b", printed)) == slides - long
        assert visit.errors == []


def test_keyboard(context: BrowserContext, decks: Path) -> None:
    """A live figure keeps the arrows, Page Down turns the slides all the same, and Escape gives the arrows back."""
    with visiting(context) as visit:
        opened(visit, (decks / "dynamic-programming.html").as_uri())

        def at() -> int:
            return visit.page.evaluate("() => Reveal.getIndices().h")

        number = visit.page.evaluate(
            "() => Reveal.getSlides().findIndex((slide) => slide.querySelector('.live input[type=range]'))"
        )
        visit.page.evaluate("(number) => Reveal.slide(number)", number)
        visit.page.locator("section.present input[type=range]").first.focus()
        visit.page.keyboard.press("ArrowRight")
        assert at() == number
        visit.page.keyboard.press("PageDown")
        assert at() == number + 1
        visit.page.keyboard.press("PageUp")
        visit.page.locator("section.present input[type=range]").first.focus()
        visit.page.keyboard.press("Escape")
        visit.page.keyboard.press("ArrowRight")
        assert at() == number + 1


def test_a_click_hits_what_it_points_at(context: BrowserContext, decks: Path) -> None:
    """Also on a larger screen, where the slide and the figure on it are drawn larger."""
    with visiting(context) as visit:
        opened(visit, (decks / "dynamic-programming.html").as_uri())
        visit.page.set_viewport_size({"width": 1920, "height": 1080})
        number = visit.page.evaluate(
            "() => Reveal.getSlides().findIndex((slide) => slide.textContent.includes('Touch a cell to back it up'))"
        )
        visit.page.evaluate("(number) => Reveal.slide(number)", number)
        widget = visit.page.locator("section.present .robonav")
        box = widget.locator(".pictures svg").first.bounding_box()
        assert box is not None
        visit.page.mouse.click(
            box["x"] + box["width"] * 2.5 / 4, box["y"] + box["height"] * 0.5 / 3
        )
        expect(widget.locator(".status")).to_contain_text("in row 1, column 3")


def test_speaker_view(context: BrowserContext, decks: Path) -> None:
    """S opens a window with the slide and its notes, also from disk."""
    with visiting(context) as visit:
        opened(visit, (decks / "dynamic-programming.html").as_uri())
        visit.page.evaluate("() => Reveal.slide(2)")
        with visit.page.expect_popup() as popup:
            visit.page.keyboard.press("s")
        notes = popup.value.locator(".speaker-controls-notes .value")
        notes.wait_for(state="attached")
        popup.value.wait_for_function(
            "() => document.querySelector('.speaker-controls-notes .value').textContent.length > 60"
        )
        popup.value.close()


def test_index_lists_all_decks(decks: Path) -> None:
    listed = (decks / "index.html").read_text("utf-8")
    for name in DECKS:
        assert f'href="{name}.html"' in listed
        assert f'href="{name}.html?long"' in listed


# ---- Without a browser -----------------------------------------------------------------------------------------------

BODY = """
<article class="bd-article"><section id="a"><h1>A page<a class="headerlink" href="#a">#</a></h1>
<p>Why it matters.</p><ul><li><p>do one thing;</p></li></ul>
<section id="b"><h2>First</h2>
<p>A reward counts less if it comes later. More of it here.</p>
<div class="math notranslate" id="equation-eq-9-1"><span class="eqno">(9.1)</span>\\[x\\]</div>
<p>Values of a policy follow from it <span class="bibtex-citation">[<a>Bellman, 1957</a>]</span>. More.</p>
{mark}</section>
<section id="c"><h2>Second</h2><p>Rewards are bounded in this process. And more.</p></section>
<section id="d"><h2>In short</h2><ul><li><p>One claim.</p></li></ul></section>
</section></article>
"""


def page(mark: str = "") -> Page:
    return Page(BODY.format(mark=mark), {})


def marked(show: str, minutes: str = "") -> str:
    return (
        f'<template class="slide" data-show="{show}" data-minutes="{minutes}"><p>A claim</p>'
        "<ul><li><p>one point</p></li></ul><p>Say this.</p></template>"
    )


def test_a_page_without_marks_has_a_deck() -> None:
    slides = lecture.lecture(page())
    assert [slide.kind for slide in slides] == [
        "title",
        "goals",
        "equation",
        "text",
        "summary",
    ]
    equation = slides[2]
    assert equation.title == "A reward counts less if it comes later"
    assert equation.points == ["Values of a policy follow from it"]
    assert "More of it here." in "".join(equation.notes)
    assert sum(slide.minutes["short"] for slide in slides) == MINUTES


def test_a_mark_says_what_a_slide_shows() -> None:
    slides = lecture.lecture(page(marked("eq-9.1", "4")))
    slide = slides[2]
    assert (slide.title, slide.points, slide.minutes["short"]) == (
        "A claim",
        ["one point"],
        4,
    )
    assert [part.kind for part in slide.parts] == ["equation"]
    assert slide.notes[0] == "<p>Say this.</p>"
    assert sum(slide.kind == "equation" for slide in slides) == 1
    assert sum(slide.minutes["short"] for slide in slides) == MINUTES


def test_a_part_that_a_mark_of_another_section_shows_is_not_shown_again() -> None:
    body = BODY.format(mark="")
    early = body.replace('<section id="b">', marked("eq-9.1") + '<section id="b">', 1)
    slides = lecture.lecture(Page(early, {}))
    assert [slide.kind for slide in slides].count("equation") == 1


def test_a_mark_that_shows_nothing_known_is_refused() -> None:
    with pytest.raises(
        NoSuchPart, match=r"a slide shows eq-9\.7, which the page does not have"
    ):
        lecture.lecture(page(marked("eq-9.7")))


def test_a_mark_may_show_what_stood_last_before_it() -> None:
    slide = lecture.lecture(page(marked("last-equation")))[2]
    assert [part.kind for part in slide.parts] == ["equation"]
    with pytest.raises(NoSuchPart, match="no table stands before it"):
        lecture.lecture(page(marked("last-table")))


def test_a_long_listing_continues_on_the_next_slide() -> None:
    """It is cut between two statements, and no line and no minute is lost."""
    code = "def f(x):\n" + "".join(
        f"<span>    </span>if x > {k}:\n<span>        </span>x += {k}\n"
        for k in range(19)
    )
    listing = f'<div class="literal-block-wrapper"><pre>{code}</pre></div>'
    tag = BeautifulSoup(listing, "html.parser").div
    assert isinstance(tag, Tag)
    part = Part("listing", [tag], {"f"}, "", "", lines=39, columns=16)
    slide = Slide("listing", "f", "", [part], fixed=3)
    first, second = lecture.with_short_listings([slide])
    halves = [each.parts[0] for each in (first, second)]
    shown = "\n".join(half.tag.pre.get_text() for half in halves)
    assert shown == re.sub(r"<[^>]+>", "", code).rstrip()
    assert all(half.lines <= lecture.MOST_LINES for half in halves)
    assert halves[1].tag.pre.get_text().startswith("    if x >")
    assert first.fixed + second.fixed == 3


@pytest.mark.parametrize(
    ("on_the_page", "on_the_slide"),
    [
        (r"\[x = 1 \, .\]", r"\[x = 1\]"),
        (r"\[x = 1,\]", r"\[x = 1\]"),
        (
            r"\[\begin{split} x &= 1. \end{split}\]",
            r"\[\begin{split} x &= 1\end{split}\]",
        ),
        (r"\[f(x, y) = 0.5\]", r"\[f(x, y) = 0.5\]"),
        (r"\[x\,\]", r"\[x\,\]"),
    ],
)
def test_a_formula_on_a_slide_ends_no_sentence(
    on_the_page: str, on_the_slide: str
) -> None:
    assert make_slides.without_stop(on_the_page) == on_the_slide


def test_no_formula_of_a_deck_ends_with_a_comma_or_a_full_stop(decks: Path) -> None:
    """The last formula of a deck's own parts; those inside theorems and sentences are theirs."""
    stop = re.compile(r"(?<!\\)[.,;]\s*(?:\\end\{\w+\}\s*)*\\\]")
    for name in DECKS:
        html = BeautifulSoup((decks / f"{name}.html").read_text("utf-8"), "html.parser")
        shown = html.select(".fit > div > div.math")
        assert [part.get_text() for part in shown if stop.search(part.get_text())] == []


def test_an_algorithm_of_a_deck_has_only_the_thesis_s_number(decks: Path) -> None:
    html = BeautifulSoup((decks / "nirl.html").read_text("utf-8"), "html.parser")
    titles = [part.get_text() for part in html.select(".algorithm .admonition-title")]
    assert titles == ["NIRL (Algorithm 10 of the thesis)"]


def test_a_high_picture_is_shown_in_halves(decks: Path) -> None:
    """Both halves are the same file, and the text for those who do not see it is said once."""
    html = BeautifulSoup((decks / "nirl.html").read_text("utf-8"), "html.parser")
    upper, lower = html.select(".halves img")
    assert (upper["src"], upper["class"]) == (lower["src"], ["upper"])
    assert upper["alt"]
    assert lower["alt"] == ""


def test_marks_that_take_too_long_are_refused() -> None:
    with pytest.raises(ValueError, match="minutes of marked slides add up to 60"):
        lecture.lecture(page(marked("eq-9.1", "60")))


def test_minutes_add_up_for_any_slides() -> None:
    for number in range(1, 40):
        slides = [Slide("text", "", "", wanted=1 + k % 3) for k in range(number)]
        lecture.share(slides, "short", MINUTES)
        assert sum(slide.minutes["short"] for slide in slides) == MINUTES
        assert all(slide.minutes["short"] % lecture.STEP == 0 for slide in slides)


def test_notebooks_leave_marks_out() -> None:
    text = (
        "Before.\n\n```{slide} A claim\n:show: eq-9.1\n\n- one point\n```\n\nAfter.\n"
    )
    assert plain(text).split() == ["Before.", "After."]


def test_no_mark_stands_between_an_explorable_and_its_answer() -> None:
    """An explorable is told when the answer that follows it is opened."""
    for name in DECKS:
        source = (make_slides.ROOT / "book" / f"{name}.md").read_text("utf-8")
        assert not re.search(r"explorable\([^\n]*\)\n```\n\n```\{slide\}", source), name


def test_marks_name_parts_of_their_pages(site: Path) -> None:
    """The marks in the built pages are those of the sources."""
    for name in DECKS:
        read = make_slides.read(name)
        marks = [block for block in read.blocks if isinstance(block, Mark)]
        source = (make_slides.ROOT / "book" / f"{name}.md").read_text("utf-8")
        assert len(marks) == len(re.findall(r"^```\{slide\}", source, re.M))
        for mark in marks:
            lecture.shown_by(mark, read)
