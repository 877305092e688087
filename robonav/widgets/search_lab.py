"""Search lab: modified A* and grid A* on one map, node by node."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import anywidget
import numpy as np
import traitlets

from robonav.lfd import GridPlan, Plan, plan, plan_on_grid
from robonav.robot import Worlds
from robonav.validation import check_array

from .shared import front_end, packed, style_sheet
from .simulator import page_world


class SearchLab(anywidget.AnyWidget):
    """Choose a map, a margin and a cell, and watch both searches. With a kernel, move the target."""

    _esm = front_end("simulator", "maps", "search_lab")
    _css = style_sheet("maps", "search_lab")
    data = traitlets.Dict().tag(sync=True)

    def __init__(
        self,
        worlds: Mapping[str, Worlds],
        margins: Sequence[float],
        cells: Sequence[float],
        speed: float,
    ) -> None:
        self._worlds = list(worlds.values())
        self._settings = list(product(margins, cells))
        self._speed = speed
        offered = {
            "map": list(worlds),
            "margin kept": [f"{margin:g} m" for margin in margins],
            "side of a cell": [f"{cell:g} m" for cell in cells],
        }
        super().__init__(
            data={
                "worlds": [page_world(world) for world in self._worlds],
                "controls": [
                    {"label": label, "options": options, "value": 0}
                    for label, options in offered.items()
                ],
                "runs": [
                    _both(world, *setting, speed)
                    for world in self._worlds
                    for setting in self._settings
                ],
                "speed": speed,
            }
        )
        self.on_msg(self._answer)

    def _answer(self, _widget: Any, message: dict[str, Any], _buffers: Any) -> None:
        """Answer the page, which asks whether a kernel is there, or for paths to another target."""
        if message.get("ask") == "kernel":
            self.send({"kernel": True})
        elif message.get("ask") == "search":
            try:
                world, margin, cell = (int(choice) for choice in message["chosen"])
                count = len(self.data["controls"][2]["options"])
                target = check_array("target", message["target"], shape=(2,))
                elsewhere = replace(self._worlds[world], targets=target[None])
                run = _both(
                    elsewhere, *self._settings[margin * count + cell], self._speed
                )
                self.send({"target": target.tolist(), "run": run})
            except (ValueError, TypeError) as error:
                self.send({"error": str(error)})


def search_lab(
    worlds: Mapping[str, Worlds],
    *,
    margins: Sequence[float] = (2.0, 1.0, 4.0),
    cells: Sequence[float] = (1.0, 2.0, 4.0),
    speed: float = 2.0,
) -> SearchLab:
    """Make the lab for some maps. Both searches run here for every map, margin and cell, and the page replays them.

    Parameters
    ----------
    worlds : mapping of str to Worlds
        Batches of one by name.
    margins : sequence of float
        Distances in metres to keep from obstacles. The first is chosen at first.
    cells : sequence of float
        Sides of squares in metres. The modified search treats poses with one heading in one square as equal. For
        grid A* they are the cells of the grid.
    speed : float
        The speed of the robot in m/s.

    Returns
    -------
    SearchLab

    Raises
    ------
    ValueError
        If there is nothing to choose from, or a number is out of bounds.

    Examples
    --------
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.search_lab import search_lab
    >>> maps = {"5 obstacles": random_worlds(1, obstacles=5, seed=41)}
    >>> len(search_lab(maps, margins=[2.0], cells=[4.0]).data) > 0
    True
    """
    for name, choices in (("worlds", worlds), ("margins", margins), ("cells", cells)):
        if not choices:
            raise ValueError(f"{name} must hold at least one, got none")
    return SearchLab(worlds, margins, cells, speed)


def _both(
    world: Worlds, margin: float, cell: float, speed: float
) -> list[dict[str, Any]]:
    """Return both searches in the format of the page."""
    with warnings.catch_warnings():  # the page itself shows that cells are too large
        warnings.filterwarnings("ignore", message="plan found no path")
        by_actions = plan(world, margin=margin, cell=cell, speed=speed, record=True)
    on_grid = plan_on_grid(world, margin=margin, cell=cell, record=True)
    return [
        {
            "kind": "actions",
            "steps": len(by_actions.actions),
            **_told(by_actions),
        },
        {"kind": "grid", "steps": None, **_told(on_grid)},
    ]


def _told(found: Plan | GridPlan) -> dict[str, Any]:
    """Return the values that both kinds of plan have; positions of nodes are rounded to a centimetre."""
    assert found.visited is not None
    return {
        "found": bool(found.found),
        "length": float(found.length),
        "expanded": int(found.expanded),
        "points": packed(found.points),
        "visited": packed(np.rint(100 * found.visited[:, :2]), np.uint16),
    }
