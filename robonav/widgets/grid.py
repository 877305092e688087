"""Grids in the format of the page (``grid.js``)."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.mdp import GridWorld


def page_grid(grid: GridWorld) -> dict[str, Any]:
    """Pack a grid for the page."""
    return {
        "rows": list(grid.rows),
        "cells": grid.cells.tolist(),
        "ends": np.flatnonzero(grid.terminal).tolist(),
        "rewards": (grid.cell_rewards - grid.step_reward).round(6).tolist(),
    }
