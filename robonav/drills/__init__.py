"""Drills: questions with new numbers each time, their right answers computed by the package's own functions."""

from . import chapter1 as chapter1
from . import chapter2 as chapter2
from . import chapter3 as chapter3
from . import chapter4 as chapter4
from . import chapter5 as chapter5
from . import chapter6 as chapter6
from .question import (
    Choice,
    Number,
    Order,
    Place,
    Question,
    Table,
    Verdict,
)
from .registry import DRILLS, Drill, drill, of_page

__all__ = [
    "DRILLS",
    "Choice",
    "Drill",
    "Number",
    "Order",
    "Place",
    "Question",
    "Table",
    "Verdict",
    "drill",
    "of_page",
]
