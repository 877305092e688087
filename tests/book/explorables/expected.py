"""The table of expectations, filled by the files of all chapters."""

from . import chapter2, chapter3, chapter4, chapter5, chapter6, robot
from .table import EXPECTED

__all__ = [
    "EXPECTED",
    "chapter2",
    "chapter3",
    "chapter4",
    "chapter5",
    "chapter6",
    "robot",
]
