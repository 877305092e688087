"""Question banks and exams from the drills: Moodle XML, QTI packages, and papers to print."""

from .moodle import moodle_xml
from .package import qti_zip
from .paper import Paper, exam_pdf, solutions_pdf
from .request import Exported, Request, export
from .selection import Drawn, drawn, seen, selected, spread, varied

__all__ = [
    "Drawn",
    "Exported",
    "Paper",
    "Request",
    "drawn",
    "exam_pdf",
    "export",
    "moodle_xml",
    "qti_zip",
    "seen",
    "selected",
    "solutions_pdf",
    "spread",
    "varied",
]
