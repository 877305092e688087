"""The reader's drives, from disk, with the network cut: driven by keyboard and by touch, kept, deleted, taken along."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import DESKTOP, PHONE, Visit
from driving import drive_map, fast, good_drive, keys_of, own_map, playground
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.lfd import load_demonstrations, save_demonstrations

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
    return lab.locator(".my-drives summary")


def said(lab: Locator) -> Locator:
    return lab.locator(".status.kept")


def test_drives_are_kept_over_a_reload_and_taken_to_python(view, lab, site, tmp_path):
    expect(heading(lab)).to_have_text("My drives (0)")
    for number in (1, 2):
        good = good_drive(number)
        ended = drive_map(lab, keys_of(good))
        assert ended == f"Arrived after {len(good)} s."
        expect(heading(lab)).to_have_text(f"My drives ({number})")
    lab = opened(view, site)
    expect(heading(lab)).to_have_text("My drives (2)")
    heading(lab).click()
    items = lab.locator(".drives li")
    expect(items.first).to_contain_text(f"map 1arrived after {len(good_drive(1))} s")
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download all").click()
    download.value.save_as(tmp_path / "mine.npz")
    mine = load_demonstrations(tmp_path / "mine.npz")
    for trajectory, number in enumerate((1, 2)):
        good = good_drive(number)
        driven = mine[mine.trajectory == trajectory]
        assert mine.worlds[trajectory].digest() == own_map(number).digest()
        np.testing.assert_array_equal(driven.actions, good.actions)
        np.testing.assert_allclose(
            driven.sensing.ranges, good.sensing.ranges, atol=2e-6
        )
    assert mine.outcome.tolist() == ["arrived", "arrived"]


def test_drives_are_deleted_one_by_one_and_all_and_loaded(lab, tmp_path):
    save_demonstrations(tmp_path / "drives.npz", good_drive(4))
    (tmp_path / "bad.npz").write_bytes(b"nothing")
    heading(lab).click()
    expect(lab.get_by_role("button", name="Download all")).to_be_disabled()
    upload = lab.get_by_label("File of drives")
    upload.set_input_files(tmp_path / "bad.npz")
    expect(said(lab)).to_have_text(
        "The file must hold demonstrations saved by robonav: it is damaged or of another kind."
    )
    for count in (1, 2, 3):
        upload.set_input_files(tmp_path / "drives.npz")
        expect(heading(lab)).to_have_text(f"My drives ({count})")
    expect(said(lab)).to_have_text("drives.npz: 1 drive loaded.")
    lab.get_by_role("button", name="Delete drive 2").press("Enter")
    expect(heading(lab)).to_have_text("My drives (2)")
    clear = lab.get_by_role("button", name=re.compile("delete", re.I)).last
    clear.click()
    expect(clear).to_have_text("Press again to delete them all")
    expect(heading(lab)).to_have_text("My drives (2)")
    clear.click()
    expect(heading(lab)).to_have_text("My drives (0)")


def test_a_drive_by_touch_is_kept_with_its_collision(lab):
    lab.get_by_role("button", name="Drive a new map yourself").click()
    lab.get_by_label("the robot goes on by itself").uncheck()
    for _ in range(60):
        lab.get_by_role("button", name="F", exact=True).dispatch_event("click")
    status = lab.locator(".status").first
    for _ in range(200):
        if re.search("Arrived|Collided", status.inner_text()):
            break
        lab.get_by_role("button", name="L30").dispatch_event("click")
    ended = "arrived" if "Arrived" in status.inner_text() else "collided"
    expect(heading(lab)).to_have_text("My drives (1)")
    heading(lab).click()
    expect(lab.locator(".drives li")).to_contain_text(ended)


def test_what_others_drove_is_not_kept(lab):
    lab.get_by_label("who drives", exact=True).select_option("rule: straight")
    lab.get_by_role("button", name="Drive", exact=True).click()
    expect(lab.locator(".status").first).to_contain_text(re.compile("Arrived|Collided"))
    expect(heading(lab)).to_have_text("My drives (0)")


BLOCKED = """Object.defineProperty(window, "localStorage", {
  get: () => { throw new DOMException("no", "SecurityError"); },
});"""
FULL = """Storage.prototype.setItem = () => { throw new DOMException("full", "QuotaExceededError"); };"""


@pytest.mark.parametrize(
    ("trouble", "sentence"),
    [
        (BLOCKED, "This browser keeps nothing for this page: your drives last until you close it."),
        (FULL, "The browser's storage is full: your drives made from now on last until you close the page."),
    ],
)  # fmt: skip
def test_without_storage_the_page_goes_on_in_memory(
    visit, site, trouble: Any, sentence
):
    visit.page.add_init_script(trouble)
    lab = opened(visit, site)
    of_the_theme = list(visit.errors)  # it uses the storage unguarded
    drive_map(lab, keys_of(good_drive(1)))
    expect(said(lab)).to_contain_text(sentence)
    expect(heading(lab)).to_have_text("My drives (1)")
    assert visit.errors == of_the_theme


def test_pages_share_their_drives(view, lab, site):
    """Over http and in Chromium from disk; Firefox gives each page on a disk a storage of its own."""
    drive_map(lab, keys_of(good_drive(1)))
    view.open(f"{site.as_uri()}/book/cite.html")
    kept = view.page.evaluate(
        "Object.keys(localStorage).filter((key) => key.startsWith('robonav.drive.'))"
    )
    assert len(kept) == 1
