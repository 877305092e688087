"""Gridworlds with a known reward: the truth against which every method of chapter 5 is held."""

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
    """A task, its true reward, and the two policies between which a learned one is rated."""

    grid: GridWorld
    task: RewardFreeMDP
    truth: np.ndarray
    expert: np.ndarray

    def value(self, policy):
        """What a policy is really worth from the start."""
        return float(
            self.task.starts
            @ policy_evaluation(self.task.with_reward(self.truth), policy)
        )

    def loss(self, policy):
        """What a policy loses, as a share of the gap between the expert's value and a random policy's."""
        best = self.value(self.expert)
        return (best - self.value(policy)) / (
            best - self.value(policies.uniform(self.task.n_states, self.task.n_actions))
        )

    def best(self, weights):
        """The best policy for a learned reward."""
        return policy_iteration(self.task.with_reward(weights)).policy


def case(grid, task, truth):
    return Case(grid, task, truth, policy_iteration(task.with_reward(truth)).policy)


@pytest.fixture(scope="session")
def terrain():
    """Four kinds of ground, some slipping, a start, a target."""
    return case(*nirl.terrain(), nirl.TRUE_WEIGHTS)


@pytest.fixture(scope="session", params=range(4))
def scattered(request):
    """Grids of 5 x 5 cells in blocks, every cell a start, a random reward or none on each of 9 blocks."""
    rng = np.random.default_rng(request.param)
    grid = GridWorld("\n".join(["....."] * 5), slip=0.1)
    blocks = grid.cells // 2
    phi = np.eye(9)[blocks[:, 0] * 3 + blocks[:, 1]]
    truth = rng.normal(size=9) * (rng.random(9) < 0.6)
    return case(grid, RewardFreeMDP.of_grid(grid, phi, 0.8), truth)
