"""Gridworlds drawn as text, with walls, slipping, rewards and terminal cells: as a model and as an environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property, wraps
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar

import gymnasium as gym
import numpy as np
import scipy.sparse as sp
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from robonav.validation import (
    check_instance,
    check_integer,
    check_one_of,
    check_real,
)

from .models import FiniteMDP

R = TypeVar("R")

UP, RIGHT, DOWN, LEFT = range(4)
# rows and columns, in the order of the actions
STEPS = np.array([(-1, 0), (0, 1), (1, 0), (0, -1)])
ARROWS = "↑→↓←"

# probability, state reached, reward, whether the episode ends
Outcome = tuple[float, int, float, bool]


@dataclass(frozen=True)
class Cell:
    """Meaning of a symbol of the map.

    Parameters
    ----------
    reward : float
        Reward of each step that ends in such a cell, in addition to the grid's ``step_reward``.
    ends : bool
        Whether reaching such a cell ends the episode.
    wall : bool
        Whether such a cell cannot be entered.
    starts : bool
        Whether episodes start there.
    slip : float, optional
        Probability of slipping on leaving such a cell; the grid's own by default.

    Examples
    --------
    >>> from robonav.mdp import Cell, GridWorld
    >>> GridWorld("S . $", legend={"$": Cell(reward=5, ends=True)}).cell_rewards
    array([0., 0., 5.])
    """

    reward: float = 0.0
    ends: bool = False
    wall: bool = False
    starts: bool = False
    slip: float | None = None


LEGEND: Mapping[str, Cell] = MappingProxyType(
    {
        ".": Cell(),
        "#": Cell(wall=True),
        "S": Cell(starts=True),
        "G": Cell(reward=1.0, ends=True),
        "X": Cell(reward=-1.0, ends=True),
        "~": Cell(slip=2 / 3),
    }
)


@dataclass(frozen=True, eq=False)
class GridWorld:
    """A grid of cells in which the robot moves up, right, down and left (actions 0 to 3).

    A step into a wall or off the grid leaves the robot where it is. States are numbered row by row, without the walls.

    Parameters
    ----------
    text : str
        One line a row, one symbol a cell; blanks between symbols are ignored. ``.`` free, ``#`` wall, ``S`` start,
        ``G`` goal (reward 1, ends), ``X`` pit (reward -1, ends), ``~`` ice (slips with probability 2/3).
    legend : mapping of str to Cell
        Further symbols, or other meanings of these.
    slip : float
        Probability that a step goes to the left or to the right of its direction, half each.
    step_reward : float
        Reward of every step.

    Raises
    ------
    TypeError, ValueError
        If the text is not a string, rows differ in length, a symbol has no meaning, no cell is free, or a probability
        is out of range.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, value_iteration
    >>> grid = GridWorld("S . . G")
    >>> value_iteration(grid.mdp(discount=0.5)).values
    array([0.25, 0.5 , 1.  , 0.  ])
    """

    text: str
    legend: Mapping[str, Cell] = field(default_factory=dict, kw_only=True)
    slip: float = field(default=0.0, kw_only=True)
    step_reward: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        check_instance("text", self.text, str)
        check_instance("legend", self.legend, Mapping)
        check_real("slip", self.slip, at_least=0, at_most=1)
        check_real("step_reward", self.step_reward)
        if len({len(row) for row in self.rows}) != 1:
            raise ValueError(
                f"text must have rows of one length, got lengths {[len(row) for row in self.rows]}"
            )
        unknown = "".join(sorted(set("".join(self.rows)) - set(self.meanings)))
        if unknown:
            raise ValueError(
                f"text must use symbols of the legend, {' '.join(self.meanings)}, got {unknown}"
            )
        for symbol, cell in self.meanings.items():
            check_instance(f"legend[{symbol!r}]", cell, Cell)
            check_real(f"reward of {symbol!r}", cell.reward)
            if cell.slip is not None:
                check_real(f"slip of {symbol!r}", cell.slip, at_least=0, at_most=1)
        if self.terminal.all():
            raise ValueError(
                "text must have a cell that is neither a wall nor terminal, got none"
            )

    def __getstate__(self) -> dict[str, Any]:
        """What a copy is made of: the fields, without what was computed from them."""
        return {field.name: vars(self)[field.name] for field in fields(self)} | {
            "legend": dict(self.legend)
        }

    @cached_property
    def meanings(self) -> Mapping[str, Cell]:
        """Every symbol's meaning."""
        return MappingProxyType({**LEGEND, **self.legend})

    @cached_property
    def rows(self) -> tuple[str, ...]:
        """The symbols of each row, without blanks."""
        lines = ("".join(line.split()) for line in self.text.splitlines())
        return tuple(line for line in lines if line)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.rows), len(self.rows[0])

    @cached_property
    def numbers(self) -> NDArray[np.intp]:
        """The state in each cell of the map (rows, columns); -1 in walls."""
        free = ~self._of_symbols(lambda cell: cell.wall, bool)
        return np.where(free, np.cumsum(free).reshape(free.shape) - 1, -1)

    @cached_property
    def cells(self) -> NDArray[np.intp]:
        """Row and column of each state, (S, 2)."""
        return np.argwhere(self.numbers >= 0)

    @property
    def n_states(self) -> int:
        """Number of states S."""
        return len(self.cells)

    @cached_property
    def terminal(self) -> NDArray[np.bool_]:
        """Which states (S,) end an episode."""
        return self._of_states(lambda cell: cell.ends, bool)

    @cached_property
    def start(self) -> NDArray[np.float64]:
        """Probability (S,) of starting in each state: uniform over the start cells, or over all not terminal."""
        starts = self._of_states(lambda cell: cell.starts, bool)
        candidates = starts if starts.any() else ~self.terminal
        return candidates / candidates.sum()

    @cached_property
    def cell_rewards(self) -> NDArray[np.float64]:
        """Reward (S,) of a step that ends in each state, the reward of the step included."""
        return self.step_reward + self._of_states(lambda cell: cell.reward, float)

    @cached_property
    def moves(self) -> NDArray[np.intp]:
        """Where each action leads from each state, (S, 4), if it does not slip."""
        bordered = np.pad(self.numbers, 1, constant_values=-1)
        ahead = np.stack(
            [bordered[tuple((self.cells + 1 + step).T)] for step in STEPS], axis=1
        )
        return np.where(ahead >= 0, ahead, np.arange(self.n_states)[:, None])

    @cached_property
    def outcomes(self) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
        """The three outcomes of each action, (S, 4, 3) each: states reached (ahead, left, right), probabilities."""
        slip = self._of_states(
            lambda cell: self.slip if cell.slip is None else cell.slip, float
        )
        probabilities = np.stack([1 - slip, slip / 2, slip / 2], axis=1)[
            :, None
        ].repeat(4, axis=1)
        reached = self.moves[:, (np.arange(4)[:, None] + [0, -1, 1]) % 4]
        reached[self.terminal] = np.flatnonzero(self.terminal)[:, None, None]
        return reached, probabilities

    def mdp(self, discount: float) -> FiniteMDP:
        """Sparse model of the grid; a step out of a terminal state leads back to it, with reward 0.

        Parameters
        ----------
        discount : float
            gamma, in [0, 1].

        Returns
        -------
        FiniteMDP

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> GridWorld("S G").mdp(discount=0.9)
        FiniteMDP(2 states, 4 actions, discount 0.9, sparse)
        """
        reached, probabilities = self.outcomes
        rewards = (probabilities * self.cell_rewards[reached]).sum(axis=2)
        rewards[self.terminal] = 0
        starts = np.arange(0, 3 * self.n_states + 1, 3, dtype=np.int32)
        shape = (self.n_states, self.n_states)
        transitions = [
            sp.csr_array(
                (
                    probabilities[:, action].ravel(),
                    reached[:, action].ravel().astype(np.int32),
                    starts,
                ),
                shape,
            )
            for action in range(4)
        ]
        return FiniteMDP(transitions, rewards, discount)

    def environment(self, *, render_mode: str | None = None) -> GridEnvironment:
        """The grid as a Gymnasium environment with the same transitions and rewards as its model.

        Parameters
        ----------
        render_mode : {"ansi"}, optional
            As in Gymnasium: "ansi" draws the map as text.

        Returns
        -------
        GridEnvironment

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> env = GridWorld("S G").environment()
        >>> env.reset(seed=0)
        (0, {})
        """
        return GridEnvironment(self, render_mode=render_mode)

    def on_map(self, numbers: ArrayLike, *, walls: float = np.nan) -> NDArray:
        """Lay out one number for each state as the map.

        Parameters
        ----------
        numbers : (..., S) array
            One number for each state, such as its value.
        walls : float
            What stands in the walls.

        Returns
        -------
        (..., rows, columns) array

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> GridWorld("S # G").on_map([0.9, 0.0])
        array([[0.9, nan, 0. ]])
        """
        given = np.asarray(numbers)
        if given.shape[-1:] != (self.n_states,):
            raise ValueError(
                f"numbers must have shape (..., {self.n_states}), one for each state, got {given.shape}"
            )
        laid_out = np.full(
            (*given.shape[:-1], *self.shape),
            walls,
            dtype=np.result_type(given, type(walls)),
        )
        laid_out[..., self.cells[:, 0], self.cells[:, 1]] = given
        return laid_out

    def _of_symbols(self, what: Callable[[Cell], float], dtype: type) -> NDArray:
        """A property of each cell of the map, (rows, columns)."""
        meaning = {symbol: what(cell) for symbol, cell in self.meanings.items()}
        return np.array(
            [[meaning[symbol] for symbol in row] for row in self.rows], dtype=dtype
        )

    def _of_states(self, what: Callable[[Cell], float], dtype: type) -> NDArray:
        """A property of each state, (S,)."""
        return self._of_symbols(what, dtype)[tuple(self.cells.T)]


def takes_action(step: Callable[[Any, int], R]) -> Callable[[Any, int], R]:
    """Decorate ``step``, so that it checks its action, 0 to 3, which other libraries may give as an array ()."""

    @wraps(step)
    def checked(env: GridEnvironment, action: Any) -> R:
        """Check the action, then make the step."""
        single = np.ndim(action) == 0 and hasattr(action, "item")
        taken = action.item() if single else action
        return step(env, check_integer("action", taken, at_least=0, at_most=3))

    return checked


class GridEnvironment(gym.Env[Any, Any]):
    """A gridworld as a Gymnasium environment, whose transitions are published in ``P`` as Gymnasium's toy texts do.

    Observations are state numbers; actions are 0 to 3 (up, right, down, left). An episode ends in a terminal cell; add
    ``gymnasium.wrappers.TimeLimit`` for a limit of steps.

    Parameters
    ----------
    grid : GridWorld
    render_mode : {"ansi"}, optional

    Attributes
    ----------
    P : dict
        ``P[s][a]`` is a list of (probability, next state, reward, terminated).
    initial_state_distrib : (S,) array
        Probability of starting in each state.

    Examples
    --------
    >>> from robonav.mdp import GridEnvironment, GridWorld
    >>> env = GridEnvironment(GridWorld("S G"))
    >>> env.reset(seed=0)[0], env.step(1)[:3]
    (0, (1, 1.0, True))
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["ansi"], "render_fps": 4}  # type: ignore[misc]

    def __init__(self, grid: GridWorld, *, render_mode: str | None = None) -> None:
        if render_mode is not None:
            check_one_of("render_mode", render_mode, self.metadata["render_modes"])
        self.grid, self.render_mode = grid, render_mode
        self.observation_space = spaces.Discrete(grid.n_states)
        self.action_space = spaces.Discrete(4)
        self.initial_state_distrib = grid.start
        self.P = {
            state: {action: self._outcomes(state, action) for action in range(4)}
            for state in range(grid.n_states)
        }
        self.state = int(grid.start.argmax())

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[int, dict[str, Any]]:
        """Start a new episode in a cell drawn from the start cells.

        Parameters
        ----------
        seed : int, optional
            Seed of the random numbers, as in Gymnasium.
        options : dict, optional
            Not used.

        Returns
        -------
        state : int
            The first state.
        info : dict
            Empty.

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> GridWorld("S G").environment().reset(seed=0)
        (0, {})
        """
        super().reset(seed=seed)
        self.state = int(
            self.np_random.choice(self.grid.n_states, p=self.initial_state_distrib)
        )
        return self.state, {}

    @takes_action
    def step(self, action: int) -> tuple[int, float, bool, bool, dict[str, Any]]:
        """One step, Eq. (2.1): draw the next state and the reward from P(. | s, a).

        Parameters
        ----------
        action : int
            0 to 3: up, right, down, left.

        Returns
        -------
        state : int
            The next state.
        reward : float
            Its reward.
        terminated : bool
            Whether the state is terminal.
        truncated : bool
            Always False.
        info : dict
            ``info["probability"]`` is the probability of this outcome.

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> env = GridWorld("S G").environment()
        >>> state, info = env.reset(seed=0)
        >>> env.step(1)[:4]  # to the right, onto the goal
        (1, 1.0, True, False)
        """
        outcome = self._draw(self.P[self.state][action])  # Eq. (2.1)
        probability, self.state, reward, ended = outcome
        return self.state, reward, ended, False, {"probability": probability}

    def render(self) -> str | None:
        """The map as text, with an R where the robot is.

        Returns
        -------
        str or None
            None without a ``render_mode``.

        Examples
        --------
        >>> from robonav.mdp import GridWorld
        >>> env = GridWorld("S # G").environment(render_mode="ansi")
        >>> _ = env.reset(seed=0)
        >>> print(env.render(), end="")
        R # G
        """
        if self.render_mode is None:
            return None
        here = self.grid.cells[self.state]
        rows = [list(row) for row in self.grid.rows]
        rows[here[0]][here[1]] = "R"
        return "\n".join(" ".join(row) for row in rows) + "\n"

    def _draw(self, outcomes: list[Outcome]) -> Outcome:
        """One of the outcomes, drawn with its probability."""
        left = self.np_random.random()
        for outcome in outcomes:
            left -= outcome[0]
            if left < 0:
                break
        return outcome

    def _outcomes(self, state: int, action: int) -> list[Outcome]:
        """The entry ``P[s][a]``: what can follow, the same state once."""
        reached, probabilities = (part[state, action] for part in self.grid.outcomes)
        if self.grid.terminal[state]:
            return [(1.0, state, 0.0, True)]
        total: dict[int, float] = {}
        for to, p in zip(reached.tolist(), probabilities.tolist(), strict=True):
            if p > 0:
                total[to] = total.get(to, 0.0) + p
        return [
            (
                probability,
                to,
                float(self.grid.cell_rewards[to]),
                bool(self.grid.terminal[to]),
            )
            for to, probability in total.items()
        ]


def four_by_three(*, slip: float = 0.2, step_reward: float = -0.04) -> GridWorld:
    """The 4x3 world of Russell and Norvig: an exit with reward 1, one with -1 below it, and a wall in the middle.

    Parameters
    ----------
    slip, step_reward : float
        As for :class:`GridWorld`.

    Returns
    -------
    GridWorld

    Examples
    --------
    >>> from robonav.mdp import four_by_three
    >>> four_by_three().shape
    (3, 4)
    """
    exits = {"+": Cell(reward=1.0, ends=True), "-": Cell(reward=-1.0, ends=True)}
    return GridWorld(
        """
        . . . +
        . # . -
        S . . .
        """,
        legend=exits,
        slip=slip,
        step_reward=step_reward,
    )
