"""What readers take away: the wheel, the notebook's first cell, and where a page can be edited."""

from __future__ import annotations

import re
import subprocess
import sys
import zipfile
from importlib.metadata import distributions
from pathlib import Path

import edit_page
import print_book
import pytest
import release
from browser import executable
from packaging.requirements import Requirement

from robonav import __version__


def test_the_wheel_installs_and_is_whole(tmp_path: Path) -> None:
    wheel = release.build_wheel(tmp_path / "wheels")
    assert wheel.read_bytes() == release.build_wheel(tmp_path / "again").read_bytes()
    pip = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-index",
        "--no-deps",
        "--target",
        tmp_path / "to",
    ]
    subprocess.run([*pip, wheel], check=True, timeout=600)
    code = "import robonav, robonav.style; print(robonav.__file__)"
    found = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path / "to",
        capture_output=True,
        text=True,
        check=True,
        timeout=600,
    )
    assert found.stdout.startswith(str(tmp_path / "to"))
    names = zipfile.ZipFile(wheel).namelist()
    assert "robonav/widgets/shared.js" in names
    assert "robonav/py.typed" in names
    assert not [name for name in names if "__pycache__" in name]


def test_the_wheel_is_of_the_distribution_with_the_books_name(tmp_path: Path) -> None:
    wheel = release.build_wheel(tmp_path)
    assert re.fullmatch(r"robonav_book-[\d.]+-py3-none-any\.whl", wheel.name)
    about = next(iter(distributions(path=[str(wheel)])))
    assert about.metadata["Name"] == release.project()["name"] == "robonav-book"
    assert about.version == __version__
    required = [Requirement(line) for line in about.requires or []]
    assert any(one.name == "pytest" and "extra" in str(one.marker) for one in required)
    assert [(e.name, e.value) for e in about.entry_points] == [
        ("robonav", "robonav.cli:main")
    ]
    with zipfile.ZipFile(wheel) as archive:
        for line in archive.read(f"{release.release_name()}.dist-info/RECORD").split():
            name, digest, size = line.decode().rsplit(",", 2)
            if digest:
                content = archive.read(name)
                assert len(content) == int(size)
                assert digest == f"sha256={release._digest(content)}"


def test_pages_link_to_the_wheel_of_this_version() -> None:
    for page in (release.ROOT / "book").glob("*.md"):
        for name in re.findall(r"robonav[\w.-]*\.whl", page.read_text("utf-8")):
            assert name == release.wheel_name(), page.name


def test_a_notebooks_first_cell_installs_the_books_own_release() -> None:
    assert f'"https://a.b/book/_static/{release.wheel_name()}"' in release.first_cell(
        "https://a.b/book/"
    )
    assert f'"{release.wheel_name()}"' in release.first_cell("")
    compile(
        release.first_cell("")
        .replace("%pip", "# %pip")
        .replace("is None:", "is None: pass"),
        "cell",
        "exec",
    )


@pytest.mark.parametrize(
    ("origin", "page"),
    [
        ("https://github.com/some/book.git\n", "https://github.com/some/book"),
        (
            "https://name:token@gitlab.com/group/sub/book",
            "https://gitlab.com/group/sub/book",
        ),
        ("git@github.com:some/book.git", "https://github.com/some/book"),
        ("ssh://git@bitbucket.org/some/book.git", "https://bitbucket.org/some/book"),
        ("/home/me/book", None),
        ("https://elsewhere.example/some/book.git", None),
        ("", None),
    ],
)
def test_where_a_page_can_be_edited(origin: str, page: str | None) -> None:
    assert edit_page.page_of(origin) == page


def test_a_repository_that_is_named_comes_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("REPOSITORY", "https://git.example/our/book/")
    assert edit_page.repository() == "https://git.example/our/book"


def test_notebooks_to_take_away_hold_no_solutions(site: Path) -> None:
    taken = list((site / "_sources").rglob("*.ipynb"))
    assert taken
    for notebook in taken:
        text = notebook.read_text("utf-8")
        assert "```{solution" not in text
        assert "%pip install" in text
    assert (site / "_static" / release.wheel_name()).is_file()


@pytest.mark.parametrize(
    ("address", "expected"),
    [
        ("#here", "#book-robot--here"),
        ("nnql.html", "#book-nnql"),
        ("reference/mdp.html#robonav.mdp", "#book-reference-mdp--robonav.mdp"),
        ("../_images/a.png", "_images/a.png"),
        ("https://a.b/c.html", "https://a.b/c.html"),
        ("data:image/png;base64,AA", "data:image/png;base64,AA"),
        ("../search.html", "search.html"),
    ],
)
def test_links_stay_inside_the_printed_book(address: str, expected: str) -> None:
    known = {"book/robot", "book/nnql", "book/reference/mdp"}
    assert print_book.inside("book/robot", address, known) == expected


def test_a_printed_page_is_open_and_still(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("BOOK_ADDRESS", raising=False)
    source = """<html><article><h1 id="top">Title<a class="headerlink" href="#top">#</a></h1>
      <details class="quiz"><summary>A</summary>why</details><details class="hide above-input"><pre>x</pre></details>
      <details class="hide above-output"><summary>Show</summary><table></table></details>
      <div class="animation"><img id="i"></div><script>frames[0] = "data:a"; frames[1] = "data:b\\
c"</script><a href="../_static/file.whl">this file</a>
      <script>run()</script><script type="application/vnd.jupyter.widget-view+json">{}</script></article></html>"""
    article = print_book.prepared("book/robot", source, {"book/robot"})
    assert article["id"] == "book-robot"
    assert article.h1["id"] == "book-robot--top"
    assert article.h1.get_text() == "Title"
    assert [details.has_attr("open") for details in article.find_all("details")] == [
        True
    ]
    assert (
        article.table is not None
    )  # an output in a fold is printed, a cell's code is not
    assert (
        article.img["src"] == "data:bc"
    )  # the frame half-way, without its line's break
    assert article.a is None  # a file of this machine
    assert [script.get("type") for script in article.find_all("script")] == [
        "application/vnd.jupyter.widget-view+json"
    ]


def test_some_pages_are_printed(site: Path, tmp_path: Path) -> None:
    if executable() is None:
        pytest.skip("Chromium is not installed")
    document = tmp_path / "some.html"
    whole = print_book.joined(["book/cite", "book/playground"])
    document.write_text(
        whole.replace("<head>", f'<head><base href="{site.as_uri()}/">'), "utf-8"
    )
    code = "import print_book, sys; from pathlib import Path; print_book.print_to(*map(Path, sys.argv[1:]))"
    command = [
        sys.executable,
        "-c",
        code,
        tmp_path / "some.pdf",
        document,
    ]  # apart: one browser's loop a process
    subprocess.run(
        command, cwd=Path(print_book.__file__).parent, check=True, timeout=600
    )
    assert (tmp_path / "some.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "some.pdf").stat().st_size > 50_000
