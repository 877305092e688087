"""Each numbered equation and each algorithm of the thesis has exactly one definition in the package."""

from __future__ import annotations

import re
from pathlib import Path

import citations
import pytest


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
