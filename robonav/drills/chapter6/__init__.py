"""Drills of chapter 6. Importing a file registers its drills."""

from . import conclusions as conclusions
from . import planners as planners
