"""What the exact direction of the target is worth: the experiment runs what it says."""

import ast
from pathlib import Path

import pytest

import robonav
from robonav.experiments import reflex
from robonav.experiments.chapter3.setup import demonstrations
from robonav.robot import Action, Reflex

(EXPERIMENT,) = reflex.EXPERIMENTS


@pytest.fixture(autouse=True)
def few_worlds(monkeypatch):
    monkeypatch.setattr(reflex, "WORLDS", 40)


@pytest.mark.parametrize("method", ["straight", "freer-side"])
@pytest.mark.parametrize("chapter", [3, 4, 5])
def test_points_lost_are_the_difference_in_the_same_worlds(chapter, method):
    case = {"chapter": chapter, "method": method, "reflex in training": "none"}
    exact, sector = (
        reflex.compare_directions(case | {"reflex in test": test}, 1, "quick")
        for test in ("exact", "sector")
    )
    assert "points lost" not in exact
    assert sector["points lost"] == exact["success"] - sector["success"]
    if method == "straight":
        # it leaves a safe state ahead of the target, which it has faced from the start
        assert sector["points lost"] == 0
    else:
        assert sector["seconds to the target"] != exact["seconds to the target"]


@pytest.mark.slow
def test_a_policy_trains_with_the_reflex_of_its_case():
    for direction, command in (
        ("exact", Action.TO_TARGET),
        ("sector", Action.TO_SECTOR),
    ):
        shown = demonstrations(0, number=2, reflex=Reflex(direction))
        assert set(shown.actions[shown.sensing.safe]) == {command}
    trained = [
        reflex.trained_policy("lfd", 0, "quick", Reflex(direction))
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
                (case["reflex in training"], case["reflex in test"])
                for case in EXPERIMENT.cases
                if (case["chapter"], case["method"]) == (chapter, policy)
            }
            assert pairs == {
                ("exact", "exact"),
                ("exact", "sector"),
                ("sector", "sector"),
            }


HAVE_REFLEX = {
    "navigate", "run_episodes", "record", "demonstrate", "demonstrate_by_hand", "dagger", "collect",
    "NavigationTask", "navigation_task", "RobotTask", "CountedTask", "NavigationEnv", "NavigationVectorEnv",
}  # fmt: skip
HAVE_TASK = {"train", "train_ppo", "learn", "learn_under_reward", "nirl", "apprenticeship", "scirl"}  # fmt: skip
PACKAGE = Path(robonav.__file__).parent
FILES = [*(PACKAGE / "experiments").rglob("*.py"), PACKAGE / "benchmark/leaderboard.py"]


def calls_by_default(source):
    """The calls that take the package's default reflex: without the argument, and without others by ``**``."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            given = {keyword.arg for keyword in node.keywords}
            wanted = {"reflex"} if node.func.id in HAVE_REFLEX else {"task"}
            if node.func.id in HAVE_REFLEX | HAVE_TASK and not given & (wanted | {None}):  # fmt: skip
                yield node.lineno, node.func.id


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_committed_numbers_name_their_reflex(path):
    """So that the package's default has no influence on them."""
    source = path.read_text()
    assert list(calls_by_default(source)) == []
    assert "REFLEX," not in source.replace("EXACT_REFLEX", "")


def test_calls_by_default_are_found():
    source = "navigate(a, b)\nnavigate(a, reflex=c)\nlearn(d, seed=1)\nlearn(**d)\nlearn(task=e)"
    assert list(calls_by_default(source)) == [(1, "navigate"), (3, "learn")]
