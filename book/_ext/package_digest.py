"""Run notebooks again when the package changes.

The cache of executed notebooks depends on the cells of a notebook, but not on the code that they import. The folder of
the cache is therefore named after a digest of the package, and pages are read again when the digest changes.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import time
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.config import Config

ROOT = Path(__file__).resolve().parents[2]
CACHES = ROOT / "_build" / "executed"
A_DAY = 24 * 3600  # seconds


def digest_of(folder: Path) -> str:
    """Return a short digest of the names and contents of all files below a folder, without byte code."""
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            total.update(
                path.relative_to(folder).as_posix().encode()
                + b"\0"
                + path.read_bytes()
                + b"\0"
            )
    return total.hexdigest()[:12]


def prepared_cache() -> Path:
    """Return the folder for notebooks of this package. Folders that nobody used for a day are deleted."""
    chosen = CACHES / digest_of(ROOT / "robonav")
    chosen.mkdir(parents=True, exist_ok=True)
    os.utime(chosen)
    for other in CACHES.iterdir():
        if other.stat().st_mtime < time.time() - A_DAY:
            shutil.rmtree(other)
    return chosen


def choose_cache(app: Sphinx, config: Config) -> None:
    """Set the notebook cache to the folder of this digest."""
    chosen = prepared_cache()
    config.package_digest = chosen.name
    config.nb_execution_cache_path = str(chosen)


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_config_value("package_digest", "", "env")
    app.connect("config-inited", choose_cache, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
