"""Drills of chapter 3, a file for each page. Importing a file registers its drills."""

from . import demonstrations as demonstrations
from . import neural_network as neural_network
