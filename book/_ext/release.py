"""The release of the book: a wheel beside the pages, and the first cell of a notebook, which installs it.

A downloaded notebook installs exactly the wheel that its book was built with: from the book's address if that is known
(``make book ADDRESS=https://...``), else from the notebook's folder. The wheel's metadata come from ``pyproject.toml``,
so the wheel does not depend on which version of the package is installed where the book is built.
"""

from __future__ import annotations

import base64
import hashlib
import os
import tomllib
import zipfile
from pathlib import Path
from typing import Any

from packaging.metadata import Metadata
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
FOLDER = "_static"
LONG_AGO = (
    1980,
    1,
    1,
    0,
    0,
    0,
)  # the time of every file, so that equal packages give equal bytes
FIRST_CELL = """\
# Away from home, in Colab for instance: install the release of robonav that this notebook was made with.
import importlib.util

if importlib.util.find_spec("robonav") is None:
    %pip install --quiet "{wheel}" anywidget"""


def project() -> dict[str, Any]:
    """Return the table ``[project]`` of ``pyproject.toml``."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def release_name() -> str:
    """Return the name and the version of the release, as file names of the wheel begin."""
    about = project()
    return f"{canonicalize_name(about['name']).replace('-', '_')}-{about['version']}"


def wheel_name() -> str:
    """Return the file name of the wheel."""
    return f"{release_name()}-py3-none-any.whl"


def first_cell(address: str | None = None) -> str:
    """Return the cell that installs the wheel, from the book's address or from the notebook's folder."""
    where = os.environ.get("BOOK_ADDRESS", "") if address is None else address
    return FIRST_CELL.format(
        wheel=f"{where.rstrip('/')}/{FOLDER}/{wheel_name()}" if where else wheel_name()
    )


def metadata() -> bytes:
    """Return the file METADATA of the wheel."""
    about = project()
    extras = about["optional-dependencies"]
    optional = [
        _with_extra(requirement, extra)
        for extra, requirements in extras.items()
        for requirement in requirements
    ]
    fields = {
        "metadata_version": "2.4",
        "name": about["name"],
        "version": about["version"],
        "summary": about["description"],
        "author": ", ".join(author["name"] for author in about["authors"]),
        "keywords": about["keywords"],
        "classifiers": about["classifiers"],
        "license_expression": about["license"],
        "license_files": about["license-files"],
        "requires_python": about["requires-python"],
        "requires_dist": about["dependencies"] + optional,
        "provides_extra": list(extras),
        "description": (ROOT / about["readme"]).read_text("utf-8"),
        "description_content_type": "text/markdown",
    }
    return Metadata.from_raw(fields).as_rfc822().as_bytes()


def _with_extra(text: str, extra: str) -> str:
    requirement = Requirement(text)
    also = f" and ({requirement.marker})" if requirement.marker else ""
    requirement.marker = None
    return f'{requirement}; extra == "{extra}"{also}'


def _entry_points() -> bytes:
    lines = [f"{name} = {target}" for name, target in project()["scripts"].items()]
    return "\n".join(["[console_scripts]", *lines, ""]).encode()


def build_wheel(folder: Path) -> Path:
    """Write the wheel: the files of the package, and the metadata of ``pyproject.toml``."""
    info = f"{release_name()}.dist-info"
    package = [
        path
        for path in sorted((ROOT / "robonav").rglob("*"))
        if path.is_file() and _belongs(path)
    ]
    contents = {
        path.relative_to(ROOT).as_posix(): path.read_bytes() for path in package
    }
    contents[f"{info}/METADATA"] = metadata()
    contents[f"{info}/entry_points.txt"] = _entry_points()
    contents[f"{info}/licenses/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    contents[f"{info}/WHEEL"] = (
        b"Wheel-Version: 1.0\nGenerator: robonav\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    )
    record = [
        f"{name},sha256={_digest(content)},{len(content)}"
        for name, content in contents.items()
    ]
    contents[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    folder.mkdir(parents=True, exist_ok=True)
    wheel = folder / wheel_name()
    with zipfile.ZipFile(wheel, "w") as archive:
        for name, content in contents.items():
            archive.writestr(
                zipfile.ZipInfo(name, LONG_AGO), content, zipfile.ZIP_DEFLATED
            )
    return wheel


def _belongs(path: Path) -> bool:
    return "__pycache__" not in path.parts and path.suffix not in (
        ".pyc",
        ".nbi",
        ".nbc",
    )


def _digest(content: bytes) -> str:
    return (
        base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    )


def offer(app: Sphinx, error: Exception | None) -> None:
    """Put the wheel beside the pages."""
    if error is None and app.builder.format == "html":
        build_wheel(Path(app.outdir) / FOLDER)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("build-finished", offer)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
