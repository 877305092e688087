"""Drills of chapter 1. Importing a file registers its drills."""

from . import introduction as introduction
