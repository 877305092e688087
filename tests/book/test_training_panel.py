"""Training in the page: the worker, the bar, the curve, Cancel; and the same where the browser gives no worker."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import anywidget
import pytest
import traitlets
from browser import DESKTOP, PHONE, Visit
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.widgets.shared import front_end, style_sheet

WIDGET = """
const inWorker = typeof document === "undefined";
function* falls(steps) {
  for (let n = 1; n <= steps; n += 1) {
    const began = performance.now();
    while (performance.now() - began < 2);
    yield { done: n, total: steps, live: { at: n, cost: 1 / n } };
  }
  return inWorker ? "a worker" : "the page";
}
function* breaks() {
  yield { done: 1, total: 9, live: { at: 1, cost: 1 } };
  throw new Error("There is nothing to learn from.");
}
function render({ model, el }) {
  const { steps } = model.get("data");
  el.classList.add("robonav");
  const panel = trainingPanel({
    source: model.get("_esm"), action: "Train", unit: "step", total: () => steps,
    lines: [{ name: "cost", label: "cost", high: 1 }],
    begin: () => steps < 0 ? "Choose something to learn from." : { job: steps ? falls : breaks, argument: steps },
    done: (where) => `It ran in ${where}.`,
  });
  const touched = (event) => (event.target.textContent = "touched");
  el.append(panel.element, h("button", { type: "button", click: touched }, "touch me"));
}
export default { render };
"""


class Panel(anywidget.AnyWidget):
    """A panel with jobs that only count."""

    _esm = front_end("learning/worker", "learning/training_panel") + WIDGET
    _css = style_sheet("learning/training_panel")
    data = traitlets.Dict().tag(sync=True)


def panel(steps: int) -> Any:
    return Panel(data={"steps": steps})


@pytest.fixture(params=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit) -> Iterator[Visit]:
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    yield visit
    assert visit.errors == []


def said(lab: Locator) -> Locator:
    return lab.locator(".status")


def test_a_worker_trains_beside_the_page(view, address):
    lab = mounted(view, address, panel(300))
    lab.get_by_role("button", name="Train").press("Enter")
    lab.get_by_role("button", name="touch me").click()
    expect(lab.get_by_role("button", name="touched")).to_be_visible()
    expect(said(lab)).to_have_text(
        re.compile(r"^Done in \d+\.\d s\. It ran in a worker\.$")
    )
    bar = lab.get_by_role("progressbar")
    expect(bar).to_have_attribute("aria-valuenow", "100")
    curve = lab.get_by_role("img", name=re.compile("^cost"))
    expect(curve).to_have_attribute(
        "aria-label", "cost: 1.00 at first, 0.00333 after 300"
    )


@pytest.mark.parametrize(
    "missing",
    ["delete globalThis.Worker", "Worker = class { constructor() { throw Error(); } }"],
)
def test_without_a_worker_the_page_trains_itself_and_answers(view, site, missing):
    view.page.add_init_script(missing)
    lab = mounted(view, site.as_uri(), panel(300))
    lab.get_by_role("button", name="Train").click()
    lab.get_by_role("button", name="touch me").click()
    expect(lab.get_by_role("button", name="touched")).to_be_visible()
    expect(said(lab)).to_contain_text("It ran in the page.")


@pytest.mark.parametrize("worker", [True, False])
def test_a_training_is_cancelled_and_begun_again(view, site, worker):
    if not worker:
        view.page.add_init_script("delete globalThis.Worker")
    lab = mounted(view, site.as_uri(), panel(100_000))
    train = lab.get_by_role("button", name="Train")
    for _ in range(2):
        train.press("Enter")
        expect(lab.get_by_role("img", name=re.compile("at first"))).to_be_visible()
        expect(lab.locator(".left")).to_have_text(
            re.compile(r"^about \d+ (s|min) left$")
        )
        cancel = lab.get_by_role("button", name="Cancel")
        expect(cancel).to_be_focused()
        cancel.press("Enter")
        expect(said(lab)).to_have_text("Cancelled. Nothing of this run is kept.")
        expect(lab.locator(".left")).to_have_text("")
        expect(train).to_be_focused()


@pytest.mark.parametrize(
    ("steps", "sentence"),
    [(0, "There is nothing to learn from."), (-1, "Choose something to learn from.")],
)
def test_what_cannot_be_trained_gets_one_sentence(view, site, steps, sentence):
    lab = mounted(view, site.as_uri(), panel(steps))
    lab.get_by_role("button", name="Train").click()
    expect(said(lab)).to_have_text(sentence)
    expect(lab.get_by_role("button", name="Train")).to_be_enabled()
