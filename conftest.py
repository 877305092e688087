"""A file of the package is tested as it is imported: after its package.

Some functions have the name of their file, such as ``nnql`` in ``robonav/nnql/nnql.py``. If pytest imports this file
first, it puts the module in the place of the function, and ``from robonav.nnql import nnql`` gives the module.
"""

from __future__ import annotations

import importlib
from pathlib import Path

ROOT = Path(__file__).parent


def pytest_collect_file(file_path: Path) -> None:
    """Import the package of a file before pytest imports the file."""
    if file_path.suffix == ".py" and (ROOT / "robonav") in file_path.parents:
        importlib.import_module(".".join(file_path.parent.relative_to(ROOT).parts))
