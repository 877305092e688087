"""Decision processes in the format of the page (``model.js``)."""

from __future__ import annotations

from typing import Any

import numpy as np

from robonav.mdp import FiniteMDP

from .shared import packed


def page_model(model: FiniteMDP) -> dict[str, Any]:
    """Pack the transitions (A, S, S) and rewards (S, A) of a small model for the page."""
    rows = [
        np.asarray(matrix.toarray() if hasattr(matrix, "toarray") else matrix)
        for matrix in model.transitions
    ]
    return {"transitions": packed(np.stack(rows)), "rewards": packed(model.rewards)}
