"""Train on my demonstrations, from disk, with the network cut: driven by keyboard, learned, tested, taken to Python."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from accessibility import AXE, RUN, ours
from browser import DESKTOP, PHONE, Visit
from driving import (
    clumsy_demonstration,
    drive_map,
    fast,
    good_demonstration,
    keys_of,
    own_map,
    playground,
)
from mounting import mounted
from playwright.sync_api import Locator, expect
from test_controls import choose_everything, slide_everything
from test_kept_demonstrations import BLOCKED, FULL

from robonav.benchmark.policies import method
from robonav.lfd import (
    concatenate,
    demonstrate,
    labelled_states,
    learn_policy,
    record_demonstrations,
    save_demonstrations,
)
from robonav.networks import (
    Weights,
    lbfgs,
    load_weights,
    random_network,
    save_weights,
)
from robonav.networks.policy import NetworkPolicy
from robonav.robot import Encoder, navigate, random_worlds, straight
from robonav.widgets.imitation_lab import ImitationLab, imitation_lab

CLEAR = "localStorage.clear()"
KEPT_NAMES = """() => Object.entries(localStorage)
  .filter(([key]) => key.startsWith("robonav.robot."))
  .map(([, text]) => JSON.parse(text).name)"""
UNSEEN = random_worlds(200, 10, seed=2024)


@pytest.fixture(scope="module")
def widget() -> ImitationLab:
    learned = method("lfd")
    assert isinstance(learned, NetworkPolicy)
    return imitation_lab(learned, demonstrations=30)


@pytest.fixture(params=["desktop", "phone"])
def view(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Visit]:
    visit.page.set_viewport_size(DESKTOP if request.param == "desktop" else PHONE)
    visit.open(f"{site.as_uri()}/book/cite.html")
    visit.page.evaluate(CLEAR)
    yield visit
    visit.page.evaluate(CLEAR)
    assert visit.errors == []


def opened(view: Visit, site: Path, widget: ImitationLab) -> Locator:
    return mounted(view, site.as_uri(), widget)


def setting(lab: Locator, label: str) -> Locator:
    """A setting of the training; on a phone they are folded at first."""
    lab.locator("details", has_text="How it learns").evaluate(
        "(fold) => { fold.open = true; }"
    )
    return lab.get_by_label(label)


def said(lab: Locator) -> Locator:
    return lab.locator(".training > .status")


def train(lab: Locator) -> None:
    lab.get_by_role("button", name="Train").press("Enter")
    expect(said(lab)).to_contain_text(
        re.compile("^Done .* (Your|This) robot arrives in")
    )


def rates(lab: Locator) -> dict[str, float]:
    rows = [
        row.locator("th, td").all_inner_texts() for row in lab.locator("tbody tr").all()
    ]
    return {name.split(":")[0]: float(rate) for name, rate, *_ in rows}


@pytest.mark.parametrize("view", ["phone"], indirect=True)
def test_five_maps_driven_by_hand_make_a_robot_that_beats_straight_on(
    view, site, widget, tmp_path
):
    lab = mounted(view, site.as_uri(), playground())
    fast(lab)
    for number in range(1, 6):
        assert "Arrived" in drive_map(lab, keys_of(good_demonstration(number)))
    lab = opened(view, site, widget)
    expect(lab.get_by_label("learn from", exact=True)).to_have_value(
        "my demonstrations"
    )
    expect(lab.locator(".about").first).to_contain_text("5 demonstrations with ")
    train(lab)
    found = rates(lab)
    assert found["always straight on"] == pytest.approx(
        100 * navigate(straight, UNSEEN).success.mean()
    )
    assert found["the book's robot"] == pytest.approx(
        100 * navigate(method("lfd"), UNSEEN).success.mean()
    )
    assert found["robot 1"] > found["always straight on"] + 10
    expect(said(lab)).not_to_contain_text("Your robot always goes")
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download the latest").click()
    download.value.save_as(tmp_path / "mine.safetensors")
    mine = load_weights(tmp_path / "mine.safetensors")
    assert mine.made["demonstrations"] == 5
    policy = NetworkPolicy(mine.network, mine.encoder)
    assert found["robot 1"] == pytest.approx(
        100 * navigate(policy, UNSEEN).success.mean()
    )
    demonstrations = concatenate([good_demonstration(number) for number in range(1, 6)])
    ours = navigate(
        learn_policy(demonstrations, regularisation=0.1), UNSEEN
    ).success.mean()
    assert found["robot 1"] == pytest.approx(100 * ours, abs=8)
    setting(lab, "regularisation λ").select_option("1")
    train(lab)  # so much of it that few demonstrations teach only the commonest action
    assert rates(lab)["robot 2"] == found["always straight on"]
    expect(said(lab)).to_contain_text(
        "%. Your robot always goes straight on. Drive more maps, turn earlier,"
    )


def test_clumsy_demonstrations_teach_a_poor_robot_and_get_advice(view, site, widget):
    """Driven by keyboard: two maps into an obstacle, then three in which the robot turns round and round."""
    lab = mounted(view, site.as_uri(), playground())
    fast(lab)
    link = lab.get_by_role("link", name="Train a robot on your demonstrations")
    number, ends = 0, {"Arrived": 0, "Collided": 0}
    while ends["Arrived"] < 3:
        number += 1
        hits = ends["Collided"] < 2 and navigate(straight, own_map(number)).collision[0]
        keys = ["ArrowUp"] * 200 if hits else keys_of(clumsy_demonstration(number))
        ended = drive_map(lab, keys).split()[0]
        ends[ended] += 1
        heard = lab.locator(".status.kept")
        if ends["Collided"]:
            expect(heard).to_contain_text(
                "A robot learns only from demonstrations that arrive:"
            )
        expect(link).to_have_count(1 if ends["Arrived"] >= 3 else 0)
        if ends["Arrived"] < 3:
            expect(heard).to_contain_text("Bring the robot to its target in")
    lab = opened(view, site, widget)
    train(lab)
    found = rates(lab)
    assert found["robot 1"] < found["always straight on"] + 5
    expect(said(lab)).to_contain_text("and the robot learned to wander: drive again")


def test_without_demonstrations_the_page_says_so_and_offers_the_experts(
    view, site, widget
):
    lab = opened(view, site, widget)
    expect(lab.get_by_label("learn from", exact=True)).to_have_value(
        "the expert's demonstrations"
    )
    expect(lab.locator(".about").first).to_contain_text(
        "no demonstration of yours is kept here. Some browsers, such as Firefox, keep the demonstrations of "
        "each page on a disk apart: press Download all where you drive, and load the file here."
    )
    lab.get_by_label("learn from", exact=True).select_option("my demonstrations")
    expect(lab.locator(".about").first).to_contain_text(
        "None of your demonstrations has arrived yet."
    )
    link = lab.locator(".about").first.get_by_role("link", name="playground")
    expect(link).to_have_attribute("href", "playground.html")
    lab.get_by_role("button", name="Train").click()
    expect(said(lab)).to_contain_text("There is nothing to learn from")
    lab.get_by_label("learn from", exact=True).select_option(
        "the expert's demonstrations"
    )
    setting(lab, "iterations of L-BFGS").select_option("30")
    train(lab)
    assert rates(lab)["robot 1"] > 80


def test_demonstrations_that_collided_are_left_out(view, site, widget, tmp_path):
    hits = navigate(straight, random_worlds(9, 10, seed=1))
    world = int(np.flatnonzero(hits.collision)[0])

    def ahead(simulator: object, asked: np.ndarray) -> np.ndarray:
        return np.zeros(len(asked), dtype=np.int64)

    bad = record_demonstrations(ahead, random_worlds(9, 10, seed=1)[world])
    save_demonstrations(
        tmp_path / "both.npz", concatenate([bad, good_demonstration(1)])
    )
    lab = opened(view, site, widget)
    lab.locator(".my-demonstrations summary").click()
    lab.get_by_label("File of demonstrations").set_input_files(tmp_path / "both.npz")
    expect(lab.get_by_label("learn from", exact=True)).to_have_value(
        "my demonstrations"
    )
    expect(lab.locator(".about").first).to_have_text(
        re.compile(
            r"^1 demonstration with \d+ steps .* 1 of your demonstrations did not arrive and is left out\.$"
        )
    )


def test_training_is_cancelled_and_begun_again(view, site, widget):
    lab = opened(view, site, widget)
    setting(lab, "hidden units").select_option("32")
    setting(lab, "iterations of L-BFGS").select_option("1000")
    button = lab.get_by_role("button", name="Train")
    button.press("Enter")
    expect(
        lab.get_by_role("img", name=re.compile("cost J: .* at first"))
    ).to_be_visible()
    lab.get_by_role("button", name="Cancel").press("Enter")
    expect(said(lab)).to_contain_text("Cancelled. ")
    expect(lab.locator("tbody tr")).to_have_count(0)
    setting(lab, "iterations of L-BFGS").select_option("3")
    train(lab)
    expect(lab.locator("tbody tr")).to_have_count(3)


def test_every_robot_has_a_name_of_its_own(visit, site, widget):
    lab = opened(visit, site, widget)
    visit.page.evaluate(CLEAR)
    setting(lab, "iterations of L-BFGS").select_option("1")
    setting(lab, "obstacles in the new maps").select_option("10")
    for number in range(1, 9):
        train(lab)
        first = lab.locator("tbody tr").first.locator("th")
        expect(first).to_contain_text(f"robot {number}: ")
    robots = [name for name in rates(lab) if name.startswith("robot ")]
    assert robots == [f"robot {number}" for number in range(8, 2, -1)]
    names = visit.page.evaluate(KEPT_NAMES)
    assert len(set(names)) == len(names) == 8
    visit.page.evaluate(CLEAR)


def test_without_a_worker_the_page_trains_itself(visit, site, widget):
    visit.page.add_init_script("delete globalThis.Worker")
    lab = opened(visit, site, widget)
    setting(lab, "iterations of L-BFGS").select_option("10")
    train(lab)
    assert visit.errors == []


def test_a_robot_that_the_browser_does_not_keep_is_said_to_be_lost(visit, site, widget):
    lab = opened(visit, site, widget)
    setting(lab, "iterations of L-BFGS").select_option("3")
    visit.page.evaluate(f"() => {{ {FULL} }}")
    train(lab)
    expect(said(lab)).to_contain_text(
        "The browser's storage is full: your robots made from now on last until you close the page. "
        "Delete some robots, or download them."
    )
    visit.page.evaluate(f"() => {{ {BLOCKED} }}")
    train(lab)
    expect(said(lab)).to_contain_text("your robots last until you close it")


def test_weights_from_a_file_are_tried_and_watched(view, site, widget, tmp_path):
    encoder = Encoder(target="signed")
    network = random_network((encoder.size, 4, 5), seed=5, spread=3.0)
    save_weights(tmp_path / "own.safetensors", Weights(network, "own", encoder))
    (tmp_path / "bad.safetensors").write_bytes(b"nothing")
    lab = opened(view, site, widget)
    upload = lab.get_by_label("Weights to try")
    upload.set_input_files(tmp_path / "bad.safetensors")
    expect(
        lab.get_by_text("The file must hold weights saved by robonav")
    ).to_be_visible()
    upload.set_input_files(tmp_path / "own.safetensors")
    expect(said(lab)).to_contain_text("Your robot arrives in")
    own = navigate(NetworkPolicy(network, encoder), UNSEEN)
    assert rates(lab)["own.safetensors"] == pytest.approx(100 * own.success.mean())
    assert lab.page.evaluate(KEPT_NAMES) == []  # it was only tried
    lab.get_by_label("robot to watch").select_option("always straight on")
    track = lab.locator("input[aria-label='map']")
    track.press("Home")
    ends = navigate(straight, UNSEEN)
    told = lab.locator(".viewer .status")
    first = f"always straight on, map 1: {ends.outcome[0]} after {ends.steps[0]} s."
    expect(told).to_have_text(first)
    lab.get_by_role("button", name="Next map where it fails").press("Enter")
    fails = int(np.flatnonzero(~ends.success[1:])[0]) + 1
    expect(told).to_contain_text(f"map {fails + 1}: {ends.outcome[fails]}")
    before = lab.locator(".viewer canvas").evaluate("(map) => map.toDataURL()")
    lab.get_by_role("button", name="Watch it drive").press("Enter")
    lab.page.wait_for_function(
        "([map, before]) => map.toDataURL() !== before",
        arg=[lab.locator(".viewer canvas").element_handle(), before],
    )


def test_a_robot_is_trained_on_from_a_file_of_python_and_numbered_on(
    view, site, widget, tmp_path
):
    """Python's first iterations, and the page's next, are Python's next; the page's file goes on in Python."""
    lab = opened(view, site, widget)
    begin = setting(lab, "begin with").and_(lab.locator("select"))
    expect(begin).to_be_disabled()
    encoder = Encoder(target="signed")
    demonstrations = demonstrate(random_worlds(30, 10, seed=9)).select_trajectories(
        range(25)
    )
    x, y = labelled_states(demonstrations, encoder)
    settings = {"regularisation": 0.1, "iterations": 3}
    first = lbfgs(random_network((encoder.size, 4, 5), seed=5), x, y, **settings)
    save_weights(tmp_path / "own.safetensors", Weights(first.network, "lfd", encoder))
    wide = random_network((encoder.size, 4, 6), seed=5)
    save_weights(tmp_path / "wide.safetensors", Weights(wide, "lfd", encoder))
    upload = lab.get_by_label("Weights to begin with")
    upload.set_input_files(tmp_path / "wide.safetensors")
    expect(lab.get_by_text("has 6 outputs, and a robot that learns")).to_be_visible()
    upload.set_input_files(tmp_path / "own.safetensors")
    expect(begin).to_have_value("own.safetensors")
    expect(setting(lab, "hidden units")).to_be_disabled()
    setting(lab, "iterations of L-BFGS").select_option("3")
    train(lab)
    with lab.page.expect_download() as download:
        lab.get_by_role("button", name="Download the latest").click()
    download.value.save_as(tmp_path / "mine.safetensors")
    mine = load_weights(tmp_path / "mine.safetensors")
    second = lbfgs(first.network, x, y, **settings)
    np.testing.assert_allclose(
        mine.network.weights[0], second.network.weights[0], atol=1e-9
    )
    assert mine.made["begun"] == "own.safetensors"
    assert "beginning with the weights of own.safetensors" in mine.made["about"]
    third = lbfgs(mine.network, x, y, **settings)
    assert third.costs[0] == pytest.approx(second.costs[-1])
    lab = opened(view, site, widget)  # a later visit
    setting(lab, "begin with").and_(lab.locator("select")).select_option(index=1)
    train(lab)
    learned = "25 of the expert's demonstrations, on from"
    assert sorted(lab.page.evaluate(KEPT_NAMES)) == [
        f"robot 1: {learned} own.safetensors, λ 0.1",
        f"robot 2: {learned} robot 1, λ 0.1",
    ]


def test_other_maps_begin_a_new_table(view, site, widget):
    lab = opened(view, site, widget)
    setting(lab, "iterations of L-BFGS").select_option("3")
    train(lab)
    setting(lab, "obstacles in the new maps").select_option("30")
    expect(lab.locator("tbody tr")).to_have_count(0)
    train(lab)
    unseen = random_worlds(200, 30, seed=2024)
    assert rates(lab)["always straight on"] == pytest.approx(
        100 * navigate(straight, unseen).success.mean()
    )


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESKTOP, PHONE])
def test_axe_finds_nothing_serious(visit, site, size, scheme, widget):
    visit.page.set_viewport_size(size)
    visit.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
    lab = mounted(visit, site.as_uri(), widget)
    train(lab)
    visit.page.evaluate("() => { window.define = undefined; }")
    visit.page.evaluate(AXE.read_text("utf-8"))
    assert [bad for bad in visit.page.evaluate(RUN) if ours(bad)] == []
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= size["width"]


def test_every_setting_changes_what_is_shown(visit, site, widget):
    visit.page.set_viewport_size(PHONE)
    lab = opened(visit, site, widget)
    setting(lab, "hidden units")
    choose_everything(lab)
    slide_everything(lab)
