"""Each notebook page as an ``.ipynb`` file, which the page's download button offers.

Pages are written in MyST, of which a plain Jupyter shows parts as raw text. The notebook is therefore converted to
plain Markdown. Equation numbers are kept, and solutions are left out.

Run as a program, ``notebooks.py FOLDER`` writes all notebooks to a folder, numbered in the order of the book. A
notebook that exists is replaced only if its page is newer. The old notebook is then kept beside the new one.
"""

from __future__ import annotations

import base64
import mimetypes
import re
import sys
import textwrap
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml
from check_site import pages
from course_exercises import exercises_of
from docutils import nodes
from quiz import VERDICTS, marks
from release import first_cell
from result_role import with_results
from sphinx.application import Sphinx
from thesis_numbers import thesis_number

from robonav.drills import of_page
from robonav.grading.course import Course

if TYPE_CHECKING:  # it takes seconds, so the functions import it that need it
    import nbformat

ROOT = Path(__file__).resolve().parents[2]

FENCE = re.compile(
    r"^(?P<fence>`{3,}|:{3,})\{(?P<name>[\w:.-]+)\} *(?P<title>[^\n]*)\n(?P<body>.*?)^(?P=fence)[ \t]*$",
    re.M | re.S,
)
OPTIONS = re.compile(r"\A(?::[\w-]+:[^\n]*\n)+|\A---\n.*?\n---\n", re.S)
DOLLARS = re.compile(
    r"^\$\$(?P<body>.*?)\$\$ *\((?P<label>[^()\n]+)\)[ \t]*$", re.M | re.S
)
EXERCISES = re.compile(r"^```\{exercises\} *(?P<page>[\w-]*)\n```$", re.M)
DRILLS = re.compile(r"^```\{drills\}\n```$", re.M)
ROLE = re.compile(r"\{(?P<name>[\w:.-]+)\}`(?P<text>[^`]+)`")
TARGET = re.compile(r"^\([\w:. -]+\)=\n", re.M)
PICTURE = re.compile(r"(?P<start>!\[[^\]]*\]\()(?P<path>[^):\s]+)\)")
KEY = re.compile(r"([a-z]+)(\d{4})[a-z]?")
LABEL = re.compile(
    r"(?P<kind>fig|table|theorem|algorithm|exercise)-(?P<number>\d+(?:-\d+)*)"
)
KINDS = {
    "fig": "Fig.",
    "table": "Table",
    "theorem": "Theorem",
    "algorithm": "Algorithm",
    "exercise": "Exercise",
}
STATEMENTS = {"theorem": "theorem", "thm": "theorem", "lemma": "lemma"}
LEFT_OUT = (
    "solution",
    "solution-start",
    "solution-end",
    "exercise-end",
    "bibliography",
    "contents",
    "slide",
)


def with_tag(tex: str, label: str | None) -> str:
    """Return a displayed formula with the thesis's number, or with its label if it is an equation of the book."""
    number = thesis_number(label or "") or label
    tag = f" \\tag{{{number}}}" if number else ""
    return f"$$\n{tex.strip()}{tag}\n$$"


def plain_directive(match: re.Match[str]) -> str:
    """Return a directive in plain Markdown: formula, picture, code, or a quotation with a bold title."""
    name, title, body = match["name"], match["title"].strip(), match["body"]
    options = OPTIONS.match(body)
    content = body[options.end() :] if options else body
    if name in LEFT_OUT:
        return ""
    if name == "math":
        label = re.search(r"^:label: *(\S+)", body, re.M)
        return with_tag(content, label[1] if label else None)
    if name in ("figure", "image"):
        alt = re.search(r"^:alt: *(.+)$", body, re.M)
        return f"![{alt[1] if alt else ''}]({title})\n\n{content.strip()}"
    if name == "source":
        return f"The code of this function: run `{title}??` in a cell (after `import robonav`)."
    if name == "quiz":
        return plain_quiz(content)
    if name in ("code-block", "code"):
        return f"```{title}\n{content}```"
    heading = (
        f"**{' '.join(filter(None, (name.removeprefix('prf:').capitalize(), title)))}**"
    )
    return "\n".join(
        f"> {line}".rstrip()
        for line in (heading, "", *plain(content).strip().splitlines())
    )


def plain_quiz(content: str) -> str:
    """Return a quiz as folded sections, which Jupyter can open too."""
    text, right = marks(plain(content))
    question, *answers = re.split(r"^- ", text, flags=re.M)
    folds = []
    for answer, is_right in zip(answers, right, strict=True):
        choice, _, why = textwrap.dedent(f"  {answer}").strip().partition("\n")
        explained = textwrap.dedent(why).strip()
        folds.append(
            f"<details><summary>{choice}</summary>\n\n**{VERDICTS[is_right]}** {explained}\n\n</details>"
        )
    return f"**Check yourself.** {question.strip()}\n\n" + "\n".join(folds)


def plain_role(match: re.Match[str]) -> str:
    """Return the text of a role in plain Markdown."""
    name, text = match["name"], match["text"]
    if name == "eq":
        return f"({thesis_number(text) or text})"
    if name.startswith("cite"):
        works = "; ".join(
            f"{author.capitalize()} {year}" for author, year in KEY.findall(text)
        )
        return works if name.startswith("cite:t") else f"({works})"
    if name == "math":
        return f"${text}$"
    if name == "thesis":
        return ", ".join(f"({number.strip()})" for number in text.split(","))
    if name == "name":
        return f"`{text}`"
    if shown := re.fullmatch(r"(.*?)\s*<[^>]*>", text, re.S):
        return shown[1]
    if name == "doc":
        return title_of(text)
    return called(text) if name in ("ref", "numref", "prf:ref") else text


def title_of(page: str) -> str:
    """Return the title of a page of the book."""
    return next(
        line[2:]
        for line in (ROOT / "book" / f"{page}.md").read_text("utf-8").splitlines()
        if line[:2] == "# "
    )


def called(label: str) -> str:
    """Return the name of a label where nothing is numbered: the thesis's number, or words."""
    if match := LABEL.search(label):
        return f"{KINDS[match['kind']]} {match['number'].replace('-', '.')}"
    kind, _, subject = label.replace("-", " ").partition(" ")
    if kind in STATEMENTS:
        return f"the {STATEMENTS[kind]} on {subject}"
    return f"the figure of {label.removeprefix('fig-').replace('-', ' ')}"


def plain(markdown: str) -> str:
    """Convert MyST Markdown to Markdown that a plain Jupyter shows well."""
    steps: list[tuple[re.Pattern[str], str | Callable[[re.Match[str]], str]]] = [
        (FENCE, plain_directive),
        (DOLLARS, lambda match: with_tag(match["body"], match["label"])),
        (ROLE, plain_role),
        (TARGET, ""),
    ]
    markdown = with_results(markdown)
    for pattern, replacement in steps:
        markdown = pattern.sub(replacement, markdown)
    return markdown


def attach_pictures(cell: nbformat.NotebookNode, folder: Path) -> None:
    """Attach the page's own pictures to the cell, because the notebook is used without the book's folder."""
    for path in {match["path"] for match in PICTURE.finditer(cell.source)}:
        picture = folder / path
        kind = mimetypes.guess_type(picture.name)[0] or "application/octet-stream"
        content = base64.b64encode(picture.read_bytes()).decode()
        cell.setdefault("attachments", {})[picture.name] = {kind: content}
    cell.source = PICTURE.sub(
        lambda match: f"{match['start']}attachment:{Path(match['path']).name})",
        cell.source,
    )


def _exercises(match: re.Match[str], page: str) -> str:
    """Return the exercises that a directive lists: those of the page it stands on, or of the page that it names."""
    return exercises_of(Course.of_book(), match["page"] or page)


def _drills(page: str) -> str:
    """Return one question of each drill of a page, its solution folded. Pictures are left out of notebooks."""
    questions = [(drill.title, drill.question(0)) for drill in of_page(page)]
    return "\n\n".join(
        f"**{title}.** {question.text}\n\n"
        f"<details><summary>Solution</summary>\n\n{question.explanation}\n\n</details>"
        for title, question in questions
    )


def notebook_of(source: Path) -> nbformat.NotebookNode:
    """Return the notebook of one page, without outputs. Its first cell installs the package if it is missing."""
    import jupytext
    import nbformat

    notebook = jupytext.read(source)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(first_cell()))
    for index, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{index}"
        if cell.cell_type == "markdown":
            listed = partial(_exercises, page=source.stem)
            text = DRILLS.sub(lambda _: _drills(source.stem), cell.source)
            cell.source = plain(EXERCISES.sub(listed, text))
            attach_pictures(cell, source.parent)
    notebook.metadata.pop("jupytext", None)
    return notebook


def offer(
    app: Sphinx,
    page: str,
    template: str,
    context: dict[str, Any],
    doctree: nodes.document | None,
) -> None:
    """Write the ``.ipynb`` of a notebook page beside its source and tell the theme, which adds the button.

    The page contains the notebook too: a page opened from disk would show the file as text, so ``book.js`` offers this
    copy.
    """
    import nbformat

    if doctree is None or "kernelspec" not in app.env.metadata.get(page, {}):
        return
    target = Path(app.outdir) / "_sources" / f"{page}.ipynb"
    target.parent.mkdir(parents=True, exist_ok=True)
    notebook = notebook_of(Path(app.env.doc2path(page)))
    nbformat.write(notebook, target)
    held = nbformat.writes(notebook).replace("</", "<\\/")
    context["metatags"] += (
        f'<script type="application/x-ipynb+json" id="notebook">{held}</script>'
    )
    context["ipynb_source"] = f"{page}.ipynb"


def notebook_pages() -> list[Path]:
    """Return the sources of the book's notebook pages, in its order."""
    listed = [
        ROOT / f"{page}.md"
        for page in pages(yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8")))
    ]
    return [
        source
        for source in listed
        if source.read_text("utf-8").startswith("---\njupytext:")
    ]


def write_all(folder: Path) -> None:
    """Write the notebooks of the book into a folder."""
    import nbformat

    folder.mkdir(parents=True, exist_ok=True)
    for number, source in enumerate(notebook_pages(), start=1):
        target = folder / f"{number:02d}-{source.stem}.ipynb"
        if target.exists():
            if target.stat().st_mtime > source.stat().st_mtime:
                continue
            target.rename(target.with_suffix(".before.ipynb"))
        nbformat.write(notebook_of(source), target)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect(
        "html-page-context", offer, priority=400
    )  # before the theme gathers its buttons
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    write_all(Path(sys.argv[1]))
