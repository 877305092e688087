"""Figures of results with matplotlib. These functions draw, and compute nothing else."""
