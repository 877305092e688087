"""Question banks and exams from the drills: Moodle XML, QTI packages, and papers to print."""

from .moodle import moodle_xml
from .package import qti_zip
from .selection import Drawn, drawn, selected

__all__ = ["Drawn", "drawn", "moodle_xml", "qti_zip", "selected"]
