"""Models of environments, and environments of models: the two agree in every transition."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium as gym
import numpy as np
import scipy.sparse as sp
from gymnasium import spaces
from numpy.typing import NDArray
from scipy.sparse import csgraph

from robonav.validation import check_integer, check_one_of

if TYPE_CHECKING:
    from .gridworld import GridWorld

Outcome = tuple[
    float, int, float, bool
]  # probability, state reached, reward, whether the episode ends


def tabulate(env: Any) -> tuple[list[sp.csr_array], NDArray[np.float64]]:
    """Sparse transitions and rewards (S, A) of an environment that publishes its table ``P``.

    A state that a transition marked as ended leads to becomes terminal: absorbing, with reward 0. Wrappers are not
    looked at.

    Raises
    ------
    ValueError : if the environment publishes no table or an incomplete one, does not keep to it, or may end an episode
        in a state and go on from it another time, so that the state alone does not say what is to come.
    """
    bare = getattr(env, "unwrapped", env)
    table = getattr(bare, "P", None)
    if table is None:
        raise ValueError(
            f"env must publish its transitions as P[s][a] (FrozenLake, Taxi, CliffWalking), got {env}"
        )
    if getattr(bare, "fickle_passenger", False):
        raise ValueError(
            "env must move as its table P says, got a taxi whose fickle passenger is not in it"
        )
    rows = [_in_order(row) for row in _in_order(table)]
    states, actions = len(rows), len(rows[0]) if rows else 0
    if actions == 0 or any(len(row) != actions for row in rows):
        raise ValueError(
            "env must publish P[s][a] for as many actions in every state, and for at least one of each"
        )
    entries = np.array(
        [
            (action, state, reached, probability, probability * reward, ended)
            for state, row in enumerate(rows)
            for action, outcomes in enumerate(row)
            for probability, reached, reward, ended in outcomes
            if probability > 0
        ],
        dtype=float,
    ).reshape(-1, 6)
    action, state, reached = entries[:, :3].astype(np.intp).T
    if reached.min(initial=0) < 0 or reached.max(initial=0) >= states:
        raise ValueError(
            f"env must publish transitions to states from 0 to {states - 1}, got {reached.max()}"
        )
    ended = entries[:, 5] == 1
    terminal = np.zeros(states, dtype=bool)
    terminal[reached[ended]] = True
    starts = np.asarray(getattr(bare, "initial_state_distrib", np.ones(states)))
    leaving = np.zeros(states, dtype=bool)
    leaving[state[(reached != state) | (entries[:, 4] != 0)]] = True
    passed = terminal & leaving & _passed(starts, state[~ended], reached[~ended])
    if passed.any():
        raise ValueError(
            "env must end an episode in a state always or never: its number alone must say what is to come, got state "
            f"{int(passed.argmax())}, in which it may end and may go on"
        )
    going_on = ~terminal[state]
    rewards = np.zeros((states, actions))
    np.add.at(rewards, (state[going_on], action[going_on]), entries[going_on, 4])
    ends = np.flatnonzero(terminal)
    transitions = []
    for which in range(actions):
        own = going_on & (action == which)
        coordinates = np.append(state[own], ends), np.append(reached[own], ends)
        probability = np.append(entries[own, 3], np.ones(ends.size))
        transitions.append(
            sp.coo_array((probability, coordinates), (states, states)).tocsr()
        )
    return transitions, rewards


def _in_order(part: Any) -> list[Any]:
    """What a list, or a dictionary with the keys 0, 1, 2, ..., holds."""
    try:
        return [part[key] for key in range(len(part))]
    except (TypeError, LookupError):
        raise ValueError(
            f"env must publish P[s][a] with states and actions numbered from 0, got {part}"
        ) from None


def _passed(
    starts: NDArray[np.float64], state: NDArray[np.intp], reached: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """Which states (S,) an episode may begin in or pass, by the steps from ``state`` to ``reached`` that do not end."""
    steps = sp.csr_array(
        (np.ones(state.size), (state, reached)), (starts.size, starts.size)
    )
    return np.isfinite(
        csgraph.dijkstra(
            steps, indices=np.flatnonzero(starts), unweighted=True, min_only=True
        )
    )


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
        """A new episode, from a cell drawn among the start cells."""
        super().reset(seed=seed)
        self.state = int(
            self.np_random.choice(self.grid.n_states, p=self.initial_state_distrib)
        )
        return self.state, {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict[str, Any]]:
        """One move: state reached and reward, drawn from P(. | s, a) (Eq. (2.1)), and whether it ended the episode."""
        taken = check_integer("action", action, at_least=0, at_most=3)
        probability, self.state, reward, ended = self._drawn(self.P[self.state][taken])
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
            (
                chance,
                to,
                float(self.grid.cell_rewards[to]),
                bool(self.grid.terminal[to]),
            )
            for to, chance in total.items()
        ]
