"""The reader's robot in the frozen worlds of the leaderboard, compared with Python's episodes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from browser import DESKTOP, Visit, empty_storage
from driving import keep_robots
from mounting import mounted
from playwright.sync_api import Locator, expect

from robonav.benchmark import EXACT_REFLEX, SETTINGS, board_worlds
from robonav.benchmark.policies import method
from robonav.networks import NetworkPolicy, Weights, save_weights
from robonav.robot import navigate, neighbour_slip
from robonav.widgets.leaderboard_row import leaderboard_row

FEW, MANY = 20, 1000  # a trial in few worlds may end before Cancel is pressed


@pytest.fixture
def row(request: pytest.FixtureRequest, visit: Visit, place: str) -> Iterator[Locator]:
    """The widget alone on a page, with few worlds a setting, or as many as a test asks for."""
    rates = {"straight": [30.0] * len(SETTINGS)}
    worlds = getattr(request, "param", FEW)
    found = mounted(visit, place, leaderboard_row(rates, worlds=worlds))
    empty_storage(visit.page)
    cut = found.page.locator(".scroll").get_attribute("data-cut")
    assert (cut is None) == (visit.page.viewport_size == DESKTOP)
    yield found
    assert visit.errors == []
    assert visit.page.evaluate(
        "document.documentElement.scrollWidth <= window.innerWidth"
    )


@pytest.fixture(scope="module")
def learned() -> NetworkPolicy:
    policy = method("lfd")
    assert isinstance(policy, NetworkPolicy)
    return policy


def expected(policy: NetworkPolicy) -> list[str]:
    """The success in each setting, in per cent."""
    rates = []
    for name, setting in SETTINGS.items():
        slip = neighbour_slip(setting.slip) if setting.slip else None
        worlds = board_worlds(name, 0, FEW)
        found = navigate(
            policy,
            worlds,
            setting.speed,
            noise=setting.noise,
            slip=slip,
            reflex=EXACT_REFLEX,
        )
        rates.append(f"{100 * found.success.mean():.0f}")
    return rates


def test_row_is_pythons(row, learned, tmp_path):
    path = tmp_path / "mine.safetensors"
    save_weights(path, Weights(learned.network, "mine", learned.encoder))
    row.get_by_label("Weights of a robot").set_input_files(path)
    expect(row.locator(".status").first).to_contain_text("is ready to be tried")
    row.get_by_role("button", name="Try this robot").click()
    expect(row.locator(".status").nth(1)).to_contain_text(
        "20 episodes a setting", timeout=240_000
    )
    cells = row.locator(".mine td")
    assert cells.all_inner_texts() == expected(learned)


@pytest.mark.parametrize("row", [pytest.param(MANY, id="many")], indirect=True)
def test_kept_robot_is_offered_tried_cancelled_and_deleted(row):
    robot = {
        "name": "walker",
        "network": {"sizes": [11, 1, 5], "weights": [[0] * 11, [0] * 5], "biases": [[0], [1, 0, 0, 0, 0]]},
        "encoder": {"sensors": [1, 2, 3, 4, 5, 6, 7, 8, 9], "walls": False, "target": "signed"},
    }  # fmt: skip
    keep_robots(row.page, robot | {"about": "It walks."})
    chosen = row.get_by_label("robot", exact=True)
    expect(chosen.locator("option:checked")).to_have_text("walker")
    expect(row.locator(".about")).to_contain_text("It walks. ")
    row.get_by_role("button", name="Try this robot").click()
    row.get_by_role("button", name="Cancel").click()
    expect(row.locator(".status").nth(1)).to_contain_text("Cancelled. ")
    row.get_by_text("My robots (1)").click()
    row.get_by_role("button", name="Delete walker").press("Enter")
    expect(chosen).to_be_disabled()
    row.get_by_role("button", name="Undo").press("Enter")
    expect(chosen.locator("option:checked")).to_have_text("walker")


def test_without_a_robot_one_sentence_says_where_to_train(row):
    row.get_by_role("button", name="Try this robot").click()
    expect(row.locator(".status").nth(1)).to_contain_text("There is no robot yet")


def test_file_that_holds_no_weights_is_one_sentence(row, tmp_path):
    path = tmp_path / "no.safetensors"
    path.write_bytes(b"nothing")
    row.get_by_label("Weights of a robot").set_input_files(path)
    expect(row.locator(".status").first).to_contain_text("must hold weights")


def test_rates_of_another_length_are_refused():
    with pytest.raises(ValueError, match="rates"):
        leaderboard_row({"straight": [1.0]})
