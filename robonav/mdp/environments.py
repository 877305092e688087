"""Models of environments, and environments of models: the two agree in every transition."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium as gym
import numpy as np
import scipy.sparse as sp
from gymnasium import spaces
from numpy.typing import NDArray

from robonav import expect

if TYPE_CHECKING:
    from .gridworld import GridWorld

Outcome = tuple[float, int, float, bool]  # probability, state reached, reward, whether the episode ends


def tabulate(env: Any) -> tuple[list[sp.csr_array], NDArray[np.float64]]:
    """Sparse transitions and rewards (S, A) of an environment that publishes its table ``P``.

    A state that a transition marked as ended leads to becomes terminal: absorbing, with reward 0.

    Raises
    ------
    ValueError : if the environment publishes no table.
    """
    table = getattr(getattr(env, "unwrapped", env), "P", None)
    if table is None:
        raise ValueError(f"env must publish its transitions as P[s][a] (FrozenLake, Taxi, CliffWalking), got {env}")
    states, actions = len(table), len(table[0])
    entries = np.array(
        [
            (action, state, reached, probability, probability * reward, ended)
            for state in range(states)
            for action in range(actions)
            for probability, reached, reward, ended in table[state][action]
        ],
        dtype=float,
    )
    action, state, reached = entries[:, :3].astype(np.intp).T
    terminal = np.zeros(states, dtype=bool)
    terminal[reached[entries[:, 5] == 1]] = True
    going_on = ~terminal[state]
    rewards = np.zeros((states, actions))
    np.add.at(rewards, (state[going_on], action[going_on]), entries[going_on, 4])
    ends = np.flatnonzero(terminal)
    transitions = []
    for which in range(actions):
        own = going_on & (action == which)
        coordinates = np.append(state[own], ends), np.append(reached[own], ends)
        probability = np.append(entries[own, 3], np.ones(ends.size))
        transitions.append(sp.coo_array((probability, coordinates), (states, states)).tocsr())
    return transitions, rewards


class GridEnvironment(gym.Env[Any, Any]):
    """A gridworld to walk through; its transitions are published in ``P``, as those of Gymnasium's toy texts are.

    Observations are state numbers, actions 0 to 3 (up, right, down, left). An episode ends in a terminal cell; add
    ``gymnasium.wrappers.TimeLimit`` for a limit of steps.

    Attributes
    ----------
    grid : the gridworld.
    P : ``P[s][a]`` is a list of (probability, next state, reward, whether the episode ends).
    initial_state_distrib : (S,), where episodes start.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["ansi"], "render_fps": 4}  # type: ignore[misc]

    def __init__(self, grid: GridWorld, *, render_mode: str | None = None) -> None:
        if render_mode is not None:
            expect.one_of("render_mode", render_mode, self.metadata["render_modes"])
        self.grid, self.render_mode = grid, render_mode
        self.observation_space = spaces.Discrete(grid.states)
        self.action_space = spaces.Discrete(4)
        self.initial_state_distrib = grid.start
        self.P = {state: {action: self._outcomes(state, action) for action in range(4)} for state in range(grid.states)}
        self.state = int(grid.start.argmax())

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[int, dict[str, Any]]:
        """A new episode, from a cell drawn among the start cells."""
        super().reset(seed=seed)
        self.state = int(self.np_random.choice(self.grid.states, p=self.initial_state_distrib))
        return self.state, {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict[str, Any]]:
        """One move: state reached, reward, whether it ended the episode."""
        probability, self.state, reward, ended = self._drawn(self.P[self.state][int(action)])
        return self.state, reward, ended, False, {"probability": probability}

    def render(self) -> str | None:
        """The map as text, with an R where the robot is."""
        if self.render_mode is None:
            return None
        here = self.grid.cells[self.state]
        rows = [list(row) for row in self.grid.rows]
        rows[here[0]][here[1]] = "R"
        return "\n".join(" ".join(row) for row in rows) + "\n"

    def _drawn(self, outcomes: list[Outcome]) -> Outcome:
        """One of the outcomes, by its probability."""
        left = self.np_random.random()
        for outcome in outcomes:
            left -= outcome[0]
            if left < 0:
                break
        return outcome

    def _outcomes(self, state: int, action: int) -> list[Outcome]:
        """The entry ``P[s][a]``: what can follow, the same state once."""
        reached, chances = (part[state, action] for part in self.grid.outcomes)
        if self.grid.terminal[state]:
            return [(1.0, state, 0.0, True)]
        total: dict[int, float] = {}
        for to, chance in zip(reached.tolist(), chances.tolist(), strict=True):
            if chance > 0:
                total[to] = total.get(to, 0.0) + chance
        return [
            (chance, to, float(self.grid.cell_rewards[to]), bool(self.grid.terminal[to]))
            for to, chance in total.items()
        ]
