"""Grid lab: values and arrows on a grid, step by step, several methods side by side, in every setting."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import anywidget
import numpy as np
import traitlets
from numpy.typing import ArrayLike, NDArray

from robonav.mdp import Cell, FiniteMDP, GridWorld
from robonav.mdp.generalised_policy_iteration import suboptimality
from robonav.validation import check_array

from .grid import page_grid
from .shared import front_end, packed, style_sheet


@dataclass(frozen=True)
class Replay:
    """What one method did on a grid, as frames to step through.

    Attributes
    ----------
    values : (F, S).
    policies : (F, S), action indices.
    said : a few words on each frame, F of them.
    walks : states passed, to be drawn as a line, F lists; none if left out.
    """

    values: NDArray[np.float64]
    policies: NDArray[np.intp]
    said: Sequence[str]
    walks: Sequence[Sequence[int]] = ()


def replay(
    mdp: FiniteMDP,
    values: ArrayLike,
    policies: ArrayLike,
    *,
    best: ArrayLike,
    steps: Sequence[str],
    walks: Sequence[Sequence[int]] = (),
) -> Replay:
    """Frames from a recorded history, each compared with the best.

    Parameters
    ----------
    values, policies : (F, S), such as ``history`` and ``policies`` of a recorded solution.
    best : (S,), the optimal values.
    steps : what each frame shows, such as "sweep 3".
    walks : the states passed in each frame, to be drawn as a line; none if left out.

    Raises
    ------
    ValueError : if there are not as many values, policies and walks as steps.
    """
    held = check_array("values", values, shape=(len(steps), mdp.n_states))
    chosen = check_array("policies", policies, shape=held.shape, dtype=np.intp)
    if walks and len(walks) != len(steps):
        raise ValueError(
            f"walks must be as many as steps, {len(steps)}, got {len(walks)}"
        )
    compared = zip(steps, *suboptimality(mdp, held, chosen, best=best), strict=True)
    return Replay(
        held,
        chosen,
        [f"{step}: {_judged(off, lost)}" for step, off, lost in compared],
        walks,
    )


def _judged(off: float, lost: float) -> str:
    close = "values exact" if off < 5e-4 else f"values off by up to {off:.3g}"
    return (
        f"{close}, arrows optimal"
        if lost < 5e-4
        else f"{close}, the arrows lose up to {lost:.3g}"
    )


Solver = Callable[[GridWorld, tuple[str, ...]], Mapping[str, Replay]]


class GridLab(anywidget.AnyWidget):
    """Choose a setting; step through what each method did; touch a cell. With a kernel: draw a map and solve it."""

    _esm = front_end("grid", "grid_lab")
    _css = style_sheet("grid", "grid_lab")
    data = traitlets.Dict().tag(sync=True)

    def __init__(
        self, data: dict[str, Any], solve: Solver | None, legend: Mapping[str, Cell]
    ) -> None:
        super().__init__(data=data)
        self._solve, self._legend = solve, legend
        self.on_msg(self._answer)

    def _answer(self, _widget: Any, message: dict[str, Any], _buffers: Any) -> None:
        """The page asks whether a kernel is there, or for a map of the reader's own to be solved."""
        if message.get("ask") == "kernel":
            self.send({"kernel": self._solve is not None})
        elif message.get("ask") == "solve" and self._solve is not None:
            try:
                grid = GridWorld(str(message["text"]), legend=self._legend)
                replays = self._solve(
                    grid, tuple(str(choice) for choice in message["choices"])
                )
                self.send({"grid": page_grid(grid), "run": _run(replays)})
            except (ValueError, TypeError) as error:
                self.send({"error": str(error)})


def grid_lab(
    grids: Mapping[str, GridWorld],
    controls: Mapping[str, Sequence[str]],
    runs: Mapping[tuple[str, ...], Mapping[str, Replay]],
    *,
    start: Sequence[str] = (),
    solve: Solver | None = None,
) -> GridLab:
    """The lab for some grids and for every combination of some settings.

    Parameters
    ----------
    grids : by the name under which they are offered.
    controls : names of further settings, and their choices.
    runs : for each grid's name and combination of choices, (grid, choice, choice, ...), a replay by method.
    start : grid and choices shown at first; by default the first of each.
    solve : what a map drawn by the reader is solved with, given the grid and the choices; needs a kernel. Its symbols
        mean what they mean in the grids offered.

    Raises
    ------
    ValueError : if a combination is missing, or a replay is of another grid.
    """
    offered = {
        "map": list(grids),
        **{label: list(options) for label, options in controls.items()},
    }
    combinations = list(product(*offered.values()))
    first = tuple(start) or combinations[0]
    for combination in (*combinations, first):
        if combination not in runs:
            raise ValueError(f"runs must hold replays for {combination}")
        for name, shown in runs[combination].items():
            check_array(
                f"values of {name}",
                shown.values,
                shape=(len(shown.said), grids[combination[0]].n_states),
            )
    return GridLab(
        {
            "grids": [page_grid(grid) for grid in grids.values()],
            "controls": [
                {"label": label, "options": options, "value": options.index(choice)}
                for (label, options), choice in zip(offered.items(), first, strict=True)
            ],
            "runs": [_run(runs[combination]) for combination in combinations],
        },
        solve,
        {
            symbol: cell
            for grid in grids.values()
            for symbol, cell in grid.legend.items()
        },
    )


def _run(replays: Mapping[str, Replay]) -> list[dict[str, Any]]:
    """The replays of one setting; single precision is more than a picture shows."""
    return [
        {
            "name": name,
            "values": packed(shown.values, np.float32),
            "policies": packed(shown.policies, np.uint8),
            "said": list(shown.said),
            "walks": [list(map(int, walk)) for walk in shown.walks],
        }
        for name, shown in replays.items()
    ]
