"""Grid lab: values and arrows on a grid, step by step, for several methods and in every setting."""

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
    """The steps of one method on a grid, as F frames.

    Attributes
    ----------
    values : (F, S) array
        The values of the states.
    policies : (F, S) array of int
        The actions of the states.
    said : sequence of str
        A few words on each frame.
    walks : sequence of sequence of int
        The states visited in each frame, drawn as a line; empty if there are none.
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
    """Make the frames of a recorded history, each compared with the optimal values.

    Parameters
    ----------
    values, policies : (F, S) array
        The history of a recorded solution, such as its ``history`` and ``policies``.
    best : (S,) array
        The optimal values.
    steps : sequence of str
        The name of each frame, such as "sweep 3".
    walks : sequence of sequence of int
        The states visited in each frame, drawn as a line; empty if there are none.

    Returns
    -------
    Replay

    Raises
    ------
    ValueError
        If the numbers of values, policies, walks and steps differ.
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
    """Choose a setting, step through each method, and touch a cell. With a kernel, draw a map and solve it."""

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
        """Answer the page, which asks whether a kernel is there, or for the solution of the reader's own map."""
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
    """Make the lab for some grids and every combination of some settings.

    Parameters
    ----------
    grids : mapping of str to GridWorld
        The grids by name.
    controls : mapping of str to sequence of str
        The names of further settings, and their choices.
    runs : mapping of tuple to mapping of str to Replay
        A replay of each method for each grid and combination of choices, (grid, choice, choice, ...).
    start : sequence of str, optional
        The grid and the choices at first; by default the first of each.
    solve : callable, optional
        A function of a grid that the reader drew and the choices. It returns the replays and needs a kernel. The
        symbols of the map have the same meaning as in the given grids.

    Returns
    -------
    GridLab

    Raises
    ------
    ValueError
        If a combination is missing, or a replay belongs to another grid.
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
    """Pack the replays of one setting for the page, in single precision, which is sufficient for a picture."""
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
