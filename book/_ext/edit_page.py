"""A link on every page to edit its source, if the address of the repository is known.

The address is that of ``make book REPOSITORY=https://...``, or else the origin of the clone, if it is on one of the
hosts whose addresses the theme knows.
"""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.config import Config

ROOT = Path(__file__).resolve().parents[2]
ORIGIN = re.compile(
    r"(?:https://(?:[^@/]+@)?|git@|ssh://git@)(?P<host>(?:github|gitlab)\.com|bitbucket\.org)[:/](?P<path>.+?)(?:\.git)?/?"
)


def page_of(origin: str) -> str | None:
    """Return the web address of a repository from the address of its clone, without any user name or token."""
    found = ORIGIN.fullmatch(origin.strip())
    return f"https://{found['host']}/{found['path']}" if found else None


def repository() -> str | None:
    """Return the address of the repository of the book's sources, if it is known."""
    if os.environ.get("REPOSITORY"):
        return os.environ["REPOSITORY"].rstrip("/")
    command = ["git", "-C", str(ROOT), "remote", "get-url", "origin"]
    try:
        return page_of(
            subprocess.run(command, capture_output=True, text=True, check=True).stdout
        )
    except (OSError, subprocess.CalledProcessError):
        return None


def offer(app: Sphinx, config: Config) -> None:
    """Turn on the theme's edit button."""
    address = repository()
    if address:
        config.html_theme_options |= {
            "repository_url": address,
            "repository_branch": os.environ.get("BRANCH", "main"),
            "path_to_docs": "",
            "use_edit_page_button": True,
        }


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("config-inited", offer, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
