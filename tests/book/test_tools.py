"""The book's own Sphinx extensions and checks, without a built book."""

from __future__ import annotations

import importlib
import inspect
import os
import re
from enum import Enum
from pathlib import Path
from types import SimpleNamespace

import check_site
import citations
import drills
import notebooks
import offline
import package_code
import package_digest
import pytest
import reference
from docutils import nodes
from sphinx.addnodes import index
from thesis_numbers import index_algorithms, thesis_number


def test_thesis_numbers_are_read_from_labels() -> None:
    assert thesis_number("eq-2.24") == "2.24"
    assert thesis_number("eq-own") is None
    assert thesis_number("my-eq-2.24") is None


def test_an_algorithm_of_the_thesis_has_an_entry_for_the_search() -> None:
    algorithm = nodes.container(ids=["alg-8"], label="alg-8")
    own = nodes.container(ids=["alg-of-the-book"], label="alg-of-the-book")
    page = nodes.section("", own, algorithm)
    index_algorithms(None, page)  # type: ignore[arg-type]
    entries = [node["entries"] for node in page.findall(index)]
    assert entries == [[("single", "Algorithm 8", "alg-8", "main", None)]]
    assert [type(node) for node in page] == [type(own), index, type(algorithm)]


def test_each_algorithm_of_the_thesis_stands_on_one_page() -> None:
    pages = (Path(__file__).parents[2] / "book").glob("*.md")
    text = "\n".join(page.read_text("utf-8") for page in pages)
    found = re.findall(r"^:+label: alg-(\d+)$", text, re.MULTILINE)
    assert sorted(map(int, found)) == list(range(1, 11))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(2.24)", {(2, 24)}),
        ("(2.29), (4.1)", {(2, 29), (4, 1)}),
        ("(3.23)-(3.25) and (3.27)", {(3, 23), (3, 24), (3, 25), (3, 27)}),
        ("3.1 to 3.3", {(3, 1), (3, 2), (3, 3)}),
        ("8", {(8,)}),
    ],
)
def test_lists_and_ranges_of_numbers(text: str, expected: set[tuple[int, ...]]) -> None:
    assert citations.numbers(text) == expected


def test_citations_are_found_in_docstrings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "robonav"
    (package / "mdp").mkdir(parents=True)
    (package / "mdp" / "chapter.py").write_text(
        'def one():\n    """By Eq. (2.10) and (2.9), Algorithm 2.\n\n    Fig. 3.10.\n    """\n\n\n'
        'class Two:\n    """Nothing."""\n\n'
        '    def three(self):\n        """Much.\n\n        Eqs. (2.9), (4.1).\n        """\n\n'
        '    def _hidden(self):\n        """Eq. (2.9)."""\n'
    )
    monkeypatch.setattr(citations, "PACKAGE", package)
    one, three = "robonav.mdp.chapter.one", "robonav.mdp.chapter.Two.three"

    def names(
        found: dict[citations.Number, list[citations.Documented]],
    ) -> dict[citations.Number, list[str]]:
        return {
            number: [item.name for item in items] for number, items in found.items()
        }

    hidden = "robonav.mdp.chapter.Two._hidden"
    assert names(citations.definitions("equations", package)) == {
        (2, 10): [one],
        (2, 9): [one, hidden],
    }
    assert names(citations.uses("equations", package)) == {
        (2, 9): [three],
        (4, 1): [three],
    }
    assert names(citations.definitions("algorithms", package)) == {(2,): [one]}
    assert names(citations.uses("figures", package)) == {(3, 10): [one]}


def test_docstring_is_cut_and_the_code_stays() -> None:
    source = '@cache\ndef f(x):\n    """Twice x.\n\n    More.\n    """\n\n    y = 2 * x\n    return y\n'
    assert (
        citations.without_docstring(source)
        == "@cache\ndef f(x):\n    y = 2 * x\n    return y\n"
    )
    bare = "def f(x):\n    return x\n"
    assert citations.without_docstring(bare) == bare


def test_names_are_resolved_through_modules_classes_and_fields() -> None:
    import robonav.style
    from robonav.plots.schemes import Box

    assert package_code.resolve("robonav.style.STYLE") is robonav.style.STYLE
    assert package_code.resolve("robonav.plots.schemes.Box") is Box
    assert package_code.resolve("robonav.plots.schemes.Box.texts").name == "texts"
    with pytest.raises(ImportError):
        package_code.resolve("robonav.style.NOTHING")
    with pytest.raises(AttributeError):
        package_code.resolve("robonav.plots.schemes.Box.nothing")


def test_names_of_code_may_break_between_their_words_alone() -> None:
    context = {
        "body": '<span class="pre">mdp.q_learning(rate)</span> a.b <span class="pre">0.5, &lt;x&gt;</span>'
    }
    package_code.let_names_break(None, "page", "page.html", context, None)  # type: ignore[arg-type]
    name, number = "mdp.<wbr>q_<wbr>learning(<wbr>rate)", "0.5, &lt;x&gt;"
    assert (
        context["body"]
        == f'<span class="pre">{name}</span> a.b <span class="pre">{number}</span>'
    )


def test_docstrings_become_lists_under_bold_titles() -> None:
    docstring = """Values of ``mdp`` (Eq. (2.26)); see :func:`~robonav.mdp.plan`.

    Parameters
    ----------
    mdp, env : FiniteMDP or Env
        One of both,
        with S states.
    *rest : (S, A) array
        More.

    Returns
    -------
    float
        The value.

    Raises
    ------
    ValueError
        If it must.

    Examples
    --------
    It counts.

    >>> 1 + 1
    2
    """
    assert reference.markdown(docstring) == (
        "Values of ``mdp`` (Eq. (2.26)); see `robonav.mdp.plan`.\n\n"
        "**Parameters**\n\n- `mdp`, `env` (FiniteMDP or Env): One of both,\n  with S states.\n"
        "- `*rest` ((S, A) array): More.\n\n"
        "**Returns**\n\n- `float`: The value.\n\n"
        "**Raises**\n\n- `ValueError`: If it must.\n\n"
        "**Examples**\n\nIt counts.\n\n```pycon\n>>> 1 + 1\n2\n```"
    )


def test_signatures_have_names_and_defaults_but_no_types() -> None:
    def drive(self: int, worlds: list[int], *, speed: float = 2.0) -> None: ...

    assert reference.signature("drive", drive) == "drive(worlds, *, speed=2.0)"

    def train(cost: object = (drive, 1)) -> None: ...

    assert reference.signature("train", train).endswith(".drive, 1))")
    assert " at 0x" not in reference.signature("train", train)
    assert (
        reference.signature("Way", Enum("Way", ["LEFT", "RIGHT"])) == "Way: LEFT, RIGHT"
    )


def test_methods_are_those_a_class_defines_and_documents() -> None:
    class Base:
        def inherited(self) -> None:
            """From above."""

    class Robot(Base):
        def go(self) -> None:
            """Go."""

        @property
        def place(self) -> int:
            """Where."""
            return 0

        @classmethod
        def new(cls) -> None:
            """Make one."""

        def bare(self) -> None: ...

        def _hidden(self) -> None:
            """Hide."""

    assert [name for name, _ in reference.methods(Robot)] == ["go", "place", "new"]


@pytest.mark.parametrize("chapter", ["mdp", "robot", "networks", "lfd", "nnql", "nirl"])
def test_everything_public_is_documented(chapter: str) -> None:
    module = importlib.import_module(f"robonav.{chapter}")
    public = [getattr(module, name) for name in module.__all__]
    called = [
        found for found in public if inspect.isclass(found) or inspect.isroutine(found)
    ]
    assert [
        found.__name__ for found in called if not reference.own_docstring(found)
    ] == []


MYST = """(here)=
Text {cite:p}`ng2000,abbeel2004` and {cite:t}`xia2015`: see
{eq}`eq-2.24`, {thesis}`2.1, 2.2`, {doc}`the notes <notation>`.
By {prf:ref}`theorem-2-2`, {numref}`fig-table-3-2` and {numref}`fig-trials` in {doc}`notation`.

$$V = r$$ (eq-2.26)

```{math}
:label: own
a = b
```

:::{admonition} Mind
:class: tip
A *word* {term}`policy`.
:::

```{figure} picture.png
:alt: A robot.
Its caption.
```

```{solution} exercise
Secret.
```

```{source} robonav.validation.positive
```
"""


def test_pages_become_plain_markdown() -> None:
    plain = notebooks.plain(MYST)
    assert (
        "Text (Ng 2000; Abbeel 2004) and Xia 2015: see\n(2.24), (2.1), (2.2), the notes."
        in plain
    )
    assert "By Theorem 2.2, Table 3.2 and the figure of trials in Notation." in plain
    assert "$$\nV = r \\tag{2.26}\n$$" in plain
    assert "$$\na = b \\tag{own}\n$$" in plain
    assert "> **Admonition Mind**\n>\n> A *word* policy." in plain
    assert "![A robot.](picture.png)\n\nIts caption." in plain
    assert "robonav.validation.positive??" in plain
    for left_over in ("Secret", "{", ":::", ":alt:", ":class:", "(here)="):
        assert left_over not in plain.replace("\\tag{2.26}", "").replace(
            "\\tag{own}", ""
        )


def test_statements_without_a_number_of_the_thesis_are_called_by_their_subject() -> (
    None
):
    plain = notebooks.plain(
        "By {prf:ref}`lemma-contraction` and {prf:ref}`theorem-2-1`."
    )
    assert plain == "By the lemma on contraction and Theorem 2.1."


PAGE = """---
jupytext:
  text_representation: {extension: .md, format_name: myst}
kernelspec: {display_name: Python 3, language: python, name: python3}
---

# Title

![A dot.](dot.png)

```{code-cell} ipython3
1 + 1
```
"""


@pytest.mark.slow
def test_notebooks_are_valid_reproducible_and_without_outputs(tmp_path: Path) -> None:
    import nbformat  # takes seconds, so other tests do without

    page = tmp_path / "page.md"
    page.write_text(PAGE)
    (tmp_path / "dot.png").write_bytes(b"dot")
    notebook = notebooks.notebook_of(page)
    nbformat.validate(notebook)
    assert [cell.cell_type for cell in notebook.cells] == ["code", "markdown", "code"]
    assert "%pip install" in notebook.cells[0].source
    assert notebook.cells[2].source == "1 + 1"
    assert notebook.cells[2].outputs == []
    assert "![A dot.](attachment:dot.png)" in notebook.cells[1].source
    assert notebook.cells[1].attachments == {"dot.png": {"image/png": "ZG90"}}
    assert notebook == notebooks.notebook_of(page)


def test_a_notebook_lists_its_exercises_and_names_its_own_equations() -> None:
    notebook = notebooks.notebook_of(notebooks.ROOT / "book" / "nnql-comparison.md")
    text = "\n".join(cell.source for cell in notebook.cells)
    assert "- 4.5 Fitted Q iteration with costs: project, about 90 minutes" in text
    assert "\\tag{nfq-target}" in text
    assert "The targets (nfq-target) and the fit (nfq-fit)" in text


@pytest.mark.slow
def test_a_notebook_that_was_changed_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from nbformat.v4 import new_notebook

    (tmp_path / "_toc.yml").write_text("root: page\n")
    (tmp_path / "page.md").write_text(PAGE.replace("![A dot.](dot.png)", ""))
    monkeypatch.setattr(notebooks, "ROOT", tmp_path)
    target = tmp_path / "lab" / "01-page.ipynb"
    notebooks.write_all(target.parent)
    target.write_text("mine")
    notebooks.write_all(target.parent)
    assert target.read_text() == "mine"
    newer = target.stat().st_mtime + 10
    monkeypatch.setattr(notebooks, "notebook_of", lambda source: new_notebook())
    os.utime(tmp_path / "page.md", (newer, newer))
    notebooks.write_all(target.parent)
    assert target.read_text() != "mine"
    assert (target.parent / "01-page.before.ipynb").read_text() == "mine"


def test_digest_sees_code_and_names_but_not_byte_code(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("x = 1")
    first = package_digest.digest_of(tmp_path)
    (tmp_path / "__pycache__").mkdir()
    (tmp_path / "__pycache__" / "a.pyc").write_bytes(b"x")
    assert package_digest.digest_of(tmp_path) == first
    (tmp_path / "a.py").rename(tmp_path / "b.py")
    second = package_digest.digest_of(tmp_path)
    (tmp_path / "b.py").write_text("x = 2")
    assert len({first, second, package_digest.digest_of(tmp_path)}) == 3


@pytest.mark.parametrize(
    ("article", "fault"),
    [
        ("word " * 200, None),
        ("word " * 20, "holds fewer than 400 characters"),
        ("word " * 200 + "Traceback (most recent call last)", "shows a failed cell"),
        (
            "word " * 200 + '<div class="system-message">',
            "shows a directive or role that did not parse",
        ),
        ("word " * 200 + "<code>{eq}</code>", "shows an unresolved reference"),
        (
            "word " * 200 + "moving $w \\leftarrow w + 1$",
            "shows a formula that did not parse",
        ),
        (
            "word " * 200
            + '<span class="math">\\(\\alpha\\)</span><code>\\dots</code>',
            None,
        ),
    ],
)
def test_a_page_that_failed_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, article: str, fault: str | None
) -> None:
    monkeypatch.setattr(check_site, "SITE", tmp_path)
    (tmp_path / "page.html").write_text(f"<html><article>{article}</article></html>")
    assert list(check_site.faults("page")) == ([fault] if fault else [])
    assert list(check_site.faults("other")) == ["was not built"]


def test_every_page_of_a_table_of_contents_is_listed() -> None:
    contents = {
        "root": "a",
        "parts": [
            {"caption": "P", "chapters": [{"file": "b", "sections": [{"file": "c"}]}]},
            {"chapters": [{"file": "d"}, {"url": "e"}]},
        ],
    }
    assert list(check_site.pages(contents)) == ["a", "b", "c", "d"]


def test_the_page_of_progress_notes_each_file_of_the_drills_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    noted: list[str] = []
    env = SimpleNamespace(docname="book/my-progress", note_dependency=noted.append)
    state = SimpleNamespace(document=SimpleNamespace(settings=SimpleNamespace(env=env)))
    monkeypatch.setattr(drills, "folded", lambda drill, static: drill.name)
    monkeypatch.setattr(drills.Progress, "parse_text_to_nodes", lambda self, text: [])
    directive = object.__new__(drills.Progress)
    directive.state = state
    shown = "".join(part.astext() for part in directive.run())
    assert all(name in shown for name in drills.DRILLS)
    assert any(path.endswith("question.py") for path in noted)
    assert len(noted) == len(set(noted))


def test_files_that_no_browser_loads_are_removed(tmp_path: Path) -> None:
    fonts, words = tmp_path / "_static/fonts", tmp_path / "_static/locales/de"
    fonts.mkdir(parents=True)
    words.mkdir(parents=True)
    for name in ("icons.woff2", "icons.ttf", "only.ttf", "theme.css", "theme.css.map"):
        (fonts / name).write_text("")
    for name in ("theme.po", "theme.mo"):
        (words / name).write_text("")
    offline.remove_what_no_browser_loads(SimpleNamespace(outdir=tmp_path), None)
    left = {path.name for path in tmp_path.rglob("*") if path.is_file()}
    assert left == {"icons.woff2", "only.ttf", "theme.css"}
