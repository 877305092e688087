"""Numbers that the page of reproduction quotes are those of the committed results."""

import re
from pathlib import Path

import numpy as np
import pytest
from result_role import with_results

from robonav.experiments import names, read_results
from robonav.experiments.runner.report import short

BOOK = Path(__file__).parents[3] / "book"
NIRL = {"method": "nirl", "discount": 0.65}
SLIPPING = {"expert": "computer, slipping"}
QUOTED = [  # start of the row, experiment, metric, case, which of the fitting cases, quoted number
    ("25 demonstrations", "table-3.2", "success", {"expert": "keeps clear", "target": "sine-cosine"}, 1, "interval"),
    ("Training settles", "table-3.3", "accuracy", {"expert": "shortest path", "iterations": 300}, 0, "mean"),
    ("NNQL learns", "table-4.3", "success", {"method": "nnql"}, 0, "interval"),
    ("NNQL learns", "table-4.3", "success", {"method": "nnql"}, 0, "best"),
    ("NNQL learns", "table-4.3", "success", {"method": "nnql"}, 0, "worst"),
    ("NNQL learns", "table-4.3", "success", {"method": "freer-side"}, 0, "mean"),
    ("Online learning", "table-4.3", "success, low temperature", {"method": "online"}, 0, "mean"),
    ("Online learning", "table-4.3", "success, low temperature", {"method": "nfq"}, 0, "mean"),
    ("Online learning", "table-4.3", "success", {"method": "nfq"}, 0, "mean"),
    ("NIRL arrives", "table-5.2", "success", NIRL, 0, "interval"),
    ("NIRL arrives", "table-5.2", "success", NIRL, 0, "worst"),
    ("NIRL beats", "table-5.2", "success", NIRL | {"method": "apprenticeship"}, 0, "mean"),
    ("NIRL beats", "table-5.2", "success", NIRL | {"method": "relative-entropy"}, 0, "mean"),
    ("NIRL beats", "table-5.2", "success", NIRL | {"method": "scirl"}, 0, "mean"),
    ("NIRL learns", "table-5.2", "success", {"method": "lfd"}, 0, "mean"),
    ("Learning from a human", "table-5.1", "success", {"expert": "human", "demonstrations": 30}, 0, "mean"),
    ("Learning from a human", "table-5.1", "success", {"expert": "computer", "demonstrations": 40}, 0, "mean"),
    ("Contradictory", "nirl-refinement", "success", SLIPPING | {"actions": "as demonstrated"}, 0, "mean"),
    ("Contradictory", "nirl-refinement", "success", SLIPPING | {"actions": "most frequent"}, 0, "mean"),
    ("Contradictory", "nirl-refinement", "success", SLIPPING | {"actions": "maximum a posteriori"}, 0, "mean"),
    ("The policy that best", "nirl-choice", "success", {"reward": "learned", "chosen by": "accuracy"}, 0, "mean"),
    ("The policy that best", "nirl-choice", "success", {"reward": "learned", "chosen by": "navigation"}, 0, "mean"),
]  # fmt: skip


@pytest.fixture(scope="module")
def page():
    """The page of reproduction with its numbers."""
    return with_results((BOOK / "reproduction.md").read_text("utf-8"))


@pytest.mark.parametrize(("row", "name", "metric", "wanted", "which", "form"), QUOTED)
def test_what_a_row_quotes_is_what_was_measured(
    page, row, name, metric, wanted, which, form
):
    (line,) = [line for line in page.splitlines() if line.startswith(f"| {row}")]
    results = read_results(name)
    fitting = [
        place
        for place, case in enumerate(results.experiment.cases)
        if wanted.items() <= case.items()
    ]
    summary = results.summary(metric, fitting[which])
    shown = short(summary) if form == "interval" else f"{getattr(summary, form):.1f}"
    assert shown in line


def test_page_counts_its_verdicts(page):
    """The opening sentence says how many claims hold; the tables have a verdict for each claim."""
    given = re.findall(r"^\| [^|]+ \| \*\*([a-z ]+)\*\*", page, re.M)
    kinds = (
        "holds",
        "holds in part",
        "does not hold",
        "cannot be decided",
    )
    assert set(given) == set(kinds)
    all_of_them, hold, part, no, open_ones = (
        len(given),
        *(given.count(kind) for kind in kinds),
    )
    assert (
        f"Of the {all_of_them} claims below, {hold} hold, {part} hold in part, {no} do not hold "
        f"and {open_ones} cannot be decided."
    ) in " ".join(page.split())


def test_every_experiment_has_its_place(page):
    """Each experiment but the labs' and the leaderboard's has one section on the pages of reproduction."""
    places = re.findall(
        r"^\(result-(.+)\)=$",
        "".join(
            source.read_text("utf-8")
            for source in sorted(BOOK.glob("reproduction*.md"))
        ),
        re.M,
    )
    assert len(places) == len(set(places))
    elsewhere = {"leaderboard", "lab-lfd", "lab-nnql", "lab-nirl"}
    assert set(places) == set(names()) - elsewhere
    assert set(re.findall(r"<result-([\w.-]+)>", page)) <= set(places)


@pytest.mark.parametrize(
    ("method", "episodes"), [("nnql", 150), ("dqn", 150), ("nfq", 180), ("online", 210)]
)
def test_when_25_of_30_episodes_first_succeed(method, episodes):
    """Two pages say after how many episodes the mean curve of Fig. 4.6 first reaches 25 of 30."""
    curves = read_results("figure-4.6")
    (case,) = [
        place
        for place, case in enumerate(curves.experiment.cases)
        if case["method"] == method
    ]
    mean = curves.values("successes", case).mean(axis=0)
    assert 30 * (np.argmax(mean >= 25) + 1) == episodes


def test_where_the_policies_of_the_board_lose_most():
    """The page of the leaderboard counts in which setting policies lose most, compared with 20 obstacles."""
    board = read_results("leaderboard")
    success = {
        (case["method"], case["setting"]): board.summary("success", place).mean
        for place, case in enumerate(board.experiment.cases)
    }
    methods = {method for method, _ in success} - {"straight"}
    settings = {setting for _, setting in success} - {"10 obstacles"}
    worst = [
        min(settings, key=lambda setting: success[method, setting])
        for method in methods
    ]
    assert len(methods) == 14
    assert worst.count("30 obstacles") == 7
    assert worst.count("20, 4 m/s") == 6
    learned = {method: success[method, "20, 4 m/s"] for method in methods}
    learned.pop("freer-side")
    assert sorted(learned, key=learned.__getitem__)[0] == "gail"
    assert set(sorted(learned, key=learned.__getitem__)[1:3]) == {"ppo", "nirl"}
    assert abs(learned["ppo"] - learned["nirl"]) < 1
    slow = {name for name in methods if success[name, "20, 1 m/s"] < success["freer-side", "20, 1 m/s"]}  # fmt: skip
    assert slow == {"nnql", "nfq", "online", "ppo", "gail"}
    assert success["freer-side", "20, 1 m/s"] - success["gail", "20, 1 m/s"] < 1
    assert success["online", "20, 1 m/s"] == min(
        success["online", setting] for setting in settings
    )


def test_how_many_more_learning_steps_the_other_methods_have():
    """The page that compares four methods: DQN a tenth more than NNQL, NFQ nearly a fifth more."""
    results = read_results("nnql-steps")
    steps = {
        case["method"]: results.summary("learning steps, whole training", place).mean
        for place, case in enumerate(results.experiment.cases)
    }
    assert steps["dqn"] / steps["nnql"] == pytest.approx(1.10, abs=0.01)
    assert 1.15 < steps["nfq"] / steps["nnql"] < 1.2
    assert steps["online"] < steps["nnql"]


def test_in_how_many_rows_of_table_5_2_the_rule_is_better():
    """The rule beats the thesis's four means, and five of the eight rows of the four methods here."""
    results = read_results("table-5.2")
    mean = {
        (case["method"], case["discount"]): results.summary("success", place).mean
        for place, case in enumerate(results.experiment.cases)
    }
    (rule,) = (value for (name, _), value in mean.items() if name == "freer-side")
    methods = {"nirl", "apprenticeship", "relative-entropy", "scirl"}
    rows = [value for (name, _), value in mean.items() if name in methods]
    assert rule > 83
    assert (len(rows), sum(rule > row for row in rows)) == (8, 5)


def test_what_slipping_actions_cost_on_the_board():
    """The page of the leaderboard: the rule and GAIL lose 7 points, every other policy at most 4."""
    board = read_results("leaderboard")
    success = {
        (case["method"], case["setting"]): board.summary("success", place).mean
        for place, case in enumerate(board.experiment.cases)
    }
    lost = {
        method: success[method, "20 obstacles"]
        - success[method, "20, a fifth of actions slips"]
        for method, _ in success
    }
    assert round(lost["freer-side"]) == round(lost["gail"]) == 7
    others = set(lost) - {"straight", "freer-side", "gail"}
    assert max(lost[name] for name in others) < 4
    assert (
        success["nfq", "20, a fifth of actions slips"] > success["nfq", "20 obstacles"]
    )


def test_how_far_the_accuracy_is_from_the_thesis():
    """Two pages: with the shortest-path expert it is two points higher, and 83.62 % lies outside the interval."""
    results = read_results("table-3.3")
    (case,) = [
        place
        for place, case in enumerate(results.experiment.cases)
        if case["expert"] == "shortest path" and case["iterations"] == 300
    ]
    found = results.summary("accuracy", case)
    assert round(found.mean - 83.62) == 2
    assert found.low > 83.62


def test_nnql_spreads_no_more_than_nfq():
    """In training both spread equally for 120 episodes, four blocks, and then NNQL spreads less."""
    curves = read_results("figure-4.6")
    methods = [case["method"] for case in curves.experiment.cases]
    nnql, nfq = (
        curves.values("successes", methods.index(name)).std(axis=0)
        for name in ("nnql", "nfq")
    )
    np.testing.assert_allclose(nnql[:4], nfq[:4], atol=0.4)
    assert (nnql[4:] < nfq[4:]).all()
