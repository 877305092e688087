"""Shortest paths, zero-reward loops and policies that end: what only planning without discount needs."""

import numpy as np
import scipy.sparse as sp

from robonav.mdp import FiniteMDP, GridWorld
from robonav.mdp.undiscounted import shortest_path_policy, zero_reward_absorbing


def test_shortest_path_policy():
    """A corridor 0 - 1 - 2 - 3 that ends at 0, and a room 4 that nobody leaves but where something is earned."""
    left = np.eye(5)[[0, 0, 1, 2, 4]]
    right = np.eye(5)[[0, 2, 3, 3, 4]]
    rewards = np.zeros((5, 2))
    rewards[4, 1] = 1
    mdp = FiniteMDP([left, right], rewards, 0.9)
    assert mdp.terminal.tolist() == [True, False, False, False, False]
    steps, policy = shortest_path_policy(mdp, mdp.terminal)
    assert policy[1:4].tolist() == [0, 0, 0]
    only_right = np.zeros((5, 2), dtype=bool)
    only_right[:, 1] = True
    steps, _ = shortest_path_policy(mdp, mdp.terminal, only_right)
    assert np.isinf(steps[1:]).all()


def test_shortest_path_policy_takes_the_likeliest_action():
    """Above the goal a step down gets there four times in five, one to the side by a slip only."""
    slippery = GridWorld("...\n..G", slip=0.2).mdp(0.9)
    steps, policy = shortest_path_policy(slippery, slippery.terminal)
    assert steps.tolist() == [3, 2, 1, 2, 1, 0]
    assert policy[[2, 4]].tolist() == [2, 1]


def test_zero_reward_absorbing_actions():
    """A ring 0 - 1 - 2 free of charge, a corridor 3 - 4 that leads into something that costs, and an end 5."""
    on = np.eye(6)[[1, 2, 0, 4, 5, 5]]
    out = np.eye(6)[[3, 5, 2, 3, 3, 5]]
    rewards = np.zeros((6, 2))
    rewards[4] = -1
    rewards[3, 1] = -1
    for transitions in (np.stack([on, out]), [sp.csr_array(on), sp.csr_array(out)]):
        rests = zero_reward_absorbing(FiniteMDP(transitions, rewards, 0.9))
        assert rests.tolist() == [[1, 0], [1, 1], [1, 1], [0, 0], [0, 0], [1, 1]]
