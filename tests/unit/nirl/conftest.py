"""Gridworlds with a known reward, with which every method of chapter 5 is compared."""

from dataclasses import dataclass

import numpy as np
import pytest

from robonav import nirl
from robonav.mdp import policies
from robonav.mdp.dynamic_programming import policy_iteration
from robonav.mdp.evaluation import policy_evaluation
from robonav.mdp.gridworld import GridWorld
from robonav.nirl import RewardFreeMDP


@dataclass(frozen=True)
class Case:
    """A task, its true reward, and the two policies between which a learned policy is rated."""

    grid: GridWorld
    task: RewardFreeMDP
    truth: np.ndarray
    expert: np.ndarray

    def value(self, policy):
        """Return the true value of a policy at the start."""
        return float(
            self.task.starts
            @ policy_evaluation(self.task.with_reward(self.truth), policy)
        )

    def loss(self, policy):
        """Return the loss of a policy, as a share of the gap between the expert's value and a random policy's."""
        best = self.value(self.expert)
        return (best - self.value(policy)) / (
            best - self.value(policies.uniform(self.task.n_states, self.task.n_actions))
        )

    def best(self, weights):
        """Return the optimal policy for a learned reward."""
        return policy_iteration(self.task.with_reward(weights)).policy


def case(grid, task, truth):
    return Case(grid, task, truth, policy_iteration(task.with_reward(truth)).policy)


@pytest.fixture(scope="session")
def terrain():
    """Four kinds of ground, some of which slip, with a start and a target."""
    return case(*nirl.terrain(), nirl.TRUE_WEIGHTS)


@pytest.fixture(scope="session", params=range(4))
def scattered(request):
    """Grids of 5 x 5 cells. Every cell is a start, and each of 9 blocks has a random reward or none."""
    rng = np.random.default_rng(request.param)
    grid = GridWorld("\n".join(["....."] * 5), slip=0.1)
    blocks = grid.cells // 2
    phi = np.eye(9)[blocks[:, 0] * 3 + blocks[:, 1]]
    truth = rng.normal(size=9) * (rng.random(9) < 0.6)
    return case(grid, RewardFreeMDP.of_grid(grid, phi, 0.8), truth)
