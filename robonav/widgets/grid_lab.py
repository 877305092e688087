"""Grid lab: values and arrows on a grid, step by step, for several methods and in every setting."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.mdp import Cell, FiniteMDP, GridWorld, rollouts
from robonav.mdp.generalized_policy_iteration import suboptimality
from robonav.mdp.learner import ControlMethod
from robonav.mdp.learning_results import ControlResult
from robonav.validation import check_array, check_integer, check_one_of

from .grid import page_grid
from .kernel_training import KernelTraining, Report
from .shared import front_end, menus, packed, spread_out, style_sheet

FRAMES = 25
"""Approximate number of frames that show a training on the reader's map."""

MOST_STEPS = 500
"""Steps after which an episode on the reader's map is cut off, because a goal may be out of reach."""

WINDOW = 20
"""Number of latest episodes whose mean return the live curve shows, because single returns vary too much."""

GREEDY_EPISODES = 100
"""Episodes with the learned greedy policy."""


@dataclass(frozen=True, eq=False)
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
    trajectories : sequence of sequence of int
        The states visited in each frame, drawn as a line; empty if there are none.
    """

    values: NDArray[np.float64]
    policies: NDArray[np.intp]
    said: Sequence[str]
    trajectories: Sequence[Sequence[int]] = ()


def replay(
    mdp: FiniteMDP,
    values: ArrayLike,
    policies: ArrayLike,
    *,
    best: ArrayLike,
    steps: Sequence[str],
    trajectories: Sequence[Sequence[int]] = (),
) -> Replay:
    """Make the frames of a recorded history, each compared with the optimal values.

    Parameters
    ----------
    mdp : FiniteMDP
        The model of S states.
    values, policies : (F, S) array
        The history of a recorded solution, such as its ``history`` and ``policies``.
    best : (S,) array
        The optimal values.
    steps : sequence of str
        The name of each frame, such as "sweep 3".
    trajectories : sequence of sequence of int
        The states visited in each frame, drawn as a line; empty if there are none.

    Returns
    -------
    Replay

    Raises
    ------
    ValueError
        If the numbers of values, policies, trajectories and steps differ.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, value_iteration
    >>> from robonav.widgets.grid_lab import replay
    >>> mdp = GridWorld("S . G").mdp(discount=0.9)
    >>> found = value_iteration(mdp, record=True)
    >>> names = [f"sweep {k}" for k in range(len(found.history))]
    >>> made = replay(mdp, found.history, found.policies, best=found.values, steps=names)
    >>> len(made.values) == len(names)
    True
    """
    held = check_array("values", values, shape=(len(steps), mdp.n_states))
    chosen = check_array("policies", policies, shape=held.shape, dtype=np.intp)
    if trajectories and len(trajectories) != len(steps):
        raise ValueError(
            f"trajectories must be as many as steps, {len(steps)}, got {len(trajectories)}"
        )
    compared = zip(steps, *suboptimality(mdp, held, chosen, best=best), strict=True)
    return Replay(
        held,
        chosen,
        [f"{step}: {_judged(off, lost)}" for step, off, lost in compared],
        trajectories,
    )


def _judged(off: float, lost: float) -> str:
    close = "values exact" if off < 5e-4 else f"values off by up to {off:.3g}"
    return (
        f"{close}, arrows optimal"
        if lost < 5e-4
        else f"{close}, the arrows lose up to {lost:.3g}"
    )


Solver = Callable[[GridWorld, tuple[str, ...]], Mapping[str, Replay]]


class _ReturnOfEpisode(gym.Wrapper[Any, Any, Any, Any]):
    """Adds up the rewards of the present episode in ``total``."""

    total = 0.0

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        self.total = 0.0
        return self.env.reset(**options)

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        state, reward, terminated, truncated, info = self.env.step(action)
        self.total += float(reward)
        return state, reward, terminated, truncated, info


class GridLab(KernelTraining):
    """Choose a setting, step through each method, and touch a cell. With a kernel, solve a map or learn on it."""

    _esm = front_end(
        "grid",
        "learning/worker",
        "learning/training_panel",
        "learning/kernel_panel",
        "grid_lab",
    )
    _css = style_sheet("grid", "learning/training_panel", "grid_lab")

    def __init__(
        self,
        data: dict[str, Any],
        solve: Solver | None,
        learners: Mapping[str, ControlMethod],
        grid: GridWorld,
        legend: Mapping[str, Cell],
    ) -> None:
        super().__init__(data)
        self._solve, self._learners = solve, learners
        self._step_reward, self._legend = grid.step_reward, legend

    def uses_kernel(self) -> bool:
        """Whether a kernel can do anything with a map of the reader: learn on it, or solve it."""
        return bool(self._learners) or self._solve is not None

    def _answer(self, widget: Any, message: dict[str, Any], buffers: Any) -> None:
        """Answer the page: as every widget that trains, and with the solution of the reader's own map."""
        super()._answer(widget, message, buffers)
        if message.get("ask") == "solve" and self._solve is not None:
            try:
                grid = GridWorld(str(message["text"]), legend=self._legend)
                replays = self._solve(
                    grid, tuple(str(choice) for choice in message["choices"])
                )
                self.send({"grid": page_grid(grid), "run": _run(replays)})
            except (ValueError, TypeError) as error:
                self.send({"error": str(error)})

    def train(self, request: dict[str, Any], report: Report) -> dict[str, Any]:
        """Learn on the reader's map by one of the learners, and return the replay of the training."""
        settings = request["settings"]
        name = check_one_of("learner", request["learner"], self._learners)
        episodes = check_integer("episodes", settings["episodes"], at_least=1)
        seed = check_integer("seed", settings["seed"], at_least=0)
        grid = GridWorld(
            str(request["text"]),
            legend=self._legend,
            slip=settings["slip"],
            step_reward=self._step_reward,
        )
        env = _ReturnOfEpisode(grid.environment())

        returns: deque[float] = deque(maxlen=WINDOW)

        def progress(done: int, total: int) -> None:
            returns.append(env.total)
            report(done, total, at=done, earned=sum(returns) / len(returns))

        learned = self._learners[name](
            env,
            episodes,
            discount=settings["discount"],
            learning_rate=settings["learning_rate"],
            epsilon=settings["epsilon"],
            max_steps=MOST_STEPS,
            seed=seed,
            record=True,
            progress=progress,
        )
        self.trainings = [learned]
        tried = rollouts(
            grid.environment(),
            learned.policy,
            GREEDY_EPISODES,
            max_steps=MOST_STEPS,
            seed=seed,
        )
        ended = sum(episode.terminated for episode in tried)
        mean = np.mean([episode.rewards.sum() for episode in tried])
        return {
            "grid": page_grid(grid),
            "run": _run({name: _replay_of_training(learned)}),
            "sentence": f"The greedy policy ends {ended} of {GREEDY_EPISODES} episodes within {MOST_STEPS} steps; "
            f"their mean return is {mean:.3g}.",
        }


def _replay_of_training(learned: ControlResult) -> Replay:
    """Some frames of a recorded training, each with the path of the episode that has just ended."""
    assert learned.history is not None
    assert learned.visited_states is not None
    shown = list(spread_out(len(learned.returns), FRAMES))
    q = learned.history[shown]
    return Replay(
        q.max(axis=2),
        q.argmax(axis=2),
        [
            f"after episode {k}, with a return of {learned.returns[k - 1]:.3g}"
            if k
            else "before the first episode"
            for k in shown
        ],
        [learned.visited_states[k - 1].tolist() if k else [] for k in shown],
    )


def grid_lab(
    grids: Mapping[str, GridWorld],
    controls: Mapping[str, Sequence[str]],
    runs: Mapping[tuple[str, ...], Mapping[str, Replay]],
    *,
    start: Sequence[str] = (),
    solve: Solver | None = None,
    learners: Mapping[str, ControlMethod] | None = None,
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
    learners : mapping of str to callable, optional
        Methods such as :func:`robonav.mdp.q_learning`, by name, that learn on a grid that the reader drew. They need a
        kernel. Symbols, and the reward of a step, are those of the given grids.

    Returns
    -------
    GridLab

    Raises
    ------
    ValueError
        If a combination is missing, or a replay belongs to another grid.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, value_iteration
    >>> from robonav.widgets.grid_lab import grid_lab, replay
    >>> grid = GridWorld("S . G")
    >>> mdp = grid.mdp(discount=0.9)
    >>> found = value_iteration(mdp, record=True)
    >>> names = [f"sweep {k}" for k in range(len(found.history))]
    >>> made = replay(mdp, found.history, found.policies, best=found.values, steps=names)
    >>> lab = grid_lab({"corridor": grid}, {}, {("corridor",): {"value iteration": made}})
    >>> len(lab.data) > 0
    True
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
            "controls": menus(offered, first),
            "runs": [_run(runs[combination]) for combination in combinations],
            "solves": solve is not None,
            "learners": list(learners or {}),
        },
        solve,
        learners or {},
        grids[first[0]],
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
            "trajectories": [
                list(map(int, trajectory)) for trajectory in shown.trajectories
            ],
        }
        for name, shown in replays.items()
    ]
