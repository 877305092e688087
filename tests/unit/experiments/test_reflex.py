"""What the exact direction of the target is worth: the experiment runs what it says."""

import pytest

from robonav.experiments import reflex
from robonav.experiments.chapter3.setup import demonstrations
from robonav.robot import Action, Reflex

(EXPERIMENT,) = reflex.EXPERIMENTS


@pytest.fixture(autouse=True)
def few_worlds(monkeypatch):
    monkeypatch.setattr(reflex, "WORLDS", 40)


@pytest.mark.parametrize("policy", ["straight", "freer-side"])
@pytest.mark.parametrize("chapter", [3, 4, 5])
def test_points_lost_are_the_difference_in_the_same_worlds(chapter, policy):
    case = {"chapter": chapter, "policy": policy, "training": "none"}
    exact, sector = (
        reflex.compare_directions(case | {"driving": driving}, 1, "quick")
        for driving in ("exact", "sector")
    )
    assert "points lost" not in exact
    assert sector["points lost"] == exact["success"] - sector["success"]
    if policy == "straight":
        # it leaves a safe state ahead of the target, which it has faced from the start
        assert sector["points lost"] == 0
    else:
        assert sector["seconds to the target"] != exact["seconds to the target"]


def test_a_policy_trains_with_the_reflex_of_its_case():
    for direction, command in (
        ("exact", Action.TO_TARGET),
        ("sector", Action.TO_SECTOR),
    ):
        shown = demonstrations(0, number=2, reflex=Reflex(direction))
        assert set(shown.actions[shown.sensing.safe]) == {command}
    trained = [
        reflex.trained_policy("cloning", 0, "quick", Reflex(direction))
        for direction in ("exact", "sector")
    ]
    assert any(
        (one != other).any()
        for one, other in zip(*(policy.network.weights for policy in trained), strict=True)
    )  # fmt: skip


def test_every_learned_policy_trains_and_drives_with_either():
    for chapter, learned in reflex.LEARNED.items():
        for policy in learned:
            pairs = {
                (case["training"], case["driving"])
                for case in EXPERIMENT.cases
                if (case["chapter"], case["policy"]) == (chapter, policy)
            }
            assert pairs == {
                ("exact", "exact"),
                ("exact", "sector"),
                ("sector", "sector"),
            }
