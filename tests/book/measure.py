"""Measure the size and speed of the built pages, the frame rate of the playground, and how fast a robot learns.

Usage: python tests/book/measure.py [PAGE ...]      (all pages of the book if none is named)

For each page the script prints: megabytes without the files that all pages share, milliseconds from a local server
until formulas and widgets are ready (the least of three visits, each with an empty cache), and the exceeded limits.
Times depend on the machine, so only this script compares them with limits.
"""

from __future__ import annotations

import sys
import time
from itertools import pairwise

import yaml
from browser import DESKTOP, ROOT, SITE, chromium, served, visiting
from check_site import pages

VISITS = 3
SLOWEST, HEAVIEST, WHOLE_SITE = 2.0, 5e6, 60e6  # seconds, bytes, bytes
FRAMES = """() => new Promise((done) => {
  const times = [];
  const tick = (now) => (times.push(now) < 181 ? requestAnimationFrame(tick) : done(times));
  requestAnimationFrame(tick);
})"""

LEARNING = {
    "book/policy-learning": (
        ".imitation-lab",
        "L-BFGS, 300 iterations on 25 drives, and 200 new maps for each of three robots",
        3,
    ),
    "book/nnql": (".q-learning-lab", "NNQL, 300 episodes and 100 new maps", 5),
}
LEARN = """(lab) => new Promise((done) => {
  const [began, status] = [performance.now(), lab.querySelector(".training .status")];
  let [last, longest] = [began, 0];
  const tick = () => {
    const now = performance.now();
    [longest, last] = [Math.max(longest, now - last), now];
    if (status.textContent.startsWith("Done")) done([(now - began) / 1000, longest]);
    else setTimeout(tick);
  };
  lab.querySelector(".training button").click();
  setTimeout(tick);
})"""


def weight(page: str) -> int:
    """Return the bytes of a page and its own pictures."""
    built = SITE / f"{page}.html"
    source = built.read_text("utf-8")
    pictures = [path for path in SITE.glob("_images/*") if path.name in source]
    return built.stat().st_size + sum(path.stat().st_size for path in pictures)


def seconds_to_open(address: str, page: str) -> float:
    """Return the seconds until formulas and widgets are ready, with an empty cache."""
    with chromium(viewport=DESKTOP) as context, visiting(context) as visit:
        visit.page.goto("about:blank")
        began = time.perf_counter()
        visit.open(f"{address}/{page}.html")
        return time.perf_counter() - began


def frames_a_second(address: str) -> tuple[float, float]:
    """Return the frame rate of the playground with thirty obstacles: the mean, and that of the slowest per cent."""
    with chromium(viewport=DESKTOP) as context, visiting(context) as visit:
        visit.open(f"{address}/book/playground.html")
        visit.page.get_by_label("world", exact=True).select_option("30 obstacles")
        visit.page.get_by_role("button", name="Drive", exact=True).click()
        times = visit.page.evaluate(FRAMES)
    gaps = sorted(later - earlier for earlier, later in pairwise(times))
    return 1000 * len(gaps) / sum(gaps), 1000 / gaps[int(0.99 * len(gaps))]


def learning(address: str, page: str, lab: str) -> tuple[float, float]:
    """Seconds that a lab takes to learn and drive, and the longest the page meanwhile answers nothing, in ms."""
    with chromium(viewport=DESKTOP) as context, visiting(context) as visit:
        visit.open(f"{address}/{page}.html")
        seconds, silence = visit.page.locator(lab).evaluate(LEARN)
        return seconds, silence


def main() -> None:
    listed = sys.argv[1:] or list(
        pages(yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8")))
    )
    with served(SITE) as address:
        for page in listed:
            took = min(seconds_to_open(address, page) for _ in range(VISITS))
            heavy = weight(page)
            signs = [
                sign
                for sign, over in (
                    ("slow", took > SLOWEST),
                    ("heavy", heavy > HEAVIEST),
                )
                if over
            ]
            print(
                f"{page:32} {heavy / 1e6:5.2f} MB {1000 * took:6.0f} ms  {' '.join(signs)}",
                flush=True,
            )
        if "book/playground" in listed:
            mean, slowest = frames_a_second(address)
            print(
                f"playground, 30 obstacles: {mean:.0f} frames a second, 99 in 100 at {slowest:.0f} or more"
            )
        for page, (lab, what, limit) in LEARNING.items():
            if page in listed:
                seconds, silence = learning(address, page, lab)
                print(
                    f"{what}: {seconds:.1f} s of {limit}; "
                    f"the page answers after {silence:.0f} ms of 100 at most"
                )
    whole = sum(path.stat().st_size for path in SITE.rglob("*") if path.is_file())
    print(f"whole site: {whole / 1e6:.1f} MB of {WHOLE_SITE / 1e6:.0f}")


if __name__ == "__main__":
    main()
