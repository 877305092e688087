"""The release of the book: a wheel beside the pages, and the first cell of a notebook, which installs it.

An index may have another package of the same name, so a downloaded notebook installs exactly the wheel that its book
was built with: from the book's address if that is known (``make book ADDRESS=https://...``), else from the notebook's
folder.
"""

from __future__ import annotations

import base64
import hashlib
import os
import zipfile
from importlib.metadata import distribution
from pathlib import Path

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


def wheel_name() -> str:
    """Return the file name of the wheel."""
    return f"robonav-{distribution('robonav').version}-py3-none-any.whl"


def first_cell(address: str | None = None) -> str:
    """Return the cell that installs the wheel, from the book's address or from the notebook's folder."""
    where = os.environ.get("BOOK_ADDRESS", "") if address is None else address
    return FIRST_CELL.format(
        wheel=f"{where.rstrip('/')}/{FOLDER}/{wheel_name()}" if where else wheel_name()
    )


def build_wheel(folder: Path) -> Path:
    """Write the wheel: the files of the package, and the metadata of the installed package."""
    about = distribution("robonav")
    info = f"robonav-{about.version}.dist-info"
    package = [
        path
        for path in sorted((ROOT / "robonav").rglob("*"))
        if path.is_file() and _belongs(path)
    ]
    contents = {
        path.relative_to(ROOT).as_posix(): path.read_bytes() for path in package
    }
    metadata = (
        about.read_text("METADATA") or about.read_text("PKG-INFO") or ""
    )  # of an editable installation
    contents[f"{info}/METADATA"] = metadata.encode()
    contents[f"{info}/entry_points.txt"] = (
        about.read_text("entry_points.txt") or ""
    ).encode()
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
