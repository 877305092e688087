"""A headless Chromium that can access only this machine, with a record of what a page did."""

from __future__ import annotations

import functools
import re
import shutil
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from playwright.sync_api import (
    BrowserContext,
    ConsoleMessage,
    Locator,
    Page,
    Playwright,
    Request,
    sync_playwright,
)

sys.path.append(
    str(Path(__file__).resolve().parents[2] / "book" / "_ext")
)  # also imported by screenshots.py

from check_site import ROOT as ROOT
from check_site import SITE as SITE

FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-proxy-server",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost, EXCLUDE 127.0.0.1",
]
LOCAL = re.compile(r"(https?://(localhost|127\.0\.0\.1)[:/]|file:|data:|blob:)")
DESKTOP, PHONE = {"width": 1280, "height": 900}, {"width": 390, "height": 844}

FORMULAS_SET = "async () => { await window.MathJax?.startup?.promise }"
WIDGETS_DRAWN = """() => [...document.querySelectorAll('script[type="application/vnd.jupyter.widget-view+json"]')]
  .every(({ parentElement: place }) => place.querySelector(".widget-subarea > * > *"))"""
PATIENCE = 60_000  # milliseconds; the machine may be slow, or busy with other tests


def executable() -> str | None:
    """Return the path of Chromium, if it is installed."""
    return next(
        filter(
            None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))
        ),
        None,
    )


@dataclass
class Visit:
    """One opened page, with its requests to other machines and its error messages."""

    page: Page
    external: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    def open(self, address: str, *, settled: bool = True) -> Visit:
        """Go to an address and wait until formulas and widgets are ready."""
        self.page.goto(address, wait_until="load")
        if settled:
            self.page.evaluate(FORMULAS_SET)
            self.page.wait_for_function(WIDGETS_DRAWN)
        return self

    def leave_formulas(self) -> None:
        """Open pages without MathJax, which needs half of the time until a page is ready."""
        self.page.route(
            "**/mathjax/*",
            lambda route: route.fulfill(content_type="text/javascript", body=""),
        )


def _watch(visit: Visit) -> None:
    # Requests are not intercepted, because Chromium caches nothing then.
    def on_request(request: Request) -> None:
        if not LOCAL.match(request.url):
            visit.external.append(request.url)

    def on_console(message: ConsoleMessage) -> None:
        if message.type == "error":
            visit.errors.append(f"{message.text} ({message.location.get('url', '')})")

    visit.page.on("request", on_request)
    visit.page.on("console", on_console)
    visit.page.on("pageerror", lambda error: visit.errors.append(str(error)))


_running: list[Playwright] = []


@contextmanager
def driver() -> Iterator[Playwright]:
    """Start Playwright, or give the one that runs already, since a thread can have only one."""
    if _running:
        yield _running[0]
        return
    with sync_playwright() as playwright:
        _running.append(playwright)
        try:
            yield playwright
        finally:
            _running.remove(playwright)


@contextmanager
def chromium(**options: Any) -> Iterator[BrowserContext]:
    """Start a new browser. ``options`` are Playwright's, such as ``viewport`` or ``color_scheme``."""
    with tempfile.TemporaryDirectory() as profile, driver() as playwright:
        context = playwright.chromium.launch_persistent_context(
            profile, executable_path=executable(), headless=True, args=FLAGS, **options
        )
        try:
            yield context
        finally:
            context.close()


@contextmanager
def visiting(context: BrowserContext) -> Iterator[Visit]:
    """Open a new page that is recorded from its first request on."""
    visit = Visit(context.new_page())
    visit.page.set_default_timeout(PATIENCE)
    _watch(visit)
    try:
        yield visit
    finally:
        visit.page.close()


def swipe(
    page: Page, start: tuple[float, float], end: tuple[float, float], *, steps: int = 8
) -> None:
    """Move a finger over the screen from one position to another."""
    session = page.context.new_cdp_session(page)
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": True})
    for step in range(steps + 1):
        x, y = (a + (b - a) * step / steps for a, b in zip(start, end, strict=True))
        kind = "touchStart" if step == 0 else "touchMove"
        session.send(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": [{"x": x, "y": y}]},
        )
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
    session.detach()


def tap(page: Page, x: float, y: float) -> None:
    """Touch the screen briefly at a position."""
    session = page.context.new_cdp_session(page)
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": True})
    session.send(
        "Input.dispatchTouchEvent",
        {"type": "touchStart", "touchPoints": [{"x": x, "y": y}]},
    )
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.evaluate("new Promise(requestAnimationFrame)")
    session.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
    session.detach()


def touch(control: Locator) -> None:
    """A finger on the middle of a control."""
    control.scroll_into_view_if_needed()
    box = control.bounding_box()
    assert box
    tap(control.page, box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)


def empty_storage(page: Page) -> None:
    """Delete what the browser keeps: other tests in the same browser keep demonstrations and robots."""
    page.evaluate("localStorage.clear()")
    page.evaluate("dispatchEvent(new StorageEvent('storage', { key: null }))")


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *arguments: Any) -> None:
        """Say nothing of each request."""


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder to this machine only, and yield its address."""
    handler = functools.partial(_Quiet, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}"
        finally:
            server.shutdown()
