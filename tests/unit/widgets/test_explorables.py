"""The numbers of the explorables' JavaScript against Python's."""

import pytest

from robonav import mdp
from robonav.widgets.explorables import EXPLORABLES, explorable


@pytest.fixture
def compute(node):
    """Run JavaScript with the exports of an explorable; ``data.given`` is what its page gets."""

    def run(name, body, **data):
        given = explorable(name).data["given"]
        return node(EXPLORABLES[name].front_end, body, {"given": given, **data})

    return run


def test_an_unknown_name_is_refused():
    with pytest.raises(ValueError, match=r"name must be one of .*discounted_return"):
        explorable("discount")


@pytest.mark.parametrize("discount", [0.0, 0.5, 0.93, 1.0])
def test_returns(compute, discount):
    rewards = [1.0, -2.0, 0.5, 0.0, 4.0]
    seen = compute(
        "discounted_return",
        "return page.returnOf(data.rewards, data.discount);",
        rewards=rewards,
        discount=discount,
    )
    assert seen == pytest.approx(mdp.discounted_return(rewards, discount)[0], abs=1e-12)


def test_both_chargers_are_worth_the_same_where_the_page_says():
    given = explorable("discounted_return").data["given"]
    assert round(given["equal"], 3) == 0.858  # as the answer on the page says
    far = mdp.discounted_return(given["far"], given["equal"])[0]
    assert far == pytest.approx(given["worth"], abs=1e-12)
