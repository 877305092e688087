"""Grids as the page's picture of them (``grid.js``) takes them."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.mdp import GridWorld


def page_grid(grid: GridWorld) -> dict[str, Any]:
    """A grid as the page draws it."""
    return {
        "rows": list(grid.rows),
        "cells": grid.cells.tolist(),
        "ends": np.flatnonzero(grid.terminal).tolist(),
        "rewards": (grid.cell_rewards - grid.step_reward).round(6).tolist(),
    }
