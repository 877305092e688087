"""Code on the built pages fits on one screen, and each equation has its listing."""

from __future__ import annotations

from pathlib import Path
from types import FunctionType
from typing import Any

import pytest
from check_listings import checks_input, faults, helpers, wide_cells, wide_stubs


def test_listings_of_page(page_name: str, site: Path) -> None:
    assert list(faults((site / f"{page_name}.html").read_text("utf-8"))) == []


def test_code_cells_of_page(page_name: str, site: Path) -> None:
    assert list(wide_cells((site / f"{page_name}.html").read_text("utf-8"))) == []


def test_exercises_of_page(page_name: str, site: Path) -> None:
    assert list(wide_stubs((site / f"{page_name}.html").read_text("utf-8"))) == []


def equation(number: str) -> str:
    return f'<div class="math" id="equation-eq-{number.replace(".", "-")}"></div>'


def listing(code: str) -> str:
    return (
        '<div><div class="code-block-caption"><code>robonav.f</code></div>'
        f'<div class="function-source highlight-python"><pre>{code}</pre></div></div>'
    )


CHECK = "shows an input check"
WARNING = "shows a warning"
RIGHT = listing("def f(q):\n    return q.max()  # Eq. (2.9)")


@pytest.mark.parametrize(
    "page",
    [
        equation("2.9") + RIGHT,
        equation("2.9") + equation("2.10") + RIGHT + listing("v  # Eq. (2.10)"),
        RIGHT + equation("2.9") + RIGHT,
    ],
)
def test_equation_followed_by_its_listing(page: str) -> None:
    assert list(faults(page)) == []


@pytest.mark.parametrize(
    "page",
    [
        equation("2.9"),
        equation("2.9") + listing("return q  # Eq. (2.90)"),
        RIGHT + equation("2.9"),
    ],
)
def test_equation_not_followed_by_its_listing(page: str) -> None:
    assert list(faults(page)) == ["no listing below Eq. (2.9) carries its number"]


def test_equation_of_the_page_itself_needs_no_listing() -> None:
    assert list(faults('<div class="math" id="equation-eq-own"></div>')) == []


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("x = 1\n" * 41, "has 41 lines"),
        ("x" * 89, "has 89 columns"),
        ("def f():\n    from . import models", "shows an import"),
        ("    import numba\n", "shows an import"),
        ("x = check_real('x', x)", CHECK),
        ("def f(x):\n    if x < 0:\n        raise ValueError(x)", CHECK),
        ("a = x if isinstance(x, tuple) else (x, x)", CHECK),
        ("def f(x):\n    assert x > 0, x", CHECK),
        ("v = validation.check_real('x', x)", CHECK),
        ("b = self.as_belief(belief)", CHECK),
        ("v = np.asarray(start)", CHECK),
        ("v, w = map(np.asarray, (v, w))", CHECK),
        ("history = ValueHistory(True)", "shows a record"),
        ("step(_NOT_RECORDED)", "shows a record"),
        (
            "def f(mdp, *, record=False):\n    return mdp.values",
            "has a parameter record that its body never reads",
        ),
        ("    _warn_not_settled(3)", WARNING),
        ("warnings.warn('slow')", WARNING),
    ],
)
def test_listing_fault(code: str, fault: str) -> None:
    assert list(faults(listing(code))) == [f"robonav.f {fault}"]


@pytest.mark.parametrize(
    "code",
    [
        "x = 1\n" * 40,
        "x" * 88,
        "important = 1",
        "# import it",
        "# raise x",
        "@checked\n@warns_not_converged(3)\ndef f(x):\n    return x",
        "if x is None:\n    x = 0",
        "q_net = as_module(network)",
    ],
)
def test_listing_without_fault(code: str) -> None:
    assert list(faults(listing(code))) == []


HELPERS = """
from robonav.mdp import policies, policy_evaluation
from robonav.mdp.evaluation import error_limit
from robonav.mdp.solutions import starting_values
"""


@pytest.mark.parametrize(
    ("code", "called"),
    [
        ("v = starting_values('start', mdp, start)", ["starting_values"]),
        ("pi = policies.probabilities(policy, 2, 3)", ["probabilities"]),
        ("v = error_limit(mdp, 0.1)", []),
        ("v = policy_evaluation(mdp, policy)", []),  # public: it checks its own input
        ("@starting_values\ndef f(v):\n    return v", []),
    ],
)
def test_helper_that_checks_its_input(code: str, called: list[str]) -> None:
    names: dict[str, Any] = {}
    exec(HELPERS, names)
    shown = FunctionType(compile("", "f", "exec"), names)
    found = [f.__name__ for f in helpers(shown, code) if checks_input(f)]
    assert found == called


def test_listing_that_calls_a_check_by_another_name() -> None:
    code = "pi = policies.probabilities(policy, 2, 3)"
    page = listing(code).replace("robonav.f", "robonav.nirl.RewardFreeMDP.rollout")
    name = "robonav.nirl.RewardFreeMDP.rollout"
    assert list(faults(page)) == [f"{name} calls probabilities, which checks its input"]


def cell(code: str) -> str:
    return f'<div class="cell"><div class="cell_input"><pre>{code}</pre></div></div>'


def folded(code: str) -> str:
    inside = f"<details class='hide'>{cell(code)}</details>"
    return f'<div class="cell">{inside}</div>'


def test_wide_code_cell() -> None:
    page = cell("x = 1") + cell("x = 1\n" + "y" * 89)
    assert list(wide_cells(page)) == [f"code cell 2 has 89 columns: {'y' * 89}"]


@pytest.mark.parametrize("page", [cell("x" * 88), folded("x" * 89)])
def test_code_cell_without_fault(page: str) -> None:
    assert list(wide_cells(page)) == []


def stub(code: str) -> str:
    return (
        '<div class="literal-block-wrapper"><div class="code-block-caption">'
        '<span class="caption-text">exercises/ch2/f.py</span></div>'
        f'<div class="highlight-python"><pre>{code}</pre></div></div>'
    )


def test_wide_stub() -> None:
    page = stub("import numpy\n" + "y" * 88) + stub("y" * 89)
    found = f"exercises/ch2/f.py has 89 columns: {'y' * 89}"
    assert list(wide_stubs(page)) == [found]
