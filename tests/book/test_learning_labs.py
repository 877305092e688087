"""The page to play with learning, on a phone and from disk: what its labs say is what the committed results are."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import DESKTOP, PHONE, Visit
from playwright.sync_api import Locator, expect

from robonav.experiments import labs, read_results

LABELS = {
    "regularisation": "strength of regularisation λ",
    "hidden": "hidden units",
    "discount": "discount γ",
}
NAMES = [experiment.name for experiment in labs.EXPERIMENTS]


@pytest.fixture(params=["desktop", "phone"])
def page(request: pytest.FixtureRequest, visit: Visit, site: Path) -> Iterator[Locator]:
    desktop = request.param == "desktop"
    visit.page.set_viewport_size(DESKTOP if desktop else PHONE)
    visit.leave_formulas()
    visit.open(
        f"{request.getfixturevalue('http') if desktop else site.as_uri()}/book/learning-labs.html"
    )
    yield visit.page.locator("article")
    assert visit.errors == []


@pytest.mark.parametrize("name", NAMES)
def test_curves_are_the_committed_results(page, name):
    lab = page.locator(".training-lab").nth(NAMES.index(name))
    results = read_results(name)
    for index in (
        0,
        len(results.experiment.cases) // 2,
        len(results.experiment.cases) - 1,
    ):
        for label, choice in results.experiment.cases[index].items():
            lab.get_by_label(LABELS.get(label, label), exact=True).select_option(
                str(choice)
            )
        said = lab.locator(".status")
        expect(said).to_have_text(re.compile(r"^(Iteration|Episode) (300|140): "))
        numbers = re.findall(
            r"(-?[\d.]+) \((-?[\d.]+) to (-?[\d.]+)\)", said.inner_text()
        )
        assert len(numbers) == len(labs.STEPS[name])
        for measure, shown in zip(labs.STEPS[name], numbers, strict=True):
            last = results.values(measure, index)[:, -1]
            expected = [last.mean(), last.min(), last.max()]
            assert [float(number) for number in shown] == pytest.approx(
                expected, rel=6e-3, abs=5e-4
            )


def test_the_learned_reward_drives_better_than_its_opposite(page):
    lab = page.locator(".reward-lab")
    score = lab.locator("p.told")

    def arrivals() -> int:
        expect(score).to_contain_text("Of 40 other maps the robot arrives in")
        return int(re.search(r"arrives in (\d+)", score.inner_text())[1])

    learned = arrivals()
    lab.get_by_label("begin with the reward").select_option(
        "opposite sign of all weights"
    )
    assert arrivals() < learned
