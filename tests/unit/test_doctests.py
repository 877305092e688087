"""The examples in docstrings run wherever pytest begins."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.slow
def test_examples_of_one_file_whose_function_has_its_name() -> None:
    """The function ``nnql`` of ``nnql.py`` is not hidden by its module."""
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "robonav/nnql/nnql.py"],
        cwd=ROOT, capture_output=True, text=True,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout
