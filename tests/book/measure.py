"""Measure the built pages in headless Chromium, and compare the numbers with the limits of the book.

Usage: python tests/book/measure.py [PAGE ...]      (all pages of the book if none is named)

For each page the script prints the megabytes of the page without the files that all pages share, the megabytes that
Chromium downloads with an empty cache, and the seconds from a local server until formulas and widgets are ready. A
second table holds what the widgets of the named pages do: how long they learn and drive new maps, how long the page
answers no touch meanwhile, and the frame rate of the playground. Each number is the best of three visits. Times depend
on the machine, so only this script compares them with limits. Run it alone.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import yaml
from browser import DESKTOP, ROOT, SITE, chromium, served, visiting
from check_site import pages
from playwright.sync_api import Locator, Page

VISITS = 3
SLOWEST, LARGEST_PAGE, LARGEST_SITE = (
    2.0,
    5e6,
    60e6,
)  # seconds, bytes (a page without what all share), bytes
SILENCE = 100  # milliseconds until a page answers a touch

FRAMES = """() => new Promise((done) => {
  const times = [];
  const tick = (now) => (times.push(now) < 181 ? requestAnimationFrame(tick) : done(times));
  requestAnimationFrame(tick);
})"""
DOWNLOADED = """() => [...performance.getEntriesByType("navigation"), ...performance.getEntriesByType("resource")]
  .reduce((sum, { encodedBodySize }) => sum + encodedBodySize, 0)"""
LEARN = """(button, steps) => new Promise((done) => {
  const panel = button.closest(".training");
  const [status, bar] = [panel.querySelector(".status"), panel.querySelector(".progress")];
  const began = performance.now();
  let [last, silence, learned] = [began, 0, null];
  const tick = () => {
    const now = performance.now();
    [silence, last] = [Math.max(silence, now - last), now];
    const over = status.textContent.startsWith("Done");
    if (learned === null && (over || parseInt(bar.getAttribute("aria-valuetext"), 10) > steps)) learned = now;
    if (over) done([(learned - began) / 1000, (now - learned) / 1000, silence]);
    else setTimeout(tick);
  };
  button.click();
  setTimeout(tick);
})"""


class Times(NamedTuple):
    """What a training takes: seconds to learn, seconds to drive new maps, milliseconds without an answer to a touch."""

    learn: float
    drive: float
    silence: float


@dataclass(frozen=True)
class Training:
    """A training that a page offers as it is opened.

    Parameters
    ----------
    page, lab, action : str
        The page, the selector of the lab, and the name of the button.
    steps : int
        The steps of learning; later steps of the progress are maps that are driven.
    what : str
        What is learned.
    limit : float
        Seconds that learning may take.
    """

    page: str
    lab: str
    action: str
    steps: int
    what: str
    limit: float

    def button(self, page: Page) -> Locator:
        """The button on the opened page that starts the training."""
        lab = page.locator(self.lab)
        return lab.get_by_role("button", name=self.action, exact=True)

    def times(self, address: str, runs: int = 1) -> list[Times]:
        """Train ``runs`` times on the page, which is opened once."""
        with chromium(viewport=DESKTOP) as context, visiting(context) as visit:
            visit.open(f"{address}/{self.page}.html")
            button = self.button(visit.page)
            return [Times(*button.evaluate(LEARN, self.steps)) for _ in range(runs)]


IMITATION = Training(
    "book/policy-learning", ".imitation-lab", "Train", 300, "L-BFGS, 300 iterations on 25 demonstrations", 1.0,
)  # fmt: skip
MAPS_DRIVEN = 2.0  # seconds for 200 maps, by one robot
TRAININGS = (
    IMITATION,
    Training("book/nnql", ".q-learning-lab", "Train", 300, "NNQL, 300 episodes of one robot", 5.0),
    Training("book/nirl", ".robonav", "Learn the reward", 140, "NIRL, 140 iterations on 30 demonstrations", 10.0),
)  # fmt: skip


class Row(NamedTuple):
    """A measured number beside the limit that it may not exceed, if there is one."""

    what: str
    measured: float
    unit: str
    limit: float | None = None

    def __str__(self) -> str:
        line = f"{self.what:58} {self.measured:8.2f} {self.unit:3}"
        if self.limit is None:
            return line
        missed = "   MISSED" if self.measured > self.limit else ""
        return f"{line} of {self.limit:g}{missed}"


def weight(page: str) -> int:
    """Return the bytes of a page and its own pictures."""
    built = SITE / f"{page}.html"
    source = built.read_text("utf-8")
    pictures = [path for path in SITE.glob("_images/*") if path.name in source]
    return built.stat().st_size + sum(path.stat().st_size for path in pictures)


def weight_of_site() -> int:
    """Return the bytes of the whole site."""
    return sum(path.stat().st_size for path in SITE.rglob("*") if path.is_file())


def opened(address: str, page: str) -> tuple[float, int]:
    """Return the seconds until formulas and widgets are ready, and the bytes downloaded, with an empty cache."""
    with chromium(viewport=DESKTOP) as context, visiting(context) as visit:
        visit.page.goto("about:blank")
        began = time.perf_counter()
        visit.open(f"{address}/{page}.html")
        seconds = time.perf_counter() - began
        return seconds, visit.page.evaluate(DOWNLOADED)


def frames_a_second(address: str) -> tuple[float, float]:
    """Return the frame rate of the playground with thirty obstacles: the mean, and that of the slowest per cent."""
    with chromium(viewport=DESKTOP) as context, visiting(context) as visit:
        visit.open(f"{address}/book/playground.html")
        visit.page.get_by_label("world", exact=True).select_option("30 obstacles")
        visit.page.get_by_role("button", name="Drive", exact=True).click()
        times = visit.page.evaluate(FRAMES)
    gaps = sorted(later - earlier for earlier, later in pairwise(times))
    return 1000 * len(gaps) / sum(gaps), 1000 / gaps[int(0.99 * len(gaps))]


def pages_opened(address: str, listed: list[str]) -> Iterator[Row]:
    """Open each page and print a line; the rows hold the slowest page, the heaviest, and the largest first visit."""
    print(f"{'page':36} {'own MB':>7} {'loaded MB':>10} {'seconds':>8}")
    found = {}
    for page in listed:
        visits = [opened(address, page) for _ in range(VISITS)]
        seconds, loaded = min(took for took, _ in visits), visits[0][1]
        found[page] = (seconds, loaded)
        print(
            f"{page:36} {weight(page) / 1e6:7.2f} {loaded / 1e6:10.2f} {seconds:8.2f}",
            flush=True,
        )
    slowest = max(found, key=lambda page: found[page][0])
    heaviest = max(listed, key=weight)
    yield Row(f"until {slowest} is ready", found[slowest][0], "s", SLOWEST)
    largest = max(found.values(), key=lambda each: each[1])[1] / 1e6
    yield Row(f"{heaviest} itself", weight(heaviest) / 1e6, "MB", LARGEST_PAGE / 1e6)
    yield Row("the largest first visit, with the files of all pages", largest, "MB")


def learned(address: str, listed: list[str]) -> Iterator[Row]:
    """Train on the named pages. In the second training of imitation only the new robot drives the maps."""
    for training in TRAININGS:
        if training.page not in listed:
            continue
        visits = [
            training.times(address, runs=2 if training is IMITATION else 1)
            for _ in range(VISITS)
        ]
        seconds = min(times.learn for runs in visits for times in runs)
        yield Row(training.what, seconds, "s", training.limit)
        if training is IMITATION:
            driven = min(runs[1].drive for runs in visits)
            yield Row("200 maps driven by one robot", driven, "s", MAPS_DRIVEN)
        silence = min(max(times.silence for times in runs) for runs in visits)
        yield Row("until the page answers meanwhile", silence, "ms", SILENCE)


def main() -> None:
    listed = sys.argv[1:] or list(
        pages(yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8")))
    )
    with served(SITE) as address:
        rows = list(pages_opened(address, listed))
        rows += learned(address, listed)
        if "book/playground" in listed:
            mean, slowest = frames_a_second(address)
            playground = "frames of the playground with 30 obstacles"
            rows.append(Row(f"{playground}, mean", mean, "/s"))
            rows.append(Row(f"{playground}, 99 in 100", slowest, "/s"))
    rows.append(Row("whole site", weight_of_site() / 1e6, "MB", LARGEST_SITE / 1e6))
    print("", *rows, sep="\n")


if __name__ == "__main__":
    main()
