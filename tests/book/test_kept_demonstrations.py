"""The reader's demonstrations, from disk, with the network cut: made by keyboard and by touch, kept, deleted, saved."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import DESKTOP, PHONE, Visit
from driving import drive_map, fast, good_demonstration, keys_of, own_map, playground
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.lfd import concatenate, load_demonstrations, save_demonstrations

CLEAR = "localStorage.clear()"


@pytest.fixture(params=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Visit]:
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    visit.open(f"{site.as_uri()}/book/cite.html")
    visit.page.evaluate(CLEAR)
    yield visit
    visit.page.evaluate(CLEAR)
    assert visit.errors == []


@pytest.fixture
def lab(view: Visit, site: Path) -> Locator:
    return opened(view, site)


def opened(view: Visit, site: Path) -> Locator:
    lab = mounted(view, site.as_uri(), playground())
    fast(lab)
    return lab


def heading(lab: Locator) -> Locator:
    return lab.locator(".my-demonstrations summary")


def said(lab: Locator) -> Locator:
    return lab.locator(".status.kept")


def test_demonstrations_are_kept_over_a_reload_and_taken_to_python(
    view, lab, site, tmp_path
):
    expect(heading(lab)).to_have_text("My demonstrations (0)")
    for number in (1, 2):
        good = good_demonstration(number)
        ended = drive_map(lab, keys_of(good))
        assert ended == f"Arrived after {len(good)} s."
        expect(heading(lab)).to_have_text(f"My demonstrations ({number})")
    lab = opened(view, site)
    expect(heading(lab)).to_have_text("My demonstrations (2)")
    heading(lab).click()
    items = lab.locator(".demonstrations li")
    expect(items.first).to_contain_text(
        f"map 1arrived after {len(good_demonstration(1))} s"
    )
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download all").click()
    download.value.save_as(tmp_path / "mine.npz")
    mine = load_demonstrations(tmp_path / "mine.npz")
    for trajectory, number in enumerate((1, 2)):
        good = good_demonstration(number)
        driven = mine[mine.trajectory == trajectory]
        assert mine.worlds[trajectory].digest() == own_map(number).digest()
        np.testing.assert_array_equal(driven.actions, good.actions)
        np.testing.assert_allclose(
            driven.sensing.ranges, good.sensing.ranges, atol=2e-6
        )
    assert mine.outcome.tolist() == ["arrived", "arrived"]


def test_demonstrations_are_deleted_one_by_one_and_all_and_loaded(lab, tmp_path):
    save_demonstrations(tmp_path / "demonstrations.npz", good_demonstration(4))
    (tmp_path / "bad.npz").write_bytes(b"nothing")
    heading(lab).click()
    expect(lab.get_by_role("button", name="Download all")).to_be_disabled()
    upload = lab.get_by_label("File of demonstrations")
    upload.set_input_files(tmp_path / "bad.npz")
    told = lab.locator(".my-demonstrations .heard")
    expect(told).to_have_text(
        "The file must hold demonstrations saved by robonav: it is damaged or of another kind."
    )
    for count in (1, 2, 3):
        save_demonstrations(
            tmp_path / "demonstrations.npz", good_demonstration(3 + count)
        )
        upload.set_input_files(tmp_path / "demonstrations.npz")
        expect(heading(lab)).to_have_text(f"My demonstrations ({count})")
    expect(told).to_have_text("demonstrations.npz: 1 demonstration loaded.")
    both = concatenate([good_demonstration(6), good_demonstration(7)])
    for count, sentence in ((4, "1 of them new, 1"), (4, "none of them new, 2")):
        save_demonstrations(tmp_path / "demonstrations.npz", both)
        upload.set_input_files(tmp_path / "demonstrations.npz")
        expect(told).to_have_text(
            f"demonstrations.npz holds 2 demonstrations: {sentence} kept already."
        )
        expect(heading(lab)).to_have_text(f"My demonstrations ({count})")
    lab.get_by_role("button", name="Delete demonstration 4").press("Enter")
    lab.get_by_role("button", name="Delete demonstration 2").press("Enter")
    expect(heading(lab)).to_have_text("My demonstrations (2)")
    clear = lab.get_by_role("button", name=re.compile("delete", re.I)).last
    clear.click()
    expect(clear).to_have_text("Press again to delete them all")
    expect(heading(lab)).to_have_text("My demonstrations (2)")
    clear.click()
    expect(heading(lab)).to_have_text("My demonstrations (0)")


def test_a_demonstration_by_touch_is_kept_with_its_collision(lab):
    lab.get_by_role("button", name="Drive a new map yourself").click()
    lab.get_by_label("the robot goes on by itself").uncheck()
    for _ in range(60):
        lab.get_by_role("button", name="ahead").dispatch_event("click")
    status = lab.locator(".status").first
    for _ in range(200):
        if re.search("Arrived|Collided", status.inner_text()):
            break
        lab.get_by_role("button", name="left 30°").dispatch_event("click")
    ended = "arrived" if "Arrived" in status.inner_text() else "collided"
    expect(heading(lab)).to_have_text("My demonstrations (1)")
    heading(lab).click()
    expect(lab.locator(".demonstrations li")).to_contain_text(ended)


def test_what_others_drove_is_not_kept(lab):
    lab.get_by_label("who drives", exact=True).select_option("rule: straight")
    lab.get_by_role("button", name="Drive", exact=True).click()
    expect(lab.locator(".status").first).to_contain_text(re.compile("Arrived|Collided"))
    expect(heading(lab)).to_have_text("My demonstrations (0)")


BLOCKED = """Object.defineProperty(window, "localStorage", {
  get: () => { throw new DOMException("no", "SecurityError"); },
});"""
FULL = """Storage.prototype.setItem = () => { throw new DOMException("full", "QuotaExceededError"); };"""


@pytest.mark.parametrize(
    ("trouble", "sentence"),
    [
        (BLOCKED, "This browser keeps nothing for this page: your demonstrations last until you close it."),
        (FULL, "The browser's storage is full: your demonstrations made from now on last until you close the page."),
    ],
)  # fmt: skip
def test_without_storage_the_page_goes_on_in_memory(
    visit, site, trouble: Any, sentence
):
    visit.page.add_init_script(trouble)
    lab = opened(visit, site)
    of_the_theme = list(visit.errors)  # it uses the storage unguarded
    drive_map(lab, keys_of(good_demonstration(1)))
    expect(said(lab)).to_contain_text(sentence)
    expect(said(lab)).not_to_contain_text("is kept")
    expect(heading(lab)).to_have_text("My demonstrations (1)")
    assert visit.errors == of_the_theme


def test_pages_share_their_demonstrations(view, lab, site):
    """Over http and in Chromium from disk; Firefox gives each page on a disk a storage of its own."""
    drive_map(lab, keys_of(good_demonstration(1)))
    view.open(f"{site.as_uri()}/book/cite.html")
    kept = view.page.evaluate(
        "Object.keys(localStorage).filter((key) => key.startsWith('robonav.drive.'))"
    )
    assert len(kept) == 1


PADS = """() => {
  window.pad = { axes: [0, 0], buttons: Array.from({ length: 16 }, () => ({ pressed: false })) };
  Object.defineProperty(navigator, "getGamepads", { value: () => [null, window.pad] });
}"""
PRESS = "([button, pressed]) => { window.pad.buttons[button].pressed = pressed; }"


def test_a_gamepad_begins_a_map_and_steers(view, site):
    lab = mounted(view, site.as_uri(), playground())
    view.page.evaluate(PADS)
    view.page.evaluate("() => { window.dispatchEvent(new Event('gamepadconnected')); }")
    view.page.evaluate(PRESS, [0, True])
    expect(lab.get_by_label("who drives", exact=True)).to_have_value("you")
    expect(said(lab)).to_contain_text("Map 1.")
    lab.get_by_label("the robot goes on by itself").uncheck()
    status = lab.locator(".status").first
    expect(status).to_contain_text("0 s, target in sector")
    view.page.evaluate(PRESS, [0, False])
    view.page.evaluate(PRESS, [14, True])
    expect(status).to_contain_text(re.compile("^[2-9] s, "))  # again while it is held
    view.page.evaluate(PRESS, [14, False])
    held = view.page.evaluate("new Promise((go) => setTimeout(go, 400))")
    assert held is None
    now = status.inner_text()
    view.page.evaluate("() => { window.pad.axes = [0, -1]; }")
    expect(status).not_to_have_text(now)


def test_the_map_its_buttons_and_what_is_said_stand_on_a_phones_screen(visit, site):
    visit.page.set_viewport_size(PHONE)
    visit.open(f"{site.as_uri()}/book/playground.html")
    lab = visit.page.locator(".robot-playground")
    lab.get_by_role("button", name="Drive a new map yourself").click()
    for part in ("canvas", ".wheel", ".status:not(.kept)", ".status.kept"):
        box = lab.locator(part).bounding_box()
        assert box
        assert box["y"] >= 0, part
        assert box["y"] + box["height"] <= PHONE["height"], part
