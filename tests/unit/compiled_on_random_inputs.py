"""Calls every compiled part of the package with random inputs.

``test_compilation.py`` runs this file with numba's checks of bounds, which compile the kernels again. An index outside
an array then raises an IndexError. Without the checks it would read or write foreign memory.
"""

import gymnasium
import numpy as np

from robonav import lfd, mdp, nirl, nnql, robot
from robonav.robot import team


def search_with_the_astars(rng):
    for world in robot.random_worlds(10, 15, seed=1):
        cell = float(rng.choice([0.2, 0.7, 1.0, 2.5, 3.2, 10.0]))
        for edge in (0.0, world.size, cell * int(rng.integers(world.size / cell))):
            start = rng.permutation([edge, rng.uniform(0, world.size)])
            lfd.plan_on_grid(world, cell=cell, start=start, record=True)
            pose = (*start, rng.uniform(-4, 4))
            lfd.plan(
                world, cell=min(max(cell, 0.7), 2.0), pose=pose, limit=500, record=True
            )


def drive(rng):
    for moving in (0, 10):
        worlds = robot.random_worlds(20, 10, moving=moving, seed=2)
        robot.navigate(
            robot.turn_to_clearer_side, worlds, max_steps=60, record_paths=True
        )
        teams = team.random_teams(5, 6, 10, moving=moving, seed=2)
        team.navigate_team(robot.turn_to_clearer_side, teams, noise=0.1, max_steps=60)
    vector = gymnasium.make_vec("robonav/Navigation-v0", 5, obstacles=20)
    vector.reset(seed=3)
    for _ in range(60):
        vector.step(rng.integers(0, 5, size=5))


def plan_and_learn(rng):
    for _ in range(10):
        states, actions = rng.integers(1, 8, size=2)
        transitions = rng.dirichlet(np.ones(states), size=(actions, states))
        model = mdp.FiniteMDP(transitions, rng.normal(size=(states, actions)), 0.9)
        for planner in (
            mdp.value_iteration,
            mdp.modified_policy_iteration,
            mdp.policy_iteration,
            mdp.prioritized_sweeping,
        ):
            planner(model)
    mdp.q_learning(mdp.four_by_three().environment(), 20, seed=4)


def train(rng):
    demonstrations = lfd.demonstrate(robot.random_worlds(3, 10, seed=5))
    lfd.learn_policy(demonstrations, iterations=20)
    for method in ("nnql", "online", "nfq", "dqn"):
        nnql.train(method, seeds=2, episodes=6)
    for method in ("nirl", "apprenticeship", "relative-entropy", "scirl"):
        nirl.learn(demonstrations, method=method, iterations=3)


if __name__ == "__main__":
    for part in (search_with_the_astars, drive, plan_and_learn, train):
        part(np.random.default_rng(0))
        print(part.__name__, flush=True)
