"""Models of environments, and environments of models: the two agree in every transition."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray


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
