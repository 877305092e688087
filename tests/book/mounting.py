"""Put a widget on a page without a notebook, alone or with Python to answer it like a kernel."""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Any

import anywidget
from browser import Visit
from playwright.sync_api import Locator

MOUNT = """async ([module, style, data, asked]) => {
  const page = await import(URL.createObjectURL(new Blob([module], { type: "text/javascript" })));
  document.head.appendChild(document.createElement("style")).textContent = style;
  const place = document.querySelector("article").appendChild(document.createElement("div"));
  place.id = "mounted";
  const listeners = [];
  const silent = () => { throw new Error("no kernel"); };
  const hear = (answers) => answers.forEach((answer) => listeners.forEach((listen) => listen(answer)));
  const ask = (message) => window.askPython(message).then(hear);
  if (asked) setInterval(() => ask({}), 100);  // what Python says unasked
  const model = {
    get: (name) => (name === "_esm" ? module : data),
    on: (_, listener) => { listeners.push(listener); },
    send: asked ? ask : silent,
  };
  page.default.render({ model, el: place });
}"""


BLANK = Path(__file__).parent / "blank.html"


def mounted(
    visit: Visit, address: str, widget: Any, *, kernel: bool = False
) -> Locator:
    """Put the widget at the end of a short page. With ``kernel``, the widget in Python answers its messages."""
    assert isinstance(widget, anywidget.AnyWidget)
    visit.open(f"{address}/book/cite.html")
    if kernel:
        answers: deque[Any] = deque()
        widget.send = answers.append

        def ask(message: dict[str, Any]) -> list[Any]:
            widget._answer(widget, message, [])
            return [answers.popleft() for _ in range(len(answers))]

        visit.page.expose_function("askPython", ask)
    visit.page.evaluate(MOUNT, [widget._esm, widget._css, widget.data, kernel])
    return visit.page.locator("#mounted")


def mounted_alone(
    visit: Visit, widget: Any, *, theme: str = "light", first: str = "() => {}"
) -> Locator:
    """Put the widget on an empty page from disk, in the theme's colours. This needs no built book.

    ``first`` is a function in JavaScript that the page calls before.
    """
    assert isinstance(widget, anywidget.AnyWidget)
    visit.open(BLANK.as_uri())
    visit.page.evaluate(first)
    visit.page.evaluate(
        "(theme) => { document.documentElement.dataset.theme = theme; }", theme
    )
    visit.page.evaluate(MOUNT, [widget._esm, widget._css, widget.data, False])
    return visit.page.locator("#mounted")
