"""The belief lab's JavaScript under Node: beliefs in the page are Python's."""

import numpy as np
import pytest

from robonav.mdp import POMDP, FiniteMDP, corridor, entropy, without_sensing
from robonav.widgets.belief_lab import SENSORS, WHEELS, belief_lab
from robonav.widgets.shared import packed

LAB = ("random_numbers", "belief")
PLANS = {"long": "..D.....D.D....", "short": "D.D.."}
WALK = """
const pomdp = page.pomdpOf(data.model), random = page.numbersFrom(data.seed);
const steps = [page.lost(pomdp, random)];
for (let k = 0; k < data.steps; k += 1) steps.push(page.act(pomdp, steps.at(-1), Math.floor(3 * random()), random));
return steps.map(({ belief, prior, ...step }) =>
  ({ ...step, belief: [...belief], prior: prior && [...prior], bits: page.entropy(belief) }));
"""


def as_page(pomdp):
    return {
        "transitions": packed(pomdp.mdp.transitions),
        "observations": packed(pomdp.observations),
    }


@pytest.mark.parametrize("sensor", range(len(SENSORS)))
@pytest.mark.parametrize("wheel", range(len(WHEELS)))
def test_a_run_in_the_page_is_believed_as_python_would(node, sensor, wheel):
    lab = belief_lab(PLANS)
    accuracy, slip = list(SENSORS.values())[sensor], list(WHEELS.values())[wheel]
    pomdp = corridor(PLANS["long"], accuracy=accuracy or 0.5, slip=slip)
    if accuracy is None:
        pomdp = without_sensing(pomdp.mdp)
    model = {
        "transitions": lab.data["transitions"][0][wheel],
        "observations": lab.data["observations"][0][sensor],
    }
    steps = node(LAB, WALK, {"model": model, "seed": 5, "steps": 200})
    belief = pomdp.uniform()
    np.testing.assert_allclose(steps[0]["belief"], belief, rtol=0, atol=1e-12)
    for step in steps[1:]:
        action, observation = step["action"], step["observation"]
        np.testing.assert_allclose(
            step["prior"], pomdp.predict(belief, action), rtol=0, atol=1e-9
        )
        probability = pomdp.observation_probabilities(belief, action)[observation]
        assert step["probability"] == pytest.approx(probability, abs=1e-9)
        belief = pomdp.update(belief, action, observation)
        np.testing.assert_allclose(step["belief"], belief, rtol=0, atol=1e-9)
        assert step["bits"] == pytest.approx(entropy(belief), abs=1e-9)
        assert belief[step["place"]] > 0  # the truth is never ruled out


def test_any_pomdp_is_updated_as_in_python(node):
    rng = np.random.default_rng(0)
    mdp = FiniteMDP(rng.dirichlet(np.ones(6), (3, 6)), np.zeros((6, 3)), 0.9)
    pomdp = POMDP(mdp, rng.dirichlet(np.ones(4), (3, 6)))
    belief = rng.dirichlet(np.ones(6))
    body = """const pomdp = page.pomdpOf(data.model), b = Float64Array.from(data.belief);
    return [0, 1, 2].map((a) => [0, 1, 2, 3].map((o) => [...page.update(pomdp, b, a, o).belief]));"""
    seen = node(LAB, body, {"model": as_page(pomdp), "belief": belief.tolist()})
    expected = [[pomdp.update(belief, a, o) for o in range(4)] for a in range(3)]
    np.testing.assert_allclose(seen, expected, rtol=0, atol=1e-12)


def test_an_impossible_observation_is_an_error_in_the_page_too(node):
    pomdp = corridor("D..", accuracy=1.0, slip=0.0)
    body = """try { page.update(page.pomdpOf(data), Float64Array.from([1, 0, 0]), 1, 1); return "none"; }
    catch (error) { return error.message; }"""
    assert "probability zero" in node(LAB, body, as_page(pomdp))


def test_the_pages_chance_is_fair_and_repeats(node):
    body = """const random = page.numbersFrom(data), again = page.numbersFrom(data), other = page.numbersFrom(data + 1);
    const take = (f) => Array.from({ length: 20000 }, f);
    const counts = [0, 0, 0];
    const seen = take(random);
    seen.forEach((u) => (counts[page.draw([0.2, 0, 0.8], u)] += 1));
    return { seen, again: take(again), other: take(other), counts };"""
    found = node(LAB, body, 3)
    assert found["seen"] == found["again"] != found["other"]
    assert 0 <= min(found["seen"]) < max(found["seen"]) < 1
    assert np.histogram(found["seen"], 20, (0, 1))[0] == pytest.approx(
        np.full(20, 1000), abs=130
    )
    assert np.corrcoef(found["seen"][1:], found["seen"][:-1])[0, 1] == pytest.approx(
        0, abs=0.03
    )
    assert np.corrcoef(found["seen"], found["other"])[0, 1] == pytest.approx(
        0, abs=0.03
    )
    assert found["counts"][1] == 0
    assert found["counts"][0] / 20_000 == pytest.approx(0.2, abs=0.012)


def test_the_lab_holds_every_combination():
    data = belief_lab(PLANS).data
    assert [entry["cells"] for entry in data["corridors"]] == list(PLANS.values())
    assert np.shape(data["transitions"]) == (2, len(WHEELS))
    assert np.shape(data["observations"]) == (2, len(SENSORS))
    assert data["observations"][1][3]["shape"] == [
        3,
        5,
        1,
    ]  # no sensing: all that can be observed is one thing


def test_the_lab_needs_something_to_choose():
    with pytest.raises(ValueError, match="corridors must hold at least one"):
        belief_lab({})
