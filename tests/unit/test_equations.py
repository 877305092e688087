"""Each numbered equation and each algorithm of the thesis has exactly one definition in the package."""

from __future__ import annotations

import inspect
import re
import textwrap
from pathlib import Path

import citations
import pytest
from package_code import resolve


def test_equation_and_algorithm_definitions() -> None:
    assert citations.faults() == []


def test_symbols_are_equations_with_a_sentence() -> None:
    assert set(citations.symbols()) <= set(citations.EQUATIONS)
    assert all(sentence.endswith(".") for sentence in citations.symbols().values())


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty package in which a test writes functions."""
    made = tmp_path / "robonav"
    (made / "mdp").mkdir(parents=True)
    (made / "plots").mkdir()
    monkeypatch.setattr(citations, "PACKAGE", made)
    return made


def faults_of(package: Path, source: str, about: str, folder: str = "mdp") -> list[str]:
    """The faults about one equation or algorithm that a source text leaves or makes."""
    (package / folder / "models.py").write_text(source)
    return [fault for fault in citations.faults(package) if fault.startswith(about)]


def test_only_first_lines_say_what_an_equation_is() -> None:
    """Below its first line a docstring says which equations a function uses."""
    second = [
        item.name
        for item in citations.documented()
        if re.search(r"\b[Tt]h(is|ese)\s+(is|are)\s+Eqs?\.", rest_of(item.docstring))
    ]
    assert second == []


def rest_of(docstring: str) -> str:
    """A docstring without its first line."""
    return docstring.partition("\n")[2]


DEFINED = '''
def value(q):
    """Value of the best action, Eq. (2.9).

    Uses Eq. (2.15).
    """
    return q.max(axis=1)  # Eq. (2.9)
'''


def test_definition_on_first_line_and_line_of_code(package: Path) -> None:
    assert faults_of(package, DEFINED, "Eq. (2.9)") == []
    assert faults_of(package, DEFINED, "Eq. (2.15)")  # only used


def test_definition_needs_number_on_line_of_code(package: Path) -> None:
    bare = DEFINED.replace("  # Eq. (2.9)", "")
    assert "no line of code" in faults_of(package, bare, "Eq. (2.9)")[0]
    alone = DEFINED.replace("    return", "    # Eq. (2.9)\n    return").replace(
        ")  # Eq. (2.9)", ")"
    )
    assert "no line of code" in faults_of(package, alone, "Eq. (2.9)")[0]


def test_second_definition_is_a_fault(package: Path) -> None:
    second = DEFINED + DEFINED.replace("def value", "def other")
    assert "2 definitions" in faults_of(package, second, "Eq. (2.9)")[0]


def test_plots_define_nothing(package: Path) -> None:
    assert faults_of(package, DEFINED, "Eq. (2.9)", folder="plots")


def test_several_equations_in_one_method(package: Path) -> None:
    source = '''
class Network:
    def cost(self):
        """Cost and its penalty, Eqs. (3.1) and (3.2)."""
        cost = 1  # Eq. (3.1)
        return cost + 2  # Eq. (3.2)
'''
    assert faults_of(package, source, "Eq. (3.1)") == []
    assert faults_of(package, source, "Eq. (3.2)") == []


def test_unknown_number_is_a_fault(package: Path) -> None:
    source = DEFINED.replace("2.9", "2.31")
    assert "not an equation" in faults_of(package, source, "Eq. (2.31)")[0]


@pytest.mark.parametrize(("lines", "right"), [(40, True), (41, False)])
def test_algorithm_length(package: Path, lines: int, right: bool) -> None:
    body = "    x = 1\n" * (lines - 1)
    source = f'def run():\n    """Planning, Algorithm 2.\n\n    Long text.\n    """\n\n{body}'
    assert (faults_of(package, source, "Algorithm 2") == []) is right


BOOK = Path(__file__).resolve().parents[2] / "book"
BESIDE_THE_ALGORITHMS = {
    "modified policy iteration": "robonav.mdp.modified_policy_iteration",
    "prioritised sweeping": "robonav.mdp.prioritized_sweeping",
    "Monte Carlo prediction": "robonav.mdp.monte_carlo_prediction",
    "Monte Carlo control": "robonav.mdp.monte_carlo_control",
    "TD(0)": "robonav.mdp.td_prediction",
    "linear Q-learning": "robonav.mdp.linear_q_learning",
    "QMDP": "robonav.mdp.qmdp",
    "point-based value iteration": "robonav.mdp.point_based_value_iteration",
    "batch gradient descent": "robonav.networks.batch_gradient_descent",
    "stochastic gradient descent": "robonav.networks.stochastic_gradient_descent",
    "the use of L-BFGS": "robonav.networks.torch_lbfgs.lbfgs_iterates",
    "A* on a grid": "robonav.lfd.astar.grid_astar",
    "A* over the robot's actions": "robonav.lfd.astar.modified_astar",
    "behaviour cloning": "robonav.lfd.behaviour_cloning",
    "DAgger": "robonav.lfd.dagger",
    "nearest neighbours": "robonav.lfd.NeighbourPolicy.__call__",
    "NNQL": "robonav.nnql.nnql",
    "online Q-learning": "robonav.nnql.online",
    "NFQ": "robonav.nnql.nfq",
    "DQN": "robonav.nnql.dqn",
    "NIRL": "robonav.nirl.nirl",
    "apprenticeship learning": "robonav.nirl.apprenticeship_learning",
    "apprenticeship learning on the robot": "robonav.nirl.apprenticeship",
    "relative entropy": "robonav.nirl.relative_entropy",
    "the weights of relative entropy": "robonav.nirl.relative_entropy_weights",
    "SCIRL": "robonav.nirl.scirl",
    "maximum causal entropy": "robonav.nirl.maximum_causal_entropy",
}
"""The function of each method that the thesis has no numbered algorithm for, and of those of chapters 4 and 5."""


def listed_on_pages() -> set[str]:
    """The names of all functions whose source a page shows."""
    pages = (path.read_text("utf-8") for path in BOOK.glob("*.md"))
    return {
        name for page in pages for name in re.findall(r"^`{3,}\{source\} (\S+)$", page, re.M)
    }  # fmt: skip


@pytest.mark.parametrize("method", BESIDE_THE_ALGORITHMS)
def test_each_method_is_one_short_function_on_a_page(method: str) -> None:
    """It counts its lines as those of Algorithms 1 to 10: with decorators and signature, without docstring."""
    name = BESIDE_THE_ALGORITHMS[method]
    assert name in listed_on_pages()
    found = resolve(name)
    assert inspect.isfunction(inspect.unwrap(found))
    source = textwrap.dedent(inspect.getsource(found))
    lines = citations.without_docstring(source).splitlines()
    assert len(lines) <= citations.MOST_LINES


def test_each_method_has_a_function_of_its_own() -> None:
    assert len(set(BESIDE_THE_ALGORITHMS.values())) == len(BESIDE_THE_ALGORITHMS)
